//! The picture as SVG: no script, no font of its own, light or dark as its
//! reader likes.

use std::fmt::Write as _;

use super::layout::{LINE, Layout, MARGIN, PAD, Place, width_of};
use super::model::{Item, Picture, Role};

/// How far a bend reaches before it is level.
const BEND: f64 = 28.0;
/// Side of a square in the key.
const SWATCH: f64 = 12.0;

/// The picture as an SVG document; `None` if it has too many boxes.
pub(crate) fn svg(picture: &Picture) -> Option<String> {
    let layout = Layout::new(picture)?;
    let key = Key::new(picture);
    let width = layout.width.max(key.width);
    let height = layout.height + key.height;
    let mut out = String::new();
    let title = escape(&picture.title);
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" \
         viewBox=\"0 0 {0} {1}\" role=\"img\">\n<title>{title}</title>",
        number(width),
        number(height)
    );
    out.push_str(&style());
    out.push_str("<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n");
    for (edge, way) in picture.edges.iter().zip(&layout.ways) {
        let ends = [edge.from, edge.to].map(|end| &picture.boxes[end]);
        let class = if ends.iter().all(|end| end.used) {
            "edge"
        } else {
            "edge unused"
        };
        let tip = format!("{} to {}", ends[0].lines[0], ends[1].lines[0]);
        let label = match edge.label.as_str() {
            "" => String::new(),
            label => format!(": {label}"),
        };
        let _ = writeln!(
            out,
            "<path class=\"{class}\" d=\"{}\"><title>{}</title></path>",
            curve(way),
            escape(&(tip + &label))
        );
    }
    for (item, place) in picture.boxes.iter().zip(&layout.places) {
        draw(item, place, &mut out);
    }
    key.draw(layout.height, &mut out);
    out.push_str("</svg>\n");
    Some(out)
}

fn draw(item: &Item, place: &Place, out: &mut String) {
    let unused = if item.used { "" } else { " unused" };
    let _ = writeln!(
        out,
        "<g class=\"{}{unused}\"><title>{}</title>\
         <rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"5\"/>",
        item.role.name(),
        escape(&item.tip),
        number(place.x),
        number(place.y),
        number(place.width),
        number(place.height),
    );
    for (index, line) in item.lines.iter().enumerate() {
        let class = if index == 0 { "name" } else { "more" };
        let y = place.y + PAD / 2.0 + (index as f64 + 0.76) * LINE;
        let _ = writeln!(
            out,
            "<text class=\"{class}\" x=\"{}\" y=\"{}\">{}</text>",
            number(place.x + PAD),
            number(y),
            escape(line)
        );
    }
    out.push_str("</g>\n");
}

/// A line through the points that is level in every point.
fn curve(way: &[[f64; 2]]) -> String {
    let mut path = String::new();
    let [x, y] = way[0];
    let _ = write!(path, "M{} {}", number(x), number(y));
    for pair in way.windows(2) {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        if (y0 - y1).abs() < 0.05 {
            let _ = write!(path, "H{}", number(x1));
            continue;
        }
        let bend = BEND.min((x1 - x0) / 2.0);
        let _ = write!(
            path,
            "C{} {} {} {} {} {}",
            number(x0 + bend),
            number(y0),
            number(x1 - bend),
            number(y1),
            number(x1),
            number(y1)
        );
    }
    path
}

/// What the colours mean, under the picture.
struct Key {
    roles: Vec<Role>,
    width: f64,
    height: f64,
}

impl Key {
    fn new(picture: &Picture) -> Self {
        let used = |role: &Role| picture.boxes.iter().any(|item| item.role == *role);
        let roles: Vec<Role> = Role::ALL.into_iter().filter(used).collect();
        let widths = roles.iter().map(|role| Self::step(*role));
        let width = widths.sum::<f64>() + 2.0 * MARGIN;
        Self {
            roles,
            width,
            height: 2.0 * LINE,
        }
    }

    fn step(role: Role) -> f64 {
        SWATCH + width_of(role.name()) + 3.0 * PAD
    }

    fn draw(&self, top: f64, out: &mut String) {
        let mut x = MARGIN;
        for role in &self.roles {
            let _ = writeln!(
                out,
                "<g class=\"{0}\"><rect x=\"{1}\" y=\"{2}\" width=\"{SWATCH}\" \
                 height=\"{SWATCH}\" rx=\"3\"/><text class=\"more\" x=\"{3}\" y=\"{4}\">{0}</text></g>",
                role.name(),
                number(x),
                number(top),
                number(x + SWATCH + PAD * 0.6),
                number(top + SWATCH - 1.5),
            );
            x += Self::step(*role);
        }
    }
}

fn style() -> String {
    let mut css = String::from(
        "<style>\n\
         text { font: 13px \"DejaVu Sans Mono\", Menlo, Consolas, \"Liberation Mono\", monospace; fill: #1a1a1a }\n\
         .name { font-weight: bold }\n.more { fill: #4d4d4d }\n\
         .ground { fill: #ffffff }\n.edge { fill: none; stroke: #7a7a7a; stroke-width: 1.4 }\n\
         .unused { opacity: 0.45 }\n",
    );
    for role in Role::ALL {
        css += &rule(role, role.light());
    }
    css.push_str(
        ".parameter rect { stroke-dasharray: 4 3 }\n\
         @media (prefers-color-scheme: dark) {\n\
         text { fill: #f0f0f0 }\n.more { fill: #c4c4c4 }\n\
         .ground { fill: #141414 }\n.edge { stroke: #9a9a9a }\n",
    );
    for role in Role::ALL {
        css += &rule(role, role.dark());
    }
    css.push_str("}\n</style>\n");
    css
}

fn rule(role: Role, (fill, line): (&str, &str)) -> String {
    format!(".{} rect {{ fill: {fill}; stroke: {line} }}\n", role.name())
}

/// A number of pixels with one decimal at most.
fn number(number: f64) -> String {
    let text = format!("{number:.1}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// Text for an element or an attribute.
pub(super) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            other => safe.push(other),
        }
    }
    safe
}
