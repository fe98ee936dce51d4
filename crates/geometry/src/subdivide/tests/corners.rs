//! Texture coordinates that are rounded like the surface.

use glam::DVec2;

use super::*;

/// The mesh with a pair for each corner, by corner and vertex.
fn with_uv(mesh: &Mesh, of: impl Fn(usize, u32) -> DVec2) -> Mesh {
    let corners = mesh.topology().corners().iter().enumerate();
    let values = corners
        .map(|(corner, &vertex)| of(corner, vertex))
        .collect();
    let attribute = Attribute::new("uv", Domain::Corner, AttributeValues::Vector2(values));
    mesh.clone()
        .with_attribute(attribute)
        .expect("one per corner")
}

fn uv(mesh: &Mesh) -> Vec<DVec2> {
    match mesh.attribute("uv", Domain::Corner).map(Attribute::values) {
        Some(AttributeValues::Vector2(values)) => values.to_vec(),
        other => panic!("{other:?}"),
    }
}

fn smooth(level: u32) -> Options {
    Options {
        uv: CornerRule::Smooth,
        ..levels(level)
    }
}

#[test]
fn coordinates_that_are_places_stay_places() {
    // Of polygons and of quads, with creases, refined and on the limit.
    let creased = with_creases(mixed(), &[([1, 2], 1.5), ([2, 4], 3.0)]);
    let quads = crate::test_support::grid(4, 3, |x, y| [x + 0.2 * y * y, y - 0.1 * x * y, x * y]);
    for mesh in [mixed(), creased, quads, cube()] {
        let places = mesh.positions().to_vec();
        let mesh = with_uv(&mesh, |_, vertex| places[vertex as usize].truncate());
        for positions in [Positions::Refined, Positions::Limit] {
            for level in 1..=3 {
                let options = Options {
                    positions,
                    ..smooth(level)
                };
                let fine = run(&mesh, options).mesh;
                let corners = fine.topology().corners().iter();
                for (found, &vertex) in uv(&fine).iter().zip(corners) {
                    let place = fine.positions()[vertex as usize].truncate();
                    assert!((*found - place).length() < 1e-13, "{found} {place}");
                }
            }
        }
        // Linear ones do not follow the surface.
        let fine = run(&mesh, levels(2)).mesh;
        let corners = fine.topology().corners().iter();
        let found = uv(&fine);
        let off = found.iter().zip(corners).filter(|(found, vertex)| {
            (**found - fine.positions()[**vertex as usize].truncate()).length() > 1e-3
        });
        assert!(off.count() > 0);
    }
}

#[test]
fn seams_are_borders_with_their_corners() {
    // Every face of a cube is an island: a square alone, whose sides stay straight.
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let islands = with_uv(&cube(), |corner, _| {
        square[corner % 4] + DVec2::X * (corner / 4) as f64
    });
    let alone = Mesh::from_faces(square.map(|p| [p.x, p.y, 0.0]).to_vec(), &[[0, 1, 2, 3]]);
    let alone = run(&alone.expect("a square"), levels(3)).mesh;
    let fine = run(&islands, smooth(3)).mesh;
    for (face, found) in uv(&fine).chunks(4).enumerate() {
        let (island, cell) = (face / 64, face % 64);
        for (found, &vertex) in found.iter().zip(alone.face(cell)) {
            let place = alone.positions()[vertex as usize].truncate();
            let expected = place + DVec2::X * island as f64;
            assert!((*found - expected).length() < 1e-13, "{found} {expected}");
        }
    }
}
