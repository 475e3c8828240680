//! Removes invisible characters from the screen, wherever the text came from.

use foreign::is_plain;
use ratatui::buffer::Buffer;

/// Removes invisible characters from every cell; a cell that would become empty shows a placeholder.
pub(super) fn make(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if !cell.symbol().chars().all(is_plain) {
            let seen: String = cell.symbol().chars().filter(|c| is_plain(*c)).collect();
            cell.set_symbol(if seen.is_empty() { "�" } else { &seen });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

    #[test]
    fn no_cell_turns_its_line_around() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 3, 1));
        for (cell, symbol) in buffer.content.iter_mut().zip(["a\u{202e}", "\u{9b}", "u\u{308}"]) {
            cell.set_symbol(symbol);
        }
        make(&mut buffer);
        assert_eq!(
            buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect::<String>(),
            "a�u\u{308}"
        );
    }
}
