//! From the statements of an OBJ file to a mesh.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use tessgraph_geometry::{Attribute, AttributeValues, Domain, Mesh, Topology, glam};

use super::statements::{NONE, Statements};
use super::{materials, tags};
use crate::error::{FaultKind, IoError, Place, quote};
use crate::warnings::{self, count};
use crate::{Loaded, Resolve, text};

/// Makes the mesh that the statements of a file have said.
pub(super) fn finish(
    bytes: &[u8],
    mut said: Statements<'_>,
    resolve: &mut Resolve<'_>,
) -> Result<Loaded, IoError> {
    check_content(bytes, &said)?;
    let mut warnings = Vec::new();
    report(bytes, &said, &mut warnings);
    let faces = said.ends.len();
    let mut offsets = std::mem::take(&mut said.ends);
    offsets.insert(0, 0);
    let corners = std::mem::take(&mut said.corners);
    let topology = Topology::new(said.positions.len(), offsets, corners)?;
    let positions = std::mem::take(&mut said.positions);
    let mut mesh = Mesh::new(positions, Arc::new(topology))?;
    mesh = add_corner_values(&mut said, mesh, &mut warnings)?;
    if !said.colors.is_empty() {
        let mut colors = std::mem::take(&mut said.colors);
        colors.resize(mesh.vertex_count(), DVec3::ONE);
        let values = AttributeValues::Vector3(colors.into());
        mesh = mesh.with_attribute(Attribute::new("color", Domain::Vertex, values))?;
    }
    mesh = tags::apply(&said.tags, mesh, bytes, &mut warnings)?;
    let (objects, groups) = (&said.objects, &said.groups);
    mesh = mesh.with_objects(objects.finish(faces, |name| name_of(name))?)?;
    mesh = mesh.with_groups(groups.finish(faces, |names| names_of(names))?)?;
    mesh = materials::add(bytes, &said, mesh, resolve, &mut warnings)?;
    Ok(Loaded {
        mesh,
        warnings,
        boundary: said.tags.boundary,
    })
}

/// A name as text; joined line ends count as blanks. `None` if empty.
pub(super) fn name_of(name: &[u8]) -> Option<String> {
    let text = text::decode(name);
    let text = match memchr::memchr2(b'\n', b'\r', name) {
        None => text,
        Some(_) => text
            .replace("\\\r\n", " ")
            .replace("\\\n", " ")
            .replace("\\\r", " "),
    };
    (!text.is_empty()).then_some(text)
}

fn names_of(names: &[u8]) -> Option<Vec<String>> {
    let names: Vec<_> = name_of(names)?
        .split_whitespace()
        .map(str::to_owned)
        .collect();
    (!names.is_empty()).then_some(names)
}

/// Refuses a file that holds no polygons and nothing like them.
fn check_content(bytes: &[u8], said: &Statements<'_>) -> Result<(), IoError> {
    let passed = &said.passed_over;
    if let (0, Some(at)) = (said.ends.len(), passed.free_form.first()) {
        let cause = "the file has free-form curves or surfaces, but no polygons";
        let help = "mesh the surfaces in the program that made them, then export again";
        let place = text::place(bytes, at);
        return Err(IoError::new(FaultKind::Unsupported, place, cause, help));
    }
    if said.known > 0 {
        return Ok(());
    }
    match passed.unknown.first() {
        Some(at) => {
            let line = bytes[at..]
                .split(|&byte| byte == b'\n' || byte == b'\r')
                .next();
            let line = quote(line.unwrap_or_default());
            let cause = format!("no line is an OBJ statement; the first is {line}");
            let help = "give an OBJ file; its statements are in lower case, like `v 0 0 0`";
            let place = text::place(bytes, at);
            Err(IoError::new(FaultKind::WrongContent, place, cause, help))
        }
        None => {
            let cause = "the file holds nothing but comments";
            Err(IoError::new(
                FaultKind::Empty,
                Place::File,
                cause,
                "export the mesh again",
            ))
        }
    }
}

/// Says what was passed over.
fn report(bytes: &[u8], said: &Statements<'_>, warnings: &mut Vec<String>) {
    let passed = &said.passed_over;
    let mut say = |counted: &warnings::Counted, what| counted.report(bytes, what, warnings);
    let lines = [
        "line or point (`l`, `p`) was passed over",
        "lines and points (`l`, `p`) were passed over",
    ];
    say(&passed.lines_and_points, lines);
    let free_form = [
        "free-form statement was passed over",
        "free-form statements were passed over",
    ];
    say(&passed.free_form, free_form);
    let commands = [
        "command (`call`, `csh`) was not followed",
        "commands (`call`, `csh`) were not followed",
    ];
    say(&passed.commands, commands);
    let unknown = [
        "unknown statement was passed over",
        "unknown statements were passed over",
    ];
    say(&passed.unknown, unknown);
    let extra = [
        "vertex has numbers of no known meaning",
        "vertices have numbers of no known meaning",
    ];
    say(&passed.extra_numbers, extra);
    let colors = [
        "vertex colour is not finite and became white",
        "vertex colours are not finite and became white",
    ];
    say(&passed.bad_colors, colors);
    let normals = [
        "normal is not finite and became zero",
        "normals are not finite and became zero",
    ];
    say(&passed.bad_normals, normals);
    let bad_tags = [
        "`t` statement was not understood",
        "`t` statements were not understood",
    ];
    say(&passed.bad_tags, bad_tags);
    let tags = [
        "subdivision tag of another kind was passed over",
        "subdivision tags of other kinds were passed over",
    ];
    say(&passed.other_tags, tags);
    if said.ends.is_empty() {
        warnings.push("the file has no faces".to_owned());
    }
}

/// Adds `uv` and `normal` where corners name them.
fn add_corner_values(
    said: &mut Statements<'_>,
    mut mesh: Mesh,
    warnings: &mut Vec<String>,
) -> Result<Mesh, IoError> {
    let corners = mesh.corner_count();
    let uvs = std::mem::take(&mut said.corner_uvs);
    if let Some(values) = gather(
        uvs,
        &said.uvs,
        DVec2::ZERO,
        corners,
        "texture coordinate",
        warnings,
    ) {
        let values = AttributeValues::Vector2(values.into());
        mesh = mesh.with_attribute(Attribute::new("uv", Domain::Corner, values))?;
    }
    let normals = std::mem::take(&mut said.corner_normals);
    if let Some(values) = gather(
        normals,
        &said.normals,
        DVec3::ZERO,
        corners,
        "normal",
        warnings,
    ) {
        let values = AttributeValues::Vector3(values.into());
        mesh = mesh.with_attribute(Attribute::new("normal", Domain::Corner, values))?;
    }
    Ok(mesh)
}

/// The value of each corner, `missing` for those that name none or one that
/// does not exist. `None` if no corner has a value.
fn gather<T: Copy>(
    mut indices: Vec<u32>,
    values: &[T],
    missing: T,
    corners: usize,
    what: &str,
    warnings: &mut Vec<String>,
) -> Option<Vec<T>> {
    if indices.is_empty() {
        return None;
    }
    indices.resize(corners, NONE);
    let (mut none, mut outside) = (0, 0);
    let gathered = indices
        .iter()
        .map(|&index| match values.get(index as usize) {
            Some(&value) => value,
            None => {
                if index == NONE {
                    none += 1;
                } else {
                    outside += 1;
                }
                missing
            }
        })
        .collect();
    if outside > 0 {
        let corners = count(outside, ["corner names", "corners name"]);
        warnings.push(format!(
            "{corners} a {what} that does not exist (there are {}) and got zero",
            values.len()
        ));
    }
    if none > 0 {
        let corners = count(none, ["corner has", "corners have"]);
        warnings.push(format!(
            "{corners} no {what}, unlike the others, and got zero"
        ));
    }
    (none + outside < corners).then_some(gathered)
}
