//! Joining neighbours: counts by formula, closed surfaces, odd domains.

use glam::DVec3;

use crate::normals::{NormalWeights, vertex_normals};
use crate::test_support::{assert_closed, assert_same_mesh, cuboid, euler, grid, torus, volume};
use crate::{
    ArrayDomain, ArrayOptions, Arrayed, DirectionSource, Directions, Fit, Join, Mesh, PatchGrids,
    Unmonitored, array_components,
};

/// Two sheets of n by n quads at heights `low` and `high`, without sides.
fn sheets(n: u32, low: f64, high: f64) -> Mesh {
    let n_f = f64::from(n);
    let one = |z: f64| grid(n, n, move |i, j| [i / n_f, j / n_f, z]);
    let (top, bottom) = (one(high), one(low));
    let count = top.vertex_count() as u32;
    let positions = [top.positions().as_slice(), bottom.positions()].concat();
    let faces = top.topology().faces().map(<[u32]>::to_vec);
    let below = bottom.topology().faces();
    let reversed = below.map(|face| face.iter().rev().map(|v| v + count).collect());
    let faces: Vec<Vec<u32>> = faces.chain(reversed).collect();
    Mesh::from_faces(positions.iter().map(|p| p.to_array()).collect(), &faces).unwrap()
}

fn normals(base: &Mesh) -> Directions {
    let normals = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).unwrap();
    Directions::new(base, normals, DirectionSource::Surface).unwrap()
}

fn joined(base: &Mesh, components: &[&Mesh], options: ArrayOptions<'_>) -> Arrayed {
    let options = ArrayOptions {
        join: Join::Weld,
        ..options
    };
    array_components(base, components, &normals(base), &options, &Unmonitored).unwrap()
}

#[test]
fn a_torus_of_sheets_is_two_closed_tori() {
    let base = torus(12, 9, 3.0, 1.0);
    for n in [1, 3, 10] {
        let array = joined(&base, &[&sheets(n, -0.1, 0.2)], ArrayOptions::default());
        let report = array.join.unwrap();
        assert_closed(&array.mesh);
        assert_eq!(euler(&array.mesh), 0);
        // Closed quad meshes of genus one have as many vertices as faces.
        assert_eq!(array.mesh.vertex_count(), 12 * 9 * 2 * (n * n) as usize);
        assert_eq!((report.open, report.dropped_faces), (0, 0));
    }
}

#[test]
fn corner_lists_in_any_rotation_join_alike() {
    // Every face starts at another corner, so shared edges run either way.
    let base = torus(12, 9, 3.0, 1.0);
    let turned: Vec<[u32; 4]> = (0..base.face_count())
        .map(|f| std::array::from_fn(|k| base.face(f)[(k + f * 7 % 4) % 4]))
        .collect();
    let positions = base.positions().iter().map(|p| p.to_array()).collect();
    let turned = Mesh::from_faces(positions, &turned).unwrap();
    // Places at tenths: 1 - 0.9 is not 0.1 in binary.
    let sheet = sheets(10, -0.1, 0.2);
    let ours = joined(&turned, &[&sheet], ArrayOptions::default());
    assert_eq!(ours.join.unwrap().open, 0);
    assert_closed(&ours.mesh);
    let plain = joined(&base, &[&sheet], ArrayOptions::default());
    assert_same_mesh(&ours.mesh, &plain.mesh, 1e-9);
}

#[test]
fn an_open_plate_counts_by_formula() {
    let base = grid(5, 4, |x, y| [x, y, 0.3 * x * y]);
    let array = joined(&base, &[&sheets(3, 0.0, 0.1)], ArrayOptions::default());
    assert_eq!(array.mesh.vertex_count(), 2 * 16 * 13);
    assert_eq!(array.join.unwrap().open, 0);
    assert_eq!(euler(&array.mesh), 2);
}

#[test]
fn sides_that_do_not_match_stay_open_and_are_counted() {
    let base = grid(2, 1, |x, y| [x, y, 0.0]);
    let (coarse, fine) = (sheets(1, 0.0, 0.1), sheets(2, 0.0, 0.1));
    let choose = [0, 1];
    let options = ArrayOptions {
        choose: Some(&choose),
        ..ArrayOptions::default()
    };
    let array = joined(&base, &[&coarse, &fine], options);
    let report = array.join.unwrap();
    // The four corner points of the shared edge match, the fine middles do not.
    assert_eq!((report.joined, report.open), (4, 2));
}

#[test]
fn other_heights_do_not_match() {
    let base = grid(2, 1, |x, y| [x, y, 0.0]);
    let (low, high) = (sheets(1, 0.0, 0.1), sheets(1, 0.0, 0.2));
    let choose = [0, 1];
    let options = ArrayOptions {
        choose: Some(&choose),
        ..ArrayOptions::default()
    };
    let report = joined(&base, &[&low, &high], options).join.unwrap();
    assert_eq!((report.joined, report.open), (2, 4));
}

#[test]
fn triangles_collapse_their_edge_v_1() {
    // An icosahedron-like closed base: the octahedron.
    let base = Mesh::from_faces(
        vec![
            [1., 0., 0.],
            [0., 1., 0.],
            [-1., 0., 0.],
            [0., -1., 0.],
            [0., 0., 1.],
            [0., 0., -1.],
        ],
        &[
            [0, 1, 4],
            [1, 2, 4],
            [2, 3, 4],
            [3, 0, 4],
            [1, 0, 5],
            [2, 1, 5],
            [3, 2, 5],
            [0, 3, 5],
        ],
    )
    .unwrap();
    for n in [1, 2, 4] {
        let array = joined(&base, &[&sheets(n, -0.2, 0.1)], ArrayOptions::default());
        assert_closed(&array.mesh);
        assert_eq!(euler(&array.mesh), 4, "two spheres");
        let report = array.join.unwrap();
        // Quads at v = 1 become triangles with n > 1; with n = 1 so does the only one.
        assert_eq!((report.open, report.dropped_faces), (0, 0));
    }
}

#[test]
fn faces_in_a_collapsed_side_are_dropped_and_counted() {
    // A closed box: its side v = 1 has no width on a triangle.
    let base =
        Mesh::from_faces(vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &[[0, 1, 2]]).unwrap();
    let array = joined(
        &base,
        &[&cuboid(1.0, 1.0, 0.0, 0.5)],
        ArrayOptions::default(),
    );
    let report = array.join.unwrap();
    assert_eq!((report.joined, report.dropped_faces), (2, 1));
    assert_closed(&array.mesh);
    assert!((volume(&array.mesh) - 0.25).abs() < 1e-12);
}

#[test]
fn non_manifold_edges_join_all_their_faces() {
    let base = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [0., 1., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [-1., 0., 0.],
            [-1., 1., 0.],
            [0., 0., 1.],
            [0., 1., 1.],
        ],
        &[[0, 2, 3, 1], [4, 0, 1, 5], [0, 1, 7, 6]],
    )
    .unwrap();
    let directions = Directions::new(&base, vec![DVec3::Y; 8], DirectionSource::Surface).unwrap();
    let options = ArrayOptions {
        join: Join::Weld,
        ..ArrayOptions::default()
    };
    let sheet = grid(2, 2, |i, j| [i, j, 0.0]);
    let array = array_components(&base, &[&sheet], &directions, &options, &Unmonitored).unwrap();
    let report = array.join.unwrap();
    assert_eq!((report.joined, report.open), (2 * 3, 0));
}

#[test]
fn parents_join_along_their_grid_lines() {
    // A torus of 12 x 8 small faces as 3 x 2 parents of side 4.
    let (m, n, side) = (12u32, 8u32, 4u32);
    let base = torus(m, n, 3.0, 1.0);
    let mut grids = PatchGrids::new();
    for parent in 0..6 {
        let (x, y) = (parent % 3 * side, parent / 3 * side);
        let at = |k: u32| (y + k / (side + 1)) % n * m + (x + k % (side + 1)) % m;
        let vertices: Vec<u32> = (0..(side + 1) * (side + 1)).map(at).collect();
        grids.push(Some((side, &vertices))).unwrap();
    }
    grids.push(None).unwrap();
    let options = ArrayOptions {
        domain: ArrayDomain::Parent(&grids),
        ..ArrayOptions::default()
    };
    let array = joined(&base, &[&sheets(8, -0.1, 0.2)], options);
    assert_eq!((array.placed, array.skipped_parents), (6, 1));
    assert_closed(&array.mesh);
    assert_eq!(array.join.unwrap().open, 0);
    // Eight steps over side four: two to each small face.
    let small = joined(&base, &[&sheets(2, -0.1, 0.2)], ArrayOptions::default());
    assert_same_mesh(&array.mesh, &small.mesh, 1e-12);
}

#[test]
fn a_direction_read_off_the_side_stays_open() {
    use crate::{NormalUvAxes, NormalUvSource, Part, evaluate_normals_uv};
    let base = torus(12, 9, 3.0, 1.0);
    let source = NormalUvSource::Collapse {
        part: Part::All,
        to: None,
    };
    let sheet = sheets(2, 0.0, 0.2);
    let component = evaluate_normals_uv(&sheet, &source, NormalUvAxes::Both, &Fit::Bounds)
        .unwrap()
        .mesh;
    let array = joined(&base, &[&component], ArrayOptions::default());
    // The sheet in the surface closes, the 8 rim points of the one above do not.
    assert_eq!(array.join.unwrap().open, 8 * base.face_count());
    let bottom = keep(&array.mesh, |face| face % 8 >= 4);
    assert_closed(&bottom);
}

fn keep(mesh: &Mesh, wanted: impl Fn(u32) -> bool) -> Mesh {
    let faces = (0..mesh.face_count() as u32).filter(|&face| wanted(face));
    crate::rebuild::keep_faces(mesh, faces.collect()).unwrap()
}
