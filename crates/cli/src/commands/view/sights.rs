//! What each page sees.

use tessgraph_graph::Plan;
use tessgraph_graph::plan::ResultRef;
use tessgraph_view::PageId;
use tessgraph_view::protocol::{Level, Notice, Shown, ToPage};
use tessgraph_view::shown::Subject;

use super::studio::{Asked, Done};
use super::viewer::Viewer;

/// What a page sees, or all that have chosen nothing.
#[derive(Debug, Default, Clone)]
pub(super) struct Sight {
    /// What somebody wants to see there.
    pub(super) asked: Asked,
    /// Whether the next picture is told even if it is the same.
    pub(super) insists: bool,
    /// The mesh that is seen.
    subject: Option<Subject>,
    has_picture: bool,
}

impl Viewer<'_> {
    /// Has another result shown to a page from the next run on.
    pub(super) fn choose(&mut self, page: PageId, asked: Asked) {
        let before = self.sights.get(&Some(page)).or(self.sights.get(&None));
        let before = before.cloned().unwrap_or_default();
        let sight = Sight {
            asked,
            insists: true,
            ..before
        };
        self.sights.insert(Some(page), sight);
    }

    /// The mesh that a page sees.
    pub(super) fn subject(&self, page: PageId) -> Option<&Subject> {
        let sight = self.sights.get(&Some(page)).or(self.sights.get(&None));
        sight?.subject.as_ref()
    }

    /// Shows pages what they look at; `failure` is what is wrong with the graph.
    pub(super) fn show_pictures(&mut self, done: &Done, failure: Option<&str>) {
        for (page, result) in &done.shown {
            self.show_picture(*page, *result, done, failure);
        }
        self.gallery.tidy();
    }

    /// Shows a page its picture; one that could not be made leaves the last one where
    /// it is, unless somebody has asked for it.
    fn show_picture(
        &mut self,
        page: Option<PageId>,
        result: ResultRef,
        done: &Done,
        failure: Option<&str>,
    ) {
        let Some(sight) = self.sights.get_mut(&page) else {
            return;
        };
        let insists = std::mem::take(&mut sight.insists);
        let node = &done.plan.nodes[result.node].name;
        if let Some((lost, _)) = sight.asked.take_if(|(asked, _)| asked != node) {
            let text = format!("the graph has no node `{lost}` any more; `{node}` is shown");
            let level = Level::Info;
            self.hub.notice(page, Notice { level, text });
        }
        let mut shown = match done.pictures.get(&result) {
            Some(picture) => {
                // A report or table leaves the mesh where it is.
                if let Some(subject) = &picture.subject {
                    sight.subject = Some(subject.clone());
                }
                sight.has_picture = true;
                picture.shown.clone()
            }
            None if !insists && sight.has_picture => return,
            None => missing(&done.plan, result, failure),
        };
        if self.gallery.told(page, &mut shown, insists) {
            self.hub.show(page, &ToPage::Shown(Box::new(shown)));
        }
    }

    /// Shows other pictures, where those that were shown took something for granted
    /// that is not so.
    pub(super) fn correct_pictures(&self, done: &Done) {
        let guesses = done.pictures.iter().filter(|(_, picture)| picture.is_guess);
        for (result, picture) in guesses {
            let Some(subject) = &picture.subject else {
                continue;
            };
            let (plan, evaluation) = (&done.plan, &done.evaluation);
            let corrected = self.studio.compute_now(|| {
                let holds = self.gallery.holds(subject);
                (!holds).then(|| self.gallery.picture(plan, evaluation, *result))
            });
            let Some(corrected) = corrected.flatten() else {
                continue;
            };
            let pages = done.shown.iter().filter(|(_, shown)| shown == result);
            for (page, _) in pages {
                let mut shown = corrected.shown.clone();
                if self.gallery.told(*page, &mut shown, false) {
                    self.hub.show(*page, &ToPage::Shown(Box::new(shown)));
                }
            }
            self.gallery.tidy();
        }
    }
}

/// What is said where there is no picture.
fn missing(plan: &Plan, result: ResultRef, failure: Option<&str>) -> Shown {
    let node = plan.nodes[result.node].name.clone();
    let failure = failure.map(str::to_owned);
    let failure = failure.unwrap_or_else(|| format!("`{node}` could not be computed"));
    Shown {
        node,
        result: plan.result_spec(result).name.to_owned(),
        kind: format!("{:?}", plan.result_spec(result).kind),
        empty: Some(failure),
        ..Shown::default()
    }
}
