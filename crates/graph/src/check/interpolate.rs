//! Texts with parameters in them: `"out_{variant}"`.

use super::inputs::Checker;
use super::scope::Named;
use crate::document::Text;
use crate::names::shown;
use crate::plan::Origin;
use crate::value::Value;

impl Checker<'_, '_> {
    /// The text with each `{name}` replaced by the value of that parameter, as
    /// written in the file's units. `{{` and `}}` stand for single braces.
    pub(super) fn interpolate(&mut self, text: &Text) -> Option<Origin> {
        let value = &text.value;
        let mut result = String::with_capacity(value.len());
        let (mut at, mut sound) = (0, true);
        while let Some(length) = value[at..].find(['{', '}']) {
            result.push_str(&value[at..at + length]);
            at += length;
            let rest = &value[at..];
            if rest.starts_with("{{") || rest.starts_with("}}") {
                result.push_str(&rest[..1]);
                at += 2;
            } else if rest.starts_with('}') {
                result.push('}');
                at += 1;
            } else if let Some(end) = rest.find('}') {
                match self.parameter_text(text, at + 1..at + end) {
                    Some(part) => result.push_str(&part),
                    None => sound = false,
                }
                at += end + 1;
            } else {
                let message = "this `{` is not closed";
                let help = "write `{name}` for a parameter, or `{{` for a brace";
                self.report("bad_text", &text.part(at..at + 1), message, "here", help);
                return None;
            }
        }
        result.push_str(&value[at..]);
        sound.then(|| Origin::Constant(Value::Text(result.into())))
    }

    fn parameter_text(&mut self, text: &Text, part: std::ops::Range<usize>) -> Option<String> {
        let name = text.value[part.clone()].trim();
        let span = text.part(part);
        let index = match self.scope.find(name) {
            Some(Named::Param(index)) => index,
            Some(Named::Opaque) => return None,
            found => {
                let message = match found {
                    Some(_) => format!("`{}` is a node; a text takes parameters", shown(name)),
                    None => format!("there is no parameter `{}`", shown(name)),
                };
                let names = self.scope.param_names();
                let help = format!(
                    "{}; a brace is written `{{{{`",
                    self.scope.suggest(name, names, "parameters")
                );
                self.report("unknown_name", &span, message, "not a parameter", help);
                return None;
            }
        };
        match self.scope.params[index].value.as_ref()? {
            Value::Text(text) => Some(text.as_ref().to_owned()),
            Value::Number(number) => Some(number.to_string()),
            Value::Integer(number) => Some(number.to_string()),
            Value::Bool(truth) => Some(truth.to_string()),
            _ => None,
        }
    }
}
