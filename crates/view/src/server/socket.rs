//! A page's socket: everything new to it, and its requests from it.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use axum::Extension;
use axum::extract::State;
use axum::extract::ws::{Message, Utf8Bytes, WebSocket, WebSocketUpgrade};
use axum::response::Response;
use tokio::sync::mpsc;

use super::Room;
use super::guard::Caller;
use super::pairings::Visit;
use crate::hub::{Hub, PageId, text};
use crate::protocol::{FromPage, Level, Notice, Shares, Sharing, ToPage};

/// Requests are some hundred bytes.
const MOST_BYTES: usize = 64 << 10;

/// Answers that a page has not taken yet.
const MOST_ANSWERS: usize = 256;

/// How often a page is asked whether it is still there.
const PING: Duration = Duration::from_secs(20);

/// What a page asks for, and the way to answer it alone.
pub struct Asking {
    /// Which page asks.
    pub page: PageId,
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

pub(super) async fn socket(
    State(room): State<Room>,
    Extension(caller): Extension<Caller>,
    upgrade: WebSocketUpgrade,
) -> Response {
    upgrade
        .max_message_size(MOST_BYTES)
        .max_frame_size(MOST_BYTES)
        .on_upgrade(move |socket| async move {
            let _ = attend(socket, room, caller).await;
        })
}

/// A page, as long as its address holds.
async fn attend(mut socket: WebSocket, room: Room, caller: Caller) -> Result<(), axum::Error> {
    let Caller::Device(id) = caller else {
        return talk(socket, room, caller).await;
    };
    let Some(mut visit) = room
        .pairings
        .as_ref()
        .and_then(|pairings| pairings.visit(id))
    else {
        return Ok(());
    };
    let may_edit = room.may_edit(caller);
    send(&mut socket, vec![text(&ToPage::Access { may_edit })]).await?;
    tokio::select! {
        talked = talk(socket, room, caller) => talked,
        () = Visit::taken_back(&mut visit) => Ok(()),
    }
}

/// A page that is open until this is dropped, whichever way that comes about.
struct Presence {
    hub: Arc<Hub>,
    page: PageId,
}

impl Presence {
    fn new(hub: &Arc<Hub>) -> Self {
        let (hub, page) = (Arc::clone(hub), hub.open());
        Self { hub, page }
    }
}

impl Drop for Presence {
    fn drop(&mut self) {
        self.hub.close(self.page);
    }
}

/// Until the page goes.
async fn talk(mut socket: WebSocket, room: Room, caller: Caller) -> Result<(), axum::Error> {
    let hub: Arc<Hub> = Arc::clone(&room.desk.hub);
    let presence = Presence::new(&hub);
    let page = presence.page;
    let mut bell = hub.bell();
    bell.mark_unchanged();
    let (texts, mut told) = hub.first();
    let texts = texts.into_iter().map(|text| for_caller(text, caller));
    send(&mut socket, texts.collect()).await?;
    let (answers, mut answered) = mpsc::channel(MOST_ANSWERS);
    let reply = Reply { answers };
    let mut ping = tokio::time::interval(PING);
    loop {
        tokio::select! {
            rung = bell.changed() => {
                if rung.is_err() {
                    return Ok(());
                }
                let (texts, count) = hub.since(page, told);
                told = count;
                send(&mut socket, texts).await?;
            }
            Some(answer) = answered.recv() => send(&mut socket, vec![answer]).await?,
            _ = ping.tick() => socket.send(Message::Ping(Vec::new().into())).await?,
            come = socket.recv() => {
                let Some(come) = come else {
                    return Ok(());
                };
                if take(come?, &room, (page, caller), &reply).is_break() {
                    return Ok(());
                }
            }
        }
    }
}

/// A message as that caller may read it: who speaks to a device does not say in
/// which folder the graph is.
fn for_caller(text: Utf8Bytes, caller: Caller) -> Utf8Bytes {
    if matches!(caller, Caller::Device(_))
        && let Ok(mut message) = serde_json::from_str(&text)
        && without_place(&mut message)
    {
        return message.to_string().into();
    }
    text
}

/// Takes out of a message where the graph is; `false` if it does not say so.
pub(super) fn without_place(message: &mut serde_json::Value) -> bool {
    let says_so = message["type"] == "hello";
    if says_so {
        message["folder"] = "".into();
    }
    says_so
}

async fn send(socket: &mut WebSocket, texts: Vec<Utf8Bytes>) -> Result<(), axum::Error> {
    for text in texts {
        socket.send(Message::Text(text)).await?;
    }
    Ok(())
}

/// Passes a request on.
fn take(
    message: Message,
    room: &Room,
    (page, caller): (PageId, Caller),
    reply: &Reply,
) -> ControlFlow<()> {
    let text = match message {
        Message::Text(text) => text,
        Message::Close(_) => return ControlFlow::Break(()),
        // Pings are answered below this.
        Message::Ping(_) | Message::Pong(_) => return ControlFlow::Continue(()),
        Message::Binary(_) => Utf8Bytes::default(),
    };
    if let (Ok(sharing), Caller::Owner { may_edit: true }) = (serde_json::from_str(&text), caller) {
        share(sharing, room, reply);
        return ControlFlow::Continue(());
    }
    let refusal = match serde_json::from_str::<FromPage>(&text) {
        Ok(request) if request.is_change() && !room.may_edit(caller) => {
            let told = "this page can only look: it may be on another machine".to_owned();
            refuse(reply, Level::Warning, told);
            None
        }
        Ok(request) => {
            let reply = reply.clone();
            let is_taken = (room.desk.ask)(Asking {
                page,
                request,
                reply,
            });
            (!is_taken).then(|| "too many requests at once; one was left out".to_owned())
        }
        Err(error) => Some(format!(
            "the page sent something that is no request: {error}"
        )),
    };
    if let Some(text) = refusal {
        refuse(reply, Level::Error, text);
    }
    ControlFlow::Continue(())
}

fn refuse(reply: &Reply, level: Level, text: String) {
    reply.send(&ToPage::Notice(Notice { level, text }));
}

/// Sees to what the owner wants of devices, and tells how things stand.
fn share(sharing: Sharing, room: &Room, reply: &Reply) {
    let mut shares = Shares::default();
    if let Some(pairings) = &room.pairings {
        match sharing {
            Sharing::Shares => {}
            Sharing::Pair => {
                if let Err(error) = pairings.pair() {
                    let text = format!("no device was paired: {error}");
                    refuse(reply, Level::Warning, text);
                }
            }
            Sharing::Unpair { id } => pairings.unpair(id),
        }
        shares = pairings.shares();
    }
    reply.send(&ToPage::Shares(shares));
}
