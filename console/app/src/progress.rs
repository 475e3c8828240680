//! What a terminal on stderr shows while something takes its time.

use crate::plan_watch::OnWork;
use indicatif::{ProgressBar, ProgressStyle};
use planner_host::{OnProgress, Progress};
use std::{
    io::IsTerminal,
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

/// How often the time that has passed is drawn again.
const EVERY: Duration = Duration::from_millis(250);

/// Says what is going on, for how long already and at most; nothing where stderr is no terminal.
pub fn spinner(work: &str, within: Duration) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner().with_message(words(work, within));
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed} so far");
    let spinner = spinner.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.enable_steady_tick(EVERY);
    spinner
}

/// Shows how far a plan is.
pub fn show_share(bar: &ProgressBar, work: &str, progress: &Progress) {
    if !bar.is_hidden() {
        bar.set_message(format!("{work}: {}", share(progress)));
    }
}

/// What planners do that takes its time, shown in the bar of something larger: the work, and how far it is.
pub fn shown_in(bar: &ProgressBar, within: Duration) -> (OnWork, OnProgress) {
    let at_hand: Arc<Mutex<String>> = Arc::default();
    let (shown, work) = (bar.clone(), Arc::clone(&at_hand));
    let on_work: OnWork = Box::new(move |words_of| {
        let mut work = work.lock().unwrap_or_else(PoisonError::into_inner);
        words_of.unwrap_or_default().clone_into(&mut work);
        if words_of.is_none() {
            shown.disable_steady_tick();
            shown.set_message("");
        } else if !shown.is_hidden() {
            shown.set_message(words(&work, within));
            shown.enable_steady_tick(EVERY);
        }
    });
    let shown = bar.clone();
    let on_progress: OnProgress = Arc::new(move |_, progress| {
        show_share(&shown, &at_hand.lock().unwrap_or_else(PoisonError::into_inner), progress);
    });
    (on_work, on_progress)
}

fn words(work: &str, within: Duration) -> String {
    format!("{work}, {} s at most", within.as_secs())
}

/// Only the end of a plan makes it whole.
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
