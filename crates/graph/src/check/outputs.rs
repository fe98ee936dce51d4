//! The files a graph writes, and what it gives to other graphs.

use std::collections::BTreeMap;
use std::ops::Range;

use super::reference::{Found, resolve};
use super::scope::{FormResult, Scope};
use crate::document::{Document, Link, Problems};
use crate::names::{is_snake_case, shown};
use crate::plan::{PlanOutput, ResultRef};

/// Makes one result of what a reference leads to; it is given the reference and
/// its place.
type Single<'s> = dyn FnMut(&str, &Found, &Range<usize>) -> Option<ResultRef> + 's;

/// The outputs in file order; those with problems are left out. `single` makes
/// one result of a list of results.
pub(super) fn check(
    scope: &Scope<'_>,
    document: &Document,
    problems: &mut Problems,
    single: &mut Single<'_>,
) -> Vec<PlanOutput> {
    let is_part = document.inputs.iter().any(|input| input.required);
    if document.outputs.is_empty() && !document.outputs_damaged && !is_part {
        report_nothing(document, problems);
    }
    let mut paths: BTreeMap<String, Range<usize>> = BTreeMap::new();
    let mut outputs = Vec::new();
    for link in &document.outputs {
        let path_is_sound = check_path(link, &mut paths, problems);
        match resolve(scope, &link.target, problems) {
            Ok(found) if path_is_sound => {
                let result = single(&link.target.value, &found, &link.target.span);
                outputs.extend(result.map(|result| PlanOutput {
                    path: link.name.value.clone(),
                    result,
                    span: link.name.span.clone(),
                }));
            }
            Ok(_) | Err(None) => {}
            Err(Some(error)) => problems.add(*error),
        }
    }
    check_nesting(&paths, problems);
    outputs
}

fn report_nothing(document: &Document, problems: &mut Problems) {
    let message = "the graph outputs nothing";
    let error = problems.error("no_outputs", &document.head, message, "no outputs");
    let node = document
        .nodes
        .last()
        .map_or("node", |node| &node.name.value);
    let help = format!("add `outputs: {{\"out/result.glb\": \"{}\"}}`", shown(node));
    problems.add(error.with_help(help));
}

fn check_path(
    link: &Link,
    paths: &mut BTreeMap<String, Range<usize>>,
    problems: &mut Problems,
) -> bool {
    let (path, span) = (&link.name.value, &link.name.span);
    let tidy = match tidy(path) {
        Ok(tidy) => tidy,
        Err((why, help)) => {
            let message = format!("nothing can be written to `{}`: {why}", shown(path));
            problems.add(
                problems
                    .error("bad_path", span, message, "here")
                    .with_help(help),
            );
            return false;
        }
    };
    if let Some(first) = paths.get(&tidy) {
        let message = format!("`{}` is written twice", shown(&tidy));
        let error = problems.error("duplicate_name", span, message, "again here");
        let error = error.with_label(first.clone(), "first written here");
        problems.add(error.with_help("give one of them another path"));
        return false;
    }
    paths.insert(tidy, span.clone());
    true
}

/// A path cannot be a file and a folder at once.
fn check_nesting(paths: &BTreeMap<String, Range<usize>>, problems: &mut Problems) {
    for (path, span) in paths {
        let folders = path.match_indices('/').map(|(end, _)| &path[..end]);
        for folder in folders {
            if let Some(file) = paths.get(folder) {
                let message = format!("`{}` would be a file and a folder", shown(folder));
                let error = problems.error("bad_path", span, message, "needs it as a folder");
                let error = error.with_label(file.clone(), "writes it as a file");
                problems.add(error.with_help("give one of them another path"));
            }
        }
    }
}

/// No system opens longer paths.
const MAX_PATH: usize = 4096;

/// The path without detours, or why it is none, and a way out.
fn tidy(path: &str) -> Result<String, (&'static str, &'static str)> {
    const RELATIVE: &str = "write a path inside the graph's folder; `--out DIR` moves all outputs";
    if path.trim().is_empty() {
        return Err((
            "the path is empty",
            "write a file name such as `out/facade.glb`",
        ));
    }
    if path.len() > MAX_PATH {
        return Err(("the path is too long", "write a shorter one"));
    }
    if path.chars().any(char::is_control) {
        return Err(("it holds control characters", "remove them"));
    }
    if path.contains('\\') {
        return Err((
            "it holds a backslash",
            "write `/` between folders, on every system",
        ));
    }
    let has_drive =
        path.as_bytes().get(1) == Some(&b':') && path.as_bytes()[0].is_ascii_alphabetic();
    if path.starts_with('/') || has_drive {
        return Err(("the path is absolute", RELATIVE));
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.pop().is_none() => {
                return Err(("it lies outside the graph's folder", RELATIVE));
            }
            ".." => {}
            part => parts.push(part),
        }
    }
    if parts.is_empty() || path.ends_with(['/']) || path.ends_with("/.") || path.ends_with("..") {
        return Err(("it is a folder", "add a file name such as `facade.glb`"));
    }
    Ok(parts.join("/"))
}

/// What the graph gives to another graph: names once, references that exist.
pub(super) fn check_results(
    scope: &Scope<'_>,
    results: &[Link],
    problems: &mut Problems,
) -> Vec<FormResult> {
    let mut given = Vec::with_capacity(results.len());
    let mut names: BTreeMap<&str, Range<usize>> = BTreeMap::new();
    for link in results {
        let (name, span) = (&link.name.value, &link.name.span);
        if !is_snake_case(name) {
            let message = format!("`{}` is no name for a result", shown(name));
            let error = problems.error("bad_name", span, message, "not snake_case");
            problems.add(error.with_help("write lower-case letters, digits and `_`"));
        }
        if let Some(first) = names.insert(name, span.clone()) {
            let message = format!("`{}` is the name of two results", shown(name));
            let error = problems.error("duplicate_name", span, message, "again here");
            problems.add(
                error
                    .with_label(first, "first named here")
                    .with_help("rename one"),
            );
        }
        let found = resolve(scope, &link.target, problems);
        let found = found.map_err(|error| problems.extend(error.map(|error| *error)));
        given.push(FormResult {
            name: name.clone(),
            found: found.ok(),
        });
    }
    given
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_inside_the_folder() {
        assert_eq!(tidy("a/./b/../c.glb").unwrap(), "a/c.glb");
        assert_eq!(tidy("c.glb").unwrap(), "c.glb");
        for bad in [
            "",
            " ",
            "/a",
            "../a",
            "a/../../b",
            "a/",
            "a/..",
            ".",
            "C:/a",
            "a\\b",
            "a\nb",
        ] {
            assert!(tidy(bad).is_err(), "{bad:?}");
        }
    }
}
