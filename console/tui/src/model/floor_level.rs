//! The forecast protection level of fixes across the floor.

use positioning::{AccuracyMap, accuracy::checks::Floor};
use serde::{Deserialize, Serialize};
use world::coverage::percent_text;

/// The forecast protection level of single fixes; `tankops accuracy` gives the same figures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FloorLevel {
    /// Level in the middle of all places, metres; `None` if half of the floor is not protected.
    pub median_m: Option<f64>,
    /// Share of the floor where a fix is not protected, 0 to 1.
    pub unprotected: f64,
}

impl FloorLevel {
    /// The levels of a map that contains them.
    ///
    /// Cost: a look at every cell, and a sort.
    pub fn of(map: &AccuracyMap) -> Self {
        let known: Vec<_> = map.floor().filter_map(|(_, cell)| cell.checks).collect();
        let floor = Floor::new(&known, map.floor().count());
        Self { median_m: floor.median_level_m(), unprotected: floor.unprotected_share() }
    }

    /// The forecast as a phrase.
    pub(crate) fn words(self) -> String {
        let unprotected = percent_text(self.unprotected, 1);
        match self.median_m {
            Some(median_m) => {
                format!("level of a fix {median_m:.2} m median, {unprotected} % of the floor not protected")
            }
            None => format!("{unprotected} % of the floor not protected"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_without_a_median_level_has_no_figure_for_it() {
        let words = |median_m, unprotected| FloorLevel { median_m, unprotected }.words();
        assert_eq!(
            words(Some(0.341), 0.02),
            "level of a fix 0.34 m median, 2.0 % of the floor not protected"
        );
        assert_eq!(words(None, 1.0), "100.0 % of the floor not protected");
    }
}
