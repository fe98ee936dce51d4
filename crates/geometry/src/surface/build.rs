//! Building the tree: binned surface-area heuristic, then four children a node.

use std::ops::Range;

use glam::DVec3;

use super::leaf::{Leaf, WIDTH};
use super::node::{EMPTY, LEAF, Node};
use super::triangle::Triangle;
use super::turned::Turned;
use crate::parallel::{CHUNK, in_order};
use crate::{GeometryError, Monitor};

/// Bins along the axis of a split (Wald 2007); more gain nothing measurable.
const BINS: usize = 16;

/// Levels of the binary tree at most. Splits that would not leave enough levels
/// for halving become medians, so that traversal stacks have a fixed size.
pub(super) const MAX_DEPTH: usize = 40;

/// Items below which a subtree is built by one thread.
const PARALLEL: usize = 8192;

/// Triangles under a node that still gets [`Turned`] boxes: over more of them a
/// surface is hardly flat, and upright boxes do.
const TURNED: usize = 64;

/// Relative widening of boxes, above the rounding of the distances inside them.
const PAD: f64 = 1e-14;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
}

impl Bounds {
    pub(super) const NONE: Self = Self {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
    };

    fn join(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub(super) fn with(self, point: DVec3) -> Self {
        Self {
            low: self.low.min(point),
            high: self.high.max(point),
        }
    }

    /// Half of the surface area; 0 for an empty box.
    fn half_area(self) -> f64 {
        let size = (self.high - self.low).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A triangle to be sorted into the tree.
#[derive(Debug, Clone, Copy)]
struct Item {
    bounds: Bounds,
    triangle: u32,
}

impl Item {
    fn new(triangle: u32, corners: Triangle) -> Self {
        let bounds = corners.0.into_iter().fold(Bounds::NONE, Bounds::with);
        let pad = DVec3::splat((bounds.high - bounds.low).max_element() * PAD);
        Self {
            bounds: Bounds {
                low: bounds.low - pad,
                high: bounds.high + pad,
            },
            triangle,
        }
    }

    fn centre(&self) -> DVec3 {
        (self.bounds.low + self.bounds.high) * 0.5
    }
}

/// A node of the binary tree: two children, or `count` items from `first`.
#[derive(Debug, Clone, Copy)]
struct Binary {
    bounds: Bounds,
    children: [u32; 2],
    first: u32,
    count: u32,
}

/// The finished tree: nodes, leaves, and a reference to its root.
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Vec<Leaf>,
    pub(super) turned: Vec<Turned>,
    pub(super) root: u32,
}

/// Builds the tree over `count` triangles, at least one.
/// Cost: O(count · log count), in parallel.
pub(super) fn build(
    count: usize,
    corners: impl Fn(u32) -> Triangle + Sync,
    monitor: &dyn Monitor,
) -> Result<Tree, GeometryError> {
    let mut items = Vec::with_capacity(count);
    in_order(count, monitor, |k| {
        items.push(Item::new(k as u32, corners(k as u32)));
    })?;
    let binary = grow_parallel(&mut items, 0, 0, monitor)?;
    let mut widen = Widen {
        binary: &binary,
        items: &items,
        corners: &corners,
        monitor,
        nodes: Vec::with_capacity(binary.len() / 4),
        leaves: Vec::with_capacity(binary.len() / 2 + 1),
        turned: Vec::new(),
    };
    let root = widen.reference(0)?;
    Ok(Tree {
        root,
        turned: widen.turned,
        nodes: widen.nodes,
        leaves: widen.leaves,
    })
}

/// The subtree of `items`, whose first has number `first`; its root comes first.
fn grow_parallel(
    items: &mut [Item],
    first: usize,
    depth: usize,
    monitor: &dyn Monitor,
) -> Result<Vec<Binary>, GeometryError> {
    monitor.check()?;
    if items.len() < PARALLEL {
        let mut nodes = Vec::with_capacity(items.len());
        grow(items, first, depth, &mut nodes);
        return Ok(nodes);
    }
    let bounds = bounds_of(items);
    monitor.check()?;
    let at = split(items, depth);
    let (left, right) = items.split_at_mut(at);
    let (left, right) = rayon::join(
        || grow_parallel(left, first, depth + 1, monitor),
        || grow_parallel(right, first + at, depth + 1, monitor),
    );
    let (left, right) = (left?, right?);
    let right_at = 1 + left.len() as u32;
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.push(Binary {
        bounds,
        children: [1, right_at],
        first: 0,
        count: 0,
    });
    for (subtree, offset) in [(left, 1), (right, right_at)] {
        nodes.extend(subtree.into_iter().map(|node| Binary {
            children: node.children.map(|child| child + offset),
            ..node
        }));
    }
    Ok(nodes)
}

fn grow(items: &mut [Item], first: usize, depth: usize, nodes: &mut Vec<Binary>) {
    let here = nodes.len();
    nodes.push(Binary {
        bounds: bounds_of(items),
        children: [0; 2],
        first: first as u32,
        count: items.len() as u32,
    });
    if items.len() <= WIDTH {
        return;
    }
    let at = split(items, depth);
    let (left, right) = items.split_at_mut(at);
    let left_at = nodes.len() as u32;
    grow(left, first, depth + 1, nodes);
    let right_at = nodes.len() as u32;
    grow(right, first + at, depth + 1, nodes);
    nodes[here].children = [left_at, right_at];
    nodes[here].count = 0;
}

fn bounds_of(items: &[Item]) -> Bounds {
    items
        .iter()
        .fold(Bounds::NONE, |bounds, item| bounds.join(item.bounds))
}

/// Sorts `items` into two parts and says where the second starts.
fn split(items: &mut [Item], depth: usize) -> usize {
    let centres = items
        .iter()
        .fold(Bounds::NONE, |bounds, item| bounds.with(item.centre()));
    let size = centres.high - centres.low;
    let axis = size.max_position();
    let levels = usize::BITS as usize - (items.len() / WIDTH).leading_zeros() as usize;
    let small = items.len() <= 4 * WIDTH;
    if small || depth + levels + 1 >= MAX_DEPTH || size[axis] <= 0.0 {
        return halve(items, axis);
    }
    let scale = BINS as f64 / size[axis];
    let bin = |item: &Item| {
        let place = (item.centre()[axis] - centres.low[axis]) * scale;
        (place as usize).min(BINS - 1)
    };
    match best_bin(items, bin) {
        Some(border) => partition(items, |item| bin(item) < border),
        None => halve(items, axis),
    }
}

/// Two halves along `axis`, the first a multiple of the leaf size, so that
/// leaves are full.
fn halve(items: &mut [Item], axis: usize) -> usize {
    let at = (items.len() / 2)
        .next_multiple_of(WIDTH)
        .min(items.len() - 1);
    items.select_nth_unstable_by(at, |a, b| {
        let places = a.centre()[axis].total_cmp(&b.centre()[axis]);
        places.then(a.triangle.cmp(&b.triangle))
    });
    at
}

/// The first bin of the right part at the least expected cost, if any split
/// has items on both sides.
fn best_bin(items: &[Item], bin: impl Fn(&Item) -> usize) -> Option<usize> {
    let mut boxes = [Bounds::NONE; BINS];
    let mut counts = [0usize; BINS];
    for item in items {
        let bin = bin(item);
        boxes[bin] = boxes[bin].join(item.bounds);
        counts[bin] += 1;
    }
    let mut right = [(Bounds::NONE, 0); BINS + 1];
    for k in (0..BINS).rev() {
        right[k] = (right[k + 1].0.join(boxes[k]), right[k + 1].1 + counts[k]);
    }
    let (mut left, mut left_count) = (Bounds::NONE, 0);
    let mut best = (f64::INFINITY, None);
    for border in 1..BINS {
        left = left.join(boxes[border - 1]);
        left_count += counts[border - 1];
        let (right, right_count) = right[border];
        // Whole leaves are paid for, also where they are not full.
        let leaves = |count: usize| count.div_ceil(WIDTH) as f64;
        let cost = leaves(left_count) * left.half_area() + leaves(right_count) * right.half_area();
        if left_count > 0 && right_count > 0 && cost < best.0 {
            best = (cost, Some(border));
        }
    }
    best.1
}

/// Moves the items for which `left` holds to the front; says how many.
fn partition(items: &mut [Item], left: impl Fn(&Item) -> bool) -> usize {
    let mut at = 0;
    for k in 0..items.len() {
        if left(&items[k]) {
            items.swap(at, k);
            at += 1;
        }
    }
    at
}

/// Turns the binary tree into one with four children a node.
struct Widen<'a, F> {
    binary: &'a [Binary],
    items: &'a [Item],
    corners: &'a F,
    monitor: &'a dyn Monitor,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    turned: Vec<Turned>,
}

impl<F: Fn(u32) -> Triangle> Widen<'_, F> {
    /// Adds the subtree under binary node `at`; says how to refer to it.
    fn reference(&mut self, at: u32) -> Result<u32, GeometryError> {
        let node = self.binary[at as usize];
        if node.count > 0 {
            let items = &self.items[node.first as usize..][..node.count as usize];
            let triangles = std::array::from_fn(|k| items[k.min(items.len() - 1)].triangle);
            self.leaves.push(Leaf::new(triangles, self.corners));
            if self.leaves.len().is_multiple_of(CHUNK) {
                self.monitor.check()?;
            }
            return Ok(LEAF | (self.leaves.len() - 1) as u32);
        }
        let here = self.nodes.len();
        self.nodes.push(Node::default());
        let (children, count) = self.gather(node);
        for (slot, &child) in children.iter().enumerate().take(count) {
            let reference = self.reference(child)?;
            let bounds = self.binary[child as usize].bounds;
            self.nodes[here].set(slot, bounds, reference);
            let parent = if reference & LEAF != 0 {
                &mut self.leaves[(reference & !LEAF) as usize].parent
            } else {
                &mut self.nodes[reference as usize].parent
            };
            *parent = here as u32;
        }
        self.turn(here, &children[..count]);
        Ok(here as u32)
    }

    /// Gives node `here`, over few triangles, boxes that lean with them.
    fn turn(&mut self, here: usize, children: &[u32]) {
        let ranges = children.iter().map(|&child| self.range(child));
        let ranges: Vec<_> = ranges.collect();
        if ranges.iter().map(|range| range.len()).sum::<usize>() > TURNED {
            return;
        }
        let triangles = |range: Range<usize>| {
            let items = self.items[range].iter();
            items.map(|item| (self.corners)(item.triangle)).collect()
        };
        let triangles: Vec<Vec<Triangle>> = ranges.into_iter().map(triangles).collect();
        if let Some(turned) = Turned::new(&triangles) {
            self.nodes[here].turned = self.turned.len() as u32;
            self.turned.push(turned);
        }
    }

    /// The items under a binary node, which lie side by side.
    fn range(&self, at: u32) -> Range<usize> {
        let [mut first, mut last] = [self.binary[at as usize]; 2];
        while first.count == 0 {
            first = self.binary[first.children[0] as usize];
        }
        while last.count == 0 {
            last = self.binary[last.children[1] as usize];
        }
        first.first as usize..(last.first + last.count) as usize
    }

    /// Up to four descendants of `node`: its children, then of those the one
    /// with the largest surface opened, until there are four.
    fn gather(&self, node: Binary) -> ([u32; WIDTH], usize) {
        let mut children = [EMPTY; WIDTH];
        children[..2].copy_from_slice(&node.children);
        let mut count = 2;
        while count < WIDTH {
            let area = |&slot: &usize| self.binary[children[slot] as usize].bounds.half_area();
            let inner = (0..count).filter(|&slot| self.binary[children[slot] as usize].count == 0);
            // The first of equals, so that the tree does not depend on chance.
            let Some(widest) = inner.reduce(|a, b| if area(&b) > area(&a) { b } else { a }) else {
                break;
            };
            let [left, right] = self.binary[children[widest] as usize].children;
            children[widest] = left;
            children[count] = right;
            count += 1;
        }
        (children, count)
    }
}
