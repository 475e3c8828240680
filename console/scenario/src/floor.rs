//! Reads the objects on the floor: `[tank]`, `[[obstacles]]`, `[[zones]]` and `[plates]`.

use super::{
    outline::{counter_clockwise, outline},
    problem::Complaint,
    section::{Place, Section},
};
use import::{is_wholly_outside, plan::MOST_PLATES};
use sim::{Mover, Track};
use std::collections::BTreeMap;
use world::{
    Boundary, DrawnPlate, NO_PLATE, Obstacle, ObstacleId, PlateLayout, RegularPlates, Shape, Vector, Zone,
    ZoneKind,
};

/// Reads `[tank]`.
pub(crate) fn tank(root: &Section<'_>) -> Option<Boundary> {
    let section = root.table("tank")?;
    if section.has("map") {
        section.text("map")?;
        section.complain(
            "map",
            Complaint::Map("a map can be used only in a scenario that is read from a file".into()),
        );
        return None;
    }
    if section.has("radius_m") {
        section.refuse(&["vertices_m", "map_tolerance_m"], "radius_m");
        return Some(Boundary::Circle { radius_m: section.number("radius_m")? });
    }
    if !section.has("vertices_m") {
        section
            .require("radius_m", "add radius_m = ..., in m, for a round tank, or vertices_m = [[x, y], ...]");
        return None;
    }
    section.refuse(&["map_tolerance_m"], "vertices_m");
    Some(Boundary::Polygon { vertices: counter_clockwise(&section, "vertices_m")? })
}

/// Reads `[plates]`.
pub(crate) fn plates(root: &Section<'_>, boundary: Option<&Boundary>) -> Option<PlateLayout> {
    let section = root.table("plates")?;
    if section.has("outlines") {
        section.refuse(&["annular_width_m", "annular_count", "plate_length_m", "plate_width_m"], "outlines");
        return Some(PlateLayout::Drawn { plates: drawn_plates(&section, boundary)?.into() });
    }
    let (annular_m, length_m) = (section.number("annular_width_m")?, section.number("plate_length_m")?);
    let width_m = section.number("plate_width_m")?;
    let n_annular = if section.has("annular_count") {
        section.whole("annular_count")? as u32
    } else {
        // The perimeter of a circle with the same area, regardless of the shape of the floor.
        let shell_m = (4.0 * std::f64::consts::PI * boundary?.area_m2()).sqrt();
        (shell_m / length_m).ceil().clamp(1.0, 1000.0) as u32
    };
    Some(PlateLayout::Regular(RegularPlates { annular_m, n_annular, length_m, width_m }))
}

/// Reads the outlines of plates; invalid outlines are left out.
fn drawn_plates(section: &Section<'_>, boundary: Option<&Boundary>) -> Option<Vec<DrawnPlate>> {
    let mut names = Names::default();
    let sections = section.tables("outlines");
    if sections.is_empty() {
        section.complain("outlines", Complaint::TooFew { have: 0, need: 1 });
        return None;
    }
    if sections.len() > MOST_PLATES {
        section.complain("outlines", Complaint::TooMany { have: sections.len(), most: MOST_PLATES });
        return None;
    }
    let mut read = |section: &Section<'_>| {
        let name = if section.has("name") { names.of(section, String::new) } else { section.text("name") };
        if name.as_deref() == Some(NO_PLATE) {
            section.complain("name", Complaint::Duplicate { other: "the floor outside all plates".into() });
        }
        let vertices_m = counter_clockwise(section, "vertices_m")?;
        let shape = Shape::Polygon { vertices: vertices_m.clone() };
        if boundary.is_some_and(|boundary| is_wholly_outside(boundary, &shape)) {
            section.complain_whole(Complaint::WhollyOutside);
        }
        Some(DrawnPlate { name: name?, vertices_m })
    };
    Some(sections.iter().filter_map(&mut read).collect())
}

/// Reads `[[obstacles]]` and their motion; invalid obstacles are left out.
pub(crate) fn obstacles(root: &Section<'_>, boundary: Option<&Boundary>) -> (Vec<Obstacle>, Vec<Mover>) {
    let mut movers = Vec::new();
    let mut names = Names::default();
    let sections = root.tables("obstacles");
    let mut read = |(i, section): (usize, &Section<'_>)| {
        let name = names.of(section, || format!("obstacle {}", i + 1));
        let id = ObstacleId(i as u32 + 1);
        let shape = outline(section, "kind");
        let track = track(section);
        // A moving obstacle cannot be on a drawing.
        let known = if section.has("known") { section.flag("known") } else { Some(track.is_none()) };
        let shape = shape?;
        movers.extend(track.map(|track| Mover { id, track }));
        if boundary.is_some_and(|boundary| is_wholly_outside(boundary, &shape)) {
            section.complain_whole(Complaint::WhollyOutside);
        }
        Some(Obstacle { id, name: name?, shape, known: known? })
    };
    let obstacles = sections.iter().enumerate().filter_map(&mut read).collect();
    (obstacles, movers)
}

/// The motion of an obstacle, if it moves.
fn track(section: &Section<'_>) -> Option<Track> {
    if section.has("velocity_m_per_s") {
        section.refuse(&["waypoints_m", "speed_m_per_s", "known"], "velocity_m_per_s");
        let [x, y] = section.pair("velocity_m_per_s")?;
        return Some(Track::Straight { velocity_m_per_s: Vector::new(x, y) });
    }
    if section.has("waypoints_m") {
        section.refuse(&["known"], "waypoints_m");
        let (points, speed) = (section.points("waypoints_m"), section.number("speed_m_per_s"));
        return Some(Track::Waypoints { points: points?, speed_m_per_s: speed? });
    }
    if section.has("speed_m_per_s") {
        section.require(
            "waypoints_m",
            "add waypoints_m = [[x, y], ...], the points between which it moves back and forth",
        );
    }
    None
}

/// Reads `[[zones]]`; invalid zones are left out.
pub(crate) fn zones(root: &Section<'_>) -> Vec<Zone> {
    let mut names = Names::default();
    let sections = root.tables("zones");
    let read = |(i, section): (usize, &Section<'_>)| {
        let name = names.of(section, || format!("zone {}", i + 1));
        let kind = section.word("kind").map(|word| match word {
            "no_go" => ZoneKind::NoGo,
            "land" => ZoneKind::Land,
            _ => ZoneKind::Underwater,
        });
        let shape = outline(section, "shape");
        Some(Zone { name: name?, kind: kind?, shape: shape? })
    };
    sections.iter().enumerate().filter_map(read).collect()
}

/// The names used so far, to detect duplicates.
#[derive(Default)]
pub(crate) struct Names(BTreeMap<String, Place>);

impl Names {
    /// The name of an entry, or a generated one; complains about a duplicate.
    pub(crate) fn of(&mut self, section: &Section<'_>, made_up: impl Fn() -> String) -> Option<String> {
        let name = if section.has("name") { section.text("name")? } else { made_up() };
        if let Some(first) = self.0.get(&name) {
            section.complain("name", Complaint::Duplicate { other: first.key.clone() });
        } else {
            self.0.insert(name.clone(), section.place("name"));
        }
        Some(name)
    }
}
