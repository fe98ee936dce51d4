//! When to look: editors write a file in several steps, and programs many
//! files one after the other.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Nothing may have happened for this long.
const QUIET: Duration = Duration::from_millis(40);

/// The same when all that was begun is known to be done: what is left to wait for
/// is another file, by the same program.
const SETTLED: Duration = Duration::from_millis(8);

/// But if something happens all the time, this is long enough to wait.
const LONGEST: Duration = Duration::from_millis(500);

/// What happened to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Step {
    /// More is to come: it was made, written to, removed, or moved away.
    Begun,
    /// Who wrote it has closed it, or it was put there whole.
    Done,
    /// Something that is neither: its permissions are others.
    Other,
}

/// Waits for a pause; knows no clock.
#[derive(Debug, Default)]
pub(super) struct Debounce {
    /// When the first and the last thing happened since the last pause.
    happened: Option<(Instant, Instant)>,
    /// The files that were begun and are not done.
    begun: BTreeSet<PathBuf>,
}

impl Debounce {
    /// Something happened to these files.
    pub(super) fn note(&mut self, now: Instant, files: &BTreeSet<PathBuf>, step: Step) {
        let first = self.happened.map_or(now, |(first, _)| first);
        self.happened = Some((first, now));
        match step {
            Step::Begun => self.begun.extend(files.iter().cloned()),
            Step::Done => self.begun.retain(|file| !files.contains(file)),
            Step::Other => {}
        }
    }

    /// When it is time to look; `None` while nothing has happened.
    pub(super) fn due(&self) -> Option<Instant> {
        let (first, last) = self.happened?;
        let pause = if self.begun.is_empty() {
            SETTLED
        } else {
            QUIET
        };
        Some((last + pause).min(first + LONGEST))
    }

    /// Whether it is time to look; if so, what happened is over.
    pub(super) fn take(&mut self, now: Instant) -> bool {
        let is_due = self.due().is_some_and(|due| due <= now);
        if is_due {
            self.happened = None;
            self.begun.clear();
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Looks taken, in milliseconds, when these things happen to these files.
    fn looks_at(happens: &[(u64, &str, Step)], until: u64) -> Vec<u64> {
        let (start, mut debounce) = (Instant::now(), Debounce::default());
        let mut looks = Vec::new();
        for ms in 0..until {
            let now = start + Duration::from_millis(ms);
            if debounce.take(now) {
                looks.push(ms);
            }
            for (_, file, step) in happens.iter().filter(|(at, ..)| *at == ms) {
                debounce.note(now, &[PathBuf::from(file)].into(), *step);
            }
        }
        looks
    }

    /// The same when a file is written to at these times and never closed.
    fn looks(happens: &[u64], until: u64) -> Vec<u64> {
        let writes: Vec<_> = happens.iter().map(|&ms| (ms, "a", Step::Begun)).collect();
        looks_at(&writes, until)
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

    #[test]
    fn what_is_done_is_looked_at_sooner() {
        use Step::{Begun, Done, Other};
        let saved = [(100, "a", Begun), (102, "a", Done)];
        assert_eq!(looks_at(&saved, 500), [110]);
        assert_eq!(looks_at(&[(100, "a", Done), (103, "a", Other)], 500), [111]);
        // Another file is still being written.
        let both = [(100, "b", Begun), (101, "a", Begun), (102, "a", Done)];
        assert_eq!(looks_at(&both, 500), [142]);
        let closed = [both.as_slice(), &[(130, "b", Done)]].concat();
        assert_eq!(looks_at(&closed, 500), [138]);
        // An editor that moves the old file away and writes a new one.
        let moved = [(100, "a", Begun), (120, "a", Begun), (125, "a", Done)];
        assert_eq!(looks_at(&moved, 500), [133]);
    }
}
