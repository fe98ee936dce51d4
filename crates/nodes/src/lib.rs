//! The nodes of tessgraph, one file each.
//!
//! A node is a thin wrapper: its inputs as a struct, its reference page as the
//! struct's doc comment, and a call into `geometry` or `io`. Adding one takes a
//! file and two lines here.

mod area_field;
mod array_components;
mod attribute_field;
mod blend_directions;
mod bridge_loops;
mod cap_holes;
mod check_intersections;
mod check_planarity;
mod color_by_field;
mod compensate_thickness;
mod constant_direction;
mod cuboid;
mod curvature_field;
mod delete_faces;
mod directions_from_attribute;
mod displace_vertices;
mod dissolve_edges;
mod distance_field;
mod dual_mesh;
mod evaluate_field;
mod evaluate_normals_uv;
mod extrude_faces;
mod face_normals;
mod fan_faces;
mod fit_component;
mod flip_faces;
mod frame_faces;
mod grid;
mod image_field;
mod join_meshes;
mod max_offset;
mod measure_distortion;
mod measure_mesh;
mod measure_thickness;
mod offset_mesh;
mod panel_schedule;
mod parametric_surface;
mod random_field;
mod read_field;
mod read_mesh;
mod require;
mod rotate_faces;
mod scale_directions;
mod select_faces;
mod separate_faces;
mod set_attribute;
mod smooth_normals;
mod split_into_quads;
mod subdivide_quad;
mod support;
mod target_directions;
mod transform;
mod triangulate_faces;
mod vertex_normals;
mod weld_vertices;

use tessgraph_graph::NodeSpec;

/// All nodes, in the order of the reference.
pub static NODES: &[NodeSpec] = &[
    // Meshes
    NodeSpec::of::<read_mesh::ReadMesh>(),
    NodeSpec::of::<grid::Grid>(),
    NodeSpec::of::<parametric_surface::ParametricSurface>(),
    NodeSpec::of::<cuboid::Cuboid>(),
    NodeSpec::of::<transform::Transform>(),
    NodeSpec::of::<join_meshes::JoinMeshes>(),
    NodeSpec::of::<subdivide_quad::SubdivideQuad>(),
    NodeSpec::of::<displace_vertices::DisplaceVertices>(),
    NodeSpec::of::<offset_mesh::OffsetMesh>(),
    // Domains of components
    NodeSpec::of::<split_into_quads::SplitIntoQuads>(),
    NodeSpec::of::<triangulate_faces::TriangulateFaces>(),
    NodeSpec::of::<fan_faces::FanFaces>(),
    NodeSpec::of::<frame_faces::FrameFaces>(),
    NodeSpec::of::<dual_mesh::DualMesh>(),
    NodeSpec::of::<rotate_faces::RotateFaces>(),
    NodeSpec::of::<flip_faces::FlipFaces>(),
    // Parts of meshes
    NodeSpec::of::<select_faces::SelectFaces>(),
    NodeSpec::of::<delete_faces::DeleteFaces>(),
    NodeSpec::of::<extrude_faces::ExtrudeFaces>(),
    NodeSpec::of::<separate_faces::SeparateFaces>(),
    NodeSpec::of::<weld_vertices::WeldVertices>(),
    NodeSpec::of::<dissolve_edges::DissolveEdges>(),
    NodeSpec::of::<cap_holes::CapHoles>(),
    NodeSpec::of::<bridge_loops::BridgeLoops>(),
    // Fields and attributes
    NodeSpec::of::<evaluate_field::EvaluateField>(),
    NodeSpec::of::<attribute_field::AttributeField>(),
    NodeSpec::of::<read_field::ReadField>(),
    NodeSpec::of::<image_field::ImageField>(),
    NodeSpec::of::<distance_field::DistanceField>(),
    NodeSpec::of::<curvature_field::CurvatureField>(),
    NodeSpec::of::<area_field::AreaField>(),
    NodeSpec::of::<random_field::RandomField>(),
    NodeSpec::of::<max_offset::MaxOffset>(),
    NodeSpec::of::<set_attribute::SetAttribute>(),
    NodeSpec::of::<color_by_field::ColorByField>(),
    // Directions
    NodeSpec::of::<vertex_normals::VertexNormals>(),
    NodeSpec::of::<smooth_normals::SmoothNormals>(),
    NodeSpec::of::<target_directions::TargetDirections>(),
    NodeSpec::of::<face_normals::FaceNormals>(),
    NodeSpec::of::<constant_direction::ConstantDirection>(),
    NodeSpec::of::<directions_from_attribute::DirectionsFromAttribute>(),
    NodeSpec::of::<blend_directions::BlendDirections>(),
    NodeSpec::of::<scale_directions::ScaleDirections>(),
    NodeSpec::of::<compensate_thickness::CompensateThickness>(),
    // Components
    NodeSpec::of::<fit_component::FitComponent>(),
    NodeSpec::of::<evaluate_normals_uv::EvaluateNormalsUV>(),
    NodeSpec::of::<array_components::ArrayComponents>(),
    // Measures
    NodeSpec::of::<measure_mesh::MeasureMesh>(),
    NodeSpec::of::<measure_thickness::MeasureThickness>(),
    NodeSpec::of::<check_intersections::CheckIntersections>(),
    NodeSpec::of::<check_planarity::CheckPlanarity>(),
    NodeSpec::of::<measure_distortion::MeasureDistortion>(),
    NodeSpec::of::<panel_schedule::PanelSchedule>(),
    NodeSpec::of::<require::Require>(),
];
