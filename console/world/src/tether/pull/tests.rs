use super::*;
use crate::{
    polyline,
    tank::{Obstacle, ObstacleId},
    tether::{Case, Limits, certify},
};
use geometry::{Boundary, Shape};
use proptest::prelude::*;

const WALL: Boundary = Boundary::Circle { radius_m: 10.0 };
const DRAG: Drag = Drag { floor_n_per_m: 0.3, friction: 0.3 };

fn reel(pull_n: f64) -> Reel {
    Reel {
        mass_kg_per_m: 0.1,
        floor_friction: 0.3,
        pull_n,
        pay_out_n: 0.5,
        robot_pull_n: Some(50.0),
        pull_ratio_max: 0.8,
    }
}

fn disc(x: f64, y: f64, radius_m: f64) -> Shape {
    Shape::Disc { center: Point::new(x, y), radius_m }
}

fn dragged(shapes: &[Shape], path: &[(f64, f64)]) -> Cable {
    let mut cable = Cable::new(Point::origin(), &WALL, shapes).unwrap();
    for (x, y) in path {
        cable.drag_to(Point::new(*x, *y));
    }
    cable
}

/// The pull at the anchor, summed over short links of the drawn cable, each with its own friction and turn.
fn summed_n(line: &[Point], drag: Drag) -> f64 {
    let line = polyline::resampled(line, 0.001);
    let turns: Vec<f64> = line
        .windows(3)
        .map(|three| (three[1] - three[0]).angle(&(three[2] - three[1])))
        .chain([0.0])
        .collect();
    line.windows(2).zip(turns).rev().fold(0.0, |pull_n, (pair, turn_rad)| {
        pull_n * (drag.friction * turn_rad).exp() + drag.floor_n_per_m * (pair[1] - pair[0]).norm()
    })
}

#[test]
fn the_pull_is_that_of_many_short_links() {
    type Way<'a> = (&'a [Shape], &'a [(f64, f64)]);
    let shapes = [disc(4.0, 0.0, 0.5), disc(6.0, 3.0, 1.0)];
    let square = Shape::Polygon {
        vertices: [(-4.0, -1.0), (-3.0, -1.0), (-3.0, 1.0), (-4.0, 1.0)]
            .map(|(x, y)| Point::new(x, y))
            .to_vec(),
    };
    let ways: [Way<'_>; 3] = [
        (&shapes, &[(4.0, 2.0), (8.0, 0.0)]),
        (&shapes, &[(4.0, 2.0), (6.0, 0.0), (4.0, -2.0), (2.0, 1.0), (4.0, 2.0), (7.5, 0.5), (8.0, 4.5)]),
        (&[square], &[(-3.5, 2.0), (-5.0, 0.0), (-3.5, -2.0)]),
    ];
    for (shapes, way) in ways {
        let cable = dragged(shapes, way);
        let (exact_n, summed_n) = (cable.pull_at_anchor_n(DRAG), summed_n(&cable.taut_line(), DRAG));
        assert!(!cable.is_straight() && exact_n > DRAG.floor_n_per_m * cable.length_m());
        // The drawn line has chords of 0.1 rad in place of arcs.
        assert!((exact_n / summed_n - 1.0).abs() < 0.005, "{exact_n} N, summed {summed_n} N");
    }
}

#[test]
fn a_weightless_cable_follows_the_capstan_equation_and_one_without_friction_needs_no_pull() {
    let cable = dragged(&[disc(4.0, 0.0, 0.5)], &[(4.0, 2.0), (8.0, 0.0)]);
    let light = Drag { floor_n_per_m: 0.0, friction: 0.3 };
    assert_eq!(cable.pull_at_anchor_n(light), 0.0);
    let factor = crate::tether::capstan_factor(0.3, cable.wrap_total_rad());
    assert!((cable.pull_at_robot_n(light, 2.0) - 2.0 * factor).abs() < 1e-9);
    let smooth = Drag { friction: 0.0, ..DRAG };
    assert!((cable.pull_at_anchor_n(smooth) - 0.3 * cable.length_m()).abs() < 1e-9);
}

#[test]
fn an_absurd_cable_needs_a_finite_pull() {
    let way: Vec<(f64, f64)> = (0..400)
        .map(|k| {
            let (sin, cos) = (0.3 * f64::from(k)).sin_cos();
            (4.0 + 2.0 * cos, 2.0 * sin)
        })
        .collect();
    let cable = dragged(&[disc(4.0, 0.0, 0.5)], &way);
    assert!(cable.wrap_total_rad() > 100.0);
    for drag in [DRAG, Drag { floor_n_per_m: 0.0, friction: 2.0 }, Drag { floor_n_per_m: 1e9, friction: 1e9 }]
    {
        let pulls = [
            cable.pull_at_anchor_n(drag),
            cable.pull_at_robot_n(drag, 0.0),
            cable.pull_at_robot_n(drag, 9.0),
        ];
        assert!(pulls.iter().all(|pull_n| (0.0..=MOST_N).contains(pull_n)), "{drag:?}: {pulls:?}");
    }
}

fn certified(pull_n: f64, robot_pull_n: Option<f64>) -> crate::tether::Certificate {
    let path = [(0.0, 0.0), (4.0, 2.0), (8.0, 0.0), (4.0, 2.0), (0.0, 0.0)].map(|(x, y)| Point::new(x, y));
    let (shape, name) = (disc(4.0, 0.0, 0.5), "C1".to_owned());
    let obstacles = [Obstacle { id: ObstacleId(1), name, shape, known: true }];
    let limits = Limits { reel_length_m: 20.0, wrap_max_rad: 3.0, wrap_total_max_rad: 3.0 };
    let case = Case {
        path: &path,
        anchor: Point::origin(),
        cable: None,
        boundary: &WALL,
        obstacles: &obstacles,
        room_m: 0.3,
        limits,
        pull: Some(Reel { robot_pull_n, ..reel(pull_n) }.limits(0.3)),
        returns: true,
        cuts: &[],
    };
    certify(&case).unwrap()
}

#[test]
fn a_path_is_certified_by_the_ratio_of_pull_and_reel() {
    let needed_n = certified(9.0, None).pull.unwrap().needed_n;
    let exact_n =
        dragged(&[disc(4.0, 0.0, 0.5)], &[(4.0, 2.0), (8.0, 0.0)]).pull_at_anchor_n(reel(9.0).drag(0.3));
    assert_eq!(needed_n, exact_n);
    let strong = certified(needed_n / 0.79, None);
    assert!(strong.certified && strong.warnings.is_empty(), "{strong:?}");
    assert_eq!(strong.pull.unwrap().at, Point::new(8.0, 0.0));
    let fair = certified(needed_n / 0.9, None);
    assert!(fair.certified && fair.warnings.len() == 1 && fair.warnings[0].contains("0.90"), "{fair:?}");
    let weak = certified(needed_n / 1.01, None);
    assert!(!weak.certified && weak.reasons[0].contains("stronger reel"), "{weak:?}");
    let tired = certified(9.0, Some(1.0));
    assert!(!tired.certified && tired.reasons[0].contains("can pull 1.0 N"), "{tired:?}");
    for pull_n in [f64::NAN, 0.0] {
        assert!(!certified(pull_n, None).certified);
    }
}

proptest! {
    /// Along a straight move, the pull is largest at an end.
    #[test]
    fn no_place_on_a_path_needs_more_pull_than_its_points(
        centers in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..5),
        goals in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..6),
        friction in 0.0..1.0_f64,
    ) {
        let shapes: Vec<Shape> = centers
            .iter()
            .filter(|(x, y)| x.hypot(*y) > 1.0)
            .map(|(x, y)| disc(*x, *y, 0.4))
            .collect();
        let drag = Drag { friction, ..DRAG };
        let mut cable = Cable::new(Point::origin(), &WALL, &shapes).unwrap();
        for (x, y) in goals {
            let (from, goal) = (cable.tip(), Point::new(x, y));
            let is_clear = |share: f64| shapes.iter().all(|shape| shape.distance_m(from + (goal - from) * share) > 0.0);
            if !(0..=400).all(|k| is_clear(f64::from(k) / 400.0)) {
                continue;
            }
            let before_n = cable.pull_at_anchor_n(drag);
            let mut between = cable.clone();
            cable.drag_to(goal);
            let ends_n = before_n.max(cable.pull_at_anchor_n(drag));
            for k in 1..100 {
                between.drag_to(from + (goal - from) * (f64::from(k) / 100.0));
                prop_assert!(between.pull_at_anchor_n(drag) <= ends_n * (1.0 + 1e-6) + 1e-6);
            }
        }
    }
}
