//! The server: one address on this machine, one secret in it.

mod connections;
mod guard;
mod pages;
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
}

/// A running server; it ends when this is dropped.
pub struct Server {
    address: SocketAddr,
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
        let listener = listen(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let app = app(address, &token, desk);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        let (stop, stopped) = oneshot::channel();
        let serve = move || {
            let serving = runtime.block_on(async {
                let listener = tokio::net::TcpListener::from_std(listener)?;
                tokio::select! {
                    () = connections::accept(&listener, app) => {}
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

/// The first port that is free, or the one that is asked for.
fn listen(address: Address) -> io::Result<TcpListener> {
    let ports: RangeInclusive<u16> = match address.port {
        Some(port) => port..=port,
        None => DEFAULT_PORT..=DEFAULT_PORT + MORE_PORTS,
    };
    let mut failure = io::ErrorKind::AddrInUse.into();
    for port in ports {
        match TcpListener::bind((address.host, port)) {
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => failure = error,
            result => return result,
        }
    }
    Err(failure)
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

fn app(address: SocketAddr, token: &str, desk: Desk) -> Router {
    let guard = Arc::new(guard::Guard::new(address, token));
    Router::new()
        .route("/{token}/", get(pages::index))
        .route("/{token}/app.js", get(pages::script))
        .route("/{token}/app.css", get(pages::style))
        .route("/{token}/buffer/{name}", get(pages::buffer))
        .route("/{token}/socket", get(socket::socket))
        .with_state(desk)
        .layer(from_fn_with_state(guard, guard::check))
}
