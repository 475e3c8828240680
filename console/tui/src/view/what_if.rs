//! Forecasts of how a held mission would continue with different planners: paths on the map, and figures side by
//! side.

use super::look::{Look, Parts, fill, ranked};
use super::{map, text};
use crate::model::ui::Arrangement;
use crate::model::{Candidate, Forecast, WhatIf};
use crate::theme::Role;
use mission::{MissionConfig, Outlook};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of a label, columns.
const LABEL: usize = 12;
/// Width of the table on a wide and on a large screen, columns.
const TABLE: (u16, u16) = (66, 100);
/// Columns from which a screen is large.
const LARGE: u16 = 170;
/// The minimum width of a candidate's column at which the difference from the first candidate is beside its value.
const DIFFERENCE: usize = 17;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(what_if) = &look.model.live.what_if else { return };
    let table_area = if arrangement == Arrangement::Wide {
        let table = if area.width >= LARGE { TABLE.1 } else { TABLE.0 };
        let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(table)]).areas(area);
        map::draw(look, frame, left);
        right
    } else {
        area
    };
    let title = format!("What if, from T+{}", text::clock(what_if.t_s));
    let inner = look.block(Role::Focus, "", "").inner(table_area);
    let (columns, height) = (usize::from(inner.width), usize::from(inner.height));
    let table = table(look, what_if, columns);
    // Why a forecast is held comes before the figures that matter least.
    let shown = [Remarks::All, Remarks::Reasons, Remarks::Selected]
        .map(|which| (which, remarks(what_if, which, columns)));
    let fits = shown.iter().position(|(_, remarks)| table.len() + remarks.len() <= height);
    let (which, remarks) = shown.into_iter().nth(fits.unwrap_or(2)).unwrap_or((Remarks::All, Vec::new()));
    let done = format!("{} of {} computed", what_if.n_done(), what_if.candidates.len());
    let others = "<previous-candidate> <next-candidate> other reasons";
    let has_others = which == Remarks::Selected && what_if.candidates.len() > 1;
    let notes = [if has_others { look.keys(&format!("{done}  {others}")) } else { done.clone() }, done];
    let note = text::wording(notes, usize::from(table_area.width).saturating_sub(text::width(&title) + 8));
    let block = look.block(Role::Focus, &title, &note);
    let mut lines = ranked(
        table.into_iter().map(|(rank, parts)| (rank, look.line(parts))).collect(),
        height.saturating_sub(remarks.len()).max(LEAST),
    );
    if height > lines.len() + remarks.len() {
        lines.push(look.line(Parts::new()));
    }
    lines.extend(remarks.into_iter().map(|parts| look.line(parts)));
    fill(frame, table_area, block, lines);
}

/// The fewest rows of the table: letter, planner, end.
const LEAST: usize = 3;

/// The table, its rows with their ranks: those with the highest numbers are dropped first.
fn table(look: &Look, what_if: &WhatIf, columns: usize) -> Vec<(u8, Parts)> {
    let width = columns.saturating_sub(LABEL + 1) / what_if.candidates.len().max(1);
    let row = |label: &str, value: &dyn Fn(usize, &Candidate) -> (Role, String)| -> Parts {
        let cells = what_if.candidates.iter().enumerate().map(|(index, candidate)| {
            let (role, words) = value(index, candidate);
            let role = if role == Role::Text && index == what_if.selected { Role::Title } else { role };
            (role, format!("{:>width$}", text::fit(&words, width.saturating_sub(1))))
        });
        std::iter::once((Role::Dim, format!(" {label:<LABEL$}"))).chain(cells).collect()
    };
    let letters = row("", &|index, _| {
        let mark = if index == what_if.selected { ">" } else { "" };
        let letter = char::from(b'A' + index as u8);
        (Role::Text, format!("{mark}{letter}{}", if index == 0 { " current" } else { "" }))
    });
    let mut rows = vec![
        (0, letters),
        (0, row("planner", &|_, candidate| (Role::Text, candidate.choice.id.clone()))),
        (0, row("end", &|_, candidate| end(candidate))),
        (4, row("tether", &|_, candidate| certificate(candidate))),
    ];
    let mission = look.run.about.as_ref().map(|about| &about.mission);
    let first = what_if.candidates.first().and_then(outlook);
    for figure in FIGURES {
        let cells = row(figure.label, &|index, candidate| {
            let Some(outlook) = outlook(candidate) else { return (Role::Dim, "-".into()) };
            let beside = (index > 0 && width >= DIFFERENCE).then_some(first).flatten();
            figure.cell(outlook, beside, mission)
        });
        rows.push((figure.rank, cells));
    }
    let parameters = row("parameters", &|_, candidate| match candidate.choice.parameters.len() {
        0 => (Role::Text, "defaults".into()),
        n => (Role::Text, format!("{n} changed")),
    });
    rows.push((8, parameters));
    rows
}

fn outlook(candidate: &Candidate) -> Option<&Outlook> {
    candidate.made.as_ref()?.as_ref().ok().map(|forecast| &forecast.outlook)
}

/// How a forecast ends, or its progress.
fn end(candidate: &Candidate) -> (Role, String) {
    match &candidate.made {
        Some(Ok(Forecast { outlook, .. })) => match outlook.outcome {
            Some(outcome) => (Role::Text, outcome.word().to_uppercase()),
            None => (Role::Hold, "! HELD".into()),
        },
        Some(Err(_)) => (Role::Warn, "! none".into()),
        None => (Role::Watch, progress(candidate)),
    }
}

fn progress(candidate: &Candidate) -> String {
    candidate
        .at
        .map_or_else(|| "waiting".into(), |share| format!("{} %", text::number((100.0 * share).floor(), 0)))
}

/// Whether every plan of the forecast is certified for the tether.
fn certificate(candidate: &Candidate) -> (Role, String) {
    match candidate.made.as_ref().and_then(|made| made.as_ref().ok()).map(|forecast| forecast.certified) {
        Some(Some(true)) => (Role::Good, "certified".into()),
        Some(Some(false)) => (Role::Warn, "! NOT cert.".into()),
        Some(None) | None => (Role::Dim, "-".into()),
    }
}

/// A figure of a forecast.
#[derive(Clone, Copy)]
struct Figure {
    label: &'static str,
    /// How soon the row is dropped if space is short: the highest number first.
    rank: u8,
    unit: &'static str,
    decimals: usize,
    value: fn(&Outlook) -> Option<f64>,
    /// The limit of the mission, and whether the value must not fall below it.
    limit: fn(&MissionConfig) -> Option<(f64, bool)>,
}

const fn figure(
    (label, rank): (&'static str, u8),
    unit: &'static str,
    decimals: usize,
    value: fn(&Outlook) -> Option<f64>,
    limit: fn(&MissionConfig) -> Option<(f64, bool)>,
) -> Figure {
    Figure { label, rank, unit, decimals, value, limit }
}

const FIGURES: [Figure; 6] = [
    figure(("ends after", 2), " min", 1, |o| Some(o.after_s / 60.0), |_| None),
    figure(("path", 5), " m", 1, |o| Some(o.length_m), |_| None),
    figure(("reachable", 1), " %", 1, |o| Some(world::coverage::percent(o.reachable)), |_| None),
    figure(("clearance", 3), " m", 2, |o| Some(o.clearance_min_m), |m| Some((m.clearance_m, true))),
    figure(
        ("tether out", 6),
        " m",
        1,
        |o| o.tether_length_max_m,
        |m| Some((m.tether.as_ref()?.limits.reel_length_m, false)),
    ),
    figure(
        ("wrap", 7),
        "°",
        0,
        |o| o.wrap_max_rad.map(f64::to_degrees),
        |m| Some((m.tether.as_ref()?.limits.wrap_max_rad.to_degrees(), false)),
    ),
];

impl Figure {
    /// The value with its unit, marked if it is beyond its limit, and its difference from the first candidate.
    fn cell(
        &self,
        outlook: &Outlook,
        first: Option<&Outlook>,
        mission: Option<&MissionConfig>,
    ) -> (Role, String) {
        let Some(value) = (self.value)(outlook) else { return (Role::Dim, "-".into()) };
        let scale = 10_f64.powi(self.decimals as i32);
        // Values that print the same are treated as equal.
        let shown = |value: f64| (value * scale).round();
        let is_beyond = mission.and_then(self.limit).is_some_and(|(limit, is_least)| {
            let (value, limit) = (shown(value), shown(limit));
            if is_least { value < limit } else { value > limit }
        });
        let difference = first.and_then(self.value).map(|first| (shown(value) - shown(first)) / scale);
        let difference = difference.filter(|by| by.is_finite()).map_or_else(String::new, |by| {
            let sign = if by >= 0.0 { "+" } else { "" };
            format!(" ({sign}{})", text::number(by, self.decimals))
        });
        let mark = if is_beyond { "! " } else { "" };
        let words = format!("{mark}{}{}{difference}", text::number(value, self.decimals), self.unit);
        (if is_beyond { Role::Warn } else { Role::Text }, words)
    }
}

/// The remarks that fit below the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Remarks {
    /// The reasons, and what the forecasts are based on.
    All,
    /// How the forecasts that do not complete the task end, and how the selected one ends.
    Reasons,
    /// How the selected forecast ends.
    Selected,
}

/// The remarks, in lines.
fn remarks(what_if: &WhatIf, which: Remarks, columns: usize) -> Vec<Parts> {
    let reason = |(index, candidate): (usize, &Candidate)| {
        let is_selected = index == what_if.selected;
        if which == Remarks::Selected && !is_selected {
            return None;
        }
        let letter = char::from(b'A' + index as u8);
        let (role, why) = match &candidate.made {
            Some(Ok(Forecast { outlook, .. })) if outlook.outcome.is_none() => {
                (Role::Hold, outlook.reason.clone())
            }
            Some(Ok(Forecast { outlook, .. })) if is_selected => (Role::Text, outlook.reason.clone()),
            Some(Err(why)) => (Role::Warn, why.clone()),
            None if is_selected => (Role::Watch, "being computed".to_owned()),
            Some(Ok(_)) | None => return None,
        };
        Some((role, format!("{letter} {}: {why}.", candidate.choice.id)))
    };
    let reasons = what_if.candidates.iter().enumerate().filter_map(reason);
    let basis = (
        Role::Dim,
        "Figures in brackets: difference from A. Based on the current estimate and map: obstacles not found yet \
        are not included. The mission and its recording are not affected; choosing another planner asks first \
        and does not move the robot."
            .to_owned(),
    );
    let set = what_if.candidate().filter(|candidate| !candidate.choice.parameters.is_empty());
    let set = set.map(|candidate| {
        let values = candidate.choice.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
        (Role::Text, format!("{} with {}.", candidate.choice.id, values.collect::<Vec<_>>().join(", ")))
    });
    let basis = Some(basis).filter(|_| which == Remarks::All);
    let set = set.filter(|_| which != Remarks::Selected);
    let words = reasons.chain(set).chain(basis);
    words
        .flat_map(|(role, words)| {
            text::wrap(&words, columns.saturating_sub(2))
                .into_iter()
                .map(move |line| vec![(role, format!(" {line}"))])
        })
        .collect()
}
