//! A page's socket: everything new to it, and its requests from it.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use axum::extract::State;
use axum::extract::ws::{Message, Utf8Bytes, WebSocket, WebSocketUpgrade};
use axum::response::Response;
use tokio::sync::mpsc;

use super::Desk;
use crate::hub::{Hub, text};
use crate::protocol::{FromPage, Level, Notice, ToPage};

/// Requests are some hundred bytes.
const MOST_BYTES: usize = 64 << 10;

/// Answers that a page has not taken yet.
const MOST_ANSWERS: usize = 256;

/// How often a page is asked whether it is still there.
const PING: Duration = Duration::from_secs(20);

/// What a page asks for, and the way to answer it alone.
pub struct Asking {
    /// What it asks for.
    pub request: FromPage,
    /// The way back.
    pub reply: Reply,
}

/// The way back to the page that asked.
#[derive(Clone)]
pub struct Reply {
    answers: mpsc::Sender<Utf8Bytes>,
}

impl Reply {
    /// Answers, unless the page is gone or takes nothing any more.
    pub fn send(&self, message: &ToPage) {
        let _ = self.answers.try_send(text(message));
    }
}

pub(super) async fn socket(State(desk): State<Desk>, upgrade: WebSocketUpgrade) -> Response {
    upgrade
        .max_message_size(MOST_BYTES)
        .max_frame_size(MOST_BYTES)
        .on_upgrade(|socket| async move {
            let _ = talk(socket, desk).await;
        })
}

/// Until the page goes.
async fn talk(mut socket: WebSocket, desk: Desk) -> Result<(), axum::Error> {
    let hub: Arc<Hub> = Arc::clone(&desk.hub);
    let mut bell = hub.bell();
    bell.mark_unchanged();
    let (texts, mut told) = hub.first();
    send(&mut socket, texts).await?;
    let (answers, mut answered) = mpsc::channel(MOST_ANSWERS);
    let reply = Reply { answers };
    let mut ping = tokio::time::interval(PING);
    loop {
        tokio::select! {
            rung = bell.changed() => {
                if rung.is_err() {
                    return Ok(());
                }
                let (texts, count) = hub.since(told);
                told = count;
                send(&mut socket, texts).await?;
            }
            Some(answer) = answered.recv() => send(&mut socket, vec![answer]).await?,
            _ = ping.tick() => socket.send(Message::Ping(Vec::new().into())).await?,
            come = socket.recv() => {
                let Some(come) = come else {
                    return Ok(());
                };
                if take(come?, &desk, &reply).is_break() {
                    return Ok(());
                }
            }
        }
    }
}

async fn send(socket: &mut WebSocket, texts: Vec<Utf8Bytes>) -> Result<(), axum::Error> {
    for text in texts {
        socket.send(Message::Text(text)).await?;
    }
    Ok(())
}

/// Passes a request on.
fn take(message: Message, desk: &Desk, reply: &Reply) -> ControlFlow<()> {
    let text = match message {
        Message::Text(text) => text,
        Message::Close(_) => return ControlFlow::Break(()),
        // Pings are answered below this.
        Message::Ping(_) | Message::Pong(_) => return ControlFlow::Continue(()),
        Message::Binary(_) => Utf8Bytes::default(),
    };
    let refusal = match serde_json::from_str(&text) {
        Ok(request) => {
            let reply = reply.clone();
            let is_taken = (desk.ask)(Asking { request, reply });
            (!is_taken).then(|| "too many requests at once; one was left out".to_owned())
        }
        Err(error) => Some(format!(
            "the page sent something that is no request: {error}"
        )),
    };
    if let Some(text) = refusal {
        let level = Level::Error;
        reply.send(&ToPage::Notice(Notice { level, text }));
    }
    ControlFlow::Continue(())
}
