//! What a slow line gets of a frame: the rows with the state of the robot at once, and as many of the others as the line
//! takes in a short time. A frame of 10 kB would keep a HOLD from a line of 2 kB/s for 5 s.

use super::cells;
use ratatui::buffer::Buffer;

/// Rows at the bottom of the screen that are always sent: the question, the state and the keys.
const BELOW: u16 = 5;

/// The frame as the terminal shows it, and where the next one goes on.
#[derive(Debug, Default)]
pub(super) struct Ration {
    shown: Buffer,
    /// The row with which the next frame begins, after those that are always sent.
    next: u16,
}

impl Ration {
    /// Notes that the terminal shows a frame.
    pub(super) fn shows(&mut self, frame: &Buffer) {
        self.shown.clone_from(frame);
    }

    /// Notes that the terminal was cleared.
    pub(super) fn is_cleared(&mut self) {
        self.shown.reset();
    }

    /// Keeps a frame to about `most` bytes, and to one row at least: the rows that do not fit stay as the terminal shows them.
    /// Returns whether some were left out.
    pub(super) fn limit(&mut self, frame: &mut Buffer, most: usize) -> bool {
        let area = frame.area;
        if self.shown.area != area {
            // The terminal was cleared when its size changed.
            self.shown = Buffer::empty(area);
        }
        let rows = area.height;
        let is_always = |row: u16| row == 0 || row + BELOW >= rows;
        let always = (0..rows).filter(|row| is_always(*row));
        let mut used: usize = always.map(|row| self.cost(frame, row)).sum();
        let others = (self.next..rows).chain(0..self.next.min(rows)).filter(|row| !is_always(*row));
        let (mut first_left, mut has_sent) = (None, false);
        for row in others {
            let cost = self.cost(frame, row);
            if first_left.is_none() && (used + cost <= most || !has_sent) {
                used += cost;
                has_sent |= cost > 0;
            } else if cost > 0 {
                first_left.get_or_insert(row);
                self.keep(frame, row);
            }
        }
        self.next = first_left.unwrap_or(0);
        first_left.is_some()
    }

    /// The bytes that the changes of a row take.
    fn cost(&self, frame: &Buffer, row: u16) -> usize {
        let changed = range(frame, row).filter(|at| frame.content[*at] != self.shown.content[*at]);
        let placed = changed.map(|at| {
            let (x, y) = frame.pos_of(at);
            (x, y, &frame.content[at])
        });
        let mut bytes = Vec::new();
        // Writing to memory cannot fail.
        let _ = cells::write(&mut bytes, placed);
        bytes.len()
    }

    /// Replaces a row of a frame by what the terminal shows.
    fn keep(&self, frame: &mut Buffer, row: u16) {
        let range = range(frame, row);
        frame.content[range.clone()].clone_from_slice(&self.shown.content[range]);
    }
}

/// The places of a row in a frame.
fn range(frame: &Buffer, row: u16) -> std::ops::Range<usize> {
    let width = usize::from(frame.area.width);
    let first = usize::from(row) * width;
    first..first + width
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use ratatui::layout::Rect;

    fn frame(size: (u16, u16), letter: impl Fn(u16) -> char) -> Buffer {
        let mut frame = Buffer::empty(Rect::new(0, 0, size.0, size.1));
        for row in 0..size.1 {
            for column in 0..size.0 {
                frame[(column, row)].set_char(letter(row));
            }
        }
        frame
    }

    fn row(frame: &Buffer, row: u16) -> String {
        range(frame, row).map(|at| frame.content[at].symbol()).collect()
    }

    #[test]
    fn the_state_is_sent_at_once_and_the_other_rows_follow() {
        let mut ration = Ration::default();
        let whole = frame((20, 10), |_| 'a');
        let mut sent = whole.clone();
        assert!(ration.limit(&mut sent, 150));
        let is_sent = |sent: &Buffer| (0..10).map(|at| row(sent, at).contains('a')).collect::<Vec<_>>();
        let (yes, no) = (true, false);
        assert_eq!(is_sent(&sent), [yes, yes, no, no, no, yes, yes, yes, yes, yes]);
        ration.shows(&sent);
        // A HOLD in the meantime comes before the rest of the map.
        let held = frame((20, 10), |row| if row == 0 { 'H' } else { 'a' });
        let mut sent = held.clone();
        assert!(ration.limit(&mut sent, 60));
        assert!(row(&sent, 0).contains('H') && row(&sent, 2).contains('a'), "{sent:?}");
        assert!(!row(&sent, 4).contains('a'), "{sent:?}");
        ration.is_cleared();
        let mut sent = held.clone();
        assert!(
            ration.limit(&mut sent, 60) && row(&sent, 3).contains('a'),
            "it goes on where it was: {sent:?}"
        );
        let mut other = frame((21, 10), |_| 'b');
        assert!(ration.limit(&mut other, 60), "a frame of another size begins with a blank terminal");
    }

    proptest! {
        #[test]
        fn every_row_is_shown_in_the_end_and_no_frame_is_much_larger_than_asked(
            width in 1_u16..40, height in 1_u16..30, most in 0_usize..600, before in any::<[u8; 30]>(),
        ) {
            let mut ration = Ration::default();
            ration.shows(&frame((width, height), |row| char::from(b'a' + before[usize::from(row)] % 3)));
            let whole = frame((width, height), |_| 'a');
            let dearest = usize::from(width) + 12;
            for turn in 0.. {
                let mut sent = whole.clone();
                let cost = |ration: &Ration, sent: &Buffer| (0..height).map(|row| ration.cost(sent, row)).sum::<usize>();
                let is_behind = ration.limit(&mut sent, most);
                prop_assert!(cost(&ration, &sent) <= most + 7 * dearest);
                ration.shows(&sent);
                prop_assert_eq!(is_behind, sent != whole);
                if !is_behind {
                    break;
                }
                prop_assert!(turn < height, "it makes no progress");
            }
        }
    }
}
