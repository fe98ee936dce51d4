//! Seams dissolved, and what stays open closed.

use super::Settings;

/// Node `pass`: the array `arrayed`, closed where that is asked for.
pub(super) fn close(settings: &mut Settings) {
    let merge = settings.flag("merge");
    // Only what is merged can be closed.
    let known = ["NONE", "CAP", "BRIDGE", "BRIDGE_CAP"];
    let closing = settings.one_of("close_mesh", "NONE", &known);
    let mut mesh = "arrayed";
    // Where the component was cut; its own seams are in the scene only.
    if settings.cuts && settings.flag("bool_dissolve_seams") {
        settings.node("whole", "DissolveEdges(mesh: \"arrayed\")");
        mesh = "whole";
    }
    if merge && closing.starts_with("BRIDGE") {
        let only = chosen(settings, mesh, "bridge");
        let bridged = format!("BridgeLoops(mesh: \"{mesh}\"{only})");
        settings.node("bridged", &bridged);
        mesh = "bridged";
    }
    if merge && closing.ends_with("CAP") {
        let only = chosen(settings, mesh, "cap");
        settings.node("capped", &format!("CapHoles(mesh: \"{mesh}\"{only})"));
        mesh = "capped";
    }
    for way in ["bridge", "cap"] {
        if !(merge && closing.to_lowercase().contains(way)) {
            // Nothing reads its group.
            settings.left.remove(&format!("vertex_group_{way}"));
            settings.left.remove(&format!("invert_vertex_group_{way}"));
        }
    }
    settings.node("pass", &format!("Transform(mesh: \"{mesh}\")"));
}

/// The input `only`: loops whose vertices all have weight 1 in the group, which
/// the base's groups are if they are mapped; those of components are not in a
/// case's folder.
fn chosen(settings: &mut Settings, mesh: &str, way: &str) -> String {
    let group = format!("vertex_group_{way}");
    if !settings.maps_groups {
        return String::new();
    }
    let Some(weight) = settings.group(&group) else {
        return String::new();
    };
    let field = format!("EvaluateField(mesh: \"{mesh}\", value: \"if({weight} > 0.999, 1, 0)\")");
    settings.node(&format!("{way}_loops"), &field);
    format!(", only: \"{way}_loops\"")
}
