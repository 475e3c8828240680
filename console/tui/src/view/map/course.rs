//! The paths on the map: the plan, where it leads and how far it has been driven, other plans, and the trail.

use super::ink::{self, Ink};
use super::pen::{Pen, within};
use super::shapes::Window;
use crate::model::{Overlay, PlanShown, Screen, WhatIf, ui::MapLayer};
use crate::view::look::Look;
use ratatui::widgets::canvas::Context;
use world::Point;

/// All passes of the trail are drawn if a pass of the tool is at least this many columns wide.
const PASS_COLUMNS: f64 = 2.0;
/// The lanes of a plan are drawn as lines if they are at least this many columns apart, and all of them as dashes if
/// they are [`PASS_COLUMNS`] apart.
const LANE_COLUMNS: f64 = 1.2;
/// How much of the trail and of the plan is drawn if they are not drawn completely, columns.
const REACH_COLUMNS: f64 = 40.0;

/// The plan on the map, in three parts, of which each begins where the one before ends.
pub(super) struct Course<'a> {
    /// The part that has been driven; empty before the start.
    pub driven: &'a [Point],
    /// The rest of the lane on which the robot is, or of the way to the next one; empty if nothing is being driven.
    pub leg: &'a [Point],
    /// The rest of the plan.
    pub ahead: &'a [Point],
    /// The index of the first point ahead.
    pub from: usize,
    /// The whole plan.
    pub plan: &'a PlanShown,
}

/// The plan, if it is shown.
pub(super) fn course<'a>(look: &Look<'a>) -> Option<Course<'a>> {
    let run = look.run;
    let plan = run.planning.plan.as_ref().filter(|_| look.model.ui.layers.shows(MapLayer::Plan))?;
    let path = plan.path.as_slice();
    let Some(progress) = run.progress.as_ref().filter(|_| !path.is_empty()) else {
        return Some(Course { driven: &[], leg: &[], ahead: path, from: 0, plan });
    };
    let at = plan.nearest(progress.target);
    let end = if run.has_ended() { at } else { plan.leg_at(at).1.clamp(at, path.len() - 1) };
    Some(Course { driven: &path[..=at], leg: &path[at..=end], ahead: &path[end..], from: end, plan })
}

/// How the plan is drawn: as lines before the start and as dashes afterwards; where its lanes would merge, as dots.
pub(super) fn plan_ink(look: &Look, window: Window) -> Ink {
    match (look.run.progress.is_some(), are_lanes_apart(look, window, LANE_COLUMNS)) {
        (true, _) => ink::AHEAD,
        (false, true) => ink::PLAN,
        (false, false) => ink::PLAN_CLOSE,
    }
}

/// Whether the lanes of a plan can be told apart on the map.
fn are_lanes_apart(look: &Look, window: Window, columns: f64) -> bool {
    let lane_m = look.run.about.as_ref().map_or(0.0, |about| about.mission.lane_m());
    lane_m >= columns * window.column_m
}

/// Whether the map shows the robot's trail; on the plan screen, the plan shows what has been driven.
pub(super) fn shows_trail(look: &Look) -> bool {
    let ui = &look.model.ui;
    ui.layers.shows(MapLayer::Trail) && ui.screen != Screen::Plan && !look.run.trail.points().is_empty()
}

/// The path of a better plan that is on offer or was taken, during the mission.
pub(super) fn offer<'a>(look: &Look<'a>) -> Option<&'a [Point]> {
    let offer = look.run.planning.offer.as_ref().filter(|_| look.model.ui.layers.shows(MapLayer::Plan))?;
    Some(offer.path.as_slice())
}

/// The plan or forecast of a different planner, for comparison.
pub(super) fn compared<'a>(look: &Look<'a>) -> Option<&'a [Point]> {
    let (live, ui) = (&look.model.live, &look.model.ui);
    let path = match (&ui.overlay, ui.screen) {
        (Overlay::WhatIf, _) => {
            &live.what_if.as_ref().and_then(WhatIf::candidate)?.made.as_ref()?.as_ref().ok()?.path
        }
        (_, Screen::Plan) => &live.plans.ghost.as_ref()?.made.as_ref()?.as_ref().ok()?.path,
        _ => return None,
    };
    Some(path)
}

impl Pen<'_> {
    pub(super) fn paths(&self, ctx: &mut Context<'_>) {
        self.others(ctx);
        if let Some(course) = course(&self.look) {
            let (look, window) = (&self.look, self.window);
            let on_plan = look.model.ui.screen == Screen::Plan;
            let reach_m = Some(REACH_COLUMNS * window.column_m)
                .filter(|_| !on_plan && !are_lanes_apart(look, window, PASS_COLUMNS));
            if on_plan {
                self.draw(ctx, course.driven, ink::DRIVEN);
            }
            let ahead = reach_m.map_or(course.ahead, |reach_m| within(course.ahead, reach_m));
            self.draw(ctx, ahead, plan_ink(look, window));
            self.draw(ctx, course.leg, ink::LEG);
        }
        if shows_trail(&self.look) {
            self.trail(ctx, self.look.run.trail.points(), ink::TRAIL);
        }
    }

    /// The other plans, and the run with which a replay is compared.
    fn others(&self, ctx: &mut Context<'_>) {
        let look = &self.look;
        if let Some(path) = compared(look) {
            self.draw(ctx, path, ink::OTHER);
        }
        if let Some(path) = offer(look) {
            self.draw(ctx, path, ink::OFFER);
        }
        let other = look.model.live.replay.as_ref().and_then(|replay| replay.other.as_ref());
        if let Some(other) = other.filter(|_| look.model.ui.screen == Screen::Mission) {
            self.trail(ctx, other.run.trail.points(), ink::OTHER);
        }
    }

    /// The newest part of a trail. Where neighbouring passes would merge on the map, only the stretch close to the
    /// robot is drawn; the scanned cells show the rest.
    fn trail(&self, ctx: &mut Context<'_>, points: &[Point], ink: Ink) {
        let swath_m = self.look.run.about.as_ref().map_or(0.0, |about| about.mission.swath_m);
        let newest: Vec<Point> = points.iter().rev().copied().collect();
        let merges = swath_m < PASS_COLUMNS * self.window.column_m;
        let reach_m = REACH_COLUMNS * self.window.column_m;
        self.draw(ctx, if merges { within(&newest, reach_m) } else { &newest }, ink);
    }
}
