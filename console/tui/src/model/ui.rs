//! What the operator looks at: zoom, filter, selection, and what lies over the screen.

use super::line_edit::LineEdit;
use super::palette::Palette;
use super::{Cause, EventList};
use crate::screens::Screen;
use crate::theme::ThemeName;
use mission::{Order, PlanId, PlannerChoice};
use serde::{Deserialize, Serialize};
use world::Point;

/// What the operator looks at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ui {
    /// Columns of the terminal.
    pub width: u16,
    /// Rows of the terminal.
    pub height: u16,
    /// The screen that is shown.
    pub screen: Screen,
    /// The screens to go back to, the last one first to be taken.
    pub back: Vec<Screen>,
    /// The pane that takes the arrow keys; on a narrow screen the one that is shown.
    pub pane: Pane,
    /// The part of the tank on the map.
    pub map: MapView,
    /// What the map shows.
    pub layers: Layers,
    /// The missed area that is selected on the result screen, among those that are listed.
    pub missed: usize,
    /// The plugin that is selected on the plugins screen.
    pub plugin: usize,
    /// The place on the map that is read, metres, tank frame; `None` without a cursor.
    pub cursor: Option<Point>,
    /// Whether the mouse is taken from the terminal.
    pub mouse: bool,
    /// The filter of the events.
    pub needle: String,
    /// The events that pass it.
    #[serde(default)]
    pub events: EventList,
    /// The selected alarm; `None`: the first one of the table.
    #[serde(default)]
    pub alarm: Option<Cause>,
    /// The colours.
    pub theme: ThemeName,
    /// What lies over the screen.
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
    /// What has been scanned.
    Coverage,
    /// Where the robot is, and how well that is known.
    Position,
    /// What the planner does.
    Planner,
    /// What happened.
    Events,
    /// How the tether lies.
    Tether,
    /// What is wrong.
    Alarms,
    /// What each AE station measured.
    Stations,
    /// What was missed, when the mission has ended.
    Missed,
    /// A quantity over the last minutes.
    Chart(Chart),
}

impl Pane {
    /// The panes that are pages of a screen too small for all of them, in the order of the Tab key.
    pub const PAGES: [Self; 5] = [Self::Map, Self::Coverage, Self::Position, Self::Planner, Self::Events];
}

/// What a chart shows over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Chart {
    /// The 95 % error of the position.
    Error,
    /// The length of tether that is out.
    TetherOut,
    /// The largest wrap.
    Wrap,
    /// The scanned share of the reachable floor.
    Scanned,
}

/// The part of the tank on the map.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MapView {
    /// How often the scale was doubled; 0 shows the whole tank.
    pub zoom: u8,
    /// Whether the robot stays in the middle.
    pub follow: bool,
    /// The middle of the map from the middle of the tank, metres, when it does not follow.
    pub offset: world::Vector,
}

/// Most doublings of the map's scale.
pub const MAX_ZOOM: u8 = 6;

/// A part of the map that can be hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MapLayer {
    /// Scanned floor.
    Scanned,
    /// Where the robot has been.
    Trail,
    /// Where the plan leads.
    Plan,
    /// What the planner draws.
    Drawings,
    /// Acoustic-emission stations.
    Stations,
    /// Where the stations are forecast to locate badly.
    Accuracy,
}

impl MapLayer {
    /// Every layer, in the order of the list.
    pub const ALL: [Self; 6] =
        [Self::Scanned, Self::Trail, Self::Plan, Self::Drawings, Self::Stations, Self::Accuracy];

    /// How the list calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scanned => "scanned floor",
            Self::Trail => "robot trail",
            Self::Plan => "plan",
            Self::Drawings => "planner drawings",
            Self::Stations => "AE stations",
            Self::Accuracy => "accuracy forecast",
        }
    }
}

/// Which parts of the map are hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Layers {
    hidden: [bool; MapLayer::ALL.len()],
}

impl Default for Layers {
    /// Everything but the forecast, which is for planning rather than for watching.
    fn default() -> Self {
        Self { hidden: MapLayer::ALL.map(|layer| layer == MapLayer::Accuracy) }
    }
}

impl Layers {
    /// Whether a layer is shown.
    pub fn shows(&self, layer: MapLayer) -> bool {
        !self.hidden[layer as usize]
    }

    /// Shows a layer or hides it.
    pub fn toggle(&mut self, layer: MapLayer) {
        self.hidden[layer as usize] = self.shows(layer);
    }
}

/// What lies over the screen and takes the keys.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Overlay {
    /// Nothing.
    #[default]
    None,
    /// A line that asks before something moves or ends.
    Confirm(Ask),
    /// The line for single steps.
    Stepping,
    /// The question before leaving.
    Quit,
    /// The list of commands.
    Commands(Palette),
    /// The list of planners.
    Planners {
        /// What the planner is chosen for.
        purpose: Purpose,
        /// Which line is selected.
        selected: usize,
    },
    /// The parameters of the active planner.
    Parameters {
        /// Which line is selected.
        selected: usize,
        /// The value being typed.
        edit: Option<Edit>,
    },
    /// What a preset would change.
    Preset {
        /// Its name.
        name: String,
        /// The planner with its parameters.
        choice: PlannerChoice,
        /// Which line is selected.
        selected: usize,
    },
    /// The layers of the map.
    Layers {
        /// Which line is selected.
        selected: usize,
    },
    /// How the mission would go on with one planner or another.
    WhatIf,
    /// The check before the start.
    Preflight {
        /// Which line is selected.
        selected: usize,
    },
    /// The filter of a list is being typed.
    Filter(LineEdit),
    /// The actions of an alarm.
    Remedies {
        /// Which alarm.
        cause: Cause,
        /// Which line is selected.
        selected: usize,
    },
    /// The line in which is typed for how long and why an alarm is put aside.
    Shelve(Shelving),
    /// The line in which the text of a bookmark at the cursor of a replay is typed.
    Bookmark(LineEdit),
}

/// For how long and why an alarm is put aside, being typed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shelving {
    /// Which alarm.
    pub cause: Cause,
    /// What was typed: minutes, then a reason.
    pub line: LineEdit,
    /// Why it cannot be taken.
    pub refusal: Option<String>,
}

/// What a planner is chosen for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Purpose {
    /// To drive.
    Drive,
    /// To plan for comparison.
    Compare,
    /// To forecast how the mission would go on.
    WhatIf,
    /// To fly in shadow.
    Shadow,
}

/// What a confirm line asks for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// Start the mission with the plan that is shown; `None` where a start names none.
    Start(Option<PlanId>),
    /// Resume.
    Resume,
    /// Fly a plan that was refused because of the tether.
    FlyUncertified,
    /// End the mission.
    Abort,
    /// Let another planner drive.
    Swap(PlannerChoice),
    /// Let the planner in shadow take over.
    Promote,
    /// Fly the better plan.
    TakePlan,
}

impl Ask {
    /// The order that follows when the operator agrees.
    pub fn order(&self) -> Order {
        match self {
            Self::Start(plan) => plan.map_or(Order::Start, Order::StartPlan),
            Self::Resume => Order::Resume,
            Self::FlyUncertified => Order::FlyUncertified,
            Self::Abort => Order::Abort,
            Self::Swap(choice) => Order::ChoosePlanner(choice.clone()),
            Self::Promote => Order::Promote,
            Self::TakePlan => Order::TakePlan,
        }
    }
}

/// A parameter's value being typed.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Edit {
    /// What was typed.
    pub line: LineEdit,
    /// Why it cannot be taken.
    pub refusal: Option<String>,
}

/// How the screen is laid out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// From 120 columns and 30 rows: everything, in full words.
    Wide,
    /// From 80 columns and 24 rows: everything, in short words.
    Narrow,
    /// From 60 columns and 16 rows: one pane at a time.
    Paged,
    /// Below: control of the robot, without a map.
    Strip,
}

impl Arrangement {
    /// How a screen of some size is laid out.
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
    /// How the screen is laid out.
    pub fn arrangement(&self) -> Arrangement {
        Arrangement::of(self.width, self.height)
    }

    /// Goes to a screen; `q` leads back to the one before.
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
        if screen == Screen::Mission {
            // Beside the map the newest events are shown, whatever was read elsewhere.
            self.events.at = None;
        }
    }

    /// Whether a pane can be seen.
    pub fn shows(&self, pane: Pane) -> bool {
        if self.screen != Screen::Mission {
            return pane == Pane::Map && self.has_map();
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

    /// The panes that the Tab key visits.
    pub fn panes(&self) -> &'static [Pane] {
        if self.screen != Screen::Mission {
            return &[];
        }
        match self.arrangement() {
            Arrangement::Wide | Arrangement::Narrow => &[Pane::Map, Pane::Events],
            Arrangement::Paged => &Pane::PAGES,
            Arrangement::Strip => &[],
        }
    }

    /// The middle of the map, metres, tank frame.
    pub fn map_center(&self, tank: Point, robot: Option<Point>) -> Point {
        match robot {
            Some(robot) if self.map.follow => robot,
            _ => tank + self.map.offset,
        }
    }
}
