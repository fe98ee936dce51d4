//! With whom the page is shared.

use serde::{Deserialize, Serialize};

/// With whom the page is shared.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Shares {
    /// Where devices of the network find it, if they may.
    pub lan: Option<Lan>,
    /// The devices.
    pub pairings: Vec<Pairing>,
}

/// Where devices of the network find the page.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Lan {
    /// The address, without a secret.
    pub address: String,
    /// Whether they may change values.
    pub edit: bool,
}

/// A device that was given an address.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Pairing {
    /// Its number.
    pub id: u32,
    /// Its address, with its secret.
    pub url: String,
    /// Pages that are open there.
    pub connected: usize,
}

/// What the owner's page asks about sharing; the server sees to it itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Sharing {
    /// With whom it is shared.
    Shares,
    /// Give another device an address.
    Pair,
    /// Take an address back.
    Unpair {
        /// The device's number.
        id: u32,
    },
}
