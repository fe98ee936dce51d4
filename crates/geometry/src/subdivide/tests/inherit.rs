//! Attributes, labels and what is left of sharpness.

use super::*;
use crate::mesh::{Labels, Material, NO_LABEL};
use glam::DVec2;

fn with<T>(mesh: Mesh, name: &str, domain: Domain, values: Vec<T>) -> Mesh
where
    T: Clone,
    AttributeValues: From2<T>,
{
    let attribute = Attribute::new(name, domain, AttributeValues::from2(values));
    mesh.with_attribute(attribute).expect("fits")
}

/// The attribute type of a Rust type.
trait From2<T> {
    fn from2(values: Vec<T>) -> Self;
}

impl From2<i64> for AttributeValues {
    fn from2(values: Vec<i64>) -> Self {
        Self::Integer(values.into())
    }
}

impl From2<f64> for AttributeValues {
    fn from2(values: Vec<f64>) -> Self {
        Self::Number(values.into())
    }
}

impl From2<DVec2> for AttributeValues {
    fn from2(values: Vec<DVec2>) -> Self {
        Self::Vector2(values.into())
    }
}

fn numbers(mesh: &Mesh, name: &str, domain: Domain) -> Vec<f64> {
    match mesh.attribute(name, domain).map(|a| a.values()) {
        Some(AttributeValues::Number(values)) => values.to_vec(),
        Some(AttributeValues::Integer(values)) => values.iter().map(|&v| v as f64).collect(),
        other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn vertex_attributes_move_like_positions() {
    for positions in [Positions::Refined, Positions::Limit] {
        for mesh in [cube(), mixed()] {
            let xs = mesh.positions().iter().map(|p| p.x).collect();
            let mesh = with(mesh, "x", Domain::Vertex, xs);
            for level in 0..=3 {
                let fine = run(
                    &mesh,
                    Options {
                        positions,
                        ..levels(level)
                    },
                )
                .mesh;
                let xs = numbers(&fine, "x", Domain::Vertex);
                for (x, p) in xs.iter().zip(fine.positions().iter()) {
                    assert!((x - p.x).abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn whole_numbers_come_from_the_nearest_vertex() {
    let mesh = with(mixed(), "id", Domain::Vertex, (0..10).collect::<Vec<i64>>());
    let scheme = Scheme::Bilinear;
    let fine = run(
        &mesh,
        Options {
            scheme,
            ..levels(3)
        },
    );
    let ids = numbers(&fine.mesh, "id", Domain::Vertex);
    let grid = fine.parents.whole_grid(1).expect("a quad");
    for (vertex, id) in [((1, 1), 1.0), ((7, 1), 3.0), ((7, 7), 4.0), ((1, 7), 2.0)] {
        assert_eq!(ids[grid.vertex(vertex.0, vertex.1) as usize], id);
    }
    let quad = [1.0, 3.0, 4.0, 2.0];
    assert!(
        grid.vertices()
            .all(|v| quad.contains(&ids[v as usize]) || !grid_inner(&grid, v))
    );
}

/// Whether a vertex is strictly inside a grid.
fn grid_inner(grid: &crate::subdivide::Grid<'_>, vertex: u32) -> bool {
    (1..grid.side()).any(|j| (1..grid.side()).any(|i| grid.vertex(i, j) == vertex))
}

#[test]
fn uv_is_bilinear_in_each_face_and_seams_stay() {
    // Every face has its own unit square, so all inner edges are seams.
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let mesh = with(cube(), "uv", Domain::Corner, square.repeat(6));
    let fine = run(&mesh, levels(3));
    let uv = match fine
        .mesh
        .attribute("uv", Domain::Corner)
        .map(|a| a.values())
    {
        Some(AttributeValues::Vector2(values)) => values,
        other => panic!("uv is {other:?}"),
    };
    for face in 0..fine.mesh.face_count() {
        let (_, [low, high]) = fine.parents.rectangle(face).expect("a grid");
        let expected = [
            low,
            DVec2::new(high.x, low.y),
            high,
            DVec2::new(low.x, high.y),
        ];
        assert_eq!(uv[4 * face..4 * face + 4], expected);
    }
}

#[test]
fn corner_values_of_polygons_meet_in_their_mean() {
    let mesh = mixed();
    let values: Vec<f64> = (0..mesh.corner_count()).map(|c| c as f64).collect();
    let fine = run(&with(mesh, "c", Domain::Corner, values), levels(2)).mesh;
    let values = numbers(&fine, "c", Domain::Corner);
    // The pentagon's corners 7..12 have the mean 9; each part's opposite corner.
    for part in 0..5 {
        let last = (12 + 16 + 4 * part + 3) * 4;
        assert!((values[last + 2] - 9.0).abs() < 1e-14);
        assert_eq!(values[(12 + 16 + 4 * part) * 4], 7.0 + part as f64);
    }
}

#[test]
fn labels_and_face_values_come_from_the_parent() {
    let materials = vec![Material::named("glass"), Material::named("steel")];
    let mesh = mixed()
        .with_materials(Labels::new(materials, vec![1, 0, NO_LABEL, 0]).expect("valid"))
        .expect("one per face");
    let mesh = with(mesh, "load", Domain::Face, vec![1.5, 2.5, 3.5, 4.5]);
    let fine = run(&mesh, levels(2));
    let loads = numbers(&fine.mesh, "load", Domain::Face);
    for (face, load) in loads.iter().enumerate() {
        let parent = fine.parents.patch_of(face);
        assert_eq!(*load, parent as f64 + 1.5);
        assert_eq!(
            fine.mesh.materials().get(face),
            mesh.materials().get(parent)
        );
    }
}

#[test]
fn levels_add_up() {
    let creases = with_creases(mixed(), &[([1, 2], 2.3), ([2, 4], 12.0), ([4, 3], 0.4)]);
    for mesh in [
        with_corners(creases, &[(4, 1.6)]),
        with_creases(cube(), &[([0, 1], 2.5), ([1, 5], 1.2)]),
    ] {
        let once = run(&mesh, levels(3)).mesh;
        let twice = run(&run(&mesh, levels(1)).mesh, levels(2)).mesh;
        assert_eq!(once.vertex_count(), twice.vertex_count());
        assert!(set_distance(once.positions(), twice.positions()) < 1e-13);
        let total =
            |mesh: &Mesh, name, domain| numbers(mesh, name, domain).iter().fold(0.0, |a, b| a + b);
        let (a, b) = (
            total(&once, CREASE, Domain::Corner),
            total(&twice, CREASE, Domain::Corner),
        );
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn sharpness_runs_out_except_where_it_is_infinite() {
    let mesh = with_corners(
        with_creases(cube(), &[([0, 1], 2.5), ([1, 5], 10.0)]),
        &[(3, 1.5)],
    );
    let fine = run(&mesh, levels(2)).mesh;
    let creases = numbers(&fine, CREASE, Domain::Corner);
    // Two faces, four parts each.
    assert_eq!(creases.iter().filter(|&&s| s == 0.5).count(), 8);
    assert_eq!(creases.iter().filter(|&&s| s == 10.0).count(), 8);
    assert_eq!(creases.iter().filter(|&&s| s == 0.0).count(), 4 * 96 - 16);
    assert!(
        numbers(&fine, CORNER_SHARPNESS, Domain::Vertex)
            .iter()
            .all(|&s| s == 0.0)
    );
    let scheme = Scheme::Bilinear;
    let kept = run(
        &mesh,
        Options {
            scheme,
            ..levels(2)
        },
    )
    .mesh;
    let creases = numbers(&kept, CREASE, Domain::Corner);
    assert_eq!(creases.iter().filter(|&&s| s == 2.5).count(), 8);
}
