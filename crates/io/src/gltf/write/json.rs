//! The JSON of a GLB file.

use glam::DVec3;
use serde_json::{Map, Value, json};
use tessgraph_geometry::{Material, Mesh, glam};

use super::parts::{Part, Parts, Source};
use super::sections::Described;
use super::{GlbOptions, y_up};

/// The whole document.
pub(super) fn document(
    source: &Source<'_>,
    parts: &Parts,
    described: Described,
    origin: DVec3,
    options: &GlbOptions<'_>,
    extras: Option<Value>,
) -> String {
    let material = |part| material(source.mesh(), part, source.has_colors());
    let materials: Vec<Value> = parts.list.iter().map(material).collect();
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
    if parts.list.is_empty() {
        root.insert("nodes".into(), json!([{}]));
    } else {
        let mut mesh = Map::new();
        let mut node = Map::new();
        if let Some(name) = options.name {
            mesh.insert("name".into(), name.into());
            node.insert("name".into(), name.into());
        }
        mesh.insert("primitives".into(), described.primitives.into());
        if let Some(extras) = extras {
            mesh.insert("extras".into(), extras);
        }
        node.insert("mesh".into(), 0.into());
        if origin != DVec3::ZERO {
            let translation = y_up(origin) + DVec3::ZERO;
            node.insert("translation".into(), translation.to_array().to_vec().into());
        }
        root.insert("nodes".into(), json!([node]));
        root.insert("meshes".into(), json!([mesh]));
        root.insert("materials".into(), materials.into());
        root.insert("accessors".into(), described.accessors.into());
        root.insert("bufferViews".into(), described.views.into());
        root.insert("buffers".into(), json!([{"byteLength": described.length}]));
    }
    Value::Object(root).to_string()
}

fn material(mesh: &Mesh, part: &Part, is_colored: bool) -> Value {
    let known = mesh.materials().labels().get(part.material as usize);
    let mut plain = Material::named("default");
    if is_colored {
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
