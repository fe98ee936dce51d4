//! Values in memory within a byte budget.
//!
//! An own structure and not a general cache crate: those weigh each entry by
//! itself, but meshes share buffers, and a subdivided surface with three
//! attributes set one after the other would count four times.

use std::collections::{BTreeMap, BTreeSet};

use tessgraph_geometry::digest::Digest;

use crate::value::Value;

/// Bytes of a value besides its buffers; an upper guess of its bookkeeping.
const OVERHEAD: u64 = 256;

/// Values by digest. What is cheapest to compute again per byte goes first,
/// and, among equals, what was not used for longest (greedy dual size).
#[derive(Debug)]
pub(super) struct Memory {
    budget: u64,
    bytes: u64,
    /// The priority at which a value was last let go: what is used now ranks
    /// above everything that was kept only for its cost until then.
    floor: f64,
    values: BTreeMap<Digest, Held>,
    order: BTreeSet<(Priority, Digest)>,
    /// Buffers by address: how many values hold each, and its size.
    buffers: BTreeMap<usize, (usize, u64)>,
}

#[derive(Debug)]
struct Held {
    value: Value,
    /// Milliseconds per byte to compute it.
    worth: f64,
    priority: Priority,
}

/// A finite number that is not negative, ordered by its bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Priority(u64);

impl Priority {
    fn new(number: f64) -> Self {
        Self(number.max(0.0).to_bits())
    }
}

impl Memory {
    pub(super) fn new(budget: u64) -> Self {
        Self {
            budget,
            bytes: 0,
            floor: 0.0,
            values: BTreeMap::new(),
            order: BTreeSet::new(),
            buffers: BTreeMap::new(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// Bytes of all values, shared buffers counted once.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    pub(super) fn get(&mut self, digest: Digest) -> Option<Value> {
        let held = self.values.get_mut(&digest)?;
        self.order.remove(&(held.priority, digest));
        held.priority = Priority::new(self.floor + held.worth);
        self.order.insert((held.priority, digest));
        Some(held.value.clone())
    }

    /// Keeps a value that took `cost` milliseconds to compute.
    pub(super) fn insert(&mut self, digest: Digest, value: &Value, cost: f64) {
        let own = value.byte_size() as u64 + OVERHEAD;
        if own > self.budget || self.get(digest).is_some() {
            return;
        }
        self.bytes += OVERHEAD;
        for (address, bytes) in buffers_of(value) {
            let (holders, _) = self.buffers.entry(address).or_insert((0, bytes));
            *holders += 1;
            if *holders == 1 {
                self.bytes += bytes;
            }
        }
        let worth = cost.max(1e-6) / own as f64;
        let priority = Priority::new(self.floor + worth);
        self.order.insert((priority, digest));
        let value = value.clone();
        self.values.insert(
            digest,
            Held {
                value,
                worth,
                priority,
            },
        );
        while self.bytes > self.budget && self.evict() {}
    }

    /// Lets the least worthy value go; `false` if there is none.
    fn evict(&mut self) -> bool {
        let Some((priority, digest)) = self.order.pop_first() else {
            return false;
        };
        self.floor = f64::from_bits(priority.0);
        if let Some(held) = self.values.remove(&digest) {
            self.bytes -= OVERHEAD;
            for (address, _) in buffers_of(&held.value) {
                self.release(address);
            }
        }
        true
    }

    fn release(&mut self, address: usize) {
        if let Some((holders, bytes)) = self.buffers.get_mut(&address) {
            *holders -= 1;
            if *holders == 0 {
                self.bytes -= *bytes;
                self.buffers.remove(&address);
            }
        }
    }
}

/// Each buffer of a value once. A buffer lives as long as a value that holds
/// it, so its address cannot come to mean another one meanwhile.
fn buffers_of(value: &Value) -> BTreeMap<usize, u64> {
    let mut buffers = BTreeMap::new();
    value.visit_buffers(&mut |address, bytes| {
        buffers.insert(address, bytes as u64);
    });
    buffers
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tessgraph_geometry::{Attribute, AttributeValues, Domain, Field, Mesh, Quantity};

    use super::*;

    /// A field of 1000 numbers that starts with `first`.
    fn field(first: u32) -> Value {
        let values = (0..1000).map(|index| f64::from(index + first)).collect();
        let field = Field::new(Domain::Vertex, Quantity::Number, values).unwrap();
        Value::Field(Arc::new(field))
    }

    #[test]
    fn what_is_cheap_to_compute_again_goes_first() {
        let mut memory = Memory::new(3 * (8000 + OVERHEAD));
        for (first, cost) in [(0, 100.0), (1, 1.0), (2, 50.0), (3, 10.0)] {
            memory.insert(field(first).digest(), &field(first), cost);
        }
        let kept = [0, 1, 2, 3].map(|first| memory.get(field(first).digest()).is_some());
        assert_eq!(kept, [true, false, true, true]);
        assert_eq!(memory.bytes(), 3 * (8000 + OVERHEAD));
        // What is never used again leaves, however dear it was.
        for first in 4..400 {
            memory.insert(field(first).digest(), &field(first), 10.0);
        }
        assert!(memory.get(field(0).digest()).is_none());
        assert!(memory.bytes() <= 3 * (8000 + OVERHEAD));
    }

    #[test]
    fn shared_buffers_are_counted_once_and_freed_with_their_last_holder() {
        let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
        let mut mesh = Mesh::from_faces(square.to_vec(), &[[0, 1, 2, 3]]).unwrap();
        let mut memory = Memory::new(1 << 20);
        let mut expected = mesh.positions().byte_size() as u64 + 2 * 4 + 4 * 4;
        for number in 0..5 {
            let values = AttributeValues::Number(vec![f64::from(number); 4].into());
            let attribute = Attribute::new(format!("a{number}"), Domain::Vertex, values);
            mesh = mesh.with_attribute(attribute).unwrap();
            memory.insert(mesh.digest(), &Value::Mesh(Arc::new(mesh.clone())), 1.0);
            expected += 4 * 8 + OVERHEAD;
        }
        assert_eq!(memory.bytes(), expected);
        while memory.evict() {}
        assert_eq!((memory.bytes(), memory.buffers.len()), (0, 0));
    }

    #[test]
    fn a_value_larger_than_the_budget_drives_nothing_out() {
        let mut memory = Memory::new(1000);
        memory.insert(Digest::of(b"one"), &Value::Number(1.0), 1.0);
        memory.insert(field(0).digest(), &field(0), 1e9);
        assert_eq!(memory.len(), 1);
    }
}
