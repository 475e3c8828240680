//! Saying no with a reason: where the way is blocked, and whether that is proved.

use crate::course::Course;
use field::Room;
use planner_api::PlannerError;
use world::Point;

/// Edge of a cell of the flood, metres.
const CELL_M: f64 = 0.05;
/// More cells than this are not flooded.
const MOST_CELLS: usize = 4_000_000;

/// The refusal of a course that is blocked at a point.
pub fn no_path(course: &Course, room: &Room, station: usize, partial: Vec<Point>) -> PlannerError {
    let at = course.points[station];
    let keep_m = room.keep().obstacle_m;
    let proof = match is_cut_off(course, room, station, &partial) {
        Some(true) => "proved: what lies behind cannot be reached from the start by any way",
        _ => "no way round was found beside the preset path",
    };
    PlannerError::no_path_but(
        format!(
            "blocked at station {station} of {}, ({:.2}, {:.2}), {:.1} m along the preset path: hull and clearance \
             need {keep_m:.2} m; {proof}",
            course.points.len(),
            at.x,
            at.y,
            course.stations_m[station],
        ),
        partial,
    )
}

/// Whether no point of the course behind a blocked one, by more than a metre and a half, can be reached from
/// the path before it: the floor is flooded in cells, and a cell counts as passable if any place in it could be.
///
/// `None` where the tank is too large to be flooded.
fn is_cut_off(course: &Course, room: &Room, station: usize, reached: &[Point]) -> Option<bool> {
    let (low, high) = room.wall().bounds();
    let (columns, rows) =
        (((high.x - low.x) / CELL_M).ceil() as usize, ((high.y - low.y) / CELL_M).ceil() as usize);
    if columns.saturating_mul(rows) > MOST_CELLS {
        return None;
    }
    let center = |x: usize, y: usize| low + world::Vector::new(x as f64 + 0.5, y as f64 + 0.5) * CELL_M;
    let half_diagonal_m = CELL_M * std::f64::consts::FRAC_1_SQRT_2;
    let cell_of = |p: Point| {
        let x = ((p.x - low.x) / CELL_M).clamp(0.0, columns as f64 - 1.0) as usize;
        let y = ((p.y - low.y) / CELL_M).clamp(0.0, rows as f64 - 1.0) as usize;
        y * columns + x
    };
    let passable = |cell: usize| room.spare_m(center(cell % columns, cell / columns)) >= -half_diagonal_m;
    let mut seen = vec![false; columns * rows];
    let before = reached.iter().map(|p| cell_of(*p)).filter(|cell| passable(*cell));
    let mut open: Vec<usize> = before.collect();
    for cell in &open {
        seen[*cell] = true;
    }
    while let Some(cell) = open.pop() {
        let (x, y) = (cell % columns, cell / columns);
        for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
            let (Some(x), Some(y)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else { continue };
            if x < columns && y < rows && !seen[y * columns + x] && passable(y * columns + x) {
                seen[y * columns + x] = true;
                open.push(y * columns + x);
            }
        }
    }
    let behind_m = course.stations_m[station] + 1.5;
    let behind = course.points.iter().zip(&course.stations_m).filter(|(_, s)| **s > behind_m);
    let mut free = behind.filter(|(p, _)| room.spare_m(**p) >= 0.0).map(|(p, _)| cell_of(*p));
    Some(!free.any(|cell| seen[cell]))
}
