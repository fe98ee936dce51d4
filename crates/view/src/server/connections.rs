//! Connections: so many and no more, and none of them for ever.

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio_io_timeout::TimeoutStream;

/// A browser opens six; the rest is for several pages.
const MOST_CONNECTIONS: usize = 64;

/// Bytes of a request's head.
const MOST_HEAD: usize = 16 << 10;

/// How long a head may take to come.
const HEAD_TIME: Duration = Duration::from_secs(10);

/// How long nothing at all may come: pages answer a ping more often.
const READ_TIME: Duration = Duration::from_secs(60);

/// How long nothing may be taken of what is sent.
const WRITE_TIME: Duration = Duration::from_secs(30);

/// After a failure of the system to give a connection.
const PAUSE: Duration = Duration::from_millis(50);

/// Serves whoever comes, for ever.
pub(super) async fn accept(listener: &TcpListener, app: Router) {
    let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        // Without a place the connection is closed at once.
        if let Ok(place) = Arc::clone(&places).try_acquire_owned() {
            let app = app.clone();
            tokio::spawn(async move {
                serve(stream, app).await;
                drop(place);
            });
        }
    }
}

async fn serve(stream: TcpStream, app: Router) {
    // Small messages must not wait for more.
    let _ = stream.set_nodelay(true);
    let mut stream = TimeoutStream::new(stream);
    stream.set_read_timeout(Some(READ_TIME));
    stream.set_write_timeout(Some(WRITE_TIME));
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_TIME)
        .max_buf_size(MOST_HEAD)
        .serve_connection(
            TokioIo::new(Box::pin(stream)),
            TowerToHyperService::new(app),
        )
        .with_upgrades()
        .await;
    // Whoever is at fault is gone.
    drop(served);
}
