//! Arrays taken apart: the formula over the parts is the array.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::normals::{NormalWeights, vertex_normals};
use crate::normals_uv::NORMAL_UV;
use crate::test_support::{cuboid, grid};
use crate::*;

fn base() -> Mesh {
    grid(6, 4, |x, y| {
        [x, 1.2 * y, 0.3 * math::sin(x + 0.5 * y) + 0.1 * x * y]
    })
}

/// Directions with another length below the surface.
fn two_sided(base: &Mesh) -> Directions {
    let outward = vertex_normals(base, NormalWeights::Angle, true, &Unmonitored).unwrap();
    let longer = (0u32..).zip(&outward);
    let inward = longer.map(|(v, n)| *n * (1.0 + 0.05 * f64::from(v)));
    let inward = inward.collect();
    let topology = Arc::clone(base.topology());
    let source = DirectionSource::Surface;
    Directions::from_parts(topology, outward, Some(inward), source, false).unwrap()
}

/// Both sides of the surface, and a ridge that leans over its neighbour.
fn component() -> Mesh {
    let mesh = cuboid(1.0, 1.0, -0.25, 0.5);
    let uv = mesh.positions().iter();
    let uv: Vec<DVec2> = uv.map(|p| DVec2::new(0.5 + 0.4 * p.x, p.y)).collect();
    let uv = Attribute::new(
        NORMAL_UV,
        Domain::Vertex,
        AttributeValues::Vector2(uv.into()),
    );
    mesh.with_attribute(uv).unwrap()
}

/// The array, and that of the same with all heights times `factor`.
fn assert_is_array(base: &Mesh, components: &[&Mesh], options: &ArrayOptions<'_>) {
    let directions = two_sided(base);
    let parts = array_parts(base, components, &directions, options, &Unmonitored).unwrap();
    for factor in [1.0, 1.75, 0.25] {
        let scale = match options.scale {
            None => Amount::Constant(factor),
            Some(Amount::Constant(number)) => Amount::Constant(number * factor),
            Some(Amount::Field(field)) => {
                Amount::Field(Arc::new(field.scaled(factor, field.quantity())))
            }
        };
        let options = ArrayOptions {
            scale: Some(&scale),
            ..*options
        };
        let array = array_components(base, components, &directions, &options, &Unmonitored);
        let array = array.unwrap().mesh;
        assert_eq!(parts.vertices.len(), array.vertex_count());
        for (vertex, place) in array.positions().iter().enumerate() {
            let found = parts.position(vertex, factor);
            assert!(
                found.distance(*place) < 1e-12,
                "{vertex}: {found}, not {place}"
            );
        }
    }
}

#[test]
fn the_formula_over_the_parts_is_the_array() {
    let (base, component) = (base(), component());
    let lid = grid(2, 2, |x, y| [x / 2.0, y / 2.0, 0.1 * (x - 1.0)]);
    let varied: Vec<f64> = (0..base.vertex_count())
        .map(|v| 0.5 + 0.1 * v as f64)
        .collect();
    let varied = Field::new(Domain::Vertex, Quantity::Number, varied).unwrap();
    let varied = Amount::Field(Arc::new(varied));
    for join in [Join::None, Join::Weld] {
        for interpolation in [Interpolation::Unit, Interpolation::Linear] {
            let plain = ArrayOptions {
                join,
                interpolation,
                ..ArrayOptions::default()
            };
            assert_is_array(&base, &[&component], &plain);
            let relative = ArrayOptions {
                height: Height::Relative,
                scale: Some(&varied),
                ..plain
            };
            assert_is_array(&base, &[&component], &relative);
            // Several components, some turned, some faces without one.
            let faces = 0..base.face_count();
            let choose: Vec<u32> = faces
                .clone()
                .map(|face| [0, 1, NO_COMPONENT][face % 3])
                .collect();
            let turns: Vec<u8> = faces.map(|face| (face % 4) as u8).collect();
            let several = ArrayOptions {
                choose: Some(&choose),
                turns: Some(&turns),
                scale: Some(&Amount::Constant(2.0)),
                ..plain
            };
            assert_is_array(&base, &[&component, &lid], &several);
        }
    }
}

#[test]
fn so_it_is_over_grids_of_several_sides() {
    let (base, component) = (base(), component());
    let mut grids = PatchGrids::new();
    let corner = |i: u32, j: u32| j * 7 + i;
    for (side, at) in [(2, (0, 0)), (1, (2, 0)), (2, (4, 2))] {
        let rows = (0..=side).flat_map(|j| (0..=side).map(move |i| (i, j)));
        let vertices: Vec<u32> = rows.map(|(i, j)| corner(at.0 + i, at.1 + j)).collect();
        grids.push(Some((side, &vertices))).unwrap();
    }
    for height in [Height::Absolute, Height::Relative] {
        let options = ArrayOptions {
            domain: ArrayDomain::Parent(&grids),
            height,
            ..ArrayOptions::default()
        };
        assert_is_array(&base, &[&component], &options);
    }
}

#[test]
fn directions_that_cancel_out_leave_the_point_in_the_surface() {
    let base = grid(1, 1, |x, y| [x, y, 0.0]);
    let across = vec![DVec3::X, -DVec3::X, DVec3::X, -DVec3::X];
    let directions = Directions::new(&base, across, DirectionSource::Surface).unwrap();
    let middle = Mesh::from_faces(
        vec![[0.5, 0.0, 0.1], [1.0, 0.5, 0.1], [0.0, 1.0, 0.1]],
        &[[0, 1, 2]],
    )
    .unwrap();
    let options = ArrayOptions {
        fit: Some(&Fit::Unit),
        ..ArrayOptions::default()
    };
    let parts = array_parts(&base, &[&middle], &directions, &options, &Unmonitored).unwrap();
    assert_eq!(parts.position(0, 1.0), DVec3::new(0.5, 0.0, 0.0));
}
