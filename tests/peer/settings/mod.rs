//! The add-on's settings as a graph.

mod component;
mod domains;
mod keys;
mod placing;
#[cfg(test)]
mod tests;

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
    /// Nodes made so far, as text.
    nodes: Vec<String>,
    /// Whether the folder has the weights of a vertex group.
    has_weights: bool,
}

impl Settings {
    fn node(&mut self, name: &str, node: &str) {
        self.nodes.push(format!("\"{name}\": {node}"));
    }

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

    /// Whether `key` has this value.
    fn is(&self, key: &str, value: &str) -> bool {
        self.left.get(key).and_then(Value::as_str) == Some(value)
    }

    /// A vertex group's weight as a formula over the attribute `w`: turned round
    /// by `invert_GROUP`, and w (1 - f) + f by `GROUP_factor`. `None` unless the
    /// case names the group and brings its weights.
    fn group(&mut self, group: &str) -> Option<String> {
        if !self.has_weights || !self.left.contains_key(group) {
            return None;
        }
        self.left.remove(group);
        let weight = match self.flag(&format!("invert_{group}")) {
            true => "(1 - w)",
            false => "w",
        };
        let least = self.number(&format!("{group}_factor"), 0.0);
        Some(format!("{weight} * (1 - {least:?}) + {least:?}"))
    }
}

/// The graph that asks for what the settings ask the add-on for.
pub(super) fn graph(settings: &str, has_weights: bool) -> Request {
    let document: Value = serde_json::from_str(settings).expect("settings are JSON");
    let left = document["settings"].as_object().cloned();
    let mut settings = Settings {
        left: left.unwrap_or_default(),
        nodes: Vec::new(),
        has_weights,
    };
    keys::drop_idle(&mut settings.left);
    let uv_layer = document["component_uv_layer"].as_str() == Some("Eval_Normals");
    let modifiers = &document["base_modifiers"];
    if !modifiers.is_null() {
        let modifiers = modifiers.clone();
        settings.left.insert("base_modifiers".to_owned(), modifiers);
    }
    let clipped = ["bounds_x", "bounds_y"].map(|key| settings.left.contains_key(key));
    domains::base(&mut settings);
    let (component, turned) = component::component(&mut settings, uv_layer);
    let domains = domains::domains(&mut settings, turned);
    domains.of("read", "base", &mut settings);
    if settings.is("normals_mode", "OBJECT") {
        settings.node("read_target", "ReadMesh(path: \"target.obj\")");
        domains.of("read_target", "target", &mut settings);
    }
    placing::directions(&mut settings);
    placing::array(&mut settings, &component);
    if !settings.left.is_empty() {
        return Request::Refused(settings.left.keys().cloned().collect());
    }
    let nodes = settings.nodes.join(",\n    ");
    let text = format!(
        "Graph(version: 1, nodes: {{\n    {nodes},\n}}, outputs: {{\"out.obj\": \"result\"}})"
    );
    Request::Graph {
        text,
        clipped: clipped.contains(&true),
    }
}
