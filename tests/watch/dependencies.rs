//! The files that a run depends on besides its graph.

use std::fs;
use std::path::Path;

use super::{Watch, strip, write};

/// A graph that reads a mesh.
fn reads(path: &str) -> String {
    format!(
        r#"Graph(version: 1, nodes: {{"mesh": ReadMesh(path: "{path}"), "size": MeasureMesh(mesh: "mesh")}},
        outputs: {{"size.json": "size", "copy.glb": "mesh"}})"#
    )
}

/// Watches a graph that reads this file with a strip of three faces.
fn watching(path: &str, prepare: &dyn Fn(&Path)) -> (tempfile::TempDir, Watch) {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder.path().join("g.ron"), &reads(path));
    prepare(folder.path());
    let watch = Watch::start(folder.path(), &[]);
    assert_eq!(watch.next()["ok"], true, "{}", watch.said());
    assert_eq!(watch.faces(), 3);
    (folder, watch)
}

fn in_meshes(folder: &Path) {
    fs::create_dir_all(folder.join("meshes")).expect("a folder");
    write(&folder.join("meshes/a.obj"), &strip(3));
}

#[test]
fn a_mesh_is_followed_while_it_is_used() {
    let (folder, watch) = watching("meshes/a.obj", &in_meshes);
    let at = |name: &str| folder.path().join(name);
    write(&at("meshes/a.obj"), &strip(4));
    watch.until_faces(4);
    write(&at("meshes/new.obj"), &strip(5));
    fs::rename(at("meshes/new.obj"), at("meshes/a.obj")).expect("renamed");
    watch.until_faces(5);
    // Missing, with its folder, and back.
    fs::remove_dir_all(at("meshes")).expect("removed");
    while watch.next()["ok"] == true {}
    assert_eq!(watch.faces(), 5, "the last good output stays");
    in_meshes(folder.path());
    watch.until_faces(3);
    // Not used any more, and used again.
    write(&at("b.obj"), &strip(6));
    write(&at("g.ron"), &reads("b.obj"));
    watch.until_faces(6);
    write(&at("meshes/a.obj"), &strip(7));
    assert_eq!(watch.until_quiet().len(), 0);
    write(&at("g.ron"), &reads("meshes/a.obj"));
    watch.until_faces(7);
    write(&at("meshes/a.obj"), &strip(8));
    watch.until_faces(8);
}

#[test]
fn an_included_graph_is_followed_also_when_it_is_broken_or_missing() {
    let part = |cells: usize| {
        format!(
            "Graph(version: 1, nodes: {{\"grid\": Grid(cells: [{cells}, 1])}}, \
             results: {{\"mesh\": \"grid\"}})"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    write(
        &at("g.ron"),
        "Graph(version: 1, nodes: {\"part\": Subgraph(path: \"parts/a.ron\"), \
         \"size\": MeasureMesh(mesh: \"part\")}, outputs: {\"size.json\": \"size\"})",
    );
    fs::create_dir(at("parts")).expect("a folder");
    write(&at("parts/a.ron"), &part(3));
    let watch = Watch::start(folder.path(), &[]);
    watch.until_faces(3);
    write(&at("parts/a.ron"), &part(4));
    watch.until_faces(4);
    write(&at("parts/a.ron"), "Graph(version: 1, nodes: {");
    while watch.next()["ok"] == true {}
    assert_eq!(watch.faces(), 4, "the last good output stays");
    write(&at("parts/a.ron"), &part(5));
    watch.until_faces(5);
    fs::remove_file(at("parts/a.ron")).expect("removed");
    while watch.next()["ok"] == true {}
    write(&at("parts/a.ron"), &part(6));
    watch.until_faces(6);
}

#[test]
fn a_file_found_only_while_reading_is_followed_also_when_missing() {
    let with_library = |folder: &Path| {
        let text = format!("mtllib a.mtl\nusemtl red\n{}", strip(3));
        write(&folder.join("a.obj"), &text);
    };
    let (folder, watch) = watching("a.obj", &with_library);
    let colour = |name: &str| {
        #[allow(clippy::disallowed_methods, reason = "tests read what was written")]
        let bytes = fs::read(folder.path().join("copy.glb")).expect("a file");
        assert!(!bytes.is_empty(), "{name}");
        bytes
    };
    let mut last = colour("none");
    for shade in ["1 0 0", "0 1 0", "0 0 1"] {
        let library = format!("newmtl red\nKd {shade}\n");
        write(&folder.path().join("a.mtl"), &library);
        assert_eq!(watch.next()["ok"], true);
        let new = colour(shade);
        assert!(new != last, "{shade}");
        last = new;
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed_wherever_they_lead() {
    use std::os::unix::fs::symlink;
    // As a deployment swaps them: a link to a link, of which one is exchanged.
    let prepare = |folder: &Path| {
        for (version, faces) in [("v1", 3), ("v2", 4), ("v3", 5)] {
            fs::create_dir(folder.join(version)).expect("a folder");
            write(&folder.join(version).join("a.obj"), &strip(faces));
        }
        symlink("v1", folder.join("current")).expect("a link");
        symlink("current/a.obj", folder.join("mesh.obj")).expect("a link");
    };
    let (folder, watch) = watching("mesh.obj", &prepare);
    let at = |name: &str| folder.path().join(name);
    let swap = |to: &str| {
        symlink(to, at("next")).expect("a link");
        fs::rename(at("next"), at("current")).expect("renamed");
    };
    swap("v2");
    watch.until_faces(4);
    swap("v3");
    watch.until_faces(5);
    // What the link led to before means nothing now; what it leads to does.
    write(&at("v1/a.obj"), &strip(8));
    assert_eq!(watch.until_quiet().len(), 0);
    write(&at("v3/a.obj"), &strip(9));
    watch.until_faces(9);
    // The graph itself is a link.
    write(&at("v1/other.ron"), &super::graph(10));
    symlink("v1/other.ron", at("next")).expect("a link");
    fs::rename(at("next"), at("g.ron")).expect("renamed");
    watch.until_faces(10);
    write(&at("v1/other.ron"), &super::graph(11));
    watch.until_faces(11);
}
