//! Tests of joined borders: closed forms, pairing, orientation, what is carried.

use proptest::prelude::*;

use super::super::{CapOptions, cap_holes, flip_chosen_faces};
use super::*;
use crate::math::{PI, TAU, cos, sin};
use crate::measure::measure_mesh;
use crate::mesh::{Attribute, AttributeValues};
use crate::subdivide::CREASE;
use crate::test_support::{assert_closed, euler, grid, volume};
use crate::transform::transform;
use crate::{Domain, Unmonitored, join};

fn moved(mesh: &Mesh, by: DVec3) -> Mesh {
    mesh.with_positions(mesh.positions().iter().map(|p| *p + by).collect())
        .unwrap()
}

fn flipped(mesh: &Mesh) -> Mesh {
    flip_chosen_faces(mesh, &vec![true; mesh.face_count()]).unwrap()
}

fn bridged(mesh: &Mesh, options: &BridgeOptions<'_>) -> Bridged {
    bridge_loops(mesh, options, &Unmonitored).unwrap()
}

/// A disc of n corners as one face, radius r, at height z, facing up or down.
fn disc(n: u32, r: f64, z: f64, turn: f64, up: bool) -> Mesh {
    let place = |k: u32| {
        let angle = turn + TAU * f64::from(k) / f64::from(n);
        [r * cos(angle), r * sin(angle), z]
    };
    let mut ring: Vec<u32> = (0..n).collect();
    if !up {
        ring.reverse();
    }
    Mesh::from_faces((0..n).map(place).collect(), &[ring]).unwrap()
}

/// A square frame: [0, 3]² without its middle cell.
fn frame() -> Mesh {
    let plate = grid(3, 3, |x, y| [x, y, 0.0]);
    let gone: Vec<bool> = (0..9).map(|f| f == 4).collect();
    super::super::delete_faces(&plate, &gone).unwrap()
}

#[test]
fn two_sheets_become_a_shell() {
    let low = grid(4, 3, |x, y| [x, y, 0.0]);
    let sheets = join(&[&flipped(&low), &moved(&low, DVec3::new(0.0, 0.0, 0.5))]).unwrap();
    let out = bridged(&sheets, &BridgeOptions::default());
    assert_closed(&out.mesh);
    assert!((volume(&out.mesh) - 6.0).abs() < 1e-14);
    assert_eq!(
        (out.mesh.face_count(), out.pairs.as_slice()),
        (24 + 14, &[[0, 1]][..])
    );
    assert!(out.mesh.topology().faces().all(|face| face.len() == 4));
    assert!(out.turned.is_empty() && out.alone.is_empty() && out.broken.is_empty());
    // A twist turns the second loop on: the walls lean, one edge further.
    let twisted = bridged(
        &sheets,
        &BridgeOptions {
            twist: 1,
            ..BridgeOptions::default()
        },
    );
    let across = |of: &Bridged| {
        let face = of.mesh.face(24);
        of.mesh.positions()[face[1] as usize].distance(of.mesh.positions()[face[2] as usize])
    };
    assert!((across(&out) - 0.5).abs() < 1e-15);
    assert!((across(&twisted) - 1.25f64.sqrt()).abs() < 1e-15);
    // Sheets that face the same way are named, since the strip turns over.
    let same = join(&[&low, &moved(&low, DVec3::new(0.0, 0.0, 0.5))]).unwrap();
    let out = bridged(&same, &BridgeOptions::default());
    assert_eq!(out.turned, [[0, 1]]);
    assert_closed(&out.mesh);
}

#[test]
fn a_frustum_has_the_volume_of_its_polygons() {
    // Equal polygons, one turned by less than half a side: walls of least length.
    let discs = join(&[
        &disc(12, 2.0, 0.0, 0.1, false),
        &disc(12, 1.0, 3.0, 0.1, true),
    ])
    .unwrap();
    let out = bridged(&discs, &BridgeOptions::default());
    assert_closed(&out.mesh);
    let area = |r: f64| 6.0 * r * r * sin(TAU / 12.0);
    let expected = 3.0 / 3.0 * (area(2.0) + area(1.0) + (area(2.0) * area(1.0)).sqrt());
    assert!((volume(&out.mesh) - expected).abs() < 1e-13);
}

#[test]
fn unequal_loops_get_quads_and_triangles_by_arc_length() {
    for (n, m) in [(12, 8), (8, 12), (24, 6), (7, 5), (5, 64)] {
        let discs = join(&[
            &disc(n, 1.0, 0.0, 0.0, false),
            &disc(m, 1.0, 1.0, 0.05, true),
        ]);
        let out = bridged(&discs.unwrap(), &BridgeOptions::default());
        assert_closed(&out.mesh);
        let sides: Vec<usize> = out
            .mesh
            .topology()
            .faces()
            .skip(2)
            .map(<[u32]>::len)
            .collect();
        let quads = sides.iter().filter(|sides| **sides == 4).count();
        assert_eq!(
            sides.iter().map(|sides| sides - 2).sum::<usize>(),
            (n + m) as usize
        );
        // Along the shorter loop every edge is a quad's, or nearly so.
        assert!(quads + 1 >= n.min(m) as usize, "{n} {m}: {quads}");
        // Between a prism over the coarser polygon and the cylinder.
        let area = |n: u32| 0.5 * f64::from(n) * sin(TAU / f64::from(n));
        let found = volume(&out.mesh);
        assert!(
            found < PI && found > 0.95 * area(n.min(m)),
            "{n} {m}: {found}"
        );
    }
}

#[test]
fn the_nearest_borders_are_paired() {
    // Both borders of a frame have one middle; the nearest is still that above.
    let low = frame();
    let high = moved(&low, DVec3::new(0.0, 0.0, 0.9));
    let sheets = join(&[&flipped(&low), &high]).unwrap();
    let out = bridged(&sheets, &BridgeOptions::default());
    assert_closed(&out.mesh);
    assert_eq!(out.pairs.len(), 2);
    assert_eq!(euler(&out.mesh), 0);
    assert!((volume(&out.mesh) - 8.0 * 0.9).abs() < 1e-13);
    // Too far apart, or not chosen: left open.
    let near = BridgeOptions {
        pairs: LoopPairs::Nearest(0.5),
        ..BridgeOptions::default()
    };
    let none = bridged(&sheets, &near);
    assert_eq!(
        (none.pairs.len(), none.alone.as_slice()),
        (0, &[0, 1, 2, 3][..])
    );
    assert_eq!(none.mesh.face_count(), 16);
    let inner: Vec<f64> = sheets
        .positions()
        .iter()
        .map(|p| f64::from((p.truncate() - glam::DVec2::splat(1.5)).abs().max_element() < 1.0))
        .collect();
    let field = crate::Field::new(Domain::Vertex, crate::Quantity::Number, inner).unwrap();
    let only = Amount::Field(std::sync::Arc::new(field));
    let holes = bridged(
        &sheets,
        &BridgeOptions {
            only,
            ..BridgeOptions::default()
        },
    );
    assert_eq!((holes.pairs.len(), holes.alone.len()), (1, 0));
    assert_eq!(holes.mesh.face_count(), 16 + 4);
}

#[test]
fn a_handle_joins_two_holes_of_one_sheet() {
    let plate = grid(7, 3, |x, y| [x, y, 0.0]);
    let gone: Vec<bool> = (0..21).map(|f| f == 8 || f == 12).collect();
    let plate = super::super::delete_faces(&plate, &gone).unwrap();
    let pairs = [[1, 2]];
    let options = BridgeOptions {
        pairs: LoopPairs::Given(&pairs),
        cuts: 3,
        smoothness: 1.0,
        ..BridgeOptions::default()
    };
    let out = bridged(&plate, &options);
    let found = measure_mesh(&out.mesh);
    assert_eq!(
        (found.euler, found.boundary_loops, found.inconsistent_edges),
        (-1, 1, 0)
    );
    assert!(out.turned.is_empty());
}

#[test]
fn cuts_are_straight_or_follow_the_surface() {
    let sheets = join(&[
        &flipped(&frame()),
        &moved(&frame(), DVec3::new(0.0, 0.0, 0.8)),
    ])
    .unwrap();
    let straight = bridged(
        &sheets,
        &BridgeOptions {
            cuts: 3,
            ..BridgeOptions::default()
        },
    );
    assert_closed(&straight.mesh);
    assert_eq!(straight.mesh.vertex_count(), 32 + 16 * 3);
    assert!((volume(&straight.mesh) - 6.4).abs() < 1e-13);
    // The surface runs into the hole on both sides, and the strip at a rim of length
    // l comes l / 4 into it at half its height: P(1/2) = middle + l (o + o) / 8.
    let smooth = BridgeOptions {
        cuts: 1,
        smoothness: 1.0,
        ..BridgeOptions::default()
    };
    let out = bridged(&sheets, &smooth);
    assert_closed(&out.mesh);
    let middle = |p: &&DVec3| (p.z - 0.4).abs() < 1e-12 && (p.truncate() - 1.5).length() < 1.0;
    let at: Vec<_> = out.mesh.positions().iter().filter(middle).collect();
    assert_eq!(at.len(), 4);
    for place in at {
        let expected = 0.5f64.sqrt() - 0.8 / 4.0;
        assert!(
            ((place.truncate() - 1.5).length() - expected).abs() < 1e-12,
            "{place}"
        );
    }
}

#[test]
fn strips_carry_values_materials_and_creases() {
    let low = grid(2, 2, |x, y| [x, y, 0.0]);
    let sheets = join(&[&flipped(&low), &moved(&low, DVec3::Z)]).unwrap();
    let heights: Vec<f64> = sheets.positions().iter().map(|p| p.z).collect();
    let values = AttributeValues::Number(heights.into());
    let sheets = sheets
        .with_attribute(Attribute::new("z", Domain::Vertex, values))
        .unwrap();
    let options = BridgeOptions {
        cuts: 4,
        crease: 3.0,
        material: Some("edge"),
        ..BridgeOptions::default()
    };
    let out = bridged(&sheets, &options).mesh;
    let AttributeValues::Number(z) = out.attribute("z", Domain::Vertex).unwrap().values() else {
        panic!("numbers");
    };
    assert!(
        out.positions()
            .iter()
            .zip(z.iter())
            .all(|(p, z)| (p.z - z).abs() < 1e-15)
    );
    for face in 0..out.face_count() {
        let name = out.materials().get(face).map(|m| m.name.as_str());
        assert_eq!(name, (face >= 8).then_some("edge"));
    }
    let AttributeValues::Number(creases) = out.attribute(CREASE, Domain::Corner).unwrap().values()
    else {
        panic!("numbers");
    };
    let adjacency = out.topology().adjacency();
    let sharp: Vec<usize> = (0..adjacency.edge_count())
        .filter(|&edge| {
            adjacency
                .edge_corners(edge)
                .iter()
                .all(|&c| creases[c as usize] > 2.9)
        })
        .collect();
    assert_eq!(sharp.len(), 16);
    assert!((creases.iter().sum::<f64>() - 16.0 * 2.0 * 3.0).abs() < 1e-12);
}

#[test]
fn loops_that_cannot_be_joined_are_named() {
    let mesh = join(&[
        &disc(5, 1.0, 0.0, 0.0, true),
        &disc(6, 1.0, 1.0, 0.0, false),
    ])
    .unwrap();
    let fails = |pairs: &[[u32; 2]]| {
        let options = BridgeOptions {
            pairs: LoopPairs::Given(pairs),
            ..BridgeOptions::default()
        };
        bridge_loops(&mesh, &options, &Unmonitored)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        fails(&[[0, 2]]),
        "there is no loop 2: the mesh has loops 0 to 1"
    );
    assert_eq!(
        fails(&[[1, 1]]),
        "loop 1 (6 edges from vertex 10) is named twice; a border can be joined with one other"
    );
    let smooth = BridgeOptions {
        smoothness: 1.5,
        ..BridgeOptions::default()
    };
    assert!(bridge_loops(&mesh, &smooth, &Unmonitored).is_err());
    // Two faces that disagree about their edge: their border does not close.
    let places: Vec<[f64; 3]> = (0..4)
        .map(|k| [f64::from(k % 2), f64::from(k / 2), 0.0])
        .collect();
    let torn = Mesh::from_faces(places, &[[0, 1, 2], [1, 2, 3]]).unwrap();
    let out = bridged(&join(&[&torn, &mesh]).unwrap(), &BridgeOptions::default());
    assert!(!out.broken.is_empty());
    assert_eq!(out.pairs.len(), 1);
}

#[test]
fn all_loops_of_an_array_find_their_twins() {
    let cell = join(&[
        &flipped(&disc(4, 0.7, 0.0, 0.0, true)),
        &disc(4, 0.7, 0.3, 0.0, true),
    ])
    .unwrap();
    let cells: Vec<Mesh> = (0..60)
        .map(|k| moved(&cell, DVec3::new(f64::from(k % 8), f64::from(k / 8), 0.0)))
        .collect();
    let all = join(&cells.iter().collect::<Vec<_>>()).unwrap();
    let out = bridged(&all, &BridgeOptions::default());
    assert_closed(&out.mesh);
    assert_eq!(out.pairs.len(), 60);
    assert!((volume(&out.mesh) - 60.0 * 2.0 * 0.49 * 0.3).abs() < 1e-11);
    assert_eq!(
        cap_holes(&out.mesh, &CapOptions::default()).unwrap().caps,
        0
    );
}

proptest! {
    #[test]
    fn strips_close_and_follow_rigid_motions(
        n in 3u32..20, m in 3u32..20, turn in 0.0f64..6.0, z in 0.1f64..2.0, cuts in 0u32..4,
        axis in (-1.0f64..1.0, -1.0f64..1.0, 0.1f64..1.0), angle in 0.0f64..6.0,
    ) {
        let discs = join(&[&disc(n, 1.0, 0.0, turn, false), &disc(m, 1.3, z, 0.0, true)]).unwrap();
        let options = BridgeOptions { cuts, smoothness: 0.5, ..BridgeOptions::default() };
        let out = bridged(&discs, &options);
        assert_closed(&out.mesh);
        prop_assert!(out.turned.is_empty());
        prop_assert!(volume(&out.mesh) > 0.0);
        let axis = DVec3::from(axis).normalize();
        let motion = glam::DAffine3::from_axis_angle(axis, angle);
        let there = bridged(&transform(&discs, motion, &Unmonitored).unwrap(), &options).mesh;
        prop_assert!((volume(&there) - volume(&out.mesh)).abs() < 1e-9);
    }
}
