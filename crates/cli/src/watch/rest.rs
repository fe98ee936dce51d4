//! When nobody has edited for a while: memory that the next edit would have used again
//! is given back then.

use std::time::{Duration, Instant};

/// Nothing was at work for this long.
const LONG: Duration = Duration::from_secs(30);

/// Waits for a rest; knows no clock.
#[derive(Debug, Default)]
pub(super) struct Rest {
    /// When something was at work last; nothing once the rest has been made use of.
    worked: Option<Instant>,
}

impl Rest {
    /// Something has just been at work.
    pub(super) fn disturb(&mut self, now: Instant) {
        self.worked = Some(now);
    }

    /// Whether it has been quiet for long; once, until it is disturbed again.
    pub(super) fn take(&mut self, now: Instant) -> bool {
        let is_long = |worked: Instant| now.saturating_duration_since(worked) >= LONG;
        self.worked.take_if(|worked| is_long(*worked)).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rest_is_long_and_comes_once() {
        let (start, mut rest) = (Instant::now(), Rest::default());
        let at = |seconds| start + Duration::from_secs(seconds);
        assert!(!rest.take(at(100)), "nothing has been at work");
        rest.disturb(at(0));
        rest.disturb(at(20));
        assert!(!rest.take(at(49)));
        assert!(rest.take(at(50)) && !rest.take(at(51)) && !rest.take(at(200)));
        rest.disturb(at(300));
        assert!(!rest.take(at(310)) && rest.take(at(331)));
    }
}
