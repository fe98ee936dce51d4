//! Closed forms and invariances of the mapping.

use glam::{DQuat, DVec2, DVec3};
use proptest::prelude::*;

use crate::normals::{NormalWeights, vertex_normals};
use crate::test_support::{assert_closed, assert_same_mesh, cuboid, grid, torus, volume};
use crate::*;

fn normals(base: &Mesh) -> Directions {
    let normals = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).unwrap();
    Directions::new(base, normals, DirectionSource::Surface).unwrap()
}

fn array(base: &Mesh, component: &Mesh, options: &ArrayOptions<'_>) -> Mesh {
    array_components(base, &[component], &normals(base), options, &Unmonitored)
        .unwrap()
        .mesh
}

fn wavy(nx: u32, ny: u32) -> Mesh {
    grid(nx, ny, |x, y| [x, y, 0.3 * math::sin(x + 0.5 * y)])
}

#[test]
fn a_joined_plate_has_the_volume_of_its_plane_at_any_tilt() {
    let component = cuboid(2.0, 1.0, -0.25, 0.5);
    for (axis, angle) in [
        (DVec3::X, 0.0),
        (DVec3::Y, 0.7),
        (DVec3::new(0.6, 0.0, 0.8), 2.5),
    ] {
        let turn = DQuat::from_axis_angle(axis, angle);
        let base = grid(4, 3, |x, y| (turn * DVec3::new(2.0 * x, y, 0.0)).to_array());
        // Boxes keep their walls: each is a closed solid of 2 x 1 x 0.75.
        let result = array(&base, &component, &ArrayOptions::default());
        assert!((volume(&result) - 24.0 * 0.75).abs() < 1e-11);
    }
}

#[test]
fn unit_interpolation_keeps_the_thickness_of_a_cylinder() {
    // Eight faces round: linear interpolation loses 1 - cos(22.5 degrees) at mid face.
    let ring = |k: f64| math::TAU * k / 8.0;
    let base = grid(8, 1, |x, y| [math::cos(ring(x)), math::sin(ring(x)), y]);
    let radial = base
        .positions()
        .iter()
        .map(|p| DVec3::new(p.x, p.y, 0.0))
        .collect();
    let directions = Directions::new(&base, radial, DirectionSource::Surface).unwrap();
    let component = grid(2, 1, |x, y| [x / 2.0, y, 0.1]);
    for (interpolation, expected) in [
        (Interpolation::Unit, 0.1),
        (Interpolation::Linear, 0.1 * math::cos(math::TAU / 16.0)),
    ] {
        let options = ArrayOptions {
            interpolation,
            fit: Some(&Fit::Unit),
            ..ArrayOptions::default()
        };
        let result = array_components(&base, &[&component], &directions, &options, &Unmonitored);
        let middle = result.unwrap().mesh.positions()[1];
        let foot = DVec3::new(1.0 + math::cos(ring(1.0)), math::sin(ring(1.0)), 0.0) / 2.0;
        assert!((middle.distance(foot) - expected).abs() < 1e-12);
    }
}

#[test]
fn relative_height_scales_with_the_base() {
    let component = cuboid(0.5, 0.5, -0.1, 0.3);
    let options = ArrayOptions {
        height: Height::Relative,
        ..ArrayOptions::default()
    };
    let small = wavy(4, 3);
    let large = small
        .with_positions(small.positions().iter().map(|p| *p * 7.0).collect())
        .unwrap();
    let ours = array(&large, &component, &options);
    let scaled = array(&small, &component, &options);
    let scaled = scaled.with_positions(scaled.positions().iter().map(|p| *p * 7.0).collect());
    assert_same_mesh(&ours, &scaled.unwrap(), 1e-12);
    // On unit cells a component of unit box is as drawn.
    let flat = grid(3, 3, |x, y| [x, y, 0.0]);
    let tile = cuboid(1.0, 1.0, 0.0, 0.25);
    let relative = array(&flat, &tile, &options);
    assert_same_mesh(
        &relative,
        &array(&flat, &tile, &ArrayOptions::default()),
        1e-12,
    );
}

#[test]
fn inward_directions_are_for_negative_heights() {
    let base = grid(1, 1, |x, y| [x, y, 0.0]);
    let up = Directions::new(&base, vec![DVec3::Z; 4], DirectionSource::Surface).unwrap();
    let directions = up
        .compensated(vec![DVec3::Z * 2.0; 4], vec![DVec3::Z * 3.0; 4])
        .unwrap();
    let component = cuboid(1.0, 1.0, -0.1, 0.1);
    let options = ArrayOptions::default();
    let result = array_components(&base, &[&component], &directions, &options, &Unmonitored);
    let (low, high) = result.unwrap().mesh.bounds().unwrap();
    assert!((low.z + 0.3).abs() < 1e-15 && (high.z - 0.2).abs() < 1e-15);
}

struct Twice;

impl Displace for Twice {
    fn height(&self, point: &ArrayPoint) -> f64 {
        assert!((point.normal.length() - 1.0).abs() < 1e-12);
        assert!(point.normal.dot(point.direction) > 0.99 * point.direction.length());
        2.0 * point.height
    }
}

#[test]
fn a_displacement_decides_on_every_point() {
    let (base, component) = (wavy(3, 2), cuboid(1.0, 1.0, -0.1, 0.2));
    let directions = normals(&base);
    let options = ArrayOptions::default();
    let twice = array_components_with(
        &base,
        &[&component],
        &directions,
        &options,
        &Twice,
        &Unmonitored,
    );
    let double = Amount::Constant(2.0);
    let scaled = ArrayOptions {
        scale: Some(&double),
        ..options
    };
    assert_same_mesh(
        &twice.unwrap().mesh,
        &array(&base, &component, &scaled),
        1e-14,
    );
    let vectors = directions.outward().to_vec();
    let compensated = directions.compensated(vectors.clone(), vectors).unwrap();
    let refused = array_components_with(
        &base,
        &[&component],
        &compensated,
        &options,
        &Twice,
        &Unmonitored,
    );
    assert!(matches!(refused, Err(GeometryError::Invalid(_))));
}

#[test]
fn provenance_and_labels_follow_the_component() {
    let ids = AttributeValues::Integer(vec![70, 80, 90].into());
    let base = grid(3, 1, |x, y| [x, y, 0.0])
        .with_attribute(Attribute::new(PANEL, Domain::Face, ids))
        .unwrap();
    let height = AttributeValues::Number((0..8).map(f64::from).collect());
    let base = base
        .with_attribute(Attribute::new("height", Domain::Vertex, height))
        .unwrap();
    let corner = AttributeValues::Number((0..12).map(f64::from).collect());
    let base = base
        .with_attribute(Attribute::new("c", Domain::Corner, corner))
        .unwrap();
    let label = |name: &str| Labels::new(vec![Material::named(name)], vec![0; 6]).unwrap();
    let glass = cuboid(1.0, 1.0, 0.0, 0.1)
        .with_materials(label("glass"))
        .unwrap();
    let tint = AttributeValues::Number(vec![0.5; 6].into());
    let steel = cuboid(1.0, 1.0, 0.0, 0.1)
        .with_materials(label("steel"))
        .unwrap()
        .with_attribute(Attribute::new("tint", Domain::Face, tint))
        .unwrap();
    let names = ["height".to_owned(), "c".to_owned()];
    let choose = [1, NO_COMPONENT, 0];
    let options = ArrayOptions {
        choose: Some(&choose),
        carry: &names,
        ..ArrayOptions::default()
    };
    let result = array_components(
        &base,
        &[&glass, &steel],
        &normals(&base),
        &options,
        &Unmonitored,
    )
    .unwrap()
    .mesh;
    let integers = |name: &str| match result.attribute(name, Domain::Face).unwrap().values() {
        AttributeValues::Integer(values) => [values[0], values[5], values[6], values[11]],
        other => panic!("{}", other.type_name()),
    };
    assert_eq!(integers(BASE_FACE), [0, 0, 2, 2]);
    assert_eq!(integers(COMPONENT_FACE), [0, 5, 0, 5]);
    assert_eq!(integers(PANEL), [70, 70, 90, 90]);
    assert_eq!(integers(COMPONENT), [1, 1, 0, 0]);
    assert_eq!(result.materials().get(0).unwrap().name, "steel");
    assert_eq!(result.materials().get(6).unwrap().name, "glass");
    let numbers = |name: &str, domain| match result.attribute(name, domain).unwrap().values() {
        AttributeValues::Number(values) => values.to_vec(),
        other => panic!("{}", other.type_name()),
    };
    assert_eq!(numbers("tint", Domain::Face)[5..7], [0.5, 0.0]);
    // Vertices 2 3 7 6 are the corners of the last face.
    assert_eq!(
        numbers("height", Domain::Vertex)[8..12],
        [2.0, 3.0, 7.0, 6.0]
    );
    // The component's first face is [3, 2, 1, 0], over corners 11 10 9 8.
    assert_eq!(numbers("c", Domain::Corner)[24..28], [11.0, 10.0, 9.0, 8.0]);
}

#[test]
fn what_cannot_be_arrayed_is_refused_by_name() {
    let pentagon = Mesh::from_faces(
        vec![
            [0., 0., 0.],
            [2., 0., 0.],
            [3., 1., 0.],
            [1., 2., 0.],
            [0., 1., 0.],
        ],
        &[&[0, 1, 2, 3, 4]],
    )
    .unwrap();
    let tile = cuboid(1.0, 1.0, 0.0, 0.1);
    let run = |base: &Mesh, components: &[&Mesh], options: &ArrayOptions<'_>| {
        array_components(base, components, &normals(base), options, &Unmonitored)
    };
    let plain = ArrayOptions::default();
    let error = run(&pentagon, &[&tile], &plain).unwrap_err();
    assert!(matches!(
        error,
        GeometryError::NotQuad {
            face: 0,
            corners: 5,
            ..
        }
    ));
    // A face that takes nothing may have any number of corners.
    let nothing = ArrayOptions {
        choose: Some(&[NO_COMPONENT]),
        ..plain
    };
    assert_eq!(
        run(&pentagon, &[&tile], &nothing)
            .unwrap()
            .mesh
            .vertex_count(),
        0
    );
    let base = grid(2, 1, |x, y| [x, y, 0.0]);
    assert!(matches!(
        run(&base, &[], &plain),
        Err(GeometryError::Empty { .. })
    ));
    let other = ArrayOptions {
        choose: Some(&[0, 3]),
        ..plain
    };
    let error = run(&base, &[&tile], &other).unwrap_err().to_string();
    assert!(
        error.contains("face 1") && error.contains("component 3"),
        "{error}"
    );
    let thin =
        Mesh::from_faces(vec![[0., 0., 0.], [1., 0., 0.], [1., 0., 1.]], &[[0, 1, 2]]).unwrap();
    let relative = ArrayOptions {
        height: Height::Relative,
        ..plain
    };
    assert!(matches!(
        run(&base, &[&thin], &relative),
        Err(GeometryError::Empty { .. })
    ));
}

#[test]
fn vertices_without_direction_are_refused_unless_allowed() {
    let (base, tile) = (grid(2, 1, |x, y| [x, y, 0.0]), cuboid(1.0, 1.0, 0.0, 0.1));
    let plain = ArrayOptions::default();
    let directions =
        Directions::new(&base, vec![DVec3::ZERO; 6], DirectionSource::Surface).unwrap();
    let zero = array_components(&base, &[&tile], &directions, &plain, &Unmonitored);
    assert!(matches!(zero, Err(GeometryError::ZeroDirection { .. })));
    let allowed = ArrayOptions {
        allow_zero_directions: true,
        ..plain
    };
    let flat = array_components(&base, &[&tile], &directions, &allowed, &Unmonitored).unwrap();
    assert_eq!(flat.mesh.bounds().unwrap().1, DVec3::new(2.0, 1.0, 0.0));
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let (base, component) = (torus(60, 40, 3.0, 1.0), cuboid(1.0, 1.0, -0.1, 0.2));
    let options = ArrayOptions {
        join: Join::Weld,
        ..ArrayOptions::default()
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| array(&base, &component, &options)).digest()
    };
    assert_eq!(on(1), on(5));
}

fn motion() -> impl Strategy<Value = (DQuat, DVec3)> {
    let unit = prop::array::uniform3(-1.0..1.0f64);
    (unit.clone(), 0.0..6.0f64, unit).prop_map(|(axis, angle, shift)| {
        let axis = (DVec3::from(axis) + DVec3::new(0.0, 0.0, 2.0)).normalize();
        (
            DQuat::from_axis_angle(axis, angle),
            DVec3::from(shift) * 10.0,
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn moving_the_base_moves_the_array((turn, shift) in motion(), linear: bool) {
        let base = wavy(3, 4);
        let moved = |mesh: &Mesh| {
            mesh.with_positions(mesh.positions().iter().map(|p| turn * *p + shift).collect()).unwrap()
        };
        let interpolation = if linear { Interpolation::Linear } else { Interpolation::Unit };
        let options = ArrayOptions { interpolation, height: Height::Relative, ..ArrayOptions::default() };
        let component = cuboid(1.5, 0.5, -0.3, 0.2);
        let ours = array(&moved(&base), &component, &options);
        assert_same_mesh(&ours, &moved(&array(&base, &component, &options)), 1e-12);
    }

    #[test]
    fn the_order_of_faces_orders_the_output(seed in any::<u64>()) {
        let base = wavy(3, 4);
        let ids: Vec<i64> = (0..12).collect();
        let keys = choose_random(&ids, &[1.0; 97], seed).unwrap();
        let mut order: Vec<u32> = (0..12).collect();
        order.sort_by_key(|&face| keys[face as usize]);
        let shuffled = rebuild::keep_faces(&base, order.clone()).unwrap();
        let component = cuboid(1.0, 1.0, -0.1, 0.2);
        // The same normals for both: sums in another order differ by rounding.
        let vectors = normals(&base).outward().to_vec();
        let on = |base: &Mesh, options: &ArrayOptions<'_>| {
            let normals = Directions::new(base, vectors.clone(), DirectionSource::Surface).unwrap();
            array_components(base, &[&component], &normals, options, &Unmonitored).unwrap().mesh
        };
        for join in [Join::None, Join::Weld] {
            let options = ArrayOptions { join, ..ArrayOptions::default() };
            let (ours, plain) = (on(&shuffled, &options), on(&base, &options));
            assert_same_mesh(&ours, &plain, 1e-12);
        }
        let options = ArrayOptions::default();
        let (ours, plain) = (on(&shuffled, &options), on(&base, &options));
        for (k, &face) in order.iter().enumerate() {
            let run = face as usize * 8..face as usize * 8 + 8;
            prop_assert_eq!(&ours.positions()[k * 8..k * 8 + 8], &plain.positions()[run]);
        }
    }

    #[test]
    fn normal_uv_equal_to_uv_changes_nothing(places in prop::collection::vec(prop::array::uniform3(-0.5..1.5f64), 9)) {
        let plain = grid(2, 2, |x, y| places[(x + 3.0 * y) as usize]);
        let uv = plain.positions().iter().map(|p| p.truncate()).collect();
        let same = Attribute::new(NORMAL_UV, Domain::Vertex, AttributeValues::Vector2(uv));
        let given = plain.clone().with_attribute(same).unwrap();
        let options = ArrayOptions { fit: Some(&Fit::Unit), ..ArrayOptions::default() };
        let base = wavy(2, 2);
        let ours = array(&base, &given, &options);
        prop_assert_eq!(ours.digest(), array(&base, &plain, &options).digest());
    }

    #[test]
    fn collapsing_moves_in_parallel(to in prop::array::uniform2(0.0..1.0f64)) {
        let base = wavy(3, 3);
        let component = cuboid(1.0, 1.0, 0.0, 0.4);
        let to = Some(DVec2::from(to));
        let source = NormalUvSource::Collapse { part: Part::All, to };
        let given = evaluate_normals_uv(&component, &source, NormalUvAxes::Both, &Fit::Bounds).unwrap();
        let ours = array(&base, &given.mesh, &ArrayOptions::default());
        for panel in ours.positions().chunks(8) {
            let moves: Vec<DVec3> = (0..4).map(|k| panel[k + 4] - panel[k]).collect();
            prop_assert!(moves.iter().all(|m| (*m - moves[0]).length() < 1e-14));
            prop_assert!((moves[0].length() - 0.4).abs() < 0.02);
        }
    }
}

#[test]
fn a_closed_component_stays_closed() {
    let result = array(
        &wavy(5, 5),
        &cuboid(1.0, 1.0, -0.1, 0.1),
        &ArrayOptions::default(),
    );
    assert_closed(&result);
}
