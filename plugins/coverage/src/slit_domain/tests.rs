use crate::cuts::domain_between_walls;
use crate::workspace::Workspace;
use proptest::prelude::*;
use trials::tanks::Tank;
use world::{Boundary, Point, polyline};

/// A room with an inward corner and a column before it: cuts begin at corners around which paths bend.
fn room() -> Tank {
    let corners = [(0.0, 0.0), (9.0, 0.0), (9.0, 4.0), (4.0, 4.0), (4.0, 9.0), (0.0, 9.0)];
    let vertices = corners.map(|(x, y)| Point::new(x, y)).to_vec();
    let columns = [(7.87, 3.16, 0.37), (2.74, 4.94, 0.37), (4.54, 3.13, 0.14)];
    Tank {
        boundary: Boundary::Polygon { vertices },
        columns: columns.map(|(x, y, radius_m)| (Point::new(x, y), radius_m)).to_vec(),
        anchor: Point::new(0.8, 0.8),
    }
}

proptest! {
    #[test]
    fn a_way_goes_on_from_each_of_its_bends_as_it_would_have_gone(
        ends in prop::array::uniform2((0.35..8.65_f64, 0.35..8.65_f64)),
    ) {
        let tank = room();
        let obstacles = tank.obstacles();
        let workspace = Workspace::new(&tank.site(&obstacles), tank.anchor).unwrap();
        let domain = domain_between_walls(&workspace).unwrap();
        let [a, b] = ends.map(|(x, y)| Point::new(x, y));
        if let Some(way) = domain.path(a, b) {
            let whole_m = polyline::length_m(&way);
            for bend in &way[1..way.len() - 1] {
                let length_m = |from: Point, to: Point| domain.path(from, to).map(|way| polyline::length_m(&way));
                let (Some(there_m), Some(on_m)) = (length_m(a, *bend), length_m(*bend, b)) else {
                    return Err(TestCaseError::fail(format!("{bend} lies outside")));
                };
                prop_assert!((there_m + on_m - whole_m).abs() < 1e-4, "{there_m} + {on_m} m, but {whole_m} m at {bend}");
            }
        }
    }
}
