//! Tests that `export_planners!` exports a table and a stamp from a crate that forbids unsafe code.
#![forbid(unsafe_code)]

use planner_api::{
    Caps, Command, Config, Ctx, ParamSpec, Plan, PlanRequest, Planner, Result, Sensed, Site, export_planners,
};

struct Idle;

impl Planner for Idle {
    const ID: &'static str = "idle";
    const NAME: &'static str = "Idle";
    const CAPS: Caps = Caps::LOCAL;
    const PARAMS: &'static [ParamSpec] = &[];

    fn configure(_: &Config<'_>, _: &Site<'_>, _: &Ctx<'_>) -> Result<Self> {
        Ok(Self)
    }

    fn plan(&mut self, _: &PlanRequest<'_>, _: &Ctx<'_>) -> Result<Plan> {
        Ok(Plan::default())
    }

    fn step(&mut self, _: &Sensed<'_>, _: &Ctx<'_>) -> Result<Command> {
        Ok(Command::twist(0.0, 0.0))
    }
}

export_planners!(Idle);

#[test]
fn the_macro_puts_stamp_and_ids_into_the_file() {
    let own = std::env::current_exe().and_then(std::fs::read).expect("the test can read itself");
    // Built at run time, so that the search does not find the bytes in the test's own constants.
    let stamp: Vec<u8> = "NALPKNAT"
        .bytes()
        .rev()
        .chain(planner_api::abi::MAJOR.to_le_bytes())
        .chain(planner_api::abi::MINOR.to_le_bytes())
        .chain(*b"idle\0")
        .collect();
    assert!(own.windows(stamp.len()).any(|bytes| bytes == stamp), "the stamp is in the file");
}
