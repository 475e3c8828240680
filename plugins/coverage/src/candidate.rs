//! Candidates of a tether-safe plan: what is tried, what each one is worth, and which are worth showing.

use crate::{
    cuts::{CutRule, Domain, domain},
    ground::Ground,
    lanes::{Pattern, Reach},
    scan::{Recipe, Scan, rotation_turns},
    tour::Effort,
};
use planner_api::Site;
use std::f64::consts::{PI, TAU};
use world::{
    Boundary, Obstacle, ObstacleId, Point, Shape, polyline,
    tether::{Cable, Case, Certificate, Limits, certify},
};

/// Shares of the cable's slack by which a cut may lengthen the way to its far end, tried in this order until the cable
/// keeps its limits: cuts across the lanes, and cuts along them. The cable seldom gets as long as a single cut makes
/// one fear.
const SLACKS_ACROSS: [f64; 4] = [1.0, 0.7, 0.4, 0.2];
const SLACKS_ALONG: [f64; 7] = [3.0, 2.2, 1.7, 1.3, 1.0, 0.8, 0.5];

/// The hull goes round a column further out than the cable does; by about this share of the least cable.
const AROUND_SHARE: f64 = 0.026;

/// What floor is worth when the path is shortened, as a multiple of the path that sweeps it.
const FLOOR_SHARE: f64 = 9.0;

/// What the operator sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wishes {
    /// Largest angle between cut and ray, radians.
    pub alpha_rad: f64,
    /// Longest cable, as a multiple of the least that can do.
    pub cable_share: f64,
    /// Reel and wraps that are wanted.
    pub limits: Limits,
    /// Reel and wraps that the mission demands.
    pub demanded: Limits,
    /// Price of a whole turn in the search, metres.
    pub turn_m: f64,
    /// Price of a whole turn in the choice among candidates, metres.
    pub choice_turn_m: f64,
    /// Coverage that is enough.
    pub enough: f64,
    /// Directions of straight lanes that are tried; none if 0.
    pub directions: usize,
    /// Whether contours are tried.
    pub contours: bool,
    /// Kicks per lane in the search for a tour.
    pub kicks_per_lane: f64,
    /// Start of random choices.
    pub seed: u64,
}

/// One way to make a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// What the operator calls it.
    pub name: String,
    pattern: Pattern,
    /// Distance between lanes and cuts, as a share of the swath.
    cut_share: f64,
}

/// What a candidate is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// Length, metres.
    pub length_m: f64,
    /// Sum of changes of heading, in whole turns.
    pub turns: f64,
    /// Swept share of the floor that the tool can reach.
    pub coverage: f64,
    /// What the tether says.
    pub certificate: Certificate,
}

impl Worth {
    /// Whether another is no worse in anything and better in something.
    pub fn is_beaten_by(&self, other: &Self) -> bool {
        let figures = |w: &Self| {
            [w.length_m, w.turns, w.certificate.tether_length_max_m, w.certificate.wrap_total_max_rad]
        };
        let pairs = || figures(self).into_iter().zip(figures(other));
        pairs().all(|(own, theirs)| theirs <= own) && pairs().any(|(own, theirs)| theirs < own)
    }

    /// Longest cable as a multiple of the least that can do.
    pub fn cable_share(&self) -> f64 {
        self.certificate.tether_length_max_m / self.certificate.eccentricity_m.max(1e-9)
    }

    /// One line for the operator.
    pub fn summary(&self, name: &str) -> String {
        let c = &self.certificate;
        format!(
            "{name}: {:.1} m, {:.0} turns, {:.2} % of the floor in reach, cable {:.2} m ({:.3} of the least), wrap \
             {:.0} / {:.0} deg{}",
            self.length_m,
            self.turns,
            100.0 * self.coverage,
            c.tether_length_max_m,
            self.cable_share(),
            c.wrap_max_rad.to_degrees(),
            c.wrap_total_max_rad.to_degrees(),
            if c.certified { String::new() } else { format!("; not certified: {}", c.reasons.join("; ")) },
        )
    }
}

/// Longest straight way from the anchor to where the robot can be, about: the least cable that can do, metres.
pub fn least_cable_m(ground: &Ground) -> f64 {
    match &ground.wall {
        Boundary::Circle { radius_m } => radius_m - ground.keep_m + ground.anchor.coords.norm(),
        Boundary::Polygon { vertices } => {
            let far = vertices.iter().map(|v| (v - ground.anchor).norm()).fold(0.0, f64::max);
            far - ground.keep_m * std::f64::consts::SQRT_2
        }
    }
}

/// What is tried, with cuts up to `alpha_rad` off the ray.
pub fn candidates(ground: &Ground, wishes: &Wishes, alpha_rad: f64) -> Vec<Candidate> {
    let angle = format!("cuts within {:.0} deg", alpha_rad.to_degrees());
    let make = |name: String, pattern: Pattern, cut_share: f64| Candidate {
        name: format!("{name}, {angle}"),
        pattern,
        cut_share,
    };
    let mut all = Vec::new();
    if wishes.contours {
        all.push(make("contours".to_owned(), Pattern::Contours, 0.33));
    }
    for k in 0..wishes.directions {
        let angle_rad = main_direction(ground) + PI * k as f64 / wishes.directions as f64;
        let (shift_m, spacing_m) = rows(ground, angle_rad);
        let pattern = Pattern::Straight { angle_rad, shift_m, spacing_m, laps: 1 };
        all.push(make(format!("straight lanes at {:.0} deg", angle_rad.to_degrees()), pattern, 0.08));
    }
    all
}

impl Candidate {
    /// How it is made, and its domain unless there is no room: costs a few domains, to find how far cuts may go.
    pub fn recipe(&self, ground: &Ground, wishes: &Wishes, alpha_rad: f64) -> (Recipe, Option<Domain>) {
        let Self { pattern, cut_share, .. } = *self;
        let (rule, domain) = cut_domain(ground, wishes, &pattern, alpha_rad);
        let recipe = Recipe {
            pattern,
            rule,
            reach: Reach { cut_m: cut_share * ground.swath_m, lap_share: 0.5, least_m: ground.swath_m / 3.0 },
            effort: Effort {
                turn_m_per_rad: wishes.turn_m / TAU,
                kicks_per_lane: wishes.kicks_per_lane,
                seed: wishes.seed,
            },
            touch_m2: 0.55 * ground.swath_m * ground.swath_m,
            rounds: 1,
            floor_m_per_m2: FLOOR_SHARE / ground.swath_m,
            enough: wishes.enough,
        };
        (recipe, domain)
    }
}

/// How far cuts may go, and the domain that they leave.
fn cut_domain(
    ground: &Ground,
    wishes: &Wishes,
    pattern: &Pattern,
    alpha_rad: f64,
) -> (CutRule, Option<Domain>) {
    let least_m = least_cable_m(ground);
    let most_m = (least_m * wishes.cable_share).min(wishes.limits.reel_length_m);
    let with = |slack: f64| {
        (least_m + (least_m * wishes.cable_share - least_m) * slack).min(wishes.limits.reel_length_m)
    };
    let home = ground.home();
    let made = |slack: f64| {
        let rule = CutRule { alpha_rad, cable_m: with(slack) };
        (rule, domain(ground, pattern, &rule, home))
    };
    let keeps = |(_, domain): &(CutRule, Option<Domain>)| {
        let is_short = |(_, slit): &Domain| slit.is_all_within(home, most_m + AROUND_SHARE * least_m);
        domain.as_ref().is_none_or(is_short)
    };
    let slacks: &[f64] = if *pattern == Pattern::Contours { &SLACKS_ACROSS } else { &SLACKS_ALONG };
    slacks.iter().map(|slack| made(*slack)).find(keeps).unwrap_or_else(|| made(0.0))
}

/// Place of the first lane across a direction, and the distance between lanes: even between straight walls.
fn rows(ground: &Ground, angle_rad: f64) -> (f64, f64) {
    if matches!(ground.wall, Boundary::Circle { .. }) {
        (0.0, ground.swath_m * 0.997)
    } else {
        even_rows(ground, angle_rad)
    }
}

/// Place of the first lane across a direction, and an even distance between lanes from wall to wall.
pub fn even_rows(ground: &Ground, angle_rad: f64) -> (f64, f64) {
    let side = crate::ground::direction(angle_rad + PI / 2.0);
    let (low, high) = match &ground.wall {
        Boundary::Circle { radius_m } => (-radius_m, *radius_m),
        Boundary::Polygon { vertices } => {
            let places = vertices.iter().map(|v| v.coords.dot(&side));
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)))
        }
    };
    let margin_m = ground.keep_m + crate::ground::SLACK_M;
    let width_m = (high - low - 2.0 * margin_m).max(ground.swath_m);
    let n = (width_m / ground.swath_m - 0.02).ceil().max(1.0);
    (low + margin_m, width_m / n)
}

/// The direction of the longest wall; east in a round tank.
fn main_direction(ground: &Ground) -> f64 {
    let Boundary::Polygon { vertices } = &ground.wall else { return 0.0 };
    let edges = vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(a, b)| b - a);
    edges.max_by(|a, b| a.norm().total_cmp(&b.norm())).map_or(0.0, |edge| edge.y.atan2(edge.x).rem_euclid(PI))
}

/// What a scan is worth to a robot whose cable lies like this.
pub fn worth(ground: &Ground, site: &Site<'_>, limits: Limits, scan: &Scan, cable: Option<&Cable>) -> Worth {
    let path = scan.path();
    Worth {
        length_m: polyline::length_m(&path),
        turns: rotation_turns(&path),
        coverage: scan.grid.coverage(),
        certificate: certificate(ground, site, limits, &path, &scan.cut_lines(), cable),
    }
}

/// The tether's word on a path.
pub fn certificate(
    ground: &Ground,
    site: &Site<'_>,
    limits: Limits,
    path: &[Point],
    cuts: &[Vec<Point>],
    cable: Option<&Cable>,
) -> Certificate {
    let obstacles = solids(site);
    let case = Case {
        path,
        anchor: ground.anchor,
        cable,
        boundary: &ground.wall,
        obstacles: &obstacles,
        room_m: ground.keep_m,
        limits,
        returns: true,
        cuts,
    };
    certify(&case).unwrap_or_else(|error| Certificate {
        certified: false,
        reasons: vec![error.to_string()],
        tether_length_max_m: f64::INFINITY,
        eccentricity_m: least_cable_m(ground),
        wrap_max_rad: f64::INFINITY,
        wrap_total_max_rad: f64::INFINITY,
        end_length_m: None,
        crossings_left: 0,
        collisions: 0,
        clearance_min_m: 0.0,
        cut_crossings: 0,
        sealed_m2: 0.0,
    })
}

/// Everything solid of a site, no-go zones left out: they stop the robot, not its cable.
pub fn solids(site: &Site<'_>) -> Vec<Obstacle> {
    site.obstacles
        .iter()
        .map(|o| Obstacle {
            id: ObstacleId(o.id),
            name: format!("obstacle {}", o.id),
            shape: shape(&o.outline),
            known: true,
        })
        .collect()
}

fn shape(outline: &planner_api::Outline<'_>) -> Shape {
    use planner_api::Outline;
    match *outline {
        Outline::Disc { center, radius_m } => Shape::Disc { center, radius_m },
        Outline::Polygon { vertices } => Shape::Polygon { vertices: vertices.to_vec() },
        Outline::Polyline { points, half_width_m } => {
            Shape::Polyline { points: points.to_vec(), half_width_m }
        }
    }
}
