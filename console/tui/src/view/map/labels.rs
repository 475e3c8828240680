//! The letters on the map: names, marks, numbers of lanes. If two labels would overlap, the less important one is
//! moved or left out.

use super::course::{self, Track};
use super::ink::{self, Ink};
use super::shapes::Window;
use super::survey;
use super::thin::{Thin, Thinning};
use crate::caps::Glyphs;
use crate::model::{Overlay, Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use crate::view::{missed, stations, text};
use account::{Area, Estimate, MissReason};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use world::{Obstacle, Point, Vector, polyline};

/// The maximum number of missed areas that are numbered on the map: first when the whole tank is shown, then when only
/// a part of it is.
const MISSED: (usize, usize) = (9, 99);
/// The longest name that is written on the map, columns.
const NAME: usize = 4;
/// The minimum length of a lane that gets an arrow, columns.
const LANE_COLUMNS: f64 = 8.0;
/// The distance between the arrows of a path without lanes, columns.
const ARROW_COLUMNS: f64 = 30.0;

/// The missed areas that are numbered on the map.
pub(super) fn numbered<'a>(look: &Look<'a>) -> Vec<&'a Area<MissReason>> {
    let ui = &look.model.ui;
    let most = match ui.map.zoom {
        _ if ui.screen != Screen::Result => 0,
        0 => MISSED.0,
        _ => MISSED.1,
    };
    look.model.live.missed().into_iter().take(most).collect()
}

/// The mark of the place at which a re-scan resumes.
pub(super) const RESUMES: &str = "R";

/// The mark of a point that is set of a zone being drawn.
pub(super) const CORNER: &str = "■";
/// The mark of the largest wrap of the tether.
pub(super) const WOUND: &str = "w";
/// The mark behind the name of a station that the last fix did not use.
pub(super) const UNUSED: &str = "!";
/// The smallest wrap that is marked, degrees.
const WOUND_DEG: f64 = 1.0;

/// The labels of a map that is drawn in `area` of `buffer`.
struct Board<'a, 'b> {
    look: Look<'a>,
    window: Window,
    area: Rect,
    buffer: &'b mut Buffer,
    /// The columns that labels occupy: row, first column, column after the last one.
    taken: Vec<(u16, u16, u16)>,
}

/// Writes the labels, the most important first.
pub(super) fn draw(look: &Look, window: Window, area: Rect, buffer: &mut Buffer) {
    let mut board = Board { look: *look, window, area, buffer, taken: Vec::new() };
    board.robots();
    board.solids();
    board.places();
    board.change_over();
    board.wound();
    board.stations();
    board.missed();
    board.frontiers();
    board.targets();
    board.lanes();
}

impl Board<'_, '_> {
    /// The cursor and the robots, which no other label covers.
    fn robots(&mut self) {
        let look = self.look;
        if let Some(cursor) = look.model.ui.cursor {
            self.always(cursor, Role::Selected, "┼");
        }
        if let Overlay::ZoneDraft(draft) = &look.model.ui.overlay {
            draft.points.iter().for_each(|point| self.always(*point, Role::NoGo, CORNER));
        }
        let Some(about) = &look.run.about else { return };
        let position = &look.run.position;
        let estimated = position.pose.as_ref().map(|pose| (pose.position, pose.heading_rad));
        let (at, heading_rad) =
            estimated.unwrap_or((about.mission.start.position, about.mission.start.heading_rad));
        self.halo(at);
        let role = if position.lost { Role::Crit } else { Role::Robot };
        self.always(at, role, robot(look.caps.glyphs, heading_rad));
        let other = look.model.live.replay.as_ref().and_then(|replay| replay.other.as_ref());
        if let Some(pose) = other.and_then(|other| other.run.position.pose.as_ref()) {
            self.always(pose.position, Role::Ghost, "B");
        }
    }

    /// Clears the lines beside the robot, so that its mark stands out.
    fn halo(&mut self, at: Point) {
        let Some((column, row)) = self.window.cell_of(at) else { return };
        for column in [column.checked_sub(1), column.checked_add(1)].into_iter().flatten() {
            if column < self.area.width {
                self.buffer[(self.area.x + column, self.area.y + row)].reset();
            }
        }
    }

    fn solids(&mut self) {
        let look = self.look;
        let columns = survey::shown(&look).map_or(&[][..], |survey| survey.columns.as_slice());
        for (column, number) in columns.iter().zip(look.run.column_numbers()) {
            self.near(column.center, Role::Found, &number.to_string(), 1);
        }
        let obstacles = look.run.about.iter().flat_map(|about| &about.world.obstacles);
        for obstacle in obstacles.filter(|obstacle| !survey::is_mapped(&look, obstacle)) {
            let (role, mark) = if obstacle.known { (Role::Obstacle, "#") } else { (Role::Found, "?") };
            let center = obstacle.shape.center();
            let named = format!("{mark}{}", obstacle.name);
            if !(is_named(obstacle) && self.if_free(center, role, &named, 0)) {
                self.if_free(center, role, mark, 0);
            }
        }
    }

    /// On the plan screen: the selected area that the plan leaves out, and the places of the figures in the estimate.
    fn places(&mut self) {
        let look = self.look;
        if look.model.ui.screen != Screen::Plan {
            return;
        }
        if let Some(at) = look.model.left_out_at() {
            self.always(at, Role::Selected, "◎");
        }
        if let Some(resumption) = look.model.live.left_out().and_then(|left_out| left_out.resumption) {
            self.always(resumption.at, Role::Title, RESUMES);
        }
        for (letter, at) in look.model.live.promised().into_iter().flat_map(worst_places) {
            self.beside(at, Role::Watch, letter);
        }
    }

    /// The obstacle round which the tether is wound most.
    fn wound(&mut self) {
        if let Some(at) = wound(&self.look) {
            self.beside(at, Role::Tether, WOUND);
        }
    }

    /// The place at which a better plan begins.
    fn change_over(&mut self) {
        let look = self.look;
        if let Some(at) = course::change_over(&look) {
            self.always(at, Role::Watch, "◇");
        }
    }

    fn stations(&mut self) {
        let look = self.look;
        let shown = look.model.ui.layers.shows(MapLayer::Stations);
        for station in look.run.about.iter().filter(|_| shown).flat_map(|about| &about.world.stations) {
            let name = if text::width(&station.name) <= NAME { station.name.as_str() } else { "S" };
            if stations::is_unused(&look, station.id) {
                self.beside(station.position, Role::Warn, &format!("{name}{UNUSED}"));
            } else {
                self.beside(station.position, Role::Station, name);
            }
        }
    }

    fn missed(&mut self) {
        let selected = self.look.model.ui.missed;
        let mut areas: Vec<(usize, &Area<MissReason>)> =
            numbered(&self.look).into_iter().enumerate().collect();
        // The selected area keeps its place.
        areas.sort_by_key(|(index, _)| *index != selected);
        for (index, area) in areas {
            let role = if index == selected { Role::Selected } else { missed::role(area) };
            let number = (index + 1).to_string();
            // Two numbers side by side would read as one.
            if !self.near(area.at, role, &number, 1) {
                self.always(area.at, role, &number);
            }
        }
    }

    fn frontiers(&mut self) {
        for at in survey::frontiers(&self.look) {
            self.if_free(*at, Role::Watch, survey::FRONTIER, 0);
        }
    }

    fn targets(&mut self) {
        let run = self.look.run;
        if let Some(progress) = run.progress.as_ref().filter(|_| !run.has_ended()) {
            self.if_free(progress.target, Role::Target, "×", 0);
        }
    }

    /// The order and the direction of the lanes ahead, then the directions of a second plan.
    fn lanes(&mut self) {
        let look = self.look;
        let [thinning, second] = course::thinnings(&look, self.window);
        if let Some(course) = course::course(&look).filter(|_| !look.run.has_ended()) {
            self.lanes_of(course.track, course.ahead.0, thinning, Arrow::PLAN);
        }
        let others = [
            (course::offer(&look), Arrow::OFFER),
            (course::compared(&look), Arrow::OTHER),
            (course::shadow(&look), Arrow::SHADOW),
        ];
        for (track, arrow) in others {
            if let Some(track) = track {
                self.lanes_of(track, 0, second, arrow);
            }
        }
    }

    /// The labels of the lanes of a path that are drawn and begin at an index of its points or later.
    fn lanes_of(&mut self, track: Track, from: usize, thinning: Thinning, arrow: Arrow) {
        let thin = Thin::new(track.path, track.lanes, thinning);
        if track.lanes.is_empty() {
            let every_m = ARROW_COLUMNS * self.window.column_m;
            for line in thin.lines((from, track.path.len().saturating_sub(1))) {
                self.arrows(&line, every_m, arrow);
            }
            return;
        }
        let least_m = LANE_COLUMNS * self.window.column_m;
        let ahead = thin.lanes.iter().map(|index| (*index, track.lanes[*index]));
        for (index, (first, last)) in ahead.filter(|(_, lane)| lane.0 >= from) {
            let lane = &track.path[first..=last];
            let length_m = polyline::length_m(lane);
            if length_m < least_m {
                continue;
            }
            let number = along(lane, 0.25 * length_m).filter(|_| arrow.is_numbered);
            if let Some((at, _)) = number {
                self.if_free(at, Role::Title, &(index + 1).to_string(), 1);
            }
            self.arrow(along(lane, arrow.at * length_m), arrow);
        }
    }

    /// Writes arrows along a path, counted from its end, because its beginning may move with the robot.
    fn arrows(&mut self, path: &[Point], every_m: f64, arrow: Arrow) {
        let mut walked_m = 0.0;
        for pair in path.windows(2).rev() {
            walked_m += (pair[1] - pair[0]).norm();
            if walked_m >= every_m {
                walked_m = 0.0;
                self.arrow(Some((pair[1], pair[1] - pair[0])), arrow);
            }
        }
    }

    fn arrow(&mut self, place: Option<(Point, Vector)>, arrow: Arrow) {
        if let Some((at, way)) = place {
            let sign = arrow.along(self.look.caps.glyphs, way.y.atan2(way.x));
            self.if_free(at, arrow.role, sign, 1);
        }
    }

    /// Writes a label over whatever is there.
    fn always(&mut self, at: Point, role: Role, label: &str) {
        if let Some(cell) = self.window.cell_of(at) {
            self.write(cell, role, label);
        }
    }

    /// Writes a label that begins at a point, if it fits and `margin` columns on both sides are free; returns whether
    /// it was written.
    fn if_free(&mut self, at: Point, role: Role, label: &str, margin: u16) -> bool {
        let cell = self.window.cell_of(at).filter(|cell| self.is_free(*cell, label, margin));
        cell.inspect(|cell| self.write(*cell, role, label)).is_some()
    }

    /// Writes a label at a point or, if something is there, next to it.
    fn beside(&mut self, at: Point, role: Role, label: &str) {
        self.near(at, role, label, 0);
    }

    /// Writes a label at a point or next to it, where `margin` columns on both sides are free; returns whether it was written.
    fn near(&mut self, at: Point, role: Role, label: &str, margin: u16) -> bool {
        let Some((column, row)) = self.window.cell_of(at) else { return false };
        let left = column.checked_sub(text::width(label) as u16);
        let places = [
            Some((column, row)),
            Some((column + 1, row)),
            left.map(|left| (left, row)),
            row.checked_sub(1).map(|above| (column, above)),
            Some((column, row + 1)),
        ];
        let free = places.into_iter().flatten().find(|cell| self.is_free(*cell, label, margin));
        free.inspect(|cell| self.write(*cell, role, label)).is_some()
    }

    fn is_free(&self, (column, row): (u16, u16), label: &str, margin: u16) -> bool {
        let (first, end) = (column.saturating_sub(margin), column + text::width(label) as u16 + margin);
        let fits = end - margin <= self.area.width && row < self.area.height;
        fits && !self.taken.iter().any(|(other, from, to)| *other == row && *from < end && first < *to)
    }

    fn write(&mut self, (column, row): (u16, u16), role: Role, label: &str) {
        let style = self.look.theme.style(role).add_modifier(Modifier::BOLD);
        let room = usize::from(self.area.width - column);
        let (end, _) = self.buffer.set_stringn(self.area.x + column, self.area.y + row, label, room, style);
        self.taken.push((row, column, end - self.area.x));
    }
}

/// Where the tether is wound most during a mission, metres, tank frame; `None` while it is straight.
pub(super) fn wound(look: &Look) -> Option<Point> {
    let most = look.run.tether.as_ref().filter(|tether| !tether.is_snagged)?.largest()?;
    let is_plan = look.model.ui.screen == Screen::Plan;
    (!is_plan && most.wrap_rad.abs().to_degrees() >= WOUND_DEG).then_some(most.at)
}

/// Whether the name of an obstacle is written on the map.
fn is_named(obstacle: &Obstacle) -> bool {
    obstacle.known && (1..=NAME).contains(&text::width(&obstacle.name))
}

/// The letters of the figures that have a place: c smallest clearance, t longest tether, w largest wrap, p largest pull, e largest error.
pub(super) fn worst_places(estimate: &Estimate) -> Vec<(&'static str, Point)> {
    let tether = estimate.tether.as_ref();
    let wrapped = tether.filter(|tether| tether.wrap_max.value > 0.0);
    let places = [
        ("t", tether.map(|tether| tether.length_max)),
        ("c", estimate.clearance_min),
        ("e", estimate.accuracy_worst),
        ("w", wrapped.map(|tether| tether.wrap_max)),
        ("p", tether.and_then(|tether| tether.pull_max_n)),
    ];
    places.into_iter().filter_map(|(letter, worst)| Some((letter, worst?.at))).collect()
}

/// The point at a distance along a path, and the direction of the path there.
fn along(path: &[Point], at_m: f64) -> Option<(Point, Vector)> {
    let mut left_m = at_m;
    for pair in path.windows(2) {
        let way = pair[1] - pair[0];
        let length_m = way.norm();
        if length_m > 0.0 && left_m <= length_m {
            return Some((pair[0] + way * (left_m / length_m), way));
        }
        left_m -= length_m;
    }
    None
}

/// The robot, which points along its heading.
fn robot(glyphs: Glyphs, heading_rad: f64) -> &'static str {
    const ROBOT: [&str; 8] = ["▶", "◥", "▲", "◤", "◀", "◣", "▼", "◢"];
    if glyphs == Glyphs::Ascii || !heading_rad.is_finite() { "@" } else { ROBOT[eighth(heading_rad)] }
}

/// The arrows along a kind of path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrow {
    role: Role,
    /// The arrows to the east and, in steps of 45°, to the other directions.
    signs: [&'static str; 8],
    /// The place of the arrow on a lane, as a share of the lane.
    at: f64,
    /// Whether the lanes are numbered.
    is_numbered: bool,
}

impl Arrow {
    const PLAN: Self = Self {
        role: Role::Plan,
        signs: ["→", "↗", "↑", "↖", "←", "↙", "↓", "↘"],
        at: 0.5,
        is_numbered: true,
    };
    const OFFER: Self = Self {
        role: Role::Watch,
        signs: ["⇒", "⇗", "⇑", "⇖", "⇐", "⇙", "⇓", "⇘"],
        at: 0.6,
        is_numbered: false,
    };
    const OTHER: Self = Self {
        role: Role::Ghost,
        signs: ["⇢", "⇡", "⇡", "⇡", "⇠", "⇣", "⇣", "⇣"],
        at: 0.6,
        is_numbered: false,
    };

    const SHADOW: Self = Self {
        role: Role::Ghost,
        signs: ["↠", "↟", "↟", "↟", "↞", "↡", "↡", "↡"],
        at: 0.4,
        is_numbered: false,
    };

    fn along(self, glyphs: Glyphs, heading_rad: f64) -> &'static str {
        const LETTERS: [&str; 8] = [">", "^", "^", "^", "<", "v", "v", "v"];
        let signs = if glyphs == Glyphs::Ascii { LETTERS } else { self.signs };
        signs[eighth(heading_rad)]
    }

    /// The arrow of a kind of line in the legend; `None` if lines of the kind have no arrows.
    pub(super) fn of(ink: Ink) -> Option<&'static str> {
        let arrow = match ink {
            ink::PLAN | ink::AHEAD => Self::PLAN,
            ink::OFFER => Self::OFFER,
            ink::OTHER => Self::OTHER,
            ink::SHADOW => Self::SHADOW,
            _ => return None,
        };
        Some(arrow.signs[0])
    }
}

fn eighth(heading_rad: f64) -> usize {
    let eighth = (heading_rad / std::f64::consts::FRAC_PI_4).round().rem_euclid(8.0);
    (eighth as usize) % 8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_along_a_path_is_found_with_its_direction() {
        let path = [Point::origin(), Point::new(2.0, 0.0), Point::new(2.0, 0.0), Point::new(2.0, 3.0)];
        let (at, way) = along(&path, 3.0).unwrap_or_default();
        assert_eq!((at, way.normalize()), (Point::new(2.0, 1.0), Vector::y()));
        assert_eq!(along(&path, 5.1), None);
    }

    #[test]
    fn directions_are_the_nearest_of_eight() {
        let at = |degrees: f64| Arrow::PLAN.along(Glyphs::Braille, degrees.to_radians());
        assert_eq!([at(0.0), at(40.0), at(-91.0), at(359.0)], ["→", "↗", "↓", "→"]);
        assert_eq!(Arrow::OFFER.along(Glyphs::Ascii, -2.0), "v");
        let all = [Arrow::PLAN, Arrow::OFFER, Arrow::OTHER, Arrow::SHADOW]
            .map(|arrow| arrow.along(Glyphs::Braille, 0.0));
        assert_eq!(all, ["→", "⇒", "⇢", "↠"], "told apart without colours");
        assert_eq!(robot(Glyphs::Braille, std::f64::consts::FRAC_PI_2), "▲");
    }
}
