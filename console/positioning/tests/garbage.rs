//! Whatever the input, only finite numbers are returned, and nothing panics.

use nalgebra::Matrix2;
use positioning::{
    Bounded, Consensus, Fix, LinearLs, Nls, PositionSolver, Positioner, PositionerConfig, RangeNoise,
    Ranging, Screened, WeightedLinear,
};
use proptest::prelude::*;
use world::{Odometry, Point, Pose, RangeSet, Station, StationId};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -30.0..30.0_f64,
        2 => 0.1..20.0_f64,
        1 => prop::num::f64::ANY,
        1 => prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(0.0), Just(-0.0), Just(1e300),
            Just(1e6), Just(1e-300), Just(1e-9), Just(f64::MIN_POSITIVE),
        ],
    ]
}

fn good_range() -> impl Strategy<Value = f64> {
    prop_oneof![5 => 0.1..20.0_f64, 1 => number()]
}

fn stations() -> impl Strategy<Value = Vec<Station>> {
    prop::collection::vec((number(), number()), 0..7).prop_map(|places| {
        let station =
            |(id, (x, y))| Station { id: StationId(id), name: String::new(), position: Point::new(x, y) };
        (0..).zip(places).map(station).collect()
    })
}

fn rangings() -> impl Strategy<Value = Vec<Ranging>> {
    let one = (good_range(), good_range());
    prop::collection::vec(one, 0..7).prop_map(|numbers| {
        (0..)
            .zip(numbers)
            .map(|(id, (range_m, sigma_m))| Ranging::single(StationId(id), range_m, sigma_m))
            .collect()
    })
}

fn is_finite(fix: &Fix) -> bool {
    let residuals = fix.residuals.iter().flat_map(|r| [r.residual_m, r.sigma_m]);
    let mirror = fix.mirror.iter().flat_map(|m| [m.x, m.y]);
    let (long, short, angle) = fix.ellipse_95();
    [fix.position.x, fix.position.y, fix.chi2, fix.gdop, fix.conditioning, long, short, angle]
        .into_iter()
        .chain(fix.covariance.iter().copied())
        .chain(residuals)
        .chain(mirror)
        .all(f64::is_finite)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn solvers_give_finite_fixes_or_reasons(
        ranges in rangings(),
        stations in stations(),
        prior in prop::option::of((number(), number(), number(), number())),
    ) {
        let prior = prior.map(|(x, y, a, b)| (Point::new(x, y), Matrix2::new(a, b, b, a)));
        for solver in [
            &LinearLs as &dyn PositionSolver, &Nls, &WeightedLinear, &Bounded { ratio: 0.05 }, &Bounded { ratio: 0.9 },
            &Consensus::default(), &Screened(Nls),
        ] {
            match solver.solve(&ranges, &stations, prior) {
                Ok(fix) => prop_assert!(is_finite(&fix), "{fix:?}"),
                Err(error) => {
                    let words = error.to_string();
                    prop_assert!(!words.contains("NaN") && !words.contains("inf"), "{words}");
                }
            }
        }
    }

    #[test]
    fn the_positioner_survives_everything(
        stations in stations(),
        cycles in prop::collection::vec(
            (prop::collection::vec(prop::collection::vec(good_range(), 0..4), 0..6), number(), number()), 1..8,
        ),
        ratio in number(),
    ) {
        let config = PositionerConfig {
            noise: RangeNoise::Gaussian { sigma_ratio: ratio }, ..PositionerConfig::new(stations, Pose::new(0.0, 0.0, 0.0))
        };
        let mut positioner = Positioner::new(config);
        for (sets, forward_m, turn_rad) in cycles {
            positioner.predict(&Odometry { forward_m, sideways_m: 0.0, turn_rad });
            let sets: Vec<RangeSet> =
                (0..).zip(sets).map(|(id, ranges_m)| RangeSet { station: StationId(id), ranges_m }).collect();
            if let Ok(fix) = positioner.cycle(&sets).fix {
                prop_assert!(is_finite(&fix), "{fix:?}");
            }
            let estimate = positioner.estimate();
            prop_assert!(estimate.pose.position.iter().all(|c| c.is_finite()));
            prop_assert!(estimate.covariance.iter().all(|c| c.is_finite()));
            prop_assert!(positioner.error_95_m().is_finite());
        }
    }
}
