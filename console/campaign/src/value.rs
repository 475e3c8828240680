//! Values in a grid.

use serde::{Deserialize, Serialize};
use std::fmt;
use toml::de::DeValue;

/// The value of a scenario key or a planner parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A flag.
    Flag(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

impl Value {
    /// A simple value in a TOML file.
    pub(crate) fn read(value: &DeValue<'_>) -> Option<Self> {
        match value {
            DeValue::Boolean(flag) => Some(Self::Flag(*flag)),
            DeValue::Integer(_) => i64::from_str_radix(
                &value.as_integer()?.as_str().replace('_', ""),
                value.as_integer()?.radix(),
            )
            .ok()
            .map(Self::Whole),
            DeValue::Float(_) => {
                value.as_float()?.as_str().parse().ok().filter(|x: &f64| x.is_finite()).map(Self::Number)
            }
            DeValue::String(word) => Some(Self::Word(word.to_string())),
            _ => None,
        }
    }

    /// The value as a number, if it is one.
    pub(crate) fn number(&self) -> Option<f64> {
        match self {
            Self::Whole(n) => Some(*n as f64),
            Self::Number(x) => Some(*x),
            Self::Flag(_) | Self::Word(_) => None,
        }
    }
}

/// The value as it is written after `--set`.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => write!(f, "{flag}"),
            Self::Whole(n) => write!(f, "{n}"),
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Word(word) => f.write_str(word),
        }
    }
}
