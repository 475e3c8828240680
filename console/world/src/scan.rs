//! A scan of the surroundings by a range sensor on the robot, and its short form in journals.

use crate::Odometry;
use geometry::{Point, Vector};
use nalgebra::Rotation2;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The stored distance of a ray without an echo, and of a ray whose distance exceeds 65.534 m.
pub const NO_ECHO: u16 = u16::MAX;
/// The longest distance that a scan can contain, metres.
pub const LONGEST_M: f64 = 65.534;

/// Maximum number of neighbouring rays on each side with which a distance is averaged, and the maximum length of the
/// arc, metres, that these rays span at that distance.
const EVENED: usize = 2;
const EVENED_ARC_M: f64 = 0.1;
/// Maximum distance by which averaging moves a point away from the sensor, in standard deviations.
const EVENED_BACK: f64 = 2.0;
/// Minimum difference between distances on two surfaces, in standard deviations; a smaller difference may be noise on
/// one surface.
pub const APART: f64 = 5.0;

/// Distances along rays from a sensor on the robot.
///
/// ```
/// use world::{NO_ECHO, Scan, scan::RangesMm};
/// let ranges_mm = RangesMm(vec![2000, NO_ECHO]);
/// let scan = Scan { first_rad: 0.0, step_rad: 0.5, ranges_mm, ..Scan::default() };
/// assert_eq!(scan.points().map(|at| (at.x, at.y)).collect::<Vec<_>>(), [(2.0, 0.0)]);
/// ```
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Scan {
    /// Direction of the first ray in the robot frame, radians, counter-clockwise from straight ahead.
    pub first_rad: f64,
    /// Angle from one ray to the next, radians; negative for a scan that runs clockwise.
    pub step_rad: f64,
    /// Place of the sensor in the robot frame, metres.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub sensor_m: [f64; 2],
    /// Maximum distance that the sensor can measure, metres, as a vehicle states it; `None` in a simulation, where the
    /// scenario states it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range_max_m: Option<f64>,
    /// Motion of the robot from the scan to the end of the readings that it is part of.
    #[serde(default, skip_serializing_if = "is_still")]
    pub since: Odometry,
    /// Distances, one per ray.
    pub ranges_mm: RangesMm,
}

/// Distances in millimetres, each [`NO_ECHO`] where no echo came back; serialised as a string of about one character
/// per ray.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct RangesMm(pub Vec<u16>);

impl From<RangesMm> for String {
    fn from(ranges: RangesMm) -> Self {
        text(&ranges.0)
    }
}

impl TryFrom<String> for RangesMm {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        ranges(&text).map(Self).ok_or("the distances of a scan are damaged")
    }
}

/// Whether this number of rays at this angle, radians, from one to the next goes all around.
pub fn is_round(rays: usize, step_rad: f64) -> bool {
    rays as f64 * step_rad.abs() > TAU - 0.5 * step_rad.abs()
}

fn is_zero(place: &[f64; 2]) -> bool {
    *place == [0.0, 0.0]
}

fn is_still(moved: &Odometry) -> bool {
    *moved == Odometry::default()
}

impl Scan {
    /// Converts a distance in metres to the form in which it is stored.
    pub fn stored(range_m: Option<f64>) -> u16 {
        match range_m.map(|range_m| (range_m * 1000.0).round()) {
            Some(mm) if (0.0..f64::from(NO_ECHO)).contains(&mm) => mm as u16,
            _ => NO_ECHO,
        }
    }

    /// The same scan with less noise: each distance is replaced by the mean of itself and of those neighbours, up to two
    /// rays to each side within an arc of 0.1 m, that may lie on the same surface because they differ by less than
    /// [`APART`] standard deviations. A distance that differs more from all these neighbours stays unchanged, and so does
    /// 0, which means too near to be measured. No distance grows by more than two standard deviations, so that a thin
    /// post in front of a wall is not averaged away.
    ///
    /// ```
    /// use world::{Scan, scan::RangesMm};
    /// let ranges_mm = RangesMm(vec![1000, 1000, 700, 1020, 1000]);
    /// let scan = Scan { step_rad: 0.01, ranges_mm, ..Scan::default() };
    /// assert_eq!(scan.evened(0.02).ranges_mm.0, [1000, 1007, 700, 1007, 1010]);
    /// ```
    #[must_use]
    pub fn evened(&self, sigma_m: f64) -> Self {
        let ranges = &self.ranges_mm.0;
        let n = ranges.len();
        let is_round = is_round(n, self.step_rad);
        let apart_mm = APART * 1000.0 * sigma_m;
        let most_back_mm = EVENED_BACK * 1000.0 * sigma_m;
        let even = |(at, mm): (usize, &u16)| {
            if matches!(*mm, 0 | NO_ECHO) {
                return *mm;
            }
            let step_m = self.step_rad.abs() * f64::from(*mm) / 1000.0;
            let beside = EVENED.min((0.5 * EVENED_ARC_M / step_m) as usize).min(n);
            let places = (at + n - beside)..=(at + n + beside);
            let places = places.filter(|place| is_round || (n..2 * n).contains(place));
            let beside = places.map(|place| ranges[place % n]).filter(|other| !matches!(*other, 0 | NO_ECHO));
            let (mut sum, mut count) = (0.0, 0.0);
            for other in beside.filter(|other| f64::from(other.abs_diff(*mm)) < apart_mm) {
                (sum, count) = (sum + f64::from(other), count + 1.0);
            }
            if count > 0.0 { (sum / count).min(f64::from(*mm) + most_back_mm).round() as u16 } else { *mm }
        };
        let evened = ranges.iter().enumerate().map(even).collect();
        Self { ranges_mm: RangesMm(evened), ..self.clone() }
    }

    /// The points that were hit, in the robot frame at the end of the readings.
    pub fn points(&self) -> impl Iterator<Item = Point> + '_ {
        let sensor = Vector::from(self.sensor_m);
        (0_u32..).zip(&self.ranges_mm.0).filter(|(_, mm)| **mm != NO_ECHO).map(move |(n, mm)| {
            let (sin, cos) = (self.first_rad + f64::from(n) * self.step_rad).sin_cos();
            let range_m = f64::from(*mm) / 1000.0;
            carried(Point::from(sensor + Vector::new(cos, sin) * range_m), &self.since)
        })
    }
}

/// Converts a point from the robot frame before a motion to the robot frame after the motion.
pub fn carried(point: Point, moved: &Odometry) -> Point {
    let left = Vector::new(moved.forward_m, moved.sideways_m);
    Point::from(Rotation2::new(-moved.turn_rad) * (point.coords - left))
}

/// Number of characters for packed distances: the printable ASCII characters that need no escape in JSON.
const DIGITS: usize = 93;
/// A digit below this one encodes a small difference on its own. A digit from this one on encodes a medium difference,
/// together with a second digit.
const SMALL: usize = 80;
const MEDIUM: usize = 11;
/// This digit announces a distance in three digits.
const WHOLE: usize = SMALL + MEDIUM;
/// This digit stands for a ray without an echo.
const NONE: usize = WHOLE + 1;

fn digit(value: usize) -> char {
    let byte = b' ' + value as u8;
    // Skips the quotation mark and the backslash.
    let byte = if byte >= b'"' { byte + 1 } else { byte };
    char::from(if byte >= b'\\' { byte + 1 } else { byte })
}

fn value(byte: u8) -> Option<usize> {
    let at = match byte {
        b' '..=b'!' => byte - b' ',
        b'#'..=b'[' => byte - b' ' - 1,
        b']'..=b'~' => byte - b' ' - 2,
        _ => return None,
    };
    Some(usize::from(at))
}

/// Packs the distances as differences between neighbours, so that a smooth wall takes one character per ray.
fn text(ranges_mm: &[u16]) -> String {
    let mut text = String::with_capacity(ranges_mm.len() * 2);
    let mut before = 0_i32;
    for &mm in ranges_mm {
        if mm == NO_ECHO {
            text.push(digit(NONE));
            continue;
        }
        let change = i32::from(mm) - before;
        before = i32::from(mm);
        let folded = (2 * change.unsigned_abs() as usize).saturating_sub(usize::from(change < 0));
        if folded < SMALL {
            text.push(digit(folded));
        } else if folded < SMALL + MEDIUM * DIGITS {
            let rest = folded - SMALL;
            text.extend([digit(SMALL + rest / DIGITS), digit(rest % DIGITS)]);
        } else {
            let mm = usize::from(mm);
            text.extend([WHOLE, mm / (DIGITS * DIGITS), mm / DIGITS % DIGITS, mm % DIGITS].map(digit));
        }
    }
    text
}

fn ranges(text: &str) -> Option<Vec<u16>> {
    let mut digits = text.bytes().map(value);
    let mut ranges = Vec::with_capacity(text.len());
    let mut before = 0_i32;
    while let Some(first) = digits.next() {
        let mut next = || digits.next().flatten();
        let folded = match first? {
            NONE => {
                ranges.push(NO_ECHO);
                continue;
            }
            WHOLE => {
                let mm = (next()? * DIGITS + next()?) * DIGITS + next()?;
                before = i32::try_from(mm).ok()?;
                ranges.push(u16::try_from(mm).ok().filter(|mm| *mm != NO_ECHO)?);
                continue;
            }
            small if small < SMALL => small,
            medium => SMALL + (medium - SMALL) * DIGITS + next()?,
        };
        let change = i32::try_from(folded.div_ceil(2)).ok()?;
        before += if folded % 2 == 1 { -change } else { change };
        ranges.push(u16::try_from(before).ok().filter(|mm| *mm != NO_ECHO)?);
    }
    Some(ranges)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use proptest::prelude::*;

    #[test]
    fn digits_are_plain_and_different() {
        let digits: Vec<char> = (0..DIGITS).map(digit).collect();
        assert!(digits.iter().all(|digit| !matches!(digit, '"' | '\\') && (' '..='~').contains(digit)));
        assert!((0..DIGITS).all(|n| value(digits[n] as u8) == Some(n)));
        assert!(value(b'"').is_none() && value(b'\\').is_none() && value(0x7f).is_none());
    }

    proptest! {
        #[test]
        fn a_scan_is_read_as_it_is_written(
            ranges_mm in prop::collection::vec(prop_oneof![any::<u16>(), 1990..2010_u16, Just(NO_ECHO)], 0..400),
            first_rad in -7.0..7.0_f64, step_rad in 0.001..0.1_f64, turn_rad in -0.1..0.1_f64,
        ) {
            let since = Odometry { turn_rad, ..Odometry::default() };
            let scan = Scan { first_rad, step_rad, since, ranges_mm: RangesMm(ranges_mm), ..Scan::default() };
            let text = serde_json::to_string(&scan).unwrap();
            prop_assert_eq!(serde_json::from_str::<Scan>(&text).unwrap(), scan);
        }

        #[test]
        fn damaged_text_gives_an_error_and_no_panic(text in "[ -~]{0,60}") {
            if let Some(found) = ranges(&text) {
                prop_assert!(found.len() <= text.len());
            }
        }
    }

    #[test]
    fn a_wall_takes_about_a_character_a_ray() {
        let wall: Vec<u16> =
            (0..360).map(|n| 3000 + (f64::from(n) * 0.7).sin() as u16 * 10 + n % 7).collect();
        assert!(text(&wall).len() < 366, "{}", text(&wall).len());
        assert!(ranges("\u{7f}").is_none() && ranges("~").is_some() && ranges("|").is_none());
    }

    #[test]
    fn evening_hides_no_post_and_mixes_no_distant_places() {
        let evened = |step_rad: f64, ranges_mm: &[u16]| {
            let scan = Scan { step_rad, ranges_mm: RangesMm(ranges_mm.to_vec()), ..Scan::default() };
            scan.evened(0.02).ranges_mm.0
        };
        // A post 9 cm in front of a wall moves back by 2 standard deviations, not to the wall.
        assert_eq!(evened(0.01, &[1000, 1000, 910, 1000, 1000])[2], 950);
        // Neighbours that are 0.2 m apart may show different objects.
        assert_eq!(evened(0.2, &[1000, 1000, 960, 1000, 1000]), [1000, 1000, 960, 1000, 1000]);
        assert_eq!(evened(0.1, &[500, 500, 470, 500, 500])[2], 490, "one neighbour on each side");
        // Too near to be measured stays so, and is the distance of nothing else.
        assert_eq!(evened(0.01, &[40, 0, 40, NO_ECHO, 60]), [40, 0, 47, NO_ECHO, 50]);
    }

    #[test]
    fn points_are_where_they_are_after_the_motion() {
        let since = Odometry { forward_m: 0.5, sideways_m: 0.0, turn_rad: std::f64::consts::FRAC_PI_2 };
        let scan = Scan {
            first_rad: 0.0,
            step_rad: 0.1,
            sensor_m: [0.2, 0.0],
            range_max_m: None,
            since,
            ranges_mm: RangesMm(vec![1000, NO_ECHO]),
        };
        let points: Vec<Point> = scan.points().collect();
        let [point] = points[..] else { panic!("{points:?}") };
        assert!((point - Point::new(0.0, -0.7)).norm() < 1e-12, "{point}");
        assert_eq!(
            [Some(1.2345), Some(70.0), Some(f64::NAN), None].map(Scan::stored),
            [1235, NO_ECHO, NO_ECHO, NO_ECHO]
        );
    }
}
