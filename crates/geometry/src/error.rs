//! What can be wrong with the input of a geometric operation.

use crate::mesh::Domain;

/// An operation's input breaks a precondition, or the caller cancelled it.
///
/// Errors name elements by index as stored in the mesh, counted from 0. They
/// know nothing of graphs, nodes or files; those add their own context.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// The caller's monitor asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NonFiniteVertex {
        /// The first such vertex.
        vertex: usize,
    },
    /// A surface given by a formula has no finite place for some parameters.
    #[error("the surface is not finite at u = {u}, v = {v}")]
    NonFiniteSurface {
        /// First parameter, 0..=1, of the first such place in row order.
        u: f64,
        /// Second parameter, 0..=1.
        v: f64,
    },
    /// Meshes to be joined use one attribute name for different types.
    #[error(
        "attribute `{name}` of {domain} elements holds {first}s in one mesh and {other}s in another"
    )]
    AttributeTypes {
        /// The attribute's name.
        name: String,
        /// The domain it is on.
        domain: Domain,
        /// Its type in the first mesh that has it.
        first: &'static str,
        /// Another type it has.
        other: &'static str,
    },
    /// A value computed for an element is NaN or infinite.
    #[error("{what} of {domain} {index} is not finite")]
    NonFiniteValue {
        /// Which quantity.
        what: &'static str,
        /// What kind of element.
        domain: Domain,
        /// The first such element.
        index: usize,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {index}, but there are {vertex_count} vertices")]
    IndexOutOfRange {
        /// The first such face.
        face: usize,
        /// The index it names.
        index: usize,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A face has fewer than three corners.
    #[error("face {face} has {corners} corners; a face needs at least 3")]
    TooFewCorners {
        /// The first such face.
        face: usize,
        /// Its corner count.
        corners: usize,
    },
    /// More elements than 32-bit indices can name.
    #[error("{what} would number {count}, above the limit of {limit}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many were asked for.
        count: u128,
        /// How many are possible.
        limit: u128,
    },
    /// A result that the memory left cannot hold ([`crate::Monitor::afford`]).
    #[error("it needs about {} MB of memory, and {} MB are left", mega(*.needed), mega((*.left).into()))]
    OutOfMemory {
        /// Bytes of the result, about.
        needed: u128,
        /// Bytes that may still be taken.
        left: u64,
    },
    /// An attribute's length differs from the number of elements of its domain.
    #[error("attribute `{name}` has {actual} values for {expected} {domain} elements")]
    AttributeLength {
        /// The attribute's name.
        name: String,
        /// The domain it is on.
        domain: Domain,
        /// Elements of that domain.
        expected: usize,
        /// Values given.
        actual: usize,
    },
    /// The mesh has no attribute of that name, domain and type.
    #[error("there is no {wanted} attribute `{name}`; {}", list_or_none(.available))]
    NoAttribute {
        /// The name asked for.
        name: String,
        /// Domain and type asked for, in words.
        wanted: &'static str,
        /// What the mesh has, by name.
        available: Vec<String>,
    },
    /// Something made for one mesh is used with another.
    #[error(
        "{what} belong to a mesh with {theirs_vertices} vertices and {theirs_faces} faces, \
         but this mesh has {ours_vertices} vertices and {ours_faces} faces{}",
        same_counts_hint(*.theirs_vertices == *.ours_vertices && *.theirs_faces == *.ours_faces)
    )]
    OtherTopology {
        /// What does not belong: directions, a field.
        what: &'static str,
        /// Vertices of the mesh it was made for.
        theirs_vertices: usize,
        /// Faces of the mesh it was made for.
        theirs_faces: usize,
        /// Vertices of the mesh it is used with.
        ours_vertices: usize,
        /// Faces of the mesh it is used with.
        ours_faces: usize,
    },
    /// A field's length differs from the number of elements it should cover.
    #[error("the field has one value per {domain} and {actual} values, but {expected} are needed")]
    FieldLength {
        /// The field's domain.
        domain: Domain,
        /// Elements to cover.
        expected: usize,
        /// Values in the field.
        actual: usize,
    },
    /// A field on one domain is used where the other is needed.
    #[error("the field is on {actual} elements, but one per {expected} is needed")]
    FieldDomain {
        /// The domain needed.
        expected: Domain,
        /// The domain it is on.
        actual: Domain,
    },
    /// Base and target differ in their faces.
    #[error(
        "the target's face {face} has vertices {target:?}, the base's has {base:?}; \
         both need the same faces with the same indices"
    )]
    TargetFace {
        /// The first face that differs.
        face: usize,
        /// Its vertices in the base.
        base: Vec<u32>,
        /// Its vertices in the target.
        target: Vec<u32>,
    },
    /// Base and target differ in their counts.
    #[error(
        "the base has {base_vertices} vertices and {base_faces} faces, \
         the target {target_vertices} and {target_faces}"
    )]
    TargetCounts {
        /// Vertices of the base.
        base_vertices: usize,
        /// Faces of the base.
        base_faces: usize,
        /// Vertices of the target.
        target_vertices: usize,
        /// Faces of the target.
        target_faces: usize,
    },
    /// Vertices whose direction has no length.
    #[error("{} no direction: its length is zero", name_vertices(.vertices, "has", "have"))]
    ZeroDirection {
        /// The vertices, ascending.
        vertices: Vec<u32>,
    },
    /// Vertices whose direction points against the surface normal.
    #[error(
        "the {} of {} against the surface normal",
        if .vertices.len() == 1 { "direction" } else { "directions" },
        name_vertices(.vertices, "points", "point")
    )]
    OpposedDirection {
        /// The vertices, ascending.
        vertices: Vec<u32>,
    },
    /// Vertices of faces that have no normal, because all their faces are degenerate.
    #[error("{} no normal: the faces around have no area or face opposite ways", name_vertices(.vertices, "has", "have"))]
    NoNormal {
        /// The vertices, ascending.
        vertices: Vec<u32>,
    },
    /// Faces without area, where their normal is needed.
    #[error("{} no area, so there is no normal", name_faces(.faces))]
    NoArea {
        /// The faces, ascending.
        faces: Vec<u32>,
    },
    /// Compensated directions where their plain lengths are needed.
    #[error(
        "the directions are compensated for thickness already; \
         {operation} takes them before CompensateThickness"
    )]
    Compensated {
        /// What refuses them, as a node's name.
        operation: &'static str,
    },
    /// An iteration did not reach its tolerance.
    #[error(
        "{what} did not converge: after {after} iterations the residual is {residual:e}, \
         above {tolerance:e}; {advice}"
    )]
    NoConvergence {
        /// What was being solved.
        what: &'static str,
        /// Iterations made.
        after: usize,
        /// What is left, relative to the start.
        residual: f64,
        /// What was to be reached.
        tolerance: f64,
        /// What helps.
        advice: &'static str,
    },
    /// Edges with more than two faces, where a manifold is needed.
    #[error("{}", nonmanifold(.edges))]
    NonManifold {
        /// Their end vertices, with how many faces each has.
        edges: Vec<([u32; 2], usize)>,
    },
    /// A face names the same vertex twice in a row, so one of its edges has no
    /// second end.
    #[error(
        "face {face} names vertex {vertex} twice in a row; \
         weld the mesh or remove its degenerate faces first"
    )]
    RepeatedVertex {
        /// The first such face.
        face: usize,
        /// The vertex it repeats.
        vertex: u32,
    },
    /// A face has more corners than the operation handles.
    #[error("face {face} has {corners} corners; {advice}")]
    NotQuad {
        /// The first such face.
        face: usize,
        /// Its corner count.
        corners: usize,
        /// What splits it.
        advice: &'static str,
    },
    /// An input is outside the range the operation is defined for.
    #[error("{what} is {value}, but {requirement}")]
    OutOfRange {
        /// Which input.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The rule, in words.
        requirement: &'static str,
    },
    /// The mesh has nothing to work on.
    #[error("{what} has no {missing}")]
    Empty {
        /// Which mesh.
        what: &'static str,
        /// What it lacks: vertices, faces, extent.
        missing: &'static str,
    },
    /// Any other broken precondition, in words.
    #[error("{0}")]
    Invalid(String),
}

impl GeometryError {
    /// What to do about it, where that does not depend on the operation.
    pub fn advice(&self) -> Option<&'static str> {
        Some(match self {
            Self::NonFiniteVertex { .. } | Self::IndexOutOfRange { .. } => {
                "repair the mesh in the program that made it"
            }
            Self::TooMany { .. } => "use fewer levels, cells or faces",
            Self::OutOfMemory { .. } => {
                "use fewer levels, cells or faces, or raise the memory limit"
            }
            Self::NoAttribute { .. } => {
                "use one of these names, or add the attribute with SetAttribute"
            }
            Self::OtherTopology { .. } | Self::FieldLength { .. } => {
                "make them from the same mesh they are used with"
            }
            Self::FieldDomain { .. } => "make the field on those elements",
            Self::TargetFace { .. } | Self::TargetCounts { .. } => {
                "make base and target by the same steps, or edit one from a copy of the other"
            }
            Self::ZeroDirection { .. } => {
                "orient the faces there alike, or move these vertices of the target"
            }
            Self::OpposedDirection { .. } => {
                "flip the faces, smooth the directions less, or move the target"
            }
            Self::NoNormal { .. } => {
                "orient the faces alike with FlipFaces, or remove the degenerate ones"
            }
            Self::NoArea { .. } => "repair or delete these faces",
            Self::Compensated { .. } => "give it the directions from before CompensateThickness",
            Self::NonManifold { .. } => "split the mesh along these edges",
            Self::RepeatedVertex { .. } => "weld the mesh, or repair the face",
            _ => return None,
        })
    }
}

/// Whole megabytes, rounded up.
fn mega(bytes: u128) -> u128 {
    bytes.div_ceil(1_000_000)
}

/// How many element ids a message lists before it only counts the rest.
const LISTED: usize = 8;

/// "vertex 4 has" or "vertices 4, 7 and 11 more have": ids for a message.
fn name_vertices(ids: &[u32], one: &str, many: &str) -> String {
    match ids {
        [id] => format!("vertex {id} {one}"),
        _ => format!("vertices {} {many}", list_ids(ids)),
    }
}

/// "face 4 has" or "faces 4 and 7 have".
fn name_faces(ids: &[u32]) -> String {
    match ids {
        [id] => format!("face {id} has"),
        _ => format!("faces {} have", list_ids(ids)),
    }
}

/// Element ids for a message: at most eight, then "and n more".
///
/// ```
/// assert_eq!(tessgraph_geometry::list_ids(&[1, 2]), "1, 2");
/// assert_eq!(tessgraph_geometry::list_ids(&[1, 2, 3, 4, 5, 6, 7, 8, 9]), "1, 2, 3, 4, 5, 6, 7, 8 and 1 more");
/// ```
pub fn list_ids(ids: &[u32]) -> String {
    let listed: Vec<_> = ids.iter().take(LISTED).map(u32::to_string).collect();
    let mut text = listed.join(", ");
    if ids.len() > LISTED {
        text.push_str(&format!(" and {} more", ids.len() - LISTED));
    }
    text
}

fn nonmanifold(edges: &[([u32; 2], usize)]) -> String {
    let listed: Vec<_> = edges
        .iter()
        .take(LISTED)
        .map(|([a, b], faces)| format!("{a}-{b} ({faces} faces)"))
        .collect();
    let more = match edges.len().saturating_sub(LISTED) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    format!(
        "{} with more than two faces: {}{more}",
        count(edges.len(), "edge"),
        listed.join(", ")
    )
}

/// "1 edge", "3 edges".
fn count(n: usize, noun: &str) -> String {
    if n == 1 {
        format!("1 {noun}")
    } else {
        format!("{n} {noun}s")
    }
}

fn list_or_none(names: &[String]) -> String {
    if names.is_empty() {
        "the mesh has none".to_owned()
    } else {
        let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        format!("the mesh has {}", quoted.join(", "))
    }
}

fn same_counts_hint(same: bool) -> &'static str {
    if same { " in another order" } else { "" }
}
