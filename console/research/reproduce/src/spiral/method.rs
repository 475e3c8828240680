//! The paper's methods, each as one of our planners with its parameters.

use super::{
    fit::Pair,
    printed::{self, Printed},
};
use crate::study::Method;

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    /// The planner, without its obstacle range.
    pub method: Method,
    /// The printed values for the three distributions; `None` where planning failed or nothing is printed.
    pub printed: [Option<Printed>; 3],
    /// The rule that assigns a preset point to a planned point.
    pub pairing: Pairing,
    /// The family of the method.
    pub set: Set,
}

/// A family of methods that are planned and reported together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Set {
    /// The methods of the text, and ours.
    Text,
    /// The methods of the reading with this name. It was chosen to fit the printed table, with obstacles drawn in the
    /// square.
    Reading(String),
}

/// The preset point with which a planned point is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pairing {
    /// The point with the same index, as in the paper's formulas.
    Index,
    /// The target of the move, which is always the point after the nearest one ahead.
    Ahead,
    /// The nearest place ahead on the preset path; for paths with their own points.
    Forward,
}

const RECONSTRUCTED: &str = "the cited source is not available: reconstructed from one sentence";
const GATED: &str = "rotating force only in a trap that our detector finds, and for ten more moves; in \
                     the text it is always on";
const FORWARD: &str =
    "reactive: the path's own points are compared with the nearest place ahead on the preset path";
const LITERAL: &str = "rotating force always on, as in the text; cannot give the printed figures";

/// The methods of Table 1, each without and with improved repulsion; the rotating field in both readings.
pub(super) fn of_table1() -> Vec<Entry> {
    let both = |improved: bool| {
        let rows = if improved { &printed::TABLE1_IMPROVED } else { &printed::TABLE1_CLASSIC };
        let entry = |id: &str, reading, row: Option<usize>, note| {
            let printed = row.map_or([None; 3], |row| rows[row].map(Some));
            let pairing = Pairing::Index;
            Entry { method: method(id, reading, improved, note), printed, pairing, set: Set::Text }
        };
        [
            entry("apf", None, None, "fails in the paper too"),
            entry("vt", None, Some(0), RECONSTRUCTED),
            entry("iapf", None, Some(1), RECONSTRUCTED),
            entry("rpf", Some("gated"), Some(2), GATED),
            entry("rpf", Some("literal"), Some(2), LITERAL),
        ]
    };
    [both(false), both(true)].concat()
}

/// The two readings of the text, compared with our reconstruction of IAPF.
pub(super) fn pairs() -> [Pair; 2] {
    [("gated", GATED), ("literal", LITERAL)].map(|(name, note)| Pair {
        name: name.to_owned(),
        ids: ["vt".to_owned(), "iapf".to_owned(), format!("rpf/{name}")],
        note: note.to_owned(),
    })
}

fn method(planner: &str, reading: Option<&str>, improved: bool, note: &'static str) -> Method {
    let reading_id = reading.map(|reading| format!("/{reading}")).unwrap_or_default();
    let id = format!("{planner}{reading_id}{}", if improved { "+ir" } else { "" });
    let method = base(Method::new(id, planner, note));
    let method = method.word("repulsion", if improved { "improved" } else { "classic" });
    let Some(reading) = reading else { return method };
    let words = [
        ("reading", reading),
        ("rotation", "literal"),
        ("sense", "counter-clockwise"),
        ("planning", "lock-step"),
    ];
    words.iter().fold(method, |m, (key, word)| m.word(key, word)).number("k_rot", 200.0)
}

/// Sets the gains of Table 1.
pub(super) fn base(method: Method) -> Method {
    let gains = [("k_att", 200.0), ("k_rep", 200.0), ("step_m", 0.2), ("wall_gain", 0.0)];
    gains.iter().fold(method, |method, (key, value)| method.number(key, *value))
}

/// The rotating field with improved repulsion and the gains of Table 2.
pub(super) fn of_table2(k_att: f64, rho_0_m: f64, note: &'static str) -> Method {
    let gains = [("k_att", k_att), ("k_rot", k_att), ("k_rep", 100.0), ("rho_0_m", rho_0_m)];
    let method = method("rpf", Some("gated"), true, note);
    gains.iter().fold(method, |method, (key, value)| method.number(key, *value))
}

/// Our own followers; the lattice also without its turn limit, which shows the cost of the limit.
pub(super) fn followers() -> Vec<Entry> {
    let entry = |method, pairing| Entry { method, printed: [None; 3], pairing, set: Set::Text };
    let lattice = |id: &str, note| Method::new(id, "spiral-lattice", note);
    vec![
        entry(lattice("spiral-lattice", ""), Pairing::Index),
        entry(
            lattice("spiral-lattice/turn-free", "without its turn limit").number("turn_deg", 0.0),
            Pairing::Index,
        ),
        entry(Method::new("spiral-tangent", "spiral-tangent", FORWARD), Pairing::Forward),
    ]
}
