//! When to look: editors write a file in several steps, and programs many
//! files one after the other.

use std::time::{Duration, Instant};

/// Nothing may have happened for this long.
const QUIET: Duration = Duration::from_millis(40);

/// But if something happens all the time, this is long enough to wait.
const LONGEST: Duration = Duration::from_millis(500);

/// Waits for a pause; knows no clock.
#[derive(Debug, Default)]
pub(super) struct Debounce {
    /// When the first and the last thing happened since the last pause.
    happened: Option<(Instant, Instant)>,
}

impl Debounce {
    /// Something happened.
    pub(super) fn note(&mut self, now: Instant) {
        let first = self.happened.map_or(now, |(first, _)| first);
        self.happened = Some((first, now));
    }

    /// When it is time to look; `None` while nothing has happened.
    pub(super) fn due(&self) -> Option<Instant> {
        self.happened
            .map(|(first, last)| (last + QUIET).min(first + LONGEST))
    }

    /// Whether it is time to look; if so, what happened is over.
    pub(super) fn take(&mut self, now: Instant) -> bool {
        let is_due = self.due().is_some_and(|due| due <= now);
        if is_due {
            self.happened = None;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks taken, in milliseconds, when things happen at these times.
    fn looks(happens: &[u64], until: u64) -> Vec<u64> {
        let (start, mut debounce) = (Instant::now(), Debounce::default());
        let mut looks = Vec::new();
        for ms in 0..until {
            let now = start + Duration::from_millis(ms);
            if debounce.take(now) {
                looks.push(ms);
            }
            if happens.contains(&ms) {
                debounce.note(now);
            }
        }
        looks
    }

    #[test]
    fn a_burst_is_looked_at_once_and_nothing_happening_never() {
        assert_eq!(looks(&[], 2000), [0; 0]);
        assert_eq!(looks(&[100], 2000), [140]);
        assert_eq!(looks(&[100, 130, 139, 150], 2000), [190]);
        assert_eq!(looks(&[100, 139, 181], 2000), [179, 221]);
    }

    #[test]
    fn an_endless_stream_is_looked_at_every_half_second() {
        let saves: Vec<u64> = (0..100).map(|save| save * 10).collect();
        // The last one, at 990, is within the second half second.
        assert_eq!(looks(&saves, 3000), [500, 1000]);
    }
}
