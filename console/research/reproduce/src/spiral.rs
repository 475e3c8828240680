//! Wang et al. 2023: planners on the preset spiral.
//!
//! Layouts: the paper's three distributions, uniform in the disk or, as printed, in the square. The paper does not
//! state the sizes of obstacles and robot; collisions are counted at a clearance of 0.3 m from an obstacle point.

mod figures;
mod fit;
mod group;
mod method;
mod plans;
mod printed;
mod readings;
mod tables;
mod trained;

pub(crate) use group::Group;
pub(crate) use trained::Trained;

use crate::study::Study;

/// The studies.
pub(crate) const STUDIES: &[Study] = &[
    Study {
        name: "wang-table1",
        about: "Wang et al. 2023, Table 1: eight methods on three distributions of obstacles",
        layouts: 100,
        run: tables::table1,
    },
    Study {
        name: "wang-search",
        about: "interpretations of details that Wang et al. 2023 leave open, drawn at random and compared \
                with Table 1, including VT",
        layouts: 8,
        run: tables::search,
    },
    Study {
        name: "wang-fig8",
        about: "Wang et al. 2023, Fig. 8: precision and recall as functions of the threshold T0",
        layouts: 100,
        run: tables::fig8,
    },
    Study {
        name: "wang-table2",
        about: "Wang et al. 2023, Table 2: gains and obstacle range of the rotating field with improved \
                repulsion",
        layouts: 30,
        run: tables::table2,
    },
    Study {
        name: "spiral-followers",
        about: "our own planners on the layouts of Wang et al. 2023, compared with the geometric lower bound",
        layouts: 1000,
        run: tables::followers,
    },
];
