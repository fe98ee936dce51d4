//! Pictures whose pixels are known, and the same bytes for any number of threads.

use tessgraph_geometry::glam::DVec3;
use tessgraph_geometry::{Domain, Field, Labels, Material, Mesh, Quantity, Unmonitored};

use super::*;

fn square(height: f64) -> (Vec<[f64; 3]>, [u32; 4]) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    (corners.map(|[x, y]| [x, y, height]).to_vec(), [0, 1, 2, 3])
}

/// Unit squares over each other, each with a material of its own.
fn stack(colors: &[[f64; 3]]) -> Mesh {
    let mut places = Vec::new();
    let mut faces = Vec::new();
    for (k, _) in colors.iter().enumerate() {
        let (corners, face) = square(k as f64);
        faces.push(face.map(|corner| corner + places.len() as u32));
        places.extend(corners);
    }
    let faces: Vec<&[u32]> = faces.iter().map(|face| &face[..]).collect();
    let materials = colors.iter().enumerate().map(|(k, [red, green, blue])| {
        let mut material = Material::named(format!("{k}"));
        material.base_color = [*red, *green, *blue, 1.0];
        material
    });
    let of_face = (0..colors.len() as u32).collect();
    let materials = Labels::new(materials.collect(), of_face).unwrap();
    Mesh::from_faces(places, &faces)
        .unwrap()
        .with_materials(materials)
        .unwrap()
}

fn seen(mesh: &Mesh, options: &DrawOptions<'_>) -> Picture {
    draw(mesh, options, &Unmonitored).unwrap()
}

fn pixel(picture: &Picture, x: u32, y: u32) -> [u8; 3] {
    let at = 3 * (y * picture.size[0] + x) as usize;
    picture.pixels[at..at + 3].try_into().unwrap()
}

const SMALL: DrawOptions<'_> = DrawOptions {
    size: [100, 100],
    view: View::Top,
    paint: Paint::Materials,
    edges: false,
};

#[test]
fn what_is_nearer_to_the_eye_is_seen() {
    let mesh = stack(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let from = |view| pixel(&seen(&mesh, &DrawOptions { view, ..SMALL }), 50, 50);
    let (above, below) = (from(View::Top), from(View::Bottom));
    assert!(above[1] > 200 && above[0] == 0, "{above:?}");
    // And darker, for it is seen from behind.
    assert!((120..220).contains(&below[0]) && below[1] == 0, "{below:?}");
}

#[test]
fn a_square_fills_the_picture_but_for_the_margin() {
    let picture = seen(&stack(&[[0.0; 3]]), &SMALL);
    let dark = |x, y| pixel(&picture, x, y)[0] < 128;
    for k in [4, 50, 95] {
        assert!(dark(k, 50) && dark(50, k), "{k}");
    }
    for k in [1, 98] {
        assert!(!dark(k, 50) && !dark(50, k), "{k}");
    }
    // 94 pixels each way.
    let covered = (0..100).filter(|&x| dark(x, 50)).count();
    assert_eq!(covered, 94);
}

#[test]
fn a_wide_mesh_is_not_stretched() {
    let (mut corners, face) = square(0.0);
    corners.iter_mut().for_each(|corner| corner[0] *= 4.0);
    let mesh = Mesh::from_faces(corners, &[&face]).unwrap();
    let picture = seen(&mesh, &SMALL);
    let ink = |x, y| pixel(&picture, x, y) != PAPER;
    let (across, down) = (
        (0..100).filter(|&x| ink(x, 50)).count(),
        (0..100).filter(|&y| ink(50, y)).count(),
    );
    assert!(
        across == 94 && down.abs_diff(94 / 4) <= 1,
        "{across} x {down}"
    );
}

#[test]
fn edges_of_polygons_are_drawn_and_not_those_of_triangles() {
    let picture = seen(
        &stack(&[[1.0; 3]]),
        &DrawOptions {
            edges: true,
            ..SMALL
        },
    );
    let bright = |x, y| pixel(&picture, x, y)[0] > 230;
    // The diagonal that cuts the square is not seen; its sides are.
    assert!((10..90).all(|k| bright(k, k) && bright(k, 99 - k)));
    assert!(!bright(50, 3) && !bright(3, 50) && !bright(50, 96) && !bright(96, 50));
}

#[test]
fn a_field_runs_from_dark_blue_to_yellow() {
    let (corners, face) = square(0.0);
    let mesh = Mesh::from_faces(corners, &[&face]).unwrap();
    let values = vec![0.0, 1.0, 1.0, 0.0];
    let field = Field::new(Domain::Vertex, Quantity::Length, values).unwrap();
    let paint = Paint::Field(FieldPaint {
        field: &field,
        title: "x [mm]",
        range: None,
        factor: 1000.0,
    });
    let options = DrawOptions {
        size: [400, 400],
        paint,
        ..SMALL
    };
    let picture = seen(&mesh, &options);
    let [low, high] = [60, 340].map(|x| pixel(&picture, x, 150));
    assert!(
        low[2] > low[1] && high[1] > high[2] && high[1] > 180,
        "{low:?} {high:?}"
    );
    // Below stands the legend: its bar has all colours in order.
    let bar = [30, 200, 370].map(|x| pixel(&picture, x, 400 - 74 + 34));
    assert!(
        bar[0][2] > bar[0][1] && bar[2][0] > 200 && bar[1] != PAPER,
        "{bar:?}"
    );
    let other = Field::new(Domain::Face, Quantity::Number, vec![1.0; 2]).unwrap();
    let paint = Paint::Field(FieldPaint {
        field: &other,
        title: "",
        range: None,
        factor: 1.0,
    });
    assert!(draw(&mesh, &DrawOptions { paint, ..SMALL }, &Unmonitored).is_err());
}

#[test]
fn hollows_are_darker_than_planes() {
    // A floor and a wall at its far side, seen from the front and above.
    let places = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    let mesh = Mesh::from_faces(places, &[&[0, 1, 2, 3], &[3, 2, 4, 5]]).unwrap();
    let view = View::From(DVec3::new(0.0, -1.0, 1.0));
    let size = [400, 400];
    let picture = seen(
        &mesh,
        &DrawOptions {
            view,
            size,
            ..SMALL
        },
    );
    // The joint is in the middle of the picture.
    let (open, joint) = (pixel(&picture, 200, 330), pixel(&picture, 200, 202));
    assert!(open[0] > joint[0] + 15, "{open:?} {joint:?}");
}

#[test]
fn nothing_and_points_give_empty_pictures() {
    for places in [
        vec![],
        vec![[0.0; 3]],
        vec![[1e300, 0.0, 0.0], [-1e300, 0.0, 0.0]],
    ] {
        let mesh = Mesh::from_faces::<[u32; 3]>(places, &[]).unwrap();
        let picture = seen(&mesh, &SMALL);
        assert!(picture.pixels.iter().all(|&byte| byte == 255));
    }
}

#[test]
fn vast_and_flat_meshes_are_drawn_without_a_panic() {
    for scale in [1e-300, 1e-12, 1e12, 1e150, 1e308] {
        let (mut corners, face) = square(0.5);
        corners.iter_mut().flatten().for_each(|part| *part *= scale);
        let mesh = Mesh::from_faces(corners, &[&face]).unwrap();
        for name in View::NAMES {
            let view = name.parse().unwrap();
            seen(&mesh, &DrawOptions { view, ..SMALL });
        }
    }
}

#[test]
fn views_have_names_and_directions() {
    for name in View::NAMES {
        let view: View = name.parse().unwrap();
        assert!((view.direction().length() - 1.0).abs() < 1e-15);
    }
    assert_eq!("0,0,3".parse::<View>().unwrap().direction(), DVec3::Z);
    for wrong in ["", "0,0,0", "1,2", "1,2,nan", "sideways", "1,2,3,4"] {
        let error = wrong.parse::<View>().unwrap_err().to_string();
        assert!(
            error.contains("iso") && error.contains("1,-2,0.5"),
            "{error}"
        );
    }
}

#[test]
fn sizes_that_make_no_picture_are_refused() {
    let mesh = stack(&[[1.0; 3]]);
    for size in [[0, 100], [100, 15], [LARGEST + 1, 100]] {
        let error = draw(&mesh, &DrawOptions { size, ..SMALL }, &Unmonitored).unwrap_err();
        assert!(error.to_string().contains("16 to 16384"), "{error}");
    }
}

#[test]
fn numbers_are_told_in_four_digits() {
    let told = [
        0.0, 0.12345, 12.3456, 999.96, 1234.5, -0.5, 2.0, 1e-9, 123_456.7, 1e9,
    ];
    let told = told.map(legend::short).join(" ");
    assert_eq!(
        told,
        "0 0.1235 12.35 1000 1234 -0.5 2 1.000e-9 123457 1.000e9"
    );
}

#[test]
fn the_number_of_threads_makes_no_difference() {
    let mesh = stack(&[[0.9, 0.2, 0.1]; 40]);
    let options = DrawOptions {
        view: View::Iso,
        edges: true,
        ..SMALL
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| seen(&mesh, &options))
    };
    assert_eq!(with(1), with(7));
}
