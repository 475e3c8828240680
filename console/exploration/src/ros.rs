//! The map in the format of the ROS map server.

use crate::{cells::CellState, map::SurveyMap};
use std::fmt::Write;

/// The greys of free, solid and unseen cells, as map savers write them.
const FREE: u8 = 254;
const SOLID: u8 = 0;
const UNSEEN: u8 = 205;

/// A map as the two files of the ROS map server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RosMap {
    /// The text of the YAML file.
    pub yaml: String,
    /// The image (PGM, P5), whose first row is the upper one.
    pub pgm: Vec<u8>,
}

impl SurveyMap {
    /// The map in the format of the ROS map server; `image` is the file name of the image, from the folder of the YAML
    /// file. `None` if the text of the cells is damaged.
    pub fn ros(&self, image: &str) -> Option<RosMap> {
        let (states, grid) = (self.states()?, &self.grid);
        let mut pgm = format!("P5\n{} {}\n255\n", grid.columns, grid.rows).into_bytes();
        let grey = |state: &CellState| match state {
            CellState::Free => FREE,
            CellState::Solid => SOLID,
            CellState::Unseen => UNSEEN,
        };
        pgm.extend(states.chunks(grid.columns).rev().flatten().map(grey));
        let mut yaml = String::new();
        let (x, y) = (grid.low.x, grid.low.y);
        // Writing to a String cannot fail. The name of the image is a JSON string, which is YAML, too.
        let _ = write!(
            yaml,
            "image: {image:?}\nmode: trinary\nresolution: {:?}\norigin: [{x:?}, {y:?}, 0.0]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n",
            grid.cell_m
        );
        Some(RosMap { yaml, pgm })
    }
}
