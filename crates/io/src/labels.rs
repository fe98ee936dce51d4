//! Collecting the label of each face while faces are read.

use std::collections::HashMap;
use std::hash::Hash;

use tessgraph_geometry::{GeometryError, Labels, NO_LABEL};

/// Which label holds from which face on, as files say it.
#[derive(Debug)]
pub(crate) struct Runs<K> {
    /// First face and key; a run lasts until the next begins.
    runs: Vec<(usize, K)>,
}

impl<K> Default for Runs<K> {
    fn default() -> Self {
        Self { runs: Vec::new() }
    }
}

impl<K: Clone + Eq + Hash> Runs<K> {
    /// From face `face` on, `key` holds. A run without faces is forgotten, so
    /// that a file of nothing but names costs nothing.
    pub(crate) fn start(&mut self, face: usize, key: K) {
        match self.runs.last_mut() {
            Some(last) if last.0 == face => last.1 = key,
            _ => self.runs.push((face, key)),
        }
    }

    /// Adds the runs of a part whose faces are counted from `face` on.
    pub(crate) fn append(&mut self, face: usize, part: &Self) {
        for (start, key) in &part.runs {
            self.start(face + start, key.clone());
        }
    }

    /// Labels of `faces` faces: distinct labels in the order of their first
    /// use. `label` makes a label of a key, or `None` for "no label".
    pub(crate) fn finish<L: Clone + Eq + Hash>(
        &self,
        faces: usize,
        mut label: impl FnMut(&K) -> Option<L>,
    ) -> Result<Labels<L>, GeometryError> {
        let mut labels = Vec::new();
        let mut of_key: HashMap<&K, u32> = HashMap::new();
        let mut of_label: HashMap<L, u32> = HashMap::new();
        let mut of_face = vec![NO_LABEL; self.runs.first().map_or(0, |run| run.0.min(faces))];
        for (i, (start, key)) in self.runs.iter().enumerate() {
            let end = self.runs.get(i + 1).map_or(faces, |next| next.0);
            if *start == end {
                continue;
            }
            let index = *of_key.entry(key).or_insert_with(|| match label(key) {
                None => NO_LABEL,
                Some(label) => *of_label.entry(label.clone()).or_insert_with(|| {
                    labels.push(label);
                    labels.len() as u32 - 1
                }),
            });
            of_face.resize(end, index);
        }
        if labels.is_empty() {
            return Ok(Labels::default());
        }
        Labels::new(labels, of_face)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_become_one_label_per_face() {
        let mut runs = Runs::default();
        runs.start(0, "unused");
        runs.start(0, "b");
        runs.start(2, "a");
        runs.start(3, "");
        runs.start(4, "b");
        let name = |key: &&str| (!key.is_empty()).then(|| key.to_string());
        let labels = runs.finish(5, name).unwrap();
        assert_eq!(labels.labels(), ["b", "a"]);
        assert_eq!(labels.of_face().as_slice(), [0, 0, 1, NO_LABEL, 0]);
    }

    #[test]
    fn faces_before_the_first_run_have_none() {
        let mut runs = Runs::default();
        runs.start(1, "a");
        let labels = runs.finish(2, |key| Some(key.to_string())).unwrap();
        assert_eq!(labels.of_face().as_slice(), [NO_LABEL, 0]);
        assert!(
            Runs::<&str>::default()
                .finish(3, |_| Some(0))
                .unwrap()
                .is_empty()
        );
    }
}
