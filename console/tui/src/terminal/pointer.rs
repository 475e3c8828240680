//! Converts the terminal's mouse reports into actions on the screen.

use super::decode::{Gesture, Pointed};
use crate::update::{Mouse, Target};
use crate::view::Places;

/// The mouse state: where the drag began, and whether the mouse has moved since the button went down.
#[derive(Debug, Default)]
pub struct Pointer {
    at: Option<(u16, u16)>,
    is_dragged: bool,
}

impl Pointer {
    /// Converts a report, using the places recorded for the last frame. A click counts if the button is released where
    /// it was pressed.
    pub fn take(&mut self, pointed: Pointed, places: &Places) -> Option<Mouse> {
        let at = (pointed.column, pointed.row);
        let on = places.target(at.0, at.1);
        match pointed.gesture {
            Gesture::Down => {
                (self.at, self.is_dragged) = (Some(at), false);
                None
            }
            Gesture::Drag => {
                let from = self.at.replace(at)?;
                self.is_dragged = true;
                match (places.target(from.0, from.1), on) {
                    (Target::Map(from), Target::Map(to)) => Some(Mouse::Drag { from, to }),
                    _ => None,
                }
            }
            Gesture::Up => (self.at.take().is_some() && !self.is_dragged).then_some(Mouse::Click(on)),
            Gesture::Wheel { up } => Some(Mouse::Wheel { up, on }),
        }
    }
}
