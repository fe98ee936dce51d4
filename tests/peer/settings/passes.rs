//! One pass, or several: what a pass made becomes the base of the next.

use serde_json::{Value, json};

use super::{Holds, LATER_PASS, Request, Settings};
use super::{closing, component, directions, domains, placing};

/// The graph of a case, and that of its later passes if it has any.
pub(super) fn graph(document: &Value, holds: &Holds) -> Request {
    let mut first = Settings::new(document, holds, false);
    let clipped = ["bounds_x", "bounds_y"].map(|key| first.left.contains_key(key));
    let passes = first.number("iterations", 1.0) as u64;
    let combined = match passes {
        1 => "LAST".to_owned(),
        // What of a pass counts as unused is in the scene only.
        _ => first.one_of("combine_mode", "LAST", &["LAST", "ALL"]),
    };
    let levels = first.number("patch_subs", 0.0) as u64;
    one_pass(&mut first, document);
    let mut left: Vec<String> = first.left.keys().cloned().collect();
    let mut later = None;
    if passes > 1 {
        let mut again = Settings::new(&later_document(document, levels), holds, true);
        for key in ["iterations", "combine_mode", "patch_subs"] {
            again.left.remove(key);
        }
        one_pass(&mut again, document);
        let keys = again
            .left
            .keys()
            .filter(|key| !first.left.contains_key(*key));
        left.extend(keys.cloned());
        later = Some(format!(
            "Graph(version: 1, inputs: {{\"mesh\": Mesh()}}, nodes: {{\n    {},\n}}, \
             results: {{\"mesh\": \"result\"}})",
            again.nodes.join(",\n    ")
        ));
    }
    if !left.is_empty() {
        return Request::Refused(left);
    }
    together(&mut first, passes, combined == "ALL");
    let text = format!(
        "Graph(version: 1, nodes: {{\n    {},\n}}, outputs: {{\"out.obj\": \"result\"}})",
        first.nodes.join(",\n    ")
    );
    Request::Graph {
        text,
        later,
        clipped: clipped.contains(&true),
    }
}

/// Nodes from the base to `pass`, and `result` in a graph of its own.
fn one_pass(settings: &mut Settings, document: &Value) {
    let uv_layer = document["component_uv_layer"].as_str() == Some("Eval_Normals");
    domains::base(settings);
    let component = component::component(settings, uv_layer);
    let domains = domains::domains(settings, &component);
    domains.of("read", "base", settings);
    domains.turn_components(settings);
    if settings.is("normals_mode", "OBJECT") && settings.holds.target {
        settings.node("read_target", "ReadMesh(path: \"target.obj\")");
        domains.of("read_target", "target", settings);
    }
    let cells = directions::directions(settings);
    placing::array(settings, &component, cells);
    closing::close(settings);
    if settings.is_later {
        settings.node("result", "Transform(mesh: \"pass\")");
    }
}

/// The settings from the second pass on: a target belongs to the first base, and
/// a subdivision of the first base gives way to one of its own.
fn later_document(document: &Value, levels: u64) -> Value {
    let mut document = document.clone();
    if let Some(settings) = document["settings"].as_object_mut()
        && settings.get("normals_mode") == Some(&json!("OBJECT"))
    {
        for key in ["normals_mode", "even_thickness", "even_thickness_iter"] {
            settings.remove(key);
        }
    }
    if document["settings"]["fill_mode"] == "PATCH" {
        document["base_modifiers"] = json!([["SUBSURF", levels]]);
    }
    document
}

/// Node `result`: the last pass, or all of them.
fn together(settings: &mut Settings, passes: u64, all: bool) {
    if passes == 1 {
        settings.node("result", "Transform(mesh: \"pass\")");
    } else if all {
        let mut names = vec!["\"pass\"".to_owned()];
        for pass in 2..=passes {
            let before = &names[names.len() - 1];
            let next = format!("Subgraph(path: \"{LATER_PASS}\", with: {{\"mesh\": {before}}})");
            settings.node(&format!("pass_{pass}"), &next);
            names.push(format!("\"pass_{pass}\""));
        }
        let joined = format!("JoinMeshes(meshes: [{}])", names.join(", "));
        settings.node("result", &joined);
    } else {
        let repeat = format!(
            "Repeat(path: \"{LATER_PASS}\", times: {}, carry: \"mesh\", with: {{\"mesh\": \"pass\"}})",
            passes - 1
        );
        settings.node("passes", &repeat);
        settings.node("result", "Transform(mesh: \"passes\")");
    }
}
