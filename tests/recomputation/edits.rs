//! The edits, as a designer makes them.

use super::Project;

/// An edit of the facade.
pub(super) struct Edit {
    pub(super) name: &'static str,
    pub(super) make: fn(&Project),
    /// Further arguments of the run.
    pub(super) arguments: &'static [&'static str],
    /// Whether it must not compute anything.
    pub(super) costs_nothing: bool,
}

impl Edit {
    const fn new(name: &'static str, make: fn(&Project)) -> Self {
        Self {
            name,
            make,
            arguments: &[],
            costs_nothing: false,
        }
    }

    /// An edit that must cost nothing.
    const fn free(name: &'static str, make: fn(&Project)) -> Self {
        let mut edit = Self::new(name, make);
        edit.costs_nothing = true;
        edit
    }

    const fn with(mut self, arguments: &'static [&'static str]) -> Self {
        self.arguments = arguments;
        self
    }
}

/// Replaces text that must be in a file.
fn change(project: &Project, file: &str, old: &str, new: &str) {
    let text = project.text(file);
    assert!(text.contains(old), "{old} in {file}");
    project.write(file, &text.replace(old, new));
}

fn graph(project: &Project, old: &str, new: &str) {
    change(project, "facade.ron", old, new);
}

/// Moves a node's line to the end of the nodes.
fn move_to_end(project: &Project, name: &str) {
    let text = project.text("facade.ron");
    let begin = format!("        \"{name}\": ");
    let line = text.lines().find(|line| line.starts_with(&begin));
    let line = format!("{}\n", line.expect("a node"));
    let without = text.replace(&line, "");
    let end = "    },\n    outputs: {";
    assert!(without.contains(end));
    project.write("facade.ron", &without.replace(end, &format!("{line}{end}")));
}

pub(super) const EDITS: &[Edit] = &[
    Edit::free("nothing at all", |_| {}),
    Edit::free("rename a node", |p| graph(p, "\"surface\"", "\"skin\"")),
    Edit::free("write a comment", |p| {
        graph(p, "    nodes: {", "    // The roof first.\n    nodes: {");
    }),
    Edit::free("reorder the nodes", |p| {
        move_to_end(p, "roof");
        move_to_end(p, "facade");
        move_to_end(p, "surface");
    }),
    Edit::free("reformat the file", |p| {
        let text = p.text("facade.ron");
        let (comment, rest) = text.split_once('\n').expect("a comment");
        let words: Vec<&str> = rest.split_whitespace().collect();
        p.write(
            "facade.ron",
            &format!("{comment}\n\n{}\n", words.join("\n  ")),
        );
    }),
    Edit::free("end lines as on Windows", |p| {
        graph(p, "\n", "\r\n");
    }),
    Edit::free("rename a parameter", |p| {
        graph(p, "\"thickness\"", "\"deep\"");
    }),
    Edit::free("write a default out", |p| {
        graph(
            p,
            "thickness: \"thickness\"),",
            "thickness: \"thickness\", mode: Global),",
        );
    }),
    Edit::free("an equal-valued expression", |p| {
        graph(p, "ignore_below: 0.125", "ignore_below: \"thickness / 2\"");
    }),
    Edit::free("another way to write a number", |p| {
        graph(p, "default: 0.25,", "default: 2.50e-1,");
    }),
    Edit::free("touch a file without changing it", |p| {
        let text = p.text("meshes/roof.obj");
        p.write("meshes/roof.obj", &text);
        let file = std::fs::File::options()
            .write(true)
            .open(p.path("meshes/roof.obj"));
        let later = std::time::Duration::from_secs(2_000_000_000);
        let time = std::time::SystemTime::UNIX_EPOCH + later;
        file.expect("a file").set_modified(time).expect("a time");
    }),
    Edit::free("rename a file", |p| {
        for name in ["meshes/a_panel.obj", "meshes/panel.obj"] {
            std::fs::copy(p.path("meshes/panel.obj"), p.path(name)).expect("copied");
        }
        graph(p, "meshes/panel.obj", "./meshes/a_panel.obj");
    }),
    Edit::free("an unused parameter", |p| {
        graph(
            p,
            "\"smooth\": Int",
            "\"idle\": 3,\n        \"smooth\": Int",
        );
    }),
    Edit::free("change an unused node", |p| {
        graph(p, "cells: [4, 4]", "cells: [9, 9]");
    }),
    Edit::free("another number of threads", |_| {}).with(&["--threads", "1"]),
    Edit::free("edit a default that is set from outside", |p| {
        graph(p, "default: 0.25,", "default: 0.4,");
    })
    .with(&["--set", "thickness=0.25"]),
    Edit::free("another output path", |p| {
        graph(p, "out/size.json", "out/figures.json");
    }),
    Edit::free("one more output of a node", |p| {
        graph(
            p,
            "\"out/size.json\": \"size\",",
            "\"out/size.json\": \"size\", \"out/skin.obj\": \"surface\",",
        );
    }),
    Edit::free("only one output", |_| {}).with(&["--only", "out/flat.json"]),
    Edit::free("remove a node and its output", |p| {
        graph(
            p,
            "        \"flat\": CheckPlanarity(mesh: \"surface\"),\n",
            "",
        );
        graph(p, "        \"out/flat.json\": \"flat\",\n", "");
    }),
    Edit::new("set a parameter", |_| {}).with(&["--set", "thickness=0.3"]),
    Edit::new("change a parameter of many nodes", |p| {
        graph(p, "default: 0.25,", "default: 0.3,");
    }),
    Edit::new("change a parameter of one node", |p| {
        graph(p, "default: 2, unit", "default: 3, unit");
    }),
    Edit::new("change a leaf", |p| {
        graph(p, "ignore_below: 0.125", "ignore_below: 0.1");
    }),
    Edit::new("use the node that was unused", |p| {
        graph(
            p,
            "\"out/flat.json\": \"flat\",",
            "\"out/flat.json\": \"flat\", \"out/spare.obj\": \"spare\",",
        );
    }),
    Edit::new("insert a node that does nothing", |p| {
        graph(
            p,
            "        \"smooth_dirs\"",
            "        \"same\": Transform(mesh: \"surface\"),\n        \"smooth_dirs\"",
        );
        for takes in [
            "SmoothNormals(mesh: ",
            "CompensateThickness(mesh: ",
            "ArrayComponents(base: ",
        ] {
            graph(
                p,
                &format!("{takes}\"surface\""),
                &format!("{takes}\"same\""),
            );
        }
    }),
    Edit::new("a comment in a mesh file", |p| {
        change(
            p,
            "meshes/roof.obj",
            "# A gently",
            "# Surveyed again: a gently",
        );
    }),
    Edit::new(
        "change a mesh file but neither its time nor its size",
        |p| {
            let path = p.path("meshes/roof.obj");
            let before = std::fs::metadata(&path).expect("a file");
            change(p, "meshes/roof.obj", "v 0 0 2", "v 0 0 3");
            let file = std::fs::File::options()
                .write(true)
                .open(&path)
                .expect("a file");
            file.set_modified(before.modified().expect("a time"))
                .expect("a time");
            drop(file);
            let after = std::fs::metadata(&path).expect("a file");
            assert_eq!(after.len(), before.len());
            assert_eq!(after.modified().ok(), before.modified().ok());
        },
    ),
    Edit::new("change only texture coordinates of the component", |p| {
        change(p, "meshes/panel.obj", "vt 1 1", "vt 0.5 1");
    }),
    Edit::new("change a colour of the component", |p| {
        change(p, "meshes/panel.mtl", "0.60 0.75 0.80", "0.90 0.75 0.80");
    }),
    Edit::new(
        "change the material file, but nothing in it that counts",
        |p| {
            change(
                p,
                "meshes/panel.mtl",
                "newmtl glass",
                "# clear\nnewmtl glass",
            );
        },
    ),
    Edit::new("swap the component", |p| {
        graph(p, "meshes/panel.obj", "meshes/fin.obj");
    }),
    Edit::new("other units, equal lengths", |p| {
        graph(p, "units: M,", "units: Cm,");
        graph(p, ".obj\"),", ".obj\", units: M),");
        graph(
            p,
            "default: 0.25, min: 0.02, max: 0.6",
            "default: 25, min: 2, max: 60",
        );
        graph(p, "default: 2, unit", "default: 200, unit");
        graph(p, "ignore_below: 0.125", "ignore_below: 12.5");
    }),
    Edit::new("a file is missing", |p| {
        std::fs::remove_file(p.path("meshes/panel.obj")).expect("removed");
    }),
    Edit::new("a mistake in the graph", |p| {
        graph(p, "ArrayComponents(", "ArrayComponent(");
    }),
];
