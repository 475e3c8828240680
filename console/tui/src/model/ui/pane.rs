//! The panes of a screen, and which of them a mission has.

use serde::{Deserialize, Serialize};

/// What a mission has, as far as its panes depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct MissionParts {
    /// Whether the mission does not scan, so that its result has no panes about the floor.
    pub without_scan: bool,
    /// Whether the mission has a tether, whose pane then has a page of its own on a narrow terminal.
    pub tether: bool,
    /// Whether the mission is a survey, whose pane then has a page of its own beside the map.
    #[serde(default)]
    pub survey: bool,
}

/// A pane of the mission screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Pane {
    /// The map.
    Map,
    /// Coverage.
    Coverage,
    /// The robot's position and its error.
    Position,
    /// The planner and its commands.
    Planner,
    /// The log.
    Events,
    /// The tether.
    Tether,
    /// The alarms.
    Alarms,
    /// The measurements of each AE station.
    Stations,
    /// The missed areas, once the mission has ended.
    Missed,
    /// A chart of a quantity over recent minutes.
    Chart(Chart),
    /// The plan screen: the state of the plan.
    Plan,
    /// The plan screen: what the plan promises.
    Promise,
    /// The plan screen: the floor that the plan leaves out.
    LeftOut,
    /// The plan screen: the parameters of the planner.
    Parameters,
    /// The plan screen: the pre-flight checks.
    Checks,
    /// The result screen: the achieved figures.
    Figures,
    /// The result screen: the plates.
    Plates,
    /// A screen with a list: the list.
    List,
    /// A screen with a list: the details of the selected row.
    Detail,
}

impl Pane {
    /// The panes that are shown one at a time on a small terminal, in Tab order.
    #[rustfmt::skip]
    pub const PAGES: [Self; 6] =
        [Self::Map, Self::Coverage, Self::Position, Self::Stations, Self::Planner, Self::Events];
    /// The panes of the plan screen that are shown one at a time on a small terminal, in Tab order.
    pub const PLAN_PAGES: [Self; 5] =
        [Self::Map, Self::Promise, Self::LeftOut, Self::Checks, Self::Parameters];
    /// The panes beside the map of the plan screen that are shown one at a time on a narrow terminal, in Tab order.
    pub const PLAN_PARTS: [Self; 4] = [Self::Map, Self::LeftOut, Self::Checks, Self::Parameters];
    /// The panes of the result screen on a terminal that is not wide, in Tab order. A small terminal shows one at a time; on a
    /// narrow one, the plates and the map take the place of others.
    pub const RESULT_PAGES: [Self; 5] =
        [Self::Figures, Self::Coverage, Self::Missed, Self::Plates, Self::Map];
    /// The panes of the result of a mission that does not scan, in Tab order.
    pub const RESULT_WITHOUT_SCAN: [Self; 2] = [Self::Figures, Self::Map];
    /// The panes of the mission screen beside which others are visible, in Tab order: the last one and the one before it only
    /// for a survey and for a mission with a tether.
    const BESIDE_MAP: [Self; 5] = [Self::Map, Self::Events, Self::Stations, Self::Tether, Self::Coverage];
    const OF_SURVEY: [Self; 4] = [Self::Map, Self::Events, Self::Stations, Self::Coverage];
    /// The panes of the mission screen that are shown alone on the whole screen, in Tab order: with and without a tether.
    #[rustfmt::skip]
    const ALONE: [Self; 12] = [
        Self::Map, Self::Coverage, Self::Position, Self::Tether, Self::Planner, Self::Stations, Self::Events,
        Self::Chart(Chart::Error), Self::Chart(Chart::Residual), Self::Chart(Chart::TetherOut), Self::Chart(Chart::Wrap),
        Self::Chart(Chart::Scanned),
    ];
    #[rustfmt::skip]
    const ALONE_WITHOUT_TETHER: [Self; 9] = [
        Self::Map, Self::Coverage, Self::Position, Self::Planner, Self::Stations, Self::Events,
        Self::Chart(Chart::Error), Self::Chart(Chart::Residual), Self::Chart(Chart::Scanned),
    ];
    /// The panes of a screen with a list, in Tab order. A small terminal shows one at a time.
    pub const OF_LIST: [Self; 2] = [Self::List, Self::Detail];
    /// The panes of the result screen on a wide terminal, in Tab order: the plates take the place of the map.
    pub const RESULT_WHOLE: [Self; 4] = [Self::Figures, Self::Coverage, Self::Missed, Self::Plates];
}

/// The quantity of a chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Chart {
    /// The 95 % error of the position.
    Error,
    /// The root mean square of the residuals of the stations.
    Residual,
    /// The length of the tether paid out.
    TetherOut,
    /// The largest wrap.
    Wrap,
    /// The scanned share of the reachable floor.
    Scanned,
}

impl MissionParts {
    /// The panes of the mission screen through which Tab cycles while one of them is shown alone.
    pub(super) fn alone(self) -> &'static [Pane] {
        if self.tether { &Pane::ALONE } else { &Pane::ALONE_WITHOUT_TETHER }
    }

    /// The panes of the mission screen through which Tab cycles beside the map; `is_narrow` if some of them take the place of
    /// others.
    pub(super) fn beside_map(self, is_narrow: bool) -> &'static [Pane] {
        match (self.survey, self.tether && is_narrow) {
            (true, true) => &Pane::BESIDE_MAP,
            (true, false) => &Pane::OF_SURVEY,
            (false, true) => &Pane::BESIDE_MAP[..4],
            (false, false) => &Pane::BESIDE_MAP[..3],
        }
    }
}
