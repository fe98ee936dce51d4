//! How the picture follows a parameter: the graph is checked with other values of it.

use std::sync::Arc;

use tessgraph_graph::Plan;
use tessgraph_view::preview::{Following, preview};
use tessgraph_view::protocol::{Previewed, ToPage, Value};
use tessgraph_view::{PageId, Reply};

use super::viewer::{Viewer, setting};
use crate::graph_file::GraphFile;
use crate::watch::Wish;

/// Values that are looked at: enough to see that a line is none.
const SAMPLES: u32 = 5;

impl Viewer<'_> {
    /// Tells a page how its picture follows the parameter `name` from one value to another.
    /// Takes place on the threads that compute, for it looks at every vertex.
    pub(super) fn preview(
        &self,
        (page, request): (PageId, u64),
        name: &str,
        range: [f64; 2],
        reply: &Reply,
    ) -> Wish {
        let declared = self.declared.as_ref();
        let is_whole = declared
            .and_then(|declared| declared.parameter(name))
            .is_some_and(|declaration| declaration.kind() == "Integer");
        let subject = self.subject(page).cloned();
        let (Some((plan, evaluation)), Some(subject)) = (self.last.clone(), subject) else {
            return Wish::default();
        };
        let (graph, allow) = (self.args.graph.clone(), self.args.engine.allow.clone());
        let (registry, settings, name) = (self.studio.registry, self.settings(), name.to_owned());
        let (gallery, reply) = (Arc::clone(&self.gallery), reply.clone());
        let version = gallery.version(page);
        self.studio.spawn(move || {
            let at = |value: f64| -> Option<Plan> {
                let mut set = settings.clone();
                set.push((name.clone(), setting(&Value::Number(value))));
                let file = GraphFile::open(&graph, registry, &set, &allow).ok()?;
                // Another text is about to be run.
                (file.plan.source.text() == plan.source.text()).then_some(file.plan)
            };
            let samples: Vec<_> = values(range, is_whole)
                .into_iter()
                .filter_map(|value| Some((value, at(value)?)))
                .collect();
            let following = Following {
                plan: &plan,
                evaluation: &evaluation,
                subject: &subject,
                samples: &samples,
            };
            let previewed = preview(gallery.buffers(), &following);
            reply.send(&ToPage::Previewed(Box::new(Previewed {
                request,
                version,
                ..previewed
            })));
        });
        Wish::default()
    }
}

/// Values from one end of a range to the other, ascending, each once.
fn values([from, to]: [f64; 2], is_whole: bool) -> Vec<f64> {
    let steps = f64::from(SAMPLES - 1);
    let value = |k: u32| from + (to - from) * f64::from(k) / steps;
    let mut values: Vec<f64> = (0..SAMPLES)
        .map(value)
        .map(|value| if is_whole { value.round() } else { value })
        .filter(|value| value.is_finite())
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_ascend_and_are_whole_where_they_must_be() {
        assert_eq!(values([0.0, 2.0], false), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(values([3.0, 1.0], true), [1.0, 2.0, 3.0]);
        assert_eq!(values([1.0, 1.0], false), [1.0]);
        assert_eq!(values([f64::NAN, 1.0], false), [0.0; 0]);
    }
}
