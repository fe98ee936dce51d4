//! Why a node was computed: which part of its key changed since the last run.

use tessgraph_geometry::digest::{Digest, Hasher};

use super::cache::{Cache, FileKind};
use super::key::Part;
use super::outcome::Evaluation;
use crate::node::InputSpec;
use crate::plan::{Origin, Plan, PlanInput, PlanNode};
use crate::reference::value_text;
use crate::value::encode::{Decoder, Encoder};
use crate::value::{Kind, Value};

/// What one input contributed to a node's key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct KeyPart {
    pub(super) input: String,
    /// As a person would say it: `0.12`, `cage.obj`, `surface`.
    pub(super) text: String,
    /// Says whether it is the same.
    pub(super) digest: Digest,
}

/// One difference between a node's key now and in the last run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyChange {
    /// The node.
    pub node: String,
    /// The input whose contribution changed, or `kind` for the node itself.
    pub input: String,
    /// What it was in the last run.
    pub old: String,
    /// What it is now.
    pub new: String,
    /// The nodes whose results the input takes: the change came from there. If
    /// there are none this is the place where the graph or a file was edited.
    pub from: Vec<String>,
    /// Whether the last run had no node of that name.
    pub is_first: bool,
}

/// The key parts of all nodes of a run, by node name.
#[derive(Debug, Default, PartialEq)]
struct KeyRecord {
    nodes: Vec<NodeRecord>,
}

#[derive(Debug, PartialEq)]
struct NodeRecord {
    name: String,
    /// Its kind and version.
    kind: String,
    units: String,
    key: Option<Digest>,
    parts: Vec<KeyPart>,
}

impl KeyPart {
    pub(super) fn new(input: &str, text: String, part: Option<&Part>) -> Self {
        let mut hasher = Hasher::new();
        match part {
            None => hasher.number(0),
            Some(Part::Absent) => hasher.number(1),
            Some(Part::Value(digest)) => hasher.number(2).digest(*digest),
            Some(Part::File(content, format)) => hasher.number(3).digest(*content).text(format),
        };
        Self {
            input: input.to_owned(),
            text,
            digest: hasher.finish(),
        }
    }
}

/// What an input is given, as a person would say it. `value` is missing for
/// whole results of other nodes, which are named.
pub(super) fn part_text(
    plan: &Plan,
    node: &PlanNode,
    spec: &InputSpec,
    input: &PlanInput,
    value: Option<&Value>,
) -> String {
    match (&input.origin, value) {
        (Origin::Absent, _) => "left out".to_owned(),
        (_, Some(Value::Text(path))) if spec.kind == Kind::Path => path.to_string(),
        (_, Some(Value::Formula(_))) => {
            let written = input
                .span
                .clone()
                .and_then(|span| node.source.text().get(span));
            written.unwrap_or("the default").to_owned()
        }
        (_, Some(value)) => value_text(value, spec.quantity, node.units),
        (origin, None) => {
            let names: Vec<&str> = sources(plan, origin);
            names.join(", ")
        }
    }
}

/// The nodes whose results an origin takes.
fn sources<'a>(plan: &'a Plan, origin: &Origin) -> Vec<&'a str> {
    let results = origin.results().into_iter();
    results
        .map(|result| plan.nodes[result.node].name.as_str())
        .collect()
}

/// Compares the keys of a run with those of the last run of the same graph,
/// and keeps them for the next time.
pub(super) fn explain(
    cache: &Cache,
    identity: &str,
    plan: &Plan,
    evaluation: &Evaluation,
) -> Vec<KeyChange> {
    let graph = address(identity);
    let before = cache
        .record(FileKind::LastRun, graph, KeyRecord::decode)
        .unwrap_or_default();
    let now = KeyRecord::of(plan, evaluation);
    let changes = now.changes(&before, plan);
    if now != before {
        cache.set_record(FileKind::LastRun, graph, &now.encode());
    }
    changes
}

fn address(identity: &str) -> Digest {
    Hasher::new().text("last run").text(identity).finish()
}

/// What a node's results took when they were last computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeCost {
    /// Milliseconds of its evaluation.
    pub ms: f64,
    /// Bytes of its results in memory.
    pub bytes: u64,
}

/// What the nodes of a plan took, by the keys they had in the graph's last run.
pub(super) fn last_costs(cache: &Cache, identity: &str, plan: &Plan) -> Vec<Option<NodeCost>> {
    let record = cache.record(FileKind::LastRun, address(identity), KeyRecord::decode);
    let record = record.unwrap_or_default();
    let cost = |planned: &PlanNode| {
        let mut nodes = record.nodes.iter();
        let node = nodes.find(|node| node.name == planned.name)?;
        let entry = cache.entry(node.key?)?;
        let kind = kind_text(planned);
        (node.kind == kind).then_some(NodeCost {
            ms: entry.ms,
            bytes: entry.bytes,
        })
    };
    plan.nodes.iter().map(cost).collect()
}

fn kind_text(planned: &PlanNode) -> String {
    format!("{} version {}", planned.spec.name, planned.spec.version)
}

impl KeyRecord {
    /// The nodes that came as far as having a key.
    fn of(plan: &Plan, evaluation: &Evaluation) -> Self {
        let nodes = plan.nodes.iter().zip(&evaluation.keys);
        let nodes = nodes.filter_map(|(planned, keyed)| {
            let (key, parts) = keyed.as_ref()?;
            Some(NodeRecord {
                name: planned.name.clone(),
                kind: kind_text(planned),
                units: planned.units.sign().to_owned(),
                key: *key,
                parts: parts.clone(),
            })
        });
        Self {
            nodes: nodes.collect(),
        }
    }

    fn changes(&self, before: &Self, plan: &Plan) -> Vec<KeyChange> {
        let mut changes = Vec::new();
        for node in &self.nodes {
            let same_key = |other: &&NodeRecord| other.key.is_some() && other.key == node.key;
            if before.nodes.iter().any(|other| same_key(&other)) {
                continue;
            }
            let planned = plan.nodes.iter().find(|planned| planned.name == node.name);
            let from = |input: &str| {
                let index = planned?
                    .spec
                    .inputs
                    .iter()
                    .position(|spec| spec.name == input)?;
                let origin = &planned?.inputs[index].origin;
                Some(
                    sources(plan, origin)
                        .into_iter()
                        .map(str::to_owned)
                        .collect(),
                )
            };
            match before.nodes.iter().find(|other| other.name == node.name) {
                Some(old) => node.compare(old, &from, &mut changes),
                None => changes.push(KeyChange {
                    node: node.name.clone(),
                    input: "kind".to_owned(),
                    old: "not in the last run".to_owned(),
                    new: node.kind.clone(),
                    from: Vec::new(),
                    is_first: true,
                }),
            }
        }
        changes
    }

    fn encode(&self) -> Vec<u8> {
        let mut out = Encoder::new();
        out.number(self.nodes.len() as u64);
        for node in &self.nodes {
            out.text(&node.name).text(&node.kind).text(&node.units);
            // A node without a key is recorded with one that nothing has.
            out.digest(node.key.unwrap_or(Digest::from_bytes([0; 16])));
            out.number(node.parts.len() as u64);
            for part in &node.parts {
                out.text(&part.input).text(&part.text).digest(part.digest);
            }
        }
        out.finish().0
    }

    fn decode(bytes: &[u8]) -> Option<Self> {
        let mut from = Decoder::new(bytes, &|_| None);
        let count = from.count()?;
        let nodes: Option<_> = (0..count).map(|_| NodeRecord::decode(&mut from)).collect();
        let nodes = nodes?;
        from.finish(Self { nodes })
    }
}

impl NodeRecord {
    fn compare(
        &self,
        old: &Self,
        from: &dyn Fn(&str) -> Option<Vec<String>>,
        changes: &mut Vec<KeyChange>,
    ) {
        let mut note = |input: &str, old: String, new: String| {
            changes.push(KeyChange {
                node: self.name.clone(),
                input: input.to_owned(),
                old,
                new,
                from: from(input).unwrap_or_default(),
                is_first: false,
            });
        };
        if self.kind != old.kind {
            note("kind", old.kind.clone(), self.kind.clone());
        }
        if self.units != old.units {
            note("units", old.units.clone(), self.units.clone());
        }
        for part in &self.parts {
            match old.parts.iter().find(|other| other.input == part.input) {
                Some(other) if other.digest == part.digest => {}
                Some(other) => {
                    let (old, new) = told_apart(other, part);
                    note(&part.input, old, new);
                }
                None => note(&part.input, "no such input".to_owned(), part.text.clone()),
            }
        }
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        let name = from.text()?.to_owned();
        let (kind, units) = (from.text()?.to_owned(), from.text()?.to_owned());
        let key = from.digest()?;
        let count = from.count()?;
        let part = |from: &mut Decoder<'_>| {
            Some(KeyPart {
                input: from.text()?.to_owned(),
                text: from.text()?.to_owned(),
                digest: from.digest()?,
            })
        };
        let parts: Option<_> = (0..count).map(|_| part(from)).collect();
        Some(Self {
            name,
            kind,
            units,
            key: (key != Digest::from_bytes([0; 16])).then_some(key),
            parts: parts?,
        })
    }
}

/// Both texts; with the beginning of their digests where they read the same.
fn told_apart(old: &KeyPart, new: &KeyPart) -> (String, String) {
    if old.text != new.text {
        return (old.text.clone(), new.text.clone());
    }
    let with_digest = |part: &KeyPart| {
        let digest = part.digest.to_string();
        format!("{} ({})", part.text, &digest[..8])
    };
    (with_digest(old), with_digest(new))
}
