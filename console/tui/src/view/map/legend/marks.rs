//! The marks in the legend: zones, obstacles, stations, and places with letters.

use super::super::pattern::braille;
use super::super::shapes::Window;
use super::super::{course, labels, plates, scan, survey};
use super::{Entry, MARK};
use crate::model::{Screen, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use crate::view::stations::is_unused;
use crate::view::text;
use world::{Point, ZoneKind};

/// The samples of areas: a no-go zone and the outline of a plate.
pub(super) fn fixed(has_dots: bool) -> [(String, &'static str); 2] {
    let hatched = if has_dots { braille(2, |x, y| (x + y).is_multiple_of(4)) } else { "xx".into() };
    let outline = if has_dots { braille(3, |x, y| y == 2 && x.is_multiple_of(2)) } else { "``".into() };
    [(hatched, "no-go zone"), (outline, "plate")]
}

/// The marks that are drawn.
pub(super) fn shown(look: &Look, window: Window) -> Vec<Entry> {
    let (run, ui) = (look.run, &look.model.ui);
    let Some(about) = &run.about else { return Vec::new() };
    let seen = |at: Point| window.cell_of(at).is_some();
    let [hatched, outline] = fixed(look.caps.glyphs.has_dots()).map(|(mark, _)| mark);
    let obstacle = |known: bool| {
        let mut shown = about.world.obstacles.iter().filter(|obstacle| !survey::is_mapped(look, obstacle));
        shown.any(|obstacle| obstacle.known == known && seen(obstacle.shape.center()))
    };
    let columns =
        survey::shown(look).filter(|survey| survey.columns.iter().any(|column| seen(column.center)));
    let frontier = survey::frontiers(look).iter().any(|at| seen(*at));
    let no_go = about.world.zones.iter().any(|zone| zone.kind == ZoneKind::NoGo && seen(zone.shape.center()));
    let station = ui.layers.shows(MapLayer::Stations)
        && about.world.stations.iter().any(|station| seen(station.position));
    let unused =
        about.world.stations.iter().find(|at| station && is_unused(look, at.id) && seen(at.position));
    let unused = unused.map(|station| {
        let is_short = text::width(&station.name) < MARK;
        format!("{}{}", if is_short { &station.name } else { "S" }, labels::UNUSED)
    });
    let target = run.progress.as_ref().is_some_and(|progress| !run.has_ended() && seen(progress.target));
    let wound = labels::wound(look).is_some_and(seen);
    let change_over = course::change_over(look).is_some_and(seen);
    let numbered = labels::numbered(look).iter().filter(|area| seen(area.at)).count();
    let numbers = match numbered {
        0 | 1 => "1".to_owned(),
        2..=9 => format!("1-{numbered}"),
        _ => "1+".into(),
    };
    let marks = [
        // The areas may be too small for their own floor to be visible.
        (numbered > 0, Role::Missed, numbers, "missed area"),
        (no_go, Role::NoGo, hatched, "no-go zone"),
        (frontier, Role::Watch, survey::FRONTIER.into(), "frontier"),
        (
            columns.is_some(),
            Role::Found,
            columns.map_or_else(String::new, |_| survey::numbers(run)),
            "column",
        ),
        (obstacle(false), Role::Found, "?".to_owned(), "found"),
        (obstacle(true), Role::Obstacle, "#".into(), "obstacle"),
        (target, Role::Target, "×".into(), "target"),
        (!scan::shown(look).is_empty(), Role::Watch, scan::mark(look), "scan"),
        (wound, Role::Tether, labels::WOUND.into(), "largest wrap"),
        (change_over, Role::Watch, "◇".into(), "change-over"),
        (station, Role::Station, stations(look), "station"),
        (unused.is_some(), Role::Warn, unused.unwrap_or_default(), "not used"),
        (plates::plates(look, window).is_some(), Role::Plate, outline, "plate"),
    ];
    let marks = marks.into_iter().filter(|(shown, ..)| *shown);
    marks.map(|(_, role, mark, word)| Entry { role, mark, word: word.into() }).collect()
}

/// The first and the last name of the stations.
fn stations(look: &Look) -> String {
    let names: Vec<&str> = look.run.stations().iter().map(|station| station.name.as_str()).collect();
    match names.as_slice() {
        [first, .., last] if text::width(first) == 1 && text::width(last) == 1 => format!("{first}-{last}"),
        [first, ..] if text::width(first) <= MARK => (*first).to_owned(),
        _ => "S".into(),
    }
}

/// The places of the estimate, on the plan screen.
pub(super) fn places(look: &Look, window: Window) -> Vec<Entry> {
    let on_plan = look.model.ui.screen == Screen::Plan;
    let places = look.model.live.promised().into_iter().filter(|_| on_plan).flat_map(labels::worst_places);
    let seen = places.filter(|(_, at)| window.cell_of(*at).is_some());
    let word = |letter: &str| match letter {
        "t" => "longest tether",
        "c" => "clearance",
        "e" => "AE error",
        "p" => "largest pull",
        _ => "wrap",
    };
    let entries =
        seen.map(|(letter, _)| Entry { role: Role::Watch, mark: letter.into(), word: word(letter).into() });
    let left_out = look.model.left_out_at().filter(|_| on_plan).map(|_| Entry {
        role: Role::Selected,
        mark: "◎".into(),
        word: "left out".into(),
    });
    let resumption = look.model.live.left_out().filter(|_| on_plan).and_then(|left_out| left_out.resumption);
    let resumes = resumption.map(|_| Entry {
        role: Role::Title,
        mark: labels::RESUMES.into(),
        word: if look.model.live.is_rescan() { "scan resumes" } else { "scan begins" }.into(),
    });
    left_out.into_iter().chain(resumes).chain(entries).collect()
}
