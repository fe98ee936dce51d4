//! Names in messages: shortened, made harmless, and the ones that were meant.

/// Longer names are cut in messages: a megabyte of them helps nobody.
const SHOWN_CHARACTERS: usize = 40;

/// `name` as it may stand in a message: control characters escaped, and cut
/// after 40 characters.
pub(crate) fn shown(name: &str) -> String {
    let mut text = String::new();
    for (count, character) in name.chars().enumerate() {
        if count == SHOWN_CHARACTERS {
            text.push('…');
            break;
        }
        if is_harmful(character) {
            text.extend(character.escape_unicode());
        } else {
            text.push(character);
        }
    }
    text
}

/// Whether a terminal could take the character for a command, or show the text
/// around it in another order.
fn is_harmful(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// The names of `candidates` that `name` may have been meant to be, best first.
pub(crate) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Vec<&'a str> {
    if name.len() > 4 * SHOWN_CHARACTERS {
        return Vec::new();
    }
    let simple = |name: &str| name.to_lowercase().replace(['_', '-', ' '], "");
    let wanted = simple(name);
    let mut scored: Vec<(f64, &str)> = candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= 4 * SHOWN_CHARACTERS)
        .map(|candidate| (closeness(&wanted, &simple(candidate)), candidate))
        .filter(|(score, _)| *score >= 0.6)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0));
    scored.dedup_by(|a, b| a.1 == b.1);
    scored.truncate(3);
    scored.into_iter().map(|(_, candidate)| candidate).collect()
}

/// 1 for equal names, 0 for names with nothing in common.
fn closeness(wanted: &str, candidate: &str) -> f64 {
    let contained = wanted.len() >= 3 && candidate.contains(wanted)
        || candidate.len() >= 3 && wanted.contains(candidate);
    let score = strsim::normalized_damerau_levenshtein(wanted, candidate);
    if contained { score.max(0.7) } else { score }
}

/// "did you mean `a` or `b`?", if any of the candidates is near.
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let near: Vec<String> = nearest(name, candidates)
        .iter()
        .map(|near| format!("`{}`", shown(near)))
        .collect();
    (!near.is_empty()).then(|| format!("did you mean {}?", listing(&near, "or")))
}

/// "a", "a or b", "a, b or c".
pub fn listing(items: &[impl AsRef<str>], word: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [first @ .., last] => {
            let first: Vec<&str> = first.iter().map(AsRef::as_ref).collect();
            format!("{} {word} {}", first.join(", "), last.as_ref())
        }
    }
}

/// The names quoted and listed, at most `limit` of them.
pub(crate) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>, limit: usize) -> String {
    let mut names = names.into_iter();
    let mut text: Vec<String> = names
        .by_ref()
        .take(limit)
        .map(|name| format!("`{}`", shown(name)))
        .collect();
    let rest = names.count();
    if rest > 0 {
        text.push(format!("{rest} more"));
    }
    listing(&text, "and")
}

/// The names quoted, as alternatives.
pub(crate) fn alternatives<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .map(|name| format!("`{}`", shown(name)))
        .collect();
    listing(&names, "or")
}

/// Whether `name` is a `snake_case` identifier.
pub(crate) fn is_snake_case(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

/// The nearest `snake_case` name: `Roof-Mesh 2` becomes `roof_mesh_2`.
pub(crate) fn to_snake_case(name: &str) -> Option<String> {
    let mut text = String::new();
    let mut before = ' ';
    for character in name.chars().take(SHOWN_CHARACTERS) {
        let word_starts = character.is_ascii_uppercase()
            && (before.is_ascii_lowercase() || before.is_ascii_digit());
        let separates = !character.is_ascii_alphanumeric();
        if (word_starts || separates) && !text.is_empty() && !text.ends_with('_') {
            text.push('_');
        }
        if !separates && (character.is_ascii_alphabetic() || !text.is_empty()) {
            text.push(character.to_ascii_lowercase());
        }
        before = character;
    }
    let tidy = text.trim_matches('_');
    is_snake_case(tidy).then(|| tidy.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_and_dangerous_names_are_tamed() {
        assert_eq!(shown("a\u{1b}[31m\n"), "a\\u{1b}[31m\\u{a}");
        assert_eq!(shown(&"x".repeat(1_000_000)).chars().count(), 41);
        assert_eq!(shown("façade"), "façade");
    }

    #[test]
    fn near_names_are_found_best_first() {
        let names = ["SmoothNormals", "VertexNormals", "ReadMesh"];
        assert_eq!(nearest("SmoothNormal", names), ["SmoothNormals"]);
        assert_eq!(nearest("readmesh", names)[0], "ReadMesh");
        assert_eq!(nearest("normals", names).len(), 2);
        assert!(nearest("zzz", names).is_empty());
        assert_eq!(
            did_you_mean("read", names).unwrap(),
            "did you mean `ReadMesh`?"
        );
    }

    #[test]
    fn snake_case_is_offered() {
        assert_eq!(to_snake_case("RoofMesh-2").as_deref(), Some("roof_mesh_2"));
        assert_eq!(to_snake_case("2nd Roof").as_deref(), Some("nd_roof"));
        assert_eq!(to_snake_case("###"), None);
        assert!(is_snake_case("a_1") && !is_snake_case("_a") && !is_snake_case("façade"));
    }

    #[test]
    fn lists_read_like_sentences() {
        assert_eq!(quoted(["a", "b", "c"], 5), "`a`, `b` and `c`");
        assert_eq!(quoted(["a", "b", "c"], 2), "`a`, `b` and 1 more");
    }
}
