//! The paths on the map: the plan with its direction and the part that has been driven, other plans, and the trail.

use super::ink::{self, Ink};
use super::pen::{Pen, within};
use super::shapes::Window;
use super::thin::{self, Thin, Thinning, divided};
use crate::model::{Lane, Overlay, Screen, WhatIf, ui::MapLayer};
use crate::view::look::Look;
use ratatui::widgets::canvas::Context;
use world::Point;

/// All passes of the trail are drawn if a pass of the tool is at least this many columns wide.
const PASS_COLUMNS: f64 = 2.0;
/// The same without colours: the floor is visible only between the passes, so most of it is left free.
const PLAIN_PASS_COLUMNS: f64 = 6.0;
/// How much of the trail is drawn if its passes would merge, columns.
const REACH_COLUMNS: f64 = 20.0;

/// A path with its lanes.
#[derive(Clone, Copy)]
pub(super) struct Track<'a> {
    pub path: &'a [Point],
    pub lanes: &'a [Lane],
}

/// The plan on the map, in three parts, each from one index of its points to another; each part begins where the one
/// before ends.
pub(super) struct Course<'a> {
    /// The part that has been driven; empty before the start.
    pub driven: Lane,
    /// The rest of the lane on which the robot is, or of the way to the next one; empty if nothing is being driven.
    pub leg: Lane,
    /// The rest of the plan.
    pub ahead: Lane,
    /// The whole plan.
    pub track: Track<'a>,
}

/// The plan, if it is shown.
pub(super) fn course<'a>(look: &Look<'a>) -> Option<Course<'a>> {
    let run = look.run;
    let plan = run.planning.plan.as_ref().filter(|_| look.model.ui.layers.shows(MapLayer::Plan))?;
    let track = Track { path: &plan.path, lanes: &plan.lanes };
    let last = plan.path.len().checked_sub(1)?;
    let Some(progress) = &run.progress else {
        return Some(Course { driven: (0, 0), leg: (0, 0), ahead: (0, last), track });
    };
    let at = plan.reached(progress);
    let end = if run.has_ended() { at } else { plan.leg_at(at).1.clamp(at, last) };
    Some(Course { driven: (0, at), leg: (at, end), ahead: (end, last), track })
}

/// How the plan is drawn: as lines before the start and as dashes afterwards.
pub(super) fn plan_ink(look: &Look) -> Ink {
    if look.run.progress.is_some() { ink::AHEAD } else { ink::PLAN }
}

/// The parts of the plan ahead, each with whether it is a way to a different part of the floor. Under way, the whole plan
/// ahead is drawn alike.
pub(super) fn parts(look: &Look, course: &Course) -> Vec<(Lane, bool)> {
    // A path to a goal has no lanes.
    let about = look.run.about.as_ref().filter(|_| look.run.covers());
    let lane_m = about.map_or(0.0, |about| about.mission.lane_m());
    if look.run.progress.is_some() {
        return vec![(course.ahead, false)];
    }
    divided(course.track.path, course.track.lanes, lane_m, course.ahead)
}

/// The lanes that are drawn: those of the plan, and those of a second plan beside it.
pub(super) fn thinnings(look: &Look, window: Window) -> [Thinning; 2] {
    let lane_m = look.run.about.as_ref().map_or(0.0, |about| about.mission.lane_m());
    // A path that passes its places once is drawn without gaps, however close together its turns are.
    let is_single = |course: Course| !thin::passes_again(course.track.path, lane_m);
    let lane_m = if !look.run.covers() && course(look).is_some_and(is_single) { 0.0 } else { lane_m };
    let paths = 1 + usize::from(offer(look).is_some() || compared(look).is_some() || shadow(look).is_some());
    [0, 1].map(|which| Thinning::new(lane_m, window, (which.min(paths - 1), paths)))
}

/// Whether the map shows the robot's trail; on the plan screen, the plan shows what has been driven.
pub(super) fn shows_trail(look: &Look) -> bool {
    let ui = &look.model.ui;
    ui.layers.shows(MapLayer::Trail) && ui.screen != Screen::Plan && !look.run.trail.points().is_empty()
}

/// A better plan that is on offer or was taken, during the mission.
pub(super) fn offer<'a>(look: &Look<'a>) -> Option<Track<'a>> {
    let offer = look.run.planning.offer.as_ref().filter(|_| look.model.ui.layers.shows(MapLayer::Plan))?;
    Some(Track { path: &offer.path, lanes: &offer.lanes })
}

/// The whole plan of the planner in shadow, which is shown while the robot does not run.
pub(super) fn shadow<'a>(look: &Look<'a>) -> Option<Track<'a>> {
    let shadow = look.run.shown_shadow().filter(|_| !look.run.is_running())?;
    let is_shown = look.model.ui.layers.shows(MapLayer::Plan) && shadow.path.len() > 1;
    is_shown.then_some(Track { path: &shadow.path, lanes: &shadow.lanes })
}

/// The place at which the better plan begins, metres, tank frame.
pub(super) fn change_over(look: &Look) -> Option<Point> {
    offer(look)?;
    look.run.planning.offer.as_ref()?.begins
}

/// The plan or forecast of a different planner, for comparison.
pub(super) fn compared<'a>(look: &Look<'a>) -> Option<Track<'a>> {
    let (live, ui) = (&look.model.live, &look.model.ui);
    match (&ui.overlay, ui.screen) {
        (Overlay::WhatIf, _) => {
            let made = live.what_if.as_ref().and_then(WhatIf::candidate)?.made.as_ref()?.as_ref().ok()?;
            Some(Track { path: &made.path, lanes: &[] })
        }
        (_, Screen::Plan) => {
            let plan = live.plans.ghost.as_ref()?.made.as_ref()?.as_ref().ok()?;
            Some(Track { path: &plan.path, lanes: &plan.lanes })
        }
        _ => None,
    }
}

impl Pen<'_> {
    pub(super) fn paths(&self, ctx: &mut Context<'_>) {
        self.others(ctx);
        let course = course(&self.look);
        if let Some(course) = &course {
            let [thinning, _] = thinnings(&self.look, self.window);
            let thin = Thin::new(course.track.path, course.track.lanes, thinning);
            if self.look.model.ui.screen == Screen::Plan {
                self.pieces(ctx, &thin, course.driven, ink::DRIVEN);
            }
            for (part, is_way) in parts(&self.look, course) {
                let ink = if is_way { ink::WAY } else { plan_ink(&self.look) };
                self.pieces(ctx, &thin, part, ink);
            }
        }
        if shows_trail(&self.look) {
            self.trail(ctx, self.look.run.trail.points(), ink::TRAIL, self.swath_m());
        }
        if let Some(course) = course {
            let (from, to) = course.leg;
            self.draw(ctx, &course.track.path[from..=to], ink::LEG);
        }
    }

    /// The other plans, and the run with which a replay is compared.
    fn others(&self, ctx: &mut Context<'_>) {
        let look = &self.look;
        let [_, thinning] = thinnings(look, self.window);
        for (track, ink) in [(compared(look), ink::OTHER), (offer(look), ink::OFFER)] {
            if let Some(track) = track.filter(|track| track.path.len() > 1) {
                let thin = Thin::new(track.path, track.lanes, thinning);
                self.pieces(ctx, &thin, (0, track.path.len() - 1), ink);
            }
        }
        let other = look.model.live.replay.as_ref().and_then(|replay| replay.other.as_ref());
        if let Some(other) = other.filter(|_| look.model.ui.screen == Screen::Mission) {
            self.trail(ctx, other.run.trail.points(), ink::OTHER, self.swath_m());
        }
    }

    /// Draws the lines of a part of a path from their ends, because the beginning of the plan ahead moves with the
    /// robot: counted from there, the dashes of the whole plan would move as well.
    fn pieces(&self, ctx: &mut Context<'_>, thin: &Thin, part: Lane, ink: Ink) {
        for mut line in thin.lines(part) {
            line.reverse();
            self.draw(ctx, &line, ink);
        }
    }

    /// Width of the floor that a pass of the tool scans in the open run, metres.
    fn swath_m(&self) -> f64 {
        self.look.run.about.as_ref().map_or(0.0, |about| about.mission.swath_m)
    }

    /// The newest part of a trail with passes of the given width, metres. Where neighbouring passes would merge on the
    /// map, or would hide the floor because the map has no colours, only the stretch close to the robot is drawn; the
    /// scanned cells show the rest.
    pub(in crate::view) fn trail(&self, ctx: &mut Context<'_>, points: &[Point], ink: Ink, swath_m: f64) {
        let newest: Vec<Point> = points.iter().rev().copied().collect();
        let least = if self.look.is_plain() { PLAIN_PASS_COLUMNS } else { PASS_COLUMNS };
        let merges = swath_m < least * self.window.column_m;
        let reach_m = REACH_COLUMNS * self.window.column_m;
        self.draw(ctx, if merges { within(&newest, reach_m) } else { &newest }, ink);
    }
}
