//! The figures that a plan promises, with the limits of the mission. A second column shows the figures of a second plan
//! or, during a mission, the current figures.

use super::along;
use crate::model::{Pane, Run, Tether};
use crate::theme::Role;
use crate::view::look::{Look, Parts, fill};
use crate::view::text;
use account::{Estimate, estimate::Worst};
use mission::{MissionConfig, Phase};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};

/// Width of a label, of a figure and of a limit, columns.
const LABEL: usize = 12;
const VALUE: usize = 9;
const LIMIT: usize = 8;
/// Width of a clock that is left, with the blank behind it, columns.
const LEFT: usize = 14;
/// The minimum width at which limits are shown beside two columns of figures, columns.
const WITH_LIMIT: usize = 42;

pub(super) fn draw(look: &Look, frame: &mut Frame, area: Rect) {
    let second = second(look);
    let columns = usize::from(look.pane(Pane::Promise, "", "").inner(area).width);
    let widths = Widths::new(columns, second.as_ref());
    let note = if widths.limit > 0 { "limit" } else { "" };
    let title = title(look, columns.saturating_sub(note.len() + 5));
    let block = look.pane(Pane::Promise, &title, note);
    let Some(mission) = look.run.about.as_ref().map(|about| &about.mission) else {
        return fill(frame, area, block, Vec::new());
    };
    if look.run.is_survey() {
        let lines = of_survey(look, mission, columns).into_iter().map(|parts| look.line(parts)).collect();
        return fill(frame, area, block, lines);
    }
    let mut rows: Vec<Parts> =
        second.as_ref().map(|second| head(look, second, &widths)).into_iter().collect();
    let cell = |figure: Figure, estimate: Option<&Estimate>, (role, room): (Role, usize)| {
        let limit = (figure.warns)(mission).or_else(|| (figure.limit)(mission));
        estimate.and_then(|estimate| (figure.promised)(estimate, look.run)).map_or(
            (role, "-".into()),
            |found| {
                let role = if found.is_beyond(figure, limit) { Role::Warn } else { role };
                (role, found.words(figure, limit, room))
            },
        )
    };
    let estimate = look.model.live.promised();
    // A figure that does not apply to this mission has no row, for example a figure of the tether in a mission without
    // one.
    let has =
        |figure: &Figure| estimate.is_none_or(|estimate| (figure.promised)(estimate, look.run).is_some());
    let computes = |figure: &Figure| figure.label != FIX_LEVEL || look.run.level.is_some();
    for figure in FIGURES.into_iter().filter(has).filter(computes) {
        let mut mine = cell(figure, estimate, (Role::Text, widths.first));
        let lanes = look.model.live.plans.lanes;
        // While a plan is being made, the lanes are those of the plan before.
        if figure.label == "path" && lanes > 0 && estimate.is_some() {
            mine.1 = text::wording(
                [format!("{}, {}", mine.1, text::counted(lanes, "lane")), mine.1],
                widths.first,
            );
        }
        let second = second.as_ref().map(|second| match second {
            Second::Now => (
                Role::Text,
                (figure.now)(look.run).map_or_else(|| "-".into(), |now| text::wording(now, widths.second)),
            ),
            Second::Compared(_, estimate) => cell(figure, Some(estimate), (Role::Ghost, widths.second)),
        });
        let limit = (figure.limit)(mission).map_or_else(String::new, |limit| figure.said(limit));
        rows.push(row(figure.label, &mine, second, &limit, &widths));
    }
    let [_, below] = Layout::vertical([Constraint::Length(rows.len() as u16 + 1), Constraint::Fill(1)])
        .areas(block.inner(area));
    fill(frame, area, block, rows.into_iter().map(|parts| look.line(parts)).collect());
    along::draw(look, frame, below);
}

/// The title; it names the planner that promised the figures if a different one drives now.
fn title(look: &Look, columns: usize) -> String {
    if look.run.is_survey() {
        return "Limits".into();
    }
    let brief = "Promised figures".to_owned();
    match look.model.live.promised_by_other() {
        Some(planner) => {
            let by = format!("{brief} (at the start, by {planner})");
            text::wording([by, format!("Promised by {planner}"), brief], columns)
        }
        None => brief,
    }
}

/// What a survey has instead of promised figures: the limits, with the figures as they are now.
fn of_survey(look: &Look, mission: &MissionConfig, columns: usize) -> Vec<Parts> {
    let widths = Widths::new(columns.max(WITH_LIMIT), None);
    let is_waiting = *look.run.phase() == Phase::Waiting;
    let limited = FIGURES.into_iter().filter_map(|figure| Some((figure, (figure.limit)(mission)?)));
    let rows = limited.map(|(figure, limit)| {
        let limit = figure.said(limit);
        if columns < WITH_LIMIT {
            return vec![(Role::Text, format!(" {}: {limit}", figure.label))];
        }
        let now = (figure.now)(look.run).filter(|_| !is_waiting);
        let now = now.map_or_else(String::new, |now| text::wording(now, widths.first));
        row(figure.label, &(Role::Text, now), None, &limit, &widths)
    });
    let words = text::wrap(NO_PROMISE, columns.saturating_sub(2)).into_iter();
    words.map(|words| vec![(Role::Text, format!(" {words}"))]).chain(rows).collect()
}

/// Why a survey has no promised figures.
const NO_PROMISE: &str = "A survey promises no figures; it keeps to these limits.";

/// A figure with a limit, as it is now.
pub(in crate::view) struct Watched {
    pub label: &'static str,
    pub now: String,
    pub limit: String,
}

/// The figures that have a limit and a current value.
pub(in crate::view) fn watched(run: &Run) -> Vec<Watched> {
    let mission = run.about.as_ref().map(|about| &about.mission);
    let of = |figure: Figure| {
        let limit = figure.said((figure.limit)(mission?)?);
        let [now, _] = (figure.now)(run)?;
        Some(Watched { label: figure.label, now, limit })
    };
    FIGURES.into_iter().filter_map(of).collect()
}

/// The contents of the second column.
enum Second<'a> {
    /// The current figures, once the mission has started.
    Now,
    /// The figures that a different planner's plan promises.
    Compared(&'a str, &'a Estimate),
}

fn second<'a>(look: &Look<'a>) -> Option<Second<'a>> {
    if *look.run.phase() != Phase::Waiting {
        return Some(Second::Now);
    }
    let ghost = look.model.live.plans.ghost.as_ref()?;
    let plan = ghost.made.as_ref()?.as_ref().ok()?;
    Some(Second::Compared(&ghost.choice.id, &plan.estimate))
}

/// The figures that fit into a line: those beyond their limits, then the others in table order.
pub(super) fn in_a_line(look: &Look, columns: usize) -> String {
    if look.run.is_survey() {
        return NO_PROMISE.into();
    }
    let Some(estimate) = look.model.live.promised() else { return "Estimate not known yet.".into() };
    let mission = look.run.about.as_ref().map(|about| &about.mission);
    let mut figures: Vec<(bool, String)> = Vec::new();
    for figure in FIGURES {
        let Some(found) = (figure.promised)(estimate, look.run) else { continue };
        let limits = [(figure.limit, ""), (figure.warns, "preferred ")];
        let limits = limits.map(|(limit, word)| (mission.and_then(limit), word));
        let over = limits.into_iter().find(|(limit, _)| found.is_beyond(figure, *limit));
        let over = over.and_then(|(limit, word)| Some(format!(" > {word}{}", figure.said(limit?))));
        let is_beyond = over.is_some();
        let over = over.unwrap_or_default();
        figures.push((is_beyond, format!("{} {}{over}", figure.brief, figure.said(found.value))));
    }
    figures.sort_by_key(|(is_beyond, _)| !is_beyond);
    let mut line = "Promised:".to_owned();
    for (_, words) in figures {
        let gap = if line.ends_with(':') { " " } else { "  " };
        if text::width(&line) + gap.len() + text::width(&words) <= columns {
            line = line + gap + &words;
        }
    }
    line
}

/// A cell in the table: role and text.
type Cell = (Role, String);

/// The widths of the columns after the label, without the blanks between them; 0 for a column that is left out.
struct Widths {
    first: usize,
    second: usize,
    limit: usize,
}

impl Widths {
    fn new(columns: usize, second: Option<&Second>) -> Self {
        let has_second = second.is_some();
        // A second column takes precedence over the limits: a figure beyond its limit is marked.
        let limit = if has_second && columns < WITH_LIMIT { 0 } else { LIMIT };
        let room = columns.saturating_sub(1 + LABEL + limit + usize::from(limit > 0));
        let second = match second {
            // A figure that is left says so, if there is room.
            Some(Second::Now) if room > VALUE + LEFT => (room / 2).max(LEFT),
            Some(_) => room / 2,
            None => 0,
        };
        Self { first: room.saturating_sub(second + 1), second: second.saturating_sub(1), limit }
    }
}

/// The heads of the columns. A name that is too long is replaced; the pane above names the planners.
fn head(look: &Look, second: &Second, widths: &Widths) -> Parts {
    let fits = |name: &str, word: &str, width| text::wording([name.to_owned(), word.to_owned()], width);
    let (mine, second) = match second {
        Second::Now if widths.second + 1 < LEFT => ("promised".into(), (Role::Title, "left/now".into())),
        Second::Now => ("promised".into(), (Role::Title, "now".into())),
        Second::Compared(id, _) => (
            fits(look.run.planner_id().unwrap_or("-"), "active", widths.first),
            (Role::Ghost, fits(id, "compared", widths.second)),
        ),
    };
    row("", &(Role::Title, mine), Some(second), "", widths)
}

fn row(label: &str, mine: &Cell, second: Option<Cell>, limit: &str, widths: &Widths) -> Parts {
    let mut parts = vec![
        (Role::Dim, format!(" {}", text::column(label, LABEL))),
        (mine.0, format!("{} ", text::column(&mine.1, widths.first))),
    ];
    parts.extend(second.map(|(role, words)| (role, format!("{} ", text::column(&words, widths.second)))));
    if widths.limit > 0 {
        parts.push((Role::Dim, format!("{limit:>width$}", width = widths.limit)));
    }
    parts
}

/// A figure of the estimate.
#[derive(Clone, Copy)]
struct Figure {
    label: &'static str,
    /// The label where all figures are in one line.
    brief: &'static str,
    /// The letter of its place on the map; empty if it has no place.
    letter: &'static str,
    /// The text in front of the value, and the unit behind it.
    around: (&'static str, &'static str),
    decimals: usize,
    promised: fn(&Estimate, &Run) -> Option<Found>,
    limit: fn(&MissionConfig) -> Option<f64>,
    /// The value above which the figure is marked, if that is not the limit.
    warns: fn(&MissionConfig) -> Option<f64>,
    /// Whether the figure must not be below its limit, instead of above it.
    is_least: bool,
    /// The current figure during the mission, in a longer and a shorter wording.
    now: fn(&Run) -> Option<[String; 2]>,
}

/// A promised value, with the place where it is reached or the object that it is about.
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
        // The planner keeps exactly to the limit, so rounding must not make the value appear to violate it.
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
        let noted = format!("{value}{}", self.note);
        let place = self.at.map(|at| {
            format!(
                "{}{} {}",
                text::column(&noted, VALUE.max(text::width(&noted) + 1)),
                figure.letter,
                text::place(at)
            )
        });
        let lettered = self.at.filter(|_| self.note.is_empty()).map(|_| format!("{padded}{}", figure.letter));
        let short = lettered.unwrap_or_else(|| noted.clone());
        text::wording([place.unwrap_or(noted), short, value], room)
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
        brief: label,
        letter,
        around: ("", unit),
        decimals,
        promised: |_, _| None,
        limit: |_| None,
        warns: |_| None,
        is_least: false,
        now: |_| None,
    }
}

/// The label of the forecast protection level, which only a mission with a stated risk has.
const FIX_LEVEL: &str = "fix level";

/// The figures in table order.
const FIGURES: [Figure; 12] = [
    Figure {
        promised: |e, _| Some(Found::of(e.time_s)),
        limit: |m| Some(m.time_limit_s),
        now: |run| Some(left(text::clock(run.left_s()?))),
        ..figure("time", "", "clock", 0)
    },
    Figure {
        promised: |e, _| Some(Found::of(e.length_m)),
        now: |run| {
            let (plan, robot) = (run.planning.plan.as_ref()?, run.position.pose?.position);
            Some(left(format!("{} m", text::number(plan.rest_m(robot, run.progress.as_ref()?.done), 1))))
        },
        ..figure("path", "", " m", 1)
    },
    Figure {
        promised: |e, _| Some(Found { note: " of reachable".into(), ..Found::of(e.reachable?) }),
        now: |run| Some(alike(format!("{} %", text::percent(run.progress.as_ref()?.covered_reachable)))),
        ..figure("scanned", "", "%", 1)
    },
    Figure {
        promised: |e, _| Some(Found::worst(e.clearance_min?)),
        limit: |m| Some(m.clearance_m),
        is_least: true,
        ..figure("clearance", "c", " m", 2)
    },
    Figure {
        promised: |e, _| Some(Found::worst(e.tether.as_ref()?.length_max)),
        limit: |m| Some(m.tether.as_ref()?.limits.reel_length_m),
        now: |run| of_tether(run, |tether| Some(format!("{} m", text::number(tether.length_m, 1)))),
        ..figure("tether", "t", " m", 1)
    },
    Figure {
        promised: |e, _| {
            let tether = e.tether.as_ref()?;
            let on =
                if tether.wrapped.is_empty() { String::new() } else { format!(" on {}", tether.wrapped) };
            let at = (tether.wrap_max.value > 0.0).then_some(tether.wrap_max.at);
            Some(Found { note: on, at, ..Found::of(tether.wrap_max.value.to_degrees()) })
        },
        limit: |m| Some(m.tether.as_ref()?.limits.wrap_max_rad.to_degrees()),
        now: |run| of_tether(run, |tether| Some(format!("{}°", text::number(tether.largest_deg(), 0)))),
        ..figure("wrap", "w", "°", 0)
    },
    Figure {
        promised: |e, run| {
            let worst = e.tether.as_ref()?.pull_max_n?;
            let preferred_n = run.about.as_ref()?.mission.tether.as_ref()?.reel?.preferred_n();
            let is_much = worst.value > preferred_n;
            let note = is_much.then(|| format!(" (preferred {} N)", text::number(preferred_n, 1)));
            Some(Found { note: note.unwrap_or_default(), ..Found::worst(worst) })
        },
        limit: |m| Some(m.tether.as_ref()?.reel?.pull_n),
        warns: |m| Some(m.tether.as_ref()?.reel?.preferred_n()),
        now: |run| of_tether(run, |tether| Some(format!("{} N", text::number(tether.pull_n?, 1)))),
        ..figure("reel needs", "p", " N", 1)
    },
    Figure {
        promised: |e, _| Some(Found::worst(e.tether.as_ref()?.own_gap_m?)),
        ..figure("own gap", "", " m", 2)
    },
    Figure {
        brief: "AE",
        around: ("±", " m"),
        promised: |e, _| Some(Found::worst(e.accuracy_worst?)),
        limit: |m| Some(m.position_limit_m),
        now: |run| Some(alike(format!("±{} m", text::number(run.position.error_m()?, 2)))),
        ..figure("AE error", "e", " m", 2)
    },
    Figure {
        promised: |_, run| Some(Found { note: " median".into(), ..Found::of(run.level?.median_m?) }),
        ..figure(FIX_LEVEL, "", " m", 2)
    },
    Figure {
        promised: |e, _| Some(Found { note: " of path".into(), ..Found::of(e.without_fix_m) }),
        ..figure("no fix on", "", " m", 1)
    },
    Figure {
        promised: |_, run| {
            let whole = run.coverage.as_ref().filter(|_| run.covers())?.whole();
            Some(Found { note: " of the floor".into(), ..Found::of(whole.unreachable + whole.margin) })
        },
        ..figure("unreachable", "", "%", 1)
    },
];

/// A value as the amount that is left, in a longer and a shorter wording; the head of a narrow column says `left`, too.
fn left(value: String) -> [String; 2] {
    [format!("{value} left"), value]
}

/// A figure of the tether; a torn tether has none.
fn of_tether(run: &Run, figure: impl FnOnce(&Tether) -> Option<String>) -> Option<[String; 2]> {
    let tether = run.tether.as_ref()?;
    if tether.is_broken { Some(alike("torn".into())) } else { figure(tether).map(alike) }
}

fn alike(value: String) -> [String; 2] {
    [value.clone(), value]
}
