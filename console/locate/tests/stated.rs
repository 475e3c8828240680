//! Stated errors are true: over seeded sets of readings of each kind, the share of truths in the 95 % ellipses of the fixes that are
//! called ok, and of the track.
//!
//! The full study, 200 sets of each kind, takes a quarter of an hour:
//! `STATED_SETS=200 STATED_SEED=0 cargo test --release -p locate --test stated stated_errors -- --nocapture`.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "tests, and a study that prints its figures")]

#[path = "stated/sets.rs"]
mod sets;

use locate::Task;
use mission::{Event, EventKind};
use nalgebra::Matrix2;
use positioning::Integrity;
use scenario::Scenario;
use sets::{Kind, Set};
use world::Point;

/// Squared distance, in standard deviations, within which 95 % of a two-dimensional normal distribution lies.
const ELLIPSE_95: f64 = 5.991_464_547;

/// The number of sets from which on chance has no influence.
const ENOUGH: u64 = 200;
/// A number of fixes below this counts as few.
const FEW: u64 = 200;
/// Covariances in events have four significant digits: semi-axes are accurate to this share.
const ROUNDING: f64 = 5e-4;

/// Counts over sets of one kind.
#[derive(Debug, Default, Clone, Copy)]
struct Count {
    fixes: u64,
    ok: u64,
    ok_inside: u64,
    rows: u64,
    rows_inside: u64,
    /// Rows whose ellipse is wider than top speed allows since the last fix.
    too_wide: u64,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.fixes += other.fixes;
        self.ok += other.ok;
        self.ok_inside += other.ok_inside;
        self.rows += other.rows;
        self.rows_inside += other.rows_inside;
        self.too_wide += other.too_wide;
    }

    fn inside(&self) -> f64 {
        self.ok_inside as f64 / self.ok.max(1) as f64
    }

    fn ok_share(&self) -> f64 {
        self.ok as f64 / self.fixes.max(1) as f64
    }

    fn track_inside(&self) -> f64 {
        self.rows_inside as f64 / self.rows.max(1) as f64
    }
}

fn is_inside(truth: Point, at: Point, covariance: &Matrix2<f64>) -> bool {
    let away = truth - at;
    covariance.try_inverse().is_some_and(|inverse| away.dot(&(inverse * away)) <= ELLIPSE_95)
}

/// Locates a set and compares the result with the truth.
fn counted(set: &Set) -> Count {
    let scenario = Scenario::parse(&set.scenario, "set.toml").map_err(|errors| errors.render()).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("set.csv");
    std::fs::write(&file, &set.readings).unwrap();
    let task = Task {
        file: &file,
        shown: "set.csv",
        scenario: &scenario,
        sound_speed_m_s: set.sound_speed_m_s,
        finds_sound_speed: set.finds_sound_speed,
        finds_clock_offset: false,
        skips_bad_rows: false,
        tool_on: None,
    };
    let survey = task.survey().unwrap();
    let (mut count, mut truth) = (Count::default(), None);
    let v_max = scenario.mission.limits.v_max_m_per_s;
    let mut last: Option<(f64, f64)> = None;
    let take = |events: &[Event]| {
        let mut has_fix = false;
        for event in events {
            match &event.kind {
                EventKind::Truth { pose, .. } => truth = Some(pose.position),
                EventKind::Fixed { fix } => {
                    has_fix = true;
                    count.fixes += 1;
                    if fix.integrity == Integrity::Ok {
                        count.ok += 1;
                        let inside = truth.is_some_and(|at| is_inside(at, fix.position, &fix.covariance));
                        count.ok_inside += u64::from(inside);
                    }
                }
                EventKind::Estimated { pose } => {
                    let covariance = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
                    let half_m = positioning::fix::ellipse_95(&covariance).0;
                    count.rows += 1;
                    let inside = truth.is_some_and(|at| is_inside(at, pose.position, &covariance));
                    count.rows_inside += u64::from(inside);
                    if let Some((t_s, before_m)) = last.filter(|_| !has_fix && set.has_no_motion) {
                        let allowed_m = before_m + v_max * (event.t_s - t_s);
                        count.too_wide += u64::from(half_m > allowed_m * (1.0 + ROUNDING));
                    }
                    if has_fix || last.is_none() {
                        last = Some((event.t_s, half_m));
                    }
                }
                _ => {}
            }
        }
    };
    task.locate(&survey, take).unwrap();
    count
}

fn over(kind: Kind, seeds: std::ops::Range<u64>) -> Count {
    let mut count = Count::default();
    seeds.for_each(|seed| count.add(counted(&Set::new(kind, seed))));
    println!(
        "{kind:?}: {} fixes, {:.2} % ok, {:.2} % of truths inside; track {:.2} % inside, {} rows too wide",
        count.fixes,
        count.ok_share() * 100.0,
        count.inside() * 100.0,
        count.track_inside() * 100.0,
        count.too_wide
    );
    count
}

/// The requirements that a kind misses, with an allowance for chance if there are few sets.
fn missed(kind: Kind, count: &Count, room: f64) -> Vec<String> {
    let (inside, ok, track) = (count.inside(), count.ok_share(), count.track_inside());
    // Among a few dozen fixes, chance alone can put a larger share outside the ellipse than in the long run.
    let few = if count.ok < FEW { 2.6 * (0.05 * 0.95 / count.ok.max(1) as f64).sqrt() } else { 0.0 };
    let room = room.max(few);
    let has_track = matches!(kind, Kind::NoOdometry | Kind::OdometryGap | Kind::WrongMotion);
    let demands = [
        ("fixes that are ok", count.ok == 0 || ok < 0.001 || inside > 0.93 - room),
        ("no wider than needed", !kind.is_sound() || inside < 0.97 + room),
        ("sound fixes are ok", !kind.is_sound() || ok > 0.98 - room),
        ("the track", !has_track || track > 0.93 - room),
        ("no wider than top speed allows", !lacks_motion(kind) || count.too_wide == 0),
    ];
    let missed = demands.into_iter().filter(|(_, is_met)| !is_met);
    missed.map(|(what, _)| format!("{kind:?}, {what}: {count:?}")).collect()
}

fn lacks_motion(kind: Kind) -> bool {
    matches!(kind, Kind::NoOdometry | Kind::OdometryGap)
}

/// A number from an environment variable.
fn number(key: &str, default: u64) -> u64 {
    std::env::var(key).map_or(default, |text| text.parse().unwrap())
}

#[test]
fn stated_errors_hold_for_readings_of_every_kind() {
    let (sets, first) = (number("STATED_SETS", 12), number("STATED_SEED", 9_000));
    let room = if sets < ENOUGH { 0.02 } else { 0.0 };
    let missed: Vec<String> =
        Kind::ALL.into_iter().flat_map(|kind| missed(kind, &over(kind, first..first + sets), room)).collect();
    assert!(missed.is_empty(), "{missed:#?}");
}

#[test]
fn the_error_does_not_depend_on_how_often_rows_come() {
    for seed in 0..6 {
        let errors = |rate_hz: u32| {
            let set = Set::outage(seed, rate_hz);
            let scenario =
                Scenario::parse(&set.scenario, "set.toml").map_err(|errors| errors.render()).unwrap();
            let dir = tempfile::tempdir().unwrap();
            let file = dir.path().join("set.csv");
            std::fs::write(&file, &set.readings).unwrap();
            let task = Task {
                file: &file,
                shown: "set.csv",
                scenario: &scenario,
                sound_speed_m_s: None,
                finds_sound_speed: false,
                finds_clock_offset: false,
                skips_bad_rows: false,
                tool_on: None,
            };
            let mut by_second = Vec::new();
            let take = |events: &[Event]| {
                for event in events {
                    if let EventKind::Estimated { pose } = &event.kind
                        && (event.t_s - event.t_s.round()).abs() < 1e-9
                    {
                        let covariance = pose.covariance.fixed_view::<2, 2>(0, 0).into_owned();
                        by_second.push(positioning::fix::ellipse_95(&covariance).0);
                    }
                }
            };
            task.locate(&task.survey().unwrap(), take).unwrap();
            by_second
        };
        let (often, seldom) = (errors(10), errors(1));
        assert_eq!(often.len(), seldom.len());
        for (one, other) in often.iter().zip(&seldom) {
            assert!((one - other).abs() < 1e-4 * other.max(0.1), "{one} {other}");
        }
        assert!(seldom.iter().copied().fold(0.0, f64::max) > 10.0);
    }
}
