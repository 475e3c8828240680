//! Progress indicators on stderr during slow work.

use flight::plan_watch::{OnWork, Work};
use indicatif::{ProgressBar, ProgressStyle};
use planner_host::{OnProgress, Progress};
use std::{
    io::IsTerminal,
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

/// The interval at which the elapsed time is redrawn.
const EVERY: Duration = Duration::from_millis(250);

/// Shows the work in progress with its elapsed time and limit; hidden if stderr is not a terminal.
pub(crate) fn spinner(work: &str, limit: Duration) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner().with_message(words(work, Some(limit)));
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed} elapsed");
    let spinner = spinner.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.enable_steady_tick(EVERY);
    spinner
}

/// Shows the progress of a plan.
pub(crate) fn show_share(bar: &ProgressBar, work: &str, progress: &Progress) {
    if !bar.is_hidden() {
        bar.set_message(format!("{work}: {}", share(progress)));
    }
}

/// Callbacks that show the planners' slow work and its progress in an existing bar.
pub(crate) fn shown_in(bar: &ProgressBar) -> (OnWork, OnProgress) {
    let current: Arc<Mutex<Option<Work>>> = Arc::default();
    let (shown, work) = (bar.clone(), Arc::clone(&current));
    let on_work: OnWork = Box::new(move |new| {
        *work.lock().unwrap_or_else(PoisonError::into_inner) = new.cloned();
        match new {
            None => {
                shown.disable_steady_tick();
                shown.set_message("");
            }
            Some(Work { what, limit, .. }) if !shown.is_hidden() => {
                shown.set_message(words(what, *limit));
                shown.enable_steady_tick(EVERY);
            }
            Some(_) => {}
        }
    });
    let shown = bar.clone();
    let on_progress: OnProgress = Arc::new(move |ask, progress| {
        let current = current.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(work) = current.as_ref().filter(|work| work.ask == ask) {
            show_share(&shown, &work.what, progress);
        }
    });
    (on_work, on_progress)
}

fn words(work: &str, limit: Option<Duration>) -> String {
    let limit = limit.map(|limit| format!(", limit {} s", limit.as_secs()));
    work.to_owned() + &limit.unwrap_or_default()
}

/// Shows 100 % only once the plan has arrived.
fn share(progress: &Progress) -> String {
    let percent = (100.0 * progress.share).floor().min(99.0);
    if progress.what.is_empty() { format!("{percent} %") } else { format!("{percent} %, {}", progress.what) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_that_is_not_there_yet_is_never_whole() {
        let shown = |share, what: &str| super::share(&Progress { share, what: what.to_owned() });
        assert_eq!(shown(0.0, ""), "0 %");
        assert_eq!(shown(0.429, "candidate 3 of 8"), "42 %, candidate 3 of 8");
        assert_eq!(shown(1.0, "certificate"), "99 %, certificate");
    }
}
