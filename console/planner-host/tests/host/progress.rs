//! Progress of a plan reaches whoever requested it, and reporting progress never extends a deadline.

use crate::desk::{self, Desk, ONE, opening};
use crate::stand::{assert_another_drives, choose, config, folder_with, host, impatient, plan, words};
use crate::state::COUNTER;
use mission::Cause;
use mission::planner::Parameters;
use planner_host::{BlockingHost, OnProgress, PluginDirs, Progress};
use std::sync::{Arc, Mutex};
use std::time::Instant;
use tempfile::TempDir;

type Received = Arc<Mutex<Vec<Progress>>>;

fn recording() -> (Received, OnProgress) {
    let received = Received::default();
    let recorded = Arc::clone(&received);
    (received, Arc::new(move |_, progress| recorded.lock().unwrap().push(progress.clone())))
}

fn recorded(host: &mut BlockingHost) -> Received {
    let (received, on_progress) = recording();
    host.set_on_progress(on_progress);
    received
}

/// The counter in C with parts of its source replaced.
fn counters(replaced: &[(&str, &str)]) -> (TempDir, PluginDirs) {
    let mut source = COUNTER.to_owned();
    for (old, new) in replaced {
        assert!(source.contains(old), "{old}");
        source = source.replace(old, new);
    }
    folder_with("counter", &source)
}

fn counter(replaced: &[(&str, &str)]) -> (TempDir, BlockingHost) {
    let (folder, dirs) = counters(replaced);
    let mut host = BlockingHost::new(&dirs, config());
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    (folder, host)
}

const PLAN: &str = "out->cost = 0.0; out->complete = 1;";

#[test]
fn a_planner_in_c_reports_the_progress_of_its_plan() {
    let reports = "
      char flood[300]; memset(flood, 'x', sizeof flood);
      if (!TP_HOST_HAS(h, progress)) return TP_E_INTERNAL;
      h->progress(h->ctx, 0.0 / 0.0, \"no number\", 9);
      h->progress(h->ctx, 0.25, \"one\\x1b[31m\", 8);
      h->progress(h->ctx, 0.5, \"too soon after\", 14);
      h->progress(h->ctx, 7.0, flood, sizeof flood);
      double began = h->time_left_s(h->ctx);
      while (began - h->time_left_s(h->ctx) < 0.1) h->should_stop(h->ctx);
      h->should_stop(h->ctx);
      h->progress(h->ctx, 1.0 / 0.0, 0, 99);
      h->progress(h->ctx, -1.0, 0, 0);
      began = h->time_left_s(h->ctx);
      while (began - h->time_left_s(h->ctx) < 0.1) h->should_stop(h->ctx);
      h->should_stop(h->ctx);";
    let (_folder, mut host) = counter(&[(PLAN, &format!("{reports} {PLAN}"))]);
    let received = recorded(&mut host);
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    plan(&mut host).unwrap();
    let progress = |share, what: &str| Progress { share, what: what.to_owned() };
    let all = [progress(0.25, "one\u{fffd}[31m"), progress(1.0, &"x".repeat(80)), progress(0.0, "")];
    assert_eq!(*received.lock().unwrap(), all);
    plan(&mut host).unwrap();
    assert_eq!(received.lock().unwrap().len(), 6, "progress of the next plan is reported as well");
}

#[test]
fn progress_outside_of_a_plan_is_ignored() {
    let report = "h->progress(h->ctx, 0.5, \"anywhere\", 8);";
    let (_folder, dirs) = counters(&[
        ("{ (void)h; return TP_OK; }", &format!("{{ {report} return TP_OK; }}")),
        ("(void)h; (void)s;", &format!("{report} (void)s;")),
        ("(void)h; (void)in;\n  if", &format!("{report} (void)in;\n  if")),
        ("h->bytes(", &format!("{report} h->bytes(")),
    ]);
    let (received, on_progress) = recording();
    let mut desk = Desk::new(&dirs, config());
    desk.host.set_on_progress(on_progress);
    desk.ask(ONE, opening("counter", &Parameters::new(), None)).unwrap();
    desk.ask(ONE, desk::plan()).unwrap();
    assert_eq!((0..3).map(|tick| desk.count(ONE, tick)).last(), Some(3));
    desk.save(ONE);
    assert_eq!(*received.lock().unwrap(), []);
}

#[test]
fn a_plugin_built_for_an_older_minor_version_is_loaded_and_plans() {
    for minor in [1, 4] {
        let older =
            format!("#include \"tankops_planner.h\"\n#undef TP_ABI_MINOR\n#define TP_ABI_MINOR {minor}u\n");
        let (_folder, mut host) = counter(&[("#include \"tankops_planner.h\"\n", &older)]);
        let info = choose(&mut host, "counter", &Parameters::new()).unwrap();
        assert_eq!(info.abi, format!("1.{minor}"));
        assert!(plan(&mut host).unwrap().value.complete);
    }
}

#[test]
fn a_planner_that_reports_progress_endlessly_is_killed_like_any_that_hangs() {
    let mut host = host(impatient());
    let received = recorded(&mut host);
    choose(&mut host, "faulty", &words(&[("fault", "plan_progress")])).unwrap();
    let asked = Instant::now();
    let fault = plan(&mut host).unwrap_err();
    assert_eq!(fault.cause, Cause::Hung, "{fault}");
    let most = 21.0 + 40.0 * asked.elapsed().as_secs_f64();
    assert!((received.lock().unwrap().len() as f64) <= most, "it cannot flood the console");
    assert_another_drives(&mut host);
}
