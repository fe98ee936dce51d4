//! Catmull-Clark and bilinear subdivision.

mod attributes;
mod bilinear;
mod cage;
mod corners;
mod counts;
mod faces;
mod limit;
mod parents;
mod refine;
mod refiner;
mod rules;
mod sharpness;
mod tiles;
mod value;

#[cfg(test)]
mod tests;

use std::sync::Arc;

pub use counts::{Counts, subdivided_counts};
pub use parents::{Grid, PARENT, Parents};
pub use sharpness::{CORNER_SHARPNESS, CREASE, INFINITELY_SHARP};

use crate::mesh::{Attribute, AttributeValues, Domain, Mesh};
use crate::topology::Topology;
use crate::{GeometryError, Monitor};
use refiner::Refiner;

/// The most levels [`subdivide`] takes: 65 536 faces per quad.
pub const MAX_LEVELS: u32 = 8;

/// How new vertices are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scheme {
    /// Towards a smooth surface (Catmull and Clark 1978).
    #[default]
    CatmullClark,
    /// On the bilinear patch of each quad: more faces, same shape.
    Bilinear,
}

/// What happens where the mesh ends (OpenSubdiv's names).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Boundary {
    /// The border is a smooth curve; corners are rounded.
    EdgeOnly,
    /// As `EdgeOnly`, but a vertex of a single face stays: corners are kept.
    #[default]
    EdgeAndCorner,
}

/// Where the refined vertices end up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Positions {
    /// As the last refinement leaves them.
    #[default]
    Refined,
    /// On the surface that infinitely many refinements lead to.
    Limit,
}

/// How pairs on corners, texture coordinates, are refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CornerRule {
    /// Bilinear in each coarse face.
    #[default]
    Linear,
    /// As positions, by the same scheme, on the surface that equal values at shared
    /// vertices make: seams are its borders, and keep their corners.
    Smooth,
}

/// How [`subdivide`] works.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// How new vertices are placed.
    pub scheme: Scheme,
    /// How often every edge is halved, 0 to [`MAX_LEVELS`].
    pub levels: u32,
    /// What happens where the mesh ends.
    pub boundary: Boundary,
    /// Where the refined vertices end up; bilinear ones are there already.
    pub positions: Positions,
    /// How texture coordinates are refined.
    pub uv: CornerRule,
}

/// A subdivided mesh and the grids its faces form.
#[derive(Debug, Clone)]
pub struct Subdivision {
    /// The fine mesh; its face attribute [`PARENT`] names the coarse faces.
    pub mesh: Mesh,
    /// The fine faces of each coarse face.
    pub parents: Parents,
}

/// Subdivides a polygon mesh; after one level all faces are quads.
///
/// Sharp edges are given by the corner attribute [`CREASE`] on the edge that
/// leaves the corner (the sharper of its two sides counts), sharp vertices by
/// the vertex attribute [`CORNER_SHARPNESS`]; both lose 1 per level, and from
/// [`INFINITELY_SHARP`] on nothing (DeRose, Kass and Truong 1998; OpenSubdiv's
/// "Uniform" rule). Vertices that two sheets share without an edge stay where
/// they are, isolated vertices too.
///
/// Order of the result. Faces: those of each coarse face together, as
/// [`Parents`] says. Vertices: the coarse ones; then, unless all coarse faces
/// are quads, one per coarse edge and one per coarse face, which makes a cage
/// of quads; then those inside each cage edge, along it; then those inside each
/// cage face, row by row. Numbering by place and not by level keeps each
/// parent's vertices side by side in memory.
///
/// Vertex attributes follow the masks of positions, corner attributes are
/// bilinear in each parent (UV seams stay sharp; pairs follow [`CornerRule`]), face attributes, materials,
/// groups and objects come from the parent. Whole numbers are taken from the
/// nearest coarse element. Both sharpness attributes hold what is left, so that
/// a then b levels are a + b levels.
///
/// Cost: O(result), a few times its memory bandwidth.
///
/// # Errors
/// [`GeometryError::OutOfRange`] above [`MAX_LEVELS`]; [`GeometryError::TooMany`]
/// and [`GeometryError::OutOfMemory`] before anything is allocated; [`GeometryError::NonManifold`] with the edges
/// that have more than two faces; [`GeometryError::RepeatedVertex`];
/// [`GeometryError::NonFiniteVertex`] when sums of huge coordinates overflow;
/// [`GeometryError::Cancelled`].
///
/// ```
/// use tessgraph_geometry::{Unmonitored, primitives, subdivide};
/// let cube = primitives::cuboid(tessgraph_geometry::glam::DVec3::ONE, [1, 1, 1], true)?;
/// let options = subdivide::Options { levels: 2, ..Default::default() };
/// let fine = subdivide::subdivide(&cube, options, &Unmonitored)?;
/// assert_eq!(fine.mesh.face_count(), 6 * 16);
/// let grid = fine.parents.whole_grid(0).expect("a cube has quads");
/// assert_eq!(grid.vertex(0, 0), cube.face(0)[0]);
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
pub fn subdivide(
    mesh: &Mesh,
    options: Options,
    monitor: &dyn Monitor,
) -> Result<Subdivision, GeometryError> {
    if options.levels > MAX_LEVELS {
        return Err(GeometryError::OutOfRange {
            what: "the number of subdivision levels",
            value: f64::from(options.levels),
            requirement: "it must lie in 0 to 8",
        });
    }
    mesh.topology().adjacency_with(monitor)?;
    let counts = subdivided_counts(mesh, options.levels)?;
    monitor.afford(counts.bytes)?;
    let refiner = Refiner::new(mesh, options, monitor)?;
    let positions = refiner.run(mesh.positions(), monitor)?;
    if options.levels == 0 {
        return unrefined(mesh, positions, &refiner, monitor);
    }
    let blocks = refiner.blocks();
    let corners = blocks.corners(monitor)?;
    let offsets = Topology::even_offsets(corners.len(), 4)?;
    let topology = Topology::of_sound(refiner.vertex_count(), offsets, corners)?;
    let fine = Mesh::new(positions, Arc::new(topology))?;
    let fine = attributes::inherit(mesh, fine, &refiner, &blocks, monitor)?;
    let side = 1usize << options.levels;
    finish(
        fine,
        blocks.parents(monitor)?,
        mesh.topology().faces().map(|face| match face.len() {
            4 => (side, side * side),
            sides => (side / 2, sides * side * side / 4),
        }),
    )
}

/// Level 0: the mesh itself, its vertices perhaps on the limit surface.
fn unrefined(
    mesh: &Mesh,
    positions: Vec<glam::DVec3>,
    refiner: &Refiner,
    monitor: &dyn Monitor,
) -> Result<Subdivision, GeometryError> {
    let mut fine = mesh.with_positions(positions)?;
    for attribute in mesh.attributes() {
        if attribute.domain() == Domain::Vertex && attribute.name() != CORNER_SHARPNESS {
            let values = attributes::at_vertices(attribute.values(), refiner, monitor)?;
            fine = fine.with_attribute(attribute.with_values(values))?;
        }
    }
    let sides = mesh
        .topology()
        .faces()
        .map(|face| usize::from(face.len() == 4));
    finish(
        fine,
        (0..mesh.face_count() as i64).collect(),
        sides.map(|side| (side, 1)),
    )
}

fn finish(
    fine: Mesh,
    of_face: Vec<i64>,
    sides_and_counts: impl Iterator<Item = (usize, usize)>,
) -> Result<Subdivision, GeometryError> {
    let parents = Parents::new(Arc::clone(fine.topology()), sides_and_counts);
    let values = AttributeValues::Integer(of_face.into());
    let mesh = fine.with_attribute(Attribute::new(PARENT, Domain::Face, values))?;
    Ok(Subdivision { mesh, parents })
}
