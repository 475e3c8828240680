//! The tether: `[tether]`.

use super::{checks::Site, problem::Complaint, section::Section};
use mission::TetherConfig;
use world::{Point, tether::Limits};

/// Reads `[tether]`; the anchor is where the robot starts if nothing else is said.
pub fn tether(section: &Section<'_>, start: Option<Point>) -> Option<TetherConfig> {
    let anchor = if section.has("anchor_m") { section.point("anchor_m") } else { start };
    let (reel_m, friction) = (section.number("reel_m"), section.number("friction"));
    let (wrap_deg, sum_deg) = (section.number("max_wrap_deg"), section.number("max_sum_wrap_deg"));
    let fly_uncertified = section.flag("fly_uncertified");
    let limits = Limits {
        reel_m: reel_m?,
        max_wrap_rad: wrap_deg?.to_radians(),
        max_sum_wrap_rad: sum_deg?.to_radians(),
    };
    Some(TetherConfig { anchor: anchor?, limits, friction: friction?, fly_uncertified: fly_uncertified? })
}

/// Complains about an anchor that is not on free floor, and about a reel that does not even reach the start.
pub fn check(section: &Section<'_>, tether: &TetherConfig, site: &Site<'_>, start: Point) {
    if section.has("anchor_m")
        && let Some(what) = site.objection(tether.anchor)
    {
        section.complain("anchor_m", what);
    }
    let way_m = (start - tether.anchor).norm();
    if way_m > tether.limits.reel_m {
        let must_be = format!("at least {way_m:.2} m, the way from the anchor to the start");
        section.complain("reel_m", Complaint::OutOfRange(must_be));
    }
}
