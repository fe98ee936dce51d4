//! Reading and writing STL.

use proptest::prelude::*;
use tessgraph_geometry::{Mesh, Unmonitored};

use crate::{
    FaultKind, Format, IoError, Loaded, Place, ReadOptions, StlOptions, TextOrBinary, no_files,
    read, write_stl,
};

fn load(bytes: &[u8]) -> Result<Loaded, IoError> {
    read(
        Format::Stl,
        "a.stl",
        bytes,
        &mut no_files,
        &ReadOptions::default(),
        &Unmonitored,
    )
}

fn tetrahedron() -> Mesh {
    let places = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]];
    Mesh::from_faces(places, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
}

fn bytes(mesh: &Mesh, encoding: TextOrBinary) -> Vec<u8> {
    write_stl(mesh, &StlOptions { encoding }, &Unmonitored)
        .unwrap()
        .bytes
}

#[test]
fn both_encodings_come_back_welded() {
    for encoding in [TextOrBinary::Binary, TextOrBinary::Text] {
        let mesh = load(&bytes(&tetrahedron(), encoding)).unwrap().mesh;
        assert_eq!((mesh.vertex_count(), mesh.face_count()), (4, 4));
        // Vertices are numbered by first use: 0, 2, 1, then 3.
        assert_eq!(mesh.face(1), [0, 2, 3]);
        assert!(mesh.topology().check_manifold().is_ok());
    }
}

#[test]
fn without_welding_triangles_stand_alone() {
    let options = ReadOptions {
        weld_stl: false,
        ..ReadOptions::default()
    };
    let bytes = bytes(&tetrahedron(), TextOrBinary::Binary);
    let mesh = read(
        Format::Stl,
        "a.stl",
        &bytes,
        &mut no_files,
        &options,
        &Unmonitored,
    )
    .unwrap()
    .mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (12, 4));
}

#[test]
fn a_binary_file_may_begin_with_solid() {
    let mut bytes = bytes(&tetrahedron(), TextOrBinary::Binary);
    bytes[..20].copy_from_slice(b"solid facet endsolid");
    assert_eq!(load(&bytes).unwrap().mesh.face_count(), 4);
}

#[test]
fn polygons_are_cut_and_normals_are_unit() {
    let quad = vec![[0.0; 3], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]];
    let mesh = Mesh::from_faces(quad, &[[0, 1, 2, 3]]).unwrap();
    let bytes = bytes(&mesh, TextOrBinary::Binary);
    assert_eq!(bytes.len(), 84 + 2 * 50);
    assert_eq!(bytes[84 + 8..84 + 12], 1.0f32.to_le_bytes());
}

#[test]
fn minus_zero_is_zero() {
    let text = "solid a b\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nfacet\nouter loop\nVERTEX -0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid a b";
    let mesh = load(text.as_bytes()).unwrap().mesh;
    assert_eq!(mesh.vertex_count(), 4);
    assert_eq!(mesh.objects().labels(), ["a b"]);
    assert_eq!(
        load(text.replace('\n', "\r\n").as_bytes())
            .unwrap()
            .mesh
            .digest(),
        mesh.digest()
    );
}

#[test]
fn counts_that_do_not_fit_are_refused_before_allocating() {
    let mut bomb = vec![b' '; 80];
    bomb.extend(u32::MAX.to_le_bytes());
    let error = load(&bomb).unwrap_err();
    assert_eq!(error.fault().unwrap().place, Place::Byte(80));
    assert!(
        error
            .to_string()
            .contains("4294967295 triangles, but the file has room for 0")
    );
    let whole = bytes(&tetrahedron(), TextOrBinary::Binary);
    for cut in [0, 10, 83, 84, 100, whole.len() - 1] {
        assert!(load(&whole[..cut]).is_err(), "{cut}");
    }
    let longer = [whole.as_slice(), b"tail"].concat();
    assert!(load(&longer).unwrap().warnings[0].contains("4 bytes"));
}

#[test]
fn ascii_faults_have_a_line() {
    let file = |body: &str| {
        format!("solid\nfacet normal 0 0 1\nouter loop\n{body}\nendloop\nendfacet\nendsolid\n")
    };
    for (body, line, column, kind) in [
        ("vertex 0 0 0\nvertex 1 0 0", 7, 1, FaultKind::Syntax),
        ("vertex 0 0 x", 4, 12, FaultKind::Syntax),
        ("vertex 0 nan 0", 4, 10, FaultKind::NotFinite),
        ("vertex 0 0", 4, 11, FaultKind::Syntax),
        (
            "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1",
            7,
            1,
            FaultKind::Syntax,
        ),
        ("facet", 4, 1, FaultKind::Syntax),
        ("hello", 4, 1, FaultKind::Syntax),
    ] {
        let error = load(file(body).as_bytes()).unwrap_err();
        let fault = error.fault().unwrap();
        assert_eq!(
            (&fault.place, fault.kind),
            (&Place::Line { line, column }, kind),
            "{error}"
        );
    }
    assert!(load(b"solid\nfacet normal 0 0 1\nvertex 0 0 0\n").is_err());
}

#[test]
fn what_32_bits_cannot_hold_is_refused_or_told() {
    let triangle = |size: f64, x: f64| {
        Mesh::from_faces(
            vec![[x, 0.0, 0.0], [x + size, 0.0, 0.0], [x, size, 0.0]],
            &[[0, 1, 2]],
        )
        .unwrap()
    };
    let write = |mesh: &Mesh| write_stl(mesh, &StlOptions::default(), &Unmonitored);
    assert!(write(&triangle(1.0, 0.0)).unwrap().warnings.is_empty());
    assert!(write(&triangle(1.0, 5e6 + 0.3)).unwrap().warnings[0].contains("move the mesh"));
    assert!(
        write(&triangle(1e39, 0.0))
            .unwrap_err()
            .to_string()
            .contains("vertex 1")
    );
    let text = bytes(&triangle(1e300, 0.0), TextOrBinary::Text);
    assert!(!String::from_utf8(text).unwrap().contains("NaN"));
}

proptest! {
    #[test]
    fn text_keeps_every_digit(places in prop::collection::vec(prop::array::uniform3(-1e9..1e9f64), 3..9)) {
        let corners: Vec<u32> = (0..places.len() as u32 / 3 * 3).collect();
        let mesh = Mesh::from_faces(places, corners.as_chunks::<3>().0).unwrap();
        let again = load(&bytes(&mesh, TextOrBinary::Text)).unwrap().mesh;
        let count = corners.len();
        prop_assert_eq!(&again.positions()[..count], &mesh.positions()[..count]);
    }
}
