//! The JSON of a glTF file, parsed part by part.

use std::cell::OnceCell;

use gltf::json::{Accessor, Buffer, Mesh, buffer::View};
use serde::Deserialize;
use serde_json::value::RawValue;

use super::{EXPORT, fault};
use crate::error::{FaultKind, IoError, Place, shorten};

/// Where the JSON text is, for messages about it.
#[derive(Debug, Clone, Copy)]
pub(super) enum JsonPlace {
    /// It is the file.
    Line,
    /// It starts at this byte.
    Byte(usize),
}

/// The top level, with every element still text.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Root<'a> {
    #[serde(borrow)]
    scene: Option<&'a RawValue>,
    #[serde(borrow, default)]
    scenes: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    nodes: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    meshes: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    materials: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    accessors: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    buffer_views: Vec<&'a RawValue>,
    #[serde(borrow, default)]
    buffers: Vec<&'a RawValue>,
    #[serde(default)]
    extensions_required: Vec<String>,
    #[serde(default)]
    extensions_used: Vec<String>,
}

/// What is looked at before anything else.
#[derive(Deserialize)]
struct Probe<'a> {
    #[serde(borrow)]
    asset: Option<&'a RawValue>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    min_version: Option<String>,
}

/// A list whose elements are parsed when they are first asked for, once.
///
/// Only what a scene needs is looked at: a file with, say, textures this
/// library knows nothing of still gives its meshes.
pub(super) struct List<'a, T> {
    name: &'static str,
    elements: Vec<(&'a RawValue, OnceCell<T>)>,
}

impl<'a, T: Deserialize<'a>> List<'a, T> {
    fn new(name: &'static str, raw: Vec<&'a RawValue>) -> Self {
        let elements = raw
            .into_iter()
            .map(|text| (text, OnceCell::new()))
            .collect();
        Self { name, elements }
    }

    pub(super) fn len(&self) -> usize {
        self.elements.len()
    }

    /// JSON pointer to an element.
    pub(super) fn pointer(&self, index: usize) -> String {
        format!("/{}/{index}", self.name)
    }

    /// The element that `from` (a JSON pointer) refers to by `index`.
    pub(super) fn get(&self, index: usize, from: &str) -> Result<&T, IoError> {
        let Some((raw, parsed)) = self.elements.get(index) else {
            let cause = format!(
                "it refers to /{}/{index}, but there are {}",
                self.name,
                self.len()
            );
            return Err(fault(FaultKind::OutOfRange, from, cause, EXPORT));
        };
        if let Some(parsed) = parsed.get() {
            return Ok(parsed);
        }
        let value = parse(raw, &self.pointer(index))?;
        Ok(parsed.get_or_init(|| value))
    }
}

/// Parses one value at `pointer`.
fn parse<'a, T: Deserialize<'a>>(raw: &'a RawValue, pointer: &str) -> Result<T, IoError> {
    serde_json::from_str(raw.get()).map_err(|error| {
        let cause = without_place(&error);
        fault(FaultKind::Syntax, pointer, cause, EXPORT)
    })
}

/// The message of a JSON error without its line and column, which count from
/// the start of a part.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let end = text.rfind(" at line ").unwrap_or(text.len());
    shorten_long(&text[..end])
}

fn shorten_long(text: &str) -> String {
    let mut words: Vec<_> = text.split(' ').map(shorten).collect();
    words.truncate(40);
    words.join(" ")
}

/// A glTF document.
pub(super) struct Document<'a> {
    scene: Option<&'a RawValue>,
    pub(super) scenes: List<'a, super::scene::Scene>,
    pub(super) nodes: List<'a, super::scene::Node>,
    pub(super) meshes: List<'a, Mesh>,
    pub(super) materials: List<'a, super::assemble::RawMaterial>,
    pub(super) accessors: List<'a, Accessor>,
    pub(super) views: List<'a, View>,
    pub(super) buffers: List<'a, Buffer>,
    required: Vec<String>,
    used: Vec<String>,
}

impl<'a> Document<'a> {
    /// Parses the top level.
    ///
    /// # Errors
    /// With the place of the first syntax error; for another version of glTF.
    pub(super) fn parse(json: &'a [u8], place: JsonPlace) -> Result<Self, IoError> {
        let fail = |at: usize, cause: String| {
            let place = match place {
                JsonPlace::Line => crate::text::place(json, at),
                JsonPlace::Byte(start) => Place::Byte((start + at) as u64),
            };
            IoError::new(FaultKind::Syntax, place, cause, EXPORT)
        };
        let text = std::str::from_utf8(json)
            .map_err(|error| fail(error.valid_up_to(), "the JSON is not UTF-8".to_owned()))?;
        let broken = |error: serde_json::Error| {
            let cause = format!("the JSON is broken: {}", without_place(&error));
            fail(offset(json, error.line(), error.column()), cause)
        };
        // Other versions have another structure, so the version comes first.
        let probe: Probe<'a> = serde_json::from_str(text).map_err(broken)?;
        check_version(probe.asset)?;
        let root: Root<'a> = serde_json::from_str(text).map_err(broken)?;
        Ok(Self {
            scene: root.scene,
            scenes: List::new("scenes", root.scenes),
            nodes: List::new("nodes", root.nodes),
            meshes: List::new("meshes", root.meshes),
            materials: List::new("materials", root.materials),
            accessors: List::new("accessors", root.accessors),
            views: List::new("bufferViews", root.buffer_views),
            buffers: List::new("buffers", root.buffers),
            required: root.extensions_required,
            used: root.extensions_used,
        })
    }

    /// Refuses a file that cannot be read without an extension unknown here.
    pub(super) fn check_extensions(&self) -> Result<(), IoError> {
        let unknown = self.required.iter().position(|name| !is_harmless(name));
        let Some(index) = unknown else {
            return Ok(());
        };
        let name = &self.required[index];
        let pointer = format!("/extensionsRequired/{index}");
        let cause = format!(
            "the file needs the extension {}, which is not read",
            shorten(name)
        );
        let help = match name.as_str() {
            "KHR_draco_mesh_compression" => {
                "export without Draco compression, or decompress: `gltf-transform copy in.glb out.glb`"
            }
            "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
                "export without meshopt compression, or decompress: `gltf-transform copy in.glb out.glb`"
            }
            _ => "export without it",
        };
        Err(fault(FaultKind::Unsupported, &pointer, cause, help))
    }

    /// Whether the file says it uses an extension.
    pub(super) fn uses(&self, extension: &str) -> bool {
        self.used
            .iter()
            .chain(&self.required)
            .any(|name| name == extension)
    }

    /// The default scene: the one `scene` names, or the first.
    pub(super) fn default_scene(&self) -> Result<(usize, &super::scene::Scene), IoError> {
        let index = match self.scene {
            Some(raw) => parse::<u32>(raw, "/scene")? as usize,
            None => 0,
        };
        if self.scenes.len() == 0 {
            let cause = "the file has no scene, so nothing says which meshes belong to it";
            return Err(fault(
                FaultKind::Empty,
                "/scenes",
                cause,
                "export it as a scene",
            ));
        }
        Ok((index, self.scenes.get(index, "/scene")?))
    }
}

/// Refuses other versions than 2.x, and files that need more than 2.0.
fn check_version(asset: Option<&RawValue>) -> Result<(), IoError> {
    let Some(asset) = asset else {
        let cause = "`asset` is missing, which every glTF file has";
        return Err(fault(
            FaultKind::WrongContent,
            "",
            cause,
            "give a glTF 2.0 file",
        ));
    };
    let asset: Asset = parse(asset, "/asset")?;
    let unsupported = |pointer, cause: String| {
        Err(fault(
            FaultKind::Unsupported,
            pointer,
            cause,
            "convert it to glTF 2.0",
        ))
    };
    let quoted = shorten(&asset.version);
    match version(&asset.version) {
        Some((2, _)) => {}
        Some(_) => {
            let cause = format!("this is glTF {quoted}; only 2.0 is read");
            return unsupported("/asset/version", cause);
        }
        None => return unsupported("/asset/version", format!("`{quoted}` is no version")),
    }
    match asset
        .min_version
        .as_deref()
        .map(|text| (text, version(text)))
    {
        None | Some((_, Some((2, 0)))) => Ok(()),
        Some((text, _)) => {
            let cause = format!("the file needs glTF {}; only 2.0 is read", shorten(text));
            unsupported("/asset/minVersion", cause)
        }
    }
}

/// Byte of a JSON error's line and column, both from 1; columns are bytes.
fn offset(json: &[u8], line: usize, column: usize) -> usize {
    let start = match line.checked_sub(2) {
        None => 0,
        Some(n) => memchr::memchr_iter(b'\n', json)
            .nth(n)
            .map_or(0, |end| end + 1),
    };
    (start + column.saturating_sub(1)).min(json.len())
}

/// "2.0" -> (2, 0).
fn version(text: &str) -> Option<(u32, u32)> {
    let (major, minor) = text.split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

/// Whether geometry can be read without knowing a required extension.
fn is_harmless(name: &str) -> bool {
    matches!(
        name,
        "KHR_mesh_quantization"
            | "KHR_texture_transform"
            | "KHR_texture_basisu"
            | "EXT_texture_webp"
            | "EXT_texture_avif"
            | "MSFT_texture_dds"
            | "KHR_lights_punctual"
            | "KHR_animation_pointer"
            | "KHR_xmp_json_ld"
    ) || name.starts_with("KHR_materials_")
}
