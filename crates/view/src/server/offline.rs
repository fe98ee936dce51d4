//! The page that needs no server: one file with the viewer, the last messages and
//! the buffers they name.

use std::collections::BTreeMap;
use std::io::Write as _;

use axum::body::Body;
use axum::extract::ws::Utf8Bytes;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use super::pages::{SCRIPT, STYLE, digest};
use super::socket::without_place;
use super::{Desk, Room};

/// Bytes of a page that browsers and mail still take.
const MOST_BYTES: usize = 100_000_000;

/// Answers with the page of the picture of that version, or says in words why there
/// is none.
pub(super) async fn offline(
    State(room): State<Room>,
    Path((_, version)): Path<(String, String)>,
) -> Response {
    let Some(texts) = version
        .parse()
        .ok()
        .and_then(|version| room.desk.hub.seen_with(version))
    else {
        let told = "The picture has just been replaced by another: try again.";
        return (StatusCode::NOT_FOUND, told).into_response();
    };
    // Packing a large model takes seconds, and this thread has others to serve.
    let made = tokio::task::spawn_blocking(move || page(&room.desk, &texts, MOST_BYTES)).await;
    match made {
        Ok(Ok(page)) => {
            let headers = [
                (CONTENT_TYPE, "text/html; charset=utf-8"),
                (CONTENT_DISPOSITION, "attachment; filename=\"model.html\""),
                (CACHE_CONTROL, "no-store"),
            ];
            (headers, Body::from(page)).into_response()
        }
        Ok(Err(refusal)) => (StatusCode::PAYLOAD_TOO_LARGE, refusal).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// The whole page; its policy lets it load nothing and run nothing but its own
/// script, which it names by its hash.
///
/// Cost: a pass of gzip over all buffers of the picture.
///
/// # Errors
/// In words, when it would have more than `most` bytes.
fn page(desk: &Desk, texts: &[Utf8Bytes], most: usize) -> Result<String, String> {
    let saved = saved(desk, texts);
    let script = in_script(&String::from_utf8_lossy(SCRIPT));
    let hash = STANDARD.encode(Sha256::digest(script.as_bytes()));
    let policy = format!(
        "default-src 'none'; script-src 'sha256-{hash}'; style-src 'unsafe-inline'; \
         img-src data: blob:; font-src data:; base-uri 'none'; form-action 'none'"
    );
    let style = String::from_utf8_lossy(STYLE).replace("</", "<\\/");
    let page = format!(
        "<!doctype html>\n<html lang=\"en\" data-theme=\"dark\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"dark light\">\n<title>tessgraph</title>\n\
         <style>{style}</style>\n</head>\n<body>\n\
         <noscript>This page needs JavaScript: it draws the model.</noscript>\n\
         <div id=\"app\"></div>\n\
         <script type=\"application/json\" id=\"saved\">{saved}</script>\n\
         <script type=\"module\">{script}</script>\n</body>\n</html>\n"
    );
    if page.len() > most {
        let [size, most] = [page.len(), most].map(|bytes| bytes.div_ceil(1_000_000));
        return Err(format!(
            "The page would have {size} MB, and {most} MB are the most that browsers take well: \
             show a smaller result, or a coarser one."
        ));
    }
    Ok(page)
}

/// Messages, and the buffers that they name, as the page reads them.
fn saved(desk: &Desk, texts: &[Utf8Bytes]) -> String {
    let mut messages: Vec<Value> = texts
        .iter()
        .filter_map(|text| serde_json::from_str(text.as_str()).ok())
        .collect();
    let mut buffers = BTreeMap::new();
    for message in &mut messages {
        if message["type"] == "shown" {
            pack(message, desk, &mut buffers);
        }
        without_place(message);
    }
    let saved = json!({"messages": messages, "buffers": buffers}).to_string();
    // In JSON this sign only stands in texts, where it has another spelling.
    saved.replace('<', "\\u003c")
}

/// Packs every buffer that a message names.
fn pack(message: &Value, desk: &Desk, buffers: &mut BTreeMap<String, String>) {
    match message {
        Value::String(name) if !buffers.contains_key(name) => {
            if let Some(content) = digest(name).and_then(|name| desk.buffers.get(name)) {
                buffers.insert(name.clone(), packed(&content));
            }
        }
        Value::Array(parts) => parts.iter().for_each(|part| pack(part, desk, buffers)),
        Value::Object(parts) => parts.values().for_each(|part| pack(part, desk, buffers)),
        _ => {}
    }
}

/// Bytes as base64 of gzip, both of which browsers read themselves.
fn packed(content: &[u8]) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    let zipped = encoder.write_all(content).and_then(|()| encoder.finish());
    // Writing to memory does not fail.
    STANDARD.encode(zipped.unwrap_or_default())
}

/// A script as it may stand between tags: in texts of a program a bar before a
/// slash or an exclamation mark says the same.
fn in_script(script: &str) -> String {
    script
        .replace("</script", "<\\/script")
        .replace("<!--", "<\\!--")
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;
    use std::sync::Arc;

    use flate2::read::GzDecoder;
    use tessgraph_geometry::digest::Digest;

    use super::*;
    use crate::buffers::{Buffers, bytes};
    use crate::hub::Hub;
    use crate::protocol::{Hello, Shown, ToPage};

    fn desk() -> Desk {
        let (hub, buffers) = (Hub::default(), Buffers::new(1000));
        let name = buffers.awaited(Digest::of(b"x"), 8, || bytes(vec![7u32, 8]));
        hub.publish(&ToPage::Hello(Hello {
            version: "1".to_owned(),
            file: "</script><script>evil()</script>".to_owned(),
            folder: "/home/somebody".to_owned(),
            session: "s".to_owned(),
            read_only: false,
        }));
        let shown = Shown {
            node: name.0.to_string(),
            version: 7,
            ..Shown::default()
        };
        hub.show(None, &ToPage::Shown(Box::new(shown)));
        Desk {
            hub: Arc::new(hub),
            buffers: Arc::new(buffers),
            ask: Arc::new(|_| true),
            picture: Arc::new(|_| None),
        }
    }

    fn made(most: usize) -> Result<String, String> {
        let desk = desk();
        let texts = desk.hub.seen_with(7).unwrap();
        page(&desk, &texts, most)
    }

    #[test]
    fn the_page_holds_what_was_told_and_nothing_of_it_is_markup() {
        let page = made(MOST_BYTES).unwrap();
        assert!(!page.contains("/home/somebody"));
        assert_eq!(page.matches("<script").count(), 2);
        assert_eq!(page.matches("</script").count(), 2);
        let start = page.find("id=\"saved\">").unwrap() + "id=\"saved\">".len();
        let end = start + page[start..].find("</script>").unwrap();
        let saved: Value = serde_json::from_str(&page[start..end]).unwrap();
        assert_eq!(
            saved["messages"][0]["file"],
            "</script><script>evil()</script>"
        );
        let name = saved["messages"][1]["node"].as_str().unwrap();
        let zipped = STANDARD
            .decode(saved["buffers"][name].as_str().unwrap())
            .unwrap();
        let mut content = Vec::new();
        GzDecoder::new(&zipped[..])
            .read_to_end(&mut content)
            .unwrap();
        assert_eq!(content, [7, 0, 0, 0, 8, 0, 0, 0]);
    }

    #[test]
    fn the_policy_names_the_script_that_is_there() {
        let page = made(MOST_BYTES).unwrap();
        let mark = "<script type=\"module\">";
        let script = &page[page.find(mark).unwrap() + mark.len()..];
        let script = &script[..script.find("</script>").unwrap()];
        let hash = STANDARD.encode(Sha256::digest(script.as_bytes()));
        assert!(page.contains(&format!("script-src 'sha256-{hash}';")));
        assert!(page.contains("default-src 'none'"));
    }

    #[test]
    fn a_page_that_is_too_large_is_refused_with_its_size() {
        let told = made(1000).unwrap_err();
        assert!(
            told.contains("would have 1 MB") || told.contains("would have 2 MB"),
            "{told}"
        );
    }
}
