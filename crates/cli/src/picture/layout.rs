//! Places of boxes and ways of edges.

use super::model::{Item, Picture};
use super::order::{Layers, Slot};

/// More boxes and passages than this make no picture.
const MOST_SLOTS: usize = 20_000;

/// Height of a line of text.
pub(super) const LINE: f64 = 17.0;
/// Width of a narrow character: no monospaced face in use is wider.
pub(super) const CHARACTER: f64 = 8.2;
/// Between text and the sides of its box.
pub(super) const PAD: f64 = 10.0;
/// Between two layers.
const GAP: f64 = 56.0;
/// Between two boxes, and two edges, one above the other.
const BETWEEN: f64 = 16.0;
/// Round everything.
pub(super) const MARGIN: f64 = 24.0;

/// A box's place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// Where everything is.
pub(super) struct Layout {
    /// One per box.
    pub(super) places: Vec<Place>,
    /// Per edge the points it leads through: pairs of a left and a right end of
    /// a level piece; between pairs it bends.
    pub(super) ways: Vec<Vec<[f64; 2]>>,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Layout {
    /// The layout of a picture; `None` if it is too large to be one.
    pub(super) fn new(picture: &Picture) -> Option<Self> {
        let layers = Layers::new(picture, MOST_SLOTS)?;
        let heights: Vec<f64> = layers
            .slots
            .iter()
            .map(|slot| match slot {
                Slot::Item(item) => height_of(&picture.boxes[*item]),
                Slot::Passage(_) => 0.0,
            })
            .collect();
        let middles = middles(&layers, &heights);
        let columns = columns(picture, &layers);
        let mut places = vec![Place::default(); picture.boxes.len()];
        let mut spans = vec![(0.0, 0.0); layers.slots.len()];
        for (layer, &(x, width)) in layers.layers.iter().zip(&columns) {
            for &slot in layer {
                spans[slot] = (x, x + width);
                if let Slot::Item(item) = layers.slots[slot] {
                    let height = heights[slot];
                    let y = middles[slot] - height / 2.0;
                    places[item] = Place {
                        x,
                        y,
                        width,
                        height,
                    };
                }
            }
        }
        let bottom = places.iter().map(|place| place.y + place.height);
        let passages = middles.iter().copied();
        let height = bottom.chain(passages).fold(0.0, f64::max) + MARGIN;
        let width = columns.last().map_or(0.0, |(x, width)| x + width) + MARGIN;
        let ways = ways(&layers, &middles, &spans, &places);
        Some(Self {
            places,
            ways,
            width,
            height,
        })
    }
}

/// How wide a text is at most.
pub(super) fn width_of(text: &str) -> f64 {
    // Scripts that are wider than Latin take two places.
    let places: usize = text
        .chars()
        .map(|c| if c < '\u{300}' || c == '…' { 1 } else { 2 })
        .sum();
    places as f64 * CHARACTER
}

fn height_of(item: &Item) -> f64 {
    item.lines.len() as f64 * LINE + PAD
}

/// The left side and width of each layer.
fn columns(picture: &Picture, layers: &Layers) -> Vec<(f64, f64)> {
    let mut x = MARGIN;
    let column = |layer: &Vec<usize>| {
        let lines = layer.iter().filter_map(|&slot| match layers.slots[slot] {
            Slot::Item(item) => Some(picture.boxes[item].lines.iter()),
            Slot::Passage(_) => None,
        });
        let width = lines
            .flatten()
            .map(|line| width_of(line))
            .fold(0.0, f64::max);
        let column = (x, width + 2.0 * PAD);
        x += column.1 + GAP;
        column
    };
    layers.layers.iter().map(column).collect()
}

/// The height at which each slot has its middle: near the mean of those it is
/// joined to, in the order of the layer, never closer than `BETWEEN`.
fn middles(layers: &Layers, heights: &[f64]) -> Vec<f64> {
    let mut middles = vec![0.0; layers.slots.len()];
    for layer in &layers.layers {
        let mut y = 0.0;
        for &slot in layer {
            middles[slot] = y + heights[slot] / 2.0;
            y += heights[slot] + BETWEEN;
        }
    }
    let last = layers.layers.len();
    for pass in 0..24 {
        for step in 0..last {
            let forward = pass % 2 == 0;
            let layer = &layers.layers[if forward { step } else { last - 1 - step }];
            let wanted: Vec<(f64, f64)> = layer
                .iter()
                .map(|&slot| wanted(layers, &middles, slot))
                .collect();
            for (&slot, middle) in layer.iter().zip(apart(layer, heights, &wanted)) {
                middles[slot] = middle;
            }
        }
    }
    let top = layers
        .layers
        .iter()
        .flatten()
        .map(|&slot| middles[slot] - heights[slot] / 2.0)
        .fold(f64::INFINITY, f64::min);
    middles.iter().map(|middle| middle - top + MARGIN).collect()
}

/// Where a slot would best have its middle, and how much that matters: edges
/// that pass should be straight.
fn wanted(layers: &Layers, middles: &[f64], slot: usize) -> (f64, f64) {
    let others = || layers.before[slot].iter().chain(&layers.after[slot]);
    let count = others().count();
    if count == 0 {
        return (middles[slot], 0.1);
    }
    let mean = others().map(|&other| middles[other]).sum::<f64>() / count as f64;
    let weight = match layers.slots[slot] {
        Slot::Item(_) => 1.0,
        Slot::Passage(_) => 4.0,
    };
    (mean, weight)
}

/// The places nearest to those wanted, by weighted squares, that keep order and
/// distance: isotonic regression, by pooling neighbours that are in each
/// other's way.
fn apart(layer: &[usize], heights: &[f64], wanted: &[(f64, f64)]) -> Vec<f64> {
    let mut offset = 0.0;
    let mut offsets = Vec::with_capacity(layer.len());
    for (place, &slot) in layer.iter().enumerate() {
        if place > 0 {
            offset += (heights[layer[place - 1]] + heights[slot]) / 2.0 + BETWEEN;
        }
        offsets.push(offset);
    }
    // Pools of a mean, a weight and a count; means rise from pool to pool.
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for (&(middle, weight), offset) in wanted.iter().zip(&offsets) {
        let mut pool = (middle - offset, weight, 1);
        while let Some(&(mean, before, count)) = pools.last() {
            if mean <= pool.0 {
                break;
            }
            pools.pop();
            let sum = before + pool.1;
            pool = ((mean * before + pool.0 * pool.1) / sum, sum, count + pool.2);
        }
        pools.push(pool);
    }
    let means = pools
        .into_iter()
        .flat_map(|(mean, _, count)| std::iter::repeat_n(mean, count));
    means
        .zip(offsets)
        .map(|(mean, offset)| mean + offset)
        .collect()
}

/// The ways of all edges. They leave a box at its middle and come to the next
/// one side by side, in the order in which they come.
fn ways(
    layers: &Layers,
    middles: &[f64],
    spans: &[(f64, f64)],
    places: &[Place],
) -> Vec<Vec<[f64; 2]>> {
    let mut comers: Vec<Vec<(f64, usize)>> = vec![Vec::new(); places.len()];
    for (edge, path) in layers.paths.iter().enumerate() {
        let (before, end) = (path[path.len() - 2], path[path.len() - 1]);
        comers[end].push((middles[before], edge));
    }
    let mut ends = vec![0.0; layers.paths.len()];
    for (place, comers) in places.iter().zip(&mut comers) {
        comers.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        for (rank, &(_, edge)) in comers.iter().enumerate() {
            let share = (rank as f64 + 1.0) / (comers.len() as f64 + 1.0);
            ends[edge] = place.y + place.height * share;
        }
    }
    let way = |(edge, path): (usize, &Vec<usize>)| {
        let last = path.len() - 1;
        let mut way = vec![[spans[path[0]].1, middles[path[0]]]];
        for &slot in &path[1..last] {
            let (left, right) = spans[slot];
            way.extend([[left, middles[slot]], [right, middles[slot]]]);
        }
        way.push([spans[path[last]].0, ends[edge]]);
        way
    };
    layers.paths.iter().enumerate().map(way).collect()
}
