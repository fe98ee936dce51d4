//! The base, cut into the add-on's domains.

use serde_json::Value;

use super::Settings;

/// How faces become domains, and how these are turned: nodes that take a mesh
/// called MESH.
pub(super) struct Domains {
    cut: String,
    turned: String,
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
}

/// The base as given, with its weights; for patches the limit of its
/// subdivision, as Blender's modifier has it.
pub(super) fn base(settings: &mut Settings) {
    let read = "ReadMesh(path: \"base.obj\")";
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
    if settings.has_weights {
        settings.node("weights", "ReadField(path: \"weights.csv\")");
        let weighted = "SetAttribute(mesh: \"given\", name: \"w\", field: \"weights\")";
        settings.node("read", weighted);
    } else {
        settings.node("read", "Transform(mesh: \"given\")");
    }
}

/// The domains the settings ask for. `turned`: the component has been turned
/// instead of them. Leaves `fill_mode` PATCH to the array.
pub(super) fn domains(settings: &mut Settings, turned: bool) -> Domains {
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
    let quads = fill != "FAN" && fill != "TRI" && !is_patch;
    let shift = match turned || is_patch {
        true => 0.0,
        false => settings.number("rotation_shift", 0.0),
    };
    let turned = if quads && settings.is("rotation_mode", "UV") {
        settings.left.remove("rotation_mode");
        format!("RotateFaces(mesh: \"MESH\", by: UvLayer, turns: {shift})")
    } else if quads && settings.has_weights && settings.is("rotation_mode", "WEIGHT") {
        by_weight(settings, shift)
    } else {
        format!("RotateFaces(mesh: \"MESH\", turns: {shift})")
    };
    Domains { cut, turned }
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
