//! The one entry to reading, and what it gives and takes.

use std::sync::Arc;

use tessgraph_geometry::{Mesh, Monitor};

use crate::{Format, IoError, gltf, obj, ply, stl};

/// How a file is read.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadOptions {
    /// Joins the corners of STL triangles that have exactly the same
    /// coordinates into shared vertices. STL knows no shared vertices, so
    /// without this every triangle stands alone.
    pub weld_stl: bool,
    /// Bytes the mesh may take in memory before reading stops. Only glTF can
    /// describe more than its file's size suggests, by repeating meshes.
    pub memory_limit: u64,
}

impl Default for ReadOptions {
    /// Welds STL; 4 GiB.
    fn default() -> Self {
        Self {
            weld_stl: true,
            memory_limit: 4 << 30,
        }
    }
}

/// A mesh that was read, and what is worth knowing about it.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The mesh, z up.
    pub mesh: Mesh,
    /// What was passed over or repaired, a sentence each without a full stop.
    pub warnings: Vec<String>,
    /// OpenSubdiv's `interpolateboundary` tag of an OBJ file: 1 keeps border
    /// edges and corners, 2 rounds corners, 0 leaves borders out.
    pub boundary: Option<i64>,
}

/// Why a further file could not be had.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResolveError {
    /// There is no such file.
    #[error("there is no such file")]
    NotFound,
    /// Anything else, in words: no permission, outside the allowed folders.
    #[error("{0}")]
    Failed(String),
}

/// Hands over a further file by its path relative to the file that is read:
/// a `.mtl` or a `.bin`. Escapes are decoded, and only paths in or below the
/// file's own folder are ever asked for.
pub type Resolve<'a> = dyn FnMut(&str) -> Result<Arc<[u8]>, ResolveError> + 'a;

/// A resolver for callers that have no further files.
pub fn no_files(_path: &str) -> Result<Arc<[u8]>, ResolveError> {
    Err(ResolveError::NotFound)
}

/// Reads a mesh of `format` from `bytes`.
///
/// `name` is the file's own name, for messages and so that a file that names
/// itself is noticed. No file is opened here: `resolve` gives the content of
/// those the file names. Vertices keep the file's order, and those without
/// faces are kept. glTF is turned from y up to z up and its node transforms
/// are applied; the other formats are taken as they are.
/// Cost: O(bytes) time and memory, for glTF also O(instances).
///
/// # Errors
/// [`IoError::Fault`] says what is wrong, where, and what to do;
/// [`IoError::Cancelled`] when `monitor` asks to stop.
///
/// ```
/// use tessgraph_geometry::Unmonitored;
/// use tessgraph_io::{Format, ReadOptions, no_files, read};
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let options = ReadOptions::default();
/// let loaded = read(Format::Obj, "quad.obj", text, &mut no_files, &options, &Unmonitored)?;
/// assert_eq!((loaded.mesh.vertex_count(), loaded.mesh.face_count()), (4, 1));
/// # Ok::<(), tessgraph_io::IoError>(())
/// ```
pub fn read(
    format: Format,
    name: &str,
    bytes: &[u8],
    resolve: &mut Resolve<'_>,
    options: &ReadOptions,
    monitor: &dyn Monitor,
) -> Result<Loaded, IoError> {
    let loaded = match format {
        Format::Obj => obj::read(bytes, resolve, monitor),
        Format::Glb => gltf::read_glb(name, bytes, resolve, options, monitor),
        Format::Gltf => gltf::read_gltf(name, bytes, resolve, options, monitor),
        Format::Stl => stl::read(bytes, options, monitor),
        Format::Ply => ply::read(bytes, monitor),
    };
    loaded.map_err(|error| error.in_file(name, format))
}
