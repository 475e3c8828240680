use super::*;
use crate::slit_domain::SlitDomain;
use crate::workspace::Workspace;
use proptest::prelude::*;
use trials::tanks::{Known, Tank};

fn empty() -> SweptFloor {
    let tank = Tank { columns: Vec::new(), ..Known::E1.tank(0) };
    let workspace = Workspace::new(&tank.site(&[]), tank.anchor).unwrap();
    let domain = SlitDomain::new(&workspace, Vec::new()).unwrap();
    SweptFloor::new(ReachableFloor::new(&domain, 0.1))
}

/// Cells under the bar on its way along a path; some may appear several times.
fn runs(floor: &SweptFloor, path: &[Point]) -> Vec<Run> {
    let mut runs = Vec::new();
    floor.floor.raster.along(path, |cells| runs.push(Run::from(cells)));
    runs
}

fn path() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64).prop_map(|(x, y)| Point::new(x, y)), 2..6)
}

proptest! {
    #[test]
    fn a_straight_way_sweeps_what_lies_within_half_a_swath_beside_it(
        a in (-9.0..9.0_f64, -9.0..9.0_f64),
        b in (-9.0..9.0_f64, -9.0..9.0_f64),
    ) {
        let (a, b) = (Point::new(a.0, a.1), Point::new(b.0, b.1));
        prop_assume!((b - a).norm() > 0.01);
        let mut floor = empty();
        floor.sweep(&[a, b]);
        let ahead = (b - a).normalize();
        for cell in 0..floor.swept.len() {
            let offset = floor.floor.raster.center(cell) - a;
            let (along, beside) = (ahead.dot(&offset), ahead.perp(&offset).abs());
            let depth = along.min((b - a).norm() - along).min(floor.floor.raster.bar_m / 2.0 - beside);
            prop_assert!(depth.abs() < 1e-6 || (depth > 0.0) == (floor.swept[cell] % OUT_OF_REACH == 1));
        }
    }

    #[test]
    fn an_exchange_of_ways_is_counted_as_it_is_made_and_can_be_asked_for_first(
        ways in prop::collection::vec(path(), 1..4),
        new in path(),
    ) {
        let mut floor = empty();
        for way in &ways {
            floor.sweep(way);
        }
        let (old, new) = (runs(&floor, &ways[0]), runs(&floor, &new));
        let (before, coverage) = (floor.swept.clone(), floor.coverage());
        let asked = floor.lost_by(&old, &new);
        prop_assert!(floor.swept == before && floor.coverage().to_bits() == coverage.to_bits());
        prop_assert_eq!(floor.exchange(&old, &new), asked);
        let lost = (coverage - floor.coverage()) * floor.floor.n as f64;
        prop_assert!((lost - asked as f64).abs() < 1e-6);
        let count = floor.swept.iter().zip(floor.floor.cells.iter()).filter(|(n, r)| **n > 0 && **r).count();
        prop_assert_eq!(count, floor.n_swept);
        prop_assert!(!floor.loses_more([&old[..]], &new, i64::MAX - 1));
    }

    #[test]
    fn taking_back_what_was_not_swept_is_noticed(way in path()) {
        let mut floor = empty();
        let runs = runs(&floor, &way);
        let Exchanged { lost, is_sound } = floor.exchanged(&runs, &[]);
        prop_assert_eq!(floor.n_swept, 0);
        prop_assert_eq!(lost == 0, is_sound);
    }
}

proptest! {
    #[test]
    fn the_floor_within_some_polygons_is_what_lies_in_any_of_them(
        rings in prop::collection::vec(prop::collection::vec((-11.0..11.0_f64, -11.0..11.0_f64), 3..8), 1..4),
    ) {
        let rings: Vec<Vec<Point>> =
            rings.into_iter().map(|ring| ring.into_iter().map(|(x, y)| Point::new(x, y)).collect()).collect();
        let regions: Vec<&[Point]> = rings.iter().map(Vec::as_slice).collect();
        let whole = empty().floor;
        let within = whole.clone().within(&regions);
        // A polygon that contains no cell centre counts as the cell around its middle.
        let holds = |ring: &&[Point], cell: usize| whole.cells[cell] && world::shape::ring_contains(ring, whole.raster.center(cell));
        let cell_of = |ring: &&[Point]| {
            let is_empty = !(0..whole.cells.len()).any(|cell| holds(ring, cell));
            whole.raster.cell_at(world::shape::mean_of(ring)).filter(|cell| is_empty && whole.cells[*cell])
        };
        let tiny: Vec<usize> = regions.iter().filter_map(cell_of).collect();
        for cell in 0..whole.cells.len() {
            let at = whole.raster.center(cell);
            let is_meant = tiny.contains(&cell) || regions.iter().any(|ring| holds(ring, cell));
            prop_assert_eq!(within.cells[cell], is_meant, "{}", at);
        }
        prop_assert_eq!(within.n, within.cells.iter().filter(|meant| **meant).count());
    }
}
