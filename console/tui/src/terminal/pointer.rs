//! Converts the terminal's mouse events into actions on the screen.

use crate::update::{Mouse, Target};
use crate::view::Places;
use crossterm::event::{MouseButton, MouseEvent, MouseEventKind};

/// The mouse state: where the drag began, and whether the mouse has moved since the button went down.
#[derive(Debug, Default)]
pub struct Pointer {
    at: Option<(u16, u16)>,
    is_dragged: bool,
}

impl Pointer {
    /// Converts a mouse event, using the places recorded for the last frame. A click counts if the button is released
    /// where it was pressed.
    pub fn take(&mut self, event: &MouseEvent, places: &Places) -> Option<Mouse> {
        let at = (event.column, event.row);
        let on = places.target(at.0, at.1);
        match event.kind {
            MouseEventKind::Down(MouseButton::Left) => {
                (self.at, self.is_dragged) = (Some(at), false);
                None
            }
            MouseEventKind::Drag(MouseButton::Left) => {
                let from = self.at.replace(at)?;
                self.is_dragged = true;
                match (places.target(from.0, from.1), on) {
                    (Target::Map(from), Target::Map(to)) => Some(Mouse::Drag { from, to }),
                    _ => None,
                }
            }
            MouseEventKind::Up(MouseButton::Left) => {
                (self.at.take().is_some() && !self.is_dragged).then_some(Mouse::Click(on))
            }
            MouseEventKind::ScrollUp => Some(Mouse::Wheel { up: true, on }),
            MouseEventKind::ScrollDown => Some(Mouse::Wheel { up: false, on }),
            _ => None,
        }
    }
}
