//! Parameters of a planner under a name.

use super::parameter;
use mission::{ParamInfo, ParamValue, Parameters, PlannerChoice, PlannerInfo};
use serde::{Deserialize, Serialize};

/// Longest name of a preset, characters.
const LONGEST: usize = 40;

/// Parameters of a planner under a name, as a file holds them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Preset {
    /// Its name.
    pub name: String,
    /// The planner with its parameters, or what is wrong with the file, with file, line and key.
    pub choice: Result<PlannerChoice, String>,
}

/// A parameter that a preset changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference<'a> {
    /// Which.
    pub info: &'a ParamInfo,
    /// Its value now; for another planner than the active one its default.
    pub now: ParamValue,
    /// Its value by the preset.
    pub then: ParamValue,
}

/// The parameters that differ between what a planner has now and what it is to have.
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

/// A planner with the value of every parameter, also of those that have their default: a preset does not change when a
/// default does.
pub fn whole(choice: Option<&PlannerChoice>, info: &PlannerInfo) -> PlannerChoice {
    let value = |info: &ParamInfo| (info.key.clone(), parameter::value(choice, info));
    let parameters: Parameters = info.parameters.iter().map(value).collect();
    PlannerChoice { id: info.id.clone(), parameters }
}

/// A planner with the parameters that differ from their defaults.
pub fn by_hand(choice: &PlannerChoice, info: &PlannerInfo) -> PlannerChoice {
    let mut choice = choice.clone();
    for info in &info.parameters {
        if choice.parameters.get(&info.key) == Some(&parameter::default(&info.kind)) {
            choice.parameters.remove(&info.key);
        }
    }
    choice
}

/// Whether a preset may have a name: it is the name of its file, too.
///
/// # Errors
/// What it may be.
pub fn check_name(name: &str) -> Result<(), String> {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    if name.is_empty() || name.len() > LONGEST || !name.chars().all(is_plain) {
        return Err(format!("no name for a preset: `{name}`; write 1 to {LONGEST} letters, digits, - or _"));
    }
    Ok(())
}
