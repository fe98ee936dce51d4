//! `--poll`: what looking sees that has to be seen.

use std::fs::{self, File};
use std::time::{Duration, SystemTime};

use super::{Watch, graph, write};

#[test]
fn a_file_older_than_the_one_it_replaces_is_seen() {
    let (folder, watch) = Watch::on_grid(1, &["--poll"]);
    let at = |name: &str| folder.path().join(name);
    write(&at("older"), &graph(2));
    let older = File::options().append(true).open(at("older"));
    let older = older.expect("a file");
    older.set_modified(SystemTime::UNIX_EPOCH).expect("a time");
    drop(older);
    fs::rename(at("older"), at("g.ron")).expect("renamed");
    watch.until_faces(2);
    // Two in one second, of the same length.
    write(&at("g.ron"), &graph(3));
    std::thread::sleep(Duration::from_millis(600));
    write(&at("g.ron"), &graph(4));
    watch.until_faces(4);
    fs::remove_file(at("g.ron")).expect("removed");
    while watch.next()["ok"] == true {}
    write(&at("g.ron"), &graph(5));
    watch.until_faces(5);
    assert_eq!(watch.until_quiet().len(), 0);
}
