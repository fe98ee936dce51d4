//! The secret in the page's address.

use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::Path;

use tessgraph_geometry::digest::Hasher;
use tessgraph_view::token;

/// The file in the cache folder from which secrets are made.
const FILE: &str = "view-secret";

/// The variable that names the secret, for programs that start the server.
pub(super) const VARIABLE: &str = "TESSGRAPH_VIEW_TOKEN";

/// The secret that the environment names, or that of the graph.
///
/// # Errors
/// When the variable holds no 32 hexadecimal digits, and as [`token_of`].
pub(super) fn chosen(graph: &Path, folder: Option<&Path>) -> io::Result<String> {
    let Some(given) = std::env::var_os(VARIABLE) else {
        return token_of(graph, folder);
    };
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    let given = given.into_string().unwrap_or_default();
    if given.len() == 32 && given.bytes().all(is_digit) {
        return Ok(given);
    }
    let reason = format!("{VARIABLE} must hold 32 hexadecimal digits, the letters small");
    Err(io::Error::other(reason))
}

/// The secret of a graph's page: the same each time, so that a page that is open
/// finds a server that was started again. It follows from 128 random bits that
/// only this user can read; where they cannot be kept it is another each time.
///
/// # Errors
/// When the system has no random numbers.
fn token_of(graph: &Path, folder: Option<&Path>) -> io::Result<String> {
    let Some(seed) = folder.and_then(|folder| seed(folder).ok()) else {
        return token();
    };
    let path = graph
        .canonicalize()
        .or_else(|_| std::path::absolute(graph))?;
    let mut hasher = Hasher::new();
    hasher.text("page").text(&seed);
    hasher.bytes(path.as_os_str().as_encoded_bytes());
    Ok(hasher.finish().to_string())
}

/// The random bits of the folder, made if there are none.
fn seed(folder: &Path) -> io::Result<String> {
    std::fs::create_dir_all(folder)?;
    let path = folder.join(FILE);
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.mode(0o600);
    }
    match options.open(&path) {
        Ok(mut file) => file.write_all(token()?.as_bytes())?,
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(error),
    }
    let mut seed = String::new();
    let file = File::open(&path)?;
    if !is_private(&file)? {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    file.take(64).read_to_string(&mut seed)?;
    if seed.len() == 32 {
        Ok(seed)
    } else {
        // Of another version, or being written just now.
        Err(io::ErrorKind::InvalidData.into())
    }
}

/// Whether only this user can read a file.
#[cfg(unix)]
fn is_private(file: &File) -> io::Result<bool> {
    use std::os::unix::fs::PermissionsExt as _;
    Ok(file.metadata()?.permissions().mode() & 0o077 == 0)
}

/// On other systems the user's folders are the user's own.
#[cfg(not(unix))]
fn is_private(_: &File) -> io::Result<bool> {
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_graph_keeps_its_secret_and_each_has_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let cache = folder.path().join("cache");
        let of = |graph: &str| token_of(&folder.path().join(graph), Some(&cache)).unwrap();
        assert_eq!(of("a.ron"), of("a.ron"));
        assert_ne!(of("a.ron"), of("b.ron"));
        assert_eq!(of("a.ron").len(), 32);
        let fresh = || token_of(Path::new("a.ron"), None).unwrap();
        assert_ne!(fresh(), fresh());
    }

    #[cfg(unix)]
    #[test]
    fn a_secret_that_others_can_read_is_not_used() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let of = || token_of(Path::new("a.ron"), Some(folder.path())).unwrap();
        let before = of();
        let open = std::fs::Permissions::from_mode(0o644);
        std::fs::set_permissions(folder.path().join(FILE), open).unwrap();
        assert_ne!(of(), before);
    }
}
