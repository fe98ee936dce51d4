//! Wavefront OBJ: polygons as text.
//!
//! What is read: `v` (with colours), `vt`, `vn`, `f` (and `fo`), `g`, `o`,
//! `usemtl`, `mtllib` through the caller, and OpenSubdiv's `t` tags. Vertices
//! keep their order, unused ones too; polygons keep all corners. Materials
//! come from `.mtl` files; one that is missing costs a warning only.
//!
//! | in the file | in the mesh |
//! |---|---|
//! | `v x y z r g b` | vertex attribute `color`; white where a vertex has none |
//! | `vt` at a corner | corner attribute `uv`; (0, 0) where a corner has none |
//! | `vn` at a corner | corner attribute `normal`; zero where a corner has none |
//! | `t crease` | corner attribute `crease`, on the corners the edge leaves |
//! | `t corner` | vertex attribute `corner_sharpness` |
//! | `g a b` | the face's group names |
//! | `o name`, `usemtl name` | the face's object and material |

mod faults;
mod finish;
mod materials;
mod parse;
mod parts;
mod statements;
mod tags;
mod write;

#[cfg(test)]
mod tests;

use tessgraph_geometry::Monitor;

use crate::error::IoError;
use crate::{Format, Loaded, Resolve, sniff};

pub use materials::write_mtl;
pub(crate) use write::lost_attributes;
pub use write::{ObjOptions, write_obj, write_obj_to};

/// Reads an OBJ file.
///
/// # Errors
/// As [`crate::read()`].
pub(crate) fn read(
    bytes: &[u8],
    resolve: &mut Resolve<'_>,
    monitor: &dyn Monitor,
) -> Result<Loaded, IoError> {
    if bytes.trim_ascii().is_empty() || sniff::recognise(bytes).is_some() {
        return Err(sniff::wrong_content(Format::Obj, bytes));
    }
    finish::finish(bytes, parts::statements(bytes, monitor)?, resolve)
}
