//! The values of commands: the choices, and the meaning of what is typed.

use crate::actions::{Kind, duration_s, moment_s};
use crate::guide;
use crate::model::ui::MapLayer;
use crate::model::{Cause, Model, Screen, Source, Speed, parameter};
use crate::theme::ThemeName;
use mission::{ParamKind, ParamValue, PlannerInfo, RangeFault, Severity, spelling::nearest};
use world::{Point, StationId, Vector};

/// A parsed value.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::update) enum Value {
    /// A speed of the simulation.
    Speed(Speed),
    /// An installed planner.
    Planner(PlannerInfo),
    /// A parameter of the planner and its value.
    Parameter { key: String, value: ParamValue },
    /// A scenario.
    Scenario(Source),
    /// The name of a past run.
    Run(String),
    /// A layer of the map.
    Layer(MapLayer),
    /// The offset of a place from the tank's centre, metres.
    Place(Vector),
    /// An event severity.
    Severity(Severity),
    /// A theme.
    Theme(ThemeName),
    /// A screen.
    Screen(Screen),
    /// The name of a preset.
    Preset(String),
    /// A duration, seconds.
    Duration(f64),
    /// An alarm.
    Alarm(Cause),
    /// An AE station.
    Station(StationId),
    /// A range fault.
    Fault(RangeFault),
    /// A corner of a box, tank frame, metres.
    Corner(Point),
    /// A moment of a run: mission time, seconds.
    Moment(f64),
    /// Any text.
    Text(String),
}

/// The values to choose from; `typed` is the beginning of the word.
pub(super) fn candidates(model: &Model, kind: Kind, typed: &str) -> Vec<String> {
    let all: Vec<String> = match kind {
        Kind::Speed => speeds(),
        Kind::Planner => model.console.planners.iter().map(|planner| planner.id.clone()).collect(),
        Kind::Parameter => parameters(model, typed),
        Kind::Scenario => scenarios(model).map(|(name, _)| name.to_owned()).collect(),
        Kind::Run => std::iter::once("latest").chain(runs(model)).map(str::to_owned).collect(),
        Kind::Layer => MapLayer::ALL.into_iter().map(word_of).collect(),
        Kind::Place => places(model).into_iter().map(|(name, _)| name).collect(),
        Kind::Severity => SEVERITIES.map(|(name, _)| name.to_owned()).into(),
        Kind::Theme => ThemeName::ALL.map(|theme| theme.name().to_owned()).into(),
        Kind::Screen => Screen::ALL.map(|screen| screen.name().to_lowercase()).into(),
        Kind::Preset => model.console.presets.iter().map(|preset| preset.name.clone()).collect(),
        Kind::Duration => ["20s", "1m", "5m", "15m"].map(str::to_owned).into(),
        Kind::Alarm => alarms(model).map(|(name, _)| name).collect(),
        Kind::Station => model.live.run.stations().iter().map(|station| station.name.clone()).collect(),
        Kind::Fault => ["dead", "offset="].map(str::to_owned).into(),
        Kind::Moment | Kind::Text | Kind::Corner => Vec::new(),
    };
    all.into_iter().map(|value| if value.contains(' ') { format!("\"{value}\"") } else { value }).collect()
}

/// Parses a typed word.
///
/// # Errors
/// Returns what is wrong and how to correct it, as a clause.
pub(super) fn read(model: &Model, kind: Kind, text: &str) -> Result<Value, String> {
    match kind {
        Kind::Speed => Speed::parse(text).map(Value::Speed),
        Kind::Parameter => read_parameter(model, text),
        Kind::Run => read_run(model, text).map(Value::Run),
        Kind::Text => Ok(Value::Text(text.to_owned())),
        Kind::Duration => duration_s(text).map(Value::Duration),
        Kind::Moment => moment_s(text).map(Value::Moment),
        Kind::Fault => read_fault(text).map(Value::Fault),
        Kind::Corner => read_corner(text).map(Value::Corner),
        Kind::Scenario if problem_of(model, text).is_some() => Err(format!(
            "scenario `{text}` cannot be opened: {}",
            problem_of(model, text).unwrap_or_default()
        )),
        _ => named(model, kind, text)
            .ok_or_else(|| wrong(&kind.to_string(), text, &candidates(model, kind, ""))),
    }
}

/// A value that is chosen by name.
fn named(model: &Model, kind: Kind, text: &str) -> Option<Value> {
    match kind {
        Kind::Planner => {
            let planner = model.console.planners.iter().find(|planner| planner.id == text)?;
            Some(Value::Planner(planner.clone()))
        }
        Kind::Scenario => scenarios(model)
            .find(|(name, _)| *name == text)
            .map(|(_, source)| Value::Scenario(source.clone())),
        Kind::Layer => MapLayer::ALL.into_iter().find(|layer| word_of(*layer) == text).map(Value::Layer),
        Kind::Place => {
            places(model).into_iter().find(|(name, _)| name == text).map(|(_, at)| Value::Place(at))
        }
        Kind::Severity => {
            SEVERITIES.iter().find(|(name, _)| *name == text).map(|(_, severity)| Value::Severity(*severity))
        }
        Kind::Theme => ThemeName::named(text).map(Value::Theme),
        Kind::Screen => {
            Screen::ALL.into_iter().find(|screen| screen.name().to_lowercase() == text).map(Value::Screen)
        }
        Kind::Preset => {
            let preset = model.console.presets.iter().find(|preset| preset.name == text)?;
            Some(Value::Preset(preset.name.clone()))
        }
        Kind::Alarm => alarms(model).find(|(name, _)| name == text).map(|(_, cause)| Value::Alarm(cause)),
        Kind::Station => {
            // The scenario's notation is accepted as well: ae.S3.
            let name = text.strip_prefix("ae.").unwrap_or(text);
            let station = model.live.run.stations().iter().find(|station| station.name == name)?;
            Some(Value::Station(station.id))
        }
        Kind::Speed
        | Kind::Parameter
        | Kind::Run
        | Kind::Text
        | Kind::Duration
        | Kind::Moment
        | Kind::Corner
        | Kind::Fault => None,
    }
}

/// The severities by name.
const SEVERITIES: [(&str, Severity); 4] = [
    ("info", Severity::Info),
    ("watch", Severity::Watch),
    ("warn", Severity::Warn),
    ("crit", Severity::Crit),
];

/// The message that nothing has this name, with either the nearest name or the list of all names.
fn wrong(what: &str, text: &str, known: &[String]) -> String {
    let none = format!("no {what} `{text}`");
    match nearest(text, known.iter().map(String::as_str)) {
        Some(near) => format!("{none}; did you mean {near}?"),
        None if known.is_empty() => format!("{none}; none available"),
        None => format!("{none}; choose from: {}", known.join(", ")),
    }
}

fn speeds() -> Vec<String> {
    let mut all = vec![Speed::Times(Speed::SLOWEST)];
    while let Some(next) = all.last().and_then(|speed| speed.stepped(true)) {
        all.push(next);
    }
    let text = |speed: &Speed| match speed {
        Speed::Times(factor) => factor.to_string(),
        Speed::Max => "max".into(),
    };
    all.iter().map(text).collect()
}

/// Parameter names or, after a name and `=`, the parameter's values if they are words.
fn parameters(model: &Model, typed: &str) -> Vec<String> {
    let all = model.planner().map(|info| info.parameters.as_slice()).unwrap_or_default();
    let Some((key, _)) = typed.split_once('=') else {
        return all.iter().map(|info| format!("{}=", info.key)).collect();
    };
    let words = match all.iter().find(|info| info.key == key).map(|info| &info.kind) {
        Some(ParamKind::Choice { options, .. }) => options.clone(),
        Some(ParamKind::Flag { .. }) => vec!["true".into(), "false".into()],
        _ => Vec::new(),
    };
    words.into_iter().map(|word| format!("{key}={word}")).collect()
}

fn read_parameter(model: &Model, text: &str) -> Result<Value, String> {
    let all = model.planner().map(|info| info.parameters.as_slice()).unwrap_or_default();
    let (key, value) = text.split_once('=').ok_or("write KEY=VALUE, such as k_rep=2")?;
    let unknown = || {
        let keys: Vec<String> = all.iter().map(|info| info.key.clone()).collect();
        wrong("parameter", key, &keys)
    };
    let info = all.iter().find(|info| info.key == key).ok_or_else(unknown)?;
    Ok(Value::Parameter { key: key.to_owned(), value: parameter::parse(info, value)? })
}

/// The alarms of the run that can be shelved, by name.
fn alarms(model: &Model) -> impl Iterator<Item = (String, Cause)> {
    let run = &model.live.run;
    run.alarms.open().map(|alarm| (guide::name(&alarm.cause, run), alarm.cause.clone()))
}

/// The largest range error that a fault may have, metres, as in a scenario.
const LONGEST_M: f64 = 1000.0;

fn read_fault(text: &str) -> Result<RangeFault, String> {
    let wrong = || {
        format!(
            "unknown fault `{text}`; write dead (silent) or offset=2.5 (ranges 2.5 m too long; at most \
            {LONGEST_M})"
        )
    };
    if text == "dead" {
        return Ok(RangeFault::Dead);
    }
    let metres = text.strip_prefix("offset=").ok_or_else(wrong)?;
    match metres.trim_end_matches('m').parse() {
        Ok(metres) if metres > 0.0 && metres <= LONGEST_M => Ok(RangeFault::Offset(metres)),
        _ => Err(wrong()),
    }
}

fn read_corner(text: &str) -> Result<Point, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|metres: &f64| metres.is_finite());
    let corner = text.split_once(',').and_then(|(x, y)| Some(Point::new(number(x)?, number(y)?)));
    corner.ok_or_else(|| format!("invalid corner `{text}`; write x and y in metres, such as -1.5,2"))
}

/// The scenarios that can be opened.
fn scenarios(model: &Model) -> impl Iterator<Item = (&str, &Source)> {
    let all = model.home.found.iter().flat_map(|found| &found.scenarios);
    all.filter(|entry| entry.problem.is_none()).map(|entry| (entry.name.as_str(), &entry.source))
}

/// Why a scenario that was found cannot be opened.
fn problem_of<'a>(model: &'a Model, name: &str) -> Option<&'a str> {
    let all = model.home.found.iter().flat_map(|found| &found.scenarios);
    all.filter(|entry| entry.name == name).find_map(|entry| entry.problem.as_deref())
}

/// Past runs, newest first.
fn runs(model: &Model) -> impl Iterator<Item = &str> {
    model.home.found.iter().flat_map(|found| &found.runs).map(|run| run.name.as_str())
}

fn read_run(model: &Model, text: &str) -> Result<String, String> {
    if text == "latest" {
        // The home screen may not know the run that has just ended.
        let ended = model.live.result.as_ref().and_then(|result| result.name.as_deref());
        let latest = ended.or_else(|| runs(model).next());
        return latest.map(str::to_owned).ok_or_else(|| "no runs yet".into());
    }
    let fitting: Vec<&str> = runs(model).filter(|name| name.starts_with(text)).collect();
    match fitting.as_slice() {
        [one] => Ok((*one).to_owned()),
        [] => Err(format!("no run begins with `{text}`")),
        many if many.contains(&text) => Ok(text.to_owned()),
        [first, second, ..] => Err(format!("{} runs match: {first}, {second}...", fitting.len())),
    }
}

fn word_of(layer: MapLayer) -> String {
    layer.name().to_lowercase().replace(' ', "-")
}

/// Stations and obstacles by name, with their offsets from the tank's centre, metres.
fn places(model: &Model) -> Vec<(String, Vector)> {
    let Some(about) = &model.live.run.about else { return Vec::new() };
    let (low, high) = about.world.boundary.bounds();
    let middle: Point = nalgebra::center(&low, &high);
    let stations = about.world.stations.iter().map(|station| (station.name.clone(), station.position));
    let obstacles = about.world.obstacles.iter().map(|found| (found.name.clone(), found.shape.center()));
    stations.chain(obstacles).map(|(name, at)| (name, at - middle)).collect()
}
