//! Choices for the details that the text of Wang et al. 2023 leaves open, selected to come near its Table 1.
//!
//! Such a set of choices is a *reading*. The readings here were found by a search that compared some thousands of
//! readings with the printed table. They therefore show that the table is compatible with a reading, but not what the
//! authors did.

use super::{
    fit::Pair,
    method::{Entry, Pairing, Set, base},
    printed,
};
use crate::study::Method;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The note of every row of such a reading.
pub(super) const SELECTED: &str = "chosen to fit the printed table: this shows that the table is \
                                   compatible with this interpretation, but not what the authors did";

/// One set of choices for the open details; every word is a value of a planner parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// Name used in the ids of methods.
    pub name: String,
    /// Gain of the repulsion; that of the pull is 200.
    k_rep: f64,
    push_form: &'static str,
    push_of: &'static str,
    /// Improved repulsion: with or without the component towards the target, and the exponent.
    improved: (&'static str, f64),
    targets: &'static str,
    move_length: &'static str,
    gate: &'static str,
    sense: &'static str,
    beside: &'static str,
    /// Sideways push of `iapf`: strength and side.
    push: (&'static str, &'static str),
    /// The force that acts in addition to that push.
    push_beside: &'static str,
}

/// The readings that came nearest to the table in the search.
pub(super) fn named() -> [Reading; 4] {
    let k1 = Reading {
        name: "K1".into(),
        k_rep: 100.0,
        push_form: "inverse",
        push_of: "nearest",
        improved: ("scaled", 0.5),
        targets: "ahead",
        move_length: "by-force",
        gate: "opposed",
        sense: "counter-clockwise",
        beside: "nothing",
        push: ("half-pull", "right"),
        push_beside: "all",
    };
    let j0 = Reading {
        name: "J0".into(),
        targets: "lock-step",
        gate: "backward",
        beside: "all",
        push: ("unit-pull", "random"),
        ..k1.clone()
    };
    let j1 = Reading {
        name: "J1".into(),
        k_rep: 200.0,
        push_of: "all",
        sense: "side-aware",
        beside: "pull",
        push: ("pull", "alternating"),
        push_beside: "pull",
        ..j0.clone()
    };
    let k0 = Reading {
        name: "K0".into(),
        push_form: "khatib",
        push_of: "nearest",
        improved: ("improved", 0.5),
        targets: "ahead",
        move_length: "to-target",
        push: ("pull", "random"),
        ..j1.clone()
    };
    [k0, k1, j0, j1]
}

/// The methods of a reading, for its rows.
pub(super) fn pair(name: &str) -> Pair {
    let ids = ["vt", "iapf", "rpf"].map(|planner| format!("{planner}/{name}"));
    Pair { name: name.to_owned(), ids, note: SELECTED.to_owned() }
}

impl Reading {
    /// A reading generated from a seed; every open detail is drawn independently.
    pub(super) fn drawn(seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let mut one_of = |words: &[&'static str]| words[rng.random_range(0..words.len())];
        let exponent = one_of(&["0.5", "1", "2"]).parse().unwrap_or(1.0);
        let k_rep = one_of(&["50", "100", "200"]).parse().unwrap_or(200.0);
        Self {
            name: format!("drawn-{seed}"),
            k_rep,
            push_form: one_of(&["khatib", "inverse"]),
            push_of: one_of(&["all", "nearest"]),
            improved: (one_of(&["improved", "scaled"]), exponent),
            targets: one_of(&["lock-step", "ahead"]),
            move_length: one_of(&["to-target", "by-force"]),
            gate: one_of(&["detected", "backward", "opposed"]),
            sense: one_of(&["counter-clockwise", "side-aware"]),
            beside: one_of(&["all", "pull", "nothing"]),
            push_beside: one_of(&["all", "pull"]),
            push: (
                one_of(&["held", "half-pull", "pull", "unit-pull"]),
                one_of(&["repulsion", "right", "random", "alternating"]),
            ),
        }
    }

    /// The six methods of Table 1 in this reading, the first three with classic repulsion.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        for (is_improved, rows) in [(false, printed::TABLE1_CLASSIC), (true, printed::TABLE1_IMPROVED)] {
            for (planner, row) in ["vt", "iapf", "rpf"].into_iter().zip(rows) {
                let set = Set::Reading(self.name.clone());
                let printed = row.map(Some);
                let pairing = if self.targets == "ahead" { Pairing::Ahead } else { Pairing::Index };
                entries.push(Entry { method: self.method(planner, is_improved), printed, pairing, set });
            }
        }
        entries
    }

    /// The choices as text, so that they can be repeated.
    pub(super) fn words(&self) -> String {
        let ((repulsion, exponent), (push, side)) = (self.improved, self.push);
        format!(
            "k_rep={} push_form={} push_of={} repulsion={repulsion} exponent={exponent} targets={} \
             move_length={} gate={} sense={} beside={} push={push} push_side={side} push_beside={}",
            self.k_rep,
            self.push_form,
            self.push_of,
            self.targets,
            self.move_length,
            self.gate,
            self.sense,
            self.beside,
            self.push_beside
        )
    }

    fn method(&self, planner: &str, is_improved: bool) -> Method {
        let id = format!("{planner}/{}{}", self.name, if is_improved { "+ir" } else { "" });
        let (improved, exponent) = self.improved;
        let method = base(Method::new(id, planner, SELECTED))
            .number("k_rep", self.k_rep)
            .number("exponent", exponent)
            .word("repulsion", if is_improved { improved } else { "classic" })
            .word("gate", self.gate)
            .word("push_form", self.push_form)
            .word("push_of", self.push_of)
            .word("targets", self.targets)
            .word("move_length", self.move_length);
        match planner {
            "rpf" => method
                .word("reading", "gated")
                .word("sense", self.sense)
                .word("rotation", "literal")
                .word("beside", self.beside)
                .word("planning", "lock-step")
                .number("k_rot", 200.0),
            "iapf" => method
                .word("push", self.push.0)
                .word("push_side", self.push.1)
                .word("beside", self.push_beside),
            _ => method,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_seed_draws_one_reading_and_others_draw_others() {
        assert_eq!(Reading::drawn(7), Reading::drawn(7));
        let words: BTreeSet<String> = (0..40).map(|seed| Reading::drawn(seed).words()).collect();
        assert!(words.len() > 35);
    }

    #[test]
    fn every_reading_has_the_six_methods_of_the_table() {
        for reading in named() {
            let ids: Vec<String> = reading.entries().into_iter().map(|entry| entry.method.id).collect();
            let name = &reading.name;
            assert_eq!(ids[..3], ["vt", "iapf", "rpf"].map(|planner| format!("{planner}/{name}")));
            assert_eq!(ids[3..], ["vt", "iapf", "rpf"].map(|planner| format!("{planner}/{name}+ir")));
        }
    }
}
