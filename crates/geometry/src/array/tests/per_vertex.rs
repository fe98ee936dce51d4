//! Every vertex at its own height, judged by plain distances.

use glam::DVec3;

use crate::normals::{NormalWeights, vertex_normals};
use crate::surface::{Border, Surface};
use crate::test_support::{cuboid, grid};
use crate::{
    ArrayOptions, Arrayed, DirectionSource, Directions, Fit, GeometryError, Join, Mesh,
    PerVertexOptions, PerVertexReport, Unmonitored, array_compensated,
};

fn normals(base: &Mesh) -> Vec<DVec3> {
    vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).unwrap()
}

fn along(base: &Mesh, vectors: Vec<DVec3>) -> Directions {
    Directions::new(base, vectors, DirectionSource::Surface).unwrap()
}

fn run(
    base: &Mesh,
    component: &Mesh,
    directions: &Directions,
    join: Join,
    border: Border,
) -> Result<(Arrayed, PerVertexReport), GeometryError> {
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        join,
        ..ArrayOptions::default()
    };
    let rule = PerVertexOptions {
        border,
        ..PerVertexOptions::default()
    };
    array_compensated(
        base,
        &[component],
        directions,
        &options,
        &rule,
        &Unmonitored,
    )
}

fn wave() -> Mesh {
    grid(6, 5, |x, y| {
        [x, y, 0.2 * crate::math::sin(x * 0.9) * (y - 2.0)]
    })
}

#[test]
fn heights_are_distances_joined_or_not() {
    let base = wave();
    let lean = DVec3::new(0.4, -0.2, 0.0);
    // Lengths make no difference: these differ from vertex to vertex.
    let stretched = normals(&base).into_iter().enumerate();
    let vectors = stretched.map(|(k, n)| (n + lean) * (1.0 + k as f64 / 9.0));
    let directions = along(&base, vectors.collect());
    let surface = Surface::new(&base, &Unmonitored).unwrap();
    for join in [Join::None, Join::Weld] {
        for border in [Border::Clip, Border::Extend] {
            let component = cuboid(1.0, 1.0, -0.3, 0.4);
            let (array, report) = run(&base, &component, &directions, join, border).unwrap();
            let (above, below) = (&report.outward, &report.inward);
            assert_eq!(
                above.vertices() + below.vertices(),
                array.mesh.vertex_count()
            );
            assert!(above.unsolved.is_empty() && below.unsolved.is_empty());
            let clipped = [&above.border_clipped[..], &below.border_clipped].concat();
            for (vertex, &p) in array.mesh.positions().iter().enumerate() {
                let rule = if clipped.contains(&(vertex as u32)) {
                    Border::Clip
                } else {
                    border
                };
                let distance = surface.distance(p, rule).0;
                let error = (distance / 0.4 - 1.0)
                    .abs()
                    .min((distance / 0.3 - 1.0).abs());
                assert!(error <= 1e-4, "vertex {vertex} at {distance}");
            }
        }
    }
}

#[test]
fn walls_too_close_are_named_with_their_faces() {
    let wall = grid(3, 3, |x, y| [x, y, 0.0]);
    let count = wall.vertex_count() as u32;
    let facing = wall.positions().iter().map(|p| *p + DVec3::Z * 1.6);
    let positions = wall.positions().iter().copied().chain(facing);
    let faces = wall.topology().faces().map(<[u32]>::to_vec);
    let turned = wall.topology().faces();
    let turned = turned.map(|face| face.iter().rev().map(|v| v + count).collect());
    let faces: Vec<Vec<u32>> = faces.chain(turned).collect();
    let base = Mesh::from_faces(positions.map(|p| p.to_array()).collect(), &faces).unwrap();
    let directions = along(&base, normals(&base));
    let lid = grid(1, 1, |x, y| [x, y, 1.0]);
    for join in [Join::None, Join::Weld] {
        let (array, report) = run(&base, &lid, &directions, join, Border::Clip).unwrap();
        let unsolved = &report.outward.unsolved;
        assert_eq!(unsolved.len(), array.mesh.vertex_count());
        for one in unsolved {
            assert!((one.reached - 0.8).abs() < 1e-3, "{one:?}");
            let z = array.mesh.positions()[one.vertex as usize].z;
            assert!((z - 0.8).abs() < 1e-3, "{z}");
        }
        let all: Vec<u32> = (0..base.face_count() as u32).collect();
        assert!(report.inward_faces.is_empty());
        // Of joined vertices the copy on the first face is the one that is left.
        if join == Join::None {
            assert_eq!(report.outward_faces, all);
        }
    }
}

#[test]
fn heights_below_the_warp_are_kept_and_named() {
    let warped = grid(1, 1, |x, y| [x, y, x * y]);
    let thin = grid(2, 2, |x, y| [x / 2.0, y / 2.0, 0.01]);
    let up = along(&warped, vec![DVec3::Z; 4]);
    let (array, report) = run(&warped, &thin, &up, Join::None, Border::Clip).unwrap();
    let middle = array.mesh.positions()[4];
    // The patch is at 1/4 there, the diagonal of the faces above or below it.
    assert!((middle.z - 0.26).abs() < 1e-12, "{middle}");
    let ids: Vec<u32> = report
        .outward
        .unsolved
        .iter()
        .map(|one| one.vertex)
        .collect();
    assert_eq!(ids, [4]);
    assert!(report.outward.unsolved[0].reached > 0.01);
}

#[test]
fn points_in_the_surface_stay_and_are_on_no_side() {
    let base = wave();
    let sheet = grid(1, 1, |x, y| [x, y, 0.0]);
    let directions = along(&base, normals(&base));
    let (array, report) = run(&base, &sheet, &directions, Join::Weld, Border::Extend).unwrap();
    assert_eq!(array.mesh.vertex_count(), base.vertex_count());
    assert_eq!(report, PerVertexReport::default());
}

#[test]
fn directions_that_cannot_be_used_are_refused() {
    let base = wave();
    let component = cuboid(1.0, 1.0, 0.0, 0.1);
    let plain = along(&base, normals(&base));
    let done = plain.compensated(normals(&base), normals(&base)).unwrap();
    let error = run(&base, &component, &done, Join::None, Border::Clip).unwrap_err();
    assert!(error.to_string().contains("PerVertex"), "{error}");
    let mut vectors = normals(&base);
    vectors[7] = -vectors[7];
    let against = along(&base, vectors);
    let error = run(&base, &component, &against, Join::None, Border::Clip).unwrap_err();
    assert!(
        matches!(&error, GeometryError::OpposedDirection { vertices } if vertices == &[7]),
        "{error}"
    );
}
