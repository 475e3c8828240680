//! Checks the layout of scans: number of rays, angles, and whether there are distances at all.

use crate::{Sensor, Trouble};
use world::Scan;

/// The layout of the scans so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    /// Number of rays of the first scan.
    rays_at_first: Option<usize>,
}

impl Layout {
    /// The reason why scans of this layout cannot be used; `None` if they can.
    pub(crate) fn trouble(&mut self, scan: &Scan, sensor: &Sensor) -> Option<Trouble> {
        let ranges = &scan.ranges_mm.0;
        let rays = ranges.len();
        let is_finite = scan.first_rad.is_finite() && scan.sensor_m.iter().all(|m| m.is_finite());
        if rays == 0 {
            return Some(Trouble::Empty);
        }
        if !is_finite || !scan.step_rad.is_normal() {
            return Some(Trouble::Angles);
        }
        if ranges.iter().all(|mm| *mm == 0) {
            return Some(Trouble::Zero);
        }
        if let Some(wanted) = sensor.rays {
            return (rays != wanted as usize).then_some(Trouble::Rays { rays, wanted });
        }
        // Some scanners leave out rays without an echo, so the number of rays is not always the same.
        let least = self.rays_at_first.get_or_insert(rays).div_ceil(2);
        (rays < least).then_some(Trouble::FewRays { rays, least })
    }
}
