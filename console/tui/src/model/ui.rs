//! What the operator is looking at: screen, zoom, filter, selection and overlay.

mod map_view;
mod overlay;
mod pane;

pub use map_view::{Layers, MAX_ZOOM, MapLayer, MapView};
pub use overlay::{Ask, Edit, Overlay, Purpose, Shelving};
pub use pane::{Chart, MissionParts, Pane};

use super::history::HISTORY_S;
use super::{Cause, EventList};
use crate::screens::Screen;
use crate::theme::ThemeName;
use serde::{Deserialize, Serialize};
use world::Point;

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
    /// Whether the mission screen shows one pane alone.
    #[serde(default)]
    pub is_alone: bool,
    /// The longest time that a chart shows, seconds of mission time.
    #[serde(default = "whole_history")]
    pub span_s: usize,
    /// The index of the selected station in the table of the stations.
    #[serde(default)]
    pub station: usize,
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

fn whole_history() -> usize {
    HISTORY_S
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
            is_alone: false,
            span_s: HISTORY_S,
            station: 0,
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

    /// Whether the mission screen shows one pane on the whole screen.
    pub(crate) fn shows_one(&self) -> bool {
        self.is_alone && self.screen == Screen::Mission && self.arrangement() != Arrangement::Strip
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
        if self.shows_one() {
            return self.pane == pane;
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
            (Screen::Mission, _) if self.shows_one() => return self.parts.alone(),
            (Screen::Mission, _) => {}
            _ => return &[],
        }
        match self.arrangement() {
            Arrangement::Wide => self.parts.beside_map(false),
            Arrangement::Narrow => self.parts.beside_map(true),
            Arrangement::Paged => &Pane::PAGES,
            Arrangement::Strip => &[],
        }
    }

    /// The panes that have a key of their own, which their titles show: those of a screen that is wide enough to show
    /// more than one at a time.
    pub fn numbered_panes(&self) -> &'static [Pane] {
        match self.panes() {
            _ if self.shows_one() => &[],
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
