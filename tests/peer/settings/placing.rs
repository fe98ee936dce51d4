//! Directions, and the array along them.

use serde_json::Value;

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

/// The array, as node `arrayed`.
pub(super) fn array(settings: &mut Settings, component: &Component) {
    // Files hold places in the world: both read x and y as they are.
    settings.one_of("mode", "BOUNDS", &["BOUNDS", "LOCAL", "GLOBAL"]);
    let known = ["ADAPTIVE", "CONSTANT"];
    let height = match settings.one_of("scale_mode", "ADAPTIVE", &known).as_str() {
        "CONSTANT" => "Absolute",
        _ => "Relative",
    };
    let join = match settings.left.get("merge") {
        Some(Value::Bool(true)) => "Weld",
        _ => "None",
    };
    let mut more = String::new();
    if settings.is("fill_mode", "PATCH") && settings.left.get("base_modifiers").is_none() {
        settings.left.remove("fill_mode");
        more += ", domain: Parent";
    }
    // The add-on's iterations for one factor per vertex; here every vertex is solved.
    if settings.flag("even_thickness") {
        more += ", compensate: PerVertex";
    }
    settings.left.remove("even_thickness_iter");
    if let Some(weight) = settings.group("vertex_group_thickness") {
        let field = format!("EvaluateField(mesh: \"base\", value: \"{weight}\")");
        settings.node("factor", &field);
        more += ", scale: \"factor\"";
    }
    if settings.flag("auto_rotate_boundary") {
        more += component.border();
    }
    more += &only(settings);
    if settings.maps_groups && settings.holds.weights {
        more += ", carry: [\"w\"]";
    }
    let array = format!(
        "ArrayComponents(base: \"base\", {}, directions: \"directions\", fit: {}, \
         height: {height}, interpolation: Linear, join: {join}{more})",
        component.inputs(),
        component.fit
    );
    settings.node("arrayed", &array);
}

/// The input that leaves faces out: those not selected, those of other materials.
fn only(settings: &mut Settings) -> String {
    let mut chosen = Vec::new();
    if settings.holds.selection && !settings.is_later && settings.flag("bool_selection") {
        chosen.push("SelectFaces(mesh: \"base\", by: Field, field: \"of_selection\"".to_owned());
        let field = "EvaluateField(mesh: \"base\", on: Faces, value: \"selected\")";
        settings.node("of_selection", field);
    }
    if settings.flag("bool_material_id") {
        let wanted = settings.number("material_id", 0.0);
        let names = match settings.is_later {
            true => &settings.holds.component_materials,
            false => &settings.holds.base_materials,
        };
        chosen.push(match names.get(wanted as usize) {
            Some(name) => format!("SelectFaces(mesh: \"base\", by: Named, name: {name:?}"),
            // Faces without a material count as of the first.
            None => {
                let all = names.is_empty() && wanted <= 0.0;
                let field = format!(
                    "EvaluateField(mesh: \"base\", on: Faces, value: {})",
                    u8::from(all)
                );
                settings.node("of_material", &field);
                "SelectFaces(mesh: \"base\", by: Field, field: \"of_material\"".to_owned()
            }
        });
    }
    let mut with = String::new();
    for (k, node) in chosen.iter().enumerate() {
        settings.node(&format!("chosen_{k}"), &format!("{node}{with})"));
        with = format!(", with: \"chosen_{k}\"");
    }
    with.replace(", with:", ", only:")
}
