//! What becomes of what a page asks for.

use std::sync::Arc;

use tessgraph_geometry::glam::DVec3;
use tessgraph_graph::plan::ResultRef;
use tessgraph_graph::reference::node_markdown;
use tessgraph_io::write_png;
use tessgraph_render::{DrawOptions, View, draw};
use tessgraph_view::pick::{measure, pick};
use tessgraph_view::protocol::{
    Described, FromPage, Level, MeasureEnd, Notice, Picked, PlaneAsked, ResultSummary, ToPage,
    Value,
};
use tessgraph_view::section::section;
use tessgraph_view::{Asking, PageId, Reply};

use super::edits::Refused;
use super::viewer::{Viewer, setting};
use crate::interrupt::UntilInterrupt;
use crate::watch::{Cause, Wish};

impl Viewer<'_> {
    /// Sees to all requests that wait; what they mean for runs.
    pub(super) fn see_to_requests(&mut self) -> Wish {
        let mut wish = Wish::default();
        while let Some(asking) = self.requests.clone().take() {
            let next = self.see_to(asking);
            wish.stop |= next.stop;
            // Who stops the run at work wants no other one either.
            let is_end = next.stop && next.again.is_none();
            wish.again = next.again.or(wish.again.filter(|_| !is_end));
        }
        self.outdated |= wish.stop && wish.again.is_some();
        wish
    }

    fn see_to(&mut self, asking: Asking) -> Wish {
        let Asking {
            page,
            request,
            reply,
        } = asking;
        let reply = &reply;
        match request {
            FromPage::Set { name, value } => self.set(name, &value, reply),
            FromPage::Write { name, value } => self.write(&name, &setting(&value), reply),
            FromPage::Reset { name } => self.reset(&name, reply),
            FromPage::Undo => {
                let done = self.edits.undo(&self.args.graph);
                self.edited("the last edit", "was not taken back", "undo", done)
            }
            FromPage::Redo => {
                let done = self.edits.redo(&self.args.graph);
                self.edited("the edit", "was not made again", "redo", done)
            }
            FromPage::Show { node, result } => self.show(page, node, result, reply),
            FromPage::Cancel => {
                self.cancelled = true;
                Wish {
                    stop: true,
                    again: None,
                }
            }
            FromPage::Run => {
                self.publish_study();
                again("the page".to_owned(), false)
            }
            FromPage::Pick {
                request,
                face,
                vertex,
            } => self.pick(page, request, [face, vertex], reply),
            FromPage::Measure { request, from, to } => {
                self.measure(page, request, [from, to], reply)
            }
            FromPage::Section { request, plane } => self.section(page, request, plane, reply),
            FromPage::Render {
                request,
                size,
                towards,
            } => self.render(page, request, (size, towards), reply),
            FromPage::Describe { node } => self.describe(node, reply),
            FromPage::Preview {
                request,
                name,
                from,
                to,
            } => self.preview((page, request), &name, [from, to], reply),
        }
    }

    /// Has another result shown to the page that asks.
    fn show(&mut self, page: PageId, node: String, result: Option<String>, reply: &Reply) -> Wish {
        let plan = self.last.as_ref().map(|(plan, _)| plan);
        if plan.is_some_and(|plan| plan.result_of(&node, result.as_deref()).is_none()) {
            let place = result.map_or_else(|| node.clone(), |result| format!("{node}.{result}"));
            return refuse(reply, &format!("the graph has no result `{place}`"));
        }
        let cause = format!("showing {node}");
        self.choose(page, Some((node, result)));
        again(cause, false)
    }

    /// Tries a value out.
    fn set(&mut self, name: String, value: &Value, reply: &Reply) -> Wish {
        if self.is_locked(&name) {
            return refuse(reply, &format!("`{name}` is held by `--set`"));
        }
        let value = setting(value);
        let declared = self.declared.as_ref();
        let Some(declaration) = declared.and_then(|declared| declared.parameter(&name)) else {
            return refuse(reply, &format!("the graph has no parameter `{name}`"));
        };
        if let Err(refusal) = declaration.read(&value) {
            return refuse(reply, &refusal);
        }
        let cause = format!("slider {name}");
        self.live.insert(name, value);
        again(cause, true)
    }

    /// Puts a value into the file.
    fn write(&mut self, name: &str, value: &str, reply: &Reply) -> Wish {
        if self.is_locked(name) {
            return refuse(reply, &format!("`{name}` is held by `--set`"));
        }
        let Some(known) = self.content else {
            return refuse(reply, "the graph file could not be read");
        };
        let done = self.edits.write(&self.args.graph, known, name, value);
        // What the file says counts from now on, also if it was not written.
        let was_live = self.live.remove(name).is_some();
        if matches!(done, Err(Refused::Nothing)) {
            let cause = format!("slider {name}");
            return if was_live {
                again(cause, true)
            } else {
                Wish::default()
            };
        }
        let what = format!("the value of `{name}`");
        self.edited(&what, "was not written", &format!("slider {name}"), done)
    }

    fn reset(&mut self, name: &str, reply: &Reply) -> Wish {
        match self.initial(name).map(setting) {
            Some(value) => self.write(name, &value, reply),
            None => refuse(reply, &format!("the graph has no parameter `{name}`")),
        }
    }

    fn is_locked(&self, name: &str) -> bool {
        self.args.set.iter().any(|(locked, _)| locked == name)
    }

    /// The file has a new content, or not.
    fn edited(
        &mut self,
        what: &str,
        not_done: &str,
        cause: &str,
        done: Result<Vec<u8>, Refused>,
    ) -> Wish {
        let cause = cause.to_owned();
        let file = self.args.graph.file_name().unwrap_or_default();
        let file = file.to_string_lossy();
        let reason = match done {
            Ok(content) => {
                self.know(&content);
                self.publish_document();
                return again(cause, true);
            }
            Err(Refused::Nothing) => return Wish::default(),
            Err(Refused::ChangedOutside) => format!("{file} was changed outside"),
            Err(Refused::Other(reason)) => reason,
        };
        self.notice(Level::Warning, format!("{reason}: {what} {not_done}"));
        // What is shown may be of a value that is not in the file.
        again(cause, true)
    }

    /// Tells what is known of a face and a vertex of what a page sees.
    fn pick(
        &self,
        page: PageId,
        request: u64,
        [face, vertex]: [Option<usize>; 2],
        reply: &Reply,
    ) -> Wish {
        let nothing = Picked {
            request,
            ..Picked::default()
        };
        let subject = self.subject(page);
        let picked = subject.map(|subject| pick(subject, request, face, vertex));
        reply.send(&ToPage::Picked(picked.unwrap_or(nothing)));
        Wish::default()
    }

    /// Measures between two places of what a page sees.
    fn measure(
        &self,
        page: PageId,
        request: u64,
        [from, to]: [MeasureEnd; 2],
        reply: &Reply,
    ) -> Wish {
        let subject = self.subject(page);
        match subject.and_then(|subject| measure(subject, request, from, to)) {
            Some(measured) => reply.send(&ToPage::Measured(measured)),
            None => return refuse(reply, "there is nothing there to measure"),
        }
        Wish::default()
    }

    /// Cuts what a page sees.
    fn section(&self, page: PageId, request: u64, plane: PlaneAsked, reply: &Reply) -> Wish {
        if let Some(subject) = self.subject(page).cloned() {
            let (buffers, reply) = (Arc::clone(&self.buffers), reply.clone());
            self.studio.spawn(move || {
                if let Some(sectioned) = section(&subject, &buffers, request, plane) {
                    reply.send(&ToPage::Sectioned(sectioned));
                }
            });
        }
        Wish::default()
    }

    /// Draws what a page sees, for a browser that cannot, in that size from there.
    fn render(
        &self,
        page: PageId,
        request: u64,
        (size, towards): ([u32; 2], [f64; 3]),
        reply: &Reply,
    ) -> Wish {
        let towards = DVec3::from_array(towards);
        if let Some(subject) = self.subject(page).cloned()
            && towards.is_finite()
        {
            let (buffers, reply) = (Arc::clone(&self.buffers), reply.clone());
            self.studio.spawn(move || {
                let options = DrawOptions {
                    size,
                    view: View::From(towards),
                    ..DrawOptions::default()
                };
                // A size that cannot be drawn is asked for by nobody who wants a picture.
                if let Ok(picture) = draw(&subject.mesh, &options, &UntilInterrupt) {
                    let bytes = write_png(picture.size(), picture.pixels(), &[]);
                    let picture = buffers.picture(bytes);
                    reply.send(&ToPage::Rendered { request, picture });
                }
            });
        }
        Wish::default()
    }

    /// The reference page of a node's kind, and what came out.
    fn describe(&self, node: String, reply: &Reply) -> Wish {
        let found = self.last.clone();
        let index = found.as_ref().and_then(|(plan, _)| plan.node_index(&node));
        let (Some((plan, evaluation)), Some(index)) = (found, index) else {
            return refuse(reply, &format!("the graph has no node `{node}`"));
        };
        let reply = reply.clone();
        // Measuring a large mesh takes a while.
        self.studio.spawn(move || {
            let spec = plan.nodes[index].spec;
            let results = spec.outputs.iter().enumerate();
            let results = results.filter_map(|(result, output)| {
                let place = ResultRef {
                    node: index,
                    result,
                };
                let value = evaluation.value(place)?;
                Some(ResultSummary {
                    name: output.name.to_owned(),
                    summary: value.summary(),
                })
            });
            reply.send(&ToPage::Described(Described {
                markdown: node_markdown(spec),
                results: results.collect(),
                warnings: evaluation.nodes[index].warnings.clone(),
                node,
            }));
        });
        Wish::default()
    }
}

/// Another run; `stop` ends the one at work.
fn again(cause: String, stop: bool) -> Wish {
    Wish {
        stop,
        again: Some(Cause::Asked(cause)),
    }
}

/// Tells the page that asked why nothing is done.
fn refuse(reply: &Reply, reason: &str) -> Wish {
    let (level, text) = (Level::Warning, reason.to_owned());
    reply.send(&ToPage::Notice(Notice { level, text }));
    Wish::default()
}
