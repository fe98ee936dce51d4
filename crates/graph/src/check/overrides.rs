//! Values for parameters from outside the file: `--set name=value`.

use crate::document::{Number, ParamKind, Parameter, Problems};
use crate::names::shown;
use crate::value::Value;

use super::scope::suggest;

/// The code of errors about values from outside the file: the file itself may
/// be right.
pub const WRONG_SETTING: &str = "wrong_setting";

/// Gives parameters the values of `set`; numbers are in the file's units.
pub(super) fn apply(params: &mut [Parameter], set: &[(String, String)], problems: &mut Problems) {
    for (name, text) in set {
        let place = params.iter().position(|param| param.name.value == *name);
        let Some(place) = place else {
            let message = format!(
                "`--set {}={}`: the graph has no parameter `{}`",
                shown(name),
                shown(text),
                shown(name)
            );
            let names = params.iter().map(|param| param.name.value.as_str());
            let help = suggest(name, names, "its parameters");
            problems.add(problems.placeless(WRONG_SETTING, message).with_help(help));
            continue;
        };
        match parse(&params[place], text) {
            Ok(value) => params[place].value = Some(value),
            Err(refusal) => report(&params[place], text, refusal, problems),
        }
    }
}

/// The value that a text stands for, as `--set` reads it.
///
/// # Errors
/// In words, with a way out.
pub(crate) fn value_of(param: &Parameter, text: &str) -> Result<Value, String> {
    parse(param, text).map_err(|Refusal { message, help }| match help.as_str() {
        "" => message,
        help => format!("{message}; {help}"),
    })
}

/// Why a value is refused, and a way out.
struct Refusal {
    message: String,
    help: String,
}

fn parse(param: &Parameter, text: &str) -> Result<Value, Refusal> {
    let wrong = |help: &str| Refusal {
        message: format!(
            "`{}` takes {}",
            shown(&param.name.value),
            param.kind.label()
        ),
        help: help.to_owned(),
    };
    match param.kind {
        ParamKind::Text | ParamKind::Path => Ok(Value::Text(text.into())),
        ParamKind::Bool => match text.trim() {
            "true" => Ok(Value::Bool(true)),
            "false" => Ok(Value::Bool(false)),
            _ => Err(wrong("write true or false")),
        },
        ParamKind::Choice => param
            .choice(text.trim())
            .map_err(|(message, help)| Refusal {
                message,
                help: help.unwrap_or_default(),
            }),
        ParamKind::Number | ParamKind::Integer => {
            let text = text.trim();
            let whole = param.kind == ParamKind::Integer;
            let number = match (text.parse::<i64>(), text.parse::<f64>()) {
                (Ok(number), _) => Number::Whole(number),
                (Err(_), Ok(number)) if whole && number.fract() != 0.0 => {
                    return Err(wrong("write a whole number such as 3"));
                }
                (Err(_), Ok(number)) if number.is_finite() => Number::Real(number),
                (Err(_), _) if whole => return Err(wrong("write a whole number such as 3")),
                (Err(_), _) => return Err(wrong("write a number such as 0.12, with a point")),
            };
            param.number(number).map_err(|message| Refusal {
                message,
                help: "the parameter declares its range; give a value within it".to_owned(),
            })
        }
    }
}

fn report(param: &Parameter, text: &str, refusal: Refusal, problems: &mut Problems) {
    let message = format!(
        "`--set {}={}`: {}",
        shown(&param.name.value),
        shown(text),
        refusal.message
    );
    let error = problems.error(WRONG_SETTING, &param.span, message, "declared here");
    problems.add(error.with_help(refusal.help));
}
