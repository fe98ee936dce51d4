//! From a node's origins to its key, and from there to its arguments.

use tessgraph_geometry::digest::{Digest, Hasher};

use super::Run;
use super::state::Unready;
use crate::NodeError;
use crate::eval::explain::{self, KeyPart};
use crate::eval::inputs;
use crate::eval::key::{self, Part};
use crate::node::InputSpec;
use crate::plan::{Origin, ResultRef};
use crate::value::{Kind, Value, list_digest};

/// What a node's inputs amount to, before their values are loaded.
pub(super) struct Prepared {
    /// The files its path inputs name.
    pub(super) paths: Vec<String>,
    /// `None` when a file cannot be read.
    pub(super) key: Option<Digest>,
    pub(super) provenance: Digest,
    pub(super) parts: Vec<KeyPart>,
}

impl Run<'_> {
    /// The node's key and provenance. Only numbers in expressions are looked
    /// at; of everything else the digest suffices.
    pub(super) fn prepare(&self, node: usize) -> Result<Prepared, Unready> {
        let planned = &self.plan.nodes[node];
        let (mut paths, mut parts, mut shown) = (Vec::new(), Vec::new(), Vec::new());
        let mut known = true;
        let mut provenance = Hasher::new();
        provenance
            .text(planned.spec.name)
            .number(planned.spec.version.into())
            .float(planned.units.metres());
        for (spec, input) in planned.spec.inputs.iter().zip(&planned.inputs) {
            let (part, value) = self.part(spec, &input.origin)?;
            if let (Kind::Path, Some(Value::Text(path))) = (spec.kind, &value) {
                paths.push(path.to_string());
            }
            self.feed_provenance(&mut provenance, spec.name, &input.origin, part.as_ref());
            let text = explain::part_text(self.plan, planned, spec, input, value.as_ref());
            shown.push(KeyPart::new(spec.name, text, part.as_ref()));
            known &= part.is_some();
            parts.extend(part);
        }
        let key = known.then(|| key::node_key(planned.spec, planned.units, &parts));
        Ok(Prepared {
            paths,
            key,
            provenance: provenance.finish(),
            parts: shown,
        })
    }

    /// What enters the key for one input, and its value if it was needed for
    /// that; no part if its file cannot be read.
    fn part(
        &self,
        spec: &InputSpec,
        origin: &Origin,
    ) -> Result<(Option<Part>, Option<Value>), Unready> {
        if let Some(identity) = self.identity_alone(origin) {
            return Ok((Some(Part::Value(identity)), None));
        }
        let value = self.input_value(spec, origin)?;
        let part = match &value {
            None => Some(Part::Absent),
            Some(value) => key::value_part(spec, value, |path| self.files.digest(path)),
        };
        Ok((part, value))
    }

    /// What tells a value that is made of whole results from others, without it.
    fn identity_alone(&self, origin: &Origin) -> Option<Digest> {
        match origin {
            Origin::Result(result) => Some(self.identity(*result)),
            Origin::List(items) => {
                let items: Option<Vec<Digest>> =
                    items.iter().map(|item| self.identity_alone(item)).collect();
                Some(list_digest(items?.into_iter()))
            }
            _ => None,
        }
    }

    /// The value of an input, with all results it needs loaded.
    fn input_value(&self, spec: &InputSpec, origin: &Origin) -> Result<Option<Value>, Unready> {
        self.load(&origin.results())?;
        let value = inputs::value_of(origin, &|result| self.value(result));
        Ok(value.map_err(|message| NodeError::new(message).at_input(spec.name))?)
    }

    /// The values that the node is evaluated with.
    pub(super) fn arguments(&self, node: usize) -> Result<Vec<Option<Value>>, Unready> {
        let planned = &self.plan.nodes[node];
        let results: Vec<ResultRef> = planned
            .inputs
            .iter()
            .flat_map(|input| input.origin.results())
            .collect();
        // All at once, so that everything that was lost is computed side by side.
        self.load(&results)?;
        let pairs = planned.spec.inputs.iter().zip(&planned.inputs);
        pairs
            .map(|(spec, input)| {
                let value = self.input_value(spec, &input.origin)?;
                let fitted =
                    value.map(|value| inputs::fitted(spec, &input.origin, value, planned.units));
                Ok(fitted.transpose()?)
            })
            .collect()
    }

    fn feed_provenance(
        &self,
        hasher: &mut Hasher,
        name: &str,
        origin: &Origin,
        part: Option<&Part>,
    ) {
        hasher.text(name);
        match part {
            None | Some(Part::Absent) => hasher.number(0),
            Some(Part::File(content, format)) => hasher.number(2).digest(*content).text(format),
            Some(Part::Value(digest)) => match origin.results().as_slice() {
                [] => hasher.number(1).digest(*digest),
                results => {
                    hasher.number(3).number(results.len() as u64);
                    for result in results {
                        hasher.digest(self.provenance(*result));
                    }
                    hasher
                }
            },
        };
    }

    pub(super) fn identity(&self, result: ResultRef) -> Digest {
        self.done(result.node).results[result.result].identity
    }

    pub(super) fn provenance(&self, result: ResultRef) -> Digest {
        of_result(self.done(result.node).provenance, result.result)
    }
}

/// The provenance of one result of a node.
pub(super) fn of_result(node: Digest, result: usize) -> Digest {
    Hasher::new().digest(node).number(result as u64).finish()
}
