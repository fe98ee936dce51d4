//! Processor time: other programs on the machine do not count.

use std::time::Duration;

/// Processor time this process has used, all threads together.
#[cfg(unix)]
pub(crate) fn processor_time() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID);
    time.expect("every unix counts processor time").into()
}

/// Elsewhere the wall clock has to do.
#[cfg(not(unix))]
pub(crate) fn processor_time() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

/// Processor time of all child processes that have ended; `None` where the
/// system does not tell.
pub(crate) fn children_time() -> Option<Duration> {
    #[cfg(unix)]
    {
        use nix::sys::resource::{UsageWho, getrusage};
        use nix::sys::time::TimeValLike;
        let usage = getrusage(UsageWho::RUSAGE_CHILDREN).ok()?;
        let microseconds =
            usage.user_time().num_microseconds() + usage.system_time().num_microseconds();
        Some(Duration::from_micros(microseconds.unsigned_abs()))
    }
    #[cfg(not(unix))]
    None
}

/// The most bytes a running process has held up to now; `None` where the system
/// does not tell.
#[expect(clippy::disallowed_methods, reason = "a benchmark is no node")]
pub(crate) fn most_held(process: u32) -> Option<usize> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: usize = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
