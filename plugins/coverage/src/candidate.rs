//! Candidates of a tether-safe plan: what is tried, what each one is worth, and which are worth showing.

use crate::{
    cuts::CutRule,
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

/// Part of the cable's slack that the cuts may use up; the rest is for what they do not foresee.
const SLACK_SHARE: f64 = 0.8;

/// What the operator sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wishes {
    /// Largest angle between cut and ray, radians.
    pub alpha_rad: f64,
    /// Longest cable, as a multiple of the least that can do.
    pub cable_share: f64,
    /// Reel and wraps.
    pub limits: Limits,
    /// Price of a whole turn, metres.
    pub turn_m: f64,
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
    /// How it is made.
    pub recipe: Recipe,
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
        let figures =
            |w: &Self| [w.length_m, w.turns, w.certificate.max_cable_m, w.certificate.max_sum_wrap_rad];
        let pairs = || figures(self).into_iter().zip(figures(other));
        pairs().all(|(own, theirs)| theirs <= own) && pairs().any(|(own, theirs)| theirs < own)
    }

    /// Longest cable as a multiple of the least that can do.
    pub fn cable_share(&self) -> f64 {
        self.certificate.max_cable_m / self.certificate.eccentricity_m.max(1e-9)
    }

    /// One line for the operator.
    pub fn told(&self, name: &str) -> String {
        let c = &self.certificate;
        format!(
            "{name}: {:.1} m, {:.0} turns, {:.2} % of the floor in reach, cable {:.2} m ({:.3} of the least), wrap \
             {:.0} / {:.0} deg{}",
            self.length_m,
            self.turns,
            100.0 * self.coverage,
            c.max_cable_m,
            self.cable_share(),
            c.max_wrap_rad.to_degrees(),
            c.max_sum_wrap_rad.to_degrees(),
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

/// Candidates with cuts up to `alpha_rad` off the ray.
pub fn candidates(ground: &Ground, wishes: &Wishes, alpha_rad: f64) -> Vec<Candidate> {
    let slack = (wishes.cable_share - 1.0) * SLACK_SHARE;
    let cable_m = (least_cable_m(ground) * (1.0 + slack)).min(wishes.limits.reel_m);
    let rule = CutRule { alpha_rad, cable_m };
    let angle = format!("cuts within {:.0} deg", alpha_rad.to_degrees());
    let make = |name: String, pattern: Pattern, cut_share: f64| Candidate {
        name: format!("{name}, {angle}"),
        recipe: Recipe {
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
            floor_m_per_m2: 30.0 / ground.swath_m,
            enough: wishes.enough,
        },
    };
    let mut all = Vec::new();
    if wishes.contours {
        all.push(make("contours".to_owned(), Pattern::Contours, 0.33));
    }
    for k in 0..wishes.directions {
        let angle_rad = main_direction(ground) + PI * k as f64 / wishes.directions as f64;
        let pattern =
            Pattern::Straight { angle_rad, shift_m: 0.0, spacing_m: ground.swath_m * 0.997, laps: 1 };
        all.push(make(format!("straight lanes at {:.0} deg", angle_rad.to_degrees()), pattern, 0.08));
    }
    all
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
        max_cable_m: f64::INFINITY,
        eccentricity_m: least_cable_m(ground),
        max_wrap_rad: f64::INFINITY,
        max_sum_wrap_rad: f64::INFINITY,
        left_out_m: None,
        crossings_left: 0,
        collisions: 0,
        min_clearance_m: 0.0,
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
