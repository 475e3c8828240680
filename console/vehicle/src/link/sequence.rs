//! Counts the numbered readings that arrived, and the missing ones.

/// Number of sequence numbers that are remembered, counted down from the highest one.
const WINDOW: u64 = 64;
/// A jump by more numbers than this counts as a new start, not as a loss.
const RESTART: u64 = 10_000;

/// The numbers of readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Different readings that arrived.
    pub received: u64,
    /// Readings that are missing. A reading that arrives late does not count.
    pub lost: u64,
    /// Readings that arrived more than once.
    pub doubled: u64,
    /// Readings that arrived after later ones.
    pub reordered: u64,
    /// Jumps in the numbers.
    pub restarts: u64,
}

/// The numbers of the readings so far.
#[derive(Debug, Clone, Default)]
pub struct Sequence {
    highest: Option<u64>,
    /// Bit n: whether number `highest - n` arrived.
    window: u64,
    counts: Counts,
}

impl Sequence {
    /// Takes a number; returns whether it is later than all before it.
    pub fn add(&mut self, seq: u64) -> bool {
        let Some(highest) = self.highest.filter(|highest| highest.abs_diff(seq) <= RESTART) else {
            self.counts.restarts += u64::from(self.highest.is_some());
            self.counts.received += 1;
            (self.highest, self.window) = (Some(seq), 1);
            return true;
        };
        if seq > highest {
            let steps = seq - highest;
            self.counts.lost += steps - 1;
            self.counts.received += 1;
            self.window = if steps < WINDOW { self.window << steps } else { 0 } | 1;
            self.highest = Some(seq);
            return true;
        }
        let back = highest - seq;
        if back >= WINDOW {
            // Too late to know whether this number arrived before; it still counts as lost.
            self.counts.reordered += 1;
        } else if self.window & (1 << back) != 0 {
            self.counts.doubled += 1;
        } else {
            self.window |= 1 << back;
            self.counts.received += 1;
            self.counts.reordered += 1;
            // A number before the first one was never counted as lost.
            self.counts.lost = self.counts.lost.saturating_sub(1);
        }
        false
    }

    /// The numbers begin again: the sender has restarted. The counts go on.
    pub fn restart(&mut self) {
        self.counts.restarts += u64::from(self.highest.is_some());
        (self.highest, self.window) = (None, 0);
    }

    /// The numbers so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    #[test]
    fn gaps_doubles_and_late_ones_are_told_apart() {
        let mut sequence = Sequence::default();
        let latest: Vec<bool> = [5, 6, 9, 9, 7, 10].map(|seq| sequence.add(seq)).to_vec();
        assert_eq!(latest, [true, true, true, false, false, true]);
        let counts = Counts { received: 5, lost: 1, doubled: 1, reordered: 1, restarts: 0 };
        assert_eq!(sequence.counts(), counts);
        assert!(sequence.add(u64::MAX) && sequence.add(3));
        assert_eq!(sequence.counts(), Counts { received: 7, restarts: 2, ..counts });
        sequence.restart();
        assert!(sequence.add(2));
        assert_eq!(sequence.counts(), Counts { received: 8, restarts: 3, ..counts });
    }

    proptest! {
        /// Any loss, doubles, and reordering by up to 20 numbers.
        #[test]
        fn the_sums_are_exact(
            fates in prop::collection::vec((0..10_u8, 0..20_u64), 2..500),
        ) {
            let mut sent: Vec<(u64, u64)> = vec![(0, 100)];
            for (n, (fate, delay)) in fates.iter().enumerate() {
                let (seq, at) = (101 + n as u64, 101 + n as u64 + delay);
                match fate {
                    0 => {}
                    1 => sent.extend([(at, seq), (at + 3, seq)]),
                    _ => sent.push((at, seq)),
                }
            }
            sent.sort_unstable();
            let mut sequence = Sequence::default();
            for (_, seq) in &sent {
                sequence.add(*seq);
            }
            let different: BTreeSet<u64> = sent.iter().map(|(_, seq)| *seq).collect();
            let span = different.last().expect("some") - 100 + 1;
            let counts = sequence.counts();
            prop_assert_eq!(counts.received, different.len() as u64);
            prop_assert_eq!(counts.lost, span - different.len() as u64);
            prop_assert_eq!(counts.doubled, (sent.len() - different.len()) as u64);
        }
    }
}
