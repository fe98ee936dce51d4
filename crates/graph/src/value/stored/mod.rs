//! How each type of value is written to the cache and read back.

mod geometry;
mod tables;

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use tessgraph_geometry::Quantity;

use super::encode::{Decoder, Encoder};
use crate::expr::Formula;

/// A type of value that the cache can keep on disk.
pub trait Stored: Sized {
    /// Writes the value; `false` if this type is never stored.
    fn encode(&self, out: &mut Encoder) -> bool;

    /// The value that [`Stored::encode`] wrote; `None` for any other bytes.
    fn decode(from: &mut Decoder<'_>) -> Option<Self>;
}

impl Stored for bool {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.byte(u8::from(*self));
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        match from.byte()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl Stored for i64 {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.number(self.cast_unsigned());
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        from.number().map(u64::cast_signed)
    }
}

impl Stored for f64 {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.float(*self);
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        from.float()
    }
}

impl Stored for Arc<str> {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.text(self);
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        from.text().map(Self::from)
    }
}

impl Stored for &'static str {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.text(self);
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        choice_name(from.text()?)
    }
}

/// A choice's name as a static text. Names are few and short, and each is
/// leaked once at most.
fn choice_name(name: &str) -> Option<&'static str> {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    const LONGEST: usize = 64;
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return Some(known);
    }
    (name.len() <= LONGEST).then(|| {
        let name: &'static str = Box::leak(name.into());
        names.insert(name);
        name
    })
}

impl Stored for DVec3 {
    fn encode(&self, out: &mut Encoder) -> bool {
        out.float(self.x).float(self.y).float(self.z);
        true
    }

    fn decode(from: &mut Decoder<'_>) -> Option<Self> {
        Some(Self::new(from.float()?, from.float()?, from.float()?))
    }
}

impl Stored for Arc<Formula> {
    /// A formula is only ever written in a graph; no node gives one.
    fn encode(&self, _: &mut Encoder) -> bool {
        false
    }

    fn decode(_: &mut Decoder<'_>) -> Option<Self> {
        None
    }
}

/// All quantities; the place in this list is what stands in files.
const QUANTITIES: [Quantity; 5] = [
    Quantity::Number,
    Quantity::Length,
    Quantity::Area,
    Quantity::Volume,
    Quantity::Angle,
];

fn quantity_tag(quantity: Quantity) -> u8 {
    match quantity {
        Quantity::Number => 0,
        Quantity::Length => 1,
        Quantity::Area => 2,
        Quantity::Volume => 3,
        Quantity::Angle => 4,
    }
}

fn quantity_of(tag: u8) -> Option<Quantity> {
    QUANTITIES.get(usize::from(tag)).copied()
}
