//! The state of the screens, as plain data.

pub mod alarms;
pub mod change;
pub mod console;
pub mod coverage;
pub mod event_list;
mod floor_level;
pub mod fold;
pub mod glimpse;
pub mod health;
pub mod history;
pub mod home;
pub mod line_edit;
pub mod live;
pub mod log;
pub mod palette;
pub mod parameter;
pub mod planner_list;
pub mod planning;
pub mod plans;
pub mod plugins;
pub mod position;
pub mod preflight;
pub mod preset;
pub mod replay;
pub mod review;
pub mod run;
pub mod scanner;
pub mod setting;
pub mod shadow;
pub mod step;
pub mod survey;
pub mod tether;
pub mod together;
pub mod trail;
pub mod ui;
mod way_left;
pub mod what_if;
pub mod zone_draft;

pub use crate::screens::Screen;
pub use alarms::{Alarm, Alarms, Cause};
pub use change::{Change, Withdrawn};
pub use console::{Console, Message, Notice, Settling, Speed, Times};
pub use coverage::Raster;
pub use event_list::EventList;
pub use floor_level::FloorLevel;
pub use glimpse::{Glimpse, Glimpses};
pub use health::{Health, Measured, Recording, Watches};
pub use history::History;
pub use home::{Home, PastRun, ScenarioEntry};
pub use line_edit::LineEdit;
pub use live::{Access, Busy, Live, RunId, RunResult, Source};
pub use log::{Entry, Log};
pub use palette::Palette;
pub use planning::{Lane, Offer, PlanShown, Planning};
pub use plans::{Ghost, GhostPlan, Plans, Promise};
pub use position::Position;
pub use preflight::Preflight;
pub use preset::Preset;
pub use replay::Replay;
pub use review::Review;
pub use run::{About, Clock, Progress, Run, VehicleSeen};
pub use shadow::Shadow;

pub use tether::Tether;
pub use together::{Combination, Continued, Earlier, Together};
pub use trail::Trail;
pub use ui::{Overlay, Pane, Ui};
pub use what_if::{Candidate, Forecast, WhatIf};
pub use zone_draft::ZoneDraft;

use mission::{PlannerChoice, PlannerInfo, Severity};
use serde::{Deserialize, Serialize};

/// Seconds for which a hint about a key stays beside the keys.
const HINT_S: f64 = 2.0;
/// Seconds for which an announcement stays beside the keys.
const NEWS_S: f64 = 3.0;
/// Seconds for which a refusal or a warning stays beside the keys.
const WARNING_S: f64 = 4.0;
/// Characters per second that an operator reads while doing other work; a long message stays until it has been read.
const READ_PER_S: f64 = 20.0;
/// Seconds without an event after which a running mission is considered silent.
const SILENCE_S: f64 = 2.0;

/// The state of the screens.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Model {
    /// The home screen: the scenarios and past runs that can be opened.
    pub home: Home,
    /// The review screen: the list of past runs.
    #[serde(default)]
    pub review: Review,
    /// The open run, and the communication between the operator and its mission.
    pub live: Live,
    /// The initial simulation speed of a mission.
    #[serde(default)]
    pub first_speed: Speed,
    /// The state of the console itself.
    pub console: Console,
    /// What the operator is looking at.
    pub ui: Ui,
}

impl Model {
    /// Whether the open question waits for the cost of a no-go zone.
    pub fn is_pricing_zone(&self) -> bool {
        let is_asked = matches!(self.ui.overlay, Overlay::Confirm(ui::Ask::DrawZone(_)));
        is_asked && self.live.zone_cost.is_none()
    }

    /// Creates a console that opens on the plan of a mission; the home screen is one key away.
    pub fn opened(id: RunId, source: Source, speed: Speed) -> Self {
        let live = Live { id, source: Some(source), is_opening: true, speed, ..Live::default() };
        let mut model = Self { live, first_speed: speed, ..Self::default() };
        model.ui.go(Screen::Plan);
        model
    }

    /// Whether the open question cannot be answered yet, because the mission has not sent the figures that it shows.
    pub fn awaits_figures(&self) -> bool {
        match &self.ui.overlay {
            Overlay::Confirm(ui::Ask::DriveBack) | Overlay::Finish { .. } => self.live.way_back.is_none(),
            Overlay::Confirm(ui::Ask::DrawZone(_)) => self.live.zone_cost.is_none(),
            _ => false,
        }
    }

    /// Creates a console that only watches the run in a folder.
    pub fn looking_on(id: RunId, folder: String) -> Self {
        let mut model = Self::opened(id, Source::File(folder), Speed::default());
        model.live.access = Access::LookOnly;
        model.ui.go(Screen::Mission);
        model
    }

    /// Creates a console that replays a past run, optionally beside a second one; there is no engine.
    pub fn replaying(id: RunId, run: String, with: Option<String>) -> Self {
        let mut model = Self::default();
        model.replay(id, run);
        if let Some(replay) = &mut model.live.replay {
            replay.other = with.map(|name| replay::Other { name, ..replay::Other::default() });
        }
        model
    }

    /// Replaces the open run with a replay of a past run.
    pub(crate) fn replay(&mut self, id: RunId, run: String) {
        self.live = Live {
            id,
            access: Access::Replay,
            source: Some(Source::File(run.clone())),
            is_opening: true,
            replay: Some(Box::new(Replay::of(run))),
            ..Live::default()
        };
        (self.ui.map, self.ui.cursor, self.ui.missed) = (ui::MapView::default(), None, 0);
        self.console.notice = None;
        self.ui.go(Screen::Mission);
    }

    /// The description of the active planner, or of the first one before any is active.
    pub fn planner(&self) -> Option<&PlannerInfo> {
        let run = &self.live.run;
        let id = run.planner_id();
        let listed = || self.console.planners.iter().find(|planner| Some(planner.id.as_str()) == id);
        run.planning.info.as_ref().or_else(listed)
    }

    /// The place of the selected area that the plan leaves out, while the list on the plan screen responds to keys.
    pub fn left_out_at(&self) -> Option<world::Point> {
        let is_listed = self.ui.screen == Screen::Plan && self.ui.pane == Pane::LeftOut;
        let areas = &self.live.left_out().filter(|_| is_listed)?.areas;
        Some(areas.get(self.ui.left_out)?.at)
    }

    /// The description of a planner.
    pub fn info_of(&self, id: &str) -> Option<&PlannerInfo> {
        let driving = self.live.run.planning.info.as_ref();
        driving.into_iter().chain(&self.console.planners).find(|info| info.id == id)
    }

    /// The planner whose parameters are listed, and the choice to which these parameters belong: a forecast draft if
    /// there is one, otherwise the active planner.
    pub fn edited(&self) -> Option<(&PlannerInfo, Option<&PlannerChoice>)> {
        match self.live.what_if.as_ref().and_then(|what_if| what_if.draft.as_ref()) {
            Some(draft) => Some((self.info_of(&draft.id)?, Some(draft))),
            None => Some((self.planner()?, self.live.run.planning.choice.as_ref())),
        }
    }

    /// The selected alarm, or the first one in the table if none is selected.
    pub fn selected_alarm(&self) -> Option<&Alarm> {
        let alarms = &self.live.run.alarms;
        let chosen = self.ui.alarm.as_ref().and_then(|cause| alarms.get(cause));
        chosen.or_else(|| alarms.table().first().copied())
    }

    /// How long a running mission has been silent, seconds; `None` if it is not silent.
    pub fn silent_s(&self) -> Option<f64> {
        let silence_s = self.console.now.mono_s - self.live.heard_mono_s;
        (self.is_heard() && silence_s > SILENCE_S).then_some(silence_s)
    }

    /// Whether a mission is running, so that its events should keep arriving.
    fn is_heard(&self) -> bool {
        self.live.run.is_running() && !self.live.is_replay()
    }

    /// The current notice, until it expires.
    pub fn notice(&self) -> Option<&Notice> {
        self.console.notice.as_ref().filter(|notice| notice.until_mono_s > self.console.now.mono_s)
    }

    /// Whether enough time has passed to tell that the pending key is not held down.
    pub fn has_settled(&self) -> bool {
        self.console
            .settling
            .as_ref()
            .is_some_and(|settling| settling.until_mono_s <= self.console.now.mono_s)
    }

    /// The time at which the screen next changes without any input, on the console's own clock, seconds; `None` if it
    /// does not change.
    pub fn wakes_at_mono_s(&self) -> Option<f64> {
        let notice = self.notice().map(|notice| notice.until_mono_s);
        let silence = self.is_heard().then(|| match self.silent_s() {
            None => self.live.heard_mono_s + SILENCE_S,
            Some(_) => self.console.now.mono_s + 1.0,
        });
        // Long work shows its elapsed time, which changes every second.
        let busy = self.live.busy.as_ref().map(|_| self.console.now.mono_s + 1.0);
        // A figure that has just crossed its limit must be checked again.
        let health = self.console.watches.is_pending().then_some(self.console.now.mono_s + 1.0);
        let settling = self.console.settling.as_ref().map(|settling| settling.until_mono_s);
        [notice, silence, busy, health, settling].into_iter().flatten().reduce(f64::min)
    }

    /// Shows the operator a message beside the keys and adds it to the history of messages.
    pub(crate) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        let text = text.into();
        let reading_s = text.chars().count() as f64 / READ_PER_S;
        let least_s = if severity == Severity::Info { NEWS_S } else { WARNING_S };
        self.console.remember(Message {
            t_s: self.live.run.about.is_some().then_some(self.live.run.clock.t_s),
            wall_unix_s: self.console.now.wall_unix_s,
            severity,
            text: text.clone(),
        });
        self.show(least_s.max(reading_s), severity, text);
    }

    /// Shows the operator a hint about the key that was pressed; hints are not kept.
    pub(crate) fn hint(&mut self, text: impl Into<String>) {
        self.show(HINT_S, Severity::Info, text.into());
        self.console.notice.iter_mut().for_each(|notice| notice.is_answer = true);
    }

    fn show(&mut self, seconds: f64, severity: Severity, text: String) {
        let until_mono_s = self.console.now.mono_s + seconds;
        self.console.notice = Some(Notice { severity, text, until_mono_s, is_answer: false });
    }
}
