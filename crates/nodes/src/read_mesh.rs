//! A mesh from a file.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use tessgraph_geometry::measure::find_defects;
use tessgraph_geometry::{Mesh, transform};
use tessgraph_graph::units::Units;
use tessgraph_graph::value::FilePath;
use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_io::{Format, IoError, ReadOptions, ResolveError};
use tessgraph_macros::{Choice, Inputs};

/// Reads a mesh from an OBJ, glTF, GLB, STL or PLY file.
///
/// The extension says which format it is. Polygons, texture coordinates,
/// materials and groups are kept, and so are the order of vertices and vertices
/// that no face uses: a target surface is matched to its base by index.
///
/// OBJ, STL and PLY files carry no unit; they are read in the graph's units
/// unless `units` says otherwise. glTF is in metres and y-up by its
/// specification and is turned to z-up. Its vertices stand apart wherever normals or
/// texture coordinates differ; `WeldVertices` with distance 0 joins them.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "out": ReadMesh(path: "meshes/roof.obj"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct ReadMesh {
    /// The file, relative to the graph.
    path: FilePath,
    /// Unit of the coordinates in a file that carries none; left out, the graph's.
    units: Option<FileUnits>,
    /// Which axis points up in the file; glTF is always y-up.
    #[input(default = Z)]
    up: Up,
}

/// (x, y, z) to (x, -z, y): the quarter turn that puts y up.
const Z_UP_FROM_Y_UP: DMat3 = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);

/// Units of a file.
#[derive(Clone, Copy, Choice)]
#[choice(into = Units)]
pub(crate) enum FileUnits {
    /// Metres.
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Feet.
    Ft,
    /// Inches.
    In,
}

/// The axis that points up.
#[derive(Clone, Copy, PartialEq, Eq, Choice)]
pub(crate) enum Up {
    /// z is up: coordinates are taken as they are.
    Z,
    /// y is up: (x, y, z) is read as (x, -z, y).
    Y,
}

impl Node for ReadMesh {
    type Output = Arc<Mesh>;
    const VERSION: u32 = 2;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let name = self.path.as_str();
        let format = Format::from_name(name).ok_or_else(|| {
            NodeError::new(format!("`{name}` is no mesh file this program can read"))
                .with_help("use a file that ends in .obj, .gltf, .glb, .stl or .ply")
                .at_input("path")
        })?;
        let bytes = cx
            .read(&self.path)
            .map_err(|error| error.at_input("path"))?;
        let mut resolve = |relative: &str| {
            let read = cx.read_beside(&self.path, relative);
            read.map_err(|error| ResolveError::Failed(error.message().to_owned()))
        };
        let options = ReadOptions::default();
        let loaded = tessgraph_io::read(format, name, &bytes, &mut resolve, &options, cx.monitor())
            .map_err(failure)?;
        for warning in &loaded.warnings {
            cx.warn(format!("{name}: {warning}"));
        }
        for defect in find_defects(&loaded.mesh).sentences(loaded.mesh.topology()) {
            cx.warn(format!("{name}: {defect}"));
        }
        let units = self.units.map_or(cx.units(), Units::from);
        if format.is_metric() {
            if self.units.is_some() {
                cx.warn("glTF files are always in metres: `units` has no effect");
            }
            return Ok(Arc::new(loaded.mesh));
        }
        let z_up_from_file = match self.up {
            Up::Z => DAffine3::IDENTITY,
            Up::Y => DAffine3::from_mat3(Z_UP_FROM_Y_UP),
        };
        let metres_from_file = DAffine3::from_scale(DVec3::splat(units.metres()));
        let place = metres_from_file * z_up_from_file;
        if place == DAffine3::IDENTITY {
            return Ok(Arc::new(loaded.mesh));
        }
        Ok(Arc::new(transform::transform(
            &loaded.mesh,
            place,
            cx.monitor(),
        )?))
    }
}

/// A reader's fault as a node's error; the file and place are in its message.
fn failure(error: IoError) -> NodeError {
    if matches!(error, IoError::Cancelled) {
        return tessgraph_geometry::GeometryError::Cancelled.into();
    }
    match error.fault() {
        Some(fault) => NodeError::new(fault.message()).with_help(fault.help.clone()),
        None => NodeError::new(error.to_string()),
    }
    .at_input("path")
}
