//! Reads the tether: `[tether]`.

use super::{
    checks::{ROUNDING_M, Site},
    problem::Complaint,
    section::Section,
};
use mission::TetherConfig;
use sim::{CableLaw, PhysicalCable};
use world::{
    Point,
    tether::{Limits, Reel},
};

/// Highest friction on columns of a simulated cable. Up to 0.5, the simulation pulls at most a quarter more than the capstan
/// equation says; from 1.4 on, cables stuck that theory lets slide.
const MOST_SIMULATED_FRICTION: f64 = 1.0;

/// Reads `[tether]`; without `anchor_m`, the anchor is the robot's start.
pub(crate) fn tether(section: &Section<'_>, start: Option<Point>) -> Option<TetherConfig> {
    let anchor = if section.has("anchor_m") { section.point("anchor_m") } else { start };
    let (reel_length_m, friction) = (section.number("reel_length_m"), section.number("friction"));
    let (wrap_deg, sum_deg) = (section.number("wrap_max_deg"), section.number("wrap_total_max_deg"));
    let allow_uncertified = section.flag("allow_uncertified");
    let reel = reel(section);
    let limits = Limits {
        reel_length_m: reel_length_m?,
        wrap_max_rad: wrap_deg?.to_radians(),
        wrap_total_max_rad: sum_deg?.to_radians(),
    };
    Some(TetherConfig {
        anchor: anchor?,
        limits,
        friction: friction?,
        reel,
        allow_uncertified: allow_uncertified?,
    })
}

/// The keys that describe the reel and the cable; the pull is checked if, and only if, the first is given.
const REEL: [&str; 7] = [
    "reel_pull_n",
    "mass_kg_per_m",
    "floor_friction",
    "reel_speed_m_per_s",
    "reel_pay_out_n",
    "robot_pull_n",
    "pull_ratio_max",
];

/// The longest simulated cable, metres: with up to 0.3 m, its links follow columns as the taut line does; with 0.4 m, they
/// do not.
const LONGEST_SIMULATED_M: f64 = 300.0;

/// The keys of the faults of a physical cable and its reel.
const FAULTS: [&str; 3] = ["reel_fails_at_s", "breaks_at_s", "breaks_at_n"];

/// Reads the reel. Complains about keys that would have no effect because `reel_pull_n` is missing.
fn reel(section: &Section<'_>) -> Option<Reel> {
    if let Some(key) = REEL.iter().find(|key| section.has(key)) {
        section.require(
            REEL[0],
            &format!("add the pull of the reel, in N; without it, tether.{key} has no effect"),
        );
    }
    Some(Reel {
        pull_n: section.number("reel_pull_n")?,
        mass_kg_per_m: section.number("mass_kg_per_m")?,
        floor_friction: section.number("floor_friction")?,
        pay_out_n: section.number("reel_pay_out_n")?,
        robot_pull_n: section.number("robot_pull_n"),
        pull_ratio_max: section.number("pull_ratio_max")?,
    })
}

/// Reads the cable of the simulation: `None` for a taut one. A reel without a speed of its own is twice as fast as the
/// robot.
pub(crate) fn physical(
    section: &Section<'_>,
    tether: &TetherConfig,
    v_max_m_per_s: f64,
) -> Option<PhysicalCable> {
    if section.word("model") != Some("physical") {
        section.refuse(&FAULTS, "a taut tether; add model = \"physical\"");
        return None;
    }
    section.require(REEL[0], "add the pull of the reel, in N; a physical cable needs it");
    if tether.friction > MOST_SIMULATED_FRICTION {
        let must_be = format!(
            "at most {MOST_SIMULATED_FRICTION} with model = \"physical\": the simulated cable is not exact above that"
        );
        section.complain("friction", Complaint::OutOfRange(must_be));
    }
    if tether.limits.reel_length_m > LONGEST_SIMULATED_M {
        let must_be = format!(
            "at most {LONGEST_SIMULATED_M} m with model = \"physical\": the links of a longer cable are too long for columns; \
             give the length that the plan needs"
        );
        section.complain("reel_length_m", Complaint::OutOfRange(must_be));
    }
    let reel = tether.reel?;
    let speed_m_per_s = section.number("reel_speed_m_per_s").unwrap_or(2.0 * v_max_m_per_s);
    let law = CableLaw {
        floor_n_per_m: reel.drag(tether.friction).floor_n_per_m,
        friction: tether.friction,
        pull_n: reel.pull_n,
        pay_out_n: reel.pay_out_n,
        speed_m_per_s,
        length_m: tether.limits.reel_length_m,
    };
    let [fails_at_s, breaks_at_s, breaks_at_n] = FAULTS.map(|key| section.number(key));
    Some(PhysicalCable { law, fails_at_s, breaks_at_s, breaks_at_n })
}

/// Complains about a reel that is slower than the robot: the certificate assumes that the reel takes up all slack at
/// once.
pub(crate) fn check_speed(section: &Section<'_>, v_max_m_per_s: f64) {
    let Some(speed_m_per_s) = section.number("reel_speed_m_per_s") else { return };
    if speed_m_per_s < v_max_m_per_s {
        let must_be = format!(
            "at least {v_max_m_per_s} m/s, the largest speed of the robot; a slower reel leaves slack behind a robot \
             that drives back"
        );
        section.complain("reel_speed_m_per_s", Complaint::OutOfRange(must_be));
    }
}

/// Complains about an anchor that is not on free floor, and about a reel that is too short to reach the start.
pub(crate) fn check(section: &Section<'_>, tether: &TetherConfig, site: &Site<'_>, start: Point) {
    if section.has("anchor_m")
        && let Some(what) = site.objection(tether.anchor)
    {
        section.complain("anchor_m", what);
    }
    let way_m = (start - tether.anchor).norm();
    if way_m > tether.limits.reel_length_m {
        let must_be = format!("at least {way_m:.2} m, the distance from the anchor to the start");
        section.complain("reel_length_m", Complaint::OutOfRange(must_be));
    }
}

/// Distance from the anchor, in metres, within which the certificate of a plan counts the robot as back; the mission's
/// tolerance applies if it is smaller.
const BACK_M: f64 = 0.3;
/// The share of that distance within which there must be a point with room for the hull and its clearance.
const ASIDE: f64 = 0.5;

/// Complains about an anchor without enough clearance for the returning robot: the hull must fit at the anchor, and the
/// hull with its clearance at a point nearby.
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
    // A point outside the tank or inside something solid is reported separately.
    if section.has(key) && away_m >= 0.0 {
        let must_be = format!(
            "at least {need_m:.3} m from {from}, because the robot returns to the anchor: its hull must fit \
             there, and the hull with its clearance must fit at a point within {aside_m:.3} m of the anchor; \
             the distance is {away_m:.3} m"
        );
        section.complain(key, Complaint::OutOfRange(must_be));
    }
}
