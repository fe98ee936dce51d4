//! Damaged files of every format: a valid mesh or an error, nothing else.

use proptest::prelude::*;
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Mesh, Monitor, Unmonitored, glam::DVec2,
};

use crate::{
    Format, GlbOptions, IoError, ObjOptions, PlyOptions, ReadOptions, StlOptions, TextOrBinary,
    no_files, read, write_glb, write_obj, write_ply, write_stl,
};

/// Small valid files of every format and encoding.
fn files() -> Vec<(Format, Vec<u8>)> {
    let places = vec![
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.5],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 2.0],
    ];
    let faces = [&[0, 1, 2, 3][..], &[1, 2, 4], &[0, 1, 4]];
    let mesh = Mesh::from_faces(places, &faces).unwrap();
    let uvs = (0..10).map(|k| DVec2::new(f64::from(k), 0.5)).collect();
    let mesh = mesh
        .with_attribute(Attribute::new(
            "uv",
            Domain::Corner,
            AttributeValues::Vector2(uvs),
        ))
        .unwrap();
    let monitor = &Unmonitored;
    let (binary, text) = (TextOrBinary::Binary, TextOrBinary::Text);
    let glb = write_glb(&mesh, &GlbOptions::default(), monitor)
        .unwrap()
        .bytes;
    let json_end = 20 + u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize;
    vec![
        (
            Format::Obj,
            write_obj(&mesh, &ObjOptions::default(), monitor)
                .unwrap()
                .bytes,
        ),
        (Format::Gltf, glb[20..json_end].to_vec()),
        (Format::Glb, glb),
        (
            Format::Stl,
            write_stl(&mesh, &StlOptions { encoding: binary }, monitor)
                .unwrap()
                .bytes,
        ),
        (
            Format::Stl,
            write_stl(&mesh, &StlOptions { encoding: text }, monitor)
                .unwrap()
                .bytes,
        ),
        (
            Format::Ply,
            write_ply(&mesh, &PlyOptions { encoding: binary }, monitor)
                .unwrap()
                .bytes,
        ),
        (
            Format::Ply,
            write_ply(&mesh, &PlyOptions { encoding: text }, monitor)
                .unwrap()
                .bytes,
        ),
    ]
}

/// Reads; what is read must be a mesh whose writers all work or refuse.
pub(crate) fn survive(format: Format, bytes: &[u8]) -> Result<(), IoError> {
    let options = ReadOptions {
        memory_limit: 1 << 24,
        ..ReadOptions::default()
    };
    let loaded = match read(format, "x", bytes, &mut no_files, &options, &Unmonitored) {
        Ok(loaded) => loaded,
        Err(error) => {
            let fault = error.fault().ok_or(error.clone())?;
            assert!(!fault.cause.is_empty() && !fault.help.is_empty() && fault.file == "x");
            assert!(!error.to_string().chars().any(char::is_control), "{error}");
            return Ok(());
        }
    };
    let mesh = &loaded.mesh;
    assert!(mesh.positions().iter().all(|place| place.is_finite()));
    assert!(
        mesh.topology()
            .corners()
            .iter()
            .all(|&vertex| (vertex as usize) < mesh.vertex_count())
    );
    let again = write_obj(mesh, &ObjOptions::default(), &Unmonitored)?.bytes;
    if mesh.vertex_count() > 0 {
        let again = read(
            Format::Obj,
            "x",
            &again,
            &mut no_files,
            &options,
            &Unmonitored,
        )?;
        assert_eq!(again.mesh.positions(), mesh.positions());
        assert!(again.mesh.topology().is_same(mesh.topology()));
    }
    if let Ok(written) = write_glb(mesh, &GlbOptions::default(), &Unmonitored) {
        assert!(gltf::Gltf::from_slice(&written.bytes).is_ok());
    }
    Ok(())
}

/// One kind of damage.
#[derive(Debug, Clone)]
enum Damage {
    Byte(prop::sample::Index, u8),
    Flip(prop::sample::Index, u8),
    Cut(prop::sample::Index),
    Remove(prop::sample::Index, usize),
    Repeat(prop::sample::Index, usize),
    Word(prop::sample::Index, u32),
    Number(prop::sample::Index, &'static str),
}

fn damage() -> impl Strategy<Value = Damage> {
    let numbers = [
        "-1",
        "0",
        "99999999999999999999",
        "1e999",
        "nan",
        "4294967297",
        "",
        "x",
        "\\",
    ];
    let words = [
        0,
        1,
        255,
        65535,
        1 << 31,
        u32::MAX,
        0x7fc0_0000,
        0x7f80_0000,
    ];
    prop_oneof![
        (any::<prop::sample::Index>(), any::<u8>()).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        (any::<prop::sample::Index>(), 0..8u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        any::<prop::sample::Index>().prop_map(Damage::Cut),
        (any::<prop::sample::Index>(), 1..20usize).prop_map(|(at, n)| Damage::Remove(at, n)),
        (any::<prop::sample::Index>(), 1..20usize).prop_map(|(at, n)| Damage::Repeat(at, n)),
        (
            any::<prop::sample::Index>(),
            prop::sample::select(words.to_vec()).boxed()
        )
            .prop_map(|(at, w)| Damage::Word(at, w)),
        (
            any::<prop::sample::Index>(),
            prop::sample::select(numbers.to_vec()).boxed()
        )
            .prop_map(|(at, n)| Damage::Number(at, n)),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    if bytes.is_empty() {
        return;
    }
    let length = bytes.len();
    match damage {
        Damage::Byte(at, byte) => bytes[at.index(length)] = *byte,
        Damage::Flip(at, bit) => bytes[at.index(length)] ^= 1 << bit,
        Damage::Cut(at) => bytes.truncate(at.index(length)),
        Damage::Remove(at, count) => {
            let start = at.index(length);
            bytes.drain(start..(start + count).min(length));
        }
        Damage::Repeat(at, count) => {
            let start = at.index(length);
            let part = bytes[start..(start + count).min(length)].to_vec();
            bytes.splice(start..start, part);
        }
        Damage::Word(at, word) => {
            let start = at.index(length);
            for (slot, byte) in bytes[start..].iter_mut().zip(word.to_le_bytes()) {
                *slot = byte;
            }
        }
        // Replaces a whole number, so that the change is one a reader parses.
        Damage::Number(at, number) => {
            let digits: Vec<_> = (0..length).filter(|&k| bytes[k].is_ascii_digit()).collect();
            if !digits.is_empty() {
                let start = digits[at.index(digits.len())];
                let count = bytes[start..]
                    .iter()
                    .take_while(|byte| byte.is_ascii_digit())
                    .count();
                bytes.splice(start..start + count, number.bytes());
            }
        }
    }
}

/// Cases per test; `TESSGRAPH_MUTANTS` asks for more.
fn config() -> ProptestConfig {
    let asked = std::env::var("TESSGRAPH_MUTANTS")
        .ok()
        .and_then(|count| count.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(4000))
}

proptest! {
    #![proptest_config(config())]
    #[test]
    fn damaged_files_give_a_mesh_or_an_error(
        which in any::<prop::sample::Index>(),
        damages in prop::collection::vec(damage(), 1..4),
    ) {
        let files = files();
        let (format, mut bytes) = files[which.index(files.len())].clone();
        damages.iter().for_each(|damage| apply(&mut bytes, damage));
        survive(format, &bytes)?;
    }

    #[test]
    fn spliced_files_give_a_mesh_or_an_error(
        which in any::<prop::sample::Index>(),
        other in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
    ) {
        let files = files();
        let (format, bytes) = &files[which.index(files.len())];
        let (_, tail) = &files[other.index(files.len())];
        let cut = at.index(bytes.len());
        survive(*format, &[&bytes[..cut], &tail[cut.min(tail.len())..]].concat())?;
    }

    #[test]
    fn any_bytes_give_a_mesh_or_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for format in Format::ALL {
            survive(format, &bytes)?;
        }
    }
}

#[test]
fn undamaged_files_load_under_their_own_name_only() {
    for (format, bytes) in files() {
        for other in Format::ALL {
            let outcome = read(
                other,
                "x",
                &bytes,
                &mut no_files,
                &ReadOptions::default(),
                &Unmonitored,
            );
            // The JSON of a GLB file lacks its buffer.
            assert_eq!(
                outcome.is_ok(),
                other == format && format != Format::Gltf,
                "{format} as {other}"
            );
        }
    }
}

/// A monitor that asks to stop at once.
struct Impatient;

impl Monitor for Impatient {
    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn everything_stops_when_asked() {
    let options = ReadOptions::default();
    for (format, bytes) in files().into_iter().filter(|file| file.0 != Format::Gltf) {
        let outcome = read(format, "x", &bytes, &mut no_files, &options, &Impatient);
        assert_eq!(outcome.unwrap_err(), IoError::Cancelled, "{format}");
        let mesh = read(format, "x", &bytes, &mut no_files, &options, &Unmonitored)
            .unwrap()
            .mesh;
        let (text, binary) = (TextOrBinary::Text, TextOrBinary::Binary);
        for outcome in [
            write_obj(&mesh, &ObjOptions::default(), &Impatient),
            write_glb(&mesh, &GlbOptions::default(), &Impatient),
            write_stl(&mesh, &StlOptions { encoding: text }, &Impatient),
            write_ply(&mesh, &PlyOptions { encoding: binary }, &Impatient),
        ] {
            assert_eq!(outcome.unwrap_err(), IoError::Cancelled);
        }
    }
}
