//! The JSON and the bytes of a GLB file.

use std::borrow::Cow;

use bytemuck::NoUninit;
use glam::DVec3;
use serde_json::{Map, Value, json};
use tessgraph_geometry::{Material, Mesh, glam};

use super::parts::Part;
use super::{GlbOptions, y_up};
use crate::error::{FaultKind, IoError, Place};

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// The whole file.
pub(super) fn file(
    mesh: &Mesh,
    parts: &[Part],
    origin: DVec3,
    options: &GlbOptions<'_>,
    extras: Option<Value>,
) -> Result<Vec<u8>, IoError> {
    let mut binary = Binary::default();
    let primitives: Vec<Value> = parts
        .iter()
        .enumerate()
        .map(|(k, part)| binary.primitive(k, part))
        .collect();
    let materials: Vec<Value> = parts.iter().map(|part| material(mesh, part)).collect();
    let mut asset = Map::new();
    asset.insert("version".into(), "2.0".into());
    asset.insert(
        "generator".into(),
        concat!("tessgraph ", env!("CARGO_PKG_VERSION")).into(),
    );
    if let Some(extras) = &options.extras {
        asset.insert("extras".into(), extras.clone());
    }
    let mut root = Map::new();
    root.insert("asset".into(), asset.into());
    root.insert("scene".into(), 0.into());
    root.insert("scenes".into(), json!([{"nodes": [0]}]));
    if parts.is_empty() {
        root.insert("nodes".into(), json!([{}]));
    } else {
        let mut described = Map::new();
        let mut node = Map::new();
        if let Some(name) = options.name {
            described.insert("name".into(), name.into());
            node.insert("name".into(), name.into());
        }
        described.insert("primitives".into(), primitives.into());
        if let Some(extras) = extras {
            described.insert("extras".into(), extras);
        }
        node.insert("mesh".into(), 0.into());
        if origin != DVec3::ZERO {
            let translation = y_up(origin) + DVec3::ZERO;
            node.insert("translation".into(), translation.to_array().to_vec().into());
        }
        root.insert("nodes".into(), json!([node]));
        root.insert("meshes".into(), json!([described]));
        root.insert("materials".into(), materials.into());
        root.insert("accessors".into(), binary.accessors.into());
        root.insert("bufferViews".into(), binary.views.into());
        root.insert("buffers".into(), json!([{"byteLength": binary.length}]));
    }
    let json = Value::Object(root).to_string();
    container(json.into_bytes(), &binary.pieces)
}

/// Puts JSON and pieces of data into the container, each padded to four bytes.
fn container(mut json: Vec<u8>, pieces: &[Cow<'_, [u8]>]) -> Result<Vec<u8>, IoError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let data: usize = pieces
        .iter()
        .map(|piece| piece.len().next_multiple_of(4))
        .sum();
    let total = 12 + 8 + json.len() + if data == 0 { 0 } else { 8 + data };
    let Ok(length) = u32::try_from(total) else {
        let cause = format!("the file would have {total} bytes; GLB ends at 4294967295");
        let help = "write the mesh in several files, or as PLY";
        return Err(IoError::new(FaultKind::TooLarge, Place::File, cause, help));
    };
    let mut out = Vec::with_capacity(total);
    out.extend_from_slice(b"glTF");
    out.extend_from_slice(&2_u32.to_le_bytes());
    out.extend_from_slice(&length.to_le_bytes());
    out.extend_from_slice(&(json.len() as u32).to_le_bytes());
    out.extend_from_slice(b"JSON");
    out.extend_from_slice(&json);
    if data > 0 {
        out.extend_from_slice(&(data as u32).to_le_bytes());
        out.extend_from_slice(b"BIN\0");
        for piece in pieces {
            out.extend_from_slice(piece);
            out.resize(out.len().next_multiple_of(4), 0);
        }
    }
    Ok(out)
}

fn material(mesh: &Mesh, part: &Part) -> Value {
    let known = mesh.materials().labels().get(part.material as usize);
    let mut plain = Material::named("default");
    if !part.colors.is_empty() {
        // The colour factor multiplies vertex colours; white shows them as they are.
        plain.base_color = [1.0; 4];
    }
    let material = known.unwrap_or(&plain);
    // NaN becomes 0 here, so that the file stays JSON.
    let unit = |value: f64| if value > 0.0 { value.min(1.0) } else { 0.0 };
    let mut out = Map::new();
    out.insert("name".into(), material.name.clone().into());
    out.insert(
        "pbrMetallicRoughness".into(),
        json!({
            "baseColorFactor": material.base_color.map(unit),
            "metallicFactor": unit(material.metallic),
            "roughnessFactor": unit(material.roughness),
        }),
    );
    if material.base_color[3] < 1.0 {
        out.insert("alphaMode".into(), "BLEND".into());
    }
    out.insert("doubleSided".into(), true.into());
    out.into()
}

/// The pieces of the binary chunk, and the views and accessors that describe
/// them. Pieces borrow what they can: meshes of a million faces are copied once.
#[derive(Default)]
struct Binary<'a> {
    pieces: Vec<Cow<'a, [u8]>>,
    /// Bytes of all pieces, each padded to four.
    length: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl<'a> Binary<'a> {
    fn primitive(&mut self, material: usize, part: &'a Part) -> Value {
        let mut attributes = Map::new();
        let position = self.add(
            &part.positions,
            ARRAY_BUFFER,
            FLOAT,
            "VEC3",
            bounds(&part.positions),
        );
        attributes.insert("POSITION".into(), position.into());
        let normal = self.add(&part.normals, ARRAY_BUFFER, FLOAT, "VEC3", Map::new());
        attributes.insert("NORMAL".into(), normal.into());
        if !part.uvs.is_empty() {
            let uv = self.add(&part.uvs, ARRAY_BUFFER, FLOAT, "VEC2", Map::new());
            attributes.insert("TEXCOORD_0".into(), uv.into());
        }
        if !part.colors.is_empty() {
            let normalized = Map::from_iter([("normalized".to_owned(), true.into())]);
            let color = self.add(
                &part.colors,
                ARRAY_BUFFER,
                UNSIGNED_SHORT,
                "VEC4",
                normalized,
            );
            attributes.insert("COLOR_0".into(), color.into());
        }
        // 65535 itself is the restart value.
        let indices = if part.positions.len() <= usize::from(u16::MAX) {
            let short: Vec<u16> = part.indices.iter().map(|&index| index as u16).collect();
            let piece = Cow::Owned(little_endian(&short, 2).into_owned());
            let kind = (ELEMENT_ARRAY_BUFFER, UNSIGNED_SHORT, "SCALAR");
            self.add_piece(piece, short.len(), kind, Map::new())
        } else {
            self.add(
                &part.indices,
                ELEMENT_ARRAY_BUFFER,
                UNSIGNED_INT,
                "SCALAR",
                Map::new(),
            )
        };
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    /// Adds elements; gives the number of their accessor.
    fn add<T: NoUninit>(
        &mut self,
        elements: &'a [T],
        target: u32,
        component: u32,
        kind: &str,
        extra: Map<String, Value>,
    ) -> usize {
        let size = if component == UNSIGNED_SHORT { 2 } else { 4 };
        self.add_piece(
            little_endian(elements, size),
            elements.len(),
            (target, component, kind),
            extra,
        )
    }

    fn add_piece(
        &mut self,
        piece: Cow<'a, [u8]>,
        count: usize,
        (target, component, kind): (u32, u32, &str),
        extra: Map<String, Value>,
    ) -> usize {
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": self.length,
            "byteLength": piece.len(),
            "target": target,
        }));
        self.length += piece.len().next_multiple_of(4);
        self.pieces.push(piece);
        let mut accessor = Map::new();
        accessor.insert("bufferView".into(), (self.views.len() - 1).into());
        accessor.insert("componentType".into(), component.into());
        accessor.insert("count".into(), count.into());
        accessor.insert("type".into(), kind.into());
        accessor.extend(extra);
        self.accessors.push(accessor.into());
        self.accessors.len() - 1
    }
}

/// The bytes of elements whose components have `size` bytes.
fn little_endian<T: NoUninit>(elements: &[T], size: usize) -> Cow<'_, [u8]> {
    let bytes = bytemuck::cast_slice(elements);
    if cfg!(target_endian = "little") {
        return Cow::Borrowed(bytes);
    }
    let mut swapped = bytes.to_vec();
    swapped.chunks_exact_mut(size).for_each(<[u8]>::reverse);
    Cow::Owned(swapped)
}

/// `min` and `max` of positions.
fn bounds(positions: &[[f32; 3]]) -> Map<String, Value> {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for position in positions {
        for k in 0..3 {
            low[k] = low[k].min(position[k]);
            high[k] = high[k].max(position[k]);
        }
    }
    let value = |corner: [f32; 3]| Value::from(corner.map(f64::from).to_vec());
    Map::from_iter([
        ("min".to_owned(), value(low)),
        ("max".to_owned(), value(high)),
    ])
}
