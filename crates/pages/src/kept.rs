//! Which freed memory is kept, as ranges of addresses.

/// Bytes from `start` on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Range {
    pub(crate) start: usize,
    pub(crate) len: usize,
}

impl Range {
    fn end(self) -> usize {
        self.start + self.len
    }
}

/// Ranges apart from each other, by address. Holds no memory of its own beyond
/// a fixed table, so that an allocator may use it.
#[derive(Debug)]
pub(crate) struct Kept {
    ranges: [Range; ROOM],
    count: usize,
    total: usize,
}

/// Ranges that a table holds; graphs free some hundred buffers at most, many of
/// them side by side.
const ROOM: usize = 512;

impl Kept {
    pub(crate) const fn new() -> Self {
        Self {
            ranges: [Range { start: 0, len: 0 }; ROOM],
            count: 0,
            total: 0,
        }
    }

    /// Bytes of all ranges.
    pub(crate) fn total(&self) -> usize {
        self.total
    }

    /// Adds a range that overlaps none; neighbours become one. `false` when the
    /// table is full.
    pub(crate) fn put(&mut self, range: Range) -> bool {
        let ranges = &self.ranges[..self.count];
        let place = ranges.partition_point(|other| other.start < range.start);
        let follows = place > 0 && ranges[place - 1].end() == range.start;
        let leads = place < self.count && range.end() == ranges[place].start;
        match (follows, leads) {
            (true, true) => {
                self.ranges[place - 1].len += range.len + self.ranges[place].len;
                self.remove(place);
            }
            (true, false) => self.ranges[place - 1].len += range.len,
            (false, true) => {
                self.ranges[place].start = range.start;
                self.ranges[place].len += range.len;
            }
            (false, false) => {
                if self.count == ROOM {
                    return false;
                }
                self.ranges.copy_within(place..self.count, place + 1);
                self.ranges[place] = range;
                self.count += 1;
            }
        }
        self.total += range.len;
        true
    }

    /// Takes `len` bytes out of the smallest range that has them.
    pub(crate) fn take(&mut self, len: usize) -> Option<usize> {
        let fitting = self.smallest(|range| range.len >= len)?;
        Some(self.cut(fitting, len).start)
    }

    /// Takes at most `len` bytes out of the smallest range.
    pub(crate) fn take_some(&mut self, len: usize) -> Option<Range> {
        let smallest = self.smallest(|_| true)?;
        Some(self.cut(smallest, len.min(self.ranges[smallest].len)))
    }

    fn smallest(&self, wanted: impl Fn(&Range) -> bool) -> Option<usize> {
        let numbered = self.ranges[..self.count].iter().enumerate();
        let fitting = numbered.filter(|(_, range)| wanted(range));
        fitting.min_by_key(|(_, range)| range.len).map(|(k, _)| k)
    }

    /// Cuts the first `len` bytes off a range.
    fn cut(&mut self, place: usize, len: usize) -> Range {
        let range = &mut self.ranges[place];
        let start = range.start;
        range.start += len;
        range.len -= len;
        if range.len == 0 {
            self.remove(place);
        }
        self.total -= len;
        Range { start, len }
    }

    fn remove(&mut self, place: usize) {
        self.ranges.copy_within(place + 1..self.count, place);
        self.count -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small linear congruential generator (Knuth).
    struct Dice(u64);

    impl Dice {
        fn below(&mut self, limit: usize) -> usize {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (self.0 >> 33) as usize % limit
        }
    }

    #[test]
    fn nothing_is_kept_twice_or_lost() {
        let mut dice = Dice(7);
        let mut kept = Kept::new();
        // One flag per byte: whether it is kept.
        let mut flags = vec![false; 4000];
        for _ in 0..20_000 {
            let len = 1 + dice.below(60);
            if dice.below(2) == 0 {
                let start = dice.below(flags.len() - len);
                if flags[start..start + len].contains(&true) {
                    continue;
                }
                assert!(kept.put(Range { start, len }), "4000 bytes fit the table");
                flags[start..start + len].fill(true);
            } else {
                let longest = flags.split(|kept| !kept).map(<[bool]>::len).max();
                let start = kept.take(len);
                assert_eq!(start.is_some(), longest >= Some(len));
                let Some(start) = start else { continue };
                assert!(flags[start..start + len].iter().all(|&kept| kept));
                flags[start..start + len].fill(false);
            }
            assert_eq!(kept.total(), flags.iter().filter(|&&kept| kept).count());
        }
        while let Some(range) = kept.take_some(50) {
            assert!(range.len <= 50 && range.len > 0);
            assert!(flags[range.start..range.end()].iter().all(|&kept| kept));
            flags[range.start..range.end()].fill(false);
        }
        assert!(kept.total() == 0 && !flags.contains(&true));
    }

    #[test]
    fn a_full_table_refuses_what_has_no_neighbour() {
        let mut kept = Kept::new();
        for k in 0..ROOM {
            assert!(kept.put(Range {
                start: 3 * k,
                len: 1
            }));
        }
        assert!(!kept.put(Range {
            start: 3 * ROOM,
            len: 1
        }));
        assert!(kept.put(Range { start: 1, len: 2 }));
        assert_eq!((kept.total(), kept.count), (ROOM + 2, ROOM - 1));
        assert_eq!(kept.take(4), Some(0));
    }
}
