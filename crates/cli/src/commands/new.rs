//! `new`: a folder with a graph to start from.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Context, FAILED, OK};
use crate::atomic::write_if_changed;
use crate::text::{argument, printable};

/// Makes a folder with a small graph and its meshes to start from
#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// The folder to make
    name: PathBuf,
}

/// What the folder gets; the graph comes last, when what it reads is there.
const FILES: [(&str, &str); 3] = [
    ("meshes/roof.obj", include_str!("../starter/roof.obj")),
    ("parts/panel.obj", include_str!("../starter/panel.obj")),
    ("facade.ron", include_str!("../starter/facade.ron")),
];

/// Carries the command out.
pub(crate) fn new(args: &NewArgs, cx: &mut Context<'_, '_>) -> u8 {
    let folder = &args.name;
    let shown = printable(&folder.to_string_lossy()).into_owned();
    if is_taken(folder) {
        let help = "name a folder that is empty or not there yet".to_owned();
        return cx.fail(
            FAILED,
            "exists",
            format!("`{shown}` is there already"),
            Some(help),
        );
    }
    for (name, content) in FILES {
        let path = folder.join(name);
        if let Err(error) = write_if_changed(&path, content.as_bytes()) {
            let message = format!(
                "cannot write {}: {error}",
                printable(&path.to_string_lossy())
            );
            return cx.fail(FAILED, "output_failed", message, None);
        }
    }
    let graph = folder.join("facade.ron");
    let graph = printable(&graph.to_string_lossy()).into_owned();
    cx.console.note(&format!(
        "made {shown} with a graph and two meshes; now try\n\n    \
         tessgraph run {}\n\n\
         which writes {shown}/out/facade.glb. The graph is a text file: change it, or a\n\
         parameter with `--set thickness=0.3`, and run it again; with `--watch` it runs\n\
         again by itself.\n",
        argument(&graph)
    ));
    OK
}

/// Whether something is at the path, other than an empty folder.
fn is_taken(path: &Path) -> bool {
    match std::fs::read_dir(path) {
        Ok(mut entries) => entries.next().is_some(),
        Err(_) => path.symlink_metadata().is_ok(),
    }
}
