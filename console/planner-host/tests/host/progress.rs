//! How far a plan is reaches whoever asked for it, and nothing that a planner tells gains it time.

use crate::stand::{assert_another_drives, choose, config, folder_with, host, impatient, plan, step, words};
use crate::state::COUNTER;
use mission::Cause;
use mission::planner::Parameters;
use planner_host::{BlockingHost, Progress};
use std::sync::{Arc, Mutex};

type Heard = Arc<Mutex<Vec<Progress>>>;

fn hearing(host: &mut BlockingHost) -> Heard {
    let heard = Heard::default();
    let hearing = Arc::clone(&heard);
    host.tell_progress(Arc::new(move |_, progress| hearing.lock().unwrap().push(progress.clone())));
    heard
}

/// The counter in C with other lines at the top of its functions.
fn counter(replaced: &[(&str, &str)]) -> (tempfile::TempDir, BlockingHost) {
    let mut source = COUNTER.to_owned();
    for (old, new) in replaced {
        assert!(source.contains(old), "{old}");
        source = source.replace(old, new);
    }
    let (folder, dirs) = folder_with("counter", &source);
    let mut host = BlockingHost::new(&dirs, config());
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    (folder, host)
}

const PLAN: &str = "out->cost = 0.0; out->complete = 1;";

#[test]
fn a_planner_in_c_tells_how_far_its_plan_is() {
    let tells = "
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
    let (_folder, mut host) = counter(&[(PLAN, &format!("{tells} {PLAN}"))]);
    let heard = hearing(&mut host);
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    plan(&mut host).unwrap();
    let told = |share, what: &str| Progress { share, what: what.to_owned() };
    let all = [told(0.25, "one [31m"), told(1.0, &"x".repeat(80)), told(0.0, "")];
    assert_eq!(*heard.lock().unwrap(), all);
    plan(&mut host).unwrap();
    assert_eq!(heard.lock().unwrap().len(), 6, "the next plan tells as well");
}

#[test]
fn progress_outside_of_a_plan_goes_nowhere_and_harms_nobody() {
    let tell = "h->progress(h->ctx, 0.5, \"anywhere\", 8);";
    let (_folder, mut host) = counter(&[
        ("{ (void)h; return TP_OK; }", &format!("{{ {tell} return TP_OK; }}")),
        ("(void)h; (void)s;", &format!("{tell} (void)s;")),
        ("(void)h; (void)in;\n  if", &format!("{tell} (void)in;\n  if")),
        ("h->bytes(", &format!("{tell} h->bytes(")),
    ]);
    let heard = hearing(&mut host);
    choose(&mut host, "counter", &Parameters::new()).unwrap();
    plan(&mut host).unwrap();
    (0..12).for_each(|tick| drop(step(&mut host, tick).unwrap()));
    assert_eq!(*heard.lock().unwrap(), []);
}

#[test]
fn a_plugin_built_for_version_1_1_is_loaded_and_plans() {
    let older = "#include \"tankops_planner.h\"\n#undef TP_ABI_MINOR\n#define TP_ABI_MINOR 1u\n";
    let (_folder, mut host) = counter(&[("#include \"tankops_planner.h\"\n", older)]);
    let info = choose(&mut host, "counter", &Parameters::new()).unwrap();
    assert_eq!(info.abi, "1.1");
    assert!(plan(&mut host).unwrap().value.complete);
}

#[test]
fn a_planner_that_tells_progress_without_end_is_killed_like_any_that_hangs() {
    let mut host = host(impatient());
    let heard = hearing(&mut host);
    choose(&mut host, "faulty", &words(&[("fault", "plan_progress")])).unwrap();
    let fault = plan(&mut host).unwrap_err();
    assert_eq!(fault.cause, Cause::Hung, "{fault}");
    assert!(heard.lock().unwrap().len() < 100, "it cannot flood the console");
    assert_another_drives(&mut host);
}
