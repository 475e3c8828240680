//! The reasons for refusing a path, as sentences.

use super::{
    cable::Cable, cable_obstacles::Bearing, case::Case, certificate::Certificate, clearance::Clearance,
    replay::Replay, sealed_region::SealedRegions,
};
use crate::beside_limit;
use geometry::Point;

/// Distance from the anchor within which a path must end to have returned, metres.
pub const BACK_M: f64 = 0.3;

/// The data that the reasons are derived from, besides the certificate.
pub(super) struct Reasons<'a> {
    pub case: &'a Case<'a>,
    pub replay: &'a Replay,
    /// The cable after the return.
    pub left: &'a Cable,
    pub clearance: &'a Clearance,
    pub sealed: Option<SealedRegions>,
}

impl Reasons<'_> {
    /// Returns all reasons for refusing the path, one sentence each.
    pub(super) fn of(&self, certificate: &Certificate) -> Vec<String> {
        let limits = &self.case.limits;
        let mut reasons: Vec<String> = Vec::new();
        if self.case.path.is_empty() {
            reasons.push("the plan has no path".into());
        }
        if self.case.path.iter().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            reasons.push("the path has a coordinate that is not a finite number".into());
        }
        if self.case.cuts.iter().flatten().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            reasons.push("a cut has a coordinate that is not a finite number".into());
        }
        if [self.case.room_m, limits.reel_length_m, limits.wrap_max_rad, limits.wrap_total_max_rad]
            .iter()
            .any(|m| m.is_nan())
        {
            reasons.push("the clearance of the hull or a limit of the tether is not a number".into());
        }
        if certificate.pull.is_some_and(|pull| !pull.ratio().is_finite() || pull.robot_needed_n.is_nan()) {
            reasons.push(
                "the pull of the reel, or the weight or friction of the tether, is not a number".into(),
            );
        }
        reasons.extend(self.collision(certificate));
        if certificate.tether_length_max_m > limits.reel_length_m {
            let (most_m, at) = self.replay.max_cable;
            let (place, [most, reel]) = (place(at), beside_limit(most_m, limits.reel_length_m, 1));
            reasons.push(format!("{most} m of tether out at {place}, but the reel holds {reel} m"));
        }
        if certificate.wrap_max_rad > limits.wrap_max_rad {
            let (wrap_rad, on) = self.replay.max_wrap;
            let [wrap, limit] = beside_limit(wrap_rad.to_degrees(), limits.wrap_max_rad.to_degrees(), 0);
            let on = self.name_of(on);
            reasons.push(format!("tether wraps {wrap}° around {on}, limit {limit}°"));
        }
        if certificate.wrap_total_max_rad > limits.wrap_total_max_rad {
            let (total_rad, at) = self.replay.max_sum;
            let [total, limit] =
                beside_limit(total_rad.to_degrees(), limits.wrap_total_max_rad.to_degrees(), 0);
            let place = place(at);
            reasons.push(format!("total tether wrap {total}° at {place}, limit {limit}°"));
        }
        reasons.extend(self.too_much_pull(certificate));
        reasons.extend(self.left_out(certificate));
        match certificate.cut_crossings {
            0 => {}
            1 => reasons.push("the path crosses a cut".to_owned()),
            n => reasons.push(format!("the path crosses cuts {n} times")),
        }
        if let Some(sealed) = self.sealed {
            reasons.push(format!("cuts seal off {:.2} m² of floor at {}", sealed.area_m2, place(sealed.at)));
        }
        reasons
    }

    /// Returns what is close to a limit, one sentence each.
    pub(super) fn warnings(&self, certificate: &Certificate) -> Vec<String> {
        let (Some(pull), Some(limits)) = (certificate.pull, self.case.pull) else { return Vec::new() };
        let (ratio, limit) = (pull.ratio(), limits.preferred_n / limits.reel_n);
        let warning = || {
            let [ratio, limit] = beside_limit(ratio, limit, 2);
            format!("reeling in needs {}, ratio {ratio}: above {limit}, slack may remain", pull.text())
        };
        (pull.needed_n > limits.preferred_n && ratio <= 1.0).then(warning).into_iter().collect()
    }

    fn too_much_pull(&self, certificate: &Certificate) -> Vec<String> {
        let (Some(pull), Some(limits)) = (certificate.pull, self.case.pull) else { return Vec::new() };
        let weak_reel = || {
            let [needed, reel] = beside_limit(pull.needed_n, pull.reel_n, 1);
            format!(
                "reeling in needs {needed} N at {}, the reel pulls {reel} N: use a stronger reel, a lighter tether, another \
                 anchor or another planner",
                place(pull.at)
            )
        };
        let weak_robot = |limit_n: f64| {
            let [needed, limit] = beside_limit(pull.robot_needed_n, limit_n, 1);
            format!(
                "the robot must pull {needed} N at {} to draw out its tether, but can pull {limit} N: use a reel that pulls \
                 less, a lighter tether, a stronger robot, another anchor or another planner",
                place(pull.robot_at)
            )
        };
        let is_over = |limit_n: &f64| pull.robot_needed_n > *limit_n;
        let robot = limits.robot_n.filter(is_over).map(weak_robot);
        (pull.ratio() > 1.0).then(weak_reel).into_iter().chain(robot).collect()
    }

    fn collision(&self, certificate: &Certificate) -> Option<String> {
        let (at, name) = self.clearance.first.as_ref()?;
        let lack = match certificate.collisions {
            1 => "1 segment of the path lacks clearance,".to_owned(),
            n => format!("{n} segments of the path lack clearance, the first"),
        };
        let [least, required] = beside_limit(certificate.clearance_min_m, self.case.room_m, 3);
        Some(format!("{lack} at {} near {name}: minimum {least} m, required {required} m", place(*at)))
    }

    fn left_out(&self, certificate: &Certificate) -> Option<String> {
        let last = self.case.path.last().filter(|_| self.case.returns)?;
        let away_m = (last - self.case.anchor).norm();
        if away_m > BACK_M {
            return Some(format!("the path ends {away_m:.2} m away from the anchor"));
        }
        let end_length_m = certificate.end_length_m.unwrap_or(0.0);
        if self.left.signature().is_empty() && end_length_m <= BACK_M {
            return None;
        }
        let mut round: Vec<String> = self.left.contacts().iter().map(|c| self.name_of(Some(c.on))).collect();
        round.dedup();
        let round = if round.len() > 3 {
            format!("{} obstacles (first: {})", round.len(), round[0])
        } else {
            round.join(", ")
        };
        Some(format!("{end_length_m:.1} m of tether still out on return, hooked around {round}"))
    }

    fn name_of(&self, on: Option<Bearing>) -> String {
        match on {
            Some(Bearing::Obstacle(k)) => {
                let obstacle = self.case.obstacles.get(k);
                obstacle.map_or_else(|| format!("obstacle {k}"), |o| o.name.clone())
            }
            Some(Bearing::Wall) | None => "a corner of the wall".into(),
        }
    }
}

fn place(at: Point) -> String {
    format!("{:.2}, {:.2} m", at.x, at.y)
}
