//! Absurd cycles between sound ones: all numbers stay finite, nothing is protected meanwhile, and sound ranges recover.

use positioning::{
    Aggregation, Guard, MotionNoise, Positioner, PositionerConfig, RangeNoise, Risk, SessionCalibration,
    SessionConfig, SolverKind, Timing,
};
use proptest::prelude::*;
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

const NOISE: RangeNoise = RangeNoise::Gaussian { sigma_ratio: 0.01 };

/// One kind of absurd input.
#[derive(Debug, Clone, Copy)]
enum Absurd {
    /// No station for this number of cycles.
    Silent,
    /// One station, heard 1,000 times.
    OneStation,
    /// All ranges are 1e9 m.
    TooLong,
    /// Ranges that are not numbers.
    NotANumber,
    /// Sets without any range.
    Empty,
}

fn absurd() -> impl Strategy<Value = Absurd> {
    prop_oneof![
        Just(Absurd::Silent),
        Just(Absurd::OneStation),
        Just(Absurd::TooLong),
        Just(Absurd::NotANumber),
        Just(Absurd::Empty),
    ]
}

/// Stations on a ring, on one line, or in one place.
fn stations() -> impl Strategy<Value = (bool, Vec<Station>)> {
    let on = |place: fn(f64) -> Point| {
        (0..6u32)
            .map(|id| Station { id: StationId(id), name: String::new(), position: place(f64::from(id)) })
            .collect::<Vec<Station>>()
    };
    let ring = on(|k| Point::new(10.0 * k.cos(), 10.0 * k.sin()));
    let line = on(|k| Point::new(4.0 * k - 10.0, -9.0));
    let same = on(|_| Point::new(-9.0, 1.0));
    prop_oneof![3 => Just((true, ring)), 1 => Just((false, line)), 1 => Just((false, same))]
}

/// Everything that takes the readings of a mission.
struct Taken {
    stations: Vec<Station>,
    positioner: Positioner,
    guard: Guard,
    session: SessionCalibration,
    t_s: f64,
    /// The length by which all ranges are too long, metres; above 0, the time of emission is unknown.
    excess_m: f64,
}

impl Taken {
    fn new(stations: Vec<Station>, start: Pose, excess_m: f64) -> Self {
        let is_free = excess_m > 0.0;
        let solver = if is_free { SolverKind::Differences } else { SolverKind::Nls };
        let config =
            PositionerConfig { noise: NOISE, solver, ..PositionerConfig::new(stations.clone(), start) };
        let ways = (Aggregation::Mean, NOISE, Timing::default());
        let session =
            SessionCalibration::new(SessionConfig::default(), &stations, ways, MotionNoise::default());
        Self {
            guard: Guard::new(&config, Risk::default()),
            positioner: Positioner::new(config),
            session: if is_free { session.with_free_emission() } else { session },
            stations,
            t_s: 0.0,
            excess_m,
        }
    }

    fn take(&mut self, sets: &[RangeSet]) {
        let rest = Odometry::default();
        let estimate = self.positioner.estimate();
        self.session.predict(&rest, estimate.pose.heading_rad);
        self.session.take(sets, (&estimate).into(), self.t_s);
        let corrected = self.session.corrected(sets);
        self.positioner.predict(&rest);
        self.guard.predict(&rest);
        let result = self.positioner.cycle(&corrected);
        self.guard.cycle(sets, &result.fix, Some(&self.session));
    }

    fn sound(&self, at: Point) -> Vec<RangeSet> {
        let set = |(k, station): (usize, &Station)| {
            // A fixed pattern of errors of at most one standard deviation.
            let wrong = 0.01 * [0.7, -0.4, 0.2, -0.8, 0.5, -0.1][(k + self.t_s as usize) % 6];
            let ranges_m = vec![(at - station.position).norm() * (1.0 + wrong) + self.excess_m];
            RangeSet { station: station.id, ranges_m }
        };
        self.stations.iter().enumerate().map(set).collect()
    }

    fn is_finite(&self) -> bool {
        let estimate = self.positioner.estimate();
        let scale = self.session.scale();
        let biases = self.session.biases_m().flat_map(|(_, bias_m)| [bias_m.value, bias_m.sigma]);
        [
            estimate.pose.position.x,
            estimate.pose.position.y,
            estimate.pose.heading_rad,
            scale.value,
            scale.sigma,
        ]
        .into_iter()
        .chain(estimate.covariance.iter().copied())
        .chain(biases)
        .all(f64::is_finite)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn absurd_cycles_protect_nothing_and_sound_ones_recover(
        (is_good, stations) in stations(),
        inputs in prop::collection::vec((absurd(), 12..3_600_usize), 1..4),
        repeats_times in any::<bool>(),
        excess_m in prop_oneof![Just(0.0), 1.0..200.0_f64],
    ) {
        let at = Point::new(2.0, 1.0);
        let mut taken = Taken::new(stations, Pose { position: at, heading_rad: 0.0 }, excess_m);
        for (input, cycles) in inputs {
            let count = if matches!(input, Absurd::Silent) { cycles } else { 12 + cycles % 20 };
            for _ in 0..count {
                taken.t_s += if repeats_times { 0.0 } else { 1.0 };
                let all = |range_m: f64| -> Vec<RangeSet> {
                    let set = |s: &Station| RangeSet { station: s.id, ranges_m: vec![range_m] };
                    taken.stations.iter().map(set).collect()
                };
                let sets = match input {
                    Absurd::Silent => Vec::new(),
                    Absurd::OneStation => {
                        vec![RangeSet { station: StationId(0), ranges_m: vec![3.0; 1_000] }]
                    }
                    Absurd::TooLong => all(1e9),
                    Absurd::NotANumber => all(f64::NAN),
                    Absurd::Empty => {
                        let set = |s: &Station| RangeSet { station: s.id, ranges_m: Vec::new() };
                        taken.stations.iter().map(set).collect()
                    }
                };
                taken.take(&sets);
                prop_assert!(taken.is_finite(), "{input:?}");
            }
            let level = taken.guard.level_m(&taken.positioner);
            prop_assert!(level.is_err(), "{input:?}: {level:?}");
        }
        for _ in 0..60 {
            taken.t_s += 1.0;
            let sets = taken.sound(at);
            taken.take(&sets);
            prop_assert!(taken.is_finite());
        }
        let level = taken.guard.level_m(&taken.positioner);
        if is_good {
            let error_m = (taken.positioner.estimate().pose.position - at).norm();
            // Without the time of emission, the same ranges say less.
            let (most_m, most) = if excess_m > 0.0 { (4.0, 0.03) } else { (2.0, 0.01) };
            prop_assert!(level.is_ok_and(|level_m| error_m < level_m && level_m < most_m), "{error_m}: {level:?}");
            prop_assert!((taken.session.scale().value).abs() < most, "{:?}", taken.session.scale());
        } else {
            prop_assert!(level.is_err(), "{level:?}");
        }
    }
}
