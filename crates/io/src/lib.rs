//! Reads and writes meshes as OBJ, glTF, STL and PLY bytes.
//!
//! Bytes in, a [`Mesh`](tessgraph_geometry::Mesh) out, and back. No file is
//! opened here: a caller hands over the bytes, and through [`Resolve`] those of
//! the files a file names. What is read is never trusted: counts, offsets and
//! indices are checked before they are used, and every refusal says what is
//! wrong, where, and what to do.
//!
//! Inside, z is up and numbers are `f64`. glTF is y up: read
//! (x, y, z) -> (x, -z, y), written (x, y, z) -> (x, z, -y). The other formats
//! are taken as they are.

#![cfg_attr(
    test,
    allow(
        clippy::float_cmp,
        reason = "tests compare what must be equal to the last bit"
    )
)]

mod error;
mod format;
mod gltf;
mod image;
mod intern;
mod labels;
mod obj;
mod ply;
mod read;
mod sniff;
mod stl;
mod stream;
mod text;
mod uri;
mod warnings;
mod write;

#[cfg(test)]
mod corpus;
#[cfg(test)]
mod hostile;

pub use error::{Fault, FaultKind, IoError, Place};
pub use format::Format;
pub use gltf::{
    GlbColors, GlbNormals, GlbOptions, mesh_colors, place_in_range, viridis, write_glb,
    write_glb_to,
};
pub use image::{Luminance, read_luminance, write_png};
pub use obj::{ObjOptions, write_mtl, write_obj, write_obj_to};
pub use ply::{PlyOptions, write_ply, write_ply_to};
pub use read::{Loaded, ReadOptions, Resolve, ResolveError, no_files, read};
pub use sniff::recognise;
pub use stl::{StlOptions, write_stl, write_stl_to};
pub use write::{TextOrBinary, Written};
