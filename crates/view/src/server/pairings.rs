//! The addresses that were given to other devices: each with a secret of its own,
//! which can be taken back.

use std::io;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use subtle::ConstantTimeEq as _;
use tokio::sync::watch;

use super::token;
use crate::protocol::{Lan, Pairing, Shares};

/// Nobody keeps more devices apart.
const MOST: usize = 32;

/// The devices that may look, or change values, from the network.
pub(super) struct Pairings {
    address: SocketAddr,
    pub(super) may_edit: bool,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// How many there ever were.
    made: u32,
    paired: Vec<Paired>,
}

struct Paired {
    id: u32,
    token: String,
    /// Counts the pages that are open; closed when the address is taken back.
    open: watch::Sender<usize>,
}

/// A page of a device, as long as it is open.
pub(super) struct Visit {
    pairings: Arc<Pairings>,
    id: u32,
    open: watch::Receiver<usize>,
}

impl Pairings {
    pub(super) fn new(address: SocketAddr, may_edit: bool) -> Self {
        let state = Mutex::default();
        Self {
            address,
            may_edit,
            state,
        }
    }

    /// Makes an address for another device.
    ///
    /// # Errors
    /// When there are too many, and when the system has no random numbers.
    pub(super) fn pair(&self) -> io::Result<()> {
        let token = token()?;
        let mut state = self.state();
        if state.paired.len() >= MOST {
            let reason = format!("{MOST} devices are paired; take one back first");
            return Err(io::Error::other(reason));
        }
        state.made += 1;
        let (id, open) = (state.made, watch::Sender::new(0));
        state.paired.push(Paired { id, token, open });
        Ok(())
    }

    /// Takes an address back; pages that are open there end.
    pub(super) fn unpair(&self, id: u32) {
        self.state().paired.retain(|paired| paired.id != id);
    }

    /// The device with that secret.
    pub(super) fn find(&self, given: &str) -> Option<u32> {
        let state = self.state();
        let is_it = |paired: &&Paired| bool::from(paired.token.as_bytes().ct_eq(given.as_bytes()));
        state.paired.iter().find(is_it).map(|paired| paired.id)
    }

    /// A page of a device is opened; `None` if its address was taken back.
    pub(super) fn visit(self: &Arc<Self>, id: u32) -> Option<Visit> {
        let state = self.state();
        let paired = state.paired.iter().find(|paired| paired.id == id)?;
        paired.open.send_modify(|count| *count += 1);
        let open = paired.open.subscribe();
        drop(state);
        let pairings = Arc::clone(self);
        Some(Visit { pairings, id, open })
    }

    /// What the owner is told.
    pub(super) fn shares(&self) -> Shares {
        let address = format!("http://{}/", self.address);
        let state = self.state();
        let pairings = state.paired.iter().map(|paired| Pairing {
            id: paired.id,
            url: format!("{address}{}/", paired.token),
            connected: *paired.open.borrow(),
        });
        Shares {
            pairings: pairings.collect(),
            lan: Some(Lan {
                address,
                edit: self.may_edit,
            }),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Visit {
    /// Waits until the address is taken back.
    pub(super) async fn taken_back(&mut self) {
        while self.open.changed().await.is_ok() {}
    }
}

impl Drop for Visit {
    fn drop(&mut self) {
        let state = self.pairings.state();
        if let Some(paired) = state.paired.iter().find(|paired| paired.id == self.id) {
            paired
                .open
                .send_modify(|count| *count = count.saturating_sub(1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairings() -> Arc<Pairings> {
        let address = "192.168.1.7:8137".parse().unwrap();
        Arc::new(Pairings::new(address, false))
    }

    fn token_of(share: &Pairing) -> String {
        let url = share.url.strip_prefix("http://192.168.1.7:8137/").unwrap();
        url.trim_end_matches('/').to_owned()
    }

    #[test]
    fn every_device_has_a_secret_that_can_be_taken_back() {
        let pairings = pairings();
        pairings.pair().unwrap();
        pairings.pair().unwrap();
        let shares = pairings.shares();
        let [one, other] = [0, 1].map(|index| token_of(&shares.pairings[index]));
        assert_eq!(one.len(), 32);
        assert_ne!(one, other);
        assert_eq!(pairings.find(&one), Some(1));
        pairings.unpair(1);
        assert_eq!(
            (pairings.find(&one), pairings.find(&other)),
            (None, Some(2))
        );
        assert!(pairings.visit(1).is_none());
        // The number of one that is gone is not given to another.
        pairings.pair().unwrap();
        assert_eq!(pairings.shares().pairings[1].id, 3);
        for _ in 2..MOST {
            pairings.pair().unwrap();
        }
        assert!(pairings.pair().is_err());
    }

    #[tokio::test]
    async fn open_pages_are_counted_and_end_with_their_address() {
        let pairings = pairings();
        pairings.pair().unwrap();
        let mut visit = pairings.visit(1).unwrap();
        let count = || pairings.shares().pairings[0].connected;
        drop(pairings.visit(1).unwrap());
        assert_eq!(count(), 1);
        pairings.unpair(1);
        visit.taken_back().await;
    }
}
