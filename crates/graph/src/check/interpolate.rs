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
    ///
    /// A path is named from the folder of the file it is written in: its own, or
    /// that of the path parameter it begins with.
    pub(super) fn interpolate(&mut self, text: &Text, is_path: bool) -> Option<Origin> {
        let mut value = self.interpolated(text)?;
        if is_path {
            value = in_folder(&self.folder_of(text), &value);
        }
        Some(Origin::Constant(Value::Text(value.into())))
    }

    /// The folder that a path in the text is named from.
    pub(super) fn folder_of(&self, text: &Text) -> String {
        let first = text
            .value
            .strip_prefix('{')
            .filter(|rest| !rest.starts_with('{'));
        let first = first.and_then(|rest| rest.split('}').next());
        let param = match first.and_then(|name| self.scope.find(name.trim())) {
            Some(Named::Param(index)) => self.scope.params[index].folder.as_deref(),
            _ => None,
        };
        param.unwrap_or(self.scope.folder).to_owned()
    }

    /// The text with parameters in their places.
    pub(super) fn interpolated(&mut self, text: &Text) -> Option<String> {
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
        sound.then_some(result)
    }

    fn parameter_text(&mut self, text: &Text, part: std::ops::Range<usize>) -> Option<String> {
        let name = text.value[part.clone()].trim();
        let span = text.part(part);
        let index = match self.scope.find(name) {
            Some(Named::Param(index)) if self.scope.given.computed[index].is_some() => {
                let message = format!(
                    "`{}` is given by a node; a text takes what is known before",
                    shown(name)
                );
                let help = "give the input a value that depends on parameters only";
                self.report("not_known_yet", &span, message, "only known later", help);
                return None;
            }
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

/// A path written in a file of that folder, from the main graph's folder.
pub(super) fn in_folder(folder: &str, path: &str) -> String {
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    if path.is_empty() || path.starts_with(['/', '\\']) || has_drive {
        return path.to_owned();
    }
    format!("{folder}{path}")
}
