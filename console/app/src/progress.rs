//! What a terminal on stderr shows while something takes its time.

use crate::flight::Planning;
use indicatif::{ProgressBar, ProgressStyle};
use std::{io::IsTerminal, time::Duration};

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

/// Shows in a bar that a plan is being made, with the time running on; or no more.
pub fn show(bar: &ProgressBar, planning: Option<&Planning>) {
    match planning {
        Some(planning) if !bar.is_hidden() => {
            bar.set_message(words(planning));
            bar.enable_steady_tick(EVERY);
        }
        Some(_) => {}
        None => {
            bar.disable_steady_tick();
            bar.set_message("");
        }
    }
}

fn words(planning: &Planning) -> String {
    format!("{}, {} s at most", planning.work, planning.within.as_secs())
}
