//! The mission: start, speed, planner and end.

use crate::actions::action::{Action, Reach, action};
use crate::actions::argument::{may, must};
use crate::actions::context::Context::{self, On};
use crate::actions::{ActionId, Kind, Risk};
use crate::keys::Key;
use crate::model::Screen;
use crate::model::ui::{Ask, Purpose};
use crate::update::offer::{self, accepted, demand};
use crate::update::overlay::ask;
use crate::update::send::send;
use crate::update::setting::propose_planner;
use crate::update::{Effect, act, finish, overlay, preflight, preset, shadow, what_if};
use mission::Order;

#[rustfmt::skip]
pub(super) const ROWS: &[Action] = &[
    action(ActionId::Hold, "hold", "HOLD; when held: resume (asks)", &[Key::Char(' ')], &[Context::Anywhere]).label("HOLD").also(&["stop", "pause", "halt"]).reaches(Reach::Pace)
        .when(offer::hold).does(act::hold),
    action(ActionId::Interrupt, "interrupt", "HOLD; twice: quit (asks)", &[Key::Ctrl('c')], &[Context::Anywhere]).does(act::interrupt),
    action(ActionId::Start, "start", "Start the mission", &[Key::Char('S')], &[On(Screen::Plan), On(Screen::Mission)]).label("start").risk(Risk::Moves)
        .when(offer::start).does(|m| ask(m, Ask::Start(m.live.run.standing.ready_plan()))),
    action(ActionId::Resume, "resume", "Resume after a hold", &[], &[Context::Screen]).risk(Risk::Moves).also(&["continue"]).when(|m| accepted(m, &Order::Resume)).does(|m| ask(m, Ask::Resume)),
    action(ActionId::DriveBack, "return", "Drive back to the anchor or start (held)", &[], &[Context::Screen]).risk(Risk::Moves).also(&["drive-back"])
        .when(|m| accepted(m, &Order::DriveBack)).does(finish::ask_way_back),
    action(ActionId::FlyUncertified, "run-uncertified", "Run a plan refused because of the tether", &[], &[Context::Screen]).risk(Risk::Moves)
        .also(&["fly-uncertified"]).when(offer::uncertified).does(|m| ask(m, Ask::FlyUncertified)),
    action(ActionId::Step, "step", "Move for one tick (while held)", &[Key::Char('.')], &[On(Screen::Mission)]).label("step").risk(Risk::Moves)
        .when(|m| accepted(m, &Order::Step)).does(|m| act::step(m, Order::Step)),
    action(ActionId::Slower, "slower", "Slow the simulation down", &[Key::Char('<')], &[Context::Screen]).label("speed").repeats().reaches(Reach::Pace)
        .when(|m| offer::speed(m, false)).does(|m| act::change_speed(m, false)),
    action(ActionId::Faster, "faster", "Speed the simulation up", &[Key::Char('>')], &[Context::Screen]).label("speed").repeats().reaches(Reach::Pace)
        .when(|m| offer::speed(m, true)).does(|m| act::change_speed(m, true)),
    action(ActionId::SetSpeed, "speed", "Set the speed of the simulation", &[], &[Context::Screen]).args(&[must("factor", Kind::Speed)]).also(&["rate", "pace"]).reaches(Reach::Pace).when(offer::simulating),
    action(ActionId::Abort, "end", "HOLD, then end or drive back (asks)", &[Key::Char('X')], &[Context::Screen]).label("end").risk(Risk::Destroys).also(&["abort", "finish"])
        .when(offer::abort).does(finish::begin),
    action(ActionId::ChoosePlanner, "planner", "Change the planner (not while moving)", &[Key::Char('P')], &[On(Screen::Plan), On(Screen::Mission)]).label("planner").risk(Risk::Changes).args(&[may("planner", Kind::Planner)])
        .when(offer::swap).does(|m| act::choose(m, Purpose::Drive)),
    action(ActionId::Shadow, "shadow", "Run a planner in shadow", &[], &[Context::Screen]).args(&[may("planner", Kind::Planner)]).reaches(Reach::Mission)
        .when(shadow::can_begin).does(|m| act::choose(m, Purpose::Shadow)),
    action(ActionId::Promote, "promote", "Promote the planner in shadow", &[], &[Context::Screen]).risk(Risk::Moves).when(|m| accepted(m, &Order::Promote)).does(|m| propose_planner(m, Ask::Promote)),
    action(ActionId::DropShadow, "shadow-off", "Stop the planner in shadow", &[], &[Context::Screen]).reaches(Reach::Mission).when(|m| accepted(m, &Order::DropShadow)).does(|m| send(m, Order::DropShadow)),
    action(ActionId::TakePlan, "take-plan", "Take the better plan on offer", &[Key::Char('T')], &[On(Screen::Mission)]).label("take plan").risk(Risk::Moves)
        .when(|m| accepted(m, &Order::TakePlan)).does(|m| ask(m, Ask::TakePlan)),
    action(ActionId::Parameters, "parameters", "View and change planner parameters", &[Key::Char('p')], &[On(Screen::Plan), On(Screen::Mission)]).label("parameters")
        .when(offer::changeable_parameters).does(overlay::open_parameters),
    action(ActionId::SetParameter, "set", "Change a planner parameter", &[], &[Context::Screen]).args(&[must("parameter", Kind::Parameter)]).reaches(Reach::Mission).when(offer::changeable_parameters),
    action(ActionId::WhatIf, "what-if", "Forecast with other planners (held)", &[Key::Char('w')], &[On(Screen::Mission)]).label("what-if").reaches(Reach::Mission)
        .when(|m| accepted(m, &Order::NoteOutlooks(Vec::new()))).does(what_if::open),
    action(ActionId::NextCandidate, "next-candidate", "Next forecast", &[Key::Right, Key::Char('l')], &[Context::WhatIf]).label("select").repeats().looks(|m| what_if::select(m, 1)),
    action(ActionId::PreviousCandidate, "previous-candidate", "Previous forecast", &[Key::Left, Key::Char('h')], &[Context::WhatIf]).label("select").repeats().looks(|m| what_if::select(m, -1)),
    action(ActionId::AddCandidate, "add-candidate", "Forecast another planner", &[Key::Char('+')], &[Context::WhatIf]).label("add").does(|m| act::choose(m, Purpose::WhatIf)),
    action(ActionId::TryParameters, "try-parameters", "Change parameters for another forecast", &[Key::Char('p')], &[Context::WhatIf]).label("parameters").does(what_if::draft),
    action(ActionId::ForecastDraft, "forecast-draft", "Forecast with these parameters", &[Key::Char('w')], &[Context::Draft]).label("forecast").does(what_if::forecast_draft),
    action(ActionId::PresetLoad, "preset-load", "Show what a parameter preset changes", &[], &[Context::Screen]).args(&[must("preset", Kind::Preset)]).when(preset::can_load),
    action(ActionId::TickValue, "tick-value", "Take or leave the value of the preset", &[Key::Char('t')], &[Context::Preset]).label("take/leave").does(preset::tick),
    action(ActionId::PresetSave, "preset-save", "Save the parameters as a preset", &[], &[Context::Screen]).args(&[must("name", Kind::Text)]).when(offer::parameters),
    action(ActionId::Preflight, "preflight", "Run the pre-flight checks", &[Key::Char('A')], &[On(Screen::Plan), On(Screen::Mission)]).label("pre-flight").reaches(Reach::Mission)
        .when(|m| demand(m.live.waits(), "checks can only be run before the start")).does(preflight::open),
    action(ActionId::Compare, "compare", "Compare with another planner's plan", &[Key::Char('c')], &[On(Screen::Plan)]).label("compare").args(&[may("planner", Kind::Planner)]).reaches(Reach::Mission)
        .when(|m| demand(m.live.waits(), "plans can only be compared before the start").and(offer::has_plan(m)).and(offer::has_planners(m))).does(|m| act::choose(m, Purpose::Compare)),
    action(ActionId::Preflight, "check-again", "Check again", &[Key::Char('r')], &[Context::Preflight]).label("check again").reaches(Reach::Mission)
        .when(|m| demand(m.live.waits(), "checks can only be run before the start")).does(preflight::open),
    action(ActionId::PlanAgain, "plan-again", "Make the plan of this mission once more", &[], &[On(Screen::Plan)]).reaches(Reach::Mission)
        .when(|m| demand(m.live.waits(), "no mission is waiting to start").and(offer::has_plan(m))).does(|_| vec![Effect::Order(Order::Plan)]),
    action(ActionId::CancelPlan, "cancel-plan", "Cancel planning or comparison", &[Key::Esc], &[On(Screen::Plan)]).label("cancel").reaches(Reach::Mission).when(offer::cancel_plan).does(overlay::cancel_plan),
];
