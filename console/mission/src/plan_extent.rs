//! Refuses plans that are far too large for their tank.

use planner_api::Plan;
use world::{Boundary, Point, polyline};

/// Maximum length of a path: this multiple of the length of all lanes over the whole floor, plus the same multiple of the
/// size of the tank.
const MOST_LANES: f64 = 20.0;
const MOST_CROSSINGS: f64 = 1000.0;

/// Refuses a plan that is far too large for this tank; `lane_m` is the width of a lane, metres. Without this check,
/// sampling the path would exhaust time and memory.
///
/// # Errors
/// What is wrong; the text continues a sentence that begins with the planner's name.
pub fn check_extent(plan: &Plan, boundary: &Boundary, lane_m: f64) -> Result<(), String> {
    let (low, high) = boundary.bounds();
    let size = high - low;
    let is_near = |p: &Point| {
        let (before, beyond) = (low - size, high + size);
        before.x <= p.x && p.x <= beyond.x && before.y <= p.y && p.y <= beyond.y
    };
    if let Some(index) = plan.path.iter().position(|p| !is_near(p)) {
        let Point { coords } = plan.path[index];
        return Err(format!(
            "gave a path whose point {index}, {:.1}, {:.1} m, is far outside the tank",
            coords.x, coords.y
        ));
    }
    let lanes_m = size.x * size.y / lane_m;
    let limit_m = MOST_LANES * lanes_m + MOST_CROSSINGS * size.norm();
    let length_m = polyline::length_m(&plan.path);
    if length_m > limit_m {
        return Err(format!("gave a path of {length_m:.0} m; in this tank the limit is {limit_m:.0} m"));
    }
    Ok(())
}
