//! Refuses a plan with a reason: where the course is blocked, and which ring of obstacles blocks it, if that is proved.

use crate::{
    course::Course,
    ring::{self, Ring},
};
use planner_api::{PlannerError, Site};
use steering::Room;
use world::Point;

/// Creates the refusal for a course that is blocked at a point.
pub(crate) fn no_path(
    course: &Course,
    (site, room): (&Site<'_>, &Room),
    station: usize,
    partial: Vec<Point>,
) -> PlannerError {
    let (blocked, ring) = match cut_off(course, (site, room), station, &partial) {
        Some((first, ring)) => (first, Some(ring)),
        None => (station, None),
    };
    let at = course.points[blocked];
    let keep_m = room.keep().obstacle_m;
    let proof = ring.map_or_else(|| "no way round was found".to_owned(), |ring| proof_by(&ring));
    PlannerError::no_path_but(
        format!(
            "blocked at point {blocked} of {}, ({:.2}, {:.2}), {:.1} m along the preset path: hull and \
             clearance need {keep_m:.2} m; {proof}",
            course.points.len(),
            at.x,
            at.y,
            course.stations_m[blocked],
        ),
        partial,
    )
}

fn proof_by(ring: &Ring) -> String {
    let ids: Vec<String> = ring.obstacles.iter().map(u32::to_string).collect();
    let wall = if ring.has_wall { " and the wall" } else { "" };
    format!("proved: a ring of obstacles {}{wall} closes off that point", ids.join(", "))
}

/// If the end of the course cannot be reached, returns the first free point at or after the blocked one that cannot be
/// reached either, and the ring around that point.
fn cut_off(
    course: &Course,
    (site, room): (&Site<'_>, &Room),
    station: usize,
    reached: &[Point],
) -> Option<(usize, Ring)> {
    let is_free = |index: &usize| room.spare_m(course.points[*index]) >= 0.0;
    let from = *reached.iter().rev().find(|place| room.spare_m(**place) >= 0.0)?;
    let apart = |index: usize| ring::between(site, room.keep(), from, course.points[index]);
    let end = (station..course.points.len()).rev().find(is_free)?;
    let of_end = apart(end)?;
    let first = (station..end).filter(is_free).find_map(|index| Some((index, apart(index)?)));
    Some(first.unwrap_or((end, of_end)))
}
