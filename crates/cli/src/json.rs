//! JSON as it is written: short on a line, or indented for files.

use serde_json::{Number, Value};

use crate::text::is_harmful;

/// One line, without a line feed.
pub(crate) fn line(value: &Value) -> String {
    harmless(value.to_string())
}

/// Indented, with a line feed at the end.
pub(crate) fn pretty(value: &Value) -> String {
    let mut text = harmless(format!("{value:#}"));
    text.push('\n');
    text
}

/// A number; null for NaN and infinity, which JSON does not have; 0 for -0.
pub(crate) fn number(number: f64) -> Value {
    Number::from_f64(number + 0.0).map_or(Value::Null, Value::Number)
}

/// Escapes what JSON allows but a terminal could take for a command; such
/// characters stand only inside strings.
fn harmless(text: String) -> String {
    let harmful = |character: char| character != '\n' && is_harmful(character);
    if !text.contains(harmful) {
        return text;
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if harmful(character) {
            // All of them lie in the basic plane: one escape each.
            safe.push_str(&format!("\\u{:04x}", u32::from(character)));
        } else {
            safe.push(character);
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn escapes_are_read_back() {
        let value = json!({"a": "x\u{9b}31m\u{1b}\u{202e}\u{7f}é"});
        let text = line(&value);
        assert!(!text.chars().any(is_harmful), "{text:?}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
        assert_eq!(
            serde_json::from_str::<Value>(&pretty(&value)).unwrap(),
            value
        );
    }

    #[test]
    fn numbers_json_lacks_are_null() {
        assert_eq!(number(f64::NAN), Value::Null);
        assert_eq!(number(-0.0).to_string(), "0.0");
        assert_eq!(number(0.1).to_string(), "0.1");
    }
}
