//! The live page: who may ask, and what for.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;
use tungstenite::Message;

use crate::support::page::Server;
use crate::support::text_of;

const GRAPH: &str = r#"Graph(version: 1, params: {"n": 3}, nodes: {"grid": Grid(cells: ["n", 1])},
    outputs: {"grid.obj": "grid"})"#;

fn serve(arguments: &[&str]) -> (tempfile::TempDir, Server) {
    serve_graph(GRAPH, &[&["--port", "0"], arguments].concat())
}

fn serve_graph(text: &str, arguments: &[&str]) -> (tempfile::TempDir, Server) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("g.ron"), text).expect("written");
    let server = Server::start(folder.path(), "g.ron", arguments);
    (folder, server)
}

/// Asks for the page with these header lines and no others.
fn with_headers(server: &Server, headers: &str) -> u16 {
    let token = &server.token;
    let request = format!("GET /{token}/ HTTP/1.1\r\nConnection: close\r\n{headers}\r\n");
    server.raw(&request).expect("an answer").status
}

#[test]
fn f107_only_this_machine_under_its_own_name() {
    let (_folder, server) = serve(&[]);
    let (host, port) = (server.host(), server.address.port());
    for (headers, status) in [
        (format!("Host: {host}\r\n"), 200),
        (format!("Host: localhost:{port}\r\n"), 200),
        (format!("Host: evil.example:{port}\r\n"), 403),
        ("Host: evil.example\r\n".to_owned(), 403),
        (format!("Host: 127.evil.example:{port}\r\n"), 403),
        (format!("Host: localhost.evil.example:{port}\r\n"), 403),
        (format!("Host: {host}.evil.example\r\n"), 403),
        ("Host: \r\n".to_owned(), 403),
        (String::new(), 403),
        (format!("Host: {host}\r\nHost: {host}\r\n"), 403),
        (format!("Host: {host}\r\nHost: evil.example\r\n"), 403),
    ] {
        assert_eq!(with_headers(&server, &headers), status, "{headers:?}");
    }
    let old = format!("GET /{}/ HTTP/1.0\r\n\r\n", server.token);
    assert_eq!(server.raw(&old).expect("an answer").status, 403);
}

const UPGRADE: &str = "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
                       Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";

#[test]
fn f108_no_page_of_another_site() {
    let (_folder, server) = serve(&[]);
    let (host, token) = (server.host(), &server.token);
    let own = format!("http://{host}");
    for origin in [
        "null",
        "http://evil.example",
        "https://evil.example",
        "",
        "file://",
    ] {
        let headers = format!("Origin: {origin}\r\n");
        let path = format!("/{token}/socket");
        let socket = server.request("GET", &path, &format!("{headers}{UPGRADE}"));
        assert_eq!(socket.status, 403, "socket for {origin:?}");
        let posted = server.request("POST", &format!("/{token}/"), &headers);
        assert_eq!(posted.status, 403, "POST from {origin:?}");
    }
    let twice = format!("Origin: {own}\r\nOrigin: {own}\r\n");
    assert_eq!(
        server.request("GET", &format!("/{token}/"), &twice).status,
        403
    );
    // The page itself may open its socket, and nobody may post anything.
    let mut stream = server.connect();
    let request = format!(
        "GET /{token}/socket HTTP/1.1\r\nHost: {host}\r\nConnection: Upgrade\r\nOrigin: {own}\r\n\
         {UPGRADE}\r\n"
    );
    stream.write_all(request.as_bytes()).expect("sent");
    let mut head = [0; 12];
    stream.read_exact(&mut head).expect("an answer");
    assert_eq!(&head, b"HTTP/1.1 101");
    let posted = server.request("POST", &format!("/{token}/"), &format!("Origin: {own}\r\n"));
    assert_eq!(posted.status, 405);
}

#[test]
fn f109_nothing_without_the_secret() {
    let (_folder, server) = serve(&[]);
    let (_other_folder, other) = serve(&[]);
    let token = &server.token;
    assert_eq!(token.len(), 32);
    assert_ne!(token, &other.token);
    let (wrong, short) = ("0".repeat(32), &token[..31]);
    let last = if token.ends_with('0') { '1' } else { '0' };
    for guess in [
        String::new(),
        wrong,
        short.to_owned(),
        format!("{short}{last}"),
        format!("{token}0"),
        token.to_uppercase() + "x",
        other.token.clone(),
    ] {
        for name in [
            "",
            "app.js",
            "app.css",
            "socket",
            "buffer/00000000000000000000000000000000",
        ] {
            let path = if guess.is_empty() {
                format!("/{name}")
            } else {
                format!("/{guess}/{name}")
            };
            assert_eq!(server.request("GET", &path, "").status, 401, "{path}");
        }
    }
    // Refusals say nothing about what would be there.
    let refusal = server.request("GET", "/", "");
    assert!(refusal.body.is_empty());
    let page = server.get("");
    assert_eq!(page.header("referrer-policy"), "no-referrer");
    let policy = page.header("content-security-policy").to_owned();
    assert!(
        policy.starts_with("default-src 'none'; script-src 'self';"),
        "{policy}"
    );
    assert!(
        policy.contains(&format!("ws://{}", server.host())),
        "{policy}"
    );
}

#[test]
fn f110_no_path_leads_to_a_file() {
    let (folder, server) = serve(&[]);
    std::fs::write(folder.path().join("secret.txt"), "secret").expect("written");
    let (token, host) = (&server.token, server.host());
    for path in [
        "/../".to_owned(),
        "/../secret.txt".to_owned(),
        "/%2e%2e/".to_owned(),
        "/..%5c".to_owned(),
        "//etc/passwd".to_owned(),
        "/?raw??".to_owned(),
        format!("/{token}/../secret.txt"),
        format!("/{token}/%2e%2e/secret.txt"),
        format!("/{token}/..%5csecret.txt"),
        format!("/{token}/..\\secret.txt"),
        format!("/{token}//etc/passwd"),
        format!("/{token}/secret.txt"),
        format!("/{token}/g.ron"),
        format!("/{token}/index.html"),
        format!("/{token}/app.js/"),
        format!("/{token}/app.js?raw??"),
        format!("/{token}/?x"),
        format!("/{token}/buffer/"),
        format!("/{token}/buffer/../app.js"),
        format!("/{token}/buffer/{}", "0".repeat(32)),
        format!("/{token}/buffer/{}", "g".repeat(32)),
        format!("http://{host}/{token}/app.js"),
        format!("http://evil.example/{token}/app.js"),
    ] {
        let answer = server.request("GET", &path, "");
        assert_eq!(answer.status, 404, "{path}");
        assert!(answer.body.is_empty(), "{path}");
    }
    // What is no target by the standard is refused as such, or its fragment is
    // not looked at.
    for (path, allowed) in [
        ("/#".to_owned(), 401),
        ("*".to_owned(), 404),
        ("file:///etc/passwd".to_owned(), 404),
        (format!("/{token}/#x"), 200),
    ] {
        let status = server.request("GET", &path, "").status;
        assert!(status == 400 || status == allowed, "{path}: {status}");
    }
}

#[test]
fn f111_no_flood_takes_it_down() {
    let (_folder, server) = serve(&[]);
    endless_head(&server);
    slow_head(&server);
    many_connections(&server);
    long_messages(&server);
    // After all that the page is there as ever.
    let deadline = Instant::now() + Duration::from_secs(30);
    while server.raw("GET / HTTP/1.1\r\n\r\n").is_none() {
        assert!(Instant::now() < deadline, "it answers nobody");
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(server.get("").status, 200);
    assert_eq!(server.open().any("shown")["mesh"]["faces"], 3);
}

/// A head without end is cut off, long before a gigabyte.
fn endless_head(server: &Server) {
    let mut stream = server.connect();
    stream.write_all(b"GET / HTTP/1.1\r\nX: ").expect("sent");
    let chunk = [b'x'; 4096];
    let taken = (0..(1 << 30) / chunk.len()).take_while(|_| stream.write_all(&chunk).is_ok());
    let taken = taken.count() * chunk.len();
    assert!(taken < 64 << 20, "{taken} bytes of a header were taken");
    let mut many = "GET / HTTP/1.1\r\n".to_owned();
    (0..10_000).for_each(|number| many += &format!("X{number}: 1\r\n"));
    let status = server.raw(&(many + "\r\n")).map(|answer| answer.status);
    assert!(matches!(status, None | Some(400..=499)), "{status:?}");
}

/// Who sends a head byte by byte is not waited for for ever.
fn slow_head(server: &Server) {
    let (start, mut stream) = (Instant::now(), server.connect());
    for byte in b"GET / HTTP/1.1\r\nX-Slow: "
        .iter()
        .chain([b'x'].iter().cycle())
    {
        std::thread::sleep(Duration::from_millis(100));
        if stream.write_all(&[*byte]).is_err() {
            break;
        }
        assert!(start.elapsed() < Duration::from_secs(30), "it still waits");
    }
}

/// Of ten thousand connections only so many are held.
fn many_connections(server: &Server) {
    let address = ("127.0.0.1", server.address.port());
    let mut open: Vec<TcpStream> = Vec::new();
    for _ in 0..10_000 {
        open.extend(TcpStream::connect(address));
        // Not all at once, for this process too may open only so many.
        if open.len() == 200 {
            open.clear();
        }
    }
    let mut held: Vec<TcpStream> = Vec::new();
    for _ in 0..200 {
        held.extend(TcpStream::connect(address));
    }
    std::thread::sleep(Duration::from_millis(500));
    let is_held = |stream: &mut TcpStream| {
        stream.set_nonblocking(true).expect("a socket");
        let read = stream.read(&mut [0]);
        read.is_err_and(|error| error.kind() == std::io::ErrorKind::WouldBlock)
    };
    let count = held
        .iter_mut()
        .filter_map(|stream| is_held(stream).then_some(()))
        .count();
    assert!((1..=64).contains(&count), "{count} connections are held");
}

/// A message of any size ends the socket before it is read.
fn long_messages(server: &Server) {
    let deadline = Instant::now() + Duration::from_secs(30);
    while server.raw("GET / HTTP/1.1\r\n\r\n").is_none() {
        assert!(Instant::now() < deadline, "it answers nobody");
        std::thread::sleep(Duration::from_millis(50));
    }
    let mut page = server.open();
    page.any("shown");
    // It may hang up while this is sent.
    let _ = page.send(Message::text("x".repeat(1 << 20)));
    assert!(std::iter::from_fn(|| page.next().ok()).count() < 100);
    // A head that announces two gigabytes.
    let mut stream = server.connect();
    let request = format!(
        "GET /{}/socket HTTP/1.1\r\nHost: {}\r\nConnection: Upgrade\r\n{UPGRADE}\r\n",
        server.token,
        server.host()
    );
    stream.write_all(request.as_bytes()).expect("sent");
    let announced = [&[0x81, 0xff][..], &(2u64 << 30).to_be_bytes(), &[0; 4]].concat();
    stream.write_all(&announced).expect("sent");
    let _ = stream.write_all(&[0; 4096]);
    let mut rest = Vec::new();
    let _ = stream.read_to_end(&mut rest);
    assert!(rest.starts_with(b"HTTP/1.1 101"), "it hangs up by itself");
    // Requests that are none are told so, and do no harm.
    let mut page = server.open();
    for wrong in ["", "null", "[]", "{\"type\":\"set\"}", &"[".repeat(60_000)] {
        page.send(Message::text(wrong.to_owned())).expect("sent");
        let notice = page.any("notice");
        assert_eq!(notice["level"], "error", "{notice}");
    }
}

#[test]
fn f112_names_are_text() {
    let evil = "<script>alert(1)</script><img src=x onerror=alert(1)>";
    let text = GRAPH
        .replace("\"grid\"", "\"<script>\"")
        .replace("grid.obj", evil);
    let (_folder, server) = serve_graph(&text, &["--port", "0"]);
    let mut page = server.open();
    // Names travel as JSON and nowhere else: the page is the same for all graphs.
    page.until("document", |document| {
        document["source"]
            .as_str()
            .is_some_and(|source| source.contains("<script>"))
    });
    page.ask(&json!({"type": "describe", "node": evil}));
    assert!(
        page.any("notice")["text"]
            .as_str()
            .is_some_and(|text| text.contains("alert"))
    );
    let (_plain_folder, plain) = serve(&[]);
    for name in ["", "app.js", "app.css"] {
        let (one, other) = (server.get(name), plain.get(name));
        assert_eq!(one.status, 200);
        assert_eq!(one.body, other.body, "{name}");
        assert_eq!(one.header("x-content-type-options"), "nosniff");
    }
    let script = String::from_utf8(plain.get("app.js").body).expect("text");
    assert!(!script.contains("eval("), "no text becomes a program");
}

#[test]
fn f113_its_own_port_on_this_machine_only() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = taken.local_addr().expect("an address").port().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("g.ron"), GRAPH).expect("written");
    let start = |arguments: &[&str]| Server::try_start(folder.path(), "g.ron", arguments);
    let told = start(&["--port", &port]).err().expect("a refusal");
    assert!(
        told.contains("exit status: 1") && told.contains("is taken"),
        "{told}"
    );
    // Without a wish the next free one is found.
    let (one, other) = (start(&[]), start(&[]));
    let (one, other) = (one.expect("a server"), other.expect("a server"));
    assert_ne!(one.address.port(), other.address.port());
    for server in [&one, &other] {
        assert!((8137..=8157).contains(&server.address.port()));
        assert!(server.address.ip().is_loopback());
    }
    #[cfg(target_os = "linux")]
    {
        assert_eq!(listeners(one.address.port()), ["0100007F"]);
        let six = start(&["--port", "0", "--host", "::1"]).expect("a server");
        assert_eq!(
            listeners(six.address.port()),
            ["00000000000000000000000001000000"]
        );
    }
    let mut open = start(&["--port", "0", "--host", "0.0.0.0"]).expect("a server");
    let mut page = open.open();
    assert_eq!(page.any("hello")["read_only"], true);
    page.ask(&json!({"type": "write", "name": "n", "value": 4}));
    assert_eq!(page.any("notice")["level"], "warning");
    assert_eq!(text_of(&folder.path().join("g.ron")), GRAPH);
    open.child.kill().expect("killed");
    let mut told = String::new();
    let err = open.child.stderr.as_mut().expect("a pipe");
    err.read_to_string(&mut told).expect("text");
    assert!(
        told.contains("can be reached from other machines"),
        "{told}"
    );
}

/// The addresses that a port is listened on at, as the system lists them.
#[cfg(target_os = "linux")]
fn listeners(port: u16) -> Vec<String> {
    let tables = ["/proc/net/tcp", "/proc/net/tcp6"].map(|path| text_of(Path::new(path)));
    let rows = tables.iter().flat_map(|table| table.lines());
    let listening = rows.filter_map(|row| {
        let mut columns = row.split_whitespace().skip(1);
        let (local, _, state) = (columns.next()?, columns.next()?, columns.next()?);
        let (address, number) = local.split_once(':')?;
        let is_listening = state == "0A" && u16::from_str_radix(number, 16) == Ok(port);
        is_listening.then(|| address.to_owned())
    });
    listening.collect()
}
