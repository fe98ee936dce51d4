//! Directions, as the add-on makes them.

use super::Settings;

/// What vectors belong to.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Cells {
    /// Vertices that faces share: node `base`.
    Joined,
    /// Faces that are flat cells each, one by one: node `cells`.
    Flat,
}

impl Cells {
    /// The node that components are arrayed over.
    pub(super) fn base(self) -> &'static str {
        match self {
            Self::Joined => "base",
            Self::Flat => "cells",
        }
    }
}

/// Node `directions`, of the vertices of the cells.
pub(super) fn directions(settings: &mut Settings) -> Cells {
    let constant = settings.is("scale_mode", "CONSTANT");
    if settings.is("normals_mode", "OBJECT") && !settings.holds.target {
        // A target that does not fit is passed over.
        settings.left.remove("normals_mode");
        settings.flag("even_thickness");
    }
    // Patches have no one face that is flat.
    let known: &[&str] = match settings.is("fill_mode", "PATCH") {
        true => &["VERTS", "OBJECT", "CUSTOM"],
        false => &["VERTS", "OBJECT", "CUSTOM", "FACES"],
    };
    let mut cells = Cells::Joined;
    match settings.one_of("normals_mode", "VERTS", known).as_str() {
        "OBJECT" => towards_target(settings, constant),
        // The mean of the corners' normals, not normalised; with flat shading a
        // corner has the normal of its face. Smoothing it makes the add-on fail.
        "CUSTOM" => {
            forget_smoothing(settings);
            settings.node("directions", "FaceNormals(mesh: \"base\", unit: false)");
        }
        "FACES" => {
            forget_smoothing(settings);
            cells = Cells::Flat;
            separate(settings, !constant);
            scaled(settings, cells, "FaceNormals(mesh: \"cells\")");
        }
        _ => along_normals(settings, constant),
    }
    if !settings.left.contains_key("smooth_normals") {
        settings.left.remove("smooth_normals_iter");
    }
    cells
}

/// Drops what nothing reads without smoothing.
fn forget_smoothing(settings: &mut Settings) {
    for key in [
        "smooth_normals",
        "smooth_normals_iter",
        "smooth_normals_uv",
        "vertex_group_smooth_normals",
        "invert_vertex_group_smooth_normals",
    ] {
        settings.left.remove(key);
    }
}

/// Vectors to the target: as long as the way, or of length 1. Smoothed they are as
/// vectors; of length 1, they then reach the height along the normal.
fn towards_target(settings: &mut Settings, constant: bool) {
    // With even thickness the add-on smooths another field, which it does not use.
    let smooth = settings.flag("smooth_normals") && !settings.left.contains_key("even_thickness");
    let towards = |length: &str| {
        format!("TargetDirections(mesh: \"base\", target: \"target\", length: {length})")
    };
    if !smooth {
        forget_smoothing(settings);
        let length = if constant { "Unit" } else { "Target" };
        return settings.node("directions", &towards(length));
    }
    settings.node("towards", &towards("Target"));
    let smoothed = smoothed(
        settings,
        ", directions: \"towards\", lengths: Diffuse",
        constant,
    );
    if constant {
        settings.node("smoothed", &smoothed);
        let even = "CompensateThickness(mesh: \"base\", directions: \"smoothed\", thickness: 1, \
                    mode: Local, limit: 1000)";
        settings.node("directions", even);
    } else {
        settings.node("directions", &smoothed);
    }
}

/// The node that smooths directions as the add-on does, by the settings.
fn smoothed(settings: &mut Settings, more: &str, flip: bool) -> String {
    let passes = settings.number("smooth_normals_iter", 5.0);
    let weights = settings.group("vertex_group_smooth_normals").map(|weight| {
        let field = format!("EvaluateField(mesh: \"base\", value: \"{weight}\")");
        settings.node("part", &field);
        ", weights: \"part\""
    });
    let anisotropy = settings.number("smooth_normals_uv", 0.0);
    // With constant thickness a direction that ends up against the normal is turned
    // round; with relative thickness it is left.
    format!(
        "SmoothNormals(mesh: \"base\", scheme: EdgeSum, iterations: {passes}, \
         flip_inverted: {flip}, anisotropy: {anisotropy:?}{}{more})",
        weights.unwrap_or_default()
    )
}

/// Vertex normals, smoothed, and scaled along the axes.
fn along_normals(settings: &mut Settings, constant: bool) {
    let node = if settings.flag("smooth_normals") {
        smoothed(settings, "", constant)
    } else {
        forget_smoothing(settings);
        "VertexNormals(mesh: \"base\")".to_owned()
    };
    scaled(settings, Cells::Joined, &node);
}

/// Node `directions`: those of `node` scaled along the axes, by a group's weights.
fn scaled(settings: &mut Settings, cells: Cells, node: &str) {
    let [x, y, z] = ["normals_x", "normals_y", "normals_z"].map(|key| settings.number(key, 1.0));
    if [x, y, z].iter().all(|factor| (factor - 1.0).abs() <= 0.0) {
        // Nothing reads its group.
        settings.left.remove("vertex_group_scale_normals");
        settings.left.remove("invert_vertex_group_scale_normals");
        return settings.node("directions", node);
    }
    let base = cells.base();
    let amount = settings.group("vertex_group_scale_normals").map(|weight| {
        let field = format!("EvaluateField(mesh: \"{base}\", value: \"{weight}\")");
        settings.node("amount", &field);
        ", amount: \"amount\""
    });
    settings.node("unscaled", node);
    let scaled = format!(
        "ScaleDirections(mesh: \"{base}\", directions: \"unscaled\", \
         factors: ({x:?}, {y:?}, {z:?}){})",
        amount.unwrap_or_default()
    );
    settings.node("directions", &scaled);
}

/// Node `cells`: the faces of the base one by one, turned to the border where that
/// is asked for, since afterwards all are at one; with the mean size of the faces
/// round each vertex, by which the add-on scales heights here, too.
fn separate(settings: &mut Settings, relative: bool) {
    let mut mesh = "base";
    if settings.flag("auto_rotate_boundary") {
        settings.node("to_border", "RotateFaces(mesh: \"base\", by: Border)");
        mesh = "to_border";
    }
    if relative {
        settings.node("sizes", "AreaField(mesh: \"base\", on: Vertices)");
        let sized = format!("SetAttribute(mesh: \"{mesh}\", name: \"size\", field: \"sizes\")");
        settings.node("sized", &sized);
        mesh = "sized";
    }
    settings.node("cells", &format!("SeparateFaces(mesh: \"{mesh}\")"));
}
