//! Dry and flooded floor, and how an amphibious robot moves on each.

use crate::tank::{Zone, ZoneKind};
use geometry::Point;
use serde::{Deserialize, Serialize};

/// The medium that covers the floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Medium {
    /// Air: the robot walks.
    Land,
    /// Water: the robot swims.
    Underwater,
}

/// The mode of an amphibious robot, from walking (weight 0) to swimming (weight 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    weight: f64,
}

/// Gauge pressure under one metre of fresh water, pascals.
const PA_PER_M: f64 = 9_806.65;
/// The evidence needed to decide on a medium, as a log-likelihood ratio: one decision in a million is wrong.
const DECIDED: f64 = 13.815_510_558;

/// A pressure sensor with which an amphibious robot detects whether the floor under it is flooded (Yang et al. 2021,
/// Fig. 6).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PressureSensor {
    /// Depth of the sensor below the surface on flooded floor, metres.
    pub depth_m: f64,
    /// Standard deviation of one reading, pascals; greater than 0.
    pub sigma_pa: f64,
}

/// The medium according to the readings of a pressure sensor.
///
/// Readings accumulate until they are decisive (a sequential test between the two expected pressures, Wald 1945). A
/// decision stands until later readings outweigh it, so noise at the waterline changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensedMedium {
    known: Option<Medium>,
    /// The accumulated log-likelihood ratio; positive for water.
    evidence: f64,
}

impl PressureSensor {
    /// Returns the gauge pressure to expect in a medium, without noise, pascals.
    ///
    /// ```
    /// use world::{Medium, PressureSensor};
    /// let sensor = PressureSensor { depth_m: 0.3, sigma_pa: 200.0 };
    /// assert!((sensor.expected_pa(Medium::Underwater) - 2_942.0).abs() < 0.1);
    /// assert_eq!(sensor.expected_pa(Medium::Land), 0.0);
    /// ```
    pub fn expected_pa(&self, medium: Medium) -> f64 {
        if medium == Medium::Underwater { PA_PER_M * self.depth_m } else { 0.0 }
    }

    /// Returns the mean number of readings until the medium is first known. A later change takes twice as many.
    ///
    /// ```
    /// use world::PressureSensor;
    /// let noisy = PressureSensor { depth_m: 0.3, sigma_pa: 2_942.0 };
    /// assert!((noisy.readings_to_decide() - 27.6).abs() < 0.1);
    /// ```
    pub fn readings_to_decide(&self) -> f64 {
        let apart = self.expected_pa(Medium::Underwater) / self.sigma_pa;
        (2.0 * DECIDED / (apart * apart)).max(1.0)
    }

    /// Returns the largest standard deviation of a reading, pascals, at which the given number of readings is enough,
    /// on average, to decide on the medium.
    ///
    /// ```
    /// use world::PressureSensor;
    /// let sensor = PressureSensor { depth_m: 0.3, sigma_pa: PressureSensor::largest_sigma_pa(0.3, 100.0) };
    /// assert!((sensor.readings_to_decide() - 100.0).abs() < 1e-9);
    /// ```
    pub fn largest_sigma_pa(depth_m: f64, readings: f64) -> f64 {
        PA_PER_M * depth_m * (readings / (2.0 * DECIDED)).sqrt()
    }

    fn evidence_for_water(&self, pressure_pa: f64) -> f64 {
        let flooded_pa = self.expected_pa(Medium::Underwater);
        (pressure_pa - 0.5 * flooded_pa) * flooded_pa / self.sigma_pa.powi(2)
    }
}

impl SensedMedium {
    /// The medium; `None` until the readings are decisive.
    ///
    /// ```
    /// assert_eq!(world::SensedMedium::default().known(), None);
    /// ```
    pub fn known(&self) -> Option<Medium> {
        self.known
    }

    /// Adds a reading, pascals; returns the medium if it has just become known or has changed.
    ///
    /// ```
    /// use world::{Medium, PressureSensor, SensedMedium};
    /// let sensor = PressureSensor { depth_m: 0.3, sigma_pa: 200.0 };
    /// let mut medium = SensedMedium::default();
    /// assert_eq!(medium.take(&sensor, 2_900.0), Some(Medium::Underwater));
    /// assert_eq!(medium.take(&sensor, 3_000.0), None);
    /// ```
    pub fn take(&mut self, sensor: &PressureSensor, pressure_pa: f64) -> Option<Medium> {
        let evidence = sensor.evidence_for_water(pressure_pa);
        if !evidence.is_finite() {
            return None;
        }
        self.evidence = (self.evidence + evidence).clamp(-DECIDED, DECIDED);
        let says = match self.evidence {
            evidence if evidence >= DECIDED => Medium::Underwater,
            evidence if evidence <= -DECIDED => Medium::Land,
            _ => return None,
        };
        (self.known.replace(says) != Some(says)).then_some(says)
    }
}

impl Medium {
    /// Returns the medium at a point, tank frame: that of the last dry or flooded zone that contains the point or,
    /// outside such zones, that of dry floor.
    ///
    /// ```
    /// use world::{Medium, Point, Shape, Zone, ZoneKind};
    /// let shape = Shape::Disc { center: Point::origin(), radius_m: 3.0 };
    /// let sump = [Zone { name: "sump".into(), kind: ZoneKind::Underwater, shape }];
    /// assert_eq!(Medium::at(&sump, Point::new(1.0, 0.0)), Medium::Underwater);
    /// assert_eq!(Medium::at(&sump, Point::new(4.0, 0.0)), Medium::Land);
    /// ```
    pub fn at(zones: &[Zone], place: Point) -> Self {
        let here = zones.iter().rev().filter(|zone| zone.kind != ZoneKind::NoGo);
        let kind = here.filter(|zone| zone.shape.distance_m(place) <= 0.0).map(|zone| zone.kind).next();
        if kind == Some(ZoneKind::Underwater) { Self::Underwater } else { Self::Land }
    }

    /// Returns the word for the floor: `dry` or `flooded`.
    ///
    /// ```
    /// assert_eq!(world::Medium::Underwater.word(), "flooded");
    /// ```
    pub fn word(self) -> &'static str {
        match self {
            Self::Land => "dry",
            Self::Underwater => "flooded",
        }
    }
}

impl Mode {
    /// Returns the mode for a medium.
    ///
    /// ```
    /// use world::{Amphibious, Medium, Mode};
    /// assert_eq!(Amphibious::YANG_2021.pace(Mode::of(Medium::Land).weight()).v_max_m_per_s, 0.13);
    /// ```
    pub fn of(medium: Medium) -> Self {
        Self { weight: if medium == Medium::Underwater { 1.0 } else { 0.0 } }
    }

    /// Returns the mode one tick later: one step of the transition towards the mode for a medium.
    ///
    /// ```
    /// use world::{Amphibious, Medium, Mode};
    /// let mode = Mode::of(Medium::Land).toward(Medium::Underwater, 20);
    /// assert!((Amphibious::YANG_2021.pace(mode.weight()).v_max_m_per_s - 0.135).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn toward(self, medium: Medium, transition_steps: u32) -> Self {
        let wanted = Self::of(medium);
        if transition_steps == 0 {
            return wanted;
        }
        let step = 1.0 / f64::from(transition_steps);
        Self { weight: self.weight + (wanted.weight - self.weight).clamp(-step, step) }
    }

    /// Share of swimming, 0 to 1.
    ///
    /// ```
    /// use world::{Medium, Mode};
    /// assert_eq!(Mode::of(Medium::Underwater).weight(), 1.0);
    /// ```
    pub fn weight(self) -> f64 {
        self.weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Amphibious, Shape};

    fn zone(kind: ZoneKind, radius_m: f64) -> Zone {
        Zone { name: String::new(), kind, shape: Shape::Disc { center: Point::origin(), radius_m } }
    }

    #[test]
    fn the_later_zone_counts_and_floor_without_one_is_dry() {
        let zones = [zone(ZoneKind::Underwater, 5.0), zone(ZoneKind::Land, 2.0), zone(ZoneKind::NoGo, 9.0)];
        let at = |x: f64| Medium::at(&zones, Point::new(x, 0.0));
        assert_eq!((at(1.0), at(3.0), at(6.0)), (Medium::Land, Medium::Underwater, Medium::Land));
    }

    #[test]
    fn a_transition_takes_its_steps_and_none_is_at_once() {
        let robot = Amphibious::YANG_2021;
        let mut mode = Mode::of(Medium::Underwater);
        for _ in 0..10 {
            mode = mode.toward(Medium::Land, robot.transition_steps);
        }
        assert!((robot.pace(mode.weight()).v_max_m_per_s - 0.18).abs() < 1e-12);
        for _ in 0..10 {
            mode = mode.toward(Medium::Land, robot.transition_steps);
        }
        assert!(mode.weight.abs() < 1e-12);
        assert_eq!(mode.toward(Medium::Underwater, 0), Mode::of(Medium::Underwater));
    }

    /// Readings generated from a seed, pascals; the noise is a sum of twelve uniform numbers.
    fn readings(mean_pa: f64, sigma_pa: f64, seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut uniform = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        std::iter::repeat_with(move || mean_pa + sigma_pa * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0))
    }

    #[test]
    fn a_noisy_sensor_decides_rightly_in_the_time_that_it_states() {
        let sensor = PressureSensor { depth_m: 0.3, sigma_pa: 3_000.0 };
        for medium in [Medium::Land, Medium::Underwater] {
            let mut taken = 0;
            for seed in 1..=300 {
                let mut sensed = SensedMedium::default();
                let mut all = readings(sensor.expected_pa(medium), sensor.sigma_pa, seed);
                let decided = all.find_map(|pressure_pa| {
                    taken += 1;
                    sensed.take(&sensor, pressure_pa)
                });
                assert_eq!(decided, Some(medium));
                // The noise of the next minute changes nothing.
                assert_eq!(all.take(600).find_map(|pressure_pa| sensed.take(&sensor, pressure_pa)), None);
            }
            let mean = f64::from(taken) / 300.0;
            let stated = sensor.readings_to_decide();
            assert!((mean / stated - 1.0).abs() < 0.15, "{mean} {stated}");
        }
    }
}
