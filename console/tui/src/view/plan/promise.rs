//! What a plan promises, beside the limits of the mission; beside it what a second plan promises or, during a mission,
//! what holds now.

use crate::model::{Pane, Run};
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use account::{Estimate, estimate::Worst};
use mission::{MissionConfig, Phase};
use ratatui::Frame;
use ratatui::layout::Rect;

/// Width of a label, of a figure and of a limit, columns.
const LABEL: usize = 10;
const VALUE: usize = 11;
const LIMIT: usize = 9;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let block = look.pane(Pane::Promise, "What it promises", "limit");
    let columns = usize::from(block.inner(area).width);
    let (live, run) = (&look.model.live, look.run);
    let ghost =
        live.plans.ghost.as_ref().and_then(|ghost| Some((ghost, ghost.made.as_ref()?.as_ref().ok()?)));
    let has_started = *run.phase() != Phase::Waiting;
    let second = match ghost {
        _ if has_started => Some((Role::Title, "now".to_owned())),
        Some((ghost, _)) => Some((Role::Ghost, named(&ghost.choice.id, "compared", columns))),
        None => None,
    };
    let mine = match second {
        None => String::new(),
        Some(_) if has_started => "promised".into(),
        Some(_) => named(run.planner_id().unwrap_or("-"), "active", columns),
    };
    let first_width =
        columns.saturating_sub(1 + LABEL + LIMIT + second.as_ref().map_or(0, |_| second_width(columns)));
    let mine = (Role::Title, mine);
    let mut rows = vec![row(("", mine, second.clone(), String::new()), columns)];
    let Some(mission) = run.about.as_ref().map(|about| &about.mission) else {
        return fill(frame, area, block, Vec::new());
    };
    for figure in FIGURES {
        let limit = (figure.limit)(mission);
        let of = |estimate: Option<&Estimate>, role: Role, room: usize| {
            let found = estimate.and_then(figure.promised);
            found.map_or((role, "-".into()), |found| {
                let role = if found.is_beyond(figure, limit) { Role::Warn } else { role };
                (role, found.words(figure, limit, room))
            })
        };
        let second = second.as_ref().map(|_| match ghost.filter(|_| !has_started) {
            Some((_, plan)) => of(Some(&plan.estimate), Role::Ghost, second_width(columns)),
            None => (Role::Text, (figure.now)(run).unwrap_or_else(|| "-".into())),
        });
        let mut mine = of(live.promised(), Role::Text, first_width.saturating_sub(1));
        let lanes = run.planning.plan.as_ref().map_or(0, |plan| plan.lanes.len());
        let with_lanes = format!("{}, {lanes} lanes", mine.1);
        if figure.label == "path" && lanes > 0 && text::width(&with_lanes) < first_width {
            mine.1 = with_lanes;
        }
        rows.push(row(
            (figure.label, mine, second, limit.map_or_else(String::new, |limit| figure.said(limit))),
            columns,
        ));
    }
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
}

/// The figures that fit into a line, the most important first.
pub(super) fn in_a_line(look: &Look, columns: usize) -> String {
    let Some(estimate) = look.model.live.promised() else { return "Estimate not known yet.".into() };
    let limits = look.run.about.as_ref().map(|about| &about.mission);
    let mut line = String::new();
    for figure in FIGURES {
        let Some(found) = (figure.promised)(estimate) else { continue };
        let limit =
            limits.and_then(figure.limit).filter(|_| found.is_beyond(figure, limits.and_then(figure.limit)));
        let over = limit.map_or_else(String::new, |limit| format!(" (limit {})", figure.said(limit)));
        let words = format!("{} {}{over}", figure.label, figure.said(found.value));
        let gap = if line.is_empty() { "" } else { "  " };
        if text::width(&line) + gap.len() + text::width(&words) <= columns {
            line = line + gap + &words;
        }
    }
    line
}

/// The name of a planner at the head of a column, or another word if the name is too long; the pane above names it.
fn named(id: &str, word: &str, columns: usize) -> String {
    text::wording([id.to_owned(), word.to_owned()], second_width(columns).saturating_sub(1))
}

fn second_width(columns: usize) -> usize {
    columns.saturating_sub(1 + LABEL + LIMIT) / 2
}

/// A cell in the table: role and text.
type Cell = (Role, String);

fn row((label, mine, second, limit): (&str, Cell, Option<Cell>, String), columns: usize) -> Parts {
    let second_width = second.as_ref().map_or(0, |_| second_width(columns));
    let first = columns.saturating_sub(1 + LABEL + LIMIT + second_width);
    let mut parts =
        vec![(Role::Dim, format!(" {}", text::column(label, LABEL))), (mine.0, text::column(&mine.1, first))];
    parts.extend(second.map(|(role, words)| (role, text::column(&words, second_width))));
    parts.push((Role::Dim, format!("{limit:>width$}", width = LIMIT - 1)));
    parts
}

/// A figure of the estimate.
#[derive(Clone, Copy)]
struct Figure {
    label: &'static str,
    /// The letter of its place on the map; empty if it has no place.
    letter: &'static str,
    /// The text in front of the value, and the unit behind it.
    around: (&'static str, &'static str),
    decimals: usize,
    promised: fn(&Estimate) -> Option<Found>,
    limit: fn(&MissionConfig) -> Option<f64>,
    /// Whether the figure must not be below its limit, instead of above it.
    is_least: bool,
    /// What holds during the mission.
    now: fn(&Run) -> Option<String>,
}

/// A promised value: where it is reached, or what it is about.
struct Found {
    value: f64,
    at: Option<world::Point>,
    note: String,
}

impl Found {
    fn of(value: f64) -> Self {
        Self { value, at: None, note: String::new() }
    }

    fn worst(worst: Worst) -> Self {
        Self { value: worst.value, at: Some(worst.at), note: String::new() }
    }

    fn is_beyond(&self, figure: Figure, limit: Option<f64>) -> bool {
        // The planner keeps to the limit exactly, so that rounding must not turn it into a fault.
        let slack = 0.5 * 10.0_f64.powi(-(figure.decimals as i32));
        limit.is_some_and(|limit| {
            let by = if figure.is_least { limit - self.value } else { self.value - limit };
            by > slack
        })
    }

    /// The value, with its place or its note if there is room.
    fn words(&self, figure: Figure, limit: Option<f64>, room: usize) -> String {
        let mark = if self.is_beyond(figure, limit) { "!" } else { "" };
        let value = format!("{}{mark}", figure.said(self.value));
        let padded = text::column(&value, VALUE.max(text::width(&value) + 1));
        let place = self.at.map(|at| format!("{padded}{} {}", figure.letter, text::place(at)));
        let noted = format!("{value}{}", self.note);
        let lettered = self.at.map(|_| format!("{padded}{}", figure.letter));
        text::wording([place.unwrap_or(noted), lettered.unwrap_or_else(|| value.clone()), value], room)
    }
}

impl Figure {
    /// A value with its unit.
    fn said(self, value: f64) -> String {
        let (before, unit) = self.around;
        match unit {
            "clock" => text::clock(value),
            "%" => format!("{before}{} %", text::percent(value)),
            unit => format!("{before}{}{unit}", text::number(value, self.decimals)),
        }
    }
}

const fn figure(label: &'static str, letter: &'static str, unit: &'static str, decimals: usize) -> Figure {
    Figure {
        label,
        letter,
        around: ("", unit),
        decimals,
        promised: |_| None,
        limit: |_| None,
        is_least: false,
        now: |_| None,
    }
}

/// The figures in table order.
const FIGURES: [Figure; 8] = [
    Figure {
        promised: |e| Some(Found::of(e.time_s)),
        limit: |m| Some(m.time_limit_s),
        now: |run| Some(format!("{} left", text::clock(run.left_s()?))),
        ..figure("time", "", "clock", 0)
    },
    Figure {
        promised: |e| Some(Found::of(e.length_m)),
        now: |run| {
            let plan = run.planning.plan.as_ref()?;
            Some(format!("{} m left", text::number(plan.rest_m(run.progress.as_ref()?.target), 1)))
        },
        ..figure("path", "", " m", 1)
    },
    Figure {
        promised: |e| Some(Found { note: " of reachable".into(), ..Found::of(e.reachable?) }),
        now: |run| Some(format!("{} %", text::percent(run.progress.as_ref()?.covered_reachable))),
        ..figure("scanned", "", "%", 1)
    },
    Figure {
        promised: |e| Some(Found::worst(e.clearance_min?)),
        limit: |m| Some(m.clearance_m),
        is_least: true,
        ..figure("gap", "c", " m", 2)
    },
    Figure {
        promised: |e| Some(Found::worst(e.tether.as_ref()?.length_max)),
        limit: |m| Some(m.tether.as_ref()?.limits.reel_length_m),
        now: |run| Some(format!("{} m", text::number(run.tether.as_ref()?.length_m, 1))),
        ..figure("tether", "t", " m", 1)
    },
    Figure {
        promised: |e| {
            let tether = e.tether.as_ref()?;
            let on =
                if tether.wrapped.is_empty() { String::new() } else { format!(" on {}", tether.wrapped) };
            Some(Found { note: on, ..Found::of(tether.wrap_max.value.to_degrees()) })
        },
        limit: |m| Some(m.tether.as_ref()?.limits.wrap_max_rad.to_degrees()),
        now: |run| {
            let most = run.tether.as_ref()?.largest().map_or(0.0, |contact| contact.wrap_rad.abs());
            Some(format!("{}°", text::number(most.to_degrees(), 0)))
        },
        ..figure("wrap", "w", "°", 0)
    },
    Figure {
        around: ("±", " m"),
        promised: |e| Some(Found::worst(e.accuracy_worst?)),
        limit: |m| Some(m.position_limit_m),
        now: |run| Some(format!("±{} m", text::number(run.position.error_m()?, 2))),
        ..figure("AE error", "e", " m", 2)
    },
    Figure {
        promised: |e| Some(Found { note: " of path".into(), ..Found::of(e.without_fix_m) }),
        ..figure("no fix on", "", " m", 1)
    },
];
