//! Quad meshes, directions and the mathematics of architectural tessellation.
//!
//! Everything here works on [`Mesh`] and plain arrays; it knows no graph, no
//! file and no text format. Lengths are metres, angles radians, z is up, and
//! all arithmetic is `f64`. Results do not depend on the number of threads or
//! on the platform.

pub mod buffer;
pub mod compensate;
pub mod diffuse;
pub mod digest;
pub mod directions;
mod displace;
mod error;
mod field;
mod join;
pub mod math;
mod mesh;
mod monitor;
mod naming;
pub mod normals;
pub mod parallel;
pub mod primitives;
mod random;
mod rebuild;
pub mod subdivide;
pub mod surface;
pub mod target;
mod topology;
pub mod transform;

pub use directions::{DirectionSource, Directions};
pub use displace::displace_vertices;
pub use error::{GeometryError, list_ids};
pub use field::{Amount, Field, Quantity};
pub use glam;
pub use join::join;
pub use mesh::{Attribute, AttributeValues, Domain, Labels, Material, Mesh, NO_LABEL, Triangles};
pub use monitor::{Monitor, Unmonitored};
pub use naming::faces_named;
pub use topology::{Adjacency, NO_EDGE, Topology};

