//! Runs the missions of a campaign one after another on the calling thread.

use account::Summary;
use campaign::{Campaign, Case, Row, Status};
use flight::{
    answers::InOrder,
    hosts,
    planners::{Found, check_choices},
    unrecorded,
};
use planner_host::{Host, HostConfig, PluginDirs};
use scenario::Scenario;
use std::{any::Any, panic::AssertUnwindSafe};

/// The number of attempts after which a mission that keeps failing counts as failed.
const TRIES: u32 = 3;

/// Runs missions; the planners' processes are reused from mission to mission.
pub(crate) struct Pilot<'a> {
    campaign: &'a Campaign,
    plugins: &'a PluginDirs,
    found: &'a Found,
    /// One host for each set of limits.
    hosts: Vec<(HostConfig, InOrder)>,
}

/// The outcome of an attempt.
enum Tried {
    Flown(Box<Summary>),
    Refused(String),
    Failed(String),
    Stopped,
}

impl<'a> Pilot<'a> {
    pub(crate) fn new(campaign: &'a Campaign, plugins: &'a PluginDirs, found: &'a Found) -> Self {
        Self { campaign, plugins, found, hosts: Vec::new() }
    }

    /// Runs a mission; returns its row and the number of attempts, or `None` if the mission was stopped.
    pub(crate) fn fly(&mut self, case: &Case<'_>, is_stopped: impl Fn() -> bool) -> Option<(Row, u32)> {
        let scenario = match self.scenario(case) {
            Ok(scenario) => scenario,
            Err(why) => return Some((Row::not_flown(case.n, Status::Refused, why), 1)),
        };
        let mut tries = 1;
        loop {
            let row = match self.attempt(&scenario, &is_stopped) {
                Tried::Stopped => return None,
                Tried::Flown(summary) => Row::flown(case.n, *summary),
                Tried::Refused(why) => Row::not_flown(case.n, Status::Refused, why),
                Tried::Failed(why) => Row::not_flown(case.n, Status::Failed, why),
            };
            // A fault of the machine does not recur on a second attempt; a fault of the planner does.
            let again = row.status == Status::Failed && tries < TRIES || row.has_faults() && tries == 1;
            if !again {
                return Some((row, tries));
            }
            self.hosts.clear();
            tries += 1;
        }
    }

    fn scenario(&self, case: &Case<'_>) -> Result<Scenario, String> {
        let settings = self.campaign.settings(case);
        let scenario = Scenario::parse_with(&case.scenario.text, &case.scenario.name, &settings);
        scenario.map_err(|errors| errors.to_string())
    }

    fn attempt(&mut self, scenario: &Scenario, is_stopped: impl Fn() -> bool) -> Tried {
        if let Err(why) = check_choices(scenario, self.found) {
            return Tried::Refused(why.to_string().lines().next().unwrap_or_default().to_owned());
        }
        let answers = self.answers(scenario);
        let flown =
            std::panic::catch_unwind(AssertUnwindSafe(|| unrecorded::fly(scenario, answers, is_stopped)));
        match flown {
            Ok(Some(summary)) => {
                answers.end_mission();
                Tried::Flown(Box::new(summary))
            }
            Ok(None) => Tried::Stopped,
            Err(panic) => Tried::Failed(format!("the program panicked: {}", words(&*panic))),
        }
    }

    fn answers(&mut self, scenario: &Scenario) -> &mut InOrder {
        let config = HostConfig { wants_drawing: false, ..hosts::config(&scenario.mission) };
        let at = self.hosts.iter().position(|(of, _)| *of == config).unwrap_or_else(|| {
            let host = Host::new(self.plugins, config.clone());
            self.hosts.push((config, InOrder::new(host)));
            self.hosts.len() - 1
        });
        &mut self.hosts[at].1
    }
}

fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}
