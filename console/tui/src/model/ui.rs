//! What the operator is looking at: screen, zoom, filter, selection and overlay.

use super::line_edit::LineEdit;
use super::palette::Palette;
use super::step::Step;
use super::{Cause, EventList, ZoneDraft};
use crate::screens::Screen;
use crate::theme::ThemeName;
use mission::{Order, ParamValue, PlanId, PlannerChoice};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use world::Point;

/// What a mission has, as far as its panes depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct MissionParts {
    /// Whether the mission does not scan, so that its result has no panes about the floor.
    pub without_scan: bool,
    /// Whether the mission has a tether, whose pane then has a page of its own on a narrow terminal.
    pub tether: bool,
}

/// What the operator is looking at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ui {
    /// The width of the terminal, columns.
    pub width: u16,
    /// The height of the terminal, rows.
    pub height: u16,
    /// The current screen.
    pub screen: Screen,
    /// The screens to which the operator can go back, most recent last.
    pub back: Vec<Screen>,
    /// The pane that responds to the arrow keys; on a small terminal, the pane shown.
    pub pane: Pane,
    /// The part of the tank on the map.
    pub map: MapView,
    /// The map layers that are shown.
    pub layers: Layers,
    /// The index of the selected missed area in the list on the result screen.
    pub missed: usize,
    /// The index of the selected plate in the list on the result screen, most missed first.
    #[serde(default)]
    pub plate: usize,
    /// The number of rows by which the pane of text is scrolled that responds to the arrow keys.
    #[serde(default)]
    pub scrolled: usize,
    /// What the open mission has, as far as its panes depend on it.
    #[serde(default)]
    pub parts: MissionParts,
    /// On a screen with a list, whether the arrow keys apply to the details of the selected row.
    #[serde(default)]
    pub in_detail: bool,
    /// The index of the selected area in the list of what the plan leaves out.
    #[serde(default)]
    pub left_out: usize,
    /// The index of the selected plugin on the plugins screen.
    pub plugin: usize,
    /// The map cursor, metres, tank frame; `None` without a cursor.
    pub cursor: Option<Point>,
    /// Whether the console captures the mouse.
    pub mouse: bool,
    /// The text of the event filter.
    pub needle: String,
    /// The events that pass the filter.
    #[serde(default)]
    pub events: EventList,
    /// The selected alarm; `None` for the first one in the table.
    #[serde(default)]
    pub alarm: Option<Cause>,
    /// The colour theme.
    pub theme: ThemeName,
    /// The open overlay.
    pub overlay: Overlay,
}

impl Default for Ui {
    fn default() -> Self {
        Self {
            width: 80,
            height: 24,
            screen: Screen::default(),
            back: Vec::new(),
            pane: Pane::Map,
            map: MapView::default(),
            layers: Layers::default(),
            missed: 0,
            plate: 0,
            scrolled: 0,
            parts: MissionParts::default(),
            in_detail: false,
            left_out: 0,
            plugin: 0,
            cursor: None,
            mouse: false,
            needle: String::new(),
            events: EventList::default(),
            alarm: None,
            theme: ThemeName::default(),
            overlay: Overlay::None,
        }
    }
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

/// The part of the tank on the map.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MapView {
    /// How many times the scale has been doubled; 0 shows the whole tank.
    pub zoom: u8,
    /// Whether the map stays centred on the robot.
    pub follow: bool,
    /// The offset of the map's centre from the tank's centre, metres, when the map does not follow the robot.
    pub offset: world::Vector,
}

/// The maximum number of doublings of the map's scale.
pub const MAX_ZOOM: u8 = 6;

/// A map layer that can be hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapLayer {
    /// Scanned floor.
    Scanned,
    /// The robot's trail.
    Trail,
    /// The path of the plan.
    Plan,
    /// The planner's drawings.
    Drawings,
    /// Acoustic-emission stations.
    Stations,
    /// Floor where the stations are forecast to locate the robot poorly.
    Accuracy,
    /// The points of the last scan.
    Scan,
    /// Floor where fixes are forecast to have a large protection level, or none.
    Protection,
    /// The map that a survey makes: floor not seen, frontiers, columns and the way.
    Explored,
}

impl MapLayer {
    /// All layers, in the order of the layer list.
    pub const ALL: [Self; 9] = [
        Self::Scanned,
        Self::Trail,
        Self::Plan,
        Self::Drawings,
        Self::Stations,
        Self::Accuracy,
        Self::Scan,
        Self::Protection,
        Self::Explored,
    ];

    /// The layer's name in the list.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scanned => "scanned floor",
            Self::Trail => "robot trail",
            Self::Plan => "plan",
            Self::Drawings => "planner drawings",
            Self::Stations => "AE stations",
            Self::Accuracy => "accuracy forecast",
            Self::Scan => "scan points",
            Self::Protection => "protection level",
            Self::Explored => "map of a survey",
        }
    }
}

/// Which map layers are hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layers {
    hidden: [bool; MapLayer::ALL.len()],
}

impl Default for Layers {
    /// Shows every layer except the forecasts, which are for planning rather than for watching.
    fn default() -> Self {
        let is_forecast = |layer| matches!(layer, MapLayer::Accuracy | MapLayer::Protection);
        Self { hidden: MapLayer::ALL.map(is_forecast) }
    }
}

impl Layers {
    /// Whether a layer is shown.
    pub fn shows(&self, layer: MapLayer) -> bool {
        !self.hidden[layer as usize]
    }

    /// Shows or hides a layer.
    pub fn toggle(&mut self, layer: MapLayer) {
        self.hidden[layer as usize] = self.shows(layer);
    }
}

/// The overlay on top of the screen; it receives the keys.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Overlay {
    /// No overlay.
    #[default]
    None,
    /// The question before the robot moves or before the mission ends.
    Confirm(Ask),
    /// The line for single steps.
    Stepping,
    /// The question before the console quits.
    Quit,
    /// The command line with its list.
    Commands(Palette),
    /// The list of planners.
    Planners {
        /// The purpose for which the planner is chosen.
        purpose: Purpose,
        /// The index of the selected line.
        selected: usize,
        /// Whether the planners that cannot run the mission are listed one by one.
        #[serde(default)]
        is_unfolded: bool,
    },
    /// The parameters of the active planner.
    Parameters {
        /// The index of the selected line.
        selected: usize,
        /// The value being typed.
        edit: Option<Edit>,
    },
    /// The changes that a preset would make.
    Preset {
        /// The name of the preset.
        name: String,
        /// The planner with its parameters.
        choice: PlannerChoice,
        /// The index of the selected line.
        selected: usize,
        /// The parameters whose values are not to be taken.
        #[serde(default)]
        left: BTreeSet<String>,
    },
    /// The layers of the map.
    Layers {
        /// The index of the selected line.
        selected: usize,
    },
    /// Forecasts of how the mission would continue with different planners.
    WhatIf,
    /// The ways to end the mission: end here, or drive back.
    Finish {
        /// The index of the selected line.
        selected: usize,
    },
    /// A no-go zone being drawn on the map.
    ZoneDraft(ZoneDraft),
    /// The history of messages, newest first.
    Messages {
        /// The index of the selected line.
        selected: usize,
    },
    /// The pre-flight check.
    Preflight {
        /// The index of the selected line.
        selected: usize,
    },
    /// The filter of a list, being typed.
    Filter(LineEdit),
    /// The action list of an alarm.
    Remedies {
        /// The cause of the alarm.
        cause: Cause,
        /// The actions at the time when the list was opened, in the order of their numbers.
        #[serde(skip)]
        steps: Vec<Step>,
        /// The index of the selected line.
        selected: usize,
    },
    /// The input line for shelving an alarm: how long and why.
    Shelve(Shelving),
    /// The input line for the text of a bookmark at the replay cursor.
    Bookmark(LineEdit),
}

impl Overlay {
    /// Whether the overlay asks something that only its own keys on the keyboard may answer.
    pub fn is_question(&self) -> bool {
        matches!(self, Self::Confirm(_) | Self::Quit | Self::Stepping | Self::Finish { .. })
    }
}

/// The input for shelving an alarm: how long and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shelving {
    /// The cause of the alarm.
    pub cause: Cause,
    /// The typed line: minutes, then a reason.
    pub line: LineEdit,
    /// Why the input was refused.
    pub refusal: Option<String>,
}

/// The purpose of choosing a planner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Purpose {
    /// The planner will drive.
    Drive,
    /// The planner will make a plan for comparison.
    Compare,
    /// The planner will forecast how the mission would continue.
    WhatIf,
    /// The planner will run in shadow.
    Shadow,
}

/// The question in the confirmation line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Start the mission with the plan shown; `None` if the start does not name a plan.
    Start(Option<PlanId>),
    /// Resume the mission.
    Resume,
    /// Run a plan that was refused because of the tether.
    FlyUncertified,
    /// Change the active planner.
    Swap(PlannerChoice),
    /// Promote the planner in shadow.
    Promote,
    /// Take the better plan.
    TakePlan,
    /// Drive back to the anchor or the start.
    DriveBack,
    /// Close the floor within an outline: its corners, metres, tank frame.
    DrawZone(Vec<Point>),
    /// Change a parameter of the active planner.
    Set {
        /// The parameter.
        key: String,
        /// Its new value.
        value: ParamValue,
        /// The line in the list of parameters from which the change was made; `None` if it was made by a command.
        #[serde(default)]
        list: Option<usize>,
    },
}

impl Ask {
    /// The order to send when the operator agrees.
    pub fn order(&self) -> Order {
        match self {
            Self::Start(plan) => plan.map_or(Order::Start, Order::StartPlan),
            Self::Resume => Order::Resume,
            Self::FlyUncertified => Order::FlyUncertified,
            Self::Swap(choice) => Order::ChoosePlanner(choice.clone()),
            Self::Promote => Order::Promote,
            Self::TakePlan => Order::TakePlan,
            Self::DriveBack => Order::DriveBack,
            Self::DrawZone(corners) => Order::DrawZone(corners.clone()),
            Self::Set { key, value, .. } => Order::SetParameter { key: key.clone(), value: value.clone() },
        }
    }
}

/// A parameter value being typed.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Edit {
    /// The typed line.
    pub line: LineEdit,
    /// Why the value was refused.
    pub refusal: Option<String>,
}

/// The arrangement of the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// From 120 columns and 30 rows: everything, with full words.
    Wide,
    /// From 80 columns and 24 rows: everything, with short words.
    Narrow,
    /// From 60 columns and 16 rows: one pane at a time.
    Paged,
    /// Smaller: control of the robot, without a map.
    Strip,
}

impl Arrangement {
    /// The arrangement for a terminal of the given size.
    pub fn of(width: u16, height: u16) -> Self {
        match (width, height) {
            (120.., 30..) => Self::Wide,
            (80.., 24..) => Self::Narrow,
            (60.., 16..) => Self::Paged,
            _ => Self::Strip,
        }
    }
}

impl Ui {
    /// The arrangement of the screen.
    pub fn arrangement(&self) -> Arrangement {
        Arrangement::of(self.width, self.height)
    }

    /// Whether the home screen has room for the last run of the selected scenario.
    pub(crate) fn is_large(&self) -> bool {
        self.width >= 170 && self.height >= 50
    }

    /// Goes to a screen; `q` returns to the previous one.
    pub fn go(&mut self, screen: Screen) {
        if screen == self.screen {
            return;
        }
        self.back.retain(|before| *before != screen);
        if screen == Screen::Home {
            self.back.clear();
        } else {
            self.back.push(self.screen);
        }
        self.screen = screen;
        self.turn_to_list();
        if screen == Screen::Result {
            self.pane = self.first_pane();
        } else if matches!(screen, Screen::Plan | Screen::Mission)
            && !self.panes().is_empty()
            && !self.panes().contains(&self.pane)
        {
            self.pane = Pane::Map;
        }
        if screen == Screen::Mission {
            // The pane beside the map shows the newest events, whatever was selected on the events screen.
            self.events.at = None;
        }
    }

    /// Makes the arrow keys apply to the list of a screen with a list.
    pub(crate) fn turn_to_list(&mut self) {
        if std::mem::take(&mut self.in_detail) {
            self.scrolled = 0;
        }
    }

    /// The pane to which the arrow keys apply.
    pub fn focus(&self) -> Pane {
        match self.panes() {
            [Pane::List, ..] if self.in_detail => Pane::Detail,
            [Pane::List, ..] => Pane::List,
            _ => self.pane,
        }
    }

    /// The pane with which a screen begins: the figures of a result, the map of any other screen.
    pub fn first_pane(&self) -> Pane {
        let first = self.panes().first().filter(|_| self.screen == Screen::Result);
        first.copied().unwrap_or(Pane::Map)
    }

    /// Whether a pane is visible.
    pub fn shows(&self, pane: Pane) -> bool {
        if self.screen == Screen::Result && !self.panes().is_empty() {
            let is_beside = pane == Pane::Map && self.arrangement() == Arrangement::Wide;
            return self.pane == pane || is_beside && self.pane != Pane::Plates;
        }
        if self.screen != Screen::Mission {
            let is_paged = self.screen == Screen::Plan && self.arrangement() == Arrangement::Paged;
            return pane == Pane::Map
                && self.has_map()
                && (!is_paged || !self.panes().contains(&self.pane) || self.pane == pane);
        }
        match self.arrangement() {
            Arrangement::Wide | Arrangement::Narrow => true,
            Arrangement::Paged => self.pane == pane,
            Arrangement::Strip => false,
        }
    }

    /// Whether the screen has a map.
    pub fn has_map(&self) -> bool {
        self.screen.has_map() && self.arrangement() != Arrangement::Strip
    }

    /// The panes through which Tab cycles.
    pub fn panes(&self) -> &'static [Pane] {
        match (self.screen, self.arrangement()) {
            (Screen::Plan, Arrangement::Wide) => return &[Pane::Map, Pane::LeftOut],
            (Screen::Plan, Arrangement::Narrow) => return &Pane::PLAN_PARTS,
            (Screen::Plan, Arrangement::Paged) => return &Pane::PLAN_PAGES,
            (Screen::Result, Arrangement::Wide | Arrangement::Narrow | Arrangement::Paged)
                if self.parts.without_scan =>
            {
                return &Pane::RESULT_WITHOUT_SCAN;
            }
            (Screen::Result, Arrangement::Wide) => return &Pane::RESULT_WHOLE,
            (Screen::Result, Arrangement::Narrow | Arrangement::Paged) => return &Pane::RESULT_PAGES,
            (Screen::Alarms | Screen::Events | Screen::Review | Screen::Plugins, arrangement) => {
                return if arrangement == Arrangement::Strip { &[] } else { &Pane::OF_LIST };
            }
            (Screen::Mission, _) => {}
            _ => return &[],
        }
        match self.arrangement() {
            Arrangement::Narrow if self.parts.tether => {
                &[Pane::Map, Pane::Events, Pane::Stations, Pane::Tether]
            }
            Arrangement::Wide | Arrangement::Narrow => &[Pane::Map, Pane::Events, Pane::Stations],
            Arrangement::Paged => &Pane::PAGES,
            Arrangement::Strip => &[],
        }
    }

    /// The panes that have a key of their own, which their titles show: those of a screen that is wide enough to show
    /// more than one at a time.
    pub fn numbered_panes(&self) -> &'static [Pane] {
        match self.panes() {
            panes @ [_, _, ..] if self.arrangement() == Arrangement::Wide => panes,
            _ => &[],
        }
    }

    /// The centre of the map, metres, tank frame.
    pub fn map_center(&self, tank: Point, robot: Option<Point>) -> Point {
        match robot {
            Some(robot) if self.map.follow => robot,
            _ => tank + self.map.offset,
        }
    }
}
