//! Data kept between frames: expensive results that rarely change, and the places that respond to the mouse. A cold
//! cache gives the same cells as a warm one.

use super::map::{PlateDrawing, PlateKey, ShadeKey, Shades, Window};
use crate::actions::ActionId;
use crate::model::{Earlier, Raster, Run, RunId, replay::Shares};
use crate::update::{Rows, Target};
use ratatui::layout::{Position, Rect};
use std::rc::Rc;
use world::{Floor, PlateMap};

/// Data kept between frames.
#[derive(Debug, Default)]
pub struct Cache {
    /// The newest shades are last. The legend needs the shades of the whole area; the map needs the shades of the
    /// area without the legend.
    shades: Vec<(ShadeKey, Shades)>,
    plate_map: Option<(PlateMapKey, Rc<PlateMap>)>,
    plates: Option<(PlateKey, Rc<PlateDrawing>)>,
    shares: Option<((u64, u64), Shares)>,
    rescan: Option<((u64, u64), [account::Shares; 2])>,
    requested: Option<((RunId, u64), Option<account::Shares>)>,
    places: Places,
    /// Whether a title of this frame names the screen.
    is_titled: bool,
}

/// The places in the last frame that respond to the mouse.
#[derive(Debug, Clone, Default)]
pub struct Places {
    map: Option<(Rect, Window)>,
    keys: Vec<(Rect, ActionId)>,
    rows: Vec<(Rect, Rows, usize)>,
}

/// The inputs from which the plate map is computed.
#[derive(Debug, Clone, PartialEq)]
struct PlateMapKey {
    layout: world::PlateLayout,
    cells: usize,
    origin: world::Point,
}

impl Cache {
    /// The places in the last frame that respond to the mouse.
    pub fn places(&self) -> &Places {
        &self.places
    }

    /// Forgets the places and titles of the last frame.
    pub(super) fn clear_places(&mut self) {
        self.places = Places::default();
        self.is_titled = false;
    }

    /// Whether the next title is the first one of the frame.
    pub(super) fn is_first_title(&mut self) -> bool {
        !std::mem::replace(&mut self.is_titled, true)
    }

    /// Records the area of the map.
    pub(super) fn place_map(&mut self, area: Rect, window: Window) {
        self.places.map = Some((area, window));
    }

    /// Records the area of a key name.
    pub(super) fn place_key(&mut self, area: Rect, id: ActionId) {
        self.places.keys.push((area, id));
    }

    /// Records the area of a list line.
    pub(super) fn place_row(&mut self, area: Rect, list: Rows, index: usize) {
        self.places.rows.push((area, list, index));
    }

    pub(super) fn shades(&mut self, key: ShadeKey, make: impl FnOnce() -> Shades) -> Shades {
        if let Some((_, shades)) = self.shades.iter().find(|(before, _)| *before == key) {
            return Rc::clone(shades);
        }
        let shades = make();
        self.shades.push((key, Rc::clone(&shades)));
        if self.shades.len() > 2 {
            self.shades.remove(0);
        }
        shades
    }

    pub(super) fn plates(
        &mut self,
        key: PlateKey,
        make: impl FnOnce() -> Rc<PlateDrawing>,
    ) -> Rc<PlateDrawing> {
        kept(&mut self.plates, key, make)
    }

    /// The shares of the floor that each of two runs scanned.
    pub(super) fn shares(&mut self, a: &Raster, b: &Raster) -> Shares {
        kept(&mut self.shares, (a.stamp(), b.stamp()), || Shares::of(a, b))
    }

    /// The shares of a re-scan, whose own floor is given.
    pub(super) fn rescan(&mut self, before: &Earlier, own: &Raster) -> [account::Shares; 2] {
        kept(&mut self.rescan, (before.raster.stamp(), own.stamp()), || before.shares(own))
    }

    /// The shares of the floor that was requested of the open run.
    pub(super) fn requested(&mut self, id: RunId, run: &Run) -> Option<account::Shares> {
        let stamp = run.coverage.as_ref()?.stamp();
        kept(&mut self.requested, (id, stamp), || run.requested())
    }

    /// The plate of each cell of a floor.
    pub(super) fn plate_map(
        &mut self,
        layout: &world::PlateLayout,
        boundary: &world::Boundary,
        floor: &Floor,
    ) -> Rc<PlateMap> {
        let key = PlateMapKey { layout: layout.clone(), cells: floor.len(), origin: floor.origin };
        kept(&mut self.plate_map, key, || Rc::new(layout.map(boundary, floor)))
    }
}

impl Places {
    /// The part of the floor that the map shows.
    pub(super) fn window(&self) -> Option<Window> {
        self.map.map(|(_, window)| window)
    }

    /// The screen element at a position in the last frame.
    pub fn target(&self, column: u16, row: u16) -> Target {
        let at = Position { x: column, y: row };
        if let Some((_, id)) = self.keys.iter().find(|(area, _)| area.contains(at)) {
            return Target::Key(*id);
        }
        if let Some((_, list, index)) = self.rows.iter().find(|(area, ..)| area.contains(at)) {
            return Target::Row(*list, *index);
        }
        match self.map.filter(|(area, _)| area.contains(at)) {
            Some((area, window)) => Target::Map(window.middle_of(column - area.x, row - area.y)),
            None => Target::Else,
        }
    }
}

fn kept<K: PartialEq, V: Clone>(slot: &mut Option<(K, V)>, key: K, make: impl FnOnce() -> V) -> V {
    match slot {
        Some((before, value)) if *before == key => value.clone(),
        _ => {
            let value = make();
            *slot = Some((key, value.clone()));
            value
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kept_value_is_made_again_only_for_another_key() {
        let (mut slot, mut made) = (None, 0);
        let values = [1, 1, 2, 2, 1].map(|key| {
            kept(&mut slot, key, || {
                made += 1;
                10 * key
            })
        });
        assert_eq!((values, made), ([10, 10, 20, 20, 10], 3));
    }
}
