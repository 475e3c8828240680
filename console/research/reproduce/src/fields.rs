//! Potential fields towards a goal: Xu et al. 2022 (virtual obstacles) and Yang et al. 2021 (virtual goals, dynamic
//! window).
//!
//! Of all layouts, the papers print only one obstacle. The other layouts are reconstructed to give the printed
//! stopping points and lengths, so agreement with those values shows only consistency. The notes state where a paper's
//! formula is wrong.

mod amphibious;
mod curves;
mod flown;
mod layout;
mod xu;
mod yang;

use crate::study::Study;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[
    Study {
        name: "xu-table1",
        about: "Xu et al. 2022, Table 1: a goal behind an obstacle that pushes the robot past it",
        layouts: 1,
        run: xu::table1,
    },
    Study {
        name: "xu-traps",
        about: "Xu et al. 2022, Figs 2, 11, 12: an obstacle on the line, a triangle and a U in the way",
        layouts: 1,
        run: xu::traps,
    },
    Study {
        name: "xu-table2",
        about: "Xu et al. 2022, Table 2: a U in the way and obstacles round the goal",
        layouts: 1,
        run: xu::table2,
    },
    Study {
        name: "xu-forces",
        about: "Xu et al. 2022, Figs 14 to 16: pull and push of three methods during a drive over the \
                floor of Table 2",
        layouts: 1,
        run: curves::forces,
    },
    Study {
        name: "yang-table3",
        about: "Yang et al. 2021, Table 3: a free path and two goals with an obstacle behind them",
        layouts: 1,
        run: yang::table3,
    },
    Study {
        name: "yang-table4",
        about: "Yang et al. 2021, Table 4: two local minima in front of obstacles",
        layouts: 1,
        run: yang::table4,
    },
    Study {
        name: "yang-hybrid",
        about: "Yang et al. 2021, Figs 12 to 15: from water to land among ten obstacles, with 0, 20 and 60 \
                steps of transition",
        layouts: 200,
        run: amphibious::hybrid,
    },
    Study {
        name: "yang-distances",
        about: "Yang et al. 2021, Figs 12 to 15 (b): distances to the ten obstacles during a drive",
        layouts: 10,
        run: curves::distances,
    },
];
