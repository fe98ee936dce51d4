//! What is written is read back, and nothing else is.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use tessgraph_geometry::digest::Digest;
use tessgraph_geometry::{
    Attribute, AttributeValues, DirectionSource, Directions, Domain, Field, Labels, Material, Mesh,
    NO_LABEL, Quantity, Topology,
};

use super::entry::Entry;
use super::frame::{self, FileKind};
use crate::eval::cache::{Cache, Known};
use crate::node::FileUse;
use crate::value::encode::{Decoder, Encoder, decode_topology, encode_topology};
use crate::value::{Column, ColumnValues, Report, ReportEntry, Scalar, Table, Value};

/// A value's bytes and the topologies they name.
fn encoded(value: &Value) -> (Vec<u8>, Vec<Arc<Topology>>) {
    let mut out = Encoder::new();
    assert!(value.encode(&mut out), "{:?} is stored", value.kind());
    out.finish()
}

fn decoded(bytes: &[u8], topologies: &[Arc<Topology>]) -> Option<Value> {
    let find = |digest: Digest| {
        let found = topologies.iter().find(|one| one.digest() == digest);
        // Through its own bytes, as on disk.
        found.and_then(|one| decode_topology(&encode_topology(one)).map(Arc::new))
    };
    let mut from = Decoder::new(bytes, &find);
    let value = Value::decode(&mut from)?;
    from.finish(value)
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1e6..1e6,
        1 => Just(0.0),
        1 => Just(5e-324),
        1 => Just(-f64::MAX),
    ]
}

fn vector() -> impl Strategy<Value = DVec3> {
    [finite(), finite(), finite()].prop_map(DVec3::from)
}

fn text() -> impl Strategy<Value = String> {
    "[a-zé ☃\"]{0,12}"
}

fn quantity() -> impl Strategy<Value = Quantity> {
    prop::sample::select(vec![
        Quantity::Number,
        Quantity::Length,
        Quantity::Area,
        Quantity::Volume,
        Quantity::Angle,
    ])
}

/// Polygons of three to six sides over up to 20 vertices, and no faces at all.
fn topology() -> impl Strategy<Value = Arc<Topology>> {
    (0..20usize).prop_flat_map(|vertices| {
        let most = if vertices == 0 { 0 } else { 8 };
        let face = prop::collection::vec(0..vertices.max(1) as u32, 3..7);
        prop::collection::vec(face, 0..=most).prop_map(move |faces| {
            let mut offsets = vec![0];
            for face in &faces {
                offsets.push(offsets[offsets.len() - 1] + face.len() as u32);
            }
            let corners = faces.concat();
            Arc::new(Topology::new(vertices, offsets, corners).expect("a valid topology"))
        })
    })
}

fn labels<L: Clone + std::fmt::Debug>(
    faces: usize,
    label: impl Strategy<Value = L>,
) -> impl Strategy<Value = Labels<L>> {
    prop::collection::vec(label, 1..4).prop_flat_map(move |labels| {
        let index = prop_oneof![0..labels.len() as u32, Just(NO_LABEL)];
        let one_each = prop::collection::vec(index, faces);
        (Just(labels), one_each)
            .prop_map(|(labels, of_face)| Labels::new(labels, of_face).expect("indices of labels"))
    })
}

fn attribute(mesh: &Mesh) -> impl Strategy<Value = Attribute> + use<> {
    let counts = [mesh.vertex_count(), mesh.face_count(), mesh.corner_count()];
    let domains = [Domain::Vertex, Domain::Face, Domain::Corner];
    (text(), 0..3usize, 0..4u8).prop_flat_map(move |(name, domain, kind)| {
        let numbers = prop::collection::vec(vector(), counts[domain]);
        numbers.prop_map(move |vectors| {
            let values = match kind {
                0 => AttributeValues::Integer(vectors.iter().map(|v| v.x as i64).collect()),
                1 => AttributeValues::Number(vectors.iter().map(|v| v.x).collect()),
                2 => {
                    AttributeValues::Vector2(vectors.iter().map(|v| DVec2::new(v.x, v.y)).collect())
                }
                _ => AttributeValues::Vector3(vectors.into()),
            };
            Attribute::new(name.clone(), domains[domain], values)
        })
    })
}

fn mesh() -> impl Strategy<Value = Mesh> {
    let bare = topology().prop_flat_map(|topology| {
        prop::collection::vec(vector(), topology.vertex_count())
            .prop_map(move |at| Mesh::new(at, Arc::clone(&topology)).expect("finite positions"))
    });
    let material = (text(), [0.0..1.0, 0.0..1.0, 0.0..1.0, 0.0..1.0]).prop_map(|(name, color)| {
        let [red, green, ..] = color;
        Material {
            name,
            base_color: color,
            metallic: red,
            roughness: green,
        }
    });
    let material = material.boxed();
    bare.prop_flat_map(move |mesh| {
        let faces = mesh.face_count();
        let attributes = prop::collection::vec(attribute(&mesh), 0..4);
        let materials = labels(faces, material.clone());
        let groups = labels(faces, prop::collection::vec(text(), 0..3));
        let objects = labels(faces, text());
        (Just(mesh), attributes, materials, groups, objects)
    })
    .prop_map(|(mesh, attributes, materials, groups, objects)| {
        let mesh = attributes.into_iter().fold(mesh, |mesh, attribute| {
            mesh.with_attribute(attribute).expect("one value each")
        });
        let mesh = mesh.with_materials(materials).expect("one label each");
        let mesh = mesh.with_groups(groups).expect("one label each");
        mesh.with_objects(objects).expect("one label each")
    })
}

fn directions() -> impl Strategy<Value = Directions> {
    (topology(), any::<(bool, bool, bool)>()).prop_flat_map(|(topology, flags)| {
        let side = || prop::collection::vec(vector(), topology.vertex_count());
        let sides = (side(), side());
        sides.prop_map(move |(outward, inward)| {
            let (shared, target, compensated) = flags;
            let source = if target {
                DirectionSource::Target
            } else {
                DirectionSource::Surface
            };
            let inward = (!shared).then_some(inward);
            let topology = Arc::clone(&topology);
            Directions::from_parts(topology, outward, inward, source, compensated)
                .expect("finite vectors")
        })
    })
}

fn report() -> impl Strategy<Value = Report> {
    let scalar = prop_oneof![
        any::<bool>().prop_map(Scalar::Bool),
        any::<i64>().prop_map(Scalar::Integer),
        finite().prop_map(Scalar::Number),
        text().prop_map(|text| Scalar::Text(text.into())),
    ];
    let entry = (text(), quantity(), scalar).prop_map(|(name, quantity, value)| ReportEntry {
        name,
        quantity,
        value,
    });
    prop::collection::vec(entry, 0..6).prop_map(Report::new)
}

fn table() -> impl Strategy<Value = Table> {
    (0..5usize).prop_flat_map(|rows| {
        let cells = prop_oneof![
            prop::collection::vec(any::<i64>(), rows).prop_map(ColumnValues::Integer),
            prop::collection::vec(prop_oneof![finite(), Just(f64::NAN)], rows)
                .prop_map(ColumnValues::Number),
            prop::collection::vec(text().prop_map(Arc::from), rows).prop_map(ColumnValues::Text),
        ];
        let column = (text(), quantity(), cells).prop_map(|(name, quantity, values)| Column {
            name,
            quantity,
            values,
        });
        prop::collection::vec(column, 0..4)
            .prop_map(|columns| Table::new(columns).expect("columns of one length"))
    })
}

fn value() -> impl Strategy<Value = Value> {
    let field = (
        any::<bool>(),
        quantity(),
        prop::collection::vec(finite(), 0..9),
    )
        .prop_map(|(vertex, quantity, values)| {
            let domain = if vertex { Domain::Vertex } else { Domain::Face };
            Field::new(domain, quantity, values).expect("finite values")
        });
    let one = prop_oneof![
        any::<bool>().prop_map(Value::Bool),
        any::<i64>().prop_map(Value::Integer),
        any::<f64>().prop_map(Value::Number),
        text().prop_map(|text| Value::Text(text.into())),
        vector().prop_map(Value::Vector),
        prop::sample::select(vec!["Local", "Global"]).prop_map(Value::Choice),
        mesh().prop_map(|mesh| Value::Mesh(Arc::new(mesh))),
        directions().prop_map(|directions| Value::Directions(Arc::new(directions))),
        field.prop_map(|field| Value::Field(Arc::new(field))),
        report().prop_map(|report| Value::Report(Arc::new(report))),
        table().prop_map(|table| Value::Table(Arc::new(table))),
    ];
    one.prop_recursive(2, 8, 3, |item| {
        prop::collection::vec(item, 0..3).prop_map(|items| Value::List(items.into()))
    })
}

proptest! {
    #[test]
    fn every_value_comes_back_as_it_was(value in value()) {
        let (bytes, topologies) = encoded(&value);
        let back = decoded(&bytes, &topologies).expect("what was written is read");
        prop_assert_eq!(back.digest(), value.digest());
        prop_assert_eq!(back.kind(), value.kind());
        // Byte for byte, and so also where a digest does not look: the sign of zero.
        prop_assert_eq!(encoded(&back).0, bytes);
    }

    #[test]
    fn decoding_never_panics(value in value(), at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let (mut bytes, topologies) = encoded(&value);
        let place = at.index(bytes.len());
        prop_assert!(decoded(&bytes[..place], &topologies).is_none(), "cut at {}", place);
        bytes[place] = byte;
        let _ = decoded(&bytes, &topologies);
        let _ = Entry::decode(&bytes);
        let _ = decode_topology(&bytes);
    }

    #[test]
    fn arbitrary_bytes_are_refused_quietly(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = decoded(&bytes, &[]);
        let _ = Entry::decode(&bytes);
        let _ = decode_topology(&bytes);
        prop_assert!(frame::content(FileKind::Value, Digest::of(b""), &bytes).is_none());
    }

    #[test]
    fn entries_come_back_as_they_were(
        values in prop::collection::vec(value(), 0..4),
        warnings in prop::collection::vec(text(), 0..3),
        relative in text(),
        content in any::<Option<u64>>(),
    ) {
        let content = content.map(|number| Digest::of(&number.to_le_bytes()));
        let entry = Entry {
            results: values.iter().map(Known::new).collect(),
            files: vec![FileUse { input: 1, relative, content }],
            warnings,
            ms: 1.5,
            bytes: 17,
        };
        let bytes = entry.encode();
        let back = Entry::decode(&bytes).expect("what was written is read");
        prop_assert_eq!(back.encode(), bytes);
        prop_assert_eq!(&back.files, &entry.files);
        prop_assert_eq!(&back.warnings, &entry.warnings);
    }
}

#[test]
fn lists_nested_without_end_are_refused() {
    // As bytes: a real value of that depth would overflow the stack of whoever
    // looks at it.
    let mut out = Encoder::new();
    for _ in 0..100_000 {
        out.text("List").number(1);
    }
    Value::Number(1.0).encode(&mut out);
    assert!(decoded(&out.finish().0, &[]).is_none());
}

#[test]
fn a_file_is_refused_for_any_flipped_bit_and_under_another_name() {
    let address = Digest::of(b"address");
    let content = b"what it holds";
    let mut file = frame::header(FileKind::Value, address, 2.5, content).to_vec();
    file.extend_from_slice(content);
    assert_eq!(
        frame::content(FileKind::Value, address, &file),
        Some(&content[..])
    );
    assert!((frame::cost(&file) - 2.5).abs() < 1e-15);
    for place in 0..file.len() {
        for bit in 0..8 {
            file[place] ^= 1 << bit;
            let found = frame::content(FileKind::Value, address, &file);
            assert_eq!(found, None, "bit {bit} of byte {place}");
            file[place] ^= 1 << bit;
        }
        assert_eq!(
            frame::content(FileKind::Value, address, &file[..place]),
            None
        );
    }
    assert_eq!(frame::content(FileKind::Entry, address, &file), None);
    assert_eq!(
        frame::content(FileKind::Value, Digest::of(b"other"), &file),
        None
    );
}

#[test]
fn meshes_with_the_same_faces_share_them() {
    let mesh = |height: f64| {
        let places = vec![[0.0, 0.0, height], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh::from_faces(places, &[[0, 1, 2]]).unwrap();
        Value::Mesh(Arc::new(mesh))
    };
    let topology = |value: &Value| match value {
        Value::Mesh(mesh) => Arc::clone(mesh.topology()),
        _ => panic!("a mesh"),
    };
    let cache = Cache::new(1_000_000, None);
    let first = cache.shared(mesh(0.0));
    let (other, digest) = (mesh(1.0), mesh(1.0).digest());
    assert!(!Arc::ptr_eq(&topology(&first), &topology(&other)));
    let other = cache.shared(other);
    assert!(Arc::ptr_eq(&topology(&first), &topology(&other)));
    assert_eq!(other.digest(), digest);
    // What nobody uses any more is not kept for this.
    drop((first, other));
    let later = cache.shared(mesh(2.0));
    assert_eq!(Arc::strong_count(&topology(&later)), 2);
}

#[test]
fn entries_take_so_many_bytes_and_the_latest_stay() {
    let cache = Cache::new(1_000_000, None);
    let entry = |number: u64| {
        let value = Value::Text(format!("{number:01000}").into());
        Arc::new(Entry {
            results: vec![Known::new(&value)],
            files: Vec::new(),
            warnings: Vec::new(),
            ms: 1.0,
            bytes: 1000,
        })
    };
    let key = |number: u64| Digest::of(&number.to_le_bytes());
    for number in 0..20_000 {
        cache.insert(key(number), &entry(number), &[]);
        // Again under the same key: counted once.
        cache.insert(key(number), &entry(number), &[]);
    }
    let entries = super::lock(&cache.entries);
    let weight: usize = entries
        .by_key
        .values()
        .map(|(_, entry)| entry.weight())
        .sum();
    assert_eq!(entries.bytes, weight);
    assert!(weight <= super::MOST_ENTRY_BYTES && weight > super::MOST_ENTRY_BYTES / 3);
    let count = entries.by_key.len() as u64;
    drop(entries);
    let is_known = |number: u64| cache.entry(key(number)).is_some();
    assert!((20_000 - count..20_000).all(is_known));
    assert!(!(0..20_000 - count).any(is_known));
}
