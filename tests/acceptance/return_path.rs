//! The drill of the operator guide: a cart blocks the return path along the tether, and leaves it again.

use crate::bench::{Bench, scenario};

#[test]
fn a_blocked_return_path_holds_the_robot_until_it_is_free() {
    let bench = Bench::new();
    let script = bench.file("return_path.txt", include_str!("return_path.txt"));
    let cart = scenario("tether-cart.toml");
    let words = ["console", cart.to_str().unwrap(), "--script", script.to_str().unwrap()];
    let ended = bench.tankops(&words);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let run = bench.runs().remove(0);
    let events = bench.tankops(&["events", run.to_str().unwrap()]).out;
    let at = |text: &str| events.find(text).unwrap_or_else(|| panic!("{text} in {events}"));
    let held = at(r#""event":"held","by":{"tether":{"message":"no return path: hull does not fit"}}"#);
    assert!(held < at(r#""event":"resumed""#), "held, then resumed");
    assert!(!events.contains(r#""order":"resume""#), "without an order");
}
