//! Reading and writing glTF.

use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use serde_json::{Value, json};
use tessgraph_geometry::{
    Attribute, AttributeValues, Domain, Field, Labels, Material, Mesh, NO_LABEL, Quantity,
    Unmonitored, glam,
};

use crate::{
    FaultKind, Format, GlbColors, GlbNormals, GlbOptions, IoError, Loaded, Place, ReadOptions,
    ResolveError, no_files, read, write_glb,
};

fn load_bytes(format: Format, bytes: &[u8]) -> Result<Loaded, IoError> {
    read(
        format,
        "a.gltf",
        bytes,
        &mut no_files,
        &ReadOptions::default(),
        &Unmonitored,
    )
}

fn load(document: &Value) -> Result<Loaded, IoError> {
    load_bytes(Format::Gltf, document.to_string().as_bytes())
}

/// Four corners of a unit square in glTF's x-z plane, 48 bytes, then indices.
fn buffer(indices: &[u8]) -> Vec<u8> {
    let corners: [[f32; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, -1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut bytes: Vec<u8> = corners
        .iter()
        .flatten()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    bytes.extend(indices);
    bytes
}

fn uri(bytes: &[u8]) -> String {
    format!(
        "data:application/octet-stream;base64,{}",
        STANDARD.encode(bytes)
    )
}

/// A file with two triangles out of four vertices and byte indices.
fn document() -> Value {
    let bytes = buffer(&[0, 1, 2, 0, 2, 3]);
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 6},
        ],
        "buffers": [{"byteLength": bytes.len(), "uri": uri(&bytes)}],
    })
}

/// The document with the value at a JSON pointer replaced or added.
fn with(pointer: &str, value: Value) -> Value {
    let mut document = document();
    set(&mut document, pointer, value);
    document
}

fn set(document: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Object(map) => {
            map.insert(key.to_owned(), value);
        }
        Value::Array(list) => match key.parse::<usize>() {
            Ok(index) => list[index] = value,
            Err(_) => list.push(value),
        },
        _ => panic!("{pointer} has no parent"),
    }
}

fn places(mesh: &Mesh) -> Vec<[f64; 3]> {
    mesh.positions()
        .iter()
        .map(|place| place.to_array())
        .collect()
}

fn area_vector(mesh: &Mesh) -> DVec3 {
    let place = |vertex: u32| mesh.positions()[vertex as usize];
    let faces = mesh.topology().faces();
    faces
        .map(|f| (place(f[1]) - place(f[0])).cross(place(f[2]) - place(f[0])) * 0.5)
        .sum()
}

#[test]
fn y_up_becomes_z_up() {
    let mesh = load(&document()).unwrap().mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (4, 2));
    assert_eq!(places(&mesh)[2], [1.0, 1.0, 0.0]);
    assert_eq!(area_vector(&mesh), DVec3::Z);
}

#[test]
fn node_transforms_are_applied_parents_first() {
    let mut document = document();
    // A quarter turn about glTF's y, that is about our z, after a scale.
    let half = 0.5f64.sqrt();
    document["nodes"] = json!([
        {"children": [1], "translation": [5000000.125, 1, 0], "rotation": [0, half, 0, half]},
        {"mesh": 0, "scale": [2, 2, 2], "name": "panel"},
    ]);
    let mesh = load(&document).unwrap().mesh;
    let expected = [
        [5000000.125, 0.0, 1.0],
        [5000000.125, 2.0, 1.0],
        [5000000.125 - 2.0, 2.0, 1.0],
    ];
    for (place, expected) in mesh.positions().iter().zip(expected) {
        assert!((*place - DVec3::from(expected)).length() < 1e-8, "{place}");
    }
    assert_eq!(mesh.objects().labels(), ["panel"]);
    let matrix = json!([2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1]);
    let mesh = load(&with("/nodes/0/matrix", matrix)).unwrap().mesh;
    assert_eq!(places(&mesh)[0], [10.0, -30.0, 20.0]);
}

#[test]
fn mirrored_nodes_keep_their_outside() {
    let mut document = with("/nodes/0/scale", json!([-1, 1, 1]));
    let normals: Vec<u8> = [0.0f32, 1.0, 0.0]
        .repeat(4)
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    document["buffers"] = json!([document["buffers"][0], {"byteLength": 48, "uri": uri(&normals)}]);
    set(
        &mut document,
        "/bufferViews/-",
        json!({"buffer": 1, "byteLength": 48}),
    );
    set(
        &mut document,
        "/accessors/-",
        json!({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"}),
    );
    set(
        &mut document,
        "/meshes/0/primitives/0/attributes/NORMAL",
        json!(2),
    );
    let mesh = load(&document).unwrap().mesh;
    assert_eq!(area_vector(&mesh), DVec3::Z);
    let normals = AttributeValues::Vector3(vec![DVec3::Z; 6].into());
    assert_eq!(
        mesh.attribute("normal", Domain::Corner).unwrap().values(),
        &normals
    );
    let flat = load(&with("/nodes/0/scale", json!([0, 1, 1]))).unwrap();
    assert!(flat.warnings[0].contains("flattened"));
}

#[test]
fn instances_are_counted_each() {
    let mut document = document();
    document["nodes"] =
        json!([{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b"}, {"children": [1]}]);
    document["scenes"] = json!([{"nodes": [0, 2]}]);
    let mesh = load(&document).unwrap().mesh;
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (8, 4));
    assert_eq!(mesh.objects().of_face().as_slice(), [0, 0, 1, 1]);
}

#[test]
fn strips_fans_and_points() {
    let faces = |mode: u32, indices: &[u8]| {
        let bytes = buffer(indices);
        let mut document = with("/meshes/0/primitives/0/mode", json!(mode));
        document["buffers"] = json!([{"byteLength": bytes.len(), "uri": uri(&bytes)}]);
        set(&mut document, "/accessors/1/count", json!(indices.len()));
        set(
            &mut document,
            "/bufferViews/1/byteLength",
            json!(indices.len()),
        );
        let loaded = load(&document).unwrap();
        (
            loaded
                .mesh
                .topology()
                .faces()
                .map(<[u32]>::to_vec)
                .collect::<Vec<_>>(),
            loaded.warnings,
        )
    };
    assert_eq!(faces(5, &[0, 1, 3, 2]).0, [[0, 1, 3], [1, 2, 3]]);
    assert_eq!(faces(6, &[0, 1, 2, 3]).0, [[0, 1, 2], [0, 2, 3]]);
    let (none, warnings) = faces(0, &[0, 1]);
    assert!(
        none.is_empty() && warnings[0].contains("points or lines"),
        "{warnings:?}"
    );
    let (one, warnings) = faces(4, &[0, 1, 2, 3]);
    assert!(one.len() == 1 && warnings[0].contains("dropped"));
}

#[test]
fn uv_color_and_material_are_read() {
    let mut document = document();
    let uvs: Vec<u8> = [0u16, 65535, 65535, 65535, 65535, 0, 0, 0]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let colors = [255u8, 0, 0, 255].repeat(4);
    document["buffers"] =
        json!([document["buffers"][0], {"byteLength": 32, "uri": uri(&[uvs, colors].concat())}]);
    set(
        &mut document,
        "/bufferViews/-",
        json!({"buffer": 1, "byteLength": 16}),
    );
    set(
        &mut document,
        "/bufferViews/-",
        json!({"buffer": 1, "byteOffset": 16, "byteLength": 16}),
    );
    for accessor in [
        json!({"bufferView": 2, "componentType": 5123, "count": 4, "type": "VEC2", "normalized": true}),
        json!({"bufferView": 3, "componentType": 5121, "count": 4, "type": "VEC4", "normalized": true}),
    ] {
        set(&mut document, "/accessors/-", accessor);
    }
    set(
        &mut document,
        "/meshes/0/primitives/0/attributes",
        json!({"POSITION": 0, "TEXCOORD_0": 2, "TEXCOORD_2": 2, "COLOR_0": 3}),
    );
    set(&mut document, "/meshes/0/primitives/0/material", json!(1));
    document["materials"] = json!([{}, {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.2, 0.5], "metallicFactor": 0.25}}]);
    let mesh = load(&document).unwrap().mesh;
    let expected = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
    ]
    .map(DVec2::from);
    for name in ["uv", "uv2"] {
        let values = AttributeValues::Vector2(expected.to_vec().into());
        assert_eq!(
            mesh.attribute(name, Domain::Corner).unwrap().values(),
            &values
        );
    }
    let red = AttributeValues::Vector3(vec![DVec3::X; 4].into());
    assert_eq!(
        mesh.attribute("color", Domain::Vertex).unwrap().values(),
        &red
    );
    let material = &mesh.materials().labels()[0];
    assert_eq!(material.base_color, [0.8, 0.1, 0.2, 0.5]);
    assert_eq!((material.metallic, material.roughness), (0.25, 1.0));
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut document = document();
    let mut patch = vec![2, 0, 0, 0];
    patch.extend([7.0f32, 8.0, 9.0].iter().flat_map(|v| v.to_le_bytes()));
    document["buffers"] = json!([document["buffers"][0], {"byteLength": 16, "uri": uri(&patch)}]);
    set(
        &mut document,
        "/bufferViews/-",
        json!({"buffer": 1, "byteLength": 4}),
    );
    set(
        &mut document,
        "/bufferViews/-",
        json!({"buffer": 1, "byteOffset": 4, "byteLength": 12}),
    );
    let sparse = json!({"count": 1, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}});
    set(&mut document, "/accessors/0/sparse", sparse);
    assert_eq!(places(&load(&document).unwrap().mesh)[2], [7.0, -9.0, 8.0]);
    document["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    let mesh = load(&document).unwrap().mesh;
    assert_eq!(places(&mesh)[0], [0.0, 0.0, 0.0]);
    set(
        &mut document,
        "/accessors/0/count",
        json!(1_000_000_000_000u64),
    );
    let error = load(&document).unwrap_err();
    assert_eq!(error.fault().unwrap().kind, FaultKind::TooLarge);
}

/// A change of one value, and the pointer, kind and cause of the refusal.
#[rustfmt::skip]
fn faults() -> Vec<(&'static str, Value, &'static str, FaultKind, &'static str)> {
    use FaultKind::{Empty, NotFinite, OutOfRange, Syntax, Truncated, UnsafeReference, Unresolved, Unsupported};
    let nan: Vec<u8> = [f32::NAN; 16].iter().flat_map(|v| v.to_le_bytes()).collect();
    let primitive = "/meshes/0/primitives/0/attributes/POSITION";
    vec![
        ("/asset/version", json!("1.0"), "/asset/version", Unsupported, "glTF 1.0"),
        ("/asset/version", json!("3.0"), "/asset/version", Unsupported, "glTF 3.0"),
        ("/asset/minVersion", json!("2.1"), "/asset/minVersion", Unsupported, "needs glTF 2.1"),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "/extensionsRequired/0", Unsupported, "draco"),
        ("/extensionsRequired", json!(["KHR_texture_transform", "X_y"]), "/extensionsRequired/1", Unsupported, "X_y"),
        ("/scene", json!(4), "/scene", OutOfRange, "/scenes/4"),
        ("/scenes", json!([]), "/scenes", Empty, "no scene"),
        ("/scenes/0/nodes", json!([]), "/scenes/0", Empty, "no mesh"),
        ("/scenes/0/nodes", json!([7]), "/scenes/0/nodes", OutOfRange, "/nodes/7"),
        ("/nodes/0/children", json!([0]), "/nodes/0/children", Syntax, "second time"),
        ("/nodes/0/mesh", json!(3), "/nodes/0/mesh", OutOfRange, "/meshes/3"),
        ("/nodes/0/rotation", json!([0, 0, 0, 0]), "/nodes/0/rotation", Syntax, "zero"),
        ("/nodes/0/matrix", json!([1, 2]), "/nodes/0/matrix", Syntax, "2 numbers"),
        ("/nodes/0/matrix", json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "/nodes/0/matrix", Unsupported, "projection"),
        ("/nodes/0/translation", json!([1e308, 0, 0]), "", Syntax, ""),
        ("/meshes/0/primitives/0/mode", json!(9), "/meshes/0/primitives/0/mode", Syntax, "mode"),
        (primitive, json!(1), primitive, Syntax, "VEC3"),
        (primitive, json!(9), primitive, OutOfRange, "/accessors/9"),
        ("/accessors/0/count", json!(0), "/accessors/0/count", Syntax, "at least one"),
        ("/accessors/0/count", json!(5), "/accessors/0", OutOfRange, "lie outside the view of 48"),
        ("/accessors/0/count", json!(u64::MAX), "/accessors/0", OutOfRange, "lie outside"),
        ("/accessors/0/count", json!(-1), "/accessors/0", Syntax, "-1"),
        ("/accessors/0/count", json!(3.5), "/accessors/0", Syntax, "3.5"),
        ("/accessors/0/byteOffset", json!(u64::MAX - 7), "/accessors/0", OutOfRange, "lie outside"),
        ("/accessors/0/componentType", json!(5122), primitive, Syntax, "KHR_mesh_quantization"),
        ("/accessors/0/componentType", json!(1), "/accessors/0/componentType", Syntax, "does not exist"),
        ("/accessors/0/type", json!("VEC5"), "/accessors/0/type", Syntax, "does not exist"),
        ("/accessors/0/bufferView", json!(9), "/accessors/0/bufferView", OutOfRange, "/bufferViews/9"),
        ("/accessors/1/componentType", json!(5126), "/accessors/1", Syntax, "unsigned"),
        ("/bufferViews/0/byteStride", json!(4), "/bufferViews/0/byteStride", OutOfRange, "4 bytes apart"),
        ("/bufferViews/0/byteStride", json!(1u64 << 40), "/bufferViews/0/byteStride", OutOfRange, "apart"),
        ("/bufferViews/0/byteLength", json!(55), "/bufferViews/0", OutOfRange, "outside its buffer"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "/bufferViews/0", OutOfRange, "outside its buffer"),
        ("/bufferViews/0/buffer", json!(2), "/bufferViews/0/buffer", OutOfRange, "/buffers/2"),
        ("/buffers/0/byteLength", json!(55), "/buffers/0/byteLength", Truncated, "there are 54"),
        ("/buffers/0/byteLength", json!(1u64 << 62), "/buffers/0/byteLength", Truncated, "there are 54"),
        ("/buffers/0/uri", json!("data:;base64,@@"), "/buffers/0/uri", Syntax, "base64"),
        ("/buffers/0/uri", json!("data:text"), "/buffers/0/uri", Syntax, "comma"),
        ("/buffers/0/uri", json!(uri(&nan)), "/accessors/0", NotFinite, "element 0"),
        ("/buffers/0/uri", json!(uri(&buffer(&[0, 1, 2, 0, 2, 4]))), "/accessors/1", OutOfRange, "names vertex 4"),
        ("/buffers/0/uri", json!(uri(&buffer(&[0, 1, 2, 0, 2, 255]))), "/accessors/1", OutOfRange, "restart"),
        ("/buffers/0/uri", json!("../a.bin"), "/buffers/0/uri", UnsafeReference, "upwards"),
        ("/buffers/0/uri", json!("%2e%2e/a.bin"), "/buffers/0/uri", UnsafeReference, "upwards"),
        ("/buffers/0/uri", json!("./a.gltf"), "/buffers/0/uri", UnsafeReference, "itself"),
        ("/buffers/0/uri", json!("a.bin"), "/buffers/0/uri", Unresolved, "no such file"),
    ]
}

#[test]
fn refusals_point_at_the_value() {
    for (changed, value, pointer, kind, cause) in faults() {
        let outcome = load(&with(changed, value.clone()));
        if pointer.is_empty() {
            assert!(
                outcome
                    .unwrap()
                    .mesh
                    .positions()
                    .iter()
                    .all(|place| place.is_finite())
            );
            continue;
        }
        let error = outcome.unwrap_err();
        let fault = error.fault().unwrap();
        assert_eq!(
            fault.place,
            Place::Pointer(pointer.to_owned()),
            "{changed} {value}: {error}"
        );
        assert_eq!(fault.kind, kind, "{changed} {value}: {error}");
        assert!(fault.cause.contains(cause), "{changed} {value}: {error}");
    }
}

#[test]
fn overflowing_transforms_are_refused() {
    let mut document = with("/nodes/0/scale", json!([1e308, 1, 1]));
    document["nodes"] = json!([document["nodes"][0], {"children": [0], "scale": [1e308, 1, 1]}]);
    document["scenes"] = json!([{"nodes": [1]}]);
    let error = load(&document).unwrap_err();
    assert_eq!(error.fault().unwrap().kind, FaultKind::NotFinite);
}

#[test]
fn containers_are_checked() {
    let bytes = write_glb(&rich(), &GlbOptions::default(), &Unmonitored)
        .unwrap()
        .bytes;
    for cut in (0..bytes.len()).step_by(7) {
        assert!(load_bytes(Format::Glb, &bytes[..cut]).is_err(), "{cut}");
    }
    let word = |at: usize, value: u32| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        load_bytes(Format::Glb, &bytes).unwrap_err()
    };
    for (at, value, place) in [(4, 1, 4), (8, u32::MAX, 8), (12, u32::MAX, 12), (16, 7, 12)] {
        assert_eq!(word(at, value).fault().unwrap().place, Place::Byte(place));
    }
    let longer = [bytes.as_slice(), b"more"].concat();
    assert!(load_bytes(Format::Glb, &longer).unwrap().warnings[0].contains("4 bytes"));
    assert!(
        load_bytes(Format::Gltf, &bytes)
            .unwrap_err()
            .to_string()
            .contains("name it .glb")
    );
    assert!(
        load_bytes(Format::Glb, b"{}")
            .unwrap_err()
            .to_string()
            .contains("JSON")
    );
}

#[test]
fn broken_json_has_a_place() {
    let error = load_bytes(Format::Gltf, b"{\n\"asset\": {,\n}").unwrap_err();
    assert_eq!(
        error.fault().unwrap().place,
        Place::Line {
            line: 2,
            column: 11
        },
        "{error}"
    );
    let deep = format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"extras\": {}",
        "[".repeat(100_000)
    );
    assert!(load_bytes(Format::Gltf, deep.as_bytes()).is_err());
}

#[test]
fn memory_is_limited_before_it_is_taken() {
    let mut document = document();
    let nodes: Vec<Value> = (0..1000).map(|_| json!({"mesh": 0})).collect();
    document["scenes"] = json!([{"nodes": (0..1000).collect::<Vec<_>>()}]);
    document["nodes"] = nodes.into();
    let options = ReadOptions {
        memory_limit: 100_000,
        ..ReadOptions::default()
    };
    let text = document.to_string();
    let error = read(
        Format::Gltf,
        "a.gltf",
        text.as_bytes(),
        &mut no_files,
        &options,
        &Unmonitored,
    )
    .unwrap_err();
    assert_eq!(error.fault().unwrap().kind, FaultKind::TooLarge);
    assert_eq!(load(&document).unwrap().mesh.face_count(), 2000);
}

#[test]
fn deep_trees_need_no_stack() {
    let mut document = document();
    let depth = 100_000;
    let mut nodes: Vec<Value> = (1..depth).map(|k| json!({"children": [k]})).collect();
    nodes.push(json!({"mesh": 0}));
    document["nodes"] = nodes.into();
    assert_eq!(load(&document).unwrap().mesh.face_count(), 2);
}

#[test]
fn buffers_beside_the_file_are_asked_for_by_decoded_name() {
    let document = with("/buffers/0/uri", json!("sub/a%20b.bin"));
    let bytes: Arc<[u8]> = buffer(&[0, 1, 2, 0, 2, 3]).into();
    let mut asked = Vec::new();
    let mut resolve = |name: &str| {
        asked.push(name.to_owned());
        if name == "sub/a b.bin" {
            Ok(bytes.clone())
        } else {
            Err(ResolveError::NotFound)
        }
    };
    let text = document.to_string();
    let options = ReadOptions::default();
    read(
        Format::Gltf,
        "a.gltf",
        text.as_bytes(),
        &mut resolve,
        &options,
        &Unmonitored,
    )
    .unwrap();
    assert_eq!(asked, ["sub/a b.bin"]);
}

/// A square with a hole of materials, uvs, colours and a name, far away.
fn rich() -> Mesh {
    let at = |x: f64, y: f64| [5_000_000.25 + x, 300_000.5 + y, 120.0 + x * y];
    let places = vec![
        at(0.0, 0.0),
        at(1.0, 0.0),
        at(1.0, 1.0),
        at(0.0, 1.0),
        at(2.0, 0.0),
        at(2.0, 1.0),
    ];
    let mesh = Mesh::from_faces(places, &[&[0, 1, 2, 3][..], &[1, 4, 5], &[1, 5, 2]]).unwrap();
    let uvs = (0..10)
        .map(|k| DVec2::new(f64::from(k) * 0.125, 0.25))
        .collect();
    let colors = (0..6)
        .map(|k| DVec3::new(f64::from(k) / 5.0, 1.0, 0.0))
        .collect();
    let glass = Material {
        base_color: [0.8, 0.9, 1.0, 0.5],
        metallic: 0.0,
        roughness: 0.1,
        ..Material::named("glass")
    };
    mesh.with_attribute(Attribute::new(
        "uv",
        Domain::Corner,
        AttributeValues::Vector2(uvs),
    ))
    .unwrap()
    .with_attribute(Attribute::new(
        "color",
        Domain::Vertex,
        AttributeValues::Vector3(colors),
    ))
    .unwrap()
    .with_materials(Labels::new(vec![Material::named("x"), glass], vec![1, NO_LABEL, 1]).unwrap())
    .unwrap()
}

fn options(normals: GlbNormals) -> GlbOptions<'static> {
    GlbOptions {
        normals,
        name: Some("façade"),
        extras: Some(json!({"graph": "facade.ron"})),
        ..GlbOptions::default()
    }
}

#[test]
fn what_is_written_reads_back_in_place() {
    let mesh = rich();
    for normals in [GlbNormals::Flat, GlbNormals::Smooth] {
        let written = write_glb(&mesh, &options(normals), &Unmonitored).unwrap();
        let again = load_bytes(Format::Glb, &written.bytes).unwrap().mesh;
        assert_eq!(again.face_count(), 4);
        assert_eq!(again.bounds(), mesh.bounds());
        assert!((area_vector(&again) - area_vector(&triangulated(&mesh))).length() < 1e-6);
        assert_eq!(again.objects().labels(), ["façade"]);
        let names: Vec<_> = again
            .materials()
            .labels()
            .iter()
            .map(|m| m.name.as_str())
            .collect();
        assert_eq!(names, ["glass", "default"]);
        assert_eq!(
            again.materials().labels()[0].base_color,
            [0.8, 0.9, 1.0, 0.5]
        );
        let AttributeValues::Vector2(uvs) = again.attribute("uv", Domain::Corner).unwrap().values()
        else {
            panic!("uv is of another type")
        };
        assert_eq!(uvs[0], DVec2::new(0.0, 0.25));
        let AttributeValues::Vector3(normals) =
            again.attribute("normal", Domain::Corner).unwrap().values()
        else {
            panic!("normal is of another type")
        };
        assert!(
            normals
                .iter()
                .all(|normal| (normal.length() - 1.0).abs() < 1e-6)
        );
        assert!(again.attribute("color", Domain::Vertex).is_some());
    }
}

fn triangulated(mesh: &Mesh) -> Mesh {
    let faces = mesh.triangle_vertices(&mesh.triangles());
    Mesh::from_faces(
        mesh.positions().iter().map(|p| p.to_array()).collect(),
        &faces,
    )
    .unwrap()
}

#[test]
fn another_reader_takes_what_is_written() {
    let bytes = write_glb(&rich(), &options(GlbNormals::Smooth), &Unmonitored)
        .unwrap()
        .bytes;
    let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = gltf.blob.clone().unwrap();
    let node = gltf.default_scene().unwrap().nodes().next().unwrap();
    assert_eq!(node.name(), Some("façade"));
    let mesh = node.mesh().unwrap();
    assert_eq!(mesh.primitives().len(), 2);
    for primitive in mesh.primitives() {
        let reader = primitive.reader(|_| Some(&blob));
        let places: Vec<_> = reader.read_positions().unwrap().collect();
        let count = places.len() as u32;
        assert!(
            reader
                .read_indices()
                .unwrap()
                .into_u32()
                .all(|index| index < count)
        );
        for k in 0..3 {
            let low = places
                .iter()
                .map(|place| place[k])
                .fold(f32::INFINITY, f32::min);
            assert_eq!(primitive.bounding_box().min[k].to_bits(), low.to_bits());
        }
        assert_eq!(
            primitive
                .material()
                .pbr_metallic_roughness()
                .metallic_factor()
                .to_bits(),
            0
        );
    }
    let extras: Value =
        serde_json::from_str(gltf.document.as_json().asset.extras.as_ref().unwrap().get()).unwrap();
    assert_eq!(extras["graph"], "facade.ron");
}

#[test]
fn near_meshes_stay_at_the_origin() {
    let quad = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Mesh::from_faces(quad, &[[0, 1, 2, 3]]).unwrap();
    let bytes = write_glb(&mesh, &GlbOptions::default(), &Unmonitored)
        .unwrap()
        .bytes;
    assert!(!String::from_utf8_lossy(&bytes).contains("translation"));
    let again = load_bytes(Format::Glb, &bytes).unwrap().mesh;
    assert_eq!(places(&again), places(&mesh));
}

#[test]
fn fields_become_colors_with_their_range() {
    let mesh = rich();
    let heights = mesh.positions().iter().map(|place| place.z).collect();
    let vertices = Field::new(Domain::Vertex, Quantity::Length, heights).unwrap();
    let faces = Field::new(Domain::Face, Quantity::Number, vec![1.0, 1.0, 1.0]).unwrap();
    for (field, range) in [
        (&vertices, json!([120.0, 122.0])),
        (&faces, json!([1.0, 1.0])),
    ] {
        let colors = GlbColors::Field {
            field,
            name: "height",
            range: None,
        };
        for normals in [GlbNormals::Flat, GlbNormals::Smooth] {
            let options = GlbOptions {
                colors,
                normals,
                ..GlbOptions::default()
            };
            let bytes = write_glb(&mesh, &options, &Unmonitored).unwrap().bytes;
            let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
            let extras = gltf
                .meshes()
                .next()
                .unwrap()
                .extras()
                .as_ref()
                .unwrap()
                .get()
                .to_owned();
            let extras: Value = serde_json::from_str(&extras).unwrap();
            assert_eq!(extras["field"]["range"], range);
            assert!(
                load_bytes(Format::Glb, &bytes)
                    .unwrap()
                    .mesh
                    .attribute("color", Domain::Vertex)
                    .is_some()
            );
        }
    }
    let wrong = Field::new(Domain::Vertex, Quantity::Number, vec![1.0]).unwrap();
    let colors = GlbColors::Field {
        field: &wrong,
        name: "x",
        range: None,
    };
    assert!(
        write_glb(
            &mesh,
            &GlbOptions {
                colors,
                ..GlbOptions::default()
            },
            &Unmonitored
        )
        .is_err()
    );
}

#[test]
fn empty_and_impossible_meshes() {
    let empty = Mesh::from_faces(vec![[1.0; 3]], &[[0u32; 3]; 0]).unwrap();
    let written = write_glb(&empty, &GlbOptions::default(), &Unmonitored).unwrap();
    assert!(written.warnings[0].contains("no faces"));
    assert!(gltf::Gltf::from_slice(&written.bytes).is_ok());
    let error = load_bytes(Format::Glb, &written.bytes).unwrap_err();
    assert_eq!(error.fault().unwrap().kind, FaultKind::Empty);
    for size in [1e39, 1e155, 1e308] {
        let places = vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]];
        let mesh = Mesh::from_faces(places, &[[0, 1, 2]]).unwrap();
        let error = write_glb(&mesh, &GlbOptions::default(), &Unmonitored).unwrap_err();
        assert!(error.to_string().contains("vertex 1"), "{error}");
    }
    let point = Mesh::from_faces(vec![[1e15, -3.0, 1e-320]; 3], &[[0, 1, 2]]).unwrap();
    let bytes = write_glb(&point, &GlbOptions::default(), &Unmonitored)
        .unwrap()
        .bytes;
    let again = load_bytes(Format::Glb, &bytes).unwrap().mesh;
    assert_eq!(again.positions()[0], DVec3::new(1e15, -3.0, 1e-320));
}

proptest! {
    #[test]
    fn positions_keep_seven_digits_of_the_size(
        centre in prop::array::uniform3(-1e7..1e7f64),
        size in 1e-3..1e3f64,
        corners in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 3..3usize + 1),
    ) {
        let places: Vec<_> = corners.iter().map(|corner| (DVec3::from(centre) + DVec3::from(*corner) * size).to_array()).collect();
        let mesh = Mesh::from_faces(places, &[[0, 1, 2]]).unwrap();
        let bytes = write_glb(&mesh, &GlbOptions::default(), &Unmonitored).unwrap().bytes;
        let again = load_bytes(Format::Glb, &bytes).unwrap().mesh;
        for (a, b) in again.positions().iter().zip(mesh.positions().iter()) {
            prop_assert!((*a - *b).length() <= mesh.diagonal() * 1e-6, "{} {}", a, b);
        }
    }
}
