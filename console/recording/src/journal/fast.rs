//! A fast reader for plans and for the events that occur in every tick, which reads lines straight into their fields.
//! The general reader first parses an event as an untyped value and then determines its kind. That takes several
//! times as long and, for a plan of a million points, several times the memory.

mod within;

use mission::{
    AskId, Event, EventKind,
    event::{Effort, MeasuredPull, PlanMade, PlanScans, TetherContact},
};
use planner_api::{Command, Drive, Leg, LegTag, PoseEstimate, Reason};
use positioning::{Fix, Ranging};
use serde::Deserialize;
use world::{CableLies, CellRun, Point, Pose, Readings};

/// Reads a line with the fields of an event; those after `;` are optional.
macro_rules! read {
    ($line:expr, $kind:ident $(($of:ident))? { $($field:ident: $type:ty),*; $($optional:ident: $some:ty),* }) => {{
        #[derive(Deserialize)]
        struct Fields {
            tick: u64,
            t_s: f64,
            $($field: $type,)*
            $(#[serde(default)] $optional: $some,)*
        }
        let Fields { tick, t_s, $($field,)* $($optional,)* } = serde_json::from_str($line).ok()?;
        Some(Event { tick, t_s, kind: made!($kind $(($of))? { $($field,)* $($optional,)* }) })
    }};
}

/// Makes an event of its fields, which may be those of a type of their own.
macro_rules! made {
    ($kind:ident { $($field:ident,)* }) => { EventKind::$kind { $($field,)* } };
    ($kind:ident ($of:ident) { $($field:ident,)* }) => { EventKind::$kind($of { $($field,)* }) };
}

/// Reads a plan, or an event that occurs in every tick, from a line in the form that this program writes. `None` for
/// any other line and for a faulty line, which the general reader then reads or reports.
pub(super) fn event(line: &[u8]) -> Option<Event> {
    let name = name_of(line)?;
    // Checked once for the whole line instead of once for each key.
    let line = std::str::from_utf8(line).ok()?;
    match name {
        b"estimated" => read!(line, Estimated { pose: PoseEstimate; }),
        b"protected" => read!(line, Protected { level_m: Option<f64>; }),
        b"truth" => read!(line, Truth { pose: Pose, clearance_m: f64, collided: bool; }),
        b"covered" => read!(line, Covered { runs: Vec<CellRun>; }),
        b"uncounted" => read!(line, Uncounted { runs: Vec<CellRun>; }),
        b"sensed" => read!(line, Sensed { source_t_s: f64, arrival_t_s: f64, readings: Box<Readings>; }),
        b"sent" => read!(line, Sent { lease_s: f64; drive: Option<Drive> }),
        b"ranged" => read!(line, Ranged { ranges: Vec<Ranging>; }),
        b"fixed" => read!(line, Fixed { fix: Fix; }),
        b"commanded" => {
            read!(line, Commanded { command: Command; ask: Option<AskId>, asked: Option<Command> })
        }
        b"tether_truth" => read!(
            line,
            TetherTruth {
                length_m: f64, wrap_max_rad: f64, wrap_total_rad: f64, detour_m: f64; lies: Option<Box<CableLies>>
            }
        ),
        b"progressed" => read!(
            line,
            Progressed {
                done: f64, target: Point, covered_reachable: f64, covered_whole: f64;
                along_m: Option<f64>, cross_track_m: Option<f64>, leg: Option<LegTag>
            }
        ),
        b"tethered" => read!(
            line,
            Tethered {
                length_m: f64, free_m: f64, contacts: Vec<TetherContact>, wrap_max_rad: f64, wrap_total_rad: f64,
                pull_factor: f64, bends: Vec<Point>;
                paid_out_m: Option<f64>, return_length_m: Option<f64>, pull_n: Option<f64>, measured: Option<MeasuredPull>
            }
        ),
        b"planned" => read!(
            line,
            Planned {
                planner: String, reason: Reason, path: Vec<Point>, length_m: f64, complete: bool;
                ask: Option<AskId>, return_path: usize, legs: Vec<Leg>, cuts: Vec<Vec<Point>>
            }
        ),
        b"better_planned" => read!(
            line,
            BetterPlanned(PlanMade) {
                ask: AskId, planner: String, path: Vec<Point>, complete: bool, flown: Effort, better: Effort;
                legs: Vec<Leg>, cuts: Vec<Vec<Point>>, scans: Option<PlanScans>, objection: Option<String>
            }
        ),
        b"shadowed" | b"discarded" => within::event(line),
        _ => None,
    }
}

/// The name of the event; `None` if the name is not in the place where this program writes it.
fn name_of(line: &[u8]) -> Option<&[u8]> {
    const KEY: &[u8] = b",\"event\":\"";
    let head = line.get(..line.len().min(96))?;
    let at = head.windows(KEY.len()).position(|window| window == KEY)? + KEY.len();
    line[at..].split(|byte| *byte == b'"').next()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use serde_json::json;

    #[test]
    fn both_readers_read_the_same() {
        let pose = json!({ "position": [1.25, -0.1], "heading_rad": 0.3 });
        let covariance = [0.01, 0.0, 0.0, 0.02, 0.0, 0.001];
        let estimate = json!({ "position": [1.0, 2.0], "heading_rad": 0.5, "covariance": covariance });
        let fix = json!({
            "position": [1.0, 2.0], "covariance": [0.01, 0.0, 0.02], "used": [1, 2, 3],
            "residuals": [{ "station": 1, "residual_m": -0.02, "sigma_m": 0.05 }],
            "excluded": [[4, { "residual": { "residual_m": 0.6, "gate_m": 0.2 } }]], "degrees_of_freedom": 1,
            "chi2": 1.5, "gdop": 1.2, "conditioning": 1.4, "mirror": null, "protection_level_m": 0.3, "integrity": "ok",
        });
        let readings = json!({
            "ranges": [{ "station": 1, "ranges_m": [4.25, 4.1] }], "ranging_cycle": true,
            "odometry": { "forward_m": 0.04, "sideways_m": 0.0, "turn_rad": -0.001 }, "sightings": [], "contact": false,
            "paid_out_m": 3.5,
        });
        let drive =
            json!({ "drive": { "twist": { "v_m_per_s": 0.4, "w_rad_per_s": 0.1 } }, "status": "moving" });
        let plan = json!({ "event": "planned", "ask": [1, 3], "planner": "navfn", "reason": "start", "path": [[0.0, 1.0], [2.0, 0.1]],
            "length_m": 2.5, "complete": true, "legs": [{ "tag": "swath", "first": 0, "last": 1 }], "cuts": [[[0.0, 0.0], [1.0, 1.0]]] });
        let kinds = [
            plan.clone(),
            json!({ "event": "shadowed", "of": plan }),
            json!({ "event": "discarded", "ask": [1, 3], "plan": plan }),
            json!({ "event": "estimated", "pose": estimate }),
            json!({ "event": "truth", "pose": pose, "clearance_m": 0.123_456_789, "collided": false }),
            json!({ "event": "fixed", "fix": fix }),
            json!({ "event": "covered", "runs": [[5, 2], [9, 1]] }),
            json!({ "event": "uncounted", "runs": [] }),
            json!({ "event": "commanded", "ask": [1, 28], "command": drive }),
            json!({ "event": "commanded", "command": drive }),
            json!({ "event": "sensed", "source_t_s": 12.5, "arrival_t_s": 1.25, "readings": readings }),
            json!({ "event": "sent", "drive": { "twist": { "v_m_per_s": 0.4, "w_rad_per_s": 0.1 } }, "lease_s": 0.25 }),
            json!({ "event": "sent", "lease_s": 0.25 }),
            json!({ "event": "tether_truth", "length_m": 1.0, "wrap_max_rad": 0.2, "wrap_total_rad": -0.0, "detour_m": 0.5 }),
            json!({ "event": "progressed", "done": 0.5, "along_m": null, "cross_track_m": 0.1, "target": [1.0, 2.0],
                    "covered_reachable": 0.25, "covered_whole": 0.2, "leg": "swath" }),
            json!({ "event": "tethered", "length_m": 1.0, "free_m": 2.0, "contacts": [{ "on": "C1", "wrap_rad": 0.1, "at": [0.0, 1.0] }],
                    "wrap_max_rad": 0.1, "wrap_total_rad": 0.1, "pull_factor": 1.1, "measured": { "pull_n": 3.5, "slack_m": 0.0 }, "return_length_m": null, "bends": [[0.0, 0.5]] }),
        ];
        for kind in kinds {
            let mut line = json!({ "tick": 26, "t_s": 2.6 });
            line.as_object_mut().unwrap().extend(kind.as_object().unwrap().clone());
            let general: Event = serde_json::from_value(line).unwrap();
            let text = serde_json::to_string(&general).unwrap();
            assert_eq!(event(text.as_bytes()), Some(general), "{text}");
        }
    }

    #[test]
    fn other_lines_are_left_to_the_general_reader() {
        let lines = [
            r#"{"tick":1,"t_s":0.1,"event":"held","by":"operator"}"#,
            r#"{"tick":1,"t_s":0.1,"event":"truth","pose":1}"#,
            r#"{"event":"resumed","tick":1,"t_s":0.1}"#,
            r#"{"tick":1,"t_s":0.1,"event":"shadowed","of":{"event":"resumed"}}"#,
            "",
        ];
        assert!(lines.iter().all(|line| event(line.as_bytes()).is_none()));
    }
}
