//! Answers: the planners in a library, and the results, messages, progress and refusals of a planner. Readers enforce
//! the limits in `checks/limits.rs`.

use crate::checks::limits::{self, MOST_CUTS, MOST_PARAMS, MOST_PLANNERS, MOST_POINTS};
use crate::parameters::check;
use crate::stamp::Abi;
pub(crate) use mission::Said;
use mission::{ParamInfo, ParamKind, Sandbox};
use nalgebra::Point2;
use planner_api::export::is_id;
use planner_api::{Drawing, Leg, LogLevel, Plan};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// A planner's refusal as it is sent: the number of its code, its sentence, and the part of the path that was found.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Refusal {
    pub(crate) code: i32,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) message: String,
    pub(crate) partial: Vec<Point2<f64>>,
}

/// Code of a refusal that comes from the worker itself because the planner's answer is invalid.
pub(crate) const BAD_OUTPUT: i32 = 100;

/// The report of a sandboxed worker before it loads a file. The console trusts it because it is sent before any code of
/// the plugin runs; everything later could come from the plugin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sealed {
    /// The extent of the sandbox.
    #[serde(deserialize_with = "limits::sandbox")]
    pub(crate) sandbox: Sandbox,
    /// SHA-256 of the file, hexadecimal.
    #[serde(deserialize_with = "limits::text")]
    pub(crate) sha256: String,
    /// The ABI version in the file's stamp.
    pub(crate) abi: Abi,
}

/// The planners in a library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Planners(#[serde(deserialize_with = "read_planners")] pub(crate) Vec<Described>);

/// One planner in a library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Described {
    #[serde(deserialize_with = "limits::text")]
    pub(crate) id: String,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) name: String,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) version: String,
    #[serde(deserialize_with = "limits::text")]
    pub(crate) about: String,
    pub(crate) caps: u32,
    pub(crate) state_version: u32,
    #[serde(serialize_with = "parameters", deserialize_with = "read_parameters")]
    pub(crate) parameters: Vec<ParamInfo>,
}

fn parameters<S: serde::Serializer>(parameters: &[ParamInfo], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(parameters.iter().cloned().map(Parameter))
}

/// Reads parameters.
fn read_parameters<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<ParamInfo>, D::Error> {
    let parameters = limits::at_most::<_, Parameter, MOST_PARAMS>(from)?;
    Ok(parameters.into_iter().map(|Parameter(info)| info).collect())
}

/// Reads planners, which must have valid, distinct ids and valid parameters.
fn read_planners<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Described>, D::Error> {
    let planners = limits::at_most::<_, Described, MOST_PLANNERS>(from)?;
    let is_new = |i: usize, id: &String| planners[..i].iter().all(|earlier| earlier.id != *id);
    let are_sound = planners.iter().enumerate().all(|(i, planner)| {
        is_id(&planner.id) && is_new(i, &planner.id) && check(&planner.parameters).is_ok()
    });
    if are_sound { Ok(planners) } else { Err(D::Error::custom("invalid planners")) }
}

/// A parameter as it is sent. (In journals, the fields of its kind are named and stand beside the other fields.)
#[derive(Serialize, Deserialize)]
pub(crate) struct Parameter(#[serde(with = "ParameterFields")] pub(crate) ParamInfo);

#[derive(Serialize, Deserialize)]
#[serde(remote = "ParamInfo")]
struct ParameterFields {
    #[serde(deserialize_with = "limits::text")]
    key: String,
    #[serde(deserialize_with = "limits::text")]
    label: String,
    #[serde(deserialize_with = "limits::text")]
    unit: String,
    #[serde(deserialize_with = "limits::text")]
    help: String,
    #[serde(deserialize_with = "limits::text")]
    group: String,
    #[serde(with = "KindFields")]
    kind: ParamKind,
    live: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ParamKind")]
enum KindFields {
    Float {
        min: f64,
        max: f64,
        default: f64,
    },
    Int {
        min: i64,
        max: i64,
        default: i64,
    },
    Flag {
        default: bool,
    },
    Choice {
        #[serde(deserialize_with = "limits::words")]
        options: Vec<String>,
        #[serde(deserialize_with = "limits::text")]
        default: String,
    },
}

/// The result of a planner, with everything that the planner drew, reported and logged during the call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Answered<T> {
    pub(crate) given: T,
    #[serde(with = "SaidFields")]
    pub(crate) said: Said,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Said")]
struct SaidFields {
    #[serde(deserialize_with = "limits::drawings")]
    drawings: Vec<Drawing>,
    #[serde(deserialize_with = "limits::scalars")]
    scalars: Vec<(String, f64, String)>,
    #[serde(deserialize_with = "limits::logs")]
    logs: Vec<(LogLevel, String)>,
}

/// A planner's plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct GivenPlan(#[serde(with = "PlanFields")] pub(crate) Plan);

#[derive(Serialize, Deserialize)]
#[serde(remote = "Plan")]
struct PlanFields {
    path: Vec<Point2<f64>>,
    cost: f64,
    complete: bool,
    #[serde(deserialize_with = "limits::at_most::<_, _, MOST_POINTS>")]
    legs: Vec<Leg>,
    #[serde(deserialize_with = "limits::at_most::<_, _, MOST_CUTS>")]
    cuts: Vec<Vec<Point2<f64>>>,
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::checks::limits::{MOST_LOGS, Text};
    use crate::wire::body::{Body, Malformed, Read, Writer, whole};
    use nalgebra::Vector2;
    use planner_api::{Command, Layer, LegTag, Status};
    use serde::de::DeserializeOwned;

    fn read<T: DeserializeOwned>(value: &impl Serialize) -> Read<T> {
        let mut writer = Writer::default();
        writer.begin(1, 0, 0).put(value);
        whole(Body(&writer.finish().unwrap()[13..]))
    }

    #[test]
    fn a_description_arrives_with_every_kind_of_parameter() {
        let kinds = [
            ParamKind::Float { min: -1.0, max: 2.0, default: 0.5 },
            ParamKind::Int { min: -4, max: 9, default: -3 },
            ParamKind::Flag { default: true },
            ParamKind::Choice { options: vec!["a".into(), "b".into()], default: "b".into() },
        ];
        let keys = ["f", "i", "b", "c"].into_iter();
        let parameters = kinds.into_iter().zip(keys).map(|(kind, key)| ParamInfo {
            key: key.into(),
            label: "L".into(),
            unit: "m".into(),
            help: "h".into(),
            group: "g".into(),
            live: true,
            kind,
        });
        let [id, name, version, about] = ["x", "X", "1", "?"].map(str::to_owned);
        let planners = vec![Described {
            id,
            name,
            version,
            about,
            caps: 9,
            state_version: 2,
            parameters: parameters.collect(),
        }];
        let planners = Planners(planners);
        assert_eq!(read(&planners), Ok(planners));
    }

    #[test]
    fn a_description_that_no_worker_sends_is_refused() {
        let planner = |id: &str, default: f64| {
            let [name, version, about] = ["X", "1", "?"].map(str::to_owned);
            let [key, label, unit, help, group] = ["k", "L", "m", "h", "g"].map(str::to_owned);
            let kind = ParamKind::Float { min: 0.0, max: 1.0, default };
            let parameters = vec![ParamInfo { key, label, unit, help, group, live: true, kind }];
            Described { id: id.to_owned(), name, version, about, caps: 0, state_version: 1, parameters }
        };
        let read = |planners: &[Described]| read(&planners).map(|Planners(planners)| planners.len());
        assert_eq!(read(&[planner("x", 0.5), planner("y", 0.5)]), Ok(2));
        for bad in [vec![planner("a b", 0.5)], vec![planner("x", f64::NAN)], vec![planner("x", 2.0)]] {
            assert_eq!(read(&bad), Err(Malformed), "{bad:?}");
        }
        assert_eq!(read(&[planner("x", 0.5), planner("x", 0.5)]), Err(Malformed));
    }

    #[test]
    fn a_text_moves_no_cursor_and_turns_no_line_round() {
        let text = read(&"a\u{1b}[2Jb\u{202e}c\u{9b}d\u{200b}");
        assert_eq!(text, Ok(Text("a�[2Jb�c�d�".to_owned())));
    }

    #[test]
    fn more_than_a_worker_sends_is_refused() {
        let reads = |said: Said| read::<Answered<()>>(&Answered { given: (), said }).is_ok();
        let logs = |n| Said { logs: vec![(LogLevel::Info, String::new()); n], ..Said::default() };
        let scalar = |value| Said { scalars: vec![("u".into(), value, String::new())], ..Said::default() };
        let circle = |radius_m| {
            let circle = Drawing::Circle { layer: Layer::Path, center: Point2::origin(), radius_m };
            Said { drawings: vec![circle], ..Said::default() }
        };
        assert!(reads(logs(MOST_LOGS + 1)) && !reads(logs(MOST_LOGS + 2)));
        assert!(reads(scalar(1.0)) && !reads(scalar(f64::NAN)));
        assert!(reads(circle(1.0)) && !reads(circle(f64::INFINITY)));
    }

    #[test]
    fn what_was_said_arrives() {
        let (layer, at) = (Layer::Tether, Point2::new(1.0, 2.0));
        let said = Said {
            drawings: vec![
                Drawing::Arrow { layer, at, vector: Vector2::new(3.0, 4.0) },
                Drawing::Circle { layer, center: at, radius_m: 0.5 },
                Drawing::Line { layer, from: at, to: Point2::origin() },
            ],
            scalars: vec![("u".into(), 1.5, "J".into())],
            logs: vec![(LogLevel::Warn, "narrow".into())],
        };
        let answered = Answered { given: (), said };
        assert_eq!(read(&answered), Ok(answered));
    }

    #[test]
    fn plans_commands_and_refusals_arrive() {
        let path = vec![Point2::new(1.0, 2.0)];
        let legs = vec![
            Leg { tag: LegTag::Retract, first: 0, last: 0 },
            Leg { tag: LegTag::Swath, first: 0, last: 0 },
        ];
        let cuts = vec![path.clone(), Vec::new()];
        let plan = Plan { path, cost: 3.0, complete: true, legs, cuts };
        let command = Command { status: Status::Waiting, ..Command::twist(0.1, -0.2) };
        let refusal = Refusal { code: -7, message: "no".into(), partial: plan.path.clone() };
        let all = (GivenPlan(plan), command, refusal);
        assert_eq!(read(&all), Ok(all));
    }
}
