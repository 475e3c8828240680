//! Records what remained undecided or was left out while readings were located.

use positioning::{Impossible, Sides};
use std::collections::{BTreeMap, BTreeSet};
use world::StationId;

/// The impossible ranges of a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refused {
    /// The number of impossible ranges.
    pub count: u64,
    /// The first impossible range, metres.
    pub range_m: f64,
    /// The longest possible range, metres.
    pub most_m: f64,
    /// Mission time of the first impossible range, seconds.
    pub t_s: f64,
}

/// The doubts about a located run: mirror images and impossible ranges.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Doubts {
    /// The numbers of the stations that were heard in fixes with a mirror image.
    pub mirrored_by: BTreeSet<u32>,
    /// Fixes whose mirror image lies behind the wall.
    pub sides_by_walls: u64,
    /// Fixes whose mirror image is too far from the robot's previous position, so that the start and the track
    /// decide.
    pub sides_by_track: u64,
    /// Fixes for which nothing decides between the position and its mirror image.
    pub sides_open: u64,
    /// Whether the first fix with a mirror image contradicts the start in the scenario, in both of its possible
    /// positions.
    pub contradicts_start: bool,
    /// Impossible ranges by station number.
    pub impossible: BTreeMap<u32, Refused>,
}

impl Doubts {
    pub(crate) fn take(&mut self, t_s: f64, sides: Sides, heard: &[StationId], impossible: &[Impossible]) {
        if sides != Sides::One {
            self.mirrored_by.extend(heard.iter().map(|station| station.0));
        }
        match sides {
            Sides::One => {}
            Sides::ByWalls => self.sides_by_walls += 1,
            Sides::ByBelief => self.sides_by_track += 1,
            Sides::Open { contradicts, .. } => {
                self.contradicts_start |=
                    contradicts && self.sides_by_track + self.sides_by_walls + self.sides_open == 0;
                self.sides_open += 1;
            }
        }
        for Impossible { station, range_m, most_m } in impossible {
            let first = Refused { count: 0, range_m: *range_m, most_m: *most_m, t_s };
            self.impossible.entry(station.0).or_insert(first).count += 1;
        }
    }
}
