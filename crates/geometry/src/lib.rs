//! Quad meshes, directions and the mathematics of architectural tessellation.
//!
//! Everything here works on [`Mesh`] and plain arrays; it knows no graph, no
//! file and no text format. Lengths are metres, angles radians, z is up, and
//! all arithmetic is `f64`. Results do not depend on the number of threads or
//! on the platform.

mod array;
pub mod buffer;
pub mod compensate;
pub mod diffuse;
pub mod digest;
pub mod directions;
mod displace;
pub mod domains;
mod error;
mod field;
pub mod fields;
mod fit;
pub mod intersect;
mod join;
pub mod math;
pub mod measure;
mod mesh;
mod monitor;
mod naming;
pub mod normals;
mod normals_uv;
mod offset;
pub mod parallel;
pub mod primitives;
pub mod random;
mod rebuild;
pub mod section;
mod sets;
pub mod subdivide;
pub mod surface;
pub mod target;
#[cfg(test)]
mod test_shapes;
#[cfg(test)]
mod test_support;
mod topology;
pub mod transform;
mod vectors;
mod weld;

pub use array::{
    ArrayCounts, ArrayDomain, ArrayOptions, ArrayParts, ArrayPoint, Arrayed, BASE_FACE, COMPONENT,
    COMPONENT_FACE, Displace, GridPlace, Height, Interpolation, Join, JoinReport, NO_COMPONENT,
    PANEL, PartPoint, PartVectors, PatchGrids, PerVertexOptions, PerVertexReport, Straight,
    array_compensated, array_components, array_components_with, array_counts, array_parts,
    border_edge_counts, border_faces, border_patch_turns, border_side_counts, border_turns,
    choose_along, choose_at_border, choose_by_index, choose_by_material, choose_random,
};
pub use directions::{DirectionSource, Directions};
pub use displace::displace_vertices;
pub use error::{GeometryError, list_ids};
pub use field::{Amount, Field, Quantity};
pub use fit::{
    Anchor, Beyond, BoxOutliers, Fit, FitOptions, Frame, box_outliers, component_frame,
    fit_component,
};
pub use glam;
pub use join::join;
pub use mesh::{
    Attribute, AttributeValues, Domain, Labels, Material, Mesh, NO_LABEL, SEAM, Triangles,
};
pub use monitor::{Monitor, Unmonitored};
pub use naming::faces_named;
pub use normals_uv::{
    NORMAL_UV, NormalUv, NormalUvAxes, NormalUvSource, Part, evaluate_normals_uv,
};
pub use offset::{PART, ShellPart, offset_mesh};
pub use topology::{Adjacency, NO_EDGE, Topology};
pub use weld::{Welded, weld_border_vertices, weld_vertices};

/// Attributes by which operations record where elements come from; files whose
/// format has no place for them lose nothing that a user put there.
pub const PROVENANCE: [&str; 8] = [
    BASE_FACE,
    COMPONENT_FACE,
    COMPONENT,
    PANEL,
    subdivide::PARENT,
    PART,
    domains::SOURCE_FACE,
    domains::SOURCE_VERTEX,
];
