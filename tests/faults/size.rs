//! Faults 71 to 75: results that cannot be held.

use std::time::Duration;

use super::desk::{Desk, SMALL};

/// Refused soon, by a node, with the figure and the limit.
#[track_caller]
fn refused(nodes: &str, says: &[&str]) {
    let desk = Desk::nodes(nodes);
    let done = desk.run(&["run", "g.ron", "--max-memory", "1GB"]);
    done.refused(says).within(Duration::from_secs(30));
    assert!(done.err.contains("failed"), "{}", done.err);
    assert!(!desk.path("out").exists());
}

#[test]
fn f071_a_subdivision_bomb() {
    let levels = "\"a\": Cuboid(), \"b\": SubdivideQuad(mesh: \"a\", levels: 7)";
    // 6 · 4^15 faces.
    refused(
        &format!("{levels}, \"out\": SubdivideQuad(mesh: \"b\", levels: 8)"),
        &["6442450946", "limit of 4294967294"],
    );
    // 6 · 4^11 can be numbered, but not held.
    refused(
        &format!("{levels}, \"out\": SubdivideQuad(mesh: \"b\", levels: 4)"),
        &["it needs about", "MB are left", "raise the memory limit"],
    );
}

#[test]
fn f072_an_array_bomb() {
    let array = |cells: u32| {
        format!(
            "\"g\": Grid(cells: ({cells}, {cells})), \"n\": VertexNormals(mesh: \"g\"),
             \"out\": ArrayComponents(base: \"g\", component: \"g\", directions: \"n\")"
        )
    };
    refused(&array(1000), &["1002001000000", "limit of 4294967294"]);
    refused(&array(100), &["it needs about", "MB are left"]);
}

#[test]
fn f073_a_grid_bomb() {
    refused(
        "\"out\": Grid(cells: (100000, 100000))",
        &["it needs about 1080005 MB"],
    );
    let most = u32::MAX;
    refused(
        &format!("\"out\": Grid(cells: ({most}, {most}))"),
        &["it needs about"],
    );
    refused(
        &format!("\"out\": Cuboid(cells: ({most}, {most}, {most}))"),
        &["it needs about"],
    );
    refused(
        "\"out\": Grid(cells: (20000, 20000))",
        &["it needs about", "MB are left"],
    );
    refused(
        "\"out\": Cuboid(cells: (9000, 9000, 9))",
        &["it needs about", "MB are left"],
    );
}

#[cfg(unix)]
#[test]
fn f074_an_address_space_limit() {
    let desk = Desk::nodes("\"out\": Grid(cells: (6000, 6000))");
    let done = desk.limited(SMALL, &["run", "g.ron"]);
    done.refused(&["it needs about", "MB are left"]);
    let desk = Desk::nodes("\"out\": Grid(cells: (60, 60))");
    desk.limited(SMALL, &["run", "g.ron"]).made();
    // Work that does not ask first meets the allocator's limit instead.
    let desk = Desk::nodes(
        "\"a\": Grid(cells: (1300, 1300)), \"c\": CheckIntersections(mesh: \"a\"), \
         \"out\": Transform(mesh: \"a\", translate: (0, 0, \"c.pairs\"))",
    );
    desk.limited(SMALL, &["run", "g.ron"]).refused(&["MB"]);
    assert!(!desk.path("out").exists());
}

#[test]
fn f072_meshes_made_of_meshes() {
    let list = vec!["\"a\""; 2000].join(",");
    let many = format!("JoinMeshes(meshes: [{list}])");
    let made = "TriangulateFaces(mesh: \"b\"), SplitIntoQuads(mesh: \"b\"), FanFaces(mesh: \"b\"), \
         FrameFaces(mesh: \"b\"), WeldVertices(mesh: \"b\"), DualMesh(mesh: \"b\"), \
         ExtrudeFaces(mesh: \"b\", height: 1)";
    for node in made
        .split("), ")
        .map(|node| format!("{})", node.trim_end_matches(')')))
        .chain([many])
    {
        let desk = Desk::nodes(&format!(
            "\"a\": Grid(cells: (120, 120)), \"b\": Grid(cells: (700, 700)), \"out\": {node}"
        ));
        let done = desk.run(&["run", "g.ron", "--no-cache", "--max-memory", "100MB"]);
        done.refused(&["it needs about", "MB are left"]);
    }
}

#[test]
fn f075_a_result_just_under_the_limit() {
    // 500 · 500 faces: 24 bytes a vertex, 84 a face.
    let desk = Desk::nodes("\"out\": Grid(cells: (500, 500))");
    let at = |limit: &str| desk.run(&["run", "g.ron", "--no-cache", "--max-memory", limit]);
    at("26MB").refused(&["it needs about 28 MB"]);
    at("120MB").made();
}
