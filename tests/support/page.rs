//! A server of the live page as a process of its own, and clients of it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::{Message, WebSocket};

use super::program::program;

/// Far more than anything takes, on the busiest machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A process that serves a page; it is killed when this is dropped.
pub(crate) struct Server {
    pub(crate) child: Child,
    pub(crate) address: SocketAddr,
    /// The secret in the page's address.
    pub(crate) token: String,
}

/// What came back for a request.
pub(crate) struct Answer {
    pub(crate) status: u16,
    /// Names in lower case.
    pub(crate) headers: Vec<(String, String)>,
    pub(crate) body: Vec<u8>,
}

/// A page's socket.
pub(crate) struct Page {
    socket: WebSocket<TcpStream>,
}

impl Server {
    /// Serves the graph that is named from the folder, with a cache there.
    pub(crate) fn start(folder: &Path, graph: &str, arguments: &[&str]) -> Self {
        Self::try_start(folder, graph, arguments).unwrap_or_else(|told| panic!("{told}"))
    }

    /// The same at a port of the system's choice.
    ///
    /// # Errors
    /// What it said before it ended.
    pub(crate) fn try_start(
        folder: &Path,
        graph: &str,
        arguments: &[&str],
    ) -> Result<Self, String> {
        let mut child = Command::new(program())
            .args(["view", graph, "--no-open"])
            .args(arguments)
            .current_dir(folder)
            .env("TESSGRAPH_CACHE", folder.join("the-cache"))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let out = child.stdout.take().expect("a pipe");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let parts = line.trim().strip_prefix("http://").unwrap_or_default();
        let Some((address, token)) = parts.split_once('/') else {
            let mut told = String::new();
            let err = child.stderr.as_mut().expect("a pipe");
            err.read_to_string(&mut told).expect("text");
            let status = child.wait().expect("it ends");
            return Err(format!("{status}: {told}"));
        };
        Ok(Self {
            address: address.parse().expect("an address"),
            token: token.trim_end_matches('/').to_owned(),
            child,
        })
    }

    /// A connection that gives up in the end.
    pub(crate) fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.address.port())).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        stream
    }

    /// Sends these bytes; what comes back, if an answer does.
    pub(crate) fn raw(&self, request: &str) -> Option<Answer> {
        let mut stream = self.connect();
        // It may hang up before everything is sent.
        let _ = stream.write_all(request.as_bytes());
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        answer(&bytes)
    }

    /// Asks for a path with further header lines, each with its line end.
    pub(crate) fn request(&self, method: &str, path: &str, headers: &str) -> Answer {
        let host = self.host();
        self.raw(&format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{headers}\r\n"
        ))
        .unwrap_or_else(|| panic!("no answer to {method} {path}"))
    }

    /// Asks for something below the secret.
    pub(crate) fn get(&self, name: &str) -> Answer {
        self.request("GET", &format!("/{}/{name}", self.token), "")
    }

    /// The host as a browser names it.
    pub(crate) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.address.port())
    }

    /// The same server by another address and secret, as a paired device sees it;
    /// what comes back for a path below the secret.
    pub(crate) fn get_at(host: &str, token: &str, name: &str) -> Answer {
        let mut stream = TcpStream::connect(host).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let head =
            format!("GET /{token}/{name} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        let _ = stream.write_all(head.as_bytes());
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        answer(&bytes).expect("an answer")
    }

    /// Opens the page's socket at an address that a device was given.
    pub(crate) fn open_at(url: &str) -> Page {
        let host = url
            .trim_start_matches("http://")
            .split('/')
            .next()
            .expect("a host");
        let stream = TcpStream::connect(host).expect("a server");
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let url = url.replace("http://", "ws://") + "socket";
        let (socket, _) = tungstenite::client(url, stream).expect("a socket");
        Page { socket }
    }

    /// Opens the page's socket.
    pub(crate) fn open(&self) -> Page {
        self.try_open().expect("a socket")
    }

    /// Opens the page's socket, if there is a server.
    pub(crate) fn try_open(&self) -> Option<Page> {
        let stream = TcpStream::connect(("127.0.0.1", self.address.port())).ok()?;
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let url = format!("ws://{}/{}/socket", self.host(), self.token);
        let (socket, _) = tungstenite::client(url, stream).ok()?;
        Some(Page { socket })
    }

    /// The content of a buffer that a message names.
    pub(crate) fn buffer(&self, name: &Value) -> Vec<u8> {
        let name = name.as_str().expect("a name");
        let answer = self.get(&format!("buffer/{name}"));
        assert_eq!(answer.status, 200, "{name}");
        answer.body
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn answer(bytes: &[u8]) -> Option<Answer> {
    let end = bytes.windows(4).position(|part| part == b"\r\n\r\n")?;
    let head = std::str::from_utf8(&bytes[..end]).expect("a head is text");
    let mut lines = head.lines();
    let status = lines.next()?.split(' ').nth(1)?;
    let header = |line: &str| {
        let (name, value) = line.split_once(": ").expect("a header");
        (name.to_lowercase(), value.to_owned())
    };
    Some(Answer {
        status: status.parse().expect("a number"),
        headers: lines.map(header).collect(),
        body: bytes[end + 4..].to_vec(),
    })
}

impl Answer {
    /// The value of a header that stands there once.
    pub(crate) fn header(&self, name: &str) -> &str {
        let mut found = self.headers.iter().filter(|(other, _)| other == name);
        let value = found.next().unwrap_or_else(|| panic!("no {name}"));
        assert!(found.next().is_none(), "{name} twice");
        &value.1
    }
}

impl Page {
    /// Asks for something.
    pub(crate) fn ask(&mut self, request: &Value) {
        self.send(Message::text(request.to_string()))
            .expect("a server");
    }

    /// Sends a message of any kind.
    pub(crate) fn send(&mut self, message: Message) -> tungstenite::Result<()> {
        self.socket.send(message)
    }

    /// The next message.
    ///
    /// # Panics
    /// If none comes in time: signs of life of the server alone are none.
    pub(crate) fn next(&mut self) -> tungstenite::Result<Value> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            assert!(Instant::now() < deadline, "no message within {PATIENCE:?}");
            match self.socket.read()? {
                Message::Text(text) => return Ok(serde_json::from_str(&text).expect("JSON")),
                Message::Close(_) => return Err(tungstenite::Error::ConnectionClosed),
                _ => {}
            }
        }
    }

    /// The next message of that type which is as it should be; others are passed
    /// over.
    pub(crate) fn until(&mut self, kind: &str, is_right: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + PATIENCE;
        let mut last = Value::Null;
        while Instant::now() < deadline {
            let message = self
                .next()
                .unwrap_or_else(|error| panic!("{error}: no such {kind}; the last one was {last}"));
            if message["type"] == kind {
                if is_right(&message) {
                    return message;
                }
                last = message;
            }
        }
        panic!("no such {kind} in time; the last one was {last}")
    }

    /// The next message of that type.
    pub(crate) fn any(&mut self, kind: &str) -> Value {
        self.until(kind, |_| true)
    }

    /// Waits until what is shown is what the file says.
    pub(crate) fn until_up_to_date(&mut self) -> Value {
        self.until("status", |status| status["state"] == "up_to_date")
    }
}
