//! The layouts of Wang et al. 2023.

use trials::{Distribution, Sampling};

/// Clearance at which collisions are counted, metres.
pub(super) const CLEARANCE_M: f64 = 0.3;

/// One kind of layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Group {
    /// Number and range of obstacles.
    pub distribution: Distribution,
    /// The region in which obstacles are drawn.
    pub sampling: Sampling,
}

impl Group {
    /// Every distribution, drawn in both regions.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        let both =
            |distribution| [Sampling::Disk, Sampling::Square].map(|sampling| Self { distribution, sampling });
        Distribution::ALL.into_iter().flat_map(both)
    }

    /// The layouts that a training set names: `wang-d1`, drawn in the disk, or `wang-d1-square`.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::all().find(|group| {
            let sampling = if group.sampling == Sampling::Disk { "" } else { "-square" };
            name == format!("wang-d{}{sampling}", group.column() + 1)
        })
    }

    /// Index of the distribution in printed tables.
    pub(crate) fn column(self) -> usize {
        self.distribution as usize
    }

    /// Id of the case.
    pub(crate) fn id(self) -> String {
        let sampling = if self.sampling == Sampling::Disk { "disk" } else { "square" };
        format!("d{}/{sampling}", self.column() + 1)
    }
}
