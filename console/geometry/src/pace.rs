//! The maximum speeds of a robot; for one that walks and swims, those in each mode.

/// The maximum speeds of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pace {
    /// Maximum speed, metres per second.
    pub v_max_m_per_s: f64,
    /// Maximum turn rate, radians per second.
    pub w_max_rad_per_s: f64,
}

/// The limits of an amphibious robot in its two modes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Amphibious {
    /// On dry floor.
    pub land: Pace,
    /// Under water.
    pub underwater: Pace,
    /// Number of ticks for a complete change of mode; 0 for an instant change.
    pub transition_steps: u32,
}

impl Amphibious {
    /// The limits from Yang et al. 2021, Table 1, with a transition of 20 steps as in that paper.
    pub const YANG_2021: Self = Self {
        land: Pace { v_max_m_per_s: 0.13, w_max_rad_per_s: 0.12 },
        underwater: Pace { v_max_m_per_s: 0.23, w_max_rad_per_s: 0.31 },
        transition_steps: 20,
    };

    /// The limits at a share of swimming from 0 to 1, interpolated linearly between the two modes.
    ///
    /// ```
    /// use geometry::Amphibious;
    /// let robot = Amphibious::YANG_2021;
    /// assert_eq!(robot.pace(1.0).v_max_m_per_s, 0.23);
    /// ```
    pub fn pace(&self, swimming: f64) -> Pace {
        let between = |land: f64, underwater: f64| land + (underwater - land) * swimming;
        Pace {
            v_max_m_per_s: between(self.land.v_max_m_per_s, self.underwater.v_max_m_per_s),
            w_max_rad_per_s: between(self.land.w_max_rad_per_s, self.underwater.w_max_rad_per_s),
        }
    }

    /// For each limit, the larger of its values in the two modes.
    ///
    /// ```
    /// use geometry::Amphibious;
    /// let robot = Amphibious::YANG_2021;
    /// assert_eq!(robot.fastest().w_max_rad_per_s, 0.31);
    /// ```
    pub fn fastest(&self) -> Pace {
        Pace {
            v_max_m_per_s: self.land.v_max_m_per_s.max(self.underwater.v_max_m_per_s),
            w_max_rad_per_s: self.land.w_max_rad_per_s.max(self.underwater.w_max_rad_per_s),
        }
    }
}
