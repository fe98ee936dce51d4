//! STL: triangles without shared vertices, binary or ASCII.
//!
//! A file is binary if its length fits its triangle count, whatever it begins
//! with: binary files that begin with "solid" are common. Normals and
//! attribute bytes are not read; normals follow from the corners.

mod ascii;
mod write;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec3;
use tessgraph_geometry::{Labels, Mesh, Monitor, Topology, glam};

use crate::error::{FaultKind, IoError, Place};
use crate::intern::Interner;
use crate::{Format, Loaded, ReadOptions, sniff, text};

pub use write::{StlOptions, write_stl, write_stl_to};

/// Bytes before the triangles of a binary file: 80 of header, 4 of count.
const HEADER: usize = 84;
/// Bytes of a triangle: normal, three corners, two attribute bytes.
const TRIANGLE: usize = 50;

/// Corners of all triangles as they were read.
pub(crate) struct Soup {
    /// Three places per triangle.
    corners: Vec<DVec3>,
    /// Names of solids and the object of each triangle, if there are names.
    objects: Labels<String>,
    warnings: Vec<String>,
}

/// Reads an STL file.
///
/// # Errors
/// As [`crate::read()`].
pub(crate) fn read(
    bytes: &[u8],
    options: &ReadOptions,
    monitor: &dyn Monitor,
) -> Result<Loaded, IoError> {
    let count = binary_count(bytes);
    let fits = |count: usize| count.checked_mul(TRIANGLE)?.checked_add(HEADER);
    let soup = match count {
        Some(count) if fits(count) == Some(bytes.len()) => read_binary(bytes, count, monitor)?,
        _ if ascii::looks_like(bytes) => ascii::read(bytes, monitor)?,
        _ if bytes.len() < HEADER
            || sniff::recognise(bytes).is_some_and(|seen| seen != "binary data") =>
        {
            return Err(not_stl(bytes));
        }
        Some(count) if fits(count).is_some_and(|need| need < bytes.len()) => {
            let mut soup = read_binary(bytes, count, monitor)?;
            let extra = bytes.len() - HEADER - count * TRIANGLE;
            soup.warnings.push(format!(
                "{extra} bytes after the last triangle were ignored"
            ));
            soup
        }
        _ => return Err(too_short(bytes, count.unwrap_or(0))),
    };
    finish(soup, options)
}

fn not_stl(bytes: &[u8]) -> IoError {
    match sniff::recognise(bytes) {
        Some("binary data") => {
            let cause = format!(
                "the file ends after {} bytes, within the header of {HEADER}",
                bytes.len()
            );
            IoError::new(
                FaultKind::Truncated,
                Place::Byte(bytes.len() as u64),
                cause,
                "export it again",
            )
        }
        _ => sniff::wrong_content(Format::Stl, bytes),
    }
}

fn too_short(bytes: &[u8], count: usize) -> IoError {
    let has = (bytes.len() - HEADER) / TRIANGLE;
    let cause = format!("the header says {count} triangles, but the file has room for {has}");
    let help = "export or download the file again";
    IoError::new(FaultKind::Truncated, Place::Byte(80), cause, help)
}

fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?.try_into().ok()?;
    Some(u32::from_le_bytes(count) as usize)
}

/// Triangles of a binary file that holds at least `count`.
fn read_binary(bytes: &[u8], count: usize, monitor: &dyn Monitor) -> Result<Soup, IoError> {
    let mut corners = Vec::with_capacity(3 * count);
    let triangles = bytes[HEADER..].as_chunks::<TRIANGLE>().0;
    for (index, triangle) in triangles.iter().take(count).enumerate() {
        if index.is_multiple_of(1 << 14) {
            monitor.check()?;
            monitor.progress(index as u64, count as u64);
        }
        for corner in triangle[12..48].as_chunks::<12>().0 {
            let part = corner.as_chunks::<4>().0;
            let place = [0, 1, 2].map(|k| f64::from(f32::from_le_bytes(part[k])));
            let place = DVec3::from(place);
            if !place.is_finite() {
                let at = HEADER + index * TRIANGLE;
                let cause = format!("triangle {index} has a coordinate that is not finite");
                let help = "repair the mesh in the program that made it";
                return Err(IoError::new(
                    FaultKind::NotFinite,
                    Place::Byte(at as u64),
                    cause,
                    help,
                ));
            }
            corners.push(place);
        }
    }
    Ok(Soup {
        corners,
        objects: Labels::default(),
        warnings: Vec::new(),
    })
}

/// Joins equal corners into vertices, in the order of first use.
fn finish(soup: Soup, options: &ReadOptions) -> Result<Loaded, IoError> {
    let mut warnings = soup.warnings;
    if soup.corners.is_empty() {
        warnings.push("the file has no triangles".to_owned());
    }
    let count = soup.corners.len();
    let (positions, corners) = if options.weld_stl {
        let mut vertices = Interner::new();
        // Adding zero makes -0 and 0 the same place.
        let key = |place: &DVec3| (*place + DVec3::ZERO).to_array().map(f64::to_bits);
        let corners: Vec<u32> = soup
            .corners
            .iter()
            .map(|place| vertices.number(key(place)))
            .collect();
        let position = |key: &[u64; 3]| DVec3::from(key.map(f64::from_bits));
        (vertices.keys().iter().map(position).collect(), corners)
    } else {
        (soup.corners, (0..count as u32).collect())
    };
    let topology = Topology::uniform(positions.len(), 3, corners)?;
    let mesh = Mesh::new(positions, Arc::new(topology))?.with_objects(soup.objects)?;
    Ok(Loaded {
        mesh,
        warnings,
        boundary: None,
    })
}
