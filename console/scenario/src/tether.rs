//! The tether: `[tether]`.

use super::{
    checks::{ROUNDING_M, Site},
    problem::Complaint,
    section::Section,
};
use mission::TetherConfig;
use world::{Point, tether::Limits};

/// Reads `[tether]`; the anchor is where the robot starts if nothing else is said.
pub(crate) fn tether(section: &Section<'_>, start: Option<Point>) -> Option<TetherConfig> {
    let anchor = if section.has("anchor_m") { section.point("anchor_m") } else { start };
    let (reel_length_m, friction) = (section.number("reel_length_m"), section.number("friction"));
    let (wrap_deg, sum_deg) = (section.number("wrap_max_deg"), section.number("wrap_total_max_deg"));
    let allow_uncertified = section.flag("allow_uncertified");
    let limits = Limits {
        reel_length_m: reel_length_m?,
        wrap_max_rad: wrap_deg?.to_radians(),
        wrap_total_max_rad: sum_deg?.to_radians(),
    };
    Some(TetherConfig { anchor: anchor?, limits, friction: friction?, allow_uncertified: allow_uncertified? })
}

/// Complains about an anchor that is not on free floor, and about a reel that does not even reach the start.
pub(crate) fn check(section: &Section<'_>, tether: &TetherConfig, site: &Site<'_>, start: Point) {
    if section.has("anchor_m")
        && let Some(what) = site.objection(tether.anchor)
    {
        section.complain("anchor_m", what);
    }
    let way_m = (start - tether.anchor).norm();
    if way_m > tether.limits.reel_length_m {
        let must_be = format!("at least {way_m:.2} m, the way from the anchor to the start");
        section.complain("reel_length_m", Complaint::OutOfRange(must_be));
    }
}

/// As far from the anchor the robot counts as back for the certificate of a plan, metres; nearer if the mission says so.
const BACK_M: f64 = 0.3;
/// Share of that by which the place with room for hull and clearance may lie beside the anchor.
const ASIDE: f64 = 0.5;

/// Complains about an anchor at which a robot that comes back to it has no room: its hull must fit, and all of the
/// clearance a little beside it.
pub(crate) fn check_room(
    (section, key): (&Section<'_>, &str),
    tether: &TetherConfig,
    site: &Site<'_>,
    (clearance_m, tolerance_m): (f64, f64),
) {
    let wall = (site.boundary.wall_distance_m(tether.anchor), "the wall".to_owned());
    let obstacles = site.obstacles.iter().map(|o| {
        let name = format!("obstacle \"{}\"", o.name);
        (o.shape.distance_m(tether.anchor), name)
    });
    let nearest = obstacles.chain([wall]).min_by(|a, b| a.0.total_cmp(&b.0));
    let aside_m = ASIDE * tolerance_m.min(BACK_M);
    let need_m = site.radius_m + (clearance_m - aside_m).max(0.0);
    let Some((away_m, from)) = nearest.filter(|(away_m, _)| *away_m < need_m - ROUNDING_M) else { return };
    // A place outside the tank or within something solid is complained about as such.
    if section.has(key) && away_m >= 0.0 {
        let must_be = format!(
            "at least {need_m:.3} m away from {from}, for the robot comes back to it: its hull must fit, and its clearance \
             {aside_m:.3} m beside it; this is {away_m:.3} m"
        );
        section.complain(key, Complaint::OutOfRange(must_be));
    }
}
