//! Material libraries (`.mtl`): colours, opacity, metalness, roughness.

use std::collections::HashMap;

use tessgraph_geometry::{Labels, Material, Mesh, NO_LABEL};

use super::finish::name_of;
use super::statements::Statements;
use crate::error::{IoError, quote, shorten};
use crate::text::{self, Scanner};
use crate::warnings::{Counted, line};
use crate::write::{Text, plain_name};
use crate::{Resolve, uri};

/// Adds the materials that faces name. A library that cannot be had, or a
/// material that none defines, costs a warning; the material then has only
/// its name.
pub(super) fn add(
    bytes: &[u8],
    said: &Statements<'_>,
    mesh: Mesh,
    resolve: &mut Resolve<'_>,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let names = said
        .materials
        .finish(mesh.face_count(), |name| name_of(name))?;
    if names.is_empty() {
        return Ok(mesh);
    }
    let mut defined = HashMap::new();
    for &(library, at) in &said.libraries {
        let at_line = line(bytes, at);
        for (name, content) in load(library, at_line, resolve, warnings) {
            read_library(&name, &content, &mut defined, warnings);
        }
    }
    let mut undefined = Vec::new();
    let materials = names.labels().iter().map(|name| match defined.get(name) {
        Some(material) => Material::clone(material),
        None => {
            undefined.push(format!("`{}`", shorten(name)));
            Material::named(name.clone())
        }
    });
    let materials = materials.collect();
    if !undefined.is_empty() && !said.libraries.is_empty() && !defined.is_empty() {
        let more = undefined.len().saturating_sub(4);
        undefined.truncate(4);
        let more = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        let list = undefined.join(", ");
        warnings.push(format!(
            "no material library defines {list}{more}; they are grey"
        ));
    }
    let of_face = names.of_face().to_vec();
    Ok(mesh.with_materials(Labels::new(materials, of_face)?)?)
}

/// The content of the libraries a `mtllib` statement names: one name that may
/// have blanks in it, or several without.
fn load(
    library: &[u8],
    at_line: usize,
    resolve: &mut Resolve<'_>,
    warnings: &mut Vec<String>,
) -> Vec<(String, std::sync::Arc<[u8]>)> {
    let whole = text::decode(library);
    let mut ask = |name: &str| -> Result<_, String> {
        uri::check_path(name)?;
        resolve(name).map_err(|error| format!("was not read: {error}"))
    };
    let mut found = Vec::new();
    let mut failed = |name: &str, why: String| {
        let name = quote(name.as_bytes());
        let path = if why.starts_with("was") {
            why
        } else {
            format!("is not followed: it {why}")
        };
        warnings.push(format!(
            "material library {name} on line {at_line} {path}; colours are grey"
        ));
    };
    match ask(&whole) {
        Ok(content) => found.push((whole, content)),
        Err(_) if whole.split_whitespace().count() > 1 => {
            for name in whole.split_whitespace() {
                match ask(name) {
                    Ok(content) => found.push((name.to_owned(), content)),
                    Err(why) => failed(name, why),
                }
            }
        }
        Err(why) => failed(&whole, why),
    }
    found
}

/// Adds the materials of a library; of equal names the first counts.
fn read_library(
    name: &str,
    content: &[u8],
    defined: &mut HashMap<String, Material>,
    warnings: &mut Vec<String>,
) {
    let mut bad = Counted::default();
    let cleaned = clean(content, &mut bad);
    let what = ["line was not understood", "lines were not understood"];
    let mut list = Vec::new();
    bad.report(content, what, &mut list);
    warnings.extend(
        list.iter()
            .map(|text| format!("material library `{}`: {text}", shorten(name))),
    );
    let Ok((materials, _)) = tobj::load_mtl_buf(&mut cleaned.as_bytes()) else {
        warnings.push(format!(
            "material library `{}` cannot be read; colours are grey",
            shorten(name)
        ));
        return;
    };
    for material in materials {
        defined
            .entry(material.name.clone())
            .or_insert_with(|| convert(&material));
    }
}

/// The statements that are read, as tobj expects them: it gives up on a whole
/// library, or panics, where a line is short of numbers.
fn clean(content: &[u8], bad: &mut Counted) -> String {
    let mut out = String::new();
    let mut scanner = Scanner::new(content, content.len() - text::without_bom(content).len());
    while scanner.peek().is_some() {
        let start = scanner.at;
        if scanner.more() {
            let word = scanner.word();
            let numbers = match word {
                b"Kd" => 3,
                b"d" | b"Tr" | b"Pm" | b"Pr" => 1,
                _ => 0,
            };
            if word == b"newmtl" {
                match name_of(scanner.rest()) {
                    Some(name) => out.push_str(&format!("newmtl {name}\n")),
                    None => bad.note(start),
                }
            } else if numbers > 0 {
                match read_numbers(&mut scanner, numbers) {
                    Some(list) => out.push_str(&format!("{} {list}\n", text::decode(word))),
                    None => bad.note(start),
                }
            }
        }
        scanner.next_line();
    }
    out
}

/// `count` finite numbers as text, parted by blanks. A single Kd number means
/// three equal ones; `d -halo` is skipped.
fn read_numbers(scanner: &mut Scanner<'_>, count: usize) -> Option<String> {
    let mut list = Vec::new();
    while scanner.more() && list.len() < count {
        match scanner.number() {
            Ok(number) => list.push(number.to_string()),
            Err(_) if scanner.word() == b"-halo" => {}
            Err(_) => return None,
        }
    }
    if list.len() == 1 {
        list.resize(count, list[0].clone());
    }
    (list.len() == count).then(|| list.join(" "))
}

fn convert(material: &tobj::Material) -> Material {
    let mut out = Material::named(material.name.clone());
    let unit = |value: f64| value.clamp(0.0, 1.0);
    let other = |name| {
        material
            .unknown_param
            .get(name)
            .and_then(|text| text.parse().ok())
    };
    if let Some([r, g, b]) = material.diffuse {
        out.base_color = [unit(r), unit(g), unit(b), 1.0];
    }
    let transparency: Option<f64> = other("Tr");
    if let Some(opacity) = material.dissolve.or(transparency.map(|tr| 1.0 - tr)) {
        out.base_color[3] = unit(opacity);
    }
    out.metallic = other("Pm").map_or(out.metallic, unit);
    out.roughness = other("Pr").map_or(out.roughness, unit);
    out
}

/// The material library that goes with a written OBJ file.
///
/// One `newmtl` per material that a face of the mesh has, with `Kd`, `d`, and
/// the PBR extension's `Pm` and `Pr`, in digits that read back exactly.
/// Empty if the mesh has no materials.
///
/// ```
/// # use tessgraph_geometry::{Labels, Material, Mesh};
/// let triangle = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(triangle, &[[0, 1, 2]])?;
/// let mesh = mesh.with_materials(Labels::new(vec![Material::named("clay")], vec![0])?)?;
/// let library = tessgraph_io::write_mtl(&mesh);
/// assert!(library.starts_with(b"newmtl clay\nKd 0.8 0.8 0.8\n"));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn write_mtl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut out = Text::at_end_of(&mut bytes);
    let names = unique_names(mesh.materials());
    let mut used = vec![false; names.len()];
    for &label in mesh
        .materials()
        .of_face()
        .iter()
        .filter(|&&label| label != NO_LABEL)
    {
        used[label as usize] = true;
    }
    let materials = mesh.materials().labels();
    for ((material, name), _) in materials.iter().zip(&names).zip(used).filter(|item| item.1) {
        out.text("newmtl ").text(name).text("\nKd");
        for value in &material.base_color[..3] {
            out.text(" ").float(*value);
        }
        let rest = [
            ("d", material.base_color[3]),
            ("Pm", material.metallic),
            ("Pr", material.roughness),
        ];
        for (key, value) in rest {
            out.text("\n").text(key).text(" ").float(value);
        }
        out.text("\n");
    }
    bytes
}

/// The names materials are written under: fit for a line, and each only once.
pub(super) fn unique_names(materials: &Labels<Material>) -> Vec<String> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut names: Vec<String> = Vec::with_capacity(materials.labels().len());
    for material in materials.labels() {
        let plain = plain_name(&material.name, false);
        let mut name = plain.clone();
        while seen.contains_key(&name) {
            let next = seen.entry(plain.clone()).or_insert(1);
            *next += 1;
            name = format!("{plain}_{next}");
        }
        seen.entry(name.clone()).or_insert(1);
        names.push(name);
    }
    names
}
