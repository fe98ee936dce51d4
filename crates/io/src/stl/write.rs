//! Writing STL.

use glam::DVec3;
use tessgraph_geometry::math::unit_or_zero;
use tessgraph_geometry::{Mesh, Monitor, glam, parallel};

use super::{HEADER, TRIANGLE};
use crate::Format;
use crate::error::{FaultKind, IoError, Place};
use crate::write::{Text, TextOrBinary, Written};

/// How an STL file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StlOptions {
    /// Binary holds 32-bit numbers; text holds all digits.
    pub encoding: TextOrBinary,
}

/// Triangles between two looks at the monitor.
const POLL: usize = 1 << 14;

/// Writes the triangles of a mesh (those of `Mesh::triangles`) as STL.
///
/// STL holds nothing but triangles: no shared vertices, attributes, materials
/// or names. Binary files round to 32 bits; a warning says by how much where
/// that is more than a millionth of the mesh's size, as for meshes far from
/// the origin. Cost: O(triangles).
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
    monitor.check()?;
    let triangles = mesh.triangles().corners;
    let written = match options.encoding {
        TextOrBinary::Binary => binary(mesh, &triangles, monitor),
        TextOrBinary::Text => ascii(mesh, &triangles, monitor),
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
fn places(mesh: &Mesh, triangle: &[u32; 3]) -> [DVec3; 3] {
    let corners = mesh.topology().corners();
    triangle.map(|corner| mesh.positions()[corners[corner as usize] as usize])
}

fn binary(mesh: &Mesh, triangles: &[[u32; 3]], monitor: &dyn Monitor) -> Result<Written, IoError> {
    let Ok(count) = u32::try_from(triangles.len()) else {
        let cause = format!(
            "{} triangles are more than an STL file can count",
            triangles.len()
        );
        let help = "write several files, or another format";
        return Err(IoError::new(FaultKind::TooLarge, Place::File, cause, help));
    };
    let warnings = rounding(mesh)?;
    let mut bytes = vec![0; HEADER + TRIANGLE * triangles.len()];
    let (header, records) = bytes.split_at_mut(HEADER);
    header.fill(b' ');
    // Not "solid": that would look like ASCII.
    let title = b"binary STL, tessgraph";
    header[..title.len()].copy_from_slice(title);
    header[HEADER - 4..].copy_from_slice(&count.to_le_bytes());
    let records = records.as_chunks_mut::<TRIANGLE>().0;
    parallel::fill(records, monitor, |index, record| {
        let corners = places(mesh, &triangles[index]);
        let vectors = std::iter::once(normal(corners)).chain(corners);
        let numbers = vectors.flat_map(|vector| vector.to_array());
        for (part, value) in record.as_chunks_mut::<4>().0.iter_mut().zip(numbers) {
            *part = (value as f32).to_le_bytes();
        }
    })?;
    Ok(Written { bytes, warnings })
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

fn ascii(mesh: &Mesh, triangles: &[[u32; 3]], monitor: &dyn Monitor) -> Result<Written, IoError> {
    let mut out = Text::with_capacity(256 * triangles.len() + 32);
    let triple = |out: &mut Text, vector: DVec3| {
        for value in vector.to_array() {
            out.text(" ").float(value);
        }
        out.text("\n");
    };
    out.text("solid\n");
    for (index, triangle) in triangles.iter().enumerate() {
        if index.is_multiple_of(POLL) {
            monitor.check()?;
            monitor.progress(index as u64, triangles.len() as u64);
        }
        let corners = places(mesh, triangle);
        out.text("facet normal");
        triple(&mut out, normal(corners));
        out.text("outer loop\n");
        for corner in corners {
            out.text("vertex");
            triple(&mut out, corner);
        }
        out.text("endloop\nendfacet\n");
    }
    out.text("endsolid\n");
    Ok(Written {
        bytes: out.into_bytes(),
        warnings: Vec::new(),
    })
}
