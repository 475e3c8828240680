//! What a terminal on stderr shows while something takes its time.

use crate::flight::{OnPlan, PlanNews, Planning};
use indicatif::{ProgressBar, ProgressStyle};
use planner_host::Progress;
use std::{
    io::IsTerminal,
    sync::{Arc, Mutex, PoisonError},
    time::Duration,
};

/// How often the time that has passed is drawn again.
const EVERY: Duration = Duration::from_millis(250);

/// Says what is going on, for how long already and at most; nothing where stderr is no terminal.
pub fn spinner(planning: &Planning) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::new_spinner().with_message(words(planning));
    let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed} so far");
    let spinner = spinner.with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.enable_steady_tick(EVERY);
    spinner
}

/// Shows how far a plan is.
pub fn show_share(bar: &ProgressBar, planning: &Planning, progress: &Progress) {
    if !bar.is_hidden() {
        bar.set_message(format!("{}: {}", words(planning), share(progress)));
    }
}

/// Shows plans that are being made in the bar of something larger.
pub fn shown_in(bar: &ProgressBar) -> OnPlan {
    let bar = bar.clone();
    let at_hand: Mutex<Option<Planning>> = Mutex::default();
    Arc::new(move |news| {
        let mut at_hand = at_hand.lock().unwrap_or_else(PoisonError::into_inner);
        match news {
            PlanNews::Begun(planning) if !bar.is_hidden() => {
                bar.set_message(words(&planning));
                bar.enable_steady_tick(EVERY);
                *at_hand = Some(planning);
            }
            PlanNews::Begun(_) => {}
            PlanNews::Progress(progress) => {
                at_hand.iter().for_each(|planning| show_share(&bar, planning, &progress));
            }
            PlanNews::Done => {
                *at_hand = None;
                bar.disable_steady_tick();
                bar.set_message("");
            }
        }
    })
}

fn words(planning: &Planning) -> String {
    format!("{}, {} s at most", planning.work, planning.within.as_secs())
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
        let told = |share, what: &str| super::share(&Progress { share, what: what.to_owned() });
        assert_eq!(told(0.0, ""), "0 %");
        assert_eq!(told(0.429, "candidate 3 of 8"), "42 %, candidate 3 of 8");
        assert_eq!(told(1.0, "certificate"), "99 %, certificate");
    }
}
