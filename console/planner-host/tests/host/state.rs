//! Private state outlives the process that kept it.

use crate::stand::{choose, config, folder_with, step, words};
use mission::planner::Parameters;
use planner_api::Drive;
use planner_host::{BlockingHost, PluginDirs};
use tempfile::TempDir;

/// Counts its steps; its speed is the count in millimetres per second. Aborts at the thirtieth step of its process.
pub const COUNTER: &str = r#"
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

fn host() -> (TempDir, BlockingHost) {
    let (folder, PluginDirs(mut dirs)) = folder_with("counter", COUNTER);
    dirs.extend(crate::stand::built().0);
    (folder, BlockingHost::new(&PluginDirs(dirs), config()))
}

/// Its count after a step.
fn count(host: &mut BlockingHost, tick: u64) -> u32 {
    match step(host, tick).unwrap().value.drive {
        Drive::Twist { v_m_per_s, .. } => (v_m_per_s * 1000.0).round() as u32,
        Drive::Velocity(_) => panic!("it drives by twists"),
    }
}

#[test]
fn a_planner_that_died_goes_on_from_its_last_saved_state() {
    let (_folder, mut host) = host();
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    // The last save within these steps is that of mission time 2 s, after twenty steps.
    let last = (0..29).map(|tick| count(&mut host, tick)).last();
    assert_eq!(last, Some(29));
    step(&mut host, 29).unwrap_err();
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!(count(&mut host, 30), 21);
}

#[test]
fn a_planner_that_is_made_anew_goes_on_from_what_it_knows_now() {
    let (_folder, mut host) = host();
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!((0..5).map(|tick| count(&mut host, tick)).last(), Some(5));
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!(count(&mut host, 5), 6);
}

#[test]
fn state_is_forgotten_when_another_planner_took_over() {
    let (_folder, mut host) = host();
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!((0..15).map(|tick| count(&mut host, tick)).last(), Some(15));
    choose(&mut host, "faulty", &words(&[("fault", "none")])).unwrap();
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!(count(&mut host, 20), 1);
}
