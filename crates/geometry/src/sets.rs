//! Disjoint sets of indices.

/// Which indices belong together (union-find with path halving; Tarjan and van
/// Leeuwen 1984). The lowest index of a set stands for it, so that the answer
/// does not depend on the order in which sets were joined.
pub(crate) struct Sets(Vec<u32>);

impl Sets {
    /// Every index a set of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The sets that `roots` tell, one for each index.
    pub(crate) fn of_roots(roots: Vec<u32>) -> Self {
        Self(roots)
    }

    /// The index that stands for the set of `i`.
    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    /// Makes one set of those of `a` and `b`.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// How many sets are represented by an index that `holds`.
    pub(crate) fn count_roots(&self, holds: impl Fn(usize) -> bool) -> usize {
        let parents = self.0.iter().enumerate();
        let roots = parents.filter(|&(index, &parent)| parent as usize == index && holds(index));
        roots.count()
    }
}
