//! The base, cut into the add-on's domains.

use serde_json::Value;

use super::component::{Component, Turned};
use super::{Settings, turns};

/// How faces become domains, and how these are turned: nodes that take a mesh
/// called MESH.
pub(super) struct Domains {
    cut: String,
    turned: String,
    /// Turns of components in place of the domains': a formula over corners, the
    /// sign of each corner, and turns on top.
    quarters: Option<(String, [f64; 4], f64)>,
}

impl Domains {
    /// The domains of the mesh `of`, as node `result`.
    pub(super) fn of(&self, of: &str, result: &str, settings: &mut Settings) {
        let cut = format!("{result}_cut");
        settings.node(&cut, &self.cut.replace("MESH", of));
        if self.turned.contains("uphill") && result == "base" {
            let field = "EvaluateField(mesh: \"base_cut\", value: \"w\")";
            settings.node("uphill", field);
        }
        settings.node(result, &self.turned.replace("MESH", &cut));
    }

    /// Node `quarters` over `base`, where components turn face by face.
    pub(super) fn turn_components(&self, settings: &mut Settings) {
        if let Some((value, score, shift)) = &self.quarters {
            turns::quarters(settings, value, *score, *shift);
        }
    }
}

/// The base as given, with its weights; for patches the limit of its
/// subdivision, as Blender's modifier has it.
pub(super) fn base(settings: &mut Settings) {
    let read = match settings.is_later {
        true => "Transform(mesh: \"mesh\")",
        false => "ReadMesh(path: \"base.obj\")",
    };
    let levels = settings
        .left
        .get("base_modifiers")
        .filter(|modifiers| modifiers[0][0] == "SUBSURF" && modifiers[1].is_null())
        .and_then(|modifiers| modifiers[0][1].as_u64());
    match (settings.is("fill_mode", "PATCH"), levels) {
        (true, Some(levels)) if levels > 0 => {
            settings.left.remove("base_modifiers");
            settings.node("coarse", read);
            let fine = format!(
                "SubdivideQuad(mesh: \"coarse\", levels: {levels}, boundary: EdgeOnly, positions: Limit)"
            );
            settings.node("given", &fine);
        }
        (true, Some(_)) => {
            // Every face is its own patch.
            settings.left.remove("base_modifiers");
            settings.left.remove("fill_mode");
            settings.node("given", read);
        }
        _ => settings.node("given", read),
    }
    let mut mesh = "given";
    // Later passes have what was carried onto their base.
    if settings.holds.weights && !settings.is_later {
        settings.node("weights", "ReadField(path: \"weights.csv\")");
        let weighted = "SetAttribute(mesh: \"given\", name: \"w\", field: \"weights\")";
        settings.node("weighted", weighted);
        mesh = "weighted";
    }
    if settings.holds.selection && !settings.is_later {
        let selection = "ReadField(path: \"selection.csv\", on: Faces)";
        settings.node("selection", selection);
        let selected =
            format!("SetAttribute(mesh: \"{mesh}\", name: \"selected\", field: \"selection\")");
        settings.node("marked", &selected);
        mesh = "marked";
    }
    settings.node("read", &format!("Transform(mesh: \"{mesh}\")"));
}

/// The domains the settings ask for, turned unless the component is instead.
/// Leaves `fill_mode` PATCH to the array.
pub(super) fn domains(settings: &mut Settings, component: &Component) -> Domains {
    let known = ["QUAD", "TRI", "FAN", "FRAME", "PATCH"];
    let fill = settings.one_of("fill_mode", "QUAD", &known);
    let is_patch = fill == "PATCH";
    if is_patch {
        let fill = Value::String(fill.clone());
        settings.left.insert("fill_mode".to_owned(), fill);
    }
    let cut = match fill.as_str() {
        "FAN" => "FanFaces(mesh: \"MESH\", order: Appended)".to_owned(),
        "TRI" => "TriangulateFaces(mesh: \"MESH\", order: Appended)".to_owned(),
        "FRAME" => frame(settings),
        // A patch keeps its fine faces as they are.
        "PATCH" => "Transform(mesh: \"MESH\")".to_owned(),
        _ => "SplitIntoQuads(mesh: \"MESH\")".to_owned(),
    };
    let as_they_are = || "Transform(mesh: \"MESH\")".to_owned();
    let mut quarters = None;
    let turned = match component.turned {
        Turned::With(_) => as_they_are(),
        Turned::ByFace => {
            quarters = Some(quarters_of_triangles(settings));
            as_they_are()
        }
        Turned::Not if is_patch => as_they_are(),
        Turned::Not => turned(settings, &fill),
    };
    Domains {
        cut,
        turned,
        quarters,
    }
}

/// The node that turns quads, or all faces alike.
fn turned(settings: &mut Settings, fill: &str) -> String {
    let quads = fill != "FAN" && fill != "TRI";
    let shift = settings.number("rotation_shift", 0.0);
    if quads && settings.is("rotation_mode", "UV") {
        settings.left.remove("rotation_mode");
        format!("RotateFaces(mesh: \"MESH\", by: UvLayer, turns: {shift})")
    } else if quads
        && settings.is("rotation_mode", "WEIGHT")
        && settings.has_group("vertex_group_rotation")
    {
        by_weight(settings, shift)
    } else {
        format!("RotateFaces(mesh: \"MESH\", turns: {shift})")
    }
}

/// What decides about the quarters of triangles: the gradient of the group, or of
/// u of the base's UV layer.
fn quarters_of_triangles(settings: &mut Settings) -> (String, [f64; 4], f64) {
    let shift = settings.number("rotation_shift", 0.0);
    if settings.text("rotation_mode", "") == "UV" {
        return ("u".to_owned(), [-1.0, -1.0, 1.0, 1.0], shift);
    }
    settings.left.remove("vertex_group_rotation");
    let sign = match settings.flag("invert_vertex_group_rotation") {
        true => "1 - w",
        false => "w",
    };
    let score = match settings.text("rotation_direction", "ORTHO").as_str() {
        "DIAG" => [-1.0, 0.0, 1.0, 0.0],
        _ => [-1.0, 1.0, 1.0, -1.0],
    };
    (sign.to_owned(), score, shift)
}

/// Turned along the gradient of the vertex group.
fn by_weight(settings: &mut Settings, shift: f64) -> String {
    settings.left.remove("rotation_mode");
    settings.left.remove("vertex_group_rotation");
    let downhill = settings.flag("invert_vertex_group_rotation");
    let along = match settings.text("rotation_direction", "ORTHO").as_str() {
        "DIAG" => "Diagonals",
        _ => "Edges",
    };
    format!(
        "RotateFaces(mesh: \"MESH\", by: Gradient, field: \"uphill\", along: {along}, \
         downhill: {downhill}, turns: {shift})"
    )
}

/// The add-on's frames. A group of weights scales the width, with one mean
/// weight per face unless `face_weight_frame` is off.
fn frame(settings: &mut Settings) -> String {
    let width = settings.number("frame_thickness", 0.2);
    let by_face = settings.left.remove("face_weight_frame") != Some(Value::Bool(false));
    let known = ["CONSTANT", "RELATIVE", "CENTER"];
    let (inset, input) = match settings.one_of("frame_mode", "CONSTANT", &known).as_str() {
        "RELATIVE" => ("Relative", "factor"),
        "CENTER" => ("Centre", "factor"),
        _ => ("Constant", "width"),
    };
    let width = match settings.group("vertex_group_frame_thickness") {
        None => format!("{width:?}"),
        Some(weight) => {
            let on = if by_face { "Faces" } else { "Vertices" };
            let field = format!(
                "EvaluateField(mesh: \"read\", on: {on}, value: \"{width:?} * ({weight})\")"
            );
            settings.node("frame_width", &field);
            "\"frame_width\"".to_owned()
        }
    };
    let border = settings.flag("frame_boundary");
    let outside = match settings.number("frame_boundary_thickness", 0.0) {
        outside if outside > 0.0 => format!(", border_width: {outside:?}"),
        _ => String::new(),
    };
    let preserve = settings.flag("preserve_quads");
    let fill = match settings.flag("fill_frame") {
        true => "Fan",
        false => "Open",
    };
    format!(
        "FrameFaces(mesh: \"MESH\", inset: {inset}, {input}: {width}, border: {border}{outside}, \
         fill: {fill}, preserve_quads: {preserve})"
    )
}
