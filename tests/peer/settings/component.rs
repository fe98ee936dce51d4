//! The component at the add-on's height, with its places of direction.

use super::Settings;

/// How the component stands in the unit square.
pub(super) struct Component {
    /// `Bounds` or `Unit`.
    pub(super) fit: &'static str,
}

/// Makes node `component`. Also whether it was turned because its triangles
/// cannot be: the add-on turns a triangle as a quad with a side of no length.
pub(super) fn component(settings: &mut Settings, uv_layer: bool) -> (Component, bool) {
    settings.node("drawn", "ReadMesh(path: \"component.obj\")");
    let local = settings.is("mode", "LOCAL") || settings.is("mode", "GLOBAL");
    let triangles = settings.is("fill_mode", "FAN") || settings.is("fill_mode", "TRI");
    let turns = match triangles && settings.left.contains_key("rotation_shift") {
        true => settings.number("rotation_shift", 0.0),
        false => 0.0,
    };
    let high = heights(settings, local);
    let fit = if turns.abs() > 0.0 || local {
        "Unit"
    } else {
        "Bounds"
    };
    let beyond = ["bounds_x", "bounds_y"].map(|key| beyond(settings, key, local));
    if turns.abs() > 0.0 && !local {
        in_the_square(settings, high);
    } else if beyond == ["Extend", "Extend"] {
        settings.node("placed", &format!("Transform(mesh: \"{high}\")"));
    } else {
        let [x, y] = beyond;
        let fitted = format!("FitComponent(component: \"{high}\", fit: Unit, x: {x}, y: {y})");
        settings.node("placed", &fitted);
    }
    let turned = format!(
        "Transform(mesh: \"placed\", rotate: (0, 0, {:?}), pivot: (0.5, 0.5, 0))",
        -90.0 * turns
    );
    let turned = if turns.abs() > 0.0 {
        &turned
    } else {
        "Transform(mesh: \"placed\")"
    };
    if uv_layer {
        settings.node("turned", turned);
        let places = format!(
            "EvaluateNormalsUV(component: \"turned\", source: UvLayer, axes: U, fit: {fit})"
        );
        settings.node("component", &places);
    } else {
        settings.node("component", turned);
    }
    (Component { fit }, triangles)
}

/// The component at its height, as the node whose name is returned.
fn heights(settings: &mut Settings, local: bool) -> &'static str {
    let about_box = settings.left.remove("use_origin_offset").is_some();
    if about_box && !local {
        return about_the_box(settings);
    }
    // Heights as drawn; the add-on's offset counts from the box only.
    settings.left.remove("offset");
    let height = settings.number("zscale", 1.0);
    let high = format!("Transform(mesh: \"drawn\", scale: (1, 1, {height:?}))");
    settings.node("high", &high);
    "high"
}

/// What happens beyond the unit square along an axis; nothing is beyond a box.
fn beyond(settings: &mut Settings, key: &str, local: bool) -> &'static str {
    let known = ["EXTEND", "CLIP", "CYCLIC"];
    match settings.one_of(key, "EXTEND", &known).as_str() {
        "CLIP" if local => "Clip",
        "CYCLIC" if local => "Cyclic",
        _ => "Extend",
    }
}

/// Node `level`: heights counted from the component's box. With constant
/// thickness or a target w = ((z - low) / depth - 1/2 + offset/2) zscale, else
/// w = (z - low + (offset/2 - 1/2) depth) zscale.
fn about_the_box(settings: &mut Settings) -> &'static str {
    let offset = settings.number("offset", 1.0);
    let height = settings.number("zscale", 1.0);
    let unit = settings.is("scale_mode", "CONSTANT") || settings.is("normals_mode", "OBJECT");
    settings.node("box", "MeasureMesh(mesh: \"drawn\")");
    settings.node("above", "FitComponent(component: \"drawn\", anchor: Above)");
    let (scale, depth) = match unit {
        true => (format!("{height:?} / box.size_z"), format!("{height:?}")),
        false => (format!("{height:?}"), format!("{height:?} * box.size_z")),
    };
    let level = format!(
        "Transform(mesh: \"above\", scale: (\"box.size_x\", \"box.size_y\", \"{scale}\"), \
         translate: (0, 0, \"({offset:?} / 2 - 0.5) * {depth}\"))"
    );
    settings.node("level", &level);
    "level"
}

/// Node `placed`: the component's box as the unit square. Relative heights, which
/// go by the box's area, are made relative to the square's.
fn in_the_square(settings: &mut Settings, high: &str) {
    settings.node("outline", &format!("MeasureMesh(mesh: \"{high}\")"));
    settings.node("square", &format!("FitComponent(component: \"{high}\")"));
    let absolute = settings.is("scale_mode", "CONSTANT") || settings.is("normals_mode", "OBJECT");
    let factor = match absolute {
        true => "1".to_owned(),
        false => "\"1 / sqrt(outline.size_x * outline.size_y)\"".to_owned(),
    };
    let placed = format!("Transform(mesh: \"square\", scale: (1, 1, {factor}))");
    settings.node("placed", &placed);
}
