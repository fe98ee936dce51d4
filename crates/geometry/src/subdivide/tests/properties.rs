//! Motion, scale and numbering do not change the shape.

use proptest::prelude::*;

use super::*;
use crate::primitives::grid;
use glam::{DAffine3, DQuat, DVec2};

/// A bent 3 × 2 grid with a few faces missing or merged, and sharp edges.
fn bent() -> impl Strategy<Value = Mesh> {
    let heights = prop::collection::vec(-0.4..0.4f64, 12);
    let sharp = prop::collection::vec((0u32..12, 0u32..12, 0.0..3.0f64), 6);
    let edited = (0usize..6, any::<bool>());
    (heights, sharp, edited).prop_map(|(heights, sharp, (gone, triangle))| {
        let flat = grid([3, 2], DVec2::new(3.0, 2.0), false).expect("valid");
        let positions = flat
            .positions()
            .iter()
            .zip(&heights)
            .map(|(p, z)| [p.x + z * 0.3, p.y, *z])
            .collect();
        let mut faces: Vec<Vec<u32>> = flat.topology().faces().map(<[u32]>::to_vec).collect();
        if triangle {
            faces[gone].truncate(3);
        } else {
            faces.remove(gone);
        }
        let mesh = Mesh::from_faces(positions, &faces).expect("valid");
        let creases: Vec<_> = sharp.iter().map(|&(a, b, s)| ([a, b], s)).collect();
        with_corners(with_creases(mesh, &creases), &[(sharp[0].0, sharp[0].2)])
    })
}

fn options() -> impl Strategy<Value = Options> {
    (0u32..4, any::<bool>(), any::<bool>(), any::<bool>()).prop_map(|(level, a, b, c)| Options {
        levels: level,
        uv: CornerRule::Linear,
        scheme: if c {
            Scheme::CatmullClark
        } else {
            Scheme::Bilinear
        },
        boundary: if a {
            Boundary::EdgeOnly
        } else {
            Boundary::EdgeAndCorner
        },
        positions: if b {
            Positions::Limit
        } else {
            Positions::Refined
        },
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn moving_then_subdividing_is_subdividing_then_moving(
        mesh in bent(),
        options in options(),
        angle in -3.0..3.0f64,
        shift in -50.0..50.0f64,
        scale in 0.1..10.0f64,
    ) {
        let motion = DAffine3::from_scale_rotation_translation(
            DVec3::splat(scale),
            DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -2.0) / 3.0, angle),
            DVec3::new(shift, -shift, 2.0 * shift),
        );
        let moved = |mesh: &Mesh| -> Mesh {
            let positions = mesh.positions().iter().map(|&p| motion.transform_point3(p)).collect();
            mesh.with_positions(positions).expect("finite")
        };
        let before = run(&moved(&mesh), options).mesh;
        let after = moved(&run(&mesh, options).mesh);
        for (a, b) in before.positions().iter().zip(after.positions().iter()) {
            prop_assert!(a.distance(*b) < 1e-11, "{} {}", a, b);
        }
    }

    #[test]
    fn renumbering_changes_order_only(
        mesh in bent(),
        options in options(),
        turn in 0usize..4,
        step in prop::sample::select(vec![1u32, 5, 7, 11]),
    ) {
        // Vertex v becomes step·v + 3 mod 12; faces are reversed in order and
        // each starts elsewhere.
        let rename = |v: u32| (step * v + 3) % 12;
        let mut positions = vec![[0.0; 3]; 12];
        for (v, p) in (0u32..).zip(mesh.positions().iter()) {
            positions[rename(v) as usize] = p.to_array();
        }
        let (mut faces, mut creases) = (Vec::new(), Vec::new());
        let attribute = |name, domain| match mesh.attribute(name, domain).map(|a| a.values()) {
            Some(AttributeValues::Number(values)) => values.to_vec(),
            _ => Vec::new(),
        };
        let sharp = attribute(CREASE, Domain::Corner);
        for face in (0..mesh.face_count()).rev() {
            let start = mesh.topology().corner_range(face).start;
            let vertices = mesh.face(face);
            let n = vertices.len();
            faces.push((0..n).map(|k| rename(vertices[(k + turn) % n])).collect::<Vec<_>>());
            creases.extend((0..n).map(|k| sharp[start + (k + turn) % n]));
        }
        let values = AttributeValues::Number(creases.into());
        let corners: Vec<_> = (0u32..)
            .zip(attribute(CORNER_SHARPNESS, Domain::Vertex))
            .map(|(v, s)| (rename(v), s))
            .collect();
        let other = Mesh::from_faces(positions, &faces)
            .and_then(|mesh| mesh.with_attribute(Attribute::new(CREASE, Domain::Corner, values)))
            .expect("valid");
        let a = run(&mesh, options).mesh;
        let b = run(&with_corners(other, &corners), options).mesh;
        prop_assert_eq!(a.vertex_count(), b.vertex_count());
        prop_assert!(set_distance(a.positions(), b.positions()) < 1e-12);
    }
}
