//! Typed parameters: declared once as constants, checked by the host, and read by key.

/// The values that a parameter accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A real number.
    Float {
        /// The smallest value allowed.
        min: f64,
        /// The largest value allowed.
        max: f64,
        /// The default.
        default: f64,
    },
    /// A whole number.
    Int {
        /// The smallest value allowed.
        min: i64,
        /// The largest value allowed.
        max: i64,
        /// The default.
        default: i64,
    },
    /// On or off.
    Flag {
        /// The default.
        default: bool,
    },
    /// One of several words.
    Choice {
        /// The words.
        options: &'static [&'static str],
        /// The index of the default.
        default: usize,
    },
}

/// One parameter of a planner.
///
/// ```
/// use planner_api::{ParamSpec, float};
///
/// const GAIN: ParamSpec =
///     float("k_rep", "Repulsion gain", "m3/s", 0.0, 10.0, 0.4).help("A larger gain keeps a larger distance.");
/// assert_eq!((GAIN.key, GAIN.unit, GAIN.live), ("k_rep", "m3/s", false));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamSpec {
    /// The key in scenarios and on the command line.
    pub key: &'static str,
    /// The name on screen.
    pub label: &'static str,
    /// The unit; empty for a pure number.
    pub unit: &'static str,
    /// One or two sentences: what the parameter does, and the effect of a larger value.
    pub help: &'static str,
    /// The heading under which the screen lists the parameter.
    pub group: &'static str,
    /// The values that the parameter accepts.
    pub kind: Kind,
    /// Whether the parameter may change while the mission runs.
    pub live: bool,
}

impl ParamSpec {
    const fn new(key: &'static str, label: &'static str, unit: &'static str, kind: Kind) -> Self {
        Self { key, label, unit, help: "", group: "", kind, live: false }
    }

    /// Sets the help text.
    ///
    /// ```
    /// let mode = planner_api::flag("gated", "Gated", true).help("Only obstacles ahead repel.");
    /// assert_eq!(mode.help, "Only obstacles ahead repel.");
    /// ```
    #[must_use]
    pub const fn help(self, help: &'static str) -> Self {
        Self { help, ..self }
    }

    /// Sets the heading under which the screen lists the parameter.
    ///
    /// ```
    /// let gain = planner_api::float("k_att", "Attraction gain", "1/s", 0.0, 5.0, 1.0).group("Field");
    /// assert_eq!(gain.group, "Field");
    /// ```
    #[must_use]
    pub const fn group(self, group: &'static str) -> Self {
        Self { group, ..self }
    }

    /// Allows the parameter to change while the mission runs, through [`crate::Planner::reconfigure`].
    ///
    /// ```
    /// let gain = planner_api::float("k_att", "Attraction gain", "1/s", 0.0, 5.0, 1.0).live();
    /// assert!(gain.live);
    /// ```
    #[must_use]
    pub const fn live(self) -> Self {
        Self { live: true, ..self }
    }
}

/// Declares a real parameter: `float("k_rep", "Repulsion gain", "m3/s", 0.0, 10.0, 0.4)`.
///
/// ```
/// use planner_api::{Kind, float};
///
/// let gain = float("k_rep", "Repulsion gain", "m3/s", 0.0, 10.0, 0.4);
/// assert_eq!(gain.kind, Kind::Float { min: 0.0, max: 10.0, default: 0.4 });
/// ```
pub const fn float(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    default: f64,
) -> ParamSpec {
    ParamSpec::new(key, label, unit, Kind::Float { min, max, default })
}

/// Declares a whole-number parameter.
///
/// ```
/// use planner_api::{Kind, int};
///
/// let candidates = int("candidates", "Candidates", "", 1, 64, 8);
/// assert_eq!(candidates.kind, Kind::Int { min: 1, max: 64, default: 8 });
/// ```
pub const fn int(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    min: i64,
    max: i64,
    default: i64,
) -> ParamSpec {
    ParamSpec::new(key, label, unit, Kind::Int { min, max, default })
}

/// Declares a parameter that is on or off.
///
/// ```
/// use planner_api::{Kind, flag};
///
/// assert_eq!(flag("gated", "Gated", true).kind, Kind::Flag { default: true });
/// ```
pub const fn flag(key: &'static str, label: &'static str, default: bool) -> ParamSpec {
    ParamSpec::new(key, label, "", Kind::Flag { default })
}

/// Declares a parameter that is one of a number of words; `default` is the index of the default word.
///
/// ```
/// use planner_api::{Kind, choice};
///
/// let mode = choice("mode", "Mode", &["literal", "gated"], 1);
/// assert!(matches!(mode.kind, Kind::Choice { options, default } if options[default] == "gated"));
/// ```
pub const fn choice(
    key: &'static str,
    label: &'static str,
    options: &'static [&'static str],
    default: usize,
) -> ParamSpec {
    ParamSpec::new(key, label, "", Kind::Choice { options, default })
}

/// One value as it crosses the boundary: 0 or 1 for a flag, the index of the word for a choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value<'a> {
    /// The key of the parameter.
    pub key: &'a str,
    /// The value.
    pub number: f64,
}

/// The values of all parameters; the host has filled in the defaults and checked the ranges.
///
/// ```
/// use planner_api::{Config, Value, choice, flag, float, int};
///
/// let params = [
///     float("k_rep", "Repulsion gain", "m3/s", 0.0, 10.0, 0.4),
///     int("candidates", "Candidates", "", 1, 64, 8),
///     flag("gated", "Gated", true),
///     choice("mode", "Mode", &["literal", "hull"], 0),
/// ];
/// let values = [Value { key: "k_rep", number: 2.0 }, Value { key: "mode", number: 1.0 }];
/// let config = Config::new(&params, &values);
/// assert_eq!((config.float("k_rep"), config.int("candidates")), (2.0, 8));
/// assert_eq!((config.flag("gated"), config.choice("mode")), (true, "hull"));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Config<'a> {
    specs: &'a [ParamSpec],
    values: &'a [Value<'a>],
}

impl<'a> Config<'a> {
    /// Combines declared parameters with the values that were set; parameters without a value take their defaults.
    pub fn new(specs: &'a [ParamSpec], values: &'a [Value<'a>]) -> Self {
        Self { specs, values }
    }

    /// Returns the value of a real parameter.
    ///
    /// # Panics
    /// The planner does not declare this parameter. The first test of the planner reveals such a mistake.
    pub fn float(&self, key: &str) -> f64 {
        self.number(key)
    }

    /// Returns the value of a whole-number parameter; panics like [`Config::float`].
    pub fn int(&self, key: &str) -> i64 {
        self.number(key) as i64
    }

    /// Returns the value of a parameter that is on or off; panics like [`Config::float`].
    pub fn flag(&self, key: &str) -> bool {
        self.number(key) != 0.0
    }

    /// Returns the chosen word; panics like [`Config::float`], or if the parameter is not a choice.
    pub fn choice(&self, key: &str) -> &'static str {
        let Kind::Choice { options, default } = self.spec(key).kind else {
            panic!("parameter `{key}` is not a choice")
        };
        options.get(self.number(key) as usize).copied().unwrap_or(options[default])
    }

    fn number(&self, key: &str) -> f64 {
        let spec = self.spec(key);
        self.values
            .iter()
            .find(|value| value.key == key)
            .map_or_else(|| default_number(&spec.kind), |v| v.number)
    }

    fn spec(&self, key: &str) -> &'a ParamSpec {
        let found = self.specs.iter().find(|spec| spec.key == key);
        found.unwrap_or_else(|| panic!("parameter `{key}` is not declared"))
    }
}

/// Returns the default of a parameter as it crosses the boundary.
///
/// ```
/// use planner_api::{choice, flag, params::default_number};
///
/// assert_eq!(default_number(&flag("gated", "Gated", true).kind), 1.0);
/// assert_eq!(default_number(&choice("mode", "Mode", &["literal", "hull"], 1).kind), 1.0);
/// ```
pub fn default_number(kind: &Kind) -> f64 {
    match *kind {
        Kind::Float { default, .. } => default,
        Kind::Int { default, .. } => default as f64,
        Kind::Flag { default } => f64::from(u8::from(default)),
        Kind::Choice { default, .. } => default as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECS: &[ParamSpec] = &[
        float("k_rep", "Repulsion gain", "m3/s", 0.0, 10.0, 0.4),
        int("n", "Exponent", "", 0, 4, 2),
        flag("improved", "Improved repulsion", true),
        choice("mode", "Mode", &["literal", "gated"], 1),
    ];

    #[test]
    fn a_value_that_is_not_set_is_the_default() {
        let config = Config::new(SPECS, &[Value { key: "n", number: 3.0 }]);
        assert!((config.float("k_rep") - 0.4).abs() < f64::EPSILON);
        assert_eq!(config.int("n"), 3);
        assert!(config.flag("improved"));
        assert_eq!(config.choice("mode"), "gated");
    }
}
