//! Reading and writing PLY.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Unmonitored, glam};

use crate::{
    FaultKind, Format, IoError, Loaded, Place, PlyOptions, ReadOptions, TextOrBinary, no_files,
    read, write_ply,
};

fn load(bytes: impl AsRef<[u8]>) -> Result<Loaded, IoError> {
    let options = ReadOptions::default();
    read(
        Format::Ply,
        "a.ply",
        bytes.as_ref(),
        &mut no_files,
        &options,
        &Unmonitored,
    )
}

fn bytes(mesh: &Mesh, encoding: TextOrBinary) -> Vec<u8> {
    write_ply(mesh, &PlyOptions { encoding }, &Unmonitored)
        .unwrap()
        .bytes
}

/// A quad and a triangle with an attribute of every kind.
fn rich() -> Mesh {
    let places = vec![
        [0.1, 0.0, 1e-9],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 5e6],
        [7.0; 3],
    ];
    let mesh = Mesh::from_faces(places, &[&[0, 1, 2, 3][..], &[0, 2, 3]]).unwrap();
    let number =
        |count: usize| AttributeValues::Number((0..count).map(|k| k as f64 / 3.0).collect());
    let vector = |count: usize| {
        AttributeValues::Vector3((0..count).map(|k| DVec3::splat(k as f64 / 7.0)).collect())
    };
    let pair = |count: usize| {
        AttributeValues::Vector2((0..count).map(|k| DVec2::new(0.1, k as f64)).collect())
    };
    let whole = |count: usize| AttributeValues::Integer((0..count).map(|k| k as i64 - 3).collect());
    let bytes = AttributeValues::Vector3(
        (0..5)
            .map(|k| DVec3::splat(f64::from(k) * 51.0 / 255.0))
            .collect(),
    );
    let attributes = [
        ("color", Domain::Vertex, bytes),
        ("normal", Domain::Vertex, vector(5)),
        ("drift", Domain::Vertex, vector(5)),
        ("flat", Domain::Vertex, pair(5)),
        ("weight", Domain::Vertex, number(5)),
        ("id", Domain::Vertex, whole(5)),
        ("part", Domain::Face, whole(2)),
        ("cost", Domain::Face, number(2)),
        ("uv", Domain::Corner, pair(7)),
        ("crease", Domain::Corner, number(7)),
        ("seam", Domain::Corner, whole(7)),
        ("tangent", Domain::Corner, vector(7)),
    ];
    attributes
        .into_iter()
        .fold(mesh, |mesh, (name, domain, values)| {
            mesh.with_attribute(Attribute::new(name, domain, values))
                .unwrap()
        })
}

#[test]
fn everything_comes_back_from_both_encodings() {
    let mesh = rich();
    for encoding in [TextOrBinary::Binary, TextOrBinary::Text] {
        let loaded = load(bytes(&mesh, encoding)).unwrap();
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        assert_eq!(loaded.mesh.positions(), mesh.positions());
        assert!(loaded.mesh.topology().is_same(mesh.topology()));
        assert_eq!(loaded.mesh.attributes().len(), mesh.attributes().len());
        for attribute in mesh.attributes() {
            let again = loaded.mesh.attribute(attribute.name(), attribute.domain());
            assert_eq!(again, Some(attribute), "{}", attribute.name());
        }
    }
}

const HEADER: &str = "ply\nformat ascii 1.0\ncomment x\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_index\nelement extra 2\nproperty int a\nend_header\n";

#[test]
fn ascii_with_other_elements_and_vertex_uvs() {
    let body = "0 0 0 0 0\n1 0 0 1 0\n0 1 0\n 0 1\n3 0 1 2\n7 8\n";
    let loaded = load(format!("{HEADER}{body}")).unwrap();
    assert_eq!(
        (loaded.mesh.vertex_count(), loaded.mesh.face_count()),
        (3, 1)
    );
    let uvs = AttributeValues::Vector2(vec![DVec2::ZERO, DVec2::X, DVec2::Y].into());
    assert_eq!(
        loaded
            .mesh
            .attribute("uv", Domain::Corner)
            .unwrap()
            .values(),
        &uvs
    );
    assert!(loaded.warnings[0].contains("2 elements `extra`"));
    let crlf = format!("{HEADER}{body}").replace('\n', "\r\n");
    assert_eq!(load(crlf).unwrap().mesh.digest(), loaded.mesh.digest());
}

#[test]
fn big_endian_is_the_mirror_of_little_endian() {
    let header = |order: &str| {
        format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty short x\nproperty double y\nproperty float z\nelement face 1\nproperty list ushort uint vertex_indices\nend_header\n"
        )
    };
    let mut big = header("big").into_bytes();
    let mut little = header("little").into_bytes();
    for k in 0..3i16 {
        big.extend((-k).to_be_bytes());
        big.extend((f64::from(k) * 0.1).to_be_bytes());
        big.extend((f32::from(k) * 0.5).to_be_bytes());
        little.extend((-k).to_le_bytes());
        little.extend((f64::from(k) * 0.1).to_le_bytes());
        little.extend((f32::from(k) * 0.5).to_le_bytes());
    }
    big.extend(3u16.to_be_bytes());
    little.extend(3u16.to_le_bytes());
    for vertex in [2u32, 1, 0] {
        big.extend(vertex.to_be_bytes());
        little.extend(vertex.to_le_bytes());
    }
    let mesh = load(&big).unwrap().mesh;
    assert_eq!(mesh.positions()[1], DVec3::new(-1.0, 0.1, 0.5));
    assert_eq!(mesh.face(0), [2, 1, 0]);
    assert_eq!(load(&little).unwrap().mesh.digest(), mesh.digest());
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of faults")]
fn faults_are_placed() {
    let body = "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n";
    for (text, line, column, kind) in [
        (
            format!("{HEADER}{body}3 0 1 3\n0 0\n"),
            18,
            6,
            FaultKind::OutOfRange,
        ),
        (
            format!("{HEADER}{body}3 0 1 -1\n0 0\n"),
            18,
            6,
            FaultKind::OutOfRange,
        ),
        (
            format!("{HEADER}{body}3 0 1 1.5\n0 0\n"),
            18,
            6,
            FaultKind::OutOfRange,
        ),
        (
            format!("{HEADER}{body}2 0 1\n0 0\n"),
            17,
            10,
            FaultKind::Syntax,
        ),
        (
            format!("{HEADER}{body}1.5 0 1\n0 0\n"),
            17,
            10,
            FaultKind::Syntax,
        ),
        (
            format!("{HEADER}0 0 x 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2 0 0"),
            15,
            5,
            FaultKind::Syntax,
        ),
        (
            format!("{HEADER}0 nan 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2 0 0"),
            15,
            2,
            FaultKind::NotFinite,
        ),
        (
            HEADER.replace("vertex 3", "vertex 1000000000"),
            15,
            1,
            FaultKind::Truncated,
        ),
        (
            HEADER.replace("vertex 3", "vertex 18446744073709551615"),
            15,
            1,
            FaultKind::Truncated,
        ),
        (
            HEADER.replace("vertex 3", "vertex -3"),
            4,
            1,
            FaultKind::Syntax,
        ),
        (
            HEADER.replace("float s", "flaot s"),
            8,
            1,
            FaultKind::Syntax,
        ),
        (
            HEADER.replace("list uchar", "list float"),
            11,
            1,
            FaultKind::Syntax,
        ),
        (HEADER.replace("ascii", "ebcdic"), 2, 1, FaultKind::Syntax),
        (
            HEADER.replace("end_header\n", ""),
            14,
            1,
            FaultKind::Truncated,
        ),
        (
            HEADER.replace("element extra 2", "element face 2"),
            12,
            1,
            FaultKind::Syntax,
        ),
    ] {
        let error = load(&text).unwrap_err();
        let fault = error.fault().unwrap();
        assert_eq!(
            (&fault.place, fault.kind),
            (&Place::Line { line, column }, kind),
            "{error}"
        );
    }
    let no_y = HEADER.replace("float y", "float w");
    assert!(
        load(format!("{no_y}{body}3 0 1 2 0 0"))
            .unwrap_err()
            .to_string()
            .contains("`y`")
    );
}

#[test]
fn lists_cannot_be_longer_than_the_file() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\nproperty list int int vertex_indices\nend_header\n";
    for count in [u32::MAX, i32::MAX as u32, 3] {
        let mut bytes = header.as_bytes().to_vec();
        bytes.extend([1, 2, 3]);
        bytes.extend(count.to_le_bytes());
        let error = load(&bytes).unwrap_err();
        assert_eq!(
            error.fault().unwrap().place,
            Place::Byte(header.len() as u64 + 3),
            "{error}"
        );
    }
}

#[test]
fn elements_without_properties_take_no_time() {
    let text = HEADER.replace(
        "element extra 2\nproperty int a\n",
        "element extra 18446744073709551615\n",
    );
    let loaded = load(format!("{text}0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n")).unwrap();
    assert_eq!(loaded.mesh.face_count(), 1);
}

#[test]
fn values_that_are_not_finite_are_left_out() {
    let text = HEADER.replace("float t", "float quality");
    let loaded = load(format!(
        "{text}0 0 0 0 nan\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n1 2"
    ))
    .unwrap();
    assert!(loaded.mesh.attribute("quality", Domain::Vertex).is_none());
    assert!(
        loaded
            .warnings
            .iter()
            .any(|text| text.contains("`quality`"))
    );
}

#[test]
fn large_faces_and_labels() {
    let places = (0..300)
        .map(|k| [f64::from(k), f64::from(k * k), 0.0])
        .collect();
    let face: Vec<u32> = (0..300).collect();
    let mesh = Mesh::from_faces(places, &[face]).unwrap();
    let objects = tessgraph_geometry::Labels::new(vec!["a".to_owned()], vec![0]).unwrap();
    let mesh = mesh.with_objects(objects).unwrap();
    let written = write_ply(&mesh, &PlyOptions::default(), &Unmonitored).unwrap();
    assert!(written.warnings[0].contains("objects"));
    assert_eq!(load(&written.bytes).unwrap().mesh.face(0), mesh.face(0));
}

proptest! {
    #[test]
    fn positions_come_back_bit_for_bit(
        places in prop::collection::vec(prop::array::uniform3(any::<f64>().prop_filter("finite", |x| x.is_finite())), 3..9),
        text: bool,
    ) {
        let mesh = Mesh::from_faces(places, &[[0, 1, 2]]).unwrap();
        let encoding = if text { TextOrBinary::Text } else { TextOrBinary::Binary };
        let again = load(bytes(&mesh, encoding)).unwrap().mesh;
        prop_assert_eq!(again.positions(), mesh.positions());
    }
}
