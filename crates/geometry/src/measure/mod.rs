//! Measures of meshes: counts, area and volume, thickness over a base,
//! planarity, distortion, and schedules of panels.

mod blank;
mod defects;
mod distortion;
mod inversion;
mod mesh;
mod panels;
mod planarity;
mod thickness;

pub use defects::{Defects, Found, find_defects};
pub use distortion::{Distortion, distortion};
pub(crate) use mesh::pieces_of_faces;
pub use mesh::{MeshMeasures, measure_mesh};
pub use panels::{Panel, PanelBase, panels};
pub use planarity::{Planarity, planarity};
pub use thickness::{Histogram, MeasuredThickness, ThicknessOptions, measure_thickness};
