//! The component at the add-on's height, with its places of direction.

use super::Settings;

/// The component, as the array takes it.
pub(super) struct Component {
    /// How it stands in the unit square: `Bounds` or `Unit`.
    pub(super) fit: &'static str,
    /// Whether it turns in place of the domains.
    pub(super) turned: Turned,
}

/// How a component turns in place of its domains, because these cannot: the add-on
/// turns a triangle as a quad with a side of no length, and a patch as a whole.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Turned {
    /// Domains turn.
    Not,
    /// So many quarters everywhere.
    With(f64),
    /// By 0 to 3 quarters, as node `quarters` says.
    ByFace,
}

impl Turned {
    /// What the settings ask for.
    fn of(settings: &mut Settings) -> Self {
        let triangles = settings.is("fill_mode", "FAN") || settings.is("fill_mode", "TRI");
        let by_weight =
            settings.is("rotation_mode", "WEIGHT") && settings.has_group("vertex_group_rotation");
        if triangles && (by_weight || settings.is("rotation_mode", "UV")) {
            return Self::ByFace;
        }
        let stays = !triangles && !settings.is("fill_mode", "PATCH");
        if stays || !settings.left.contains_key("rotation_shift") {
            return Self::Not;
        }
        Self::With(settings.number("rotation_shift", 0.0))
    }
}

/// Nodes `component`, or `component_0` to `component_3` where it turns by face.
pub(super) fn component(settings: &mut Settings, uv_layer: bool) -> Component {
    settings.node("drawn", "ReadMesh(path: \"component.obj\")");
    let local = settings.is("mode", "LOCAL") || settings.is("mode", "GLOBAL");
    let turned = Turned::of(settings);
    let high = heights(settings, local);
    let fit = if turned != Turned::Not || local {
        "Unit"
    } else {
        "Bounds"
    };
    let beyond = ["bounds_x", "bounds_y"].map(|key| beyond(settings, key, local));
    if turned != Turned::Not && !local {
        in_the_square(settings, high);
    } else if beyond == ["Extend", "Extend"] {
        settings.node("placed", &format!("Transform(mesh: \"{high}\")"));
    } else {
        settings.cuts = true;
        let [x, y] = beyond;
        let fitted = format!("FitComponent(component: \"{high}\", fit: Unit, x: {x}, y: {y})");
        settings.node("placed", &fitted);
    }
    let mut made = |name: &str, turns: f64| {
        let turn = format!(
            "Transform(mesh: \"placed\", rotate: (0, 0, {:?}), pivot: (0.5, 0.5, 0))",
            -90.0 * turns
        );
        let turn = match turns.abs() > 0.0 {
            true => &turn,
            false => "Transform(mesh: \"placed\")",
        };
        if uv_layer {
            settings.node(&format!("{name}_turned"), turn);
            let places = format!(
                "EvaluateNormalsUV(component: \"{name}_turned\", source: UvLayer, axes: U, fit: {fit})"
            );
            settings.node(name, &places);
        } else {
            settings.node(name, turn);
        }
    };
    match turned {
        Turned::Not => made("component", 0.0),
        Turned::With(turns) => made("component", turns),
        Turned::ByFace => (0..4).for_each(|turns| {
            made(&format!("component_{turns}"), f64::from(turns));
        }),
    }
    Component { fit, turned }
}

impl Component {
    /// The inputs of the array that name the component.
    pub(super) fn inputs(&self) -> String {
        match self.turned {
            Turned::ByFace => {
                let names = [0, 1, 2, 3].map(|turns| format!("\"component_{turns}\""));
                let names = names.join(", ");
                format!("components: [{names}], choose: Index, index: \"quarters\"")
            }
            _ => "component: \"component\"".to_owned(),
        }
    }

    /// The input that turns components at the border so that it is on one side.
    pub(super) fn border(&self) -> &'static str {
        match self.turned {
            Turned::ByFace => ", border_component: \"component_0\"",
            _ => ", border_component: \"component\"",
        }
    }
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
