//! The lines in the legend: the paths, the tether and the planner's drawings.

use super::super::course::{self, Course};
use super::super::ink::{self, Ink};
use super::super::shapes::Window;
use super::super::{drawn, labels, survey, zone};
use super::{Entry, MARK};
use crate::model::Screen;
use crate::update::zones;
use crate::view::look::Look;
use planner_api::Drawing;

/// The trail of the run with which a replay is compared.
pub(super) const RUN_B: &str = "run B";

/// Whether a kind of line is drawn.
pub(super) type IsDrawn = fn(&Look, Option<&Course>) -> bool;

/// The kinds of lines, the most important first, each with its legend text.
pub(super) const LINES: [(Ink, &str, IsDrawn); 14] = [
    (ink::BLOCKED, "blocked", |look, _| !zone::blocked(look).is_empty()),
    (ink::OUTLINE, "new zone", |look, _| zones::drawn(look.model).is_some()),
    (ink::LEG, "this leg", |look, course| {
        !survey::way(look).is_empty() || course.is_some_and(|course| course.leg.0 < course.leg.1)
    }),
    (ink::PLAN, "plan", |look, course| is_ahead(look, course, ink::PLAN)),
    (ink::AHEAD, "plan", |look, course| is_ahead(look, course, ink::AHEAD)),
    (ink::WAY, "way between", |look, course| {
        course.is_some_and(|course| course::parts(look, course).iter().any(|part| part.1))
    }),
    (ink::OFFER, "better plan", |look, _| course::offer(look).is_some()),
    (ink::OTHER, "compared", |look, _| course::compared(look).is_some()),
    (ink::TETHER, "tether", |look, _| {
        let line = look.run.tether.as_ref().map(|tether| &tether.line);
        line.is_some_and(|line| line.windows(2).any(|pair| pair[0] != pair[1]))
    }),
    (ink::CABLE, "tether, true", |look, _| {
        look.run.tether.as_ref().is_some_and(|tether| !tether.lies.is_empty())
    }),
    (ink::TRAIL, "trail", |look, _| course::shows_trail(look)),
    (ink::OTHER, RUN_B, |look, _| {
        let has_other = look.model.live.replay.as_ref().is_some_and(|replay| replay.other.is_some());
        has_other && look.model.ui.screen == Screen::Mission
    }),
    (ink::SHADOW, "shadow", |look, _| look.run.shown_shadow().is_some()),
    (ink::DRIVEN, "driven", |look, course| {
        look.model.ui.screen == Screen::Plan && course.is_some_and(|course| course.driven.0 < course.driven.1)
    }),
];

/// Whether the plan ahead is drawn, with the given ink.
fn is_ahead(look: &Look, course: Option<&Course>, ink: Ink) -> bool {
    course::plan_ink(look) == ink && course.is_some_and(|course| course.ahead.0 < course.ahead.1)
}

/// The sample of a kind of line.
pub(super) fn mark(ink: Ink, word: &str, has_dots: bool) -> String {
    match labels::Arrow::of(ink) {
        _ if !has_dots => ink.letter.to_string().repeat(2),
        // The trail of a run has no arrows.
        Some(arrow) if word != RUN_B => format!("{}{arrow}", ink.pattern.sample(MARK as u16 - 1)),
        _ => ink.pattern.sample(MARK as u16),
    }
}

/// The entry of a kind of line.
pub(super) fn entry(look: &Look, ink: Ink, word: &'static str) -> Entry {
    Entry { role: ink.role, mark: mark(ink, word, look.caps.glyphs.has_dots()), word: word.into() }
}

/// The lines that are drawn.
pub(super) fn shown(look: &Look, window: Window) -> Vec<Entry> {
    let course = course::course(look);
    let every = course::thinnings(look, window)[0].every;
    let lines = LINES.into_iter().filter(|(.., is_drawn)| is_drawn(look, course.as_ref()));
    let written = |(ink, word, _): (Ink, &'static str, IsDrawn)| {
        let entry = entry(look, ink, word);
        let is_thinned = every > 1 && matches!(ink, ink::PLAN | ink::AHEAD);
        if is_thinned {
            Entry { word: format!("{word}, every {} lane", ordinal(every)).into(), ..entry }
        } else {
            entry
        }
    };
    lines.map(written).collect()
}

/// A number as a word that counts: `3rd`, `15th`.
fn ordinal(n: usize) -> String {
    let end = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{end}")
}

/// The planner's drawings that are large enough to be seen in the window.
pub(super) fn drawings(look: &Look, window: Window) -> Vec<Entry> {
    let is_seen = |drawing: &&Drawing| {
        let points = drawn::points(drawing);
        let is_long = points.iter().any(|point| (point - points[0]).norm() >= window.column_m);
        is_long && points.iter().any(|point| window.cell_of(*point).is_some())
    };
    let seen: Vec<Ink> = drawn::shown(look).iter().filter(is_seen).map(drawn::ink).collect();
    let kinds = drawn::KINDS.into_iter().filter(|(ink, _)| seen.contains(ink));
    kinds.map(|(ink, word)| entry(look, ink, word)).collect()
}
