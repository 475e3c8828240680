//! The summaries of very short runs.

use super::*;
use crate::samples::{chosen, fold, full_run, opened, truth, zone_drawn};
use serde_json::json;

#[test]
fn the_text_for_people() {
    insta::assert_snapshot!(human(&full_run()));
}

#[test]
fn the_text_of_a_run_that_was_cut_off() {
    let run = fold(&[(0, opened()), (0, chosen("rpf")), (0, truth(-1.75, 0.0, 0.2, false))]).summary();
    insta::assert_snapshot!(human(&run));
}

#[test]
fn a_zone_drawn_under_way_is_reported_for_every_task_with_who_drew_it_when_and_where() {
    let start = json!({ "event": "ordered", "order": "start" });
    let run = fold(&[(0, opened()), (0, start), (4, zone_drawn(0.0, 0.5))]).summary();
    let line = "no-go zone no-go 1, drawn by the operator at 2.0 s: 2.00 m², corners 0.00, 0.50; 1.00, 0.50; 1.00, 2.50; 0.00, 2.50 m";
    assert!(human(&run).contains(line), "{}", human(&run));
    let early = fold(&[(0, opened()), (0, zone_drawn(0.0, 0.5))]).summary();
    assert!(human(&early).contains("drawn by the operator before the start"), "{}", human(&early));
}
