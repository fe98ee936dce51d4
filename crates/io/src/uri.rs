//! Which references to further files are followed.

/// The longest file reference that is passed on.
const LONGEST: usize = 1024;

/// `uri` with its %XX escapes decoded, if it names a file in or below the
/// folder of the file that holds it.
///
/// # Errors
/// Says in words why it does not: absolute, with a scheme, upwards, ...
pub(crate) fn relative(uri: &str) -> Result<String, &'static str> {
    let path = percent_decode(uri)?;
    check_path(&path)?;
    // What decodes to another escape was written to slip past a check.
    if percent_decode(&path).is_ok_and(|twice| check_path(&twice).is_err()) {
        return Err("is escaped twice");
    }
    Ok(path)
}

/// Checks that `path`, as it stands, names a file in or below the folder.
///
/// # Errors
/// As [`relative`].
pub(crate) fn check_path(path: &str) -> Result<(), &'static str> {
    if path.is_empty() {
        return Err("is empty");
    }
    if path.len() > LONGEST {
        return Err("is longer than 1024 bytes");
    }
    if path.chars().any(char::is_control) {
        return Err("has control characters in it");
    }
    if path.contains('\\') {
        return Err("has backslashes; `/` parts folders");
    }
    if path.starts_with('/') {
        return Err("is absolute");
    }
    // A colon is a scheme, a drive or an NTFS stream; none is a relative name.
    if path.contains(':') {
        return Err("has a scheme or drive");
    }
    if path.split('/').any(|part| part == "..") {
        return Err("leads upwards");
    }
    if path.split('/').any(str::is_empty) || path.split('/').next_back() == Some(".") {
        return Err("names a folder");
    }
    Ok(())
}

fn percent_decode(uri: &str) -> Result<String, &'static str> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let hex = |b: &u8| char::from(*b).to_digit(16).map(|digit| digit as u8);
        match (first, tail) {
            (b'%', [high, low, after @ ..]) => {
                let (Some(high), Some(low)) = (hex(high), hex(low)) else {
                    return Err("has a broken %XX escape");
                };
                bytes.push(high << 4 | low);
                rest = after;
            }
            (b'%', _) => return Err("has a broken %XX escape"),
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).map_err(|_| "is not UTF-8")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_relative_names_pass_decoded() {
        assert_eq!(relative("a.bin"), Ok("a.bin".into()));
        assert_eq!(relative("./sub/a.bin"), Ok("./sub/a.bin".into()));
        assert_eq!(relative("a%20b.bin"), Ok("a b.bin".into()));
        assert_eq!(relative("Unicode%20❤♻.bin"), Ok("Unicode ❤♻.bin".into()));
        assert_eq!(relative("a..b.bin"), Ok("a..b.bin".into()));
    }

    #[test]
    fn everything_else_is_refused() {
        for uri in [
            "",
            "/etc/passwd",
            "../a",
            "a/../../b",
            "%2e%2e/a",
            "%2E%2e%2fa",
            "file:///etc/passwd",
            "http://x/y",
            "C:/x",
            "C:x",
            "..\\a",
            "a%5cb",
            "//host/share",
            "\\\\host\\share",
            "a\nb",
            "a\0b",
            "a%00b",
            "a%0ab",
            ".",
            "a/",
            "a//b",
            "a/.",
            "%zz",
            "a%2",
            "%252e%252e/a",
            "a%ff",
            "data:x",
        ] {
            assert!(relative(uri).is_err(), "{uri:?}");
        }
        assert!(relative(&"a".repeat(2000)).is_err());
    }
}
