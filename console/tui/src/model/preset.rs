//! Parameter presets.

use super::parameter;
use mission::{ParamInfo, ParamValue, Parameters, PlannerChoice, PlannerInfo};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The maximum length of a preset's name, characters.
const LONGEST: usize = 40;

/// Named parameters of a planner, as stored in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preset {
    /// The name of the preset.
    pub name: String,
    /// The planner with its parameters, or an error with file, line and key.
    pub choice: Result<PlannerChoice, String>,
}

/// A parameter that a preset changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference<'a> {
    /// The parameter.
    pub info: &'a ParamInfo,
    /// The current value, or the default if the planner is not the active one.
    pub now: ParamValue,
    /// The value in the preset.
    pub then: ParamValue,
}

/// The parameters whose values would change.
pub fn differences<'a>(
    now: Option<&PlannerChoice>,
    then: &PlannerChoice,
    info: &'a PlannerInfo,
) -> Vec<Difference<'a>> {
    let now = now.filter(|now| now.id == then.id);
    let all = info.parameters.iter().map(|info| Difference {
        info,
        now: parameter::value(now, info),
        then: parameter::value(Some(then), info),
    });
    all.filter(|difference| difference.now != difference.then).collect()
}

/// The planner of a preset with the values that the operator takes; the parameters in `left` keep their current values.
pub fn picked(
    now: Option<&PlannerChoice>,
    then: &PlannerChoice,
    info: &PlannerInfo,
    left: &BTreeSet<String>,
) -> PlannerChoice {
    let now = now.filter(|now| now.id == then.id);
    let value = |info: &ParamInfo| {
        let of = if left.contains(&info.key) { now } else { Some(then) };
        (info.key.clone(), parameter::value(of, info))
    };
    let parameters: Parameters = info.parameters.iter().map(value).collect();
    by_hand(&PlannerChoice { id: info.id.clone(), parameters }, info)
}

/// A planner with the value of every parameter, defaults included, so that a later change of a default does not
/// change the preset.
pub fn whole(choice: Option<&PlannerChoice>, info: &PlannerInfo) -> PlannerChoice {
    let value = |info: &ParamInfo| (info.key.clone(), parameter::value(choice, info));
    let parameters: Parameters = info.parameters.iter().map(value).collect();
    PlannerChoice { id: info.id.clone(), parameters }
}

/// A planner with only the parameters that differ from their defaults.
pub fn by_hand(choice: &PlannerChoice, info: &PlannerInfo) -> PlannerChoice {
    let mut choice = choice.clone();
    for info in &info.parameters {
        if choice.parameters.get(&info.key) == Some(&parameter::default(&info.kind)) {
            choice.parameters.remove(&info.key);
        }
    }
    choice
}

/// Checks that a name is permitted for a preset; the name is also the file name.
///
/// # Errors
/// Returns a message that states which names are permitted.
pub fn check_name(name: &str) -> Result<(), String> {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    if name.is_empty() || name.len() > LONGEST || !name.chars().all(is_plain) {
        return Err(format!("invalid preset name `{name}`; use 1 to {LONGEST} letters, digits, - or _"));
    }
    Ok(())
}
