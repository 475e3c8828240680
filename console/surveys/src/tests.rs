#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use proptest::prelude::*;
use world::{Boundary, PlateLayout, RegularPlates};

fn column(name: &str, x: f64, y: f64) -> Column {
    Column { name: name.into(), at: Point::new(x, y), size_m: 0.3 }
}

fn tank() -> Tank {
    let columns = vec![column("N", 0.3, 2.0), column("E", 1.9, -0.6), column("W", -2.0, -0.4)];
    Tank { boundary: Boundary::Circle { radius_m: 4.0 }, columns, plates: None }
}

fn pit(number: usize, x: f64, y: f64, depth_mm: f64) -> Indication {
    let covariance = Matrix2::identity() * 0.02_f64.powi(2);
    Indication {
        number,
        plate: Some("P".into()),
        at: Point::new(x, y),
        low: Point::new(x, y),
        high: Point::new(x, y),
        covariance,
        depth_mm,
        depth_sigma_mm: 0.2,
        is_cut: false,
    }
}

fn survey(indications: Vec<Indication>) -> Survey {
    Survey { tank: tank(), thickness_mm: 8.0, threshold_mm: 1.6, tested_m2: 45.0, indications }
}

fn everywhere(_: Point) -> bool {
    true
}

fn compared(first: &Survey, second: &Survey) -> Comparison {
    compare([first, second], 4.0, [&everywhere, &everywhere]).unwrap()
}

#[test]
fn a_pit_that_grew_has_its_rate_and_new_and_gone_ones_are_named() {
    let first = survey(vec![pit(1, 0.0, 0.0, 2.0), pit(2, 1.0, 1.0, 3.0)]);
    let second = survey(vec![pit(1, 0.02, -0.01, 3.0), pit(2, -1.0, 1.0, 2.0)]);
    let found = compared(&first, &second);
    let [(pair, growth)] = &found.matched[..] else { panic!("{found:?}") };
    assert_eq!((pair.first, pair.second, pair.rivals), (0, 0, 0));
    assert!((growth.rate_mm_per_a - 0.25).abs() < 1e-9);
    let half_mm = 1.96 * 0.08_f64.sqrt();
    assert!((growth.interval_mm[1] - 1.0 - half_mm).abs() < 1e-9, "{growth:?}");
    assert_eq!(found.new, [Unmatched { index: 1, is_tested: true, part_of: None }]);
    assert_eq!(found.gone, [Unmatched { index: 1, is_tested: true, part_of: None }]);
    let [plate] = &found.plates[..] else { panic!("{found:?}") };
    assert_eq!((plate.matched, plate.new, plate.gone), (1, 1, 1));
    assert_eq!(plate.mean.unwrap().mm.to_bits(), plate.greatest.unwrap().mm.to_bits());
}

#[test]
fn the_best_assignment_is_not_the_nearest_neighbour() {
    // The second pit of the first survey is nearest to the only partner of the first one.
    let first = survey(vec![pit(1, 0.0, 0.0, 2.0), pit(2, 0.08, 0.0, 2.0)]);
    let second = survey(vec![pit(1, 0.05, 0.0, 2.0), pit(2, 0.13, 0.0, 2.0)]);
    let found = compared(&first, &second);
    let pairs: Vec<_> =
        found.matched.iter().map(|(pair, _)| (pair.first, pair.second, pair.rivals)).collect();
    assert_eq!(pairs, [(0, 0, 1), (1, 1, 1)]);
}

/// A pit with an extent of a half width, metres.
fn wide(half_m: f64, pit: Indication) -> Indication {
    let half = world::Vector::repeat(half_m);
    Indication { low: pit.at - half, high: pit.at + half, ..pit }
}

#[test]
fn the_pieces_of_a_larger_indication_are_not_new_and_a_pit_beside_it_is() {
    let first = survey(vec![wide(0.3, pit(1, 0.0, 0.0, 2.0))]);
    let pieces = [(0.0, 0.01), (0.25, 0.1), (-0.2, -0.25), (0.6, 0.0)];
    let piece = |(k, (x, y)): (usize, &(f64, f64))| wide(0.02, pit(k, *x, *y, 2.4));
    let second = survey(pieces.iter().enumerate().map(piece).collect());
    let found = compared(&first, &second);
    assert_eq!(found.matched.len(), 1);
    let whole: Vec<_> = found.new.iter().map(|one| (one.index, one.part_of)).collect();
    assert_eq!(whole, [(1, Some(0)), (2, Some(0)), (3, None)]);
    assert_eq!(found.plates.iter().map(|plate| plate.new).sum::<usize>(), 1);
    // The other way round, pits that grew together are not gone.
    let merged = compared(&second, &survey(vec![wide(0.3, pit(1, 0.0, 0.0, 2.8))]));
    let whole: Vec<_> = merged.gone.iter().map(|one| (one.index, one.part_of)).collect();
    assert_eq!(whole, [(1, Some(0)), (2, Some(0)), (3, None)]);
    // Two pits that grew together have another middle, too far from either of them to match by place.
    let apart = survey(vec![wide(0.03, pit(1, -0.25, 0.0, 2.0)), wide(0.03, pit(2, 0.25, 0.0, 3.0))]);
    let joined = compared(&apart, &survey(vec![wide(0.3, pit(1, 0.0, 0.0, 3.4))]));
    let [(pair, growth)] = &joined.matched[..] else { panic!("{joined:?}") };
    assert_eq!((pair.first, pair.second), (1, 0), "the deepest part is the partner");
    assert!((growth.mm - 0.4).abs() < 1e-9 && joined.new.is_empty());
    assert_eq!(joined.gone, [Unmatched { index: 0, is_tested: true, part_of: Some(0) }]);
    // A larger indication is not a part of a smaller one.
    let grown = compared(
        &survey(vec![wide(0.02, pit(1, 0.0, 0.0, 6.0))]),
        &survey(vec![wide(0.3, pit(1, 0.0, 0.0, 2.0))]),
    );
    assert_eq!((grown.new[0].part_of, grown.gone[0].part_of), (None, Some(0)));
}

#[test]
fn metal_does_not_grow_back() {
    let found = compared(&survey(vec![pit(1, 0.0, 0.0, 5.0)]), &survey(vec![pit(1, 0.0, 0.0, 2.0)]));
    assert_eq!((found.matched.len(), found.new.len(), found.gone.len()), (0, 1, 1));
}

proptest! {
    #[test]
    fn the_order_of_the_indications_does_not_matter(
        places in proptest::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, 1.6..6.0_f64, -0.05..0.05_f64), 1..30),
        turn in 0..30_usize,
    ) {
        let one = |(k, (x, y, depth_mm, _)): (usize, &(f64, f64, f64, f64))| pit(k, *x, *y, *depth_mm);
        let other = |(k, (x, y, depth_mm, off)): (usize, &(f64, f64, f64, f64))| pit(k, x + off, y - off, depth_mm + 0.3);
        let first = survey(places.iter().enumerate().map(one).collect());
        let second = survey(places.iter().enumerate().map(other).collect());
        let (mut first_again, mut second_again) = (first.clone(), second.clone());
        first_again.indications.reverse();
        second_again.indications.rotate_left(turn % places.len());
        let numbers = |a: &Survey, b: &Survey| {
            let found = compared(a, b);
            let mut all: Vec<_> = found
                .matched
                .iter()
                .map(|(pair, _)| (a.indications[pair.first].number, b.indications[pair.second].number))
                .collect();
            all.sort_unstable();
            all
        };
        prop_assert_eq!(numbers(&first, &second), numbers(&first_again, &second_again));
    }

    #[test]
    fn a_turned_frame_is_found_from_the_columns(turn_rad in -3.1..3.1_f64) {
        let turn = nalgebra::Rotation2::new(-turn_rad);
        let mut second = tank();
        for column in &mut second.columns {
            column.at = turn * column.at;
        }
        let found = Registration::of(&tank(), &second).unwrap();
        let place = Point::new(1.0, -2.0);
        prop_assert!((found.apply(turn * place) - place).norm() < 1e-6 + found.residuals[1].max_m, "{:?}", found);
        prop_assert!((found.back(found.apply(place)) - place).norm() < 1e-9);
    }
}

#[test]
fn tanks_that_differ_are_refused_with_the_reason() {
    let why = |second: &Tank| Registration::of(&tank(), second).unwrap_err().to_string();
    let bigger = Tank { boundary: Boundary::Circle { radius_m: 4.5 }, ..tank() };
    assert!(
        why(&bigger).contains(
            "a circle with a radius of 4 m in the first survey and a circle with a radius of 4.5 m"
        )
    );
    let fewer = Tank { columns: tank().columns[1..].to_vec(), ..tank() };
    assert!(why(&fewer).contains("3 columns in the first survey and 2 in the second one"));
    let mut moved = tank();
    moved.columns[1].at.x += 0.5;
    assert!(why(&moved).contains("E of the first survey has no counterpart within 0.1 m"), "{}", why(&moved));
    let square = Tank { boundary: Boundary::Polygon { vertices: vec![Point::origin(); 4] }, ..tank() };
    assert!(why(&square).contains("a polygon with 4 corners"));
    let layout = |length_m| {
        PlateLayout::Regular(RegularPlates { annular_m: 0.6, n_annular: 12, length_m, width_m: 1.5 })
    };
    let with = |length_m| Tank { plates: Some(layout(length_m)), ..tank() };
    let refused = Registration::of(&with(4.0), &with(6.0)).unwrap_err().to_string();
    assert!(
        refused.contains("plate length is 4 m in the first survey and 6 m in the second one"),
        "{refused}"
    );
    assert!(Registration::of(&with(4.0), &with(4.0)).unwrap().is_turn_fixed);
}

#[test]
fn columns_that_fit_in_two_ways_are_refused_unless_the_frames_are_the_same() {
    let ring = |from_deg: f64| {
        let at = |k: u32| (from_deg + 90.0 * f64::from(k)).to_radians();
        let columns = (0..4).map(|k| column("C", 2.0 * at(k).cos(), 2.0 * at(k).sin())).collect();
        Tank { columns, ..tank() }
    };
    assert!(Registration::of(&ring(0.0), &ring(0.0)).unwrap().turn_rad.abs() < 1e-9);
    let refused = Registration::of(&ring(0.0), &ring(30.0)).unwrap_err();
    assert!(matches!(refused, Refusal::Ambiguous { .. }), "{refused}");
}

#[test]
fn a_loss_that_is_cut_by_untested_floor_has_no_rate_and_counts_with_its_whole_depth() {
    let cut = |depth_mm| Indication { is_cut: true, ..pit(1, 0.0, 0.0, depth_mm) };
    let second = survey(vec![pit(1, 0.0, 0.0, 6.0)]);
    let found = compared(&survey(vec![cut(2.0)]), &second);
    let [plate] = &found.plates[..] else { panic!("{found:?}") };
    assert_eq!((plate.matched, plate.mean, plate.greatest), (1, None, None));
    let outlook = Outlook::of(&found, &second, 1.0).unwrap();
    assert_eq!(outlook.basis, Basis::WholeDepth);
    assert!((outlook.rate_mm_per_a - (6.0 + 1.96 * 0.2) / 4.0).abs() < 1e-9);
}

#[test]
fn dates_and_thicknesses_that_do_not_fit_are_refused() {
    let one = survey(vec![]);
    for years in [0.0, -1.0, f64::NAN] {
        assert_eq!(compare([&one, &one], years, [&everywhere, &everywhere]), Err(Refusal::NotLater));
    }
    let thicker = Survey { thickness_mm: 9.0, ..one.clone() };
    let refused = compare([&one, &thicker], 3.0, [&everywhere, &everywhere]).unwrap_err();
    assert!(refused.to_string().contains("8 mm in the first survey and 9 mm in the second one"));
}

#[test]
fn the_outlook_follows_its_formula_and_is_zero_where_the_least_thickness_is_reached() {
    let first = survey(vec![pit(1, 0.0, 0.0, 2.0)]);
    let second = survey(vec![pit(1, 0.0, 0.0, 3.0)]);
    let found = compared(&first, &second);
    let outlook = Outlook::of(&found, &second, 2.5).unwrap();
    let rate = (1.0 + 1.96 * 0.08_f64.sqrt()) / 4.0;
    assert!((outlook.years - (8.0 - 3.0 - 1.96 * 0.2 - 2.5) / rate).abs() < 1e-9, "{outlook:?}");
    assert_eq!(outlook.basis, Basis::Matched);
    let reached = Outlook::of(&found, &second, 6.0).unwrap();
    assert!(reached.years.abs() < 1e-12 && (outlook.reached, reached.reached) == (0, 1));
    // Without an earlier indication, the whole depth may have grown since the first survey.
    let fresh = compared(&survey(vec![]), &second);
    let outlook = Outlook::of(&fresh, &second, 2.5).unwrap();
    assert_eq!(outlook.basis, Basis::WholeDepth);
    assert!((outlook.rate_mm_per_a - (3.0 + 1.96 * 0.2) / 4.0).abs() < 1e-9);
    // A loss that shrank beyond its error reaches nothing.
    let slow = compared(&survey(vec![pit(1, 0.0, 0.0, 3.9)]), &second);
    assert_eq!(Outlook::of(&slow, &second, 2.5), None);
}

#[test]
fn of_several_losses_at_the_least_thickness_the_deepest_one_governs() {
    let second = survey(vec![pit(1, 0.0, 0.0, 4.0), pit(2, 3.0, 0.0, 7.0), pit(3, 0.0, 3.0, 5.0)]);
    let found = compared(&survey(vec![pit(1, 0.0, 0.0, 3.0)]), &second);
    let outlook = Outlook::of(&found, &second, 4.0).unwrap();
    assert_eq!((outlook.second, outlook.reached, outlook.years), (1, 3, 0.0));
}
