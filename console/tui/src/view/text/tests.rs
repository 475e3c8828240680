//! Tests of the wording helpers.

use super::*;

#[test]
fn a_meter_marks_where_the_limit_is_close() {
    assert_eq!([0.0, 0.5, 1.2].map(meter), ["░░░░░░┊░", "████░░┊░", "██████┊█"]);
    assert_eq!(meter(f64::NAN), "░░░░░░┊░");
}

#[test]
fn numbers_without_a_value_are_a_dash_and_zero_has_no_sign() {
    assert_eq!([number(f64::NAN, 2), number(-0.001, 2), number(-1.005, 1)], ["-", "0.00", "-1.0"]);
}

#[test]
fn an_age_has_one_unit() {
    let ages = [-5.0, 59.9, 60.0, 7300.0, 200_000.0, -100.0, f64::NAN].map(ago);
    assert_eq!(ages, ["0 s", "59 s", "1 min", "2 h", "2 d", "-", "-"]);
}

#[test]
fn long_text_is_cut_with_an_ellipsis() {
    assert_eq!([fit("tank-07", 7), fit("tank-07", 5), fit("tank", 0)], ["tank-07", "tank…", ""]);
    assert_eq!(column("ae", 4), "ae  ");
}

#[test]
fn the_fullest_wording_that_fits_is_taken() {
    let at = |columns| wording(["standing still".to_owned(), "still".to_owned()], columns);
    assert_eq!([at(14), at(13), at(2)], ["standing still", "still", "still"]);
}

#[test]
fn a_cut_is_between_words_unless_little_would_remain() {
    let action = "Exclude station C (largest residual, +1.75 m)";
    assert_eq!(fit(action, 42), "Exclude station C (largest residual…");
    assert_eq!(fit(action, 20), "Exclude station C…");
    assert_eq!(fit("a 20261130T002200Z-cover-circle", 20), "a 20261130T002200Z-…");
    assert_eq!(fit(action, 45), action);
}

#[test]
fn a_sentence_loses_whole_clauses_and_a_list_whole_names() {
    let sentence = "12 MB free, 91 MB needed; delete runs";
    let at = |columns| clauses(sentence, columns);
    assert_eq!([at(37), at(36), at(23)], [sentence, "12 MB free, 91 MB needed", "12 MB free"]);
    assert_eq!([at(5), clauses("at 14:10:00", 9)], ["12 M…", "at 14:10…"]);
    assert_eq!(
        clauses("spiral: floor left out around (-5.7, 4.2): too narrow", 36).chars().last(),
        Some('…')
    );
    // A single word after a colon, a comma or a question mark would say nothing.
    assert_eq!(
        clauses("plan: shell: along 0.4 m of it, the scan is wider", 32),
        "plan: shell: along 0.4 m of it"
    );
    assert_eq!(clauses("plan: shell: along 0.4 m of it", 20), "plan: shell: along…");
    assert_eq!(clauses("Go on? Enter: change, Esc: cancel", 30), "Go on? Enter: change, Esc…");
    let at = |columns| names(&["apf", "rpf", "navfn"], columns);
    assert_eq!([at(13), at(12), at(6), at(1)], ["apf rpf navfn", "apf rpf +1", "apf +2", "3"]);
}

#[test]
fn times_are_written_as_clocks() {
    assert_eq!(clock(2480.9), "00:41:20");
    assert_eq!(degrees(-std::f64::consts::FRAC_PI_2), "270");
    assert_eq!(degrees(-1e-9), "0");
}

#[test]
fn a_curve_begins_at_the_left_and_keeps_the_largest_value_of_each_column() {
    let mut history = History::default();
    for (t_s, value) in [(0.0, 0.0), (4.0, 1.0), (8.0, 0.5)] {
        history.add(t_s, value);
    }
    let at = |columns| sparkline(&history, 120, 1.0, columns);
    assert_eq!([at(5), at(15)], ["█    ", "▁█▅            "]);
    assert_eq!(at(30).trim_end(), "▁▁██▅▅", "the first minute from the left, without gaps");
}

#[test]
fn a_curve_has_a_gap_while_no_values_came() {
    let mut history = History::default();
    for t_s in [0.0, 4.0, 52.0, 56.0] {
        history.add(t_s, 1.0);
    }
    assert_eq!(sparkline(&history, 60, 1.0, 15), "██           ██");
}

#[test]
fn items_are_not_divided_between_lines() {
    let items = ["a 1", "bb 22", "c 3"].map(str::to_owned);
    assert_eq!(wrap_items(&items, 11, "  "), ["a 1  bb 22", "c 3"]);
    assert_eq!(wrap_items(&items, 4, "  "), ["a 1", "bb…", "c 3"]);
}

#[test]
fn words_are_wrapped_and_none_is_lost() {
    let lines = wrap("one planner drives at a time", 12);
    assert_eq!(lines, ["one planner", "drives at a", "time"]);
}

#[test]
fn a_number_and_its_unit_stay_in_one_line() {
    assert_eq!(wrap("tether out 11.8 m, wrap", 18), ["tether out", "11.8 m, wrap"]);
    assert_eq!(wrap("about 5 % (limit 3.0 m).", 19), ["about 5 % (limit", "3.0 m)."]);
    assert_eq!(wrap("area 12 m", 9), ["area", "12 m"]);
    assert_eq!(wrap("column C2 m", 10), ["column", "C2 m"], "a name may end in a digit");
    assert_eq!(wrap("5 m", 2), ["5", "m"], "even a number and its unit may be too long");
    assert_eq!([capitalized("cell_m 0.025"), capitalized("path 2 m")], ["cell_m 0.025", "Path 2 m"]);
}

#[test]
fn a_long_word_is_divided_behind_a_mark_if_it_has_one() {
    let lines = wrap("kept in logs/20261129T171737Z-tether-cart/events.jsonl", 20);
    assert_eq!(lines, ["kept in logs/", "20261129T171737Z-", "tether-cart/", "events.jsonl"]);
    assert_eq!(wrap("abcdefgh", 3), ["abc", "def", "gh"]);
    assert_eq!(wrap("word", 0), ["word"]);
}
