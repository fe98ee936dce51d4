//! The server: one address on this machine, one secret in it.

mod connections;
mod guard;
mod offline;
mod pages;
mod pairings;
mod socket;

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::thread::JoinHandle;

use axum::Router;
use axum::middleware::from_fn_with_state;
use axum::routing::get;
use tokio::sync::oneshot;

pub use socket::{Asking, Reply};

use crate::buffers::Buffers;
use crate::hub::Hub;
use guard::{Caller, Guard, Keys};
use pairings::Pairings;

/// The port unless another is asked for.
pub const DEFAULT_PORT: u16 = 8137;

/// How many ports after the default one are tried.
const MORE_PORTS: u16 = 20;

/// Where to listen.
#[derive(Debug, Clone, Copy)]
pub struct Address {
    /// The address of this machine that is listened on.
    pub host: IpAddr,
    /// The port; if none is asked for, the first free one from
    /// [`DEFAULT_PORT`] on.
    pub port: Option<u16>,
    /// Where devices of the network find the page too, at the same port.
    pub network: Option<Network>,
}

/// How devices of the network are let in: each by a secret of its own that the
/// owner's page hands out.
#[derive(Debug, Clone, Copy)]
pub struct Network {
    /// This machine's address in the network.
    pub host: IpAddr,
    /// Whether devices may change values.
    pub may_edit: bool,
}

/// What the server gives out, and whom it asks.
#[derive(Clone)]
pub struct Desk {
    /// What every page is told.
    pub hub: Arc<Hub>,
    /// What pages draw.
    pub buffers: Arc<Buffers>,
    /// Is asked what a page asks for. Called on the server's own thread, it must
    /// only note the request down; `false` says that there are too many.
    pub ask: Arc<dyn Fn(Asking) -> bool + Send + Sync>,
    /// Gives the picture of a number that a study's message has named, a PNG.
    pub picture: Arc<dyn Fn(usize) -> Option<Vec<u8>> + Send + Sync>,
}

/// What requests are answered from.
#[derive(Clone)]
struct Room {
    desk: Desk,
    pairings: Option<Arc<Pairings>>,
}

impl Room {
    /// Whether somebody may change values.
    fn may_edit(&self, caller: Caller) -> bool {
        match caller {
            Caller::Owner { may_edit } => may_edit,
            Caller::Device(_) => {
                let pairings = self.pairings.as_ref();
                pairings.is_some_and(|pairings| pairings.may_edit)
            }
        }
    }
}

/// A running server; it ends when this is dropped.
pub struct Server {
    address: SocketAddr,
    network: Option<SocketAddr>,
    token: String,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Listens, and serves on a thread of its own whoever knows `token`: 32
    /// hexadecimal digits, as [`token`] makes them.
    ///
    /// # Errors
    /// When the port is taken, and whatever else the system says.
    pub fn start(address: Address, token: String, desk: Desk) -> io::Result<Self> {
        let (listener, outer) = listen(address)?;
        let network = address.network;
        let address = listener.local_addr()?;
        let outside = outer.as_ref().map(TcpListener::local_addr).transpose()?;
        let pairings = network.zip(outside).map(|(network, address)| {
            let pairings = Pairings::new(address, network.may_edit);
            Arc::new(pairings)
        });
        let room = Room { desk, pairings };
        let outer = outer.zip(outside).zip(room.pairings.clone());
        let outer = outer.map(|((listener, address), pairings)| {
            let guard = Guard::new(address, Keys::Paired(pairings));
            (listener, app(guard, room.clone()))
        });
        let app = app(Guard::new(address, Keys::Owner(token.clone())), room);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        let (stop, stopped) = oneshot::channel();
        let serve = move || {
            let serving = runtime.block_on(async {
                tokio::select! {
                    served = accept(listener, app) => served?,
                    served = accept_from_network(outer) => served?,
                    // Also when the sender is gone.
                    _ = stopped => {}
                }
                io::Result::Ok(())
            });
            // Without an event queue of the system nothing is served; pages find
            // nobody there and say so.
            drop(serving);
            runtime.shutdown_background();
        };
        let thread = std::thread::Builder::new()
            .name("page".to_owned())
            .spawn(serve)?;
        Ok(Self {
            address,
            network: outside,
            token,
            stop: Some(stop),
            thread: Some(thread),
        })
    }

    /// The address of the page, with its secret.
    pub fn url(&self) -> String {
        let mut address = self.address;
        if address.ip().is_unspecified() {
            // Every address of this machine: this one is always among them.
            address.set_ip(Ipv4Addr::LOCALHOST.into());
        }
        format!("http://{address}/{}/", self.token)
    }

    /// Where devices of the network find it, without a secret.
    pub fn network(&self) -> Option<SocketAddr> {
        self.network
    }

    /// The secret that pages must know.
    pub fn token(&self) -> &str {
        &self.token
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.take();
        if let Some(thread) = self.thread.take() {
            // A panic there has ended the serving, which is what is wanted.
            let _ = thread.join();
        }
    }
}

async fn accept(listener: TcpListener, app: Router) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener)?;
    connections::accept(&listener, app).await;
    Ok(())
}

/// For ever, also where nobody comes from the network.
async fn accept_from_network(outer: Option<(TcpListener, Router)>) -> io::Result<()> {
    match outer {
        Some((listener, app)) => accept(listener, app).await,
        None => std::future::pending().await,
    }
}

/// Listens at the first port that is free, or the one that is asked for; for the
/// network at the same.
fn listen(address: Address) -> io::Result<(TcpListener, Option<TcpListener>)> {
    let ports: RangeInclusive<u16> = match address.port {
        Some(port) => port..=port,
        None => DEFAULT_PORT..=DEFAULT_PORT + MORE_PORTS,
    };
    let mut failure = io::ErrorKind::AddrInUse.into();
    for port in ports {
        match listen_at(address, port) {
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => failure = error,
            result => return result,
        }
    }
    Err(failure)
}

fn listen_at(address: Address, port: u16) -> io::Result<(TcpListener, Option<TcpListener>)> {
    let listener = TcpListener::bind((address.host, port))?;
    listener.set_nonblocking(true)?;
    let port = listener.local_addr()?.port();
    let outer = address.network.map(|network| -> io::Result<TcpListener> {
        let outer = TcpListener::bind((network.host, port))?;
        outer.set_nonblocking(true)?;
        Ok(outer)
    });
    Ok((listener, outer.transpose()?))
}

/// 128 random bits as 32 hexadecimal digits.
///
/// # Errors
/// When the system has none.
pub fn token() -> io::Result<String> {
    let mut bits = [0; 16];
    getrandom::fill(&mut bits).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(bits.iter().map(|byte| format!("{byte:02x}")).collect())
}

fn app(guard: Guard, room: Room) -> Router {
    let guard = Arc::new(guard);
    Router::new()
        .route("/{token}/", get(pages::index))
        .route("/{token}/app.js", get(pages::script))
        .route("/{token}/app.css", get(pages::style))
        .route("/{token}/offline/{version}", get(offline::offline))
        .route("/{token}/picture/{number}", get(pages::picture))
        .route("/{token}/buffer/{name}", get(pages::buffer))
        .route("/{token}/socket", get(socket::socket))
        .with_state(room)
        .layer(from_fn_with_state(guard, guard::check))
}
