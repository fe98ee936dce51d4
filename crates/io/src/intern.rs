//! Numbering equal keys alike, in the order of first use.

/// Gives equal keys of `N` words equal numbers: 0, 1, 2, ... by first use.
///
/// An open-addressed table: a few times faster than the standard map, and
/// without its random order.
#[derive(Debug)]
pub(crate) struct Interner<const N: usize> {
    slots: Vec<u32>,
    keys: Vec<[u64; N]>,
}

const FREE: u32 = u32::MAX;

impl<const N: usize> Interner<N> {
    pub(crate) fn new() -> Self {
        Self {
            slots: vec![FREE; 64],
            keys: Vec::new(),
        }
    }

    /// The number of `key`.
    pub(crate) fn number(&mut self, key: [u64; N]) -> u32 {
        let mask = self.slots.len() - 1;
        let mut slot = hash(&key) as usize & mask;
        loop {
            match self.slots[slot] {
                FREE => break,
                known if self.keys[known as usize] == key => return known,
                _ => slot = (slot + 1) & mask,
            }
        }
        let number = self.keys.len() as u32;
        self.slots[slot] = number;
        self.keys.push(key);
        if self.keys.len() * 2 > self.slots.len() {
            self.grow();
        }
        number
    }

    /// The distinct keys, by number.
    pub(crate) fn keys(&self) -> &[[u64; N]] {
        &self.keys
    }

    fn grow(&mut self) {
        let mask = self.slots.len() * 2 - 1;
        self.slots = vec![FREE; mask + 1];
        for (number, key) in self.keys.iter().enumerate() {
            let mut slot = hash(key) as usize & mask;
            while self.slots[slot] != FREE {
                slot = (slot + 1) & mask;
            }
            self.slots[slot] = number as u32;
        }
    }
}

/// Mixes all bits of the key into the low ones (splitmix64's finaliser).
fn hash<const N: usize>(key: &[u64; N]) -> u64 {
    key.iter().fold(0x9e37_79b9_7f4a_7c15, |hash, &word| {
        let mut mixed = (hash ^ word).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed ^= mixed >> 29;
        mixed = mixed.wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_follow_first_use() {
        let mut interner = Interner::<2>::new();
        let numbers: Vec<_> = (0..10_000u64)
            .map(|i| interner.number([i % 777, i % 3]))
            .collect();
        // 777 is a multiple of 3, so the second word follows from the first.
        assert_eq!(interner.keys().len(), 777);
        assert!(
            numbers
                .iter()
                .enumerate()
                .all(|(i, &n)| n as usize == i % 777)
        );
    }
}
