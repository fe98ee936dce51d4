//! Who may ask: programs of this machine that know the secret, and no page of
//! another site, whatever name it gives this machine.

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header::{
    CONTENT_SECURITY_POLICY, HOST, HeaderName, HeaderValue, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use subtle::ConstantTimeEq as _;

use super::pairings::Pairings;

/// What a request must have.
pub(super) struct Guard {
    address: SocketAddr,
    keys: Keys,
}

/// The secrets that are let in.
pub(super) enum Keys {
    /// That of the owner, who is on this machine.
    Owner(String),
    /// Those of devices in the network.
    Paired(Arc<Pairings>),
}

/// Who asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Caller {
    /// Whoever has the address that was printed; may change values if it is of
    /// this machine.
    Owner {
        /// Whether values may be changed.
        may_edit: bool,
    },
    /// A device of that number.
    Device(u32),
}

impl Guard {
    pub(super) fn new(address: SocketAddr, keys: Keys) -> Self {
        Self { address, keys }
    }

    /// Why a request is refused, or the host it names and who asks.
    ///
    /// A page of another site can make a browser send requests here, under any
    /// name that leads here, but cannot keep the browser from saying so in the
    /// headers `Host` and `Origin`.
    fn judge(&self, request: &Request) -> Result<(String, Caller), StatusCode> {
        let Some(host) = only(request.headers(), HOST).filter(|host| self.is_own(host)) else {
            return Err(StatusCode::FORBIDDEN);
        };
        if request.headers().contains_key(ORIGIN) {
            let origin = only(request.headers(), ORIGIN);
            if origin != Some(&format!("http://{host}")) {
                return Err(StatusCode::FORBIDDEN);
            }
        }
        let uri = request.uri();
        let path = uri.path();
        let is_plain = path.starts_with('/')
            && !path.contains("//")
            && !path.contains("..")
            && !path.contains(['%', '\\'])
            && uri.query().is_none()
            && uri.authority().is_none();
        if !is_plain {
            return Err(StatusCode::NOT_FOUND);
        }
        let given = path[1..].split('/').next().unwrap_or_default();
        let caller = self.caller(given).ok_or(StatusCode::UNAUTHORIZED)?;
        Ok((host.to_owned(), caller))
    }

    /// Who knows such a secret.
    fn caller(&self, given: &str) -> Option<Caller> {
        match &self.keys {
            Keys::Owner(token) => {
                let may_edit = self.address.ip().is_loopback();
                bool::from(given.as_bytes().ct_eq(token.as_bytes()))
                    .then_some(Caller::Owner { may_edit })
            }
            Keys::Paired(pairings) => pairings.find(given).map(Caller::Device),
        }
    }

    /// Whether a host is this machine under a number, or "localhost"; for devices
    /// of the network the one address they were given.
    fn is_own(&self, host: &str) -> bool {
        if matches!(self.keys, Keys::Paired(_)) {
            return host == self.address.to_string();
        }
        let Some((name, port)) = host.rsplit_once(':') else {
            return false;
        };
        if port != self.address.port().to_string() {
            return false;
        }
        let name = name
            .strip_prefix('[')
            .and_then(|name| name.strip_suffix(']'))
            .unwrap_or(name);
        let is_local = name == "localhost"
            || name
                .parse::<IpAddr>()
                .is_ok_and(|number| number.is_loopback());
        // Elsewhere nobody can say by which numbers this machine is reached, but
        // a number is no name that another site could give it.
        is_local || (!self.address.ip().is_loopback() && name.parse::<IpAddr>().is_ok())
    }
}

/// The value of a header that stands there once.
fn only(headers: &HeaderMap, name: HeaderName) -> Option<&str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

/// Refuses what [`Guard`] refuses, and tells the browser what the page may do.
pub(super) async fn check(
    State(guard): State<Arc<Guard>>,
    mut request: Request<Body>,
    next: Next,
) -> Response {
    let (mut response, host) = match guard.judge(&request) {
        Ok((host, caller)) => {
            request.extensions_mut().insert(caller);
            (next.run(request).await, host)
        }
        Err(status) => (status.into_response(), String::new()),
    };
    let policy = format!(
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; \
         img-src 'self' data: blob:; connect-src 'self' ws://{host}; font-src 'self'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    let headers = response.headers_mut();
    if let Ok(policy) = HeaderValue::from_str(&policy) {
        headers.insert(CONTENT_SECURITY_POLICY, policy);
    }
    let fixed = [
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (X_FRAME_OPTIONS, "DENY"),
        (REFERRER_POLICY, "no-referrer"),
        (
            HeaderName::from_static("cross-origin-resource-policy"),
            "same-origin",
        ),
    ];
    for (name, value) in fixed {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard(address: &str) -> Guard {
        Guard::new(address.parse().unwrap(), Keys::Owner("a".repeat(32)))
    }

    fn judge(guard: &Guard, path: &str, headers: &[(&str, &str)]) -> Result<String, u16> {
        let mut request = Request::builder().uri(path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        let request = request.body(Body::empty()).unwrap();
        let judged = guard.judge(&request);
        judged
            .map(|(host, _)| host)
            .map_err(|status| status.as_u16())
    }

    #[test]
    fn devices_come_by_their_own_address_and_secret_alone() {
        let address = "192.168.1.7:8137".parse().unwrap();
        let pairings = Arc::new(Pairings::new(address, false));
        pairings.pair().unwrap();
        let url = pairings.shares().pairings[0].url.clone();
        let path = url
            .strip_prefix("http://192.168.1.7:8137")
            .unwrap()
            .to_owned();
        let guard = Guard::new(address, Keys::Paired(Arc::clone(&pairings)));
        let host = ("host", "192.168.1.7:8137");
        assert_eq!(
            guard.caller(path.trim_matches('/')),
            Some(Caller::Device(1))
        );
        assert!(judge(&guard, &path, &[host]).is_ok());
        assert_eq!(judge(&guard, "/", &[host]), Err(401));
        for other in [
            "127.0.0.1:8137",
            "localhost:8137",
            "192.168.1.8:8137",
            "192.168.1.7:80",
            "[::1]:8137",
        ] {
            assert_eq!(
                judge(&guard, &path, &[("host", other)]),
                Err(403),
                "{other}"
            );
        }
        let origin = ("origin", "http://192.168.1.8:8137");
        assert_eq!(judge(&guard, &path, &[host, origin]), Err(403));
        pairings.unpair(1);
        assert_eq!(judge(&guard, &path, &[host]), Err(401));
    }

    #[test]
    fn only_numbers_of_this_machine_and_localhost_are_hosts() {
        let (local, open) = (guard("127.0.0.1:8137"), guard("0.0.0.0:8137"));
        let path = format!("/{}/", "a".repeat(32));
        for (host, here, anywhere) in [
            ("127.0.0.1:8137", true, true),
            ("localhost:8137", true, true),
            ("[::1]:8137", true, true),
            ("192.168.1.7:8137", false, true),
            ("127.0.0.1:80", false, false),
            ("127.0.0.1", false, false),
            ("evil.example:8137", false, false),
            ("127.evil.example:8137", false, false),
            ("localhost.evil.example:8137", false, false),
            ("127.0.0.1.:8137", false, false),
            ("", false, false),
            (":8137", false, false),
        ] {
            let judged = |guard| judge(guard, &path, &[("host", host)]);
            let expected = |is_own| {
                if is_own {
                    Ok(host.to_owned())
                } else {
                    Err(403)
                }
            };
            assert_eq!(judged(&local), expected(here), "{host}");
            assert_eq!(judged(&open), expected(anywhere), "{host}");
        }
    }

    #[test]
    fn the_secret_must_be_whole() {
        let guard = guard("127.0.0.1:8137");
        let host = ("host", "127.0.0.1:8137");
        let whole = "a".repeat(32);
        assert!(judge(&guard, &format!("/{whole}"), &[host]).is_ok());
        for path in [
            "/",
            "/a/",
            &format!("/{whole}a/"),
            &format!("/{}/", &whole[1..]),
        ] {
            assert_eq!(judge(&guard, path, &[host]), Err(401), "{path}");
        }
        for origin in ["null", "http://evil.example", "https://127.0.0.1:8137", ""] {
            let path = format!("/{whole}/socket");
            let judged = judge(&guard, &path, &[host, ("origin", origin)]);
            assert_eq!(judged, Err(403), "{origin}");
        }
    }
}
