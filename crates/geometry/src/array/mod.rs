//! Components arrayed over the faces of a base surface (figure 1).

mod basis;
mod carry;
mod choose;
mod grids;
mod layout;
mod map;
mod parts;
mod patch;
mod per_vertex;
mod replicate;
#[cfg(test)]
mod tests;
mod weld;

pub use basis::GridPlace;
pub use choose::{
    NO_COMPONENT, border_edge_counts, border_faces, border_patch_turns, border_side_counts,
    border_turns, choose_along, choose_at_border, choose_by_index, choose_by_material,
    choose_random,
};
pub use grids::PatchGrids;
pub use layout::{ArrayCounts, array_counts};
pub use map::{ArrayPoint, Displace, Straight};
pub use parts::{ArrayParts, PartPoint, PartVectors, array_parts};
pub use per_vertex::{PerVertexOptions, PerVertexReport, array_compensated};
pub use weld::JoinReport;

use crate::fit::{Fit, FitOptions, component_frame, fit_component};
use crate::normals_uv::NORMAL_UV;
use crate::{Amount, AttributeValues, Directions, Domain, GeometryError, Mesh, Monitor, list_ids};
use layout::Layout;

/// How heights of a component become displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Height {
    /// As drawn: w metres along the direction.
    #[default]
    Absolute,
    /// Scaled with the size of the faces: times sqrt(A / a), A the mean area of
    /// the faces at a vertex, a the area of the component's box.
    Relative,
}

/// How directions are interpolated inside a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolation {
    /// Unit direction and length apart: thickness does not shrink inside
    /// curved faces.
    #[default]
    Unit,
    /// The vectors themselves: what the paper's add-on does. Between diverging
    /// unit normals the length falls to the cosine of half their angle.
    Linear,
}

/// What one component is mapped over.
#[derive(Debug, Clone, Copy, Default)]
pub enum ArrayDomain<'a> {
    /// Each face of the base.
    #[default]
    Face,
    /// Each coarse face a subdivided base was made from.
    Parent(&'a PatchGrids),
}

/// Whether neighbours are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Join {
    /// Every component stays a piece of its own.
    #[default]
    None,
    /// Vertices on the sides of the square are joined with those of neighbours.
    Weld,
}

/// Settings of [`array_components`]; the default maps one component's XY box
/// over every face, heights as drawn.
#[derive(Debug, Clone, Copy, Default)]
pub struct ArrayOptions<'a> {
    /// How x and y of the components become (u, v); `None` for [`Fit::Bounds`].
    pub fit: Option<&'a Fit>,
    /// How heights are scaled.
    pub height: Height,
    /// Factor k on heights, a number or one per base vertex; `None` for 1.
    pub scale: Option<&'a Amount>,
    /// How directions are interpolated.
    pub interpolation: Interpolation,
    /// What a component is mapped over.
    pub domain: ArrayDomain<'a>,
    /// For each face (or parent) the index of its component, or
    /// [`NO_COMPONENT`]; `None` for the first component everywhere.
    pub choose: Option<&'a [u32]>,
    /// For each face (or parent) how many quarter turns the component makes on
    /// it: one turn puts its corner (0, 0) where (0, 1) was. Triangles cannot
    /// turn. `None` for none.
    pub turns: Option<&'a [u8]>,
    /// Attributes of the base to bring onto the output, by name.
    pub carry: &'a [String],
    /// Whether neighbours are joined.
    pub join: Join,
    /// Vertices without direction are taken as they are (their points stay in
    /// the surface) instead of refused.
    pub allow_zero_directions: bool,
}

/// Result of [`array_components`].
#[derive(Debug, Clone)]
pub struct Arrayed {
    /// The components, face by face.
    pub mesh: Mesh,
    /// How many components were placed.
    pub placed: usize,
    /// Parents left out because they have not four sides.
    pub skipped_parents: usize,
    /// What was joined; `None` without [`Join::Weld`].
    pub join: Option<JoinReport>,
    /// For each vertex its index before neighbours were joined; `None` without
    /// [`Join::Weld`].
    pub vertex_sources: Option<Vec<u32>>,
}

/// Face attribute of the output: the base face (or parent) it lies on.
pub const BASE_FACE: &str = "base_face";
/// Face attribute of the output: the face of the component it is a copy of.
pub const COMPONENT_FACE: &str = "component_face";
/// Face attribute of the output: which component it belongs to, where several
/// were given.
pub const COMPONENT: &str = "component";
/// Face attribute of the output and, if present, of the base: the panel's id.
pub const PANEL: &str = "panel";

/// Maps components over the faces of a base surface (figure 1).
///
/// A component vertex at (u, v, w) goes to X = P(u, v) + w s k D(u', v').
/// P and D are interpolated bilinearly from the corners of the face, (0, 0),
/// (1, 0), (1, 1), (0, 1) being its corners in order; a triangle is a quad whose
/// edge v = 1 collapses on its third corner. Over a parent's grid, from the
/// small face that holds the place. Places beyond the square extrapolate.
/// D is outward for w >= 0, inward below. (u', v') is vertex attribute
/// [`NORMAL_UV`] of the component if it has one (§3.3), else (u, v).
///
/// With [`Interpolation::Unit`] D is the normalised interpolation of unit
/// directions times the interpolated length; where opposite directions cancel
/// out, the point stays in the surface. s is 1 for [`Height::Absolute`] and for
/// target directions, else the interpolated sqrt(A / a): A the mean face area at
/// the vertex (times n² over a grid of side n), a the area of the box that
/// [`Fit::Bounds`] or [`Fit::Cell`] maps to the square, 1 for [`Fit::Unit`].
///
/// The output holds the components face by face, each with its vertices and
/// faces in order, with all it carries; [`NORMAL_UV`] has served its purpose and
/// goes. An attribute that only some components have is 0 on the others. Face
/// attributes [`BASE_FACE`], [`COMPONENT_FACE`] and [`PANEL`] say where a face
/// comes from, [`COMPONENT`] which component it belongs to if there are several.
/// The panel id is the base's face attribute of that name, else the index of
/// the face (or parent): it depends on topology only and survives edits of
/// shape. `carry` interpolates vertex attributes of the base to vertices and
/// corner attributes to corners (whole numbers take the nearest corner's), and
/// copies face attributes; a component's attribute of the same name gives way.
///
/// Cost: O(output), in parallel; the same bytes on any number of threads.
///
/// ```
/// use tessgraph_geometry::{
///     ArrayOptions, DirectionSource, Directions, Mesh, Unmonitored, array_components, glam::DVec3,
/// };
/// let square = vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let base = Mesh::from_faces(square.clone(), &[[0, 1, 2, 3]])?;
/// let lid = Mesh::from_faces(square.iter().map(|p| [p[0], p[1], 0.2]).collect(), &[[0, 1, 2, 3]])?;
/// let up = Directions::new(&base, vec![DVec3::Z; 4], DirectionSource::Surface)?;
/// let array = array_components(&base, &[&lid], &up, &ArrayOptions::default(), &Unmonitored)?;
/// assert_eq!(array.mesh.positions()[2], DVec3::new(1.0, 1.0, 0.2));
/// # Ok::<(), tessgraph_geometry::GeometryError>(())
/// ```
///
/// # Errors
/// [`GeometryError::OtherTopology`] for directions of another mesh,
/// [`GeometryError::NotQuad`] for a face with more than four corners,
/// [`GeometryError::ZeroDirection`] for vertices without direction under a
/// component (see `allow_zero_directions`), [`GeometryError::TooMany`],
/// [`GeometryError::Empty`], [`GeometryError::NoAttribute`],
/// [`GeometryError::FieldLength`], [`GeometryError::Invalid`] for a component
/// index that does not exist, [`GeometryError::NonFiniteVertex`] when
/// coordinates overflow, [`GeometryError::Cancelled`].
pub fn array_components(
    base: &Mesh,
    components: &[&Mesh],
    directions: &Directions,
    options: &ArrayOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Arrayed, GeometryError> {
    array_components_with(base, components, directions, options, &Straight, monitor)
}

/// [`array_components`] with the displacement of every single point decided by
/// `displace`: the door for thickness compensation per vertex (§5).
///
/// `directions` must not be compensated already, since `displace` does that.
///
/// # Errors
/// As [`array_components`]; [`GeometryError::Invalid`] for compensated
/// directions with anything but [`Straight`].
pub fn array_components_with<D: Displace + ?Sized>(
    base: &Mesh,
    components: &[&Mesh],
    directions: &Directions,
    options: &ArrayOptions<'_>,
    displace: &D,
    monitor: &dyn Monitor,
) -> Result<Arrayed, GeometryError> {
    directions.check(base)?;
    if displace.compensates() && directions.is_compensated() {
        return Err(GeometryError::Invalid(
            "the directions are compensated already; compensating every vertex \
             needs the uncompensated ones"
                .into(),
        ));
    }
    let pieces = pieces_of(components, directions, options)?;
    let layout = Layout::new(base, &pieces, options, monitor)?;
    if !options.allow_zero_directions {
        check_directions(directions, &pieces, &layout)?;
    }
    let map = map::Map::new(base, directions, &pieces, &layout, options, monitor)?;
    let map = if displace.compensates() {
        map.with_normals(monitor)?
    } else {
        map
    };
    let positions = map.positions(displace, monitor)?;
    let mesh = replicate::replicate(base, &pieces, &layout, positions, monitor)?;
    let mesh = carry::carry(base, mesh, &pieces, &layout, &map, options, monitor)?;
    let mut array = Arrayed {
        mesh,
        placed: layout.placements.len(),
        skipped_parents: layout.skipped,
        join: None,
        vertex_sources: None,
    };
    if options.join == Join::Weld {
        monitor.check()?;
        let (welded, report) = weld::join(&array.mesh, &pieces, &layout, monitor)?;
        array.mesh = welded.mesh;
        array.join = Some(report);
        array.vertex_sources = Some(welded.vertex_sources);
    }
    Ok(array)
}

/// The components in the unit square.
fn pieces_of(
    components: &[&Mesh],
    directions: &Directions,
    options: &ArrayOptions<'_>,
) -> Result<Vec<Piece>, GeometryError> {
    let fit = options.fit.unwrap_or(&Fit::Bounds);
    let pieces = components.iter();
    pieces
        .map(|component| Piece::new(component, fit, options.height, directions))
        .collect()
}

/// A component in the unit square.
struct Piece {
    /// Positions are (u, v, w).
    mesh: Mesh,
    /// (u', v') of each vertex.
    normal_uv: Vec<glam::DVec2>,
    /// Factor on w: 1 / sqrt(a) for relative heights.
    height_scale: f64,
}

impl Piece {
    fn new(
        component: &Mesh,
        fit: &Fit,
        height: Height,
        directions: &Directions,
    ) -> Result<Self, GeometryError> {
        let options = FitOptions {
            fit: fit.clone(),
            ..FitOptions::default()
        };
        let mesh = fit_component(component, &options)?;
        let normal_uv = match mesh
            .attribute(NORMAL_UV, Domain::Vertex)
            .map(|a| a.values())
        {
            Some(AttributeValues::Vector2(places)) => places.to_vec(),
            Some(other) => {
                return Err(GeometryError::Invalid(format!(
                    "the component's attribute `{NORMAL_UV}` is a {}; it must be a 2D vector",
                    other.type_name()
                )));
            }
            None => mesh.positions().iter().map(|p| p.truncate()).collect(),
        };
        let height_scale = if is_relative(height, directions) {
            let area = component_frame(component, fit)?.area();
            if area <= 0.0 {
                return Err(GeometryError::Empty {
                    what: "the component's box",
                    missing: "area, so heights cannot be relative to it",
                });
            }
            1.0 / area.sqrt()
        } else {
            1.0
        };
        Ok(Self {
            mesh,
            normal_uv,
            height_scale,
        })
    }
}

/// A target sets the size by itself; anything else would scale it twice.
fn is_relative(height: Height, directions: &Directions) -> bool {
    height == Height::Relative && directions.source() == crate::DirectionSource::Surface
}

/// Checks that all vertices of the faces in use have a direction on the sides
/// of the surface that their components are on.
fn check_directions(
    directions: &Directions,
    pieces: &[Piece],
    layout: &Layout<'_>,
) -> Result<(), GeometryError> {
    let on =
        |piece: &Piece, side: fn(f64) -> bool| piece.mesh.positions().iter().any(|p| side(p.z));
    let above: Vec<bool> = pieces.iter().map(|piece| on(piece, |w| w > 0.0)).collect();
    let below: Vec<bool> = pieces.iter().map(|piece| on(piece, |w| w < 0.0)).collect();
    let is_zero =
        |vectors: &[glam::DVec3], vertex: u32| vectors[vertex as usize] == glam::DVec3::ZERO;
    let (mut vertices, mut grid) = (Vec::new(), Vec::new());
    for (index, placement) in layout.placements.iter().enumerate() {
        let component = placement.component as usize;
        layout.grid(index, &mut grid);
        vertices.extend(grid.iter().copied().filter(|&vertex| {
            (above[component] && is_zero(directions.outward(), vertex))
                || (below[component] && is_zero(directions.inward(), vertex))
        }));
    }
    vertices.sort_unstable();
    vertices.dedup();
    if vertices.is_empty() {
        return Ok(());
    }
    Err(GeometryError::ZeroDirection { vertices })
}

/// "faces 3, 4": element ids for messages of this module.
fn faces(ids: &[u32]) -> String {
    let noun = if ids.len() == 1 { "face" } else { "faces" };
    format!("{noun} {}", list_ids(ids))
}
