//! Writing STL.

use std::io;

use glam::DVec3;
use tessgraph_geometry::math::unit_or_zero;
use tessgraph_geometry::{Mesh, Monitor, glam};

use super::{HEADER, TRIANGLE};
use crate::Format;
use crate::error::{FaultKind, IoError, Place};
use crate::stream::Stream;
use crate::write::{Text, TextOrBinary, Written};

/// How an STL file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StlOptions {
    /// Binary holds 32-bit numbers; text holds all digits.
    pub encoding: TextOrBinary,
}

/// Writes the triangles of a mesh (those of `Mesh::triangles`) as STL.
///
/// STL holds nothing but triangles: no shared vertices, attributes, materials
/// or names. Binary files round to 32 bits; a warning says by how much where
/// that is more than a millionth of the mesh's size, as for meshes far from
/// the origin. Cost: O(corners), and memory for the file.
///
/// # Errors
/// [`IoError::Fault`] names the first vertex beyond the reach of 32-bit
/// numbers; [`IoError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Mesh, Unmonitored};
/// let triangle = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Mesh::from_faces(triangle, &[[0, 1, 2]])?;
/// let written = tessgraph_io::write_stl(&mesh, &Default::default(), &Unmonitored)?;
/// assert_eq!(written.bytes.len(), 84 + 50);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_stl(
    mesh: &Mesh,
    options: &StlOptions,
    monitor: &dyn Monitor,
) -> Result<Written, IoError> {
    Written::of(|sink| write_stl_to(sink, mesh, options, monitor))
}

/// [`write_stl`] to a file or another sink, with memory for some blocks of it
/// only; gives the warnings.
///
/// # Errors
/// As [`write_stl`], and [`IoError::NotTaken`]; the sink then has a part of the
/// file.
pub fn write_stl_to(
    sink: &mut dyn io::Write,
    mesh: &Mesh,
    options: &StlOptions,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    let stream = Stream::new(sink, mesh.face_count(), monitor);
    let written = match options.encoding {
        TextOrBinary::Binary => binary(stream, mesh, monitor),
        TextOrBinary::Text => ascii(stream, mesh).map(|()| Vec::new()),
    };
    written.map_err(|error| error.in_file("", Format::Stl))
}

/// Unit normal of a triangle, zero without area.
#[inline]
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    let cross = (b - a).cross(c - a);
    let squared = cross.length_squared();
    if squared > 1e-250 && squared < 1e250 {
        return cross / squared.sqrt();
    }
    // Edges are made unit first, so that no size overflows on the way.
    unit_or_zero(unit_or_zero(b - a).cross(unit_or_zero(c - a)))
}

/// The places of a triangle's corners.
#[inline]
fn places(mesh: &Mesh, triangle: [u32; 3]) -> [DVec3; 3] {
    let corners = mesh.topology().corners();
    triangle.map(|corner| mesh.positions()[corners[corner as usize] as usize])
}

fn binary(
    mut stream: Stream<'_>,
    mesh: &Mesh,
    monitor: &dyn Monitor,
) -> Result<Vec<String>, IoError> {
    monitor.check()?;
    let triangles = mesh.corner_count() - 2 * mesh.face_count();
    let Ok(count) = u32::try_from(triangles) else {
        let cause = format!("{triangles} triangles are more than an STL file can count");
        let help = "write several files, or another format";
        return Err(IoError::new(FaultKind::TooLarge, Place::File, cause, help));
    };
    let warnings = rounding(mesh)?;
    let mut header = [b' '; HEADER];
    // Not "solid": that would look like ASCII.
    let title = b"binary STL, tessgraph";
    header[..title.len()].copy_from_slice(title);
    header[HEADER - 4..].copy_from_slice(&count.to_le_bytes());
    stream.bytes(&header)?;
    stream.elements(mesh.face_count(), |faces, out| {
        let mut records = Vec::new();
        mesh.for_triangles(faces, |_, triangle| {
            let corners = places(mesh, triangle);
            let vectors = [normal(corners), corners[0], corners[1], corners[2]];
            let mut record = [0; TRIANGLE];
            let parts = record.as_chunks_mut::<12>().0;
            for (part, vector) in parts.iter_mut().zip(vectors) {
                let [x, y, z] = vector.as_vec3().to_array().map(f32::to_le_bytes);
                part.copy_from_slice([x, y, z].as_flattened());
            }
            records.push(record);
        });
        out.extend_from_slice(records.as_flattened());
    })?;
    Ok(warnings)
}

/// Checks that every coordinate fits 32 bits, and warns of what rounding does.
fn rounding(mesh: &Mesh) -> Result<Vec<String>, IoError> {
    let mut largest = 0.0_f64;
    for (vertex, place) in mesh.positions().iter().enumerate() {
        let rounded = place.as_vec3();
        if !rounded.is_finite() {
            let cause = format!("vertex {vertex} is beyond the reach of STL's 32-bit numbers");
            let help = "scale or move the mesh, or write OBJ or PLY";
            return Err(IoError::new(FaultKind::NotFinite, Place::File, cause, help));
        }
        largest = largest.max((rounded.as_dvec3() - *place).abs().max_element());
    }
    if largest > mesh.diagonal() * 1e-6 {
        let text = "STL's 32-bit numbers move vertices by up to";
        return Ok(vec![format!(
            "{text} {largest:.2e}; move the mesh to the origin, or write GLB, OBJ or PLY"
        )]);
    }
    Ok(Vec::new())
}

fn ascii(mut stream: Stream<'_>, mesh: &Mesh) -> Result<(), IoError> {
    let triple = |out: &mut Text<'_>, vector: DVec3| {
        for value in vector.to_array() {
            out.text(" ").float(value);
        }
        out.text("\n");
    };
    stream.bytes(b"solid\n")?;
    stream.elements(mesh.face_count(), |faces, out| {
        let mut out = Text::at_end_of(out);
        mesh.for_triangles(faces, |_, triangle| {
            let corners = places(mesh, triangle);
            out.text("facet normal");
            triple(&mut out, normal(corners));
            out.text("outer loop\n");
            for corner in corners {
                out.text("vertex");
                triple(&mut out, corner);
            }
            out.text("endloop\nendfacet\n");
        });
    })?;
    stream.bytes(b"endsolid\n")
}
