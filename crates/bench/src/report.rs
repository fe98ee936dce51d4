//! One line per case, in Markdown.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a benchmark prints its figures"
)]

use crate::case::{Best, Role, Runs};

/// Prints the title and the head of the table.
pub(crate) fn head(title: &str) {
    println!("\n### {title}\n");
    println!(
        "| kernel | size | ns each | in memory used before | rate | bytes each | 2 threads: ns each, faster by | against peers | against the limit |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---|---|");
}

/// Says, beside the table, that somebody takes no part.
pub(crate) fn absent(name: &str, reason: &str) {
    eprintln!("not compared with {name}: {reason}");
}

/// A line under way.
pub(crate) struct Row<'a> {
    kernel: &'a str,
    count: usize,
    unit: &'static str,
    bytes_are_rate: bool,
    ours: Runs,
    others: Vec<(&'a str, Role, Best)>,
}

impl<'a> Row<'a> {
    pub(crate) fn new(
        kernel: &'a str,
        count: usize,
        unit: &'static str,
        bytes_are_rate: bool,
    ) -> Self {
        Self {
            kernel,
            count,
            unit,
            bytes_are_rate,
            ours: Runs::default(),
            others: Vec::new(),
        }
    }

    pub(crate) fn add(&mut self, name: &'a str, role: Role, runs: Runs) {
        if role == Role::Ours {
            self.ours = runs;
        } else if let Some(alone) = runs.fresh {
            self.others.push((name, role, alone));
        }
    }

    pub(crate) fn print(&self) {
        let Some(fresh) = self.ours.fresh else {
            return;
        };
        let reused = self.ours.reused.unwrap_or(fresh);
        let each = |best: Best| best.processor.as_secs_f64() * 1e9 / self.count as f64;
        let rate = self.count as f64 / reused.processor.as_secs_f64() / 1e6;
        let (rate_unit, digits) = if self.bytes_are_rate {
            ("MB/s", 0)
        } else {
            ("M/s", 2)
        };
        let again = self
            .ours
            .reused
            .map_or(String::new(), |it| number(each(it)));
        let two = self.ours.both.map_or(String::new(), |both| {
            let faster = reused.wall.as_secs_f64() / both.wall.as_secs_f64();
            format!("{}, {faster:.2}x", number(each(both)))
        });
        println!(
            "| {} | {} {} | {} | {again} | {rate:.digits$} {rate_unit} | {} | {two} | {} | {} |",
            self.kernel,
            grouped(self.count),
            self.unit,
            number(each(fresh)),
            number(fresh.bytes as f64 / self.count as f64),
            self.against(&[Role::Peer], fresh, reused),
            self.against(&[Role::Limit, Role::ReusedLimit], fresh, reused),
        );
    }

    /// Our time beside that of the others who have one of these roles.
    fn against(&self, roles: &[Role], fresh: Best, reused: Best) -> String {
        let time = |best: Best| best.processor.as_secs_f64();
        let of_role = self
            .others
            .iter()
            .filter(|(_, role, _)| roles.contains(role));
        let text = of_role.map(|&(name, role, other)| {
            let ratio = match role {
                Role::Peer => format!("{:.2}x as fast", time(other) / time(fresh)),
                Role::ReusedLimit => format!("{:.1}x its time", time(reused) / time(other)),
                _ => format!("{:.1}x its time", time(fresh) / time(other)),
            };
            let theirs = number(time(other) * 1e9 / self.count as f64);
            format!("{name} ({theirs}): {ratio}")
        });
        text.collect::<Vec<_>>().join("; ")
    }
}

/// Three digits that count.
fn number(value: f64) -> String {
    match value {
        value if value >= 100.0 => format!("{value:.0}"),
        value if value >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

/// 1048576 as "1 048 576".
fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.5, 12.34, 1234.0].map(number), ["0.50", "12.3", "1234"]);
        assert_eq!([0, 999, 1_048_576].map(grouped), ["0", "999", "1 048 576"]);
    }
}
