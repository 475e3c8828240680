//! Scenarios and runs: opening, results, replay, comparison and reports.

use crate::actions::action::{Action, Reach, action};
use crate::actions::argument::{may, must};
use crate::actions::context::Context::{self, On};
use crate::actions::{ActionId, Kind};
use crate::keys::Key;
use crate::model::Screen;
use crate::model::replay::Jump;
use crate::update::offer::{self, demand};
use crate::update::{go, replay, review};

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Open, "open", "Open a scenario", &[], &[Context::Screen]).args(&[must("scenario", Kind::Scenario), may("planner", Kind::Planner)]).reaches(Reach::Runs).when(offer::nothing_under_way),
    action(ActionId::NextMissed, "next-missed", "Show the next missed area", &[Key::Char('n')], &[On(Screen::Result)]).label("missed").repeats().when(offer::missed).looks(|m| go::select_missed(m, 1)),
    action(ActionId::PreviousMissed, "previous-missed", "Show the previous missed area", &[Key::Char('N')], &[On(Screen::Result)]).label("missed").repeats()
        .when(offer::missed).looks(|m| go::select_missed(m, -1)),
    action(ActionId::Again, "again", "Open the same scenario for a new run", &[Key::Char('p')], &[On(Screen::Result)]).label("new run").reaches(Reach::Mission)
        .when(|m| demand(m.live.source.is_some() && !m.live.is_under_way(), "a mission is in progress")).does(go::again),
    action(ActionId::Play, "play", "Play or pause the run (<hold>)", &[], &[Context::Replay]).when(replay::is_loaded).does(replay::toggle),
    action(ActionId::Jump(Jump::TickBack), "tick-back", "Step back one tick", &[Key::Char(',')], &[Context::Replay]).label("tick").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::Tick), "tick-on", "Step forward one tick", &[Key::Char('.')], &[Context::Replay]).label("tick").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::EventBack), "event-back", "Previous event", &[Key::Char('[')], &[Context::Replay]).label("event").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::Event), "event-on", "Next event", &[Key::Char(']')], &[Context::Replay]).label("event").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::AlarmBack), "alarm-back", "Previous alarm", &[Key::Char('{')], &[Context::Replay]).label("alarm").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::Alarm), "alarm-on", "Next alarm", &[Key::Char('}')], &[Context::Replay]).label("alarm").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::MinuteBack), "minute-back", "Step back one minute", &[Key::Char('(')], &[Context::Replay]).label("minute").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::Minute), "minute-on", "Step forward one minute", &[Key::Char(')')], &[Context::Replay]).label("minute").repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::Start), "to-start", "Go to the beginning of the run", &[Key::Char('^')], &[Context::Replay]).when(replay::is_loaded),
    action(ActionId::Jump(Jump::End), "to-end", "Go to the end of the run", &[Key::Char('$')], &[Context::Replay]).when(replay::is_loaded),
    action(ActionId::Seek, "seek", "Go to a moment of the run", &[], &[Context::Replay]).args(&[must("moment", Kind::Moment)]).when(replay::is_loaded),
    action(ActionId::Bookmark, "bookmark", "Set a bookmark, or change its text", &[Key::Char('b')], &[Context::Replay]).label("bookmark").args(&[may("text", Kind::Text)]).reaches(Reach::Runs)
        .when(replay::can_note).does(replay::open_bookmark),
    action(ActionId::Unmark, "remove-bookmark", "Remove the bookmark at this moment", &[Key::Char('B')], &[Context::Replay]).reaches(Reach::Runs).when(replay::can_unmark).does(replay::unmark),
    action(ActionId::Jump(Jump::Bookmark), "next-bookmark", "Next bookmark", &[Key::Char('n')], &[Context::Replay]).repeats().when(replay::is_loaded),
    action(ActionId::Jump(Jump::BookmarkBack), "previous-bookmark", "Previous bookmark", &[Key::Char('N')], &[Context::Replay]).repeats().when(replay::is_loaded),
    action(ActionId::Remark, "remark", "Write a remark about the whole run", &[], &[Context::Replay]).args(&[must("text", Kind::Text)]).reaches(Reach::Runs).when(replay::can_note),
    action(ActionId::Difference, "difference", "Show floor that only one run scanned", &[Key::Char('D')], &[Context::Replay]).label("difference")
        .when(replay::has_second).looks(replay::toggle_difference),
    action(ActionId::Align, "align", "Align two runs by time, path or place", &[Key::Char('T')], &[Context::Replay]).label("align").when(replay::has_second).does(replay::align),
    action(ActionId::Replay, "replay", "Replay a past run", &[], &[Context::Screen]).args(&[may("run", Kind::Run)]).reaches(Reach::Runs).when(replay::can_open).does(|m| go::begin(m, ActionId::Replay)),
    action(ActionId::CompareRun, "compare-run", "Compare a run with the replayed one", &[Key::Char('c')], &[On(Screen::Review)]).label("compare").args(&[may("run", Kind::Run)]).reaches(Reach::Runs)
        .when(replay::can_compare).does(|m| go::begin(m, ActionId::CompareRun)),
    action(ActionId::Sort, "sort", "Change the sort order", &[Key::Char('s')], &[On(Screen::Review)]).label("sort").when(|m| offer::on_screen(m, Screen::Review)).does(review::sort),
    action(ActionId::Rescan, "rescan", "Re-scan what a run missed", &[Key::Char('r')], &[On(Screen::Home), On(Screen::Review), On(Screen::Result)]).label("re-scan").args(&[may("run", Kind::Run)]).reaches(Reach::Runs)
        .when(offer::rescan).does(|m| go::begin(m, ActionId::Rescan)),
    action(ActionId::Verify, "verify", "Recompute a run and compare its journal", &[Key::Char('v')], &[On(Screen::Home), On(Screen::Review), On(Screen::Result)]).label("verify").args(&[may("run", Kind::Run)])
        .when(offer::written_run).does(|m| go::begin(m, ActionId::Verify)),
    action(ActionId::Report, "report", "Write the report of a run", &[Key::Char('w')], &[On(Screen::Home), On(Screen::Review), On(Screen::Result)]).label("report").args(&[may("run", Kind::Run)]).reaches(Reach::Runs)
        .when(offer::run).does(|m| go::begin(m, ActionId::Report)),
    action(ActionId::HandOver, "handover", "Write a page for the next operator", &[], &[Context::Screen]).args(&[must("file", Kind::Text), may("overwrite", Kind::Text)]).reaches(Reach::Runs)
        .when(offer::has_mission),
    action(ActionId::View, "view", "Open the recording of a run in rerun", &[Key::Char('o')], &[On(Screen::Home), On(Screen::Review), Context::Replay, On(Screen::Result)]).label("rerun").args(&[may("run", Kind::Run)])
        .when(offer::run).does(|m| go::begin(m, ActionId::View)),
];
