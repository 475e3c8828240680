//! Forecasts of how a held mission would continue with different planners: paths on the map, and figures side by
//! side.

use super::look::{Look, Parts, fill};
use super::{map, text};
use crate::model::ui::Arrangement;
use crate::model::{Candidate, Forecast, WhatIf};
use crate::theme::Role;
use mission::Outlook;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of a label, columns.
const LABEL: usize = 11;
/// Width of the table on a wide screen, columns.
const TABLE: u16 = 66;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect, arrangement: Arrangement) {
    let Some(what_if) = &look.model.live.what_if else { return };
    let table_area = if arrangement == Arrangement::Wide {
        let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(TABLE)]).areas(area);
        map::draw(look, frame, left);
        right
    } else {
        area
    };
    let title = format!("What if, from T+{}", text::clock(what_if.t_s));
    let note = format!("{} of {} computed", what_if.n_done(), what_if.candidates.len());
    let block = look.block(Role::Focus, &title, &note);
    let columns = usize::from(block.inner(table_area).width);
    let mut rows = table(what_if, columns);
    rows.push(Parts::new());
    rows.extend(remarks(what_if, columns));
    fill(frame, table_area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

fn table(what_if: &WhatIf, columns: usize) -> Vec<Parts> {
    let width = columns.saturating_sub(LABEL + 1) / what_if.candidates.len().max(1);
    let row = |label: &str, value: &dyn Fn(usize, &Candidate) -> String| -> Parts {
        let cells = what_if.candidates.iter().enumerate().map(|(index, candidate)| {
            let role = if index == what_if.selected { Role::Title } else { Role::Text };
            (role, format!("{:>width$}", text::fit(&value(index, candidate), width.saturating_sub(1))))
        });
        std::iter::once((Role::Dim, format!(" {label:<LABEL$}"))).chain(cells).collect()
    };
    let mut rows = vec![
        row("", &|index, _| {
            let mark = if index == what_if.selected { ">" } else { "" };
            let letter = char::from(b'A' + index as u8);
            format!("{mark}{letter}{}", if index == 0 { " current" } else { "" })
        }),
        row("planner", &|_, candidate| candidate.choice.id.clone()),
    ];
    for (label, figure) in FIGURES {
        rows.push(row(label, &|_, candidate| match &candidate.made {
            Some(Ok(Forecast { outlook, .. })) => figure(outlook),
            Some(Err(_)) => "-".into(),
            None if label == FIGURES[0].0 => progress(candidate),
            None => String::new(),
        }));
    }
    rows
}

fn progress(candidate: &Candidate) -> String {
    candidate
        .at
        .map_or_else(|| "waiting".into(), |share| format!("{} %", text::number((100.0 * share).floor(), 0)))
}

type Figure = fn(&Outlook) -> String;

const FIGURES: [(&str, Figure); 8] = [
    ("end", |outlook| outlook.outcome.map_or_else(|| "HELD".into(), |outcome| outcome.word().to_uppercase())),
    ("after", |outlook| text::clock(outlook.after_s)),
    ("path", |outlook| format!("{} m", text::number(outlook.length_m, 1))),
    ("reachable", |outlook| format!("{} %", text::percent(outlook.reachable))),
    ("clearance", |outlook| format!("{} m", text::number(outlook.clearance_min_m, 2))),
    ("tether out", |outlook| {
        outlook.tether_length_max_m.map_or_else(|| "-".into(), |m| format!("{} m", text::number(m, 1)))
    }),
    ("wrap", |outlook| {
        outlook
            .wrap_max_rad
            .map_or_else(|| "-".into(), |rad| format!("{}°", text::number(rad.to_degrees(), 0)))
    }),
    ("parameters", |outlook| match outlook.choice.parameters.len() {
        0 => "defaults".into(),
        n => format!("{n} changed"),
    }),
];

/// How the selected forecast ends, and what the forecasts are based on.
fn remarks(what_if: &WhatIf, columns: usize) -> Vec<Parts> {
    let selected = what_if.candidate().map(|candidate| match &candidate.made {
        Some(Ok(forecast)) => (Role::Text, format!("{}: {}.", candidate.choice.id, forecast.outlook.reason)),
        Some(Err(why)) => (Role::Warn, format!("{}: {why}.", candidate.choice.id)),
        None => (Role::Watch, format!("{}: being computed.", candidate.choice.id)),
    });
    let basis = (
        Role::Dim,
        "Based on the current estimate and map: obstacles not found yet are not included. The mission and \
        its recording are not affected; choosing another planner asks first and does not move the robot."
            .to_owned(),
    );
    let set = what_if.candidate().filter(|candidate| !candidate.choice.parameters.is_empty());
    let set = set.map(|candidate| {
        let values = candidate.choice.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
        (Role::Text, format!("{} with {}.", candidate.choice.id, values.collect::<Vec<_>>().join(", ")))
    });
    let words = set.into_iter().chain(selected).chain([basis]);
    words
        .flat_map(|(role, words)| {
            text::wrap(&words, columns.saturating_sub(2))
                .into_iter()
                .map(move |line| vec![(role, format!(" {line}"))])
        })
        .collect()
}
