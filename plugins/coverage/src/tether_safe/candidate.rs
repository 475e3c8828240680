//! Candidates of a tether-safe plan: combinations of a lane pattern and rules for cuts.

use crate::cuts::{CutRule, broken_lanes, domain, domain_between_walls};
use crate::draft::rotation_turns;
use crate::pattern::{Pattern, Rows};
use crate::scan::Scan;
use crate::slit_domain::SlitDomain;
use crate::tether::{Tethered, least_cable_m};
use crate::tether_safe::parameters::{Choice, Preferences};
use crate::tuning::choice::{
    ANGLES_BETWEEN_WALLS, BETWEEN_WALLS, BY_OBSTACLE, LEAST_TOURED, LOOKED_AT, MOST_ANGLE_RAD, PLACES,
    PULL_M, SLIVER_PER_M, TOURED_M,
};
use crate::tuning::cuts::{AROUND_M, SLACKS_ACROSS, SLACKS_ALONG};
use crate::workspace::Workspace;
use planner_api::Site;
use std::f64::consts::PI;
use world::tether::{Cable, Certificate, Strain};
use world::{Boundary, coverage::percent_text, polyline, shape::ring_area_m2};

/// One way to make a plan.
pub(super) struct Candidate {
    pub pattern: Pattern,
    /// Largest angle between a cut and the ray from the anchor, radians.
    alpha_rad: f64,
}

impl Candidate {
    /// All candidates, with cuts up to `alpha_rad` off the ray from the anchor.
    pub(super) fn all(workspace: &Workspace, preferences: &Preferences, alpha_rad: f64) -> Vec<Self> {
        // Contours of the outer wall are unsuitable as lanes between inner walls, and too many columns break them.
        let is_other = workspace.is_room || workspace.is_crowded();
        let is_meant = preferences.contours && (preferences.directions == 0 || !is_other);
        let contours = is_meant.then_some(Pattern::Contours);
        let straight = straight(workspace, preferences, alpha_rad);
        let patterns: Vec<Pattern> = contours.into_iter().chain(straight).collect();
        let with_cuts =
            |alpha_rad: f64| patterns.iter().map(move |pattern| Self { pattern: *pattern, alpha_rad });
        angles_rad(workspace, alpha_rad, patterns.len()).into_iter().flat_map(with_cuts).collect()
    }

    /// The name shown to the operator.
    pub(super) fn name(&self) -> String {
        let lanes = match self.pattern {
            Pattern::Contours => "contours".to_owned(),
            Pattern::Straight { rows, .. } => {
                format!("straight lanes at {:.0} deg", rows.angle_rad.to_degrees())
            }
        };
        format!("{lanes}, cuts within {:.0} deg of the ray from the anchor", self.alpha_rad.to_degrees())
    }

    /// The domain between the candidate's cuts, if the hull fits at home. Several domains are computed to find the
    /// loosest rule for cuts that keeps the cable within its limits.
    pub(super) fn domain<'a>(
        &self,
        workspace: &'a Workspace,
        preferences: &Preferences,
    ) -> Option<SlitDomain<'a>> {
        if workspace.is_room {
            return domain_between_walls(workspace);
        }
        let (least_m, reel_length_m) = (least_cable_m(workspace), preferences.limits.reel_length_m);
        let preferred_m = preferences.preferred_cable_m(least_m);
        let most_m = preferred_m.min(reel_length_m);
        let made = |slack: f64| {
            let cable_m = (least_m + (preferred_m - least_m) * slack).min(reel_length_m);
            domain(workspace, &self.pattern, &CutRule { alpha_rad: self.alpha_rad, cable_m })
        };
        let is_short = |domain: &SlitDomain<'_>| domain.is_all_within(most_m + AROUND_M);
        let slacks: &[f64] = if self.pattern == Pattern::Contours { &SLACKS_ACROSS } else { &SLACKS_ALONG };
        let mut domains = slacks.iter().map(|slack| made(*slack));
        domains.find(|domain| domain.as_ref().is_none_or(is_short)).unwrap_or_else(|| made(0.0))
    }
}

/// Straight lanes in different directions. In a round tank: the directions, out of many, in which cuts and obstacles
/// break the fewest lanes, each at the offset where obstacles break the fewest.
fn straight(workspace: &Workspace, preferences: &Preferences, alpha_rad: f64) -> Vec<Pattern> {
    let is_round = matches!(workspace.wall, Boundary::Circle { .. }) && !workspace.is_room;
    let wanted = preferences.directions.min(most_directions(workspace, is_round));
    let looked_at = if is_round && wanted > 0 { wanted.max(LOOKED_AT) } else { wanted };
    let pattern = |rows: Rows| Pattern::Straight { rows, laps: 1 };
    let rows = |k: usize| {
        let angle_rad = main_direction_rad(&workspace.wall) + PI * k as f64 / looked_at as f64;
        Rows::new(workspace, angle_rad)
    };
    if !is_round {
        return (0..looked_at).map(|k| pattern(rows(k))).collect();
    }
    let cable_m = least_cable_m(workspace) * preferences.cable_share.min(2.0);
    let rule = CutRule { alpha_rad, cable_m: cable_m.min(preferences.limits.reel_length_m) };
    let best_place = |k: usize| {
        let rows = rows(k);
        let places = (0..PLACES).map(|place| rows.aside(place as f64 / PLACES as f64));
        let priced = places.map(|rows| (broken_by_obstacles(workspace, &rows), rows));
        let (cost, best) = priced.reduce(|best, other| if other.0 < best.0 { other } else { best })?;
        Some((cost + broken_lanes(workspace, &pattern(best), &rule), best))
    };
    let mut found: Vec<(f64, Rows)> = (0..looked_at).filter_map(best_place).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(wanted).map(|(_, rows)| pattern(rows)).collect()
}

/// The largest cut angles to try, radians; several between straight walls, where lanes have few directions.
fn angles_rad(workspace: &Workspace, alpha_rad: f64, n_patterns: usize) -> Vec<f64> {
    if matches!(workspace.wall, Boundary::Circle { .. }) || workspace.is_crowded() {
        return vec![alpha_rad];
    }
    let most = most_toured(workspace) / n_patterns.max(1);
    let larger_rad = |times: f64| alpha_rad.max((alpha_rad * times).min(MOST_ANGLE_RAD));
    let mut angles_rad = ANGLES_BETWEEN_WALLS.map(larger_rad).to_vec();
    angles_rad.dedup();
    angles_rad.truncate(most.max(1));
    angles_rad
}

/// The number of directions of straight lanes that are worth trying.
fn most_directions(workspace: &Workspace, is_round: bool) -> usize {
    if workspace.is_crowded() {
        return 1;
    }
    if is_round { most_toured(workspace) } else { BETWEEN_WALLS }
}

/// The number of first tours that are worth computing.
fn most_toured(workspace: &Workspace) -> usize {
    let area_m2 = match &workspace.wall {
        Boundary::Circle { radius_m } => PI * radius_m * radius_m,
        Boundary::Polygon { vertices } => ring_area_m2(vertices).abs(),
    };
    ((TOURED_M * workspace.swath_m / area_m2) as usize).max(LEAST_TOURED)
}

/// The cost of rows due to obstacles and to slivers along the wall, in lanes broken by a cut.
fn broken_by_obstacles(workspace: &Workspace, rows: &Rows) -> f64 {
    BY_OBSTACLE * rows.broken(workspace) + SLIVER_PER_M * rows.slivers_m(workspace)
}

/// The direction of the longest wall, radians; east in a round tank.
fn main_direction_rad(wall: &Boundary) -> f64 {
    let Boundary::Polygon { vertices } = wall else { return 0.0 };
    let edges = polyline::edges(vertices).map(|(a, b)| b - a);
    edges.max_by(|a, b| a.norm().total_cmp(&b.norm())).map_or(0.0, |edge| edge.y.atan2(edge.x).rem_euclid(PI))
}

/// The value of a candidate.
pub(super) struct Worth {
    /// Length, metres.
    pub length_m: f64,
    /// Sum of changes of heading, in whole turns.
    pub turns: f64,
    /// Swept share of the reachable floor.
    pub coverage: f64,
    /// The certificate for the tether.
    pub certificate: Certificate,
}

impl Worth {
    /// Computes the value of a scan for a robot with the cable in the given position.
    pub(super) fn of(
        site: &Site<'_>,
        preferences: &Preferences,
        scan: &Scan<'_>,
        cable: Option<&Cable>,
    ) -> Self {
        let path = scan.path();
        let tethered = Tethered { domain: &scan.domain, path: &path, cable };
        Self {
            length_m: polyline::length_m(&path),
            turns: rotation_turns(&path),
            coverage: scan.swept.coverage(),
            certificate: tethered.certificate(site, preferences.demands()),
        }
    }

    /// Whether another candidate is no worse in any figure and better in at least one.
    pub(super) fn is_beaten_by(&self, other: &Self) -> bool {
        let figures = |w: &Self| {
            [w.length_m, w.turns, w.certificate.tether_length_max_m, w.certificate.wrap_total_max_rad]
        };
        let pairs = || figures(self).into_iter().zip(figures(other));
        pairs().all(|(own, theirs)| theirs <= own) && pairs().any(|(own, theirs)| theirs < own)
    }

    /// A one-line summary for the operator.
    pub(super) fn summary(&self, name: &str) -> String {
        let c = &self.certificate;
        format!(
            "{name}: {:.1} m, {:.0} turns, {} % of reachable floor, tether {:.2} m ({:.0} % above the minimum), \
             wrap {:.0} deg on one obstacle, {:.0} deg in all{}{}",
            self.length_m,
            self.turns,
            percent_text(self.coverage, 2),
            c.tether_length_max_m,
            100.0 * (Strain::from(c).cable_share() - 1.0),
            c.wrap_max_rad.to_degrees(),
            c.wrap_total_max_rad.to_degrees(),
            c.pull.map_or_else(String::new, |pull| format!(", pull {}", pull.text())),
            if c.certified { String::new() } else { format!("; not certified: {}", c.reasons.join("; ")) },
        )
    }

    /// Whether the candidate is certified and also meets the preferences for the cable.
    pub(super) fn meets(&self, preferences: &Preferences) -> bool {
        self.certificate.certified && preferences.allow(&Strain::from(&self.certificate))
    }

    /// Whether the plan can be run safely, with or without a tether, as far as this can be certified.
    pub(super) fn is_safe(&self, has_tether: bool) -> bool {
        self.certificate.certified || (!has_tether && self.certificate.collisions == 0)
    }

    /// Whether this candidate is preferred to another: certified first, then within the preferences, then by the chosen
    /// figure.
    pub(super) fn is_before(&self, other: &Self, preferences: &Preferences) -> bool {
        let figure = |worth: &Self| match preferences.choice {
            Choice::Shortest => {
                worth.length_m
                    + preferences.choice_turn_m * worth.turns
                    + PULL_M * preferences.pull_share(&Strain::from(&worth.certificate))
            }
            Choice::FewestTurns => worth.turns,
            Choice::ShortestCable => worth.certificate.tether_length_max_m,
        };
        let rank = |worth: &Self| (!worth.certificate.certified, !worth.meets(preferences));
        rank(self).cmp(&rank(other)).then(figure(self).total_cmp(&figure(other))).is_lt()
    }
}
