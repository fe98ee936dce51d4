//! `view`: the live page of a graph.
//!
//! It shows, and writes only the one value of the graph file that somebody has
//! changed on the page. Outputs are made by `run`.

mod args;
mod asked;
mod edits;
mod network;
mod preview;
mod problems;
mod requests;
mod secret;
mod sights;
mod studio;
mod study;
mod viewer;

use args::Lan;
pub(crate) use args::ViewArgs;

use std::sync::{Arc, PoisonError};

use tessgraph_view::{Address, Buffers, Desk, Hub, Server};

use super::{Context, FAILED, USAGE, status};
use crate::diagnostics::print;
use crate::graph_file::GraphFile;
use crate::interrupt;
use crate::watch::{Mailbox, Message, Watched, follow, resume};
use requests::Requests;
use studio::Studio;
use viewer::{Pictures, Viewer};

/// The share of the cache's memory that buffers nobody names any more may take.
const BUFFER_SHARE: u64 = 4;

/// And more than this is of no use: they are made again in milliseconds, and in
/// memory that was used before rather than in new pages.
const MOST_BUFFERS: u64 = 64 << 20;

/// Carries the command out.
pub(crate) fn view(args: &ViewArgs, cx: &mut Context<'_, '_>) -> u8 {
    if let Some(status) = wrong_settings(args, cx) {
        return status;
    }
    let studio = match Studio::new(args, cx.registry, cx.cache.as_deref()) {
        Ok(studio) => studio,
        Err(message) => {
            let help = Some("ask for fewer with `--threads`".to_owned());
            return cx.fail(FAILED, "threads", message, help);
        }
    };
    let mailbox = Mailbox::new();
    let post = mailbox.post();
    interrupt::on_request(move || {
        // Nobody may be listening any more.
        let _ = post.send(Message::Stop);
    });
    let budget = (studio.memory() / BUFFER_SHARE).min(MOST_BUFFERS);
    let budget = usize::try_from(budget).unwrap_or(usize::MAX);
    let (hub, buffers) = (Arc::new(Hub::default()), Arc::new(Buffers::new(budget)));
    let requests = Arc::new(Requests::new(mailbox.post()));
    let taking = Arc::clone(&requests);
    let pictures = Pictures::default();
    let listed = Arc::clone(&pictures);
    let desk = Desk {
        hub: Arc::clone(&hub),
        buffers: Arc::clone(&buffers),
        ask: Arc::new(move |asking| taking.put(asking)),
        picture: Arc::new(move |number| {
            let paths = listed.lock().unwrap_or_else(PoisonError::into_inner);
            let path = paths.get(number).cloned();
            drop(paths);
            study::picture(&path?)
        }),
    };
    // Told before anybody can ask.
    let viewer = Viewer::new(args, &studio, requests, pictures, hub, buffers);
    let server = match serve(args, cx, desk) {
        Ok(server) => server,
        Err(status) => return status,
    };
    let port = format!("--resume-port={}", server.address().port());
    resume::arm(vec![port.into()], vec![(secret::VARIABLE, server.token())]);
    if args.resume.is_none() {
        announce(args, &server, cx);
    }
    let watched = Watched {
        graph: &args.graph,
        allowed: &args.engine.allow,
        poll: args.poll,
    };
    let waits = || {
        args.resume
            .is_some_and(|began| resume::waits(&args.graph, began))
    };
    let status = follow(&watched, waits, &mailbox, viewer);
    drop(server);
    studio.close();
    status
}

/// The exit status, if the graph takes no such values as the command line gives.
/// Whatever else is wrong with it, the page will show.
fn wrong_settings(args: &ViewArgs, cx: &mut Context<'_, '_>) -> Option<u8> {
    if args.set.is_empty() {
        return None;
    }
    let opened = GraphFile::open(&args.graph, cx.registry, &args.set, &args.engine.allow);
    let diagnostics = opened.err().filter(|found| status(found) == USAGE)?;
    print(cx.console, &diagnostics);
    Some(USAGE)
}

/// Starts the server, or says why not.
fn serve(args: &ViewArgs, cx: &mut Context<'_, '_>, desk: Desk) -> Result<Server, u8> {
    let network = args
        .lan
        .map(network::network)
        .transpose()
        .map_err(|error| {
            let message = format!("this machine has no address in a local network: {error}");
            let help = "leave `--lan` out, or join a network first".to_owned();
            cx.fail(FAILED, "no_network", message, Some(help))
        })?;
    let address = Address {
        host: args.host,
        port: args.resume_port.or(args.port),
        network,
    };
    let started = secret::chosen(&args.graph, cx.cache.as_deref())
        .and_then(|token| Server::start(address, token, desk));
    started.map_err(|error| {
        let (message, help) = match args.port {
            Some(port) if error.kind() == std::io::ErrorKind::AddrInUse => (
                format!("port {port} is taken"),
                "name another one, or leave `--port` out to have a free one found".to_owned(),
            ),
            _ => (
                format!("cannot serve the page on {}: {error}", args.host),
                "free ports are looked for from 8137 on; name another one with `--port`".to_owned(),
            ),
        };
        cx.fail(FAILED, "no_server", message, Some(help))
    })
}

/// Says where the page is, and opens it.
fn announce(args: &ViewArgs, server: &Server, cx: &mut Context<'_, '_>) {
    if !args.host.is_loopback() {
        let warning = format!(
            "warning: the page can be reached from other machines at {}; whoever has its address \
             can look, and nobody can change anything\n",
            server.address()
        );
        cx.console.note(&warning);
    }
    if let Some(address) = server.network() {
        let may = match args.lan {
            Some(Lan::Edit) => "look and change values",
            _ => "only look",
        };
        let note = format!(
            "note: devices of your network can {may} at http://{address}/ once you pair them under \
             Share on the page; the connection is not encrypted\n"
        );
        cx.console.note(&note);
    }
    let url = server.url();
    cx.console.data(&format!("{url}\n"));
    if !args.no_open
        && let Err(error) = open::that_detached(&url)
    {
        let note = format!("note: no browser could be opened: {error}; open the address above\n");
        cx.console.note(&note);
    }
    cx.console.note("the page follows the graph; Ctrl-C ends\n");
}
