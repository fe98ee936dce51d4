//! Layers, and the order within them: the method of Sugiyama, Tagawa and Toda
//! (1981), longest-path layers and barycentres.

use super::model::Picture;

/// How often the order of all layers is gone through, there and back.
const SWEEPS: usize = 12;

/// What stands at a place in a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// A box, by index.
    Item(usize),
    /// Where an edge, by index, passes a layer.
    Passage(usize),
}

/// Slots in layers, and the pieces of edges from each layer to the next.
pub(super) struct Layers {
    pub(super) slots: Vec<Slot>,
    /// Slots of each layer, in order.
    pub(super) layers: Vec<Vec<usize>>,
    /// The slots before and after each slot that a piece of an edge leads to.
    pub(super) before: Vec<Vec<usize>>,
    pub(super) after: Vec<Vec<usize>>,
    /// The slots each edge leads through, its two boxes included.
    pub(super) paths: Vec<Vec<usize>>,
}

impl Layers {
    /// Layers of few crossings; `None` if there would be more than `most` slots.
    pub(super) fn new(picture: &Picture, most: usize) -> Option<Self> {
        let layer_of = layer_of(picture);
        let count = layer_of.iter().max().map_or(0, |last| last + 1);
        let boxes = picture.boxes.len();
        let mut all = Self {
            slots: (0..boxes).map(Slot::Item).collect(),
            layers: vec![Vec::new(); count],
            before: vec![Vec::new(); boxes],
            after: vec![Vec::new(); boxes],
            paths: Vec::new(),
        };
        for (item, &layer) in layer_of.iter().enumerate() {
            all.layers[layer].push(item);
        }
        for (index, edge) in picture.edges.iter().enumerate() {
            let mut path = vec![edge.from];
            for layer in &mut all.layers[layer_of[edge.from] + 1..layer_of[edge.to]] {
                if all.slots.len() >= most {
                    return None;
                }
                path.push(all.slots.len());
                layer.push(all.slots.len());
                all.slots.push(Slot::Passage(index));
            }
            path.push(edge.to);
            all.before.resize(all.slots.len(), Vec::new());
            all.after.resize(all.slots.len(), Vec::new());
            for pair in path.windows(2) {
                all.after[pair[0]].push(pair[1]);
                all.before[pair[1]].push(pair[0]);
            }
            all.paths.push(path);
        }
        all.reduce_crossings();
        Some(all)
    }

    /// Puts every slot at the mean place of its neighbours, from the first layer
    /// to the last and back, and keeps the order with the fewest crossings.
    fn reduce_crossings(&mut self) {
        let mut best = (self.crossings(), self.layers.clone());
        for _ in 0..SWEEPS {
            for forward in [true, false] {
                let count = self.layers.len();
                for step in 1..count {
                    let layer = if forward { step } else { count - 1 - step };
                    self.sort(layer, forward);
                }
                let crossings = self.crossings();
                if crossings < best.0 {
                    best = (crossings, self.layers.clone());
                }
            }
        }
        self.layers = best.1;
    }

    fn sort(&mut self, layer: usize, forward: bool) {
        let places = self.places();
        let neighbours = if forward { &self.before } else { &self.after };
        let mean = |slot: usize, own: usize| {
            let others = &neighbours[slot];
            if others.is_empty() {
                return own as f64;
            }
            let sum: usize = others.iter().map(|&other| places[other]).sum();
            sum as f64 / others.len() as f64
        };
        let mut keyed: Vec<(f64, usize)> = self.layers[layer]
            .iter()
            .enumerate()
            .map(|(own, &slot)| (mean(slot, own), slot))
            .collect();
        // Stable: what is equal stays as it is.
        keyed.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        self.layers[layer] = keyed.into_iter().map(|(_, slot)| slot).collect();
    }

    /// Each slot's place within its layer.
    fn places(&self) -> Vec<usize> {
        let mut places = vec![0; self.slots.len()];
        for layer in &self.layers {
            for (place, &slot) in layer.iter().enumerate() {
                places[slot] = place;
            }
        }
        places
    }

    /// How many pairs of pieces of edges cross.
    fn crossings(&self) -> usize {
        let places = self.places();
        self.layers
            .iter()
            .map(|layer| {
                let ends: Vec<usize> = layer
                    .iter()
                    .flat_map(|&slot| {
                        let mut ends: Vec<usize> =
                            self.after[slot].iter().map(|&next| places[next]).collect();
                        ends.sort_unstable();
                        ends
                    })
                    .collect();
                inversions(&ends)
            })
            .sum()
    }
}

/// How many pairs stand in the wrong order. Cost: O(n log n), with a Fenwick
/// tree over the numbers.
fn inversions(numbers: &[usize]) -> usize {
    let most = numbers.iter().max().map_or(0, |most| most + 1);
    let mut tree = vec![0; most + 1];
    let mut crossings = 0;
    for (seen, &number) in numbers.iter().enumerate() {
        let (mut at, mut not_above) = (number + 1, 0);
        while at > 0 {
            not_above += tree[at];
            at &= at - 1;
        }
        crossings += seen - not_above;
        at = number + 1;
        while at < tree.len() {
            tree[at] += 1;
            at += at & at.wrapping_neg();
        }
    }
    crossings
}

/// Each box one layer after the last one it takes from. What takes from
/// nothing stands right before the first that takes from it.
fn layer_of(picture: &Picture) -> Vec<usize> {
    let count = picture.boxes.len();
    let mut layer = vec![0; count];
    let (mut has_source, mut first_user) = (vec![false; count], vec![usize::MAX; count]);
    let mut edges: Vec<_> = picture.edges.iter().collect();
    edges.sort_by_key(|edge| (edge.from, edge.to));
    // Boxes stand after those they take from, so one pass suffices.
    for edge in &edges {
        has_source[edge.to] = true;
        layer[edge.to] = layer[edge.to].max(layer[edge.from] + 1);
    }
    for edge in &edges {
        first_user[edge.from] = first_user[edge.from].min(layer[edge.to]);
    }
    for item in 0..count {
        if !has_source[item] && first_user[item] != usize::MAX {
            layer[item] = first_user[item] - 1;
        }
    }
    layer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inversions_are_counted() {
        assert_eq!(inversions(&[]), 0);
        assert_eq!(inversions(&[0, 1, 1, 2]), 0);
        assert_eq!(inversions(&[3, 2, 1, 0]), 6);
        assert_eq!(inversions(&[1, 0, 1, 0]), 3);
    }
}
