//! The add-on's settings as a graph.

mod closing;
mod component;
mod directions;
mod domains;
mod keys;
mod passes;
mod placing;
#[cfg(test)]
mod tests;
mod turns;

use std::collections::BTreeSet;

use serde_json::{Map, Value};

/// The graph of one pass after the first, beside the files of a case.
pub(super) const LATER_PASS: &str = "later_pass.ron";

/// What a case asks for.
pub(super) enum Request {
    /// A graph whose node `result` is the array.
    Graph {
        /// Its text.
        text: String,
        /// The graph [`LATER_PASS`] that it includes, where it asks for several passes.
        later: Option<String>,
        /// Whether the component was cut at the square's sides.
        clipped: bool,
    },
    /// Keys that have no counterpart.
    Refused(Vec<String>),
}

/// What a case's folder holds beside base, component and target.
#[derive(Clone, Default)]
pub(super) struct Holds {
    /// `weights.csv`: a vertex group of the base, one weight per vertex.
    pub(super) weights: bool,
    /// A `target.obj` with as many vertices and faces as the base.
    pub(super) target: bool,
    /// `selection.csv`: 1 for each selected face of the base, 0 for the others.
    pub(super) selection: bool,
    /// Names of the base's materials, in the order of their first faces.
    pub(super) base_materials: Vec<String>,
    /// Those of the component.
    pub(super) component_materials: Vec<String>,
}

/// Settings still to be understood; what is left over is refused.
struct Settings {
    left: Map<String, Value>,
    /// Nodes made so far, as text.
    nodes: Vec<String>,
    holds: Holds,
    /// Whether this is a pass over what the pass before made.
    is_later: bool,
    /// Whether the component is cut at the sides of the square.
    cuts: bool,
    /// Whether groups of the base are brought onto the result.
    maps_groups: bool,
}

impl Settings {
    fn new(document: &Value, holds: &Holds, is_later: bool) -> Self {
        let mut left = document["settings"]
            .as_object()
            .cloned()
            .unwrap_or_default();
        let maps_groups = left.get("bool_vertex_group") == Some(&Value::Bool(true));
        keys::drop_idle(&mut left);
        let modifiers = &document["base_modifiers"];
        if !modifiers.is_null() {
            left.insert("base_modifiers".to_owned(), modifiers.clone());
        }
        Self {
            left,
            nodes: Vec::new(),
            holds: holds.clone(),
            is_later,
            cuts: false,
            maps_groups,
        }
    }

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

    /// Whether the case names this vertex group of the base and brings its weights:
    /// a folder holds one group, and a later pass has it only if it was mapped.
    fn has_group(&self, group: &str) -> bool {
        let names = self.left.iter().filter_map(|(key, name)| {
            let is_name = key.starts_with("vertex_group_") && !key.ends_with("_owner");
            is_name.then(|| name.as_str()).flatten()
        });
        let names: BTreeSet<&str> = names.collect();
        let is_there = !self.is_later || self.maps_groups;
        self.holds.weights && is_there && names.len() == 1 && self.left.contains_key(group)
    }

    /// A vertex group's weight as a formula over the attribute `w`: turned round
    /// by `invert_GROUP`, and w (1 - f) + f by `GROUP_factor`. `None` unless the
    /// case names the group and brings its weights.
    fn group(&mut self, group: &str) -> Option<String> {
        if !self.has_group(group) {
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
pub(super) fn graph(settings: &str, holds: &Holds) -> Request {
    let document: Value = serde_json::from_str(settings).expect("settings are JSON");
    passes::graph(&document, holds)
}

/// Why a key is refused.
pub(super) fn reason(key: &str) -> Option<&'static str> {
    let mut table = keys::WITHOUT_COUNTERPART.iter();
    table
        .find(|(name, _)| *name == key)
        .map(|(_, reason)| *reason)
}
