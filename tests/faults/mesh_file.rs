//! Faults 35 to 44 and 59 to 69: files of meshes.

use std::fmt::Write as _;

use serde_json::Value;

use super::desk::{Desk, Done, SMALL};

/// Three vertices to which a test adds.
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// `info --json` on one file, within 512 MiB of address space where that can
/// be limited.
fn info(name: &str, content: impl AsRef<[u8]>) -> Done {
    let desk = Desk::new();
    desk.write(name, content);
    #[cfg(unix)]
    return desk.limited(SMALL, &["info", name, "--json"]);
    #[cfg(not(unix))]
    desk.run(&["info", name, "--json"])
}

/// A file with this many vertices and faces.
#[track_caller]
fn loads(name: &str, content: impl AsRef<[u8]>, counts: (u64, u64)) {
    let done = info(name, content);
    done.made();
    let found: Value = serde_json::from_str(&done.out).expect("JSON");
    let count = |what: &str| found[what].as_u64().expect("a count");
    assert_eq!((count("vertices"), count("faces")), counts);
}

#[track_caller]
fn refused(name: &str, content: impl AsRef<[u8]>, says: &[&str]) {
    info(name, content).refused(says);
}

#[track_caller]
fn obj_refused(rest: &str, says: &[&str]) {
    refused("a.obj", format!("{CORNER}{rest}"), says);
}

#[test]
fn f035_obj_as_it_is_found() {
    let lines = [
        "f 1 2 3",
        "f 1/1 2/1 3/1",
        "f 1//1 2//1 3//1",
        "f 1/1/1 2/1/1 3/1/1",
        "f -3 -2 -1",
        "f 1 -2 3",
        "f\t1   2\t3  # a comment",
        "f 1 \\\n 2 3",
        "g\no\ns off\nusemtl\nf 1 2 3",
    ];
    for line in lines {
        let text = format!("{CORNER}vt 0.5\nvt 0 0 0\nvn 0 0 1\n{line}");
        let first = text.replacen("/1", "/-2", 1);
        for text in [
            text.clone(),
            text.replace('\n', "\r\n"),
            format!("\u{feff}{text}"),
            first,
        ] {
            loads("a.obj", text, (3, 1));
        }
    }
    loads(
        "a.obj",
        format!("{CORNER}f 1 2 3\n").replace('\n', "\r"),
        (3, 1),
    );
    loads(
        "a.obj",
        "v 0 0 0 1\nv +1. .0 -0e0 0.5 0.5 0.5\nv 0 1E0 0 1 1 1 1\nf 1 2 3",
        (3, 1),
    );
    let latin = format!("# Latin-1: \u{e9}\n{CORNER}f 1 2 3\n");
    let bytes: Vec<u8> = latin.chars().map(|c| c as u8).collect();
    loads("a.obj", bytes, (3, 1));
    let mut round = String::new();
    for k in 0..1000 {
        // A star: concave, and simple.
        let (radius, angle) = (
            1.0 + f64::from(k % 2),
            f64::from(k) * 0.002 * std::f64::consts::PI,
        );
        let place = tessgraph_geometry::math::cos(angle) * radius;
        let _ = writeln!(
            round,
            "v {place} {} 0",
            tessgraph_geometry::math::sin(angle) * radius
        );
    }
    let corners: Vec<_> = (1..=1000).map(|k| k.to_string()).collect();
    let _ = writeln!(round, "f {}", corners.join(" "));
    loads("a.obj", round, (1000, 1));
}

#[test]
fn f036_references_that_lead_nowhere() {
    let huge = "100000000000000000000";
    for index in [
        "0",
        "4",
        "-4",
        "4294967297",
        huge,
        "-9223372036854775808",
        "1.5",
        "0x1",
        "one",
    ] {
        obj_refused(&format!("f {index} 2 3"), &["a.obj:4:3"]);
    }
    // The shape is sound without them.
    let warned = |rest: &str, says| {
        info("a.obj", format!("{CORNER}{rest}")).warned(&[says]);
    };
    warned(
        "vt 0 0\nf 1/2 2/1 3/1",
        "1 corner names a texture coordinate",
    );
    warned("f 1//1 2//1 3//1", "3 corners name a normal");
}

#[test]
fn f037_faces_with_too_few_corners() {
    for line in ["f", "f 1", "f 1 2"] {
        obj_refused(line, &["a.obj:4:", "corner"]);
    }
}

#[test]
fn f038_coordinates_that_are_none() {
    for line in ["v 1 2", "v", "v 1 2 x", "v 1,5 2 3", "v 1 2 3e"] {
        obj_refused(line, &["a.obj:4:"]);
    }
}

#[test]
fn f039_coordinates_that_are_not_finite() {
    for number in ["nan", "-1.#IND", "inf", "1e400", "-Infinity"] {
        obj_refused(&format!("v {number} 0 0"), &["a.obj:4:3"]);
    }
}

#[test]
fn f040_coordinates_that_overflow() {
    for number in ["1e155", "1e308"] {
        obj_refused(
            &format!("v {number} 0 0\nf 2 3 4"),
            &["area or volume overflows"],
        );
    }
    // What a format cannot hold is refused when it is written.
    let desk = Desk::with(
        "Graph(version: 1, nodes: {\"out\": ReadMesh(path: \"a.obj\")},
         outputs: {\"o.obj\": \"out\", \"o.glb\": \"out\", \"o.stl\": \"out\"})",
    );
    desk.write("a.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1e39 0\nf 1 2 3\n");
    desk.go().sound().refused(&["o.glb"]);
    for name in ["o.glb", "o.stl"] {
        assert!(!desk.path(name).exists(), "{name}");
    }
    assert!(desk.path("o.obj").is_file());
}

#[test]
fn f042_other_files_under_the_wrong_name() {
    let others: [(&[u8], &str); 6] = [
        (b"<!DOCTYPE html><html>", "web page"),
        (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n",
            "git-lfs",
        ),
        (b"\x1f\x8b\x08\0\0\0\0\0\0\x03", "gzip"),
        (b"glTF\x02\0\0\0\x0c\0\0\0", "GLB"),
        (b"\xff\xfev\0 \0", "UTF-16"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\x0d", "PNG"),
    ];
    for (bytes, what) in others {
        for name in ["a.obj", "a.stl", "a.ply", "a.gltf"] {
            refused(name, bytes, &[name, what]);
        }
    }
}

#[cfg(unix)]
#[test]
fn f043_names_in_files_are_not_followed_out_of_the_folder() {
    // Opening a pipe without a writer would wait for ever.
    let desk = Desk::new();
    desk.write(
        "in/a.obj",
        format!("call ../pipe\ncsh ../pipe\nmtllib ../pipe /dev/zero\n{CORNER}usemtl m\nf 1 2 3\n"),
    );
    let made = std::process::Command::new("mkfifo")
        .arg(desk.path("pipe"))
        .status();
    assert!(made.expect("mkfifo").success());
    let done = desk.run(&["info", "in/a.obj"]);
    done.warned(&["call", "csh", "pipe"]);
    desk.write(
        "g.ron",
        super::desk::graph("\"out\": ReadMesh(path: \"in/a.obj\")"),
    );
    std::fs::rename(desk.path("g.ron"), desk.path("in/g.ron")).expect("a file");
    std::fs::rename(desk.path("in/a.obj"), desk.path("in/b.obj")).expect("a file");
    desk.write(
        "in/g.ron",
        super::desk::graph("\"out\": ReadMesh(path: \"b.obj\")"),
    );
    desk.run(&["run", "in/g.ron"]).warned(&["pipe"]);
}

#[test]
fn f044_much_of_everything() {
    let mut face = String::from("f");
    let mut vertices = String::new();
    for k in 1..=600_000 {
        let _ = writeln!(vertices, "v {k} {} 0", k % 7);
        let _ = write!(face, " {k}");
    }
    info("a.obj", format!("{vertices}{face}\n")).sound();
    let lines = |word: &str, count: usize| {
        let mut text = CORNER.to_owned();
        for k in 0..count {
            let _ = writeln!(text, "{word} n{k}\nf 1 2 3");
        }
        text
    };
    loads("a.obj", lines("g", 200_000), (3, 200_000));
    loads("a.obj", lines("o", 50_000), (3, 50_000));
    info(
        "a.obj",
        format!("{CORNER}# {}\nf 1 2 3\n", "x".repeat(10 << 20)),
    )
    .made();
    info(
        "a.obj",
        format!("{CORNER}g {}\nf 1 2 3\n", "x".repeat(10 << 20)),
    )
    .sound();
}

/// A glTF with this much beside its version.
fn gltf(rest: &str) -> String {
    format!("{{\"asset\": {{\"version\": \"2.0\"}}{rest}}}")
}

/// A triangle whose buffer is `uri`, with some text replaced.
fn triangle(uri: &str, from: &str, to: &str) -> String {
    let text = gltf(&format!(
        ", \"buffers\": [{{\"uri\": \"{uri}\", \"byteLength\": 36}}],
        \"bufferViews\": [{{\"buffer\": 0, \"byteOffset\": 0, \"byteLength\": 36}}],
        \"accessors\": [{{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}}],
        \"meshes\": [{{\"primitives\": [{{\"attributes\": {{\"POSITION\": 0}}}}]}}],
        \"nodes\": [{{\"mesh\": 0}}], \"scenes\": [{{\"nodes\": [0]}}], \"scene\": 0"
    ));
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

/// Three points as a data URI: zeros but for two coordinates of 1.
const POINTS: &str =
    "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

#[test]
fn f059_f060_required_extensions_that_are_not_known() {
    loads("a.gltf", triangle(POINTS, "\"scene\"", "\"scene\""), (3, 1));
    for name in [
        "KHR_draco_mesh_compression",
        "EXT_meshopt_compression",
        "ACME_secret",
    ] {
        let text = gltf(&format!(
            ", \"extensionsUsed\": [\"{name}\"], \"extensionsRequired\": [\"{name}\"]"
        ));
        refused("a.gltf", text, &["a.gltf", name]);
    }
}

#[test]
fn f061_other_versions_of_gltf() {
    for version in ["1.0", "3.0"] {
        refused(
            "a.gltf",
            gltf("").replace("2.0", version),
            &["a.gltf", version],
        );
    }
    let text = gltf("").replace("\"2.0\"", "\"2.0\", \"minVersion\": \"2.1\"");
    refused("a.gltf", text, &["2.1"]);
}

#[test]
fn f062_uris_that_lead_out_of_the_folder() {
    for uri in [
        "../../etc/passwd",
        "/etc/passwd",
        "file:///etc/passwd",
        "http://example.com/a.bin",
        "%2e%2e/a.bin",
        "..%5ca.bin",
        "..\\\\a.bin",
        "\\\\\\\\host\\\\a.bin",
        "/dev/zero",
        "/proc/self/environ",
        ".",
        "a.gltf",
        "",
    ] {
        refused(
            "a.gltf",
            triangle(uri, "36", "36"),
            &["a.gltf", "/buffers/0"],
        );
    }
}

#[test]
fn f063_bombs_in_headers() {
    for (from, to) in [
        ("\"count\": 3", "\"count\": 4611686018427387904"),
        ("\"count\": 3", "\"count\": 1000000000"),
        ("\"count\": 3", "\"count\": 4"),
        ("\"byteLength\": 36}]", "\"byteLength\": 1e300}]"),
        ("\"byteOffset\": 0", "\"byteOffset\": 18446744073709551608"),
        ("\"byteOffset\": 0", "\"byteOffset\": 1"),
        (
            "\"byteOffset\": 0",
            "\"byteStride\": 252, \"byteOffset\": 0",
        ),
    ] {
        let desk = Desk::new();
        desk.write("a.gltf", triangle(POINTS, from, to));
        #[cfg(unix)]
        desk.limited(100 << 10, &["info", "a.gltf"])
            .refused(&["a.gltf"]);
    }
}

#[test]
fn f064_nodes_without_end() {
    let nodes = |nodes: &str| triangle(POINTS, "[{\"mesh\": 0}]", nodes);
    refused(
        "a.gltf",
        nodes("[{\"children\": [0]}]"),
        &["a.gltf", "/nodes/0"],
    );
    refused(
        "a.gltf",
        nodes("[{\"children\": [1]}, {\"children\": [0]}]"),
        &["/nodes/"],
    );
    refused(
        "a.gltf",
        nodes("[{\"children\": [1, 2]}, {\"children\": [3]}, {\"children\": [3]}, {\"mesh\": 0}]"),
        &["/nodes/"],
    );
    let chain: Vec<_> = (1..20_000)
        .map(|k| format!("{{\"children\": [{k}]}}"))
        .collect();
    info(
        "a.gltf",
        nodes(&format!("[{}, {{\"mesh\": 0}}]", chain.join(","))),
    )
    .sound();
}

#[test]
fn f065_values_that_cannot_be() {
    for (from, to) in [
        ("\"POSITION\": 0", "\"POSITION\": 7"),
        ("\"bufferView\": 0", "\"bufferView\": 9"),
        ("\"mesh\": 0", "\"mesh\": 3"),
        ("\"POSITION\": 0}", "\"POSITION\": 0}, \"indices\": 0"),
        ("\"VEC3\"", "\"VEC2\""),
        ("5126", "5121"),
    ] {
        refused("a.gltf", triangle(POINTS, from, to), &["a.gltf", "/"]);
    }
    // 0x7f800000 is infinity.
    let infinite = POINTS.replace("AACAPwAA", "AACAfwAA");
    refused("a.gltf", triangle(&infinite, "36", "36"), &["a.gltf"]);
}

#[test]
fn f066_binary_files_cut_short_or_swapped() {
    let desk =
        Desk::with("Graph(version: 1, nodes: {\"out\": Grid()}, outputs: {\"o.glb\": \"out\"})");
    desk.go().made();
    let whole = desk.content("o.glb");
    let read = |bytes: &[u8]| {
        let mut none = |_: &str| Err(tessgraph_io::ResolveError::Failed("none".to_owned()));
        let options = tessgraph_io::ReadOptions::default();
        let (format, monitor) = (tessgraph_io::Format::Glb, tessgraph_geometry::Unmonitored);
        tessgraph_io::read(format, "o.glb", bytes, &mut none, &options, &monitor)
    };
    assert!(read(&whole).is_ok());
    for end in 0..whole.len() {
        assert!(read(&whole[..end]).is_err(), "cut to {end} bytes");
    }
    let json = u32::from_le_bytes(whole[12..16].try_into().expect("four")) as usize;
    for length in [0, 1, u32::MAX, u32::MAX - 3] {
        for at in [8, 12, 20 + json] {
            let mut bytes = whole.clone();
            bytes[at..at + 4].copy_from_slice(&length.to_le_bytes());
            assert!(read(&bytes).is_err(), "length {length} at {at}");
        }
    }
    let swapped = [&whole[..12], &whole[20 + json..], &whole[12..20 + json]].concat();
    assert!(read(&swapped).is_err());
    refused("a.glb", &whole[..40], &["a.glb", "byte"]);
}

#[test]
fn f067_mirrored_and_flat_nodes() {
    let placed = |node: &str| {
        let done = info(
            "a.gltf",
            triangle(POINTS, "{\"mesh\": 0}", &format!("{{\"mesh\": 0, {node}}}")),
        );
        done.sound();
        done
    };
    // The area keeps its sign inside: a mirrored triangle still faces outwards.
    placed("\"scale\": [-1, 1, 1]").made();
    placed("\"scale\": [0, 1, 1]");
    placed("\"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,1, 0,0,0,1]").refused(&["/nodes/0"]);
    placed("\"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]").made();
}

#[test]
fn f069_bombs_in_stl_and_ply() {
    let mut stl = vec![0; 84];
    stl[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    refused("a.stl", &stl, &["a.stl"]);
    let mut solid = b"solid but binary".to_vec();
    solid.resize(84, b' ');
    solid[80..].copy_from_slice(&1u32.to_le_bytes());
    let corners = [[0f32, 0.0, 1.0], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    solid.extend(corners.iter().flatten().flat_map(|c| c.to_le_bytes()));
    solid.extend([0, 0]);
    loads("a.stl", &solid, (3, 1));
    let ply =
        |format: &str, elements: &str| format!("ply\nformat {format} 1.0\n{elements}end_header\n");
    let place = "property float x\nproperty float y\nproperty float z\n";
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for count in ["4294967295", "18446744073709551615", "-1", "1e9"] {
            let header = ply(format, &format!("element vertex {count}\n{place}"));
            refused("a.ply", header, &["a.ply"]);
        }
        let lists = "element face 1\nproperty list uint int vertex_indices\n";
        let mut bytes = ply(format, &format!("element vertex 0\n{place}{lists}")).into_bytes();
        bytes.extend([0xff; 8]);
        refused("a.ply", bytes, &["a.ply"]);
    }
}
