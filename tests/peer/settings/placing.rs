//! The array along its directions.

use super::Settings;
use super::component::Component;
use super::directions::Cells;

/// The array, as node `apart`, and with its neighbours joined as node `arrayed`.
pub(super) fn array(settings: &mut Settings, component: &Component, cells: Cells) {
    let base = cells.base();
    // Files hold places in the world: both read x and y as they are.
    settings.one_of("mode", "BOUNDS", &["BOUNDS", "LOCAL", "GLOBAL"]);
    let known = ["ADAPTIVE", "CONSTANT"];
    let relative = settings.one_of("scale_mode", "ADAPTIVE", &known) != "CONSTANT";
    let height = match cells {
        Cells::Joined if relative => "Relative",
        _ => "Absolute",
    };
    let join = Join::of(settings, cells);
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
    if let Some(factor) = factor(settings, component, relative && cells == Cells::Flat) {
        let field = format!("EvaluateField(mesh: \"{base}\", value: \"{factor}\")");
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
        "ArrayComponents(base: \"{base}\", {}, directions: \"directions\", fit: {}, \
         height: {height}, interpolation: Linear, join: {}{more})",
        component.inputs(),
        component.fit,
        if join == Join::ByTopology {
            "Weld"
        } else {
            "None"
        }
    );
    settings.node("apart", &array);
    let joined = match join {
        Join::ByDistance(distance, border_only) => format!(
            "WeldVertices(mesh: \"apart\", distance: {distance:?}, border_only: {border_only})"
        ),
        _ => "Transform(mesh: \"apart\")".to_owned(),
    };
    settings.node("arrayed", &joined);
}

/// How neighbours are joined. The add-on goes by distance alone; at its default
/// distance that comes to the joints of shared edges.
#[derive(Clone, Copy, PartialEq)]
enum Join {
    Not,
    ByTopology,
    /// The distance, and whether only at open borders.
    ByDistance(f64, bool),
}

impl Join {
    fn of(settings: &mut Settings, cells: Cells) -> Self {
        // Its group still asks for `merge` later on, to be closed.
        if settings.left.get("merge") != Some(&true.into()) {
            return Self::Not;
        }
        let distance = settings.number("merge_thres", DISTANCE);
        let border_only = settings.flag("merge_open_edges_only");
        let usual = (distance / DISTANCE - 1.0).abs() < 1e-6 && !border_only;
        if usual && cells == Cells::Joined {
            Self::ByTopology
        } else {
            Self::ByDistance(distance, border_only)
        }
    }
}

/// The add-on's default of `merge_thres`.
const DISTANCE: f64 = 1e-4;

/// The factor on heights as a formula: a group's weight, and for flat cells the size
/// of the faces round a vertex against the component's.
fn factor(settings: &mut Settings, component: &Component, by_size: bool) -> Option<String> {
    let weight = settings.group("vertex_group_thickness");
    if !by_size {
        return weight;
    }
    let area = if component.fit == "Bounds" {
        settings.node("extent", "MeasureMesh(mesh: \"component\")");
        "extent.size_x * extent.size_y"
    } else {
        "1"
    };
    let weight = weight.unwrap_or("1".to_owned());
    Some(format!("sqrt(size / ({area})) * ({weight})"))
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
