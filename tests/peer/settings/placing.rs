//! Directions, and the array along them.

use super::Settings;
use super::component::Component;

/// The directions, as node `directions`.
pub(super) fn directions(settings: &mut Settings) {
    let constant = settings.is("scale_mode", "CONSTANT");
    let known = ["VERTS", "OBJECT", "CUSTOM"];
    match settings.one_of("normals_mode", "VERTS", &known).as_str() {
        "OBJECT" => {
            let length = if constant { "Unit" } else { "Target" };
            let towards =
                format!("TargetDirections(mesh: \"base\", target: \"target\", length: {length})");
            settings.node("directions", &towards);
            if settings.left.contains_key("even_thickness") {
                // The add-on smooths another field then, which it does not use.
                settings.flag("smooth_normals");
                settings.left.remove("smooth_normals_iter");
            }
        }
        // The mean of the corners' normals, not normalised; with flat shading a
        // corner has the normal of its face. Smoothing it makes the add-on fail.
        "CUSTOM" => {
            settings.flag("smooth_normals");
            settings.left.remove("smooth_normals_iter");
            settings.node("directions", "FaceNormals(mesh: \"base\", unit: false)");
        }
        _ => along_normals(settings, constant),
    }
    if !settings.left.contains_key("smooth_normals") {
        settings.left.remove("smooth_normals_iter");
    }
}

/// Vertex normals, smoothed, and scaled along the axes.
fn along_normals(settings: &mut Settings, constant: bool) {
    let factors = ["normals_x", "normals_y", "normals_z"].map(|key| settings.number(key, 1.0));
    let smooth = settings.flag("smooth_normals");
    let passes = settings.number("smooth_normals_iter", 5.0);
    let node = if smooth {
        let weights = settings.group("vertex_group_smooth_normals").map(|weight| {
            let field = format!("EvaluateField(mesh: \"base\", value: \"{weight}\")");
            settings.node("part", &field);
            ", weights: \"part\""
        });
        let anisotropy = settings.number("smooth_normals_uv", 0.0);
        // With constant thickness a direction that ends up against the normal is
        // turned round; with relative thickness it is left.
        format!(
            "SmoothNormals(mesh: \"base\", scheme: EdgeSum, iterations: {passes}, \
             flip_inverted: {constant}, anisotropy: {anisotropy:?}{})",
            weights.unwrap_or_default()
        )
    } else {
        // Without smoothing nothing reads its group.
        settings.left.remove("vertex_group_smooth_normals");
        settings.left.remove("invert_vertex_group_smooth_normals");
        settings.left.remove("smooth_normals_uv");
        "VertexNormals(mesh: \"base\")".to_owned()
    };
    let [x, y, z] = factors;
    if factors.iter().all(|factor| (factor - 1.0).abs() <= 0.0) {
        settings.node("directions", &node);
    } else {
        settings.node("unscaled", &node);
        let scaled = format!(
            "ScaleDirections(mesh: \"base\", directions: \"unscaled\", factors: ({x:?}, {y:?}, {z:?}))"
        );
        settings.node("directions", &scaled);
    }
}

/// The array, as node `result`, closed where that is asked for.
pub(super) fn array(settings: &mut Settings, component: &Component) {
    // Files hold places in the world: both read x and y as they are.
    settings.one_of("mode", "BOUNDS", &["BOUNDS", "LOCAL", "GLOBAL"]);
    let fit = component.fit;
    let known = ["ADAPTIVE", "CONSTANT"];
    let height = match settings.one_of("scale_mode", "ADAPTIVE", &known).as_str() {
        "CONSTANT" => "Absolute",
        _ => "Relative",
    };
    let merge = settings.flag("merge");
    let join = if merge { "Weld" } else { "None" };
    let patch =
        if settings.is("fill_mode", "PATCH") && settings.left.get("base_modifiers").is_none() {
            settings.left.remove("fill_mode");
            ", domain: Parent"
        } else {
            ""
        };
    // The add-on's iterations for one factor per vertex; here every vertex is solved.
    let even = if settings.flag("even_thickness") {
        ", compensate: PerVertex"
    } else {
        ""
    };
    settings.left.remove("even_thickness_iter");
    let scale = match settings.group("vertex_group_thickness") {
        Some(weight) => {
            let field = format!("EvaluateField(mesh: \"base\", value: \"{weight}\")");
            settings.node("factor", &field);
            ", scale: \"factor\""
        }
        None => "",
    };
    let array = format!(
        "ArrayComponents(base: \"base\", component: \"component\", directions: \"directions\", \
         fit: {fit}, height: {height}, interpolation: Linear, join: {join}{scale}{patch}{even})"
    );
    // Only what is merged can be closed.
    let known = ["NONE", "CAP", "BRIDGE", "BRIDGE_CAP"];
    let closing = settings.one_of("close_mesh", "NONE", &known);
    let closed = match closing.as_str() {
        "CAP" if merge => "CapHoles(mesh: \"open\")",
        "BRIDGE" if merge => "BridgeLoops(mesh: \"open\")",
        "BRIDGE_CAP" if merge => {
            settings.node("bridged", "BridgeLoops(mesh: \"open\")");
            "CapHoles(mesh: \"bridged\")"
        }
        _ => return settings.node("result", &array),
    };
    settings.node("open", &array);
    settings.node("result", closed);
}
