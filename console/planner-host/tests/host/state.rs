//! Private state outlives the process that kept it.

use crate::desk::{Desk, ONE, TWO, opening, step};
use crate::stand::{self, built, choose, config, folder_with};
use mission::planner::Parameters;
use mission::{AskId, Cause, Given, What};
use planner_api::{Command, Drive};
use planner_host::{BlockingHost, PluginDirs};
use tempfile::TempDir;

/// Counts its steps; its speed is the count in millimetres per second. Aborts at the thirtieth step of its process.
pub(crate) const COUNTER: &str = r#"
#include "tankops_planner.h"
#include <stdlib.h>
#include <string.h>
typedef struct { uint32_t count, in_this_process; } counter;
static int32_t describe(const tp_host *h) { (void)h; return TP_OK; }
static int32_t create(const tp_host *h, const tp_site *s, const tp_value *v, uint32_t n, void **out) {
  (void)h; (void)s; (void)v; (void)n;
  *out = calloc(1, sizeof(counter));
  return *out ? TP_OK : TP_E_INTERNAL;
}
static void destroy(void *p) { free(p); }
static int32_t plan(void *p, const tp_host *h, const tp_plan_in *in, tp_plan_out *out) {
  (void)p; (void)h; (void)in;
  out->cost = 0.0; out->complete = 1;
  return TP_OK;
}
static int32_t step(void *p, const tp_host *h, const tp_step_in *in, tp_step_out *out) {
  counter *c = p;
  (void)h; (void)in;
  if (++c->in_this_process >= 30) abort();
  c->count++;
  out->drive = TP_TWIST; out->status = TP_MOVING; out->a = 0.001 * c->count; out->b = 0.0;
  return TP_OK;
}
static int32_t snapshot(void *p, const tp_host *h) {
  h->bytes(h->ctx, p, sizeof(uint32_t));
  return TP_OK;
}
static int32_t restore(void *p, const tp_host *h, uint32_t version, const uint8_t *state, size_t n) {
  (void)h;
  if (version != 7 || n != sizeof(uint32_t)) return TP_E_STATE;
  memcpy(p, state, n);
  return TP_OK;
}
static const tp_planner planner = {
  sizeof(tp_planner), TP_CAP_LOCAL | TP_CAP_SNAPSHOT, 7, 0, TP_STR("counter"), TP_STR("Counter"), TP_STR("1"),
  TP_STR(""), describe, create, destroy, plan, step, 0, 0, snapshot, restore, 0};
static const tp_planner *const list[] = {&planner};
TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(list, 1, "C");
TP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);
"#;

/// The count that the speed of a counter's command encodes.
pub(crate) fn counted(command: &Command) -> u32 {
    match command.drive {
        Drive::Twist { v_m_per_s, .. } => (v_m_per_s * 1000.0).round() as u32,
        Drive::Velocity(_) => panic!("it drives by twists"),
    }
}

fn counters() -> (TempDir, Desk) {
    let (folder, dirs) = folder_with("counter", COUNTER);
    let desk = Desk::new(&dirs, config());
    (folder, desk)
}

fn open(restore: Option<AskId>) -> What {
    opening("counter", &Parameters::new(), restore)
}

#[test]
fn a_state_that_was_saved_under_an_ask_is_restored_in_another_worker() {
    let (_folder, mut desk) = counters();
    desk.ask(ONE, open(None)).unwrap();
    assert_eq!((0..3).map(|tick| desk.count(ONE, tick)).last(), Some(3));
    let saved = desk.save(ONE);
    assert_eq!(desk.count(ONE, 3), 4);
    desk.submit(ONE, What::Close);
    desk.ask(TWO, open(Some(saved))).unwrap();
    assert_eq!(desk.count(TWO, 4), 4, "the state outlives its worker");
    let unknown = AskId { worker: ONE, n: 1 };
    desk.ask(ONE, open(Some(unknown))).unwrap();
    assert_eq!(desk.count(ONE, 0), 1, "without a state it starts fresh");
}

#[test]
fn a_planner_that_died_goes_on_from_its_last_saved_state() {
    let (_folder, mut desk) = counters();
    desk.ask(ONE, open(None)).unwrap();
    let mut saved = None;
    for tick in 0..29 {
        if tick % 10 == 0 {
            saved = Some(desk.save(ONE));
        }
        assert_eq!(u64::from(desk.count(ONE, tick)), tick + 1);
    }
    assert_eq!(desk.ask(ONE, step(29)).unwrap_err().cause, Cause::Died);
    desk.ask(TWO, open(saved)).unwrap();
    assert_eq!(desk.count(TWO, 30), 21);
}

#[test]
fn a_planner_that_takes_over_from_a_living_one_goes_on_from_what_that_knows() {
    let (_folder, mut desk) = counters();
    desk.ask(ONE, open(None)).unwrap();
    assert_eq!((0..5).map(|tick| desk.count(ONE, tick)).last(), Some(5));
    let saved = desk.save(ONE);
    desk.ask(TWO, open(Some(saved))).unwrap();
    desk.submit(ONE, What::Close);
    assert_eq!(desk.count(TWO, 5), 6);
}

#[test]
fn the_state_of_another_planner_is_not_restored() {
    let (_counter, PluginDirs { folders: mut dirs, .. }) = folder_with("counter", COUNTER);
    let (_twin, twin) = folder_with("twin", &COUNTER.replace("TP_STR(\"counter\")", "TP_STR(\"twin\")"));
    dirs.extend(twin.folders);
    let mut desk = Desk::new(&PluginDirs::of(dirs), config());
    desk.ask(ONE, open(None)).unwrap();
    assert_eq!((0..15).map(|tick| desk.count(ONE, tick)).last(), Some(15));
    let saved = desk.save(ONE);
    desk.ask(TWO, opening("twin", &Parameters::new(), Some(saved))).unwrap();
    assert_eq!(desk.count(TWO, 15), 1, "it would understand the state");
    desk.ask(TWO, open(Some(saved))).unwrap();
    assert_eq!(desk.count(TWO, 16), 16, "the planner that saved the state can still have it");
}

#[test]
fn the_state_of_another_file_is_not_restored() {
    let (folder, mut desk) = counters();
    desk.ask(ONE, open(None)).unwrap();
    assert_eq!((0..15).map(|tick| desk.count(ONE, tick)).last(), Some(15));
    let saved = desk.save(ONE);
    // Meanwhile, the plugin was built again from different lines.
    let (newer, _) = folder_with("counter", &COUNTER.replace("TP_STR(\"1\")", "TP_STR(\"2\")"));
    let file = "libplanner_counter.so";
    std::fs::rename(newer.path().join(file), folder.path().join(file)).unwrap();
    assert!(matches!(desk.ask(TWO, open(Some(saved))), Ok(Given::Opened(info)) if info.version == "2"));
    assert_eq!(desk.count(TWO, 15), 1, "it would understand the state");
}

#[test]
fn a_planner_without_a_state_gives_none() {
    let mut desk = Desk::new(&built(), config());
    desk.open(ONE, "none");
    assert_eq!(desk.ask(ONE, What::Snapshot), Ok(Given::State { bytes: 0 }));
    let refuses = "{ (void)p; (void)h; return TP_E_STATE; }";
    let gives = "{\n  h->bytes(h->ctx, p, sizeof(uint32_t));\n  return TP_OK;\n}";
    let (_folder, dirs) = folder_with("counter", &COUNTER.replace(gives, refuses));
    let mut desk = Desk::new(&dirs, config());
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    assert_eq!(desk.ask(ONE, What::Snapshot), Ok(Given::State { bytes: 0 }));
    assert_eq!((desk.count(ONE, 0), desk.host.stats().faults), (1, 0));
}

#[test]
fn a_host_that_waits_saves_no_state() {
    let (_folder, dirs) = folder_with("counter", COUNTER);
    let mut host = BlockingHost::new(&dirs, config());
    for _ in 0..2 {
        choose(&mut host, "counter", &Parameters::new()).unwrap();
        let counts = (0..15).map(|tick| counted(&stand::step(&mut host, tick).unwrap().value));
        assert_eq!(counts.last(), Some(15));
    }
}
