//! Reading and writing OBJ.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tessgraph_geometry::{AttributeValues, Domain, Mesh, NO_LABEL, Unmonitored, glam};

use crate::{
    FaultKind, Format, IoError, Loaded, ObjOptions, Place, ReadOptions, ResolveError, no_files,
    read, write_mtl, write_obj,
};

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn load(text: impl AsRef<[u8]>) -> Result<Loaded, IoError> {
    let options = ReadOptions::default();
    read(
        Format::Obj,
        "a.obj",
        text.as_ref(),
        &mut no_files,
        &options,
        &Unmonitored,
    )
}

fn with_files(text: &str, files: &[(&str, &str)]) -> Loaded {
    let mut resolve = |name: &str| match files.iter().find(|file| file.0 == name) {
        Some(file) => Ok(Arc::from(file.1.as_bytes())),
        None => Err(ResolveError::NotFound),
    };
    let options = ReadOptions::default();
    read(
        Format::Obj,
        "a.obj",
        text.as_bytes(),
        &mut resolve,
        &options,
        &Unmonitored,
    )
    .unwrap()
}

fn faces(mesh: &Mesh) -> Vec<Vec<u32>> {
    mesh.topology().faces().map(<[u32]>::to_vec).collect()
}

fn corner_uvs(mesh: &Mesh) -> Vec<DVec2> {
    match mesh.attribute("uv", Domain::Corner).unwrap().values() {
        AttributeValues::Vector2(uvs) => uvs.to_vec(),
        _ => panic!("uv is of another type"),
    }
}

fn numbers(mesh: &Mesh, name: &str, domain: Domain) -> Vec<f64> {
    match mesh.attribute(name, domain).unwrap().values() {
        AttributeValues::Number(values) => values.to_vec(),
        _ => panic!("{name} is of another type"),
    }
}

#[test]
fn every_spelling_of_one_face_is_the_same_face() {
    let plain = load(format!("{QUAD}f 1 2 3 4\n")).unwrap().mesh;
    for face in [
        "f 1 2 3 4",
        "f -4 -3 -2 -1",
        "f 1 -3 3 -1",
        "f  1\t2  3 4  ",
        "fo 1 2 3 4",
        "f 1/ 2/ 3/ 4/",
        "f 1// 2// 3// 4//",
        "f 1 2 \\\n3 4",
        "f 1 2\\\r\n 3 4 # note",
        "f\\\n 1 2 3 4",
        "f +1 2 3 4",
    ] {
        let mesh = load(format!("{QUAD}{face}")).unwrap().mesh;
        assert_eq!(mesh.digest(), plain.digest(), "{face}");
    }
    let text = format!("{QUAD}f 1 2 3 4\n");
    for text in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.replace('v', "  v"),
        format!("f 1 2 3 4\n{QUAD}"),
        text.replace("v 0 0 0", "v +0. 0e5 .0"),
        text.replace("v 0 0 0", "v 0 0 0 1.0"),
    ] {
        assert_eq!(
            load(&text).unwrap().mesh.digest(),
            plain.digest(),
            "{text:?}"
        );
    }
}

#[test]
fn vertices_keep_their_order_and_their_place() {
    let mesh = load("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 8 8 8\nv 0 1 0\nf 2 3 5\n")
        .unwrap()
        .mesh;
    assert_eq!(mesh.vertex_count(), 5);
    assert_eq!(faces(&mesh), [[1, 2, 4]]);
    assert_eq!(mesh.positions()[0], DVec3::splat(9.0));
}

#[test]
fn coordinates_are_rounded_correctly() {
    let mesh = load("v 5000000.123456789 1e-320 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3")
        .unwrap()
        .mesh;
    let expected = DVec3::new(5000000.123456789, 1e-320, 0.1);
    assert_eq!(
        mesh.positions()[0].to_array().map(f64::to_bits),
        expected.to_array().map(f64::to_bits)
    );
}

#[test]
fn refusals_name_place_and_cause() {
    for (line, column, what, cause) in [
        ("f 1 2 0", 7, FaultKind::OutOfRange, "counted from 1"),
        ("f 1 2 5", 7, FaultKind::OutOfRange, "there are 4"),
        ("f 1 2 -5", 7, FaultKind::OutOfRange, "only 4 before"),
        ("f 1 2 4294967297", 7, FaultKind::OutOfRange, "there are 4"),
        (
            "f 1 2 100000000000000000000",
            7,
            FaultKind::Syntax,
            "whole number",
        ),
        (
            "f 1 2 -9223372036854775808",
            7,
            FaultKind::Syntax,
            "whole number",
        ),
        ("f 1 2 3.5", 7, FaultKind::Syntax, "`3.5`"),
        ("f 1 2 0x1", 7, FaultKind::Syntax, "`0x1`"),
        ("f 1 2 three", 7, FaultKind::Syntax, "`three`"),
        ("f 1/1/1/1 2 3", 3, FaultKind::Syntax, "v/vt/vn"),
        ("f 1/x 2 3", 3, FaultKind::Syntax, "`1/x`"),
        ("f", 1, FaultKind::Syntax, "0 corners"),
        ("f 1", 1, FaultKind::Syntax, "1 corner;"),
        ("f 1 2", 1, FaultKind::Syntax, "2 corners"),
        ("v 1 2", 1, FaultKind::Syntax, "2 of the three"),
        ("v", 1, FaultKind::Syntax, "lacks"),
        ("v 1 x 3", 5, FaultKind::Syntax, "`x`"),
        ("v 1 0,5 3", 5, FaultKind::Syntax, "comma"),
        ("v 1 nan 3", 5, FaultKind::NotFinite, "`nan`"),
        ("v 1 -1.#IND 3", 5, FaultKind::NotFinite, "not finite"),
        ("v 1 inf 3", 5, FaultKind::NotFinite, "not finite"),
        ("v 1 2 1e400", 7, FaultKind::NotFinite, "`1e400`"),
        ("v 1 2 3 x", 9, FaultKind::Syntax, "after the coordinates"),
        ("vt nan 0", 4, FaultKind::NotFinite, "texture"),
        ("vt", 1, FaultKind::Syntax, "lacks"),
        ("vn 1 0", 1, FaultKind::Syntax, "2 of the three"),
        ("<<<<<<< HEAD", 1, FaultKind::Syntax, "merge"),
    ] {
        let error = load(format!("# é\n{QUAD}{line}\nf 1 2 3 4\n")).unwrap_err();
        let fault = error.fault().unwrap();
        assert_eq!(
            fault.place,
            Place::Line { line: 6, column },
            "{line}: {error}"
        );
        assert_eq!(fault.kind, what, "{line}: {error}");
        let text = error.to_string();
        assert!(
            text.starts_with("a.obj:6:") && text.contains(cause),
            "{line}: {error}"
        );
    }
}

#[test]
fn what_is_no_obj_is_refused() {
    for (text, cause) in [
        ("", "empty"),
        ("# nothing\n", "comments"),
        ("hello world\n", "no line is an OBJ statement"),
        ("V 0 0 0\n", "lower case"),
        ("solid x\nfacet normal 0 0 1\n", "STL"),
        ("ply\nformat\n", "PLY"),
        ("v 0 0 0\ncstype bezier\nsurf 0 1 0 1 1\nend\n", "free-form"),
    ] {
        let error = load(text).unwrap_err().to_string();
        assert!(error.contains(cause), "{error}");
    }
}

#[test]
fn what_is_passed_over_is_counted() {
    let text =
        format!("call x.obj\ncsh rm -rf /\nl 1 2\np 1\np 2\nfoo\n{QUAD}f 1 2 3 4\ns 1\nt x\n");
    let warnings = load(text).unwrap().warnings.join("\n");
    for part in [
        "2 commands",
        "3 lines and points",
        "first on line 3",
        "1 unknown statement",
        "1 `t` statement",
    ] {
        assert!(warnings.contains(part), "{part}: {warnings}");
    }
    let empty = load("mtllib x.mtl\n").unwrap();
    assert_eq!(empty.mesh.vertex_count(), 0);
    assert!(empty.warnings[0].contains("no faces"));
}

#[test]
fn uvs_go_on_corners_and_missing_ones_are_told() {
    let vt = "vt 0 0\nvt 1 0.5 9\nvt 0.25\n";
    let whole = load(format!("{QUAD}{vt}f 1/1 2/2 3/-1 4/3")).unwrap();
    assert!(whole.warnings.is_empty());
    let expected = [(0.0, 0.0), (1.0, 0.5), (0.25, 0.0), (0.25, 0.0)].map(DVec2::from);
    assert_eq!(corner_uvs(&whole.mesh), expected);
    let part = load(format!("{QUAD}{vt}f 1 2 3\nf 1/2 3/9 4/2\nf 2 3 4")).unwrap();
    assert_eq!(corner_uvs(&part.mesh)[3], DVec2::new(1.0, 0.5));
    assert_eq!(corner_uvs(&part.mesh).len(), 9);
    let warnings = part.warnings.join("\n");
    assert!(
        warnings.contains("1 corner names a texture coordinate that does not exist (there are 3)")
    );
    assert!(
        warnings.contains("6 corners have no texture coordinate"),
        "{warnings}"
    );
    let none = load(format!("{QUAD}f 1/7 2/7 3/7")).unwrap();
    assert!(none.mesh.attributes().is_empty());
}

#[test]
fn normals_and_colors_are_read() {
    let text =
        "v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 nan\nvn 0 0 1\nvn nan 0 0\nf 1//1 2//1 3//2\n";
    let loaded = load(text).unwrap();
    let mesh = &loaded.mesh;
    let normals = AttributeValues::Vector3(vec![DVec3::Z, DVec3::Z, DVec3::ZERO].into());
    assert_eq!(
        mesh.attribute("normal", Domain::Corner).unwrap().values(),
        &normals
    );
    let colors = vec![DVec3::new(1.0, 0.5, 0.0), DVec3::ONE, DVec3::ONE];
    let colors = AttributeValues::Vector3(colors.into());
    assert_eq!(
        mesh.attribute("color", Domain::Vertex).unwrap().values(),
        &colors
    );
    assert_eq!(loaded.warnings.len(), 2);
}

#[test]
fn labels_follow_their_statements() {
    let text = "o House A\ng wall north\nusemtl brick\nf 1 2 3\ng\nf 1 2 4\no\nusemtl\nf 2 3 4\ng north  wall\nf 1 3 4\n";
    let mesh = load(format!("{QUAD}{text}")).unwrap().mesh;
    assert_eq!(mesh.objects().labels(), ["House A"]);
    assert_eq!(
        mesh.objects().of_face().as_slice(),
        [0, 0, NO_LABEL, NO_LABEL]
    );
    assert_eq!(mesh.groups().get(0).unwrap(), &["wall", "north"]);
    assert_eq!(mesh.groups().get(1), None);
    assert_eq!(mesh.groups().get(3).unwrap(), &["north", "wall"]);
    assert_eq!(
        mesh.materials().of_face().as_slice(),
        [0, 0, NO_LABEL, NO_LABEL]
    );
    let latin = load([QUAD.as_bytes(), b"# \xe9\no caf\xe9\nf 1 2 3\n"].concat()).unwrap();
    assert_eq!(latin.mesh.objects().labels(), ["café"]);
}

#[test]
fn materials_come_from_libraries() {
    let library = "newmtl other\nKd 1 1 1\nnewmtl red brick\n  Kd 0.8 0.1 0.05\nKs 1\nd 0.5\nPm 0.25\nPr 0.125\nmap_Kd x.png\nillum 2\nnewmtl bad\nKd\nKd 2 0 x\nTr 0.75\n";
    let text = format!(
        "mtllib my lib.mtl\n{QUAD}usemtl red brick\nf 1 2 3\nusemtl bad\nf 1 3 4\nusemtl none\nf 1 2 4"
    );
    let loaded = with_files(&text, &[("my lib.mtl", library)]);
    let materials = loaded.mesh.materials().labels();
    assert_eq!(materials[0].base_color, [0.8, 0.1, 0.05, 0.5]);
    assert_eq!(
        (materials[0].metallic, materials[0].roughness),
        (0.25, 0.125)
    );
    assert_eq!(materials[1].base_color, [0.8, 0.8, 0.8, 0.25]);
    assert_eq!(materials[2].name, "none");
    let warnings = loaded.warnings.join("\n");
    assert!(
        warnings.contains("2 lines were not understood, first on line 12"),
        "{warnings}"
    );
    assert!(
        warnings.contains("no material library defines `none`"),
        "{warnings}"
    );
    let two = with_files(
        &text.replace("my lib.mtl", "a.mtl b.mtl"),
        &[("b.mtl", library)],
    );
    assert_eq!(two.mesh.materials().labels()[0].base_color[0], 0.8);
    assert!(two.warnings[0].contains("`a.mtl`"));
}

#[test]
fn unsafe_libraries_are_never_asked_for() {
    for name in [
        "/etc/passwd",
        "../x.mtl",
        "C:\\x.mtl",
        "sub/../../x",
        "file:///x",
        "..\\x",
        "//host/x",
    ] {
        let text = format!("mtllib {name}\n{QUAD}usemtl a\nf 1 2 3\n");
        let mut resolve = |name: &str| panic!("asked for {name}");
        let options = ReadOptions::default();
        let loaded = read(
            Format::Obj,
            "a.obj",
            text.as_bytes(),
            &mut resolve,
            &options,
            &Unmonitored,
        )
        .unwrap();
        assert!(
            loaded.warnings[0].contains("not followed"),
            "{:?}",
            loaded.warnings
        );
    }
    let missing = load(format!("mtllib x.mtl\n{QUAD}usemtl a\nf 1 2 3\n")).unwrap();
    assert!(missing.warnings[0].contains("no such file"));
}

#[test]
fn subdivision_tags_become_attributes() {
    let tags = "t crease 2/1/0 1 0 2.5\nt crease 4/2/0 1 2 0 2 7 8\nt corner 1/1/0 3 4\nt corner 2/1/0 0 1 10\nt interpolateboundary 1/0/0 2\nt hole 1/0/0 0\n";
    let loaded = load(format!("{QUAD}f 1 2 3\nf 1 3 4\n{tags}")).unwrap();
    assert_eq!(loaded.boundary, Some(2));
    // Corners leave 0-1, 1-2, 2-0, 0-2, 2-3, 3-0.
    let crease = numbers(&loaded.mesh, "crease", Domain::Corner);
    assert_eq!(crease, [2.5, 7.0, 8.0, 8.0, 0.0, 0.0]);
    assert_eq!(
        numbers(&loaded.mesh, "corner_sharpness", Domain::Vertex),
        [10.0, 10.0, 0.0, 4.0]
    );
    assert!(
        loaded.warnings[0].contains("other kind"),
        "{:?}",
        loaded.warnings
    );
    let lost = load(format!("{QUAD}f 1 2 3\nt crease 2/1/0 0 3 1\n")).unwrap();
    assert!(lost.warnings[0].contains("1 crease is on no edge"));
    let wrong = load(format!("{QUAD}f 1 2 3\nt corner 1/1/0 4 1\n")).unwrap_err();
    assert_eq!(
        wrong.fault().unwrap().place,
        Place::Line { line: 6, column: 1 }
    );
}

#[test]
fn tobj_agrees_where_it_is_right() {
    for text in [
        format!("{QUAD}f 1 2 3 4\n"),
        format!("{QUAD}v 2 0 0.5\nv 2 1 0.25\nf 1 2 3 4\nf 2 5 6 3\n"),
        format!("{QUAD}vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf -4/1 -2/3 -1/2\n"),
    ] {
        let ours = load(&text).unwrap().mesh;
        let options = tobj::LoadOptions::default();
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| {
            Err(tobj::LoadError::OpenFileFailed)
        })
        .unwrap();
        let theirs = &models[0].mesh;
        let place = |k: usize| DVec3::from_slice(&theirs.positions[3 * k..3 * k + 3]);
        let arity = |k: usize| theirs.face_arities.get(k).map_or(3, |&n| n as usize);
        let mut at = 0;
        for (face, vertices) in faces(&ours).iter().enumerate() {
            assert_eq!(vertices.len(), arity(face));
            for &vertex in vertices {
                assert_eq!(
                    ours.positions()[vertex as usize],
                    place(theirs.indices[at] as usize)
                );
                at += 1;
            }
        }
        assert_eq!(at, theirs.indices.len());
    }
}

/// Writes and reads back with the material library beside it.
fn round_trip(loaded: &Loaded) -> Loaded {
    let options = ObjOptions {
        material_library: Some("m.mtl".into()),
        boundary: loaded.boundary,
    };
    let bytes = write_obj(&loaded.mesh, &options, &Unmonitored)
        .unwrap()
        .bytes;
    let library: Arc<[u8]> = write_mtl(&loaded.mesh).into();
    let mut resolve = |name: &str| match name {
        "m.mtl" => Ok(library.clone()),
        _ => Err(ResolveError::NotFound),
    };
    read(
        Format::Obj,
        "b.obj",
        &bytes,
        &mut resolve,
        &ReadOptions::default(),
        &Unmonitored,
    )
    .unwrap()
}

#[test]
fn a_file_with_everything_survives_the_round_trip() {
    let text = "mtllib m.mtl\no A b\ng x y\nusemtl m 1\nv 0.1 -0 1e-9 1 0 0.5\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 7 7 7\nvt 0 0\nvt 1 0.3\nvn 0 0 1\nf 1/1/1 2/2/1 3 4/1\ng\nf 3 2 1\no\nusemtl n\nf 1 4 3\nt crease 2/1/0 0 1 2\nt corner 1/1/0 2 3\nt interpolateboundary 1/0/0 1\n";
    let loaded = with_files(
        text,
        &[("m.mtl", "newmtl m 1\nKd 0.1 0.2 0.3\nnewmtl n\nPr 0.9\n")],
    );
    let again = round_trip(&loaded);
    assert_eq!(again.mesh.digest(), loaded.mesh.digest());
    assert_eq!(again.boundary, Some(1));
}

#[test]
fn names_are_made_fit_and_distinct() {
    use tessgraph_geometry::{Labels, Material};
    let mesh = load(format!("{QUAD}f 1 2 3\nf 1 3 4\n")).unwrap().mesh;
    let named = ["a\nb", "a_b"].map(Material::named).to_vec();
    let mesh = mesh
        .with_materials(Labels::new(named, vec![0, 1]).unwrap())
        .unwrap();
    let mesh = mesh
        .with_objects(Labels::new(vec!["#x\\".to_owned()], vec![0, 0]).unwrap())
        .unwrap();
    let text = String::from_utf8(
        write_obj(&mesh, &ObjOptions::default(), &Unmonitored)
            .unwrap()
            .bytes,
    )
    .unwrap();
    assert!(
        text.contains("o _x_\n")
            && text.contains("usemtl a_b\n")
            && text.contains("usemtl a_b_2\n"),
        "{text}"
    );
}

#[test]
fn a_long_line_and_many_names_cost_little() {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    text.push_str(&" 1 2 3".repeat(100_000));
    for k in 0..100_000 {
        text.push_str(&format!("\ng g{k}"));
    }
    let mesh = load(&text).unwrap().mesh;
    assert_eq!((mesh.face_count(), mesh.corner_count()), (1, 300_000));
    assert!(mesh.groups().is_empty());
}

prop_compose! {
    /// A file of arbitrary faces, texture coordinates and names.
    fn any_file()(
        places in prop::collection::vec(prop::array::uniform3(-1e6..1e6f64), 3..12),
        uvs in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 1..6),
        faces in prop::collection::vec((prop::collection::vec((any::<u32>(), any::<u32>()), 3..7), 0..4u8), 0..8),
    ) -> String {
        let mut text = String::new();
        for [x, y, z] in &places { text.push_str(&format!("v {x} {y} {z}\n")); }
        for (u, v) in &uvs { text.push_str(&format!("vt {u} {v}\n")); }
        for (corners, label) in &faces {
            match label {
                0 => text.push_str("g a b\n"),
                1 => text.push_str("o thing\nusemtl m\n"),
                2 => text.push_str("g\n"),
                _ => {}
            }
            text.push('f');
            for (v, t) in corners {
                let v = *v as usize % places.len() + 1;
                text.push_str(&if *label == 3 { format!(" {v}") } else { format!(" {v}/{}", *t as usize % uvs.len() + 1) });
            }
            text.push('\n');
        }
        text
    }
}

proptest! {
    #[test]
    fn what_is_read_is_written_and_read_back(text in any_file()) {
        let loaded = load(&text).unwrap();
        let again = round_trip(&loaded);
        prop_assert_eq!(again.mesh.digest(), loaded.mesh.digest());
    }

    #[test]
    fn any_statements_give_a_mesh_or_an_error(
        words in prop::collection::vec("(v|vt|vn|f|g|o|usemtl|mtllib|t|l|\\\\|\n|\n|-?[0-9]{1,3}|[0-9]/[0-9]|[0-9]//-[0-9]|crease|2/1/0|nan|#|\\.)", 0..60),
    ) {
        if let Err(error) = load(words.join(" ")) {
            prop_assert!(error.fault().is_some());
        }
    }
}

/// Lines of all kinds, right and wrong.
const LINES: &[&str] = &[
    "v 0 0 0\n",
    "v 1 0 0\r\n",
    "v 1 1 0 1 0.5 0\n",
    "v 0 1 nan\n",
    "\tv 2 \\\n 1 0\n",
    "vt 0.25 1\n",
    "vn 0 0 1\r",
    "vn 0 nan 1\n",
    "f 1 2 3\n",
    "f 4/1/1 3/2 1//2\r\n",
    "f -1 -2 -3\n",
    "f -1/-1 -3/-1/-1 -2\\\r\n -4//-1\n",
    "f 9 1 2\n",
    "f 1 2\n",
    "g left right\n",
    "o panel\\\n s\n",
    "usemtl steel\n",
    "mtllib \\\r\n none.mtl\n",
    "t crease 2/1/0 0 1 2.5\n",
    "t interpolateboundary 1/0/0 1\n",
    "l 1 2\n",
    "# a comment \\\n",
    "what is this\n",
    "\n",
];

proptest! {
    #[test]
    fn parts_of_any_size_say_what_the_whole_says(
        lines in prop::collection::vec(0..LINES.len(), 0..60), part in 0usize..80,
    ) {
        // Every fourth file may have mistakes.
        let good = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 1 0 0\nvn 0 1 0\n";
        let wrong = ["v 0 1 nan\n", "f 9 1 2\n", "f 1 2\n"];
        let kept = |&line: &&str| lines.len() % 4 == 0 || !wrong.contains(&line);
        let text = lines.iter().map(|&line| LINES[line]).filter(kept);
        let text = good.to_owned() + &text.collect::<String>();
        let bytes = text.as_bytes();
        let read = |part: usize| {
            let said = super::parts::in_parts(bytes, part, usize::MAX, &Unmonitored)?;
            super::finish::finish(bytes, said, &mut no_files)
        };
        match (read(part), read(usize::MAX / 2)) {
            (Ok(parts), Ok(whole)) => {
                prop_assert_eq!(parts.mesh.digest(), whole.mesh.digest());
                prop_assert_eq!(parts.warnings, whole.warnings);
                prop_assert_eq!(parts.boundary, whole.boundary);
            }
            (parts, whole) => {
                let text = |read: Result<Loaded, IoError>| read.err().map(|error| format!("{error:?}"));
                prop_assert_eq!(text(parts), text(whole));
            }
        }
    }
}
