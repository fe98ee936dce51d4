//! The order nodes are evaluated in, and cycles, which have none.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::ops::Range;
use std::sync::Arc;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::expand::{ExpandedNode, Expander};
use crate::diagnostic::{Diagnostic, Label, Place};
use crate::document::{Item, Shape};
use crate::names::shown;
use crate::plan::PlanInput;

/// All nodes, each after those it depends on, else in file order; `None` after
/// reporting every cycle. Cost: O((nodes + edges) · log nodes).
pub(super) fn check(expander: &mut Expander<'_>) -> Option<Vec<usize>> {
    let nodes = expander.nodes.iter();
    let needs: Vec<Vec<usize>> = nodes.map(|node| needed(&node.inputs)).collect();
    let order = sort(&needs);
    if order.len() == needs.len() {
        return Some(order);
    }
    for cycle in cycles(&needs, &order) {
        let problem = problem(&expander.nodes, &cycle);
        expander.report(problem);
    }
    None
}

/// The nodes whose results the inputs use, each once, in ascending order.
fn needed(inputs: &[PlanInput]) -> Vec<usize> {
    let results = inputs.iter().flat_map(|input| input.origin.results());
    let mut nodes: Vec<usize> = results.map(|result| result.node).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Kahn's algorithm with a heap: of all nodes that are ready, the first of the
/// file. Nodes on or behind a cycle are missing from the result.
pub(super) fn sort(needs: &[Vec<usize>]) -> Vec<usize> {
    let mut users = vec![Vec::new(); needs.len()];
    let mut waiting: Vec<usize> = needs.iter().map(Vec::len).collect();
    for (node, needs) in needs.iter().enumerate() {
        for &need in needs {
            users[need].push(node);
        }
    }
    let ready = waiting.iter().enumerate().filter(|(_, count)| **count == 0);
    let mut ready: BinaryHeap<Reverse<usize>> = ready.map(|(node, _)| Reverse(node)).collect();
    let mut order = Vec::with_capacity(needs.len());
    while let Some(Reverse(node)) = ready.pop() {
        order.push(node);
        for &user in &users[node] {
            waiting[user] -= 1;
            if waiting[user] == 0 {
                ready.push(Reverse(user));
            }
        }
    }
    order
}

/// One cycle, as short as can be, through the first node of each knot: each
/// node needs the next, the last needs the first.
pub(super) fn cycles(needs: &[Vec<usize>], ordered: &[usize]) -> Vec<Vec<usize>> {
    let mut stuck = vec![true; needs.len()];
    ordered.iter().for_each(|&node| stuck[node] = false);
    let mut graph = DiGraph::<(), ()>::with_capacity(needs.len(), 0);
    for _ in needs {
        graph.add_node(());
    }
    for (node, needs) in needs.iter().enumerate().filter(|(node, _)| stuck[*node]) {
        for &need in needs {
            graph.add_edge(NodeIndex::new(node), NodeIndex::new(need), ());
        }
    }
    // Kosaraju's algorithm walks with its own stack; Tarjan's recurses, which
    // a knot of 100 000 nodes would turn into a stack overflow.
    let mut knots: Vec<Vec<usize>> = kosaraju_scc(&graph)
        .into_iter()
        .map(|knot| knot.into_iter().map(NodeIndex::index).collect())
        .filter(|knot: &Vec<usize>| knot.len() > 1 || needs[knot[0]].contains(&knot[0]))
        .collect();
    knots.iter_mut().for_each(|knot| knot.sort_unstable());
    knots.sort();
    knots
        .iter()
        .filter_map(|knot| shortest_cycle(needs, knot))
        .collect()
}

/// Breadth-first from the knot's first node until it is met again.
fn shortest_cycle(needs: &[Vec<usize>], knot: &[usize]) -> Option<Vec<usize>> {
    let start = *knot.first()?;
    let mut from = vec![usize::MAX; needs.len()];
    let mut queue = VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        for &next in &needs[node] {
            if next == start {
                let mut cycle = vec![node];
                while let Some(&last) = cycle.last().filter(|last| **last != start) {
                    cycle.push(from[last]);
                }
                cycle.reverse();
                return Some(cycle);
            }
            if from[next] == usize::MAX && knot.binary_search(&next).is_ok() {
                from[next] = node;
                queue.push_back(next);
            }
        }
    }
    None
}

/// More places than these make a diagnostic unreadable; the message has all.
const MAX_LABELS: usize = 8;

fn problem(nodes: &[ExpandedNode], cycle: &[usize]) -> Diagnostic {
    let name = |node: usize| format!("`{}`", shown(&nodes[node].name));
    let next = |place: usize| cycle[(place + 1) % cycle.len()];
    let label = |place: usize| Label {
        span: edge(&nodes[cycle[place]], &nodes[next(place)], next(place)),
        message: format!("{} takes {}", name(cycle[place]), name(next(place))),
    };
    let (message, help) = match cycle {
        [node] => (
            format!("{} takes its own result", name(*node)),
            "take another node's result",
        ),
        _ => {
            let names: Vec<String> = cycle
                .iter()
                .chain(cycle.first())
                .map(|&n| name(n))
                .collect();
            let message = format!("nodes need each other in a cycle: {}", names.join(" -> "));
            (message, "break the cycle at one of these inputs")
        }
    };
    let first = &nodes[cycle[0]];
    let place = label(0);
    let mut error = Diagnostic::error("cycle", &first.source, place.span, message, place.message);
    for (index, &user) in cycle.iter().enumerate().take(MAX_LABELS).skip(1) {
        let (label, source) = (label(index), &nodes[user].source);
        if Arc::ptr_eq(source, &first.source) {
            error.labels.push(label);
        } else {
            let source = Arc::clone(source);
            error.elsewhere.push(Place { source, label });
        }
    }
    error.with_help(help).with_node(&first.name)
}

/// Where `user` refers to a result of `used`, which is the node at `place`.
fn edge(user: &ExpandedNode, used: &ExpandedNode, place: usize) -> Range<usize> {
    let uses = |input: &&PlanInput| {
        input
            .origin
            .results()
            .iter()
            .any(|result| result.node == place)
    };
    let span = user
        .inputs
        .iter()
        .find(uses)
        .and_then(|input| input.span.clone());
    let (Some(span), Some((document, index))) = (span, &user.entry) else {
        return user.span.clone();
    };
    let field = document.nodes[*index]
        .fields
        .iter()
        .find(|field| field.value.span == span);
    let name = used.name.rsplit('/').next().unwrap_or(&used.name);
    let text = document.source.text();
    field
        .and_then(|field| mention(text, &field.value, name))
        .unwrap_or(span)
}

/// The item of a list that names the node.
fn mention(text: &str, item: &Item, name: &str) -> Option<Range<usize>> {
    match &item.shape {
        Shape::List(items) => items.iter().find_map(|item| mention(text, item, name)),
        Shape::Tuple(tuple) => tuple
            .items
            .iter()
            .find_map(|item| mention(text, item, name)),
        Shape::Text => {
            let value = item.text(text)?.value;
            (value.split('.').next() == Some(name)).then(|| item.span.clone())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn among_equals_the_order_of_the_file_counts() {
        // 0 needs 3; 1, 2 and 3 need nothing.
        assert_eq!(sort(&[vec![3], vec![], vec![], vec![]]), [1, 2, 3, 0]);
    }

    #[test]
    fn each_knot_gives_one_shortest_cycle() {
        let needs = [vec![1], vec![2, 0], vec![0], vec![3], vec![0]];
        let order = sort(&needs);
        assert!(order.is_empty());
        assert_eq!(cycles(&needs, &order), [vec![0, 1], vec![3]]);
    }

    #[test]
    fn long_chains_and_long_cycles_do_not_recurse() {
        let count = 100_000;
        let chain: Vec<Vec<usize>> = (0..count)
            .map(|node| {
                if node + 1 < count {
                    vec![node + 1]
                } else {
                    vec![]
                }
            })
            .collect();
        assert_eq!(sort(&chain).len(), count);
        let ring: Vec<Vec<usize>> = (0..count).map(|node| vec![(node + 1) % count]).collect();
        assert_eq!(cycles(&ring, &[])[0].len(), count);
    }
}
