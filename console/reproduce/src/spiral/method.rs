//! The paper's methods as planners of ours with their parameters.

use super::printed::{self, Printed};
use mission::{ParamValue, Parameters};

/// A planner set up for a column of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Method {
    /// Its id in rows.
    pub id: String,
    /// The planner.
    pub planner: String,
    /// Its parameters, without the range of obstacles.
    pub parameters: Parameters,
    /// What the paper prints for the three distributions; none where planning failed or nothing is printed.
    pub printed: [Option<Printed>; 3],
    /// What a reader must know.
    pub note: &'static str,
    /// Which preset point a planned point belongs to.
    pub pairing: Pairing,
}

/// Which preset point a planned point is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pairing {
    /// That of the same index, as the paper's formulas have it.
    Index,
    /// The nearest place of the preset path ahead; for paths with points of their own.
    Forward,
}

const RECONSTRUCTED: &str = "the cited source is not at hand: reconstructed from one sentence";
const GATED: &str =
    "rotating force only in a trap; nearest to the printed level, though the text has it always on";
const FORWARD: &str = "reactive: points of its own, compared with the nearest place of the preset path ahead";
const LITERAL: &str = "rotating force always on, as the text has it; cannot give the printed figures";

/// The methods of Table 1, the rotating field in both readings, without and with improved repulsion.
pub(super) fn of_table1() -> Vec<Method> {
    let both = |improved: bool| {
        let rows = if improved { &printed::TABLE1_IMPROVED } else { &printed::TABLE1_CLASSIC };
        [
            method("apf", "apf", None, improved, [None; 3], "fails in the paper too"),
            method("vt", "vt", None, improved, rows[0].map(Some), RECONSTRUCTED),
            method("iapf", "iapf", None, improved, rows[1].map(Some), RECONSTRUCTED),
            method("rpf/gated", "rpf", Some("gated"), improved, rows[2].map(Some), GATED),
            method("rpf/literal", "rpf", Some("literal"), improved, rows[2].map(Some), LITERAL),
        ]
    };
    [both(false), both(true)].concat()
}

fn method(
    id: &str,
    planner: &'static str,
    reading: Option<&str>,
    improved: bool,
    printed: [Option<Printed>; 3],
    note: &'static str,
) -> Method {
    let mut parameters: Parameters =
        [("k_att", 200.0), ("k_rep", 200.0), ("step_m", 0.2), ("wall_gain", 0.0)]
            .map(|(key, value)| (key.to_owned(), ParamValue::Float(value)))
            .into();
    let mut word = |key: &str, value: &str| parameters.insert(key.into(), ParamValue::Word(value.into()));
    word("repulsion", if improved { "improved" } else { "classic" });
    if let Some(reading) = reading {
        word("reading", reading);
        word("rotation", "literal");
        word("sense", "counter-clockwise");
        word("planning", "lock-step");
        parameters.insert("k_rot".into(), ParamValue::Float(200.0));
    }
    let id = if improved { format!("{id}+ir") } else { id.to_owned() };
    Method { id, planner: planner.to_owned(), parameters, printed, note, pairing: Pairing::Index }
}

/// The rotating field with improved repulsion and the gains of Table 2.
pub(super) fn of_table2(k_att: f64) -> Method {
    let mut method = method("rpf/gated", "rpf", Some("gated"), true, [None; 3], "");
    for (key, value) in [("k_att", k_att), ("k_rot", k_att), ("k_rep", 100.0)] {
        method.parameters.insert(key.into(), ParamValue::Float(value));
    }
    method
}

/// Our own followers; the lattice also without its turn limit, which shows what the limit costs.
pub(super) fn followers() -> Vec<Method> {
    let plain = |id: &str, planner: &str, parameters, note, pairing| Method {
        id: id.to_owned(),
        planner: planner.to_owned(),
        parameters,
        printed: [None; 3],
        note,
        pairing,
    };
    let without_limit = Parameters::from([("turn_deg".to_owned(), ParamValue::Float(0.0))]);
    vec![
        plain("spiral-lattice", "spiral-lattice", Parameters::new(), "", Pairing::Index),
        plain(
            "spiral-lattice/turn-free",
            "spiral-lattice",
            without_limit,
            "without its turn limit",
            Pairing::Index,
        ),
        plain("spiral-tangent", "spiral-tangent", Parameters::new(), FORWARD, Pairing::Forward),
    ]
}
