//! Compares a short motion as measured with the motion as commanded: signs, axes and units.

use super::{Figure, Row};
use crate::link::{Axis, Finding};

/// A measured motion passes if it differs from the commanded one by at most this share of it, for slip and friction.
const TOLERANCE: f64 = 0.3;
/// Below this share of the commanded motion, the vehicle does not move.
const FROZEN: f64 = 0.05;

/// A motion, in the robot frame at its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moved {
    /// Metres ahead.
    pub forward_m: f64,
    /// Metres to the left.
    pub sideways_m: f64,
    /// Change of heading, radians, counter-clockwise.
    pub turn_rad: f64,
}

impl Moved {
    fn figures(&self) -> Vec<Figure> {
        vec![
            Figure::new("ahead", self.forward_m, "m"),
            Figure::new("left", self.sideways_m, "m"),
            Figure::new("turn", self.turn_rad.to_degrees(), "deg"),
        ]
    }
}

/// Compares a measured motion with a commanded distance ahead.
pub fn ahead(check: &'static str, commanded_m: f64, moved: Moved) -> Row {
    let ratio = moved.forward_m / commanded_m;
    let across = moved.sideways_m / commanded_m;
    let turned_rad = moved.turn_rad.abs();
    let says = if moved.forward_m.hypot(moved.sideways_m) < FROZEN * commanded_m {
        if turned_rad > FROZEN {
            Some("the vehicle turned although it was commanded ahead: speed and turn rate are swapped".into())
        } else {
            Some(Finding::Frozen(Axis::Forward).to_string())
        }
    } else if across.abs() > ratio.abs() {
        Some(Finding::Swapped.to_string())
    } else if ratio < 0.0 {
        Some(Finding::Reversed(Axis::Forward).to_string())
    } else if (ratio - 1.0).abs() > TOLERANCE {
        Some(Finding::Scale { axis: Axis::Forward, ratio, is_steady: true }.to_string())
    } else if across.abs() > TOLERANCE {
        Some("the vehicle moves sideways while it is driven ahead: x must point ahead".into())
    } else if turned_rad > TOLERANCE {
        Some("the heading changes while the vehicle is driven ahead".into())
    } else {
        None
    };
    told(check, moved, says, &format!("{commanded_m:.2} m ahead was commanded"))
}

/// Compares a measured motion with a commanded turn, counter-clockwise.
pub fn turned(check: &'static str, commanded_rad: f64, moved: Moved) -> Row {
    let ratio = moved.turn_rad / commanded_rad;
    let way_m = moved.forward_m.hypot(moved.sideways_m);
    let says = if ratio.abs() < FROZEN {
        if way_m > FROZEN {
            Some(
                "the vehicle drove although it was commanded to turn: speed and turn rate are swapped".into(),
            )
        } else {
            Some(Finding::Frozen(Axis::Turn).to_string())
        }
    } else if ratio < 0.0 {
        Some(Finding::Reversed(Axis::Turn).to_string())
    } else if (ratio - 1.0).abs() > TOLERANCE {
        Some(Finding::Scale { axis: Axis::Turn, ratio, is_steady: true }.to_string())
    } else if way_m > TOLERANCE * commanded_rad {
        Some(format!("the origin moved by {way_m:.2} m during the turn: it must be the centre of rotation"))
    } else {
        None
    };
    let degrees = commanded_rad.to_degrees();
    told(check, moved, says, &format!("a left turn by {degrees:.0} degrees was commanded"))
}

fn told(check: &'static str, moved: Moved, wrong: Option<String>, commanded: &str) -> Row {
    match wrong {
        Some(wrong) => Row::fail(check, moved.figures(), format!("{commanded}; {wrong}")),
        None => Row::pass(check, moved.figures(), commanded),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::Verdict;

    fn moved(forward_m: f64, sideways_m: f64, turn_rad: f64) -> Moved {
        Moved { forward_m, sideways_m, turn_rad }
    }

    #[test]
    fn wrong_frames_and_units_are_named() {
        let cases = [
            (moved(0.19, 0.01, 0.02), ""),
            (moved(-0.2, 0.0, 0.0), "runs backward"),
            (moved(0.0, 0.2, 0.0), "axes are swapped"),
            (moved(0.0, -0.2, 0.0), "axes are swapped"),
            (moved(0.656, 0.0, 0.0), "feet instead of metres"),
            (moved(0.061, 0.0, 0.0), "feet per second"),
            (moved(0.0, 0.0, 0.0), "standstill"),
            (moved(0.0, 0.0, 0.2), "speed and turn rate are swapped"),
            (moved(0.2, 0.1, 0.0), "sideways"),
            (moved(0.2, 0.0, 0.5), "heading changes"),
        ];
        for (moved, why) in cases {
            let row = ahead("frames", 0.2, moved);
            assert_eq!(row.verdict == Verdict::Pass, why.is_empty(), "{row:?}");
            assert!(row.says.contains(why), "{row:?}");
        }
    }

    #[test]
    fn wrong_turns_are_named() {
        let rad = 20_f64.to_radians();
        let cases = [
            (moved(0.0, 0.0, 0.9 * rad), ""),
            (moved(0.0, 0.0, -rad), "mirrored"),
            (moved(0.0, 0.0, 57.3 * rad), "degrees instead of radians"),
            (moved(0.0, 0.0, 0.0175 * rad * 4.0), "0.07 times"),
            (moved(0.0, 0.0, 0.0), "does not change"),
            (moved(0.3, 0.0, 0.0), "swapped"),
            (moved(0.2, 0.0, rad), "centre of rotation"),
        ];
        for (moved, why) in cases {
            let row = turned("frames", rad, moved);
            assert_eq!(row.verdict == Verdict::Pass, why.is_empty(), "{row:?}");
            assert!(row.says.contains(why), "{row:?}");
        }
    }
}
