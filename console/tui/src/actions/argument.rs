//! What commands take.

/// What a value of a command is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A speed of the simulation.
    Speed,
    /// Id of a planner.
    Planner,
    /// A parameter of the planner and its value.
    Parameter,
    /// Name of a scenario.
    Scenario,
    /// Name of a past run, the unique beginning of one, or `latest`.
    Run,
    /// A layer of the map.
    Layer,
    /// Name of a station or an obstacle.
    Place,
    /// A severity of events.
    Severity,
    /// A theme.
    Theme,
    /// A screen.
    Screen,
    /// Any text.
    Text,
}

/// What a command takes; the first one goes without its name, the others need it: `planner=navfn`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arg {
    /// Its name.
    pub name: &'static str,
    /// What its value is.
    pub kind: Kind,
    /// Whether the command does not run without it.
    pub is_required: bool,
}

pub(super) const fn must(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: true }
}

pub(super) const fn may(name: &'static str, kind: Kind) -> Arg {
    Arg { name, kind, is_required: false }
}

impl Arg {
    /// How it is written.
    pub(super) fn usage(&self, is_named: bool) -> String {
        let value = match self.kind {
            Kind::Parameter => "KEY=VALUE".to_owned(),
            _ => self.name.to_uppercase(),
        };
        let value = if is_named { format!("{}={value}", self.name) } else { value };
        if self.is_required { value } else { format!("[{value}]") }
    }
}
