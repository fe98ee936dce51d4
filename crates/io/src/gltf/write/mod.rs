//! Writing binary glTF.

mod colors;
mod json;
mod parts;
mod sections;

use std::io;

use glam::DVec3;
use tessgraph_geometry::{Field, Mesh, Monitor, glam};

use crate::Format;
use crate::error::{FaultKind, IoError, Place};
use crate::stream::Stream;
use crate::write::Written;
use parts::Source;

/// Which normals a GLB file gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlbNormals {
    /// One per face: panels look flat, and every face has its own vertices.
    #[default]
    Flat,
    /// One per vertex, weighted by angle: surfaces look round.
    Smooth,
}

/// Where the vertex colours of a GLB file come from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum GlbColors<'a> {
    /// No vertex colours.
    None,
    /// The attribute `color` of the vertices, or else of the faces, if the mesh
    /// has it.
    #[default]
    Attribute,
    /// A field as colours of [`crate::viridis`].
    Field {
        /// One number per vertex or face of the mesh.
        field: &'a Field,
        /// What the field is called, for the file's extras.
        name: &'a str,
        /// The numbers at both ends of the colour map; the field's smallest and
        /// largest if not given.
        range: Option<(f64, f64)>,
    },
    /// Linear red, green, blue in 0..=1, one per vertex.
    Vertices(&'a [DVec3]),
    /// Linear red, green, blue in 0..=1, one per face.
    Faces(&'a [DVec3]),
}

/// How a GLB file is written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GlbOptions<'a> {
    /// Flat or smooth.
    pub normals: GlbNormals,
    /// Vertex colours, in 16 bits per component.
    pub colors: GlbColors<'a>,
    /// Name of the mesh and its node.
    pub name: Option<&'a str>,
    /// Kept as the `extras` of the file's `asset`: where it came from.
    pub extras: Option<serde_json::Value>,
}

/// Coordinates larger than so many diagonals of the mesh lose too many of
/// their 24 bits, and are written about a local origin.
const REACH: f64 = 4.0;

/// Writes a mesh as binary glTF 2.0.
///
/// Positions are 32-bit numbers. A mesh far from the origin is written about a
/// local origin near its centre, which is the node's translation: readers with
/// 64-bit transforms get survey coordinates back to the micrometre. Polygons
/// are cut as `Mesh::triangles` says; z up becomes y up; `uv` becomes
/// TEXCOORD_0 with v counted from the top, as glTF does. There is one
/// primitive per material that a face has, double-sided; faces without one get
/// a plain grey, white under vertex colours. Vertices without faces are left
/// out; a mesh without faces gives a valid file without a mesh, and a warning.
///
/// The same mesh and options give the same bytes. Cost: O(corners), and memory
/// for the file.
///
/// # Errors
/// [`IoError::Fault`] if the mesh is beyond the reach of 32-bit numbers, if
/// colours or field do not fit the mesh, or if the file would pass 4 GiB;
/// [`IoError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// let quad = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(quad, &[[0, 1, 2, 3]])?;
/// let written = tessgraph_io::write_glb(&mesh, &Default::default(), &Unmonitored)?;
/// assert!(written.bytes.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_glb(
    mesh: &Mesh,
    options: &GlbOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Written, IoError> {
    Written::of(|sink| write_glb_to(sink, mesh, options, monitor))
}

/// [`write_glb`] to a file or another sink, with memory for some blocks of it
/// only; gives the warnings.
///
/// # Errors
/// As [`write_glb`], and [`IoError::NotTaken`]; the sink then has a part of the
/// file.
pub fn write_glb_to(
    sink: &mut dyn io::Write,
    mesh: &Mesh,
    options: &GlbOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    write(sink, mesh, options, monitor).map_err(|error| error.in_file("", Format::Glb))
}

fn write(
    sink: &mut dyn io::Write,
    mesh: &Mesh,
    options: &GlbOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    monitor.check()?;
    let origin = local_origin(mesh)?;
    let colors = colors::resolve(mesh, &options.colors)?;
    let source = Source::new(mesh, origin, options.normals, &colors.of, monitor)?;
    let parts = source.split(monitor)?;
    let described = sections::describe(&parts, &source);
    let length = described.length;
    let json = json::document(&source, &parts, described, origin, options, colors.extras);
    let mut stream = Stream::new(sink, sections::element_count(&parts, &source), monitor);
    start(&mut stream, json.into_bytes(), length)?;
    sections::write(&parts, &source, &mut stream)?;
    Ok(warnings(mesh))
}

/// Writes the container up to the content of the binary chunk, `length` bytes
/// and a multiple of four.
fn start(stream: &mut Stream<'_>, mut json: Vec<u8>, length: usize) -> Result<(), IoError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + if length == 0 { 0 } else { 8 + length };
    let Ok(whole) = u32::try_from(total) else {
        let cause = format!("the file would have {total} bytes; GLB ends at 4294967295");
        let help = "write the mesh in several files, or as PLY";
        return Err(IoError::new(FaultKind::TooLarge, Place::File, cause, help));
    };
    let word = |value: usize| (value as u32).to_le_bytes();
    stream.bytes(b"glTF")?;
    stream.bytes(&2_u32.to_le_bytes())?;
    stream.bytes(&whole.to_le_bytes())?;
    stream.bytes(&word(json.len()))?;
    stream.bytes(b"JSON")?;
    stream.bytes(&json)?;
    if length > 0 {
        stream.bytes(&word(length))?;
        stream.bytes(b"BIN\0")?;
    }
    Ok(())
}

fn warnings(mesh: &Mesh) -> Vec<String> {
    let mut warnings = Vec::new();
    if mesh.face_count() == 0 {
        warnings.push("the mesh has no faces, so the file has no mesh".to_owned());
    }
    let written = |name: &str| name == "uv" || name == "normal" || name == "color";
    let lost = mesh
        .attributes()
        .iter()
        .filter(|attribute| !written(attribute.name()));
    warnings.extend(crate::obj::lost_attributes(lost, Format::Glb));
    warnings
}

/// The point all positions are written relative to: the origin itself, or a
/// rounded point near the centre of a mesh that is far away.
///
/// Rounded to the power of two below the mesh's diagonal, so that subtracting
/// it loses nothing and the number stays short.
fn local_origin(mesh: &Mesh) -> Result<DVec3, IoError> {
    let Some((low, high)) = mesh.bounds() else {
        return Ok(DVec3::ZERO);
    };
    let (diagonal, farthest) = (mesh.diagonal(), low.abs().max(high.abs()).max_element());
    let reach = f64::from(f32::MAX);
    if farthest > reach || diagonal > reach {
        let place = mesh
            .positions()
            .iter()
            .position(|place| place.abs().max_element() > reach);
        let which = place.map_or_else(
            || "the mesh".to_owned(),
            |vertex| format!("vertex {vertex}"),
        );
        let cause = format!("{which} is beyond the reach of glTF's 32-bit numbers");
        let help = "scale or move the mesh, or write OBJ or PLY";
        return Err(IoError::new(FaultKind::NotFinite, Place::File, cause, help));
    }
    if farthest <= REACH * diagonal {
        return Ok(DVec3::ZERO);
    }
    // Clearing the digits of a number leaves the power of two below it.
    let step = f64::from_bits(diagonal.to_bits() & f64::INFINITY.to_bits());
    let round = |centre: f64| {
        let steps = centre / step;
        // Beyond 2⁵² steps the centre is a multiple of the step already.
        if steps.abs() < 4_503_599_627_370_496.0 {
            steps.round() * step + 0.0
        } else {
            centre
        }
    };
    let centre = low * 0.5 + high * 0.5;
    Ok(DVec3::from(centre.to_array().map(round)))
}

/// z up to y up.
fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y)
}
