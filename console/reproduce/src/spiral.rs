//! Wang et al. 2023: planners on the preset spiral.
//!
//! Layouts: the paper's three distributions, uniform in the disk or, as printed, in the square. The paper states
//! the size of neither obstacles nor robot; collisions are counted at a clearance of 0.3 m from an obstacle point.

mod figures;
mod method;
mod plans;
mod printed;
mod tables;
mod trained;

pub use trained::{figures_of, loss};

use crate::study::Study;
use trials::{Distribution, Sampling};

/// Clearance at which collisions are counted, metres.
pub const CLEARANCE_M: f64 = 0.3;

/// The studies.
pub const STUDIES: &[Study] = &[
    Study {
        name: "wang-table1",
        about: "Wang et al. 2023, Table 1: eight methods on three distributions of obstacles",
        layouts: 100,
        run: tables::table1,
    },
    Study {
        name: "wang-fig8",
        about: "Wang et al. 2023, Fig. 8: precision and recall over the threshold T0",
        layouts: 100,
        run: tables::fig8,
    },
    Study {
        name: "wang-table2",
        about: "Wang et al. 2023, Table 2: gains and obstacle range of the rotating field with improved repulsion",
        layouts: 30,
        run: tables::table2,
    },
    Study {
        name: "spiral-followers",
        about: "our own planners on the layouts of Wang et al. 2023, against the geometric floor",
        layouts: 1000,
        run: tables::followers,
    },
];

/// One kind of layouts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Group {
    /// Number and range of obstacles.
    pub distribution: Distribution,
    /// Where obstacles are drawn.
    pub sampling: Sampling,
}

impl Group {
    /// Every distribution, drawn both ways.
    pub fn all() -> impl Iterator<Item = Self> {
        let both =
            |distribution| [Sampling::Disk, Sampling::Square].map(|sampling| Self { distribution, sampling });
        Distribution::ALL.into_iter().flat_map(both)
    }

    /// The layouts that a training set names: `wang-d1`, drawn in the disk, or `wang-d1-square`.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|group| {
            let sampling = if group.sampling == Sampling::Disk { "" } else { "-square" };
            name == format!("wang-d{}{sampling}", group.column() + 1)
        })
    }

    /// Index of the distribution in printed tables.
    pub fn column(self) -> usize {
        self.distribution as usize
    }

    /// Id of the case.
    pub fn id(self) -> String {
        let sampling = if self.sampling == Sampling::Disk { "disk" } else { "square" };
        format!("d{}/{sampling}", self.column() + 1)
    }
}
