//! Numbering, grids and orientation.

use super::*;
use crate::subdivide::{PARENT, Parents};
use glam::DVec2;

fn check_grids(mesh: &Mesh, level: u32) {
    let fine = run(mesh, levels(level));
    let parents = &fine.parents;
    assert_eq!(parents.len(), mesh.face_count());
    let side = 1usize << level;
    for face in 0..mesh.face_count() {
        let corners = mesh.face(face);
        let whole = parents.whole_grid(face);
        assert_eq!(whole.is_some(), corners.len() == 4);
        let count = match (corners.len(), level) {
            (4, _) => 1,
            (_, 0) => 0,
            (sides, _) => sides,
        };
        assert_eq!(parents.grid_count(face), count);
        for (k, &corner) in corners.iter().enumerate().take(count) {
            let grid = parents.grid(face, k);
            let n = grid.side();
            assert_eq!(n, if whole.is_some() { side } else { side / 2 });
            assert_eq!(grid.vertex(0, 0), corner);
            for (i, j) in (0..n * n).map(|cell| (cell % n, cell / n)) {
                let face = fine.mesh.face(grid.face(i, j));
                let around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                assert_eq!(face, around.map(|(i, j)| grid.vertex(i, j)));
                let (number, [low, high]) = parents.rectangle(grid.face(i, j)).expect("a grid");
                assert_eq!(number, k);
                let place = DVec2::new(i as f64, j as f64);
                assert_eq!(low * n as f64, place);
                assert_eq!(high * n as f64, place + 1.0);
            }
        }
        if let Some(grid) = whole {
            let ends = [(0, 0), (side, 0), (side, side), (0, side)];
            assert_eq!(corners, ends.map(|(i, j)| grid.vertex(i, j)));
        }
    }
}

#[test]
fn children_keep_the_u_and_v_of_their_parent() {
    for level in 0..=4 {
        check_grids(&cube(), level);
        check_grids(&mixed(), level);
    }
}

#[test]
fn faces_of_a_parent_follow_each_other() {
    let fine = run(&mixed(), levels(2));
    let attribute = fine
        .mesh
        .attribute(PARENT, Domain::Face)
        .expect("has parents");
    let AttributeValues::Integer(of_face) = attribute.values() else {
        panic!("parents are {}s", attribute.values().type_name());
    };
    assert!(of_face.is_sorted());
    for (face, &parent) in of_face.iter().enumerate() {
        assert_eq!(fine.parents.patch_of(face) as i64, parent);
        assert!(fine.parents.faces(parent as usize).contains(&face));
    }
    let sizes = of_face.chunk_by(|a, b| a == b).map(<[i64]>::len);
    assert!(sizes.eq([12, 16, 20, 16]));
}

#[test]
fn parents_are_found_again_from_the_attribute() {
    for mesh in [cube(), mixed()] {
        for level in 0..=3 {
            let fine = run(&mesh, levels(level));
            let found = Parents::of_mesh(&fine.mesh).expect("has the attribute");
            assert_eq!(found.len(), fine.parents.len());
            for patch in 0..found.len() {
                assert_eq!(found.parent(patch), fine.parents.parent(patch));
                assert_eq!(found.faces(patch), fine.parents.faces(patch));
                assert_eq!(
                    found.grid_count(patch),
                    fine.parents.grid_count(patch),
                    "level {level} patch {patch}"
                );
            }
        }
    }
}

#[test]
fn a_patch_that_lost_a_face_has_no_grid() {
    let fine = run(&cube(), levels(1)).mesh;
    let faces: Vec<&[u32]> = fine.topology().faces().skip(1).collect();
    let positions = fine.positions().iter().map(|p| p.to_array()).collect();
    let parents: Vec<i64> = (1..24).map(|face| face / 4).collect();
    let values = AttributeValues::Integer(parents.into());
    let mesh = Mesh::from_faces(positions, &faces)
        .and_then(|mesh| mesh.with_attribute(Attribute::new(PARENT, Domain::Face, values)))
        .expect("valid");
    let found = Parents::of_mesh(&mesh).expect("has the attribute");
    assert!(found.whole_grid(0).is_none());
    assert_eq!((found.grid_count(0), found.grid_count(1)), (0, 1));
    assert_eq!(found.rectangle(0), None);
}

#[test]
fn meshes_without_the_attribute_say_what_they_have() {
    let error = Parents::of_mesh(&cube()).expect_err("no attribute");
    assert_eq!(
        error.to_string(),
        "there is no face integer attribute `parent`; the mesh has `uv`"
    );
}

#[test]
fn coarse_vertices_come_first_then_edges_then_faces() {
    let mesh = mixed();
    let scheme = Scheme::Bilinear;
    let fine = run(
        &mesh,
        Options {
            scheme,
            ..levels(1)
        },
    )
    .mesh;
    let p = mesh.positions();
    assert_eq!(fine.positions()[..10], p[..]);
    let edges = mesh.topology().adjacency().edges();
    for (k, &[a, b]) in edges.iter().enumerate() {
        let middle = (p[a as usize] + p[b as usize]) / 2.0;
        assert_eq!(fine.positions()[10 + k], middle);
    }
    let triangle = (p[0] + p[1] + p[2]) / 3.0;
    assert!(fine.positions()[10 + edges.len()].distance(triangle) < 1e-15);
}
