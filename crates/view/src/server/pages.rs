//! What is given out: three files that are part of the program, and buffers.
//! The page that needs no server is in `offline`.

use axum::body::Body;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use tessgraph_geometry::digest::Digest;

use super::Room;

const INDEX: &[u8] = include_bytes!("../../page/index.html");
pub(super) const SCRIPT: &[u8] = include_bytes!("../../page/app.js");
pub(super) const STYLE: &[u8] = include_bytes!("../../page/app.css");

pub(super) async fn index() -> Response {
    part("text/html; charset=utf-8", INDEX)
}

pub(super) async fn script() -> Response {
    part("text/javascript; charset=utf-8", SCRIPT)
}

pub(super) async fn style() -> Response {
    part("text/css; charset=utf-8", STYLE)
}

/// A file of the page. Another version of the program may have another one at
/// the same address.
fn part(kind: &'static str, content: impl Into<Body>) -> Response {
    let content: Body = content.into();
    ([(CONTENT_TYPE, kind), (CACHE_CONTROL, "no-cache")], content).into_response()
}

/// A buffer that a message has named.
pub(super) async fn buffer(
    State(room): State<Room>,
    Path((_, name)): Path<(String, String)>,
) -> Response {
    let Some(name) = digest(&name) else {
        return StatusCode::NOT_FOUND.into_response();
    };
    // Making one may take a while, and this thread has others to serve.
    let found = tokio::task::spawn_blocking(move || room.desk.buffers.get(name)).await;
    match found {
        Ok(Some(bytes)) => {
            let kind = (CONTENT_TYPE, "application/octet-stream");
            let for_ever = (CACHE_CONTROL, "private, max-age=31536000, immutable");
            ([kind, for_ever], Body::from(bytes)).into_response()
        }
        Ok(None) => StatusCode::NOT_FOUND.into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// A picture of a study, by the number that its message gave it.
pub(super) async fn picture(
    State(room): State<Room>,
    Path((_, number)): Path<(String, String)>,
) -> Response {
    let is_plain = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    let Some(number) = number.parse().ok().filter(|_| is_plain) else {
        return StatusCode::NOT_FOUND.into_response();
    };
    let found = tokio::task::spawn_blocking(move || (room.desk.picture)(number)).await;
    match found {
        Ok(Some(bytes)) => part("image/png", bytes),
        Ok(None) => StatusCode::NOT_FOUND.into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// The digest that 32 lower-case hexadecimal digits stand for.
pub(super) fn digest(name: &str) -> Option<Digest> {
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    if name.len() != 32 || !name.bytes().all(is_digit) {
        return None;
    }
    let mut bytes = [0; 16];
    for (place, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(name.get(2 * place..2 * place + 2)?, 16).ok()?;
    }
    Some(Digest::from_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_are_read_as_they_are_written() {
        let some = Digest::of(b"some");
        assert_eq!(digest(&some.to_string()), Some(some));
        for wrong in ["", "0", &"g".repeat(32), &"A".repeat(32), &"é".repeat(16)] {
            assert_eq!(digest(wrong), None, "{wrong}");
        }
    }
}
