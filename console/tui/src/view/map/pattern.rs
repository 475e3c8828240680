//! The patterns that tell lines apart without colours.

use super::pen::DOTS;

/// Dots of a line from one stroke across it to the next.
const TICK_DOTS: usize = 5;

/// How far a zigzag line swings, dots.
const SWING: usize = 3;

/// How far a zigzag line is from its side at a distance along the line, dots.
fn swing(step: usize) -> usize {
    let at = step % (2 * SWING);
    at.min(2 * SWING - at)
}

/// How the dots of a line are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::view) enum Pattern {
    /// Every dot.
    Solid,
    /// Short dashes.
    Dashed,
    /// Every third dot.
    Dotted,
    /// Dashes of two dots with gaps as long.
    Stitched,
    /// A line with short strokes across it.
    Ticked,
    /// Two dots wide.
    Thick,
    /// Long dashes.
    LongDashed,
    /// Two lines side by side.
    Double,
    /// A line that jumps from side to side.
    Jagged,
    /// Short pieces, two dots wide.
    Beaded,
    /// Long dashes with a dot between them.
    DashDotted,
    /// A line that swings widely from side to side.
    Zigzag,
    /// A line with many strokes across it.
    Rope,
}

impl Pattern {
    /// The pattern of a line of letters, which is one letter wide.
    pub(super) fn in_letters(self) -> Self {
        match self {
            Self::Double
            | Self::Thick
            | Self::Ticked
            | Self::Jagged
            | Self::Beaded
            | Self::Zigzag
            | Self::Rope => Self::Solid,
            narrow => narrow,
        }
    }

    /// Whether the dot at a distance along the line is set.
    pub(super) fn is_on(self, step: usize) -> bool {
        match self {
            Self::Solid
            | Self::Double
            | Self::Thick
            | Self::Ticked
            | Self::Jagged
            | Self::Zigzag
            | Self::Rope => true,
            Self::Beaded | Self::Stitched => step % 4 < 2,
            Self::DashDotted => step % 6 != 3 && step % 6 != 5,
            Self::Dashed => step % 5 < 3,
            Self::Dotted => step.is_multiple_of(3),
            Self::LongDashed => step % 8 < 5,
        }
    }

    /// Sets the dots that are drawn for one dot of the line; that dot is `step` dots along the line.
    pub(super) fn dots(
        self,
        (x, y): (usize, usize),
        (step, is_flat): (usize, bool),
        mut set: impl FnMut(usize, usize),
    ) {
        match (self, is_flat) {
            (Self::Thick | Self::Beaded, true) => {
                set(x, y);
                set(x, y + 1);
            }
            (Self::Thick | Self::Beaded, false) => {
                set(x, y);
                set(x + 1, y);
            }
            (Self::Ticked, true) if step % TICK_DOTS == TICK_DOTS / 2 => {
                (y.saturating_sub(1)..=y + 1).for_each(|y| set(x, y));
            }
            (Self::Ticked, false) if step % TICK_DOTS == TICK_DOTS / 2 => {
                (x.saturating_sub(1)..=x + 1).for_each(|x| set(x, y));
            }
            (Self::Rope, true) if step % 2 == 0 => (y.saturating_sub(1)..=y + 1).for_each(|y| set(x, y)),
            (Self::Rope, false) if step % 2 == 0 => (x.saturating_sub(1)..=x + 1).for_each(|x| set(x, y)),
            (Self::Zigzag, true) => set(x, (y + swing(step)).saturating_sub(SWING / 2)),
            (Self::Zigzag, false) => set((x + swing(step)).saturating_sub(SWING / 2), y),
            (Self::Jagged, true) => set(x, y + step % 2),
            (Self::Jagged, false) => set(x + step % 2, y),
            (Self::Double, true) => {
                set(x, y.saturating_sub(1));
                set(x, y + 1);
            }
            (Self::Double, false) => {
                set(x.saturating_sub(1), y);
                set(x + 1, y);
            }
            _ => set(x, y),
        }
    }

    /// A horizontal piece of the line, in a number of characters.
    pub(super) fn sample(self, columns: u16) -> String {
        let mut set = std::collections::BTreeSet::new();
        for x in (0..usize::from(columns * DOTS.0)).filter(|x| self.is_on(*x)) {
            self.dots((x, 2), (x, true), |x, y| {
                set.insert((x, y));
            });
        }
        braille(columns, |x, y| set.contains(&(x, y)))
    }
}

/// A row of braille characters and blanks, with the dots for which a predicate holds.
pub(super) fn braille(columns: u16, is_set: impl Fn(usize, usize) -> bool) -> String {
    /// The bits of the dots of a character, row by row.
    const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
    let cell = |column: usize| {
        let dots = BITS
            .iter()
            .enumerate()
            .flat_map(|(y, bits)| bits.iter().enumerate().map(move |(x, bit)| (x, y, bit)));
        let set = dots.filter(|(x, y, _)| is_set(2 * column + x, *y));
        match set.map(|(.., bit)| bit).sum::<u32>() {
            0 => ' ',
            bits => char::from_u32(0x2800 + bits).unwrap_or(' '),
        }
    };
    (0..usize::from(columns)).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pattern_has_its_own_sample() {
        let all = [
            Pattern::Solid,
            Pattern::Dashed,
            Pattern::Dotted,
            Pattern::Stitched,
            Pattern::Ticked,
            Pattern::Thick,
            Pattern::LongDashed,
            Pattern::Double,
            Pattern::Jagged,
            Pattern::Beaded,
            Pattern::DashDotted,
            Pattern::Zigzag,
            Pattern::Rope,
        ];
        let samples = all.map(|pattern| pattern.sample(4));
        assert_eq!(
            samples,
            [
                "⠤⠤⠤⠤",
                "⠤⠄⠠⠤",
                "⠄⠠ ⠄",
                "⠤ ⠤ ",
                "⠤⡦⠤⢴",
                "⣤⣤⣤⣤",
                "⠤⠤⠄ ",
                "⣒⣒⣒⣒",
                "⢄⢄⢄⢄",
                "⣤ ⣤ ",
                "⠤⠄⠄⠤",
                "⠢⡀⡠⠢",
                "⡦⡦⡦⡦"
            ]
            .map(str::to_owned)
        );
    }
}
