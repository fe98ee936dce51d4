//! The live page of tessgraph: what it is told, and the server that tells it.
//!
//! [`Server`] serves one page on this machine: three files that are part of the
//! program, raw buffers, and a socket. [`Hub`] holds what every page is told,
//! [`Buffers`] what pages draw. The modules beside them make messages from plans
//! and evaluations; no node is named here, kinds of nodes are data.
//!
//! Nothing here reads or writes a file, evaluates a graph, or prints.

mod buffers;
pub mod document;
mod hub;
pub mod outcomes;
pub mod pick;
pub mod preview;
pub mod protocol;
pub mod section;
mod server;
pub mod shown;
mod values;

pub use buffers::Buffers;
pub use hub::{Hub, PageId};
pub use server::{Address, Asking, DEFAULT_PORT, Desk, Network, Reply, Server, token};
