//! How much memory a run may take, and how much its nodes took.

mod guard;
mod meter;

pub use guard::MemoryGuard;
pub(crate) use guard::{left, limit, set_limit};
pub(crate) use meter::{Span, count_this_thread};

/// The way out where memory is short.
pub(crate) const TOO_LARGE: &str =
    "make a smaller result, with fewer levels or cells, or raise `--max-memory`";

/// What is assumed where the system does not tell.
const FALLBACK: u64 = 8 << 30;

/// Address space that stacks of threads and the allocator's own books take.
const RESERVE: u64 = 64 << 20;

/// The default limit: the least of 3/4 of the machine's memory, the process's
/// address space limit (`ulimit -v`) and the control group's limit. Of the
/// address space, what is mapped already and [`RESERVE`] are left out.
pub(crate) fn default_limit() -> u64 {
    let file = |path: &str| {
        std::fs::File::open(path)
            .and_then(std::io::read_to_string)
            .ok()
    };
    let total = file("/proc/meminfo").as_deref().and_then(total_memory);
    let space = file("/proc/self/limits").as_deref().and_then(address_space);
    let mapped = file("/proc/self/status").as_deref().and_then(mapped);
    let space = space.map(|bytes| room(bytes, mapped.unwrap_or(0)));
    let group = [
        "/sys/fs/cgroup/memory.max",
        "/sys/fs/cgroup/memory/memory.limit_in_bytes",
    ];
    let group = group
        .iter()
        .filter_map(|path| file(path)?.trim().parse().ok())
        .min();
    let total = total.map(|bytes| bytes / 4 * 3);
    [total, space, group]
        .into_iter()
        .flatten()
        .min()
        .unwrap_or(FALLBACK)
}

/// What an address space of `bytes` leaves for results; a quarter at least, so
/// that small work goes on under any limit that lets the program start.
fn room(bytes: u64, mapped: u64) -> u64 {
    bytes.saturating_sub(mapped + RESERVE).max(bytes / 4)
}

/// Bytes from "MemTotal:       16384 kB".
fn total_memory(meminfo: &str) -> Option<u64> {
    kibibytes(meminfo, "MemTotal:")
}

/// Bytes of address space in use, from "VmSize:     3048 kB".
fn mapped(status: &str) -> Option<u64> {
    kibibytes(status, "VmSize:")
}

/// The bytes of a line such as "MemTotal:       16384 kB".
fn kibibytes(table: &str, label: &str) -> Option<u64> {
    let line = table.lines().find_map(|line| line.strip_prefix(label))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Bytes from "Max address space  500000000  unlimited  bytes".
fn address_space(limits: &str) -> Option<u64> {
    let line = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Reads "500000000", "512MB", "1.5 GiB", "2G": B, kB, MB, GB, TB are powers of
/// 1000; KiB, MiB, GiB, TiB, and K, M, G, T alone, powers of 1024.
///
/// # Errors
/// In words, when it is no such size.
pub(crate) fn parse_size(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let split = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(split);
    let unit = unit.trim().to_ascii_lowercase();
    let (base, prefix): (f64, &str) = match unit.strip_suffix("ib") {
        Some(prefix) => (1024.0, prefix),
        None => match unit.strip_suffix('b') {
            Some(prefix) => (1000.0, prefix),
            None => (1024.0, unit.as_str()),
        },
    };
    let factor = match prefix {
        "" => 1.0,
        "k" => base,
        "m" => base * base,
        "g" => base * base * base,
        "t" => base * base * base * base,
        _ => return Err(format!("`{unit}` is no unit of bytes; write 2GB or 512MiB")),
    };
    match number.parse::<f64>() {
        Ok(number) if number > 0.0 && number * factor >= 1.0 => Ok((number * factor) as u64),
        _ => Err("not a size above 0; write 2GB or 512MiB".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        for (text, bytes) in [
            ("500000000", 500_000_000),
            ("1 kB", 1000),
            ("2GB", 2_000_000_000),
            ("512MiB", 512 << 20),
            ("1.5g", 3 << 29),
            ("7b", 7),
        ] {
            assert_eq!(parse_size(text), Ok(bytes), "{text}");
        }
        for text in ["", "-1", "0", "1 apple", "1e9", "GB", "0.1b", "1..2"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_systems_tables_are_read() {
        assert_eq!(
            total_memory("MemTotal:       16 kB\nMemFree: 1 kB\n"),
            Some(16 << 10)
        );
        let limits = "Limit   Soft Limit   Hard Limit   Units\n\
                      Max address space         512000000            unlimited            bytes\n";
        assert_eq!(address_space(limits), Some(512_000_000));
        let unlimited = "Max address space         unlimited            unlimited            bytes";
        assert_eq!(address_space(unlimited), None);
        assert_eq!(mapped("Name:\tx\nVmSize:\t    16 kB\n"), Some(16 << 10));
        assert_eq!(room(1 << 30, 1 << 20), (1 << 30) - (1 << 20) - RESERVE);
        assert_eq!(room(64 << 20, 60 << 20), 16 << 20);
        assert!(default_limit() > 0);
    }
}
