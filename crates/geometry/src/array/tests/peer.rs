//! The paper's add-on on its own cases: equal results with its conventions.

use glam::DVec3;

use crate::math::unit_or_zero;
use crate::normals::{NormalWeights, vertex_normals};
use crate::test_support::{PeerCase, assert_closed, assert_same_mesh, peer_case};
use crate::{
    Amount, ArrayDomain, ArrayOptions, Arrayed, Beyond, DirectionSource, Directions, Domain, Field,
    Fit, FitOptions, Height, Interpolation, Join, Mesh, NormalUvAxes, NormalUvSource, PatchGrids,
    Quantity, Unmonitored, array_components, evaluate_normals_uv, fit_component,
};

/// Positions in the cases have nine digits, normals six.
const TOLERANCE: f64 = 1e-5;

fn normals(base: &Mesh) -> Directions {
    let normals = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).unwrap();
    Directions::new(base, normals, DirectionSource::Surface).unwrap()
}

fn towards(base: &Mesh, target: &Mesh, length: impl Fn(DVec3) -> DVec3) -> Directions {
    let pairs = base.positions().iter().zip(target.positions().iter());
    let vectors = pairs.map(|(p, t)| length(*t - *p)).collect();
    Directions::new(base, vectors, DirectionSource::Target).unwrap()
}

fn linear<'a>() -> ArrayOptions<'a> {
    ArrayOptions {
        interpolation: Interpolation::Linear,
        ..ArrayOptions::default()
    }
}

fn run(
    case: &PeerCase,
    directions: impl Fn(&Mesh) -> Directions,
    options: &ArrayOptions<'_>,
) -> Arrayed {
    let base = case.mesh("base");
    let component = case.mesh("component");
    array_components(
        &base,
        &[&component],
        &directions(&base),
        options,
        &Unmonitored,
    )
    .unwrap()
}

#[test]
fn saddle_relative_height() {
    let Some(case) = peer_case("01_saddle_default") else {
        return;
    };
    let options = ArrayOptions {
        height: Height::Relative,
        ..linear()
    };
    let array = run(&case, normals, &options);
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn saddle_joined() {
    let Some(case) = peer_case("02_saddle_constant_merge") else {
        return;
    };
    let array = run(
        &case,
        normals,
        &ArrayOptions {
            join: Join::Weld,
            ..linear()
        },
    );
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
    let report = array.join.unwrap();
    assert_eq!(
        (report.joined, report.open, report.dropped_faces),
        (144 * 16 - 1490, 0, 0)
    );
}

#[test]
fn fold_in_unit_coordinates() {
    let Some(case) = peer_case("03_fold_default") else {
        return;
    };
    let array = run(
        &case,
        normals,
        &ArrayOptions {
            fit: Some(&Fit::Unit),
            ..linear()
        },
    );
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn target_vectors_as_they_are() {
    let Some(case) = peer_case("06_fold_target_relative") else {
        return;
    };
    let target = case.mesh("target");
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        height: Height::Relative,
        ..linear()
    };
    let array = run(&case, |base| towards(base, &target, |d| d), &options);
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn target_vectors_of_unit_length() {
    let Some(case) = peer_case("07_fold_target_constant") else {
        return;
    };
    let target = case.mesh("target");
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        ..linear()
    };
    let array = run(&case, |base| towards(base, &target, unit_or_zero), &options);
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn directions_read_at_a_uv_layer() {
    for (name, axes) in [
        ("10_evalnormals_identity", NormalUvAxes::U),
        ("10_evalnormals_identity", NormalUvAxes::Both),
        ("10b_evalnormals_collapsed", NormalUvAxes::U),
    ] {
        let Some(case) = peer_case(name) else { return };
        let base = case.mesh("base");
        let layer = NormalUvSource::UvLayer { layer: Some("uv") };
        let component = evaluate_normals_uv(&case.mesh("component"), &layer, axes, &Fit::Bounds)
            .unwrap()
            .mesh;
        let directions = normals(&base);
        let array =
            array_components(&base, &[&component], &directions, &linear(), &Unmonitored).unwrap();
        assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
    }
}

#[test]
fn torus_joined_is_closed() {
    let Some(case) = peer_case("15_torus_closed_merge") else {
        return;
    };
    let array = run(
        &case,
        normals,
        &ArrayOptions {
            join: Join::Weld,
            ..linear()
        },
    );
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
    assert_closed(&array.mesh);
    assert_eq!(array.join.unwrap().open, 0);
}

#[test]
fn quarter_turns() {
    let Some(case) = peer_case("17_rotation_shift1") else {
        return;
    };
    let turns = vec![1; case.mesh("base").face_count()];
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        turns: Some(&turns),
        ..linear()
    };
    let array = run(&case, normals, &options);
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn clipped_component() {
    let Some(case) = peer_case("19b_bounds_clip") else {
        return;
    };
    let base = case.mesh("base");
    let fit = FitOptions {
        fit: Fit::Unit,
        x: Beyond::Clip,
        ..FitOptions::default()
    };
    let component = fit_component(&case.mesh("component"), &fit).unwrap();
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        ..linear()
    };
    let array = array_components(
        &base,
        &[&component],
        &normals(&base),
        &options,
        &Unmonitored,
    )
    .unwrap();
    // The add-on cuts the edges that only touch the line from outside, too: of
    // each 12 vertices two coincide with others, of 6 faces one has no area.
    let theirs = crate::weld_vertices(&case.mesh("tissue"), 1e-6, &Unmonitored).unwrap();
    assert_eq!(theirs.joined, welded(&array.mesh) + 16 * 2);
    let ours = crate::weld_vertices(&array.mesh, 1e-6, &Unmonitored).unwrap();
    assert_same_mesh(&ours.mesh, &theirs.mesh, TOLERANCE);
}

fn welded(mesh: &Mesh) -> usize {
    crate::weld_vertices(mesh, 1e-6, &Unmonitored)
        .unwrap()
        .joined
}

#[test]
fn thickness_by_a_vertex_field() {
    let Some(case) = peer_case("40_vg_thickness") else {
        return;
    };
    let weights = case.numbers("weights.csv");
    let values = weights.iter().map(|w| w * 0.8 + 0.2).collect();
    let field = Field::new(Domain::Vertex, Quantity::Number, values).unwrap();
    let scale = Amount::Field(field.into());
    let array = run(
        &case,
        normals,
        &ArrayOptions {
            scale: Some(&scale),
            ..linear()
        },
    );
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

/// The patches of a case: rows of vertices with v fastest, turned to u fastest.
fn grids(case: &PeerCase) -> PatchGrids {
    let mut grids = PatchGrids::new();
    for row in case.rows("grids.csv") {
        let side = (row.len() as f64).sqrt() as usize;
        let turned: Vec<u32> = (0..side * side)
            .map(|k| row[(k % side) * side + k / side])
            .collect();
        grids.push(Some((side as u32 - 1, &turned))).unwrap();
    }
    grids
}

#[test]
fn patches_of_a_subdivided_base() {
    let Some(case) = peer_case("11_patch_L2") else {
        return;
    };
    let base = case.mesh("base_cells");
    let grids = grids(&case);
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        domain: ArrayDomain::Parent(&grids),
        ..linear()
    };
    let component = case.mesh("component");
    let directions = normals(&base);
    let array =
        array_components(&base, &[&component], &directions, &options, &Unmonitored).unwrap();
    assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
}

#[test]
fn fans_and_frames_as_the_add_on_cut_them() {
    for (name, scale) in [("12_fan_hex", 1.0), ("13_frame_hex", 0.5)] {
        let Some(case) = peer_case(name) else { return };
        let (base, component) = (case.mesh("base_cells"), case.mesh("component"));
        let scale = Amount::Constant(scale);
        let options = ArrayOptions {
            scale: Some(&scale),
            ..linear()
        };
        let directions = normals(&base);
        let array =
            array_components(&base, &[&component], &directions, &options, &Unmonitored).unwrap();
        assert_same_mesh(&array.mesh, &case.mesh("tissue"), TOLERANCE);
    }
}
