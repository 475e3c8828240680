//! The conditions that a script can wait for or require.

use mission::Phase;
use std::fmt;
use tui::{Model, guide, model::Alarm};
use world::coverage::percent_text;

/// A condition that a script can wait for or require.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Condition {
    is_negated: bool,
    what: What,
}

#[derive(Debug, Clone, PartialEq)]
enum What {
    /// `waiting`, `running`, `held`, `ended`, or an outcome.
    Phase(String),
    /// The screen with this name is shown.
    Screen(String),
    /// At least this percentage of the reachable floor is scanned.
    Coverage(f64),
    /// The name or the text of an open alarm contains this text; if this text is empty, any open alarm meets the
    /// condition.
    Alarm(String),
    /// The screen contains this text.
    Text(String),
}

const PHASES: [&str; 10] = [
    "waiting",
    "running",
    "held",
    "ended",
    "complete",
    "stuck",
    "collision",
    "time_limit",
    "entangled",
    "aborted",
];

impl Condition {
    /// Parses a condition.
    ///
    /// # Errors
    /// The problem, and the correct form.
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let (is_negated, text) = match text.strip_prefix("not ") {
            Some(rest) => (true, rest.trim()),
            None => (false, text),
        };
        let (word, value) = text.split_once(' ').unwrap_or((text, ""));
        let value = value.trim();
        let bare = value.trim_matches('"').to_owned();
        let what = match word {
            "phase" if PHASES.contains(&value) => What::Phase(bare),
            "phase" => return Err(format!("unknown phase `{value}`; the phases are: {}", PHASES.join(", "))),
            "screen" => screen(value)?,
            "coverage" => coverage(value)?,
            "alarm" => What::Alarm(bare),
            "text" if !bare.is_empty() => What::Text(bare),
            _ => {
                return Err(format!(
                    "unknown condition `{text}`; write phase WORD, screen NAME, coverage >= PERCENT, alarm \
                     [TEXT] or text TEXT, optionally preceded by not"
                ));
            }
        };
        Ok(Self { is_negated, what })
    }

    /// Whether the condition holds; `screen` draws the screen as text.
    pub(super) fn holds(&self, model: &Model, screen: impl Fn(&Model) -> anyhow::Result<String>) -> bool {
        self.is_negated != self.what.holds(model, screen)
    }

    /// The actual state, as a clause.
    pub(super) fn instead(&self, model: &Model) -> String {
        match &self.what {
            What::Phase(_) => format!("the phase is {}", phase(model.live.run.phase())),
            What::Screen(_) => format!("the screen is {}", model.ui.screen.name().to_lowercase()),
            What::Coverage(_) => {
                format!("coverage is {} %", percent_text(coverage_percent(model) / 100.0, 1))
            }
            What::Alarm(_) => match model.live.run.alarms.worst() {
                Some(alarm) => format!("the most severe alarm is: {}", alarm.text),
                None => "no alarm is open".into(),
            },
            What::Text(_) => "the screen does not contain it".into(),
        }
    }
}

impl What {
    fn holds(&self, model: &Model, screen: impl Fn(&Model) -> anyhow::Result<String>) -> bool {
        match self {
            Self::Phase(word) => match model.live.run.phase() {
                Phase::Ended(outcome) => word == "ended" || word == outcome.word(),
                other => word == phase(other),
            },
            Self::Screen(name) => *name == model.ui.screen.name().to_lowercase(),
            Self::Coverage(percent) => coverage_percent(model) >= *percent,
            Self::Alarm(text) => is_alarm_open(model, text),
            Self::Text(text) => screen(model).is_ok_and(|shown| shown.contains(text)),
        }
    }
}

/// Whether the name or the text of an open alarm, one that the top line counts, contains a text.
fn is_alarm_open(model: &Model, text: &str) -> bool {
    let run = &model.live.run;
    let names = |alarm: &Alarm| alarm.text.contains(text) || guide::name(&alarm.cause, run).contains(text);
    run.alarms.open().any(names)
}

fn screen(name: &str) -> Result<What, String> {
    let names = tui::model::Screen::ALL.map(|screen| screen.name().to_lowercase());
    if names.iter().any(|known| known == name) {
        return Ok(What::Screen(name.to_owned()));
    }
    Err(format!("unknown screen `{name}`; the screens are: {}", names.join(", ")))
}

fn coverage(text: &str) -> Result<What, String> {
    let percent = text.strip_prefix(">=").and_then(|number| number.trim().parse().ok());
    let percent = percent.filter(|percent| (0.0..=100.0).contains(percent));
    percent.map(What::Coverage).ok_or_else(|| "write coverage >= PERCENT, for example coverage >= 95".into())
}

/// The scanned share of the reachable floor in percent.
fn coverage_percent(model: &Model) -> f64 {
    model.live.run.progress.as_ref().map_or(0.0, |progress| 100.0 * progress.covered_reachable)
}

fn phase(phase: &Phase) -> &'static str {
    match phase {
        Phase::Waiting => "waiting",
        Phase::Running(_) => "running",
        Phase::Held(_) => "held",
        Phase::Ended(outcome) => outcome.word(),
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.is_negated { "not " } else { "" })?;
        match &self.what {
            What::Phase(word) => write!(f, "phase {word}"),
            What::Screen(name) => write!(f, "screen {name}"),
            What::Coverage(percent) => write!(f, "coverage >= {percent}"),
            What::Alarm(text) if text.is_empty() => f.write_str("alarm"),
            What::Alarm(text) => write!(f, "alarm {text:?}"),
            What::Text(text) => write!(f, "text {text:?}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mission::{Note, Noted, Severity};
    use tui::model::Cause;

    /// Whether an alarm condition holds, and whether its negation does.
    fn holds(model: &Model, alarm: &str) -> [bool; 2] {
        [format!("alarm {alarm}"), format!("not alarm {alarm}")]
            .map(|text| Condition::read(&text).unwrap().holds(model, |_| Ok(String::new())))
    }

    #[test]
    fn an_alarm_counts_until_it_is_cleared_and_acknowledged() {
        let mut model = Model::default();
        let cause = Cause::Zone("no-go 1".into());
        let text = "hull is 0.10 m inside zone no-go 1".to_owned();
        assert_eq!(holds(&model, ""), [false, true]);
        model.live.run.alarms.raise(cause.clone(), Severity::Crit, text.clone(), 1.0);
        assert_eq!([holds(&model, ""), holds(&model, "inside zone")], [[true, false]; 2]);
        assert_eq!([holds(&model, "hull in zone"), holds(&model, "tether")], [[true, false], [false, true]]);
        model.live.run.alarms.clear(&cause, 2.0);
        assert_eq!(holds(&model, "hull in zone"), [true, false], "it is not acknowledged yet");
        let what = Noted::Acknowledged { alarm: cause.key(), text };
        model.live.run.alarms.take(&Note { what, by: None }, 3.0);
        assert_eq!(model.live.run.alarms.list().len(), 1, "it stays in the list");
        assert_eq!(holds(&model, "hull in zone"), [false, true]);
    }
}
