#![allow(clippy::unwrap_used, reason = "tests")]

use super::{adviser::advise, *};
use crate::{
    Aggregation, Nls, PositionSolver,
    draws::{Draws, paper_stations, ring, stations},
};
use world::{Boundary, Obstacle, ObstacleId, Shape};

const FORECAST: Forecast = Forecast {
    noise: RangeNoise::Uniform { ratio: 0.05 },
    timing: Timing { jitter_m: 0.0, resolution_m: 0.0 },
    repetitions: 20,
    needs_line_of_sight: true,
    is_emission_unknown: false,
    cell_m: 0.5,
};

fn tank(stations: Vec<Station>, columns: &[(f64, f64, f64)]) -> World {
    let column = |(id, (x, y, radius_m)): (u32, &(f64, f64, f64))| Obstacle {
        id: ObstacleId(id),
        name: String::new(),
        shape: Shape::Disc { center: Point::new(*x, *y), radius_m: *radius_m },
        known: true,
    };
    World {
        boundary: Boundary::Circle { radius_m: 10.0 },
        obstacles: (1..).zip(columns).map(column).collect(),
        stations,
        zones: vec![],
    }
}

#[test]
fn the_forecast_is_the_scatter_of_real_fixes() {
    let (stations, mut draws) = (paper_stations(), Draws::new(0.05, 20, 3));
    let world = tank(stations.clone(), &[]);
    let map = ObstacleMap::new(&world.boundary, &[]);
    for place in [Point::new(0.0, 0.0), Point::new(5.0, -6.0), Point::new(-3.0, 4.0)] {
        let forecast = FORECAST.at(place, &stations, &map).error_95_m.unwrap();
        let mut covariance = Matrix2::zeros();
        for _ in 0..4_000 {
            let ranges = draws.rangings(&stations, place, Aggregation::Mean);
            let off = Nls.solve(&ranges, &stations, None).unwrap().position - place;
            covariance += off * off.transpose() / 4_000.0;
        }
        let real = ellipse_95(&covariance).0;
        assert!((forecast / real - 1.0).abs() < 0.05, "{place}: {forecast} for {real}");
    }
}

#[test]
fn a_column_casts_a_shadow_where_two_stations_are_left() {
    let world = tank(paper_stations(), &[(5.0, 0.0, 0.5)]);
    let accuracy = AccuracyMap::new(&world, &FORECAST);
    let (behind, beside) = (Point::new(2.0, 0.0), Point::new(2.0, 4.0));
    assert_eq!(
        accuracy.at(behind).unwrap(),
        Accuracy { error_95_m: None, gdop: None, heard: 2, mirror: None, checks: None }
    );
    assert_eq!(accuracy.at(beside).unwrap().heard, 3);
    assert_eq!(accuracy.at(Point::new(5.0, 0.0)), None, "a column is not floor");
    let through = AccuracyMap::new(&world, &Forecast { needs_line_of_sight: false, ..FORECAST });
    assert_eq!(through.at(behind).unwrap().heard, 3);
}

#[test]
fn what_is_beyond_the_limit_is_listed_worst_first() {
    let accuracy = AccuracyMap::new(&tank(paper_stations(), &[]), &FORECAST);
    let all: Vec<f64> = accuracy.floor().filter_map(|(_, cell)| cell.error_95_m).collect();
    let limit_m = all.iter().copied().fold(0.0, f64::max) * 0.8;
    let beyond = accuracy.beyond(limit_m);
    assert_eq!(beyond.len(), all.iter().filter(|e| **e > limit_m).count());
    assert!(!beyond.is_empty() && beyond.len() < all.len() / 2);
    assert!(beyond.windows(2).all(|pair| pair[0].1.error_95_m >= pair[1].1.error_95_m));
}

#[test]
fn places_outside_and_nonsense_have_no_forecast() {
    let accuracy = AccuracyMap::new(&tank(paper_stations(), &[]), &FORECAST);
    for place in [Point::new(9.9, 9.9), Point::new(-30.0, 0.0), Point::new(f64::NAN, 0.0)] {
        assert_eq!(accuracy.at(place), None, "{place}");
    }
    let tiny = AccuracyMap::new(&tank(vec![], &[]), &Forecast { cell_m: f64::NAN, ..FORECAST });
    assert!(tiny.cells.len() <= (MOST_CELLS + 1).pow(2));
    assert!(tiny.floor().all(|(_, cell)| cell.error_95_m.is_none()));
}

#[test]
fn advice_beats_an_even_ring_among_columns() {
    let columns = [(4.0, 3.0, 0.6), (-4.0, 3.0, 0.6), (0.0, -5.0, 0.6), (6.0, -3.0, 0.6), (-1.0, 6.0, 0.6)];
    let world = tank(vec![], &columns);
    let advice = advise(&world, 4, &FORECAST).unwrap();
    assert_eq!(advice.places.len(), 4);
    assert!(advice.places.iter().all(|p| (p.coords.norm() - 10.0).abs() < 1e-6), "on the wall");
    let even = AccuracyMap::new(&tank(ring(4, 10.0), &columns), &FORECAST);
    let places: Vec<(f64, f64)> = advice.places.iter().map(|p| (p.x, p.y)).collect();
    let advised = AccuracyMap::new(&tank(stations(&places), &columns), &FORECAST);
    let blind = |map: &AccuracyMap| map.beyond(0.4).len();
    assert!(blind(&advised) < blind(&even), "{} {}", blind(&advised), blind(&even));
}

#[test]
fn without_columns_the_advice_is_an_even_ring() {
    let advice = advise(&tank(vec![], &[]), 3, &FORECAST).unwrap();
    let even = AccuracyMap::new(&tank(ring(3, 10.0), &[]), &FORECAST);
    let errors: Vec<f64> = even.floor().filter_map(|(_, cell)| cell.error_95_m).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(advice.mean_error_95_m < 1.03 * mean, "{} {mean}", advice.mean_error_95_m);
}

#[test]
fn advice_for_too_few_or_too_many_stations_is_refused() {
    for n in [0, 2, 33] {
        assert!(advise(&tank(vec![], &[]), n, &FORECAST).is_err());
    }
}
