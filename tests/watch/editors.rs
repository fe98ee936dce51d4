//! Every way in which programs save a file, step by step.

use std::fs::{self, File, OpenOptions};
use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use super::{Watch, graph, write};

fn beside(path: &Path, name: &str) -> std::path::PathBuf {
    path.with_file_name(name)
}

/// Makes a new file with this content, as `open(O_CREAT | O_TRUNC)` does.
fn make(path: &Path, text: &str) {
    let mut file = File::create(path).expect("a file");
    file.write_all(text.as_bytes()).expect("written");
    file.sync_all().expect("synced");
}

/// vim: tries whether the folder takes files, moves the file away, writes a new
/// one, and removes the old one.
fn vim(path: &Path, text: &str) {
    make(&beside(path, "4913"), "");
    fs::remove_file(beside(path, "4913")).expect("removed");
    fs::rename(path, beside(path, "g.ron~")).expect("renamed");
    make(path, text);
    fs::remove_file(beside(path, "g.ron~")).expect("removed");
}

/// vim with `backupcopy=yes`: copies the file and writes it in place.
fn vim_in_place(path: &Path, text: &str) {
    fs::copy(path, beside(path, "g.ron~")).expect("copied");
    make(path, text);
    fs::remove_file(beside(path, "g.ron~")).expect("removed");
}

/// emacs: locks with a dangling link, saves by itself, keeps the old file as a
/// backup and writes a new one.
fn emacs(path: &Path, text: &str) {
    let lock = beside(path, ".#g.ron");
    #[cfg(unix)]
    std::os::unix::fs::symlink("user@host.123:456", &lock).expect("a link");
    make(&beside(path, "#g.ron#"), text);
    fs::rename(path, beside(path, "g.ron~")).expect("renamed");
    make(path, text);
    fs::remove_file(beside(path, "#g.ron#")).expect("removed");
    // Only where there are links.
    let _ = fs::remove_file(&lock);
}

/// VS Code: opens the file, cuts it to nothing, and writes after a moment.
fn vs_code(path: &Path, text: &str) {
    let file = OpenOptions::new().write(true).open(path);
    let mut file = file.expect("it is there");
    file.set_len(0).expect("cut");
    std::thread::sleep(Duration::from_millis(5));
    file.write_all(text.as_bytes()).expect("written");
}

/// `sed -i`, gedit, Kate, JetBrains: writes another file and renames it.
fn renamed(path: &Path, text: &str) {
    make(&beside(path, ".g.ron.XXXX"), text);
    fs::rename(beside(path, ".g.ron.XXXX"), path).expect("renamed");
}

/// `cp new g.ron`: writes over the file.
fn copied(path: &Path, text: &str) {
    make(&beside(path, "new"), text);
    fs::copy(beside(path, "new"), path).expect("copied");
}

/// An exchange of the two files, as some tools do to keep the old one.
fn by_way_of_a_backup(path: &Path, text: &str) {
    make(&beside(path, "new"), text);
    fs::rename(path, beside(path, "old")).expect("renamed");
    std::thread::sleep(Duration::from_millis(5));
    fs::rename(beside(path, "new"), path).expect("renamed");
}

/// Removes the file and writes it again.
fn removed(path: &Path, text: &str) {
    fs::remove_file(path).expect("removed");
    make(path, text);
}

/// Many small writes.
fn in_pieces(path: &Path, text: &str) {
    let mut file = File::create(path).expect("a file");
    for piece in text.as_bytes().chunks(16) {
        file.write_all(piece).expect("written");
        std::thread::sleep(Duration::from_millis(1));
    }
}

type Save = fn(&Path, &str);

const SAVES: [(&str, Save); 9] = [
    ("vim", vim),
    ("vim in place", vim_in_place),
    ("emacs", emacs),
    ("VS Code", vs_code),
    ("renamed", renamed),
    ("copied", copied),
    ("by way of a backup", by_way_of_a_backup),
    ("removed", removed),
    ("in pieces", in_pieces),
];

fn follows_every_way_of_saving(rounds: usize, arguments: &[&str]) {
    let (_folder, watch) = Watch::on_grid(1, arguments);
    for (index, (name, save)) in SAVES.repeat(rounds).into_iter().enumerate() {
        let faces = index + 2;
        save(&watch.path("g.ron"), &graph(faces));
        watch.until_faces_after(name, faces);
    }
}

#[test]
fn every_way_of_saving_is_followed() {
    // Twice in a row: the second finds what the first left behind.
    follows_every_way_of_saving(2, &[]);
}

#[test]
fn every_way_of_saving_is_seen_by_looking() {
    follows_every_way_of_saving(1, &["--poll"]);
}

#[test]
fn a_half_written_file_is_an_error_until_the_rest_comes() {
    let (_folder, watch) = Watch::on_grid(1, &[]);
    let text = graph(7);
    let half = text.len() / 2;
    let mut file = File::create(watch.path("g.ron")).expect("a file");
    file.write_all(&text.as_bytes()[..half]).expect("written");
    let broken = watch.next();
    assert_eq!(broken["ok"], false);
    assert_eq!(watch.faces(), 1, "the last good output stays");
    file.write_all(&text.as_bytes()[half..]).expect("written");
    watch.until_faces(7);
    watch.line_with("half written");
}

#[test]
fn a_hundred_saves_in_a_second_end_in_the_last_content() {
    let (_folder, watch) = Watch::on_grid(1, &[]);
    for faces in 2..102 {
        write(&watch.path("g.ron"), &graph(faces));
        std::thread::sleep(Duration::from_millis(10));
    }
    let before = watch.reports.try_iter().count();
    let after = watch.until_quiet();
    println!("{before} runs while it was saved, {} after", after.len());
    // The one at work when the last save came, and the one for it.
    assert!((1..=2).contains(&after.len()), "{}", after.len());
    assert_eq!(watch.faces(), 101);
    // Every half second one, whatever the machine had to do meanwhile.
    assert!(before <= 20, "{before}");
}
