//! The layouts of Wang et al. 2023 by their names.

use crate::spiral::Layout;

/// The paper's three distributions of obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Distribution {
    /// 39 obstacles.
    D1,
    /// 36 obstacles.
    D2,
    /// 20 obstacles.
    D3,
}

/// The region in which obstacles are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Uniform in the tank.
    Disk,
    /// Uniform in the square around it, as printed: one in five falls outside.
    Square,
}

impl Distribution {
    /// Every distribution.
    pub const ALL: [Self; 3] = [Self::D1, Self::D2, Self::D3];

    /// Range of obstacles, metres.
    pub fn rho_0_m(self) -> f64 {
        [1.5, 1.0, 0.8][self as usize]
    }

    /// Generates a layout: point obstacles, a point robot that keeps `clearance_m` from them, and the paper's spiral.
    pub fn layout(self, sampling: Sampling, seed: u64, clearance_m: f64) -> Layout {
        let n_obstacles = [39, 36, 20][self as usize];
        let layout = Layout::of_the_paper(seed, n_obstacles, sampling == Sampling::Square);
        Layout { clearance_m, ..layout }
    }
}
