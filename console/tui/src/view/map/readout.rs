//! The lines at the bottom of the map: the robot's position, and details about the place under the cursor.

use super::{plates, shade, survey};
use crate::model::ui::Ui;
use crate::theme::Role;
use crate::view::look::Look;
use crate::view::missed::briefest;
use crate::view::text;
use account::OutOfReach;
use world::{FloorClass, Point};

/// The robot's position and its error, in words.
pub(super) fn robot(look: &Look, width: u16) -> (Role, String) {
    let position = &look.run.position;
    let name = if width >= 60 { "robot " } else { "" };
    let Some(pose) = &position.pose else { return (Role::Dim, "robot: no position yet ".into()) };
    let at = text::place(pose.position);
    let error = text::number(position.error_m().unwrap_or(f64::NAN), 2);
    let is_stale = look.is_pose_stale() || position.is_fix_stale(look.run.clock.t_s);
    let stale = if is_stale { "◌ " } else { "" };
    let role = if position.lost { Role::Crit } else { Role::Text };
    let lost = if position.lost { "LOST " } else { "" };
    (role, format!("{lost}{stale}{name}{at} ±{error} m "))
}

/// The place under the cursor: coordinates, and radius and bearing from the tank's centre.
pub(super) fn cursor(look: &Look, ui: &Ui, width: u16) -> Option<(Role, String)> {
    let at = ui.cursor?;
    let (low, high) = look.run.about.as_ref()?.world.boundary.bounds();
    let way = at - nalgebra::center(&low, &high);
    let name = if width >= 60 { "cursor " } else { "" };
    let (radius, bearing) = (text::number(way.norm(), 2), text::degrees(way.y.atan2(way.x)));
    Some((Role::Title, format!(" {name}{}  r {radius} m, {bearing}°", text::place(at))))
}

/// The floor there: its plate, its class, and the expected error of a fix.
pub(super) fn floor(look: &Look, at: Point) -> String {
    if let Some(survey) = survey::shown(look) {
        return format!("{}  {}", survey.word_at(at), fix_error(look, at));
    }
    let raster = look.model.live.scanned();
    let class = raster.and_then(|raster| raster.class_at(at, look.run.has_missed()));
    let Some((class, times)) = class else { return "no floor".into() };
    let plate = plates::name_at(look, at).map_or_else(String::new, |name| format!("{name}  "));
    format!("{plate}{}  {}", word(look, at, (class, times)), fix_error(look, at))
}

/// The forecast error of a fix.
fn fix_error(look: &Look, at: Point) -> String {
    let forecast = look.run.accuracy.as_ref().and_then(|map| map.at(at));
    match forecast.map(|forecast| forecast.error_95_m) {
        Some(Some(error_m)) => format!("AE ±{} m{}", text::number(error_m, 2), level(look, at)),
        Some(None) => "AE no fix".into(),
        None => "AE -".into(),
    }
}

/// The forecast protection level of a fix, if the scenario states a risk.
fn level(look: &Look, at: Point) -> String {
    let states_risk = look.run.about.as_ref().is_some_and(|about| about.mission.locating.risk.is_some());
    let here = look.run.accuracy.as_ref().and_then(|map| map.at(at)).filter(|_| states_risk);
    here.map_or_else(String::new, |here| match here.checks.and_then(|checks| checks.level_m) {
        Some(level_m) => format!(", level {} m", text::number(level_m, 2)),
        None => ", not protected".into(),
    })
}

/// The class of the floor at a place, and why it was missed, is left out or cannot be reached.
fn word(look: &Look, at: Point, (class, times): (FloorClass, u32)) -> String {
    let live = &look.model.live;
    let out_of_reach = || {
        let floor = look.run.coverage.as_ref()?.floor();
        Some(OutOfReach::of(floor.kind(floor.cell_at(at)?))?.plainly())
    };
    match class {
        FloorClass::Scanned | FloorClass::Again | FloorClass::Partial
            if let Some(doubt) = shade::why_left(look, at) =>
        {
            doubt.into()
        }
        FloorClass::Outside | FloorClass::ToDo => match live.left_out_area(at) {
            Some(area) => format!("left out: {}", briefest(area)),
            None => "to do".into(),
        },
        FloorClass::Missed => match (shade::why_left(look, at), live.missed_area(at)) {
            (Some(why), _) => why.into(),
            (None, Some(area)) => format!("missed: {}", briefest(area)),
            (None, None) => "missed".into(),
        },
        FloorClass::Scanned => "scanned".into(),
        FloorClass::Again => format!("scanned ×{times}"),
        FloorClass::Partial => "partially scanned".into(),
        FloorClass::Margin => "shell margin".into(),
        FloorClass::Untestable => "not testable by this tool: weld".into(),
        FloorClass::Unreachable => match out_of_reach() {
            Some(why) => format!("unreachable: {why}"),
            None => "unreachable".into(),
        },
    }
}
