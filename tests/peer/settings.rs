//! The add-on's settings as a graph.

use serde_json::{Map, Value};

/// What a case asks for.
pub(super) enum Request {
    /// A graph whose node `result` is the array.
    Graph {
        /// Its text.
        text: String,
        /// Whether the component was cut at the square's sides.
        clipped: bool,
    },
    /// Keys that have no counterpart.
    Refused(Vec<String>),
}

/// Settings still to be understood; what is left over is refused.
struct Settings {
    left: Map<String, Value>,
}

impl Settings {
    fn text(&mut self, key: &str, default: &str) -> String {
        let value = self.left.remove(key);
        value
            .and_then(|value| Some(value.as_str()?.to_owned()))
            .unwrap_or(default.to_owned())
    }

    fn flag(&mut self, key: &str) -> bool {
        self.left
            .remove(key)
            .and_then(|value| value.as_bool())
            .unwrap_or(false)
    }

    fn number(&mut self, key: &str, default: f64) -> f64 {
        self.left
            .remove(key)
            .and_then(|value| value.as_f64())
            .unwrap_or(default)
    }

    /// The value of `key` out of those that are understood; others are put back.
    fn one_of(&mut self, key: &str, default: &str, known: &[&str]) -> String {
        let value = self.text(key, default);
        if !known.contains(&value.as_str()) {
            self.left
                .insert(key.to_owned(), Value::String(value.clone()));
        }
        value
    }
}

/// The graph that asks for what the settings ask the add-on for.
pub(super) fn graph(settings: &str, has_weights: bool) -> Request {
    let document: Value = serde_json::from_str(settings).expect("settings are JSON");
    let left = document["settings"]
        .as_object()
        .cloned()
        .unwrap_or_default();
    let mut settings = Settings { left };
    let uv_layer = document["component_uv_layer"].as_str() == Some("Eval_Normals");
    if !document["base_modifiers"].is_null() {
        settings.left.insert(
            "base_modifiers".to_owned(),
            document["base_modifiers"].clone(),
        );
    }
    let mut nodes = vec![
        given(&mut settings),
        "\"drawn\": ReadMesh(path: \"component.obj\")".to_owned(),
    ];
    if has_weights {
        nodes.push("\"weights\": ReadField(path: \"weights.csv\")".to_owned());
        let weighted = "\"read\": SetAttribute(mesh: \"given\", name: \"w\", field: \"weights\")";
        nodes.push(weighted.to_owned());
    } else {
        nodes.push("\"read\": Transform(mesh: \"given\")".to_owned());
    }
    let (cut, turned) = domains(&mut settings, has_weights);
    let of = |mesh: &str, result: &str| {
        [
            format!("\"{result}_cut\": {cut}").replace("MESH", mesh),
            format!("\"{result}\": {turned}").replace("MESH", &format!("{result}_cut")),
        ]
    };
    if turned.contains("uphill") {
        nodes.push("\"uphill\": EvaluateField(mesh: \"base_cut\", value: \"w\")".to_owned());
    }
    nodes.extend(of("read", "base"));
    let clipped = settings.left.contains_key("bounds_x") || settings.left.contains_key("bounds_y");
    nodes.push(component(&mut settings, uv_layer));
    if settings.left.get("normals_mode").and_then(Value::as_str) == Some("OBJECT") {
        nodes.push("\"read_target\": ReadMesh(path: \"target.obj\")".to_owned());
        nodes.extend(of("read_target", "target"));
    }
    nodes.extend(directions(&mut settings));
    nodes.push(array(&mut settings, has_weights));
    nodes.extend(weights(&mut settings, has_weights));
    if !settings.left.is_empty() {
        return Request::Refused(settings.left.keys().cloned().collect());
    }
    let nodes = nodes.join(",\n    ");
    let text = format!(
        "Graph(version: 1, nodes: {{\n    {nodes},\n}}, outputs: {{\"out.obj\": \"result\"}})"
    );
    Request::Graph { text, clipped }
}

/// How the base's faces become domains, and how these are turned: nodes that
/// take a mesh called MESH.
fn domains(settings: &mut Settings, has_weights: bool) -> (String, String) {
    let fill = settings.one_of(
        "fill_mode",
        "QUAD",
        &["QUAD", "TRI", "FAN", "FRAME", "PATCH"],
    );
    let is_patch = fill == "PATCH";
    if is_patch {
        settings
            .left
            .insert("fill_mode".to_owned(), Value::String(fill.clone()));
    }
    let cut = match fill.as_str() {
        "FAN" => "FanFaces(mesh: \"MESH\", order: Appended)".to_owned(),
        "TRI" => "TriangulateFaces(mesh: \"MESH\", order: Appended)".to_owned(),
        "FRAME" => frame(settings),
        // A patch keeps its fine faces as they are.
        "PATCH" => "Transform(mesh: \"MESH\")".to_owned(),
        _ => "SplitIntoQuads(mesh: \"MESH\")".to_owned(),
    };
    let shift = match fill.as_str() {
        // The add-on turns a triangle as a quad with a side of no length.
        "FAN" | "TRI" => 0.0,
        _ => settings.number("rotation_shift", 0.0),
    };
    let by_weight = fill != "FAN"
        && fill != "TRI"
        && has_weights
        && settings.left.get("rotation_mode").and_then(Value::as_str) == Some("WEIGHT");
    if !by_weight {
        settings.one_of("rotation_mode", "DEFAULT", &["DEFAULT"]);
        return (cut, format!("RotateFaces(mesh: \"MESH\", turns: {shift})"));
    }
    settings.left.remove("rotation_mode");
    settings.left.remove("vertex_group_rotation");
    let downhill = settings.flag("invert_vertex_group_rotation");
    let along = match settings.text("rotation_direction", "ORTHO").as_str() {
        "DIAG" => "Diagonals",
        _ => "Edges",
    };
    let turned = format!(
        "RotateFaces(mesh: \"MESH\", by: Gradient, field: \"uphill\", along: {along}, \
         downhill: {downhill}, turns: {shift})"
    );
    (cut, turned)
}

/// The base as given; for patches the limit of its subdivision, as Blender's
/// modifier has it.
fn given(settings: &mut Settings) -> String {
    let read = "\"given\": ReadMesh(path: \"base.obj\")".to_owned();
    let is_patch = settings.left.get("fill_mode").and_then(Value::as_str) == Some("PATCH");
    let levels = settings
        .left
        .get("base_modifiers")
        .filter(|modifiers| modifiers[0][0] == "SUBSURF" && modifiers[1].is_null())
        .and_then(|modifiers| modifiers[0][1].as_u64());
    let (true, Some(levels)) = (is_patch, levels) else {
        return read;
    };
    settings.left.remove("base_modifiers");
    if levels == 0 {
        // Every face is its own patch.
        settings.left.remove("fill_mode");
        return read;
    }
    format!(
        "{},\n    \"given\": SubdivideQuad(mesh: \"coarse\", levels: {levels}, \
         boundary: EdgeOnly, positions: Limit)",
        read.replace("\"given\"", "\"coarse\"")
    )
}

/// The add-on's frames.
fn frame(settings: &mut Settings) -> String {
    let width = settings.number("frame_thickness", 0.2);
    let inset = match settings
        .one_of(
            "frame_mode",
            "CONSTANT",
            &["CONSTANT", "RELATIVE", "CENTER"],
        )
        .as_str()
    {
        "RELATIVE" => format!("inset: Relative, factor: {width:?}"),
        "CENTER" => format!("inset: Centre, factor: {width:?}"),
        _ => format!("inset: Constant, width: {width:?}"),
    };
    let border = settings.flag("frame_boundary");
    let preserve = settings.flag("preserve_quads");
    let fill = match settings.flag("fill_frame") {
        true => "Fan",
        false => "Open",
    };
    format!(
        "FrameFaces(mesh: \"MESH\", {inset}, border: {border}, fill: {fill}, preserve_quads: {preserve})"
    )
}

/// The component at the add-on's height, with its places of direction.
fn component(settings: &mut Settings, uv_layer: bool) -> String {
    let height = settings.number("zscale", 1.0);
    let local = settings.left.get("mode").and_then(Value::as_str) == Some("LOCAL");
    let mut beyond = |key: &str| match local {
        false => "Extend",
        true => match settings
            .one_of(key, "EXTEND", &["EXTEND", "CLIP", "CYCLIC"])
            .as_str()
        {
            "CLIP" => "Clip",
            "CYCLIC" => "Cyclic",
            _ => "Extend",
        },
    };
    let (x, y) = (beyond("bounds_x"), beyond("bounds_y"));
    let scaled = if (x, y) == ("Extend", "Extend") {
        format!("\"component\": Transform(mesh: \"drawn\", scale: (1, 1, {height:?}))")
    } else {
        format!(
            "\"high\": Transform(mesh: \"drawn\", scale: (1, 1, {height:?})),\n    \
             \"component\": FitComponent(component: \"high\", fit: Unit, x: {x}, y: {y})"
        )
    };
    if !uv_layer {
        return scaled;
    }
    let fit = match settings.left.get("mode").and_then(Value::as_str) {
        Some("LOCAL") => "Unit",
        _ => "Bounds",
    };
    format!(
        "{},\n    \"component\": EvaluateNormalsUV(component: \"scaled\", source: UvLayer, axes: U, fit: {fit})",
        scaled.replace("\"component\"", "\"scaled\"")
    )
}

/// The directions, under the name `directions`.
fn directions(settings: &mut Settings) -> Vec<String> {
    let constant = settings.left.get("scale_mode").and_then(Value::as_str) == Some("CONSTANT");
    let smooth = settings.flag("smooth_normals");
    let passes = settings.number("smooth_normals_iter", 5.0);
    match settings
        .one_of("normals_mode", "VERTS", &["VERTS", "OBJECT", "CUSTOM"])
        .as_str()
    {
        "OBJECT" => {
            let length = if constant { "Unit" } else { "Target" };
            vec![format!(
                "\"directions\": TargetDirections(mesh: \"base\", target: \"target\", length: {length})"
            )]
        }
        // The mean of the corners' normals, not normalised; with flat shading a
        // corner has the normal of its face.
        "CUSTOM" => vec!["\"directions\": FaceNormals(mesh: \"base\", unit: false)".to_owned()],
        _ if smooth => {
            // With constant thickness a direction that ends up against the normal is
            // turned round; with relative thickness it is left.
            vec![format!(
                "\"directions\": SmoothNormals(mesh: \"base\", scheme: EdgeSum, iterations: {passes}, flip_inverted: {constant})"
            )]
        }
        _ => vec!["\"directions\": VertexNormals(mesh: \"base\")".to_owned()],
    }
}

fn array(settings: &mut Settings, has_weights: bool) -> String {
    let fit = match settings
        .one_of("mode", "BOUNDS", &["BOUNDS", "LOCAL"])
        .as_str()
    {
        "LOCAL" => "Unit",
        _ => "Bounds",
    };
    let height = match settings
        .one_of("scale_mode", "ADAPTIVE", &["ADAPTIVE", "CONSTANT"])
        .as_str()
    {
        "CONSTANT" => "Absolute",
        _ => "Relative",
    };
    let join = if settings.flag("merge") {
        "Weld"
    } else {
        "None"
    };
    settings.number("merge_thres", 1e-4);
    let patch = match settings.left.remove("fill_mode") {
        Some(Value::String(mode)) if mode == "PATCH" => ", domain: Parent",
        Some(other) => {
            settings.left.insert("fill_mode".to_owned(), other);
            ""
        }
        None => "",
    };
    // The add-on's iterations for one factor per vertex; here every vertex is solved.
    let even = if settings.flag("even_thickness") {
        settings.left.remove("even_thickness_iter");
        ", compensate: PerVertex"
    } else {
        ""
    };
    let weighted = has_weights && settings.left.contains_key("vertex_group_thickness");
    let scale = if weighted { ", scale: \"factor\"" } else { "" };
    format!(
        "\"result\": ArrayComponents(base: \"base\", component: \"component\", directions: \"directions\", \
         fit: {fit}, height: {height}, interpolation: Linear, join: {join}{scale}{patch}{even})"
    )
}

/// The thickness factor w (1 - f) + f of a vertex group w.
fn weights(settings: &mut Settings, has_weights: bool) -> Option<String> {
    if !has_weights || !settings.left.contains_key("vertex_group_thickness") {
        return None;
    }
    settings.left.remove("vertex_group_thickness");
    let least = settings.number("vertex_group_thickness_factor", 0.0);
    Some(format!(
        "\"factor\": EvaluateField(mesh: \"base\", value: \"w * (1 - {least:?}) + {least:?}\")"
    ))
}
