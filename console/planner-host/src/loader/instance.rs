//! An instance of a planner, and calls to it.

use super::sink::Sink;
use crate::wire::answer::{BAD_OUTPUT, Refusal};
use planner_api::abi::{self, PlanOut, StepOut, Str, Value, lend};
use planner_api::{Code, Command, Plan, PlanRequest, Sensed, Site};
use std::ffi::c_void;

/// An instance of a planner; it is destroyed through its own function table.
pub(crate) struct Instance {
    table: abi::Planner,
    planner: *mut c_void,
}

const CHECKED: &str = "required functions were checked when the table was read";

fn accept(code: i32, sink: &mut Sink<'_>) -> Result<(), Refusal> {
    if code == 0 {
        return Ok(());
    }
    let partial = std::mem::take(&mut sink.points);
    Err(Refusal { code, message: sink.take_error(), partial })
}

/// Checks that nothing that the planner passed is larger than the console accepts.
fn within_limits(sink: &Sink<'_>) -> Result<(), Refusal> {
    sink.exceeds.map_or(Ok(()), |what| Err(bad_output(format!("gave {what}"))))
}

fn bad_output(message: String) -> Refusal {
    Refusal { code: BAD_OUTPUT, message, partial: Vec::new() }
}

fn unsupported() -> Refusal {
    Refusal {
        code: Code::Unsupported as i32,
        message: "not offered by this planner".to_owned(),
        partial: Vec::new(),
    }
}

fn lend_values(values: &[(String, f64)]) -> Vec<Value> {
    values.iter().map(|(key, number)| Value { key: Str::of(key), number: *number }).collect()
}

impl Instance {
    pub(super) fn create(
        table: &abi::Planner,
        site: &Site<'_>,
        values: &[(String, f64)],
        sink: &mut Sink<'_>,
    ) -> Result<Self, Refusal> {
        let create = table.create.expect(CHECKED);
        let (obstacles, zones) = (lend::obstacles(site.obstacles), lend::zones(site.zones));
        let (site, values) = (lend::site(site, &obstacles, &zones), lend_values(values));
        let mut planner = std::ptr::null_mut();
        // SAFETY: everything lent outlives the call, here and below.
        let code = sink.during(|host| unsafe {
            create(host, &raw const site, values.as_ptr(), values.len() as u32, &raw mut planner)
        });
        accept(code, sink)?;
        if planner.is_null() {
            return Err(bad_output("reported success but created no instance".to_owned()));
        }
        Ok(Self { table: *table, planner })
    }

    /// Passes new values of live parameters.
    pub(crate) fn reconfigure(
        &mut self,
        values: &[(String, f64)],
        sink: &mut Sink<'_>,
    ) -> Result<(), Refusal> {
        let reconfigure = self.table.reconfigure.ok_or_else(unsupported)?;
        let values = lend_values(values);
        // SAFETY: as above.
        let code = sink
            .during(|host| unsafe { reconfigure(self.planner, host, values.as_ptr(), values.len() as u32) });
        accept(code, sink)
    }

    /// Requests a plan.
    pub(crate) fn plan(&mut self, request: &PlanRequest<'_>, sink: &mut Sink<'_>) -> Result<Plan, Refusal> {
        let plan = self.table.plan.expect(CHECKED);
        let site = request.site;
        let (obstacles, zones) = (lend::obstacles(site.obstacles), lend::zones(site.zones));
        let site = lend::site(site, &obstacles, &zones);
        let parts = lend::PlanParts::of(request);
        let input = lend::plan(request, &site, &parts);
        let mut out = PlanOut::UNSET;
        // SAFETY: as above.
        let code = sink.during(|host| unsafe { plan(self.planner, host, &raw const input, &raw mut out) });
        accept(code, sink)?;
        within_limits(sink)?;
        if out.complete > 1 {
            return Err(bad_output("gave a plan without stating whether it is complete".to_owned()));
        }
        let legs = sink.legs.drain(..).map(|leg| leg.get()).collect::<Result<_, _>>().map_err(bad_output)?;
        Ok(Plan {
            path: std::mem::take(&mut sink.points),
            cost: out.cost,
            complete: out.complete == 1,
            legs,
            cuts: std::mem::take(&mut sink.cuts),
        })
    }

    /// Requests a command.
    pub(crate) fn step(&mut self, sensed: &Sensed<'_>, sink: &mut Sink<'_>) -> Result<Command, Refusal> {
        let step = self.table.step.expect(CHECKED);
        let obstacles = lend::obstacles(sensed.obstacles);
        let input = lend::step(sensed, &obstacles);
        let mut out = StepOut::UNSET;
        // SAFETY: as above.
        let code = sink.during(|host| unsafe { step(self.planner, host, &raw const input, &raw mut out) });
        accept(code, sink)?;
        out.get().map_err(bad_output)
    }

    /// Requests the private state.
    pub(crate) fn snapshot(&mut self, sink: &mut Sink<'_>) -> Result<Vec<u8>, Refusal> {
        let snapshot = self.table.snapshot.ok_or_else(unsupported)?;
        // SAFETY: as above.
        let code = sink.during(|host| unsafe { snapshot(self.planner, host) });
        accept(code, sink)?;
        if let Some(what) = sink.exceeds {
            // The planner continues without its saved state.
            let message = format!("it has {what}");
            return Err(Refusal { code: Code::State as i32, message, partial: Vec::new() });
        }
        Ok(std::mem::take(&mut sink.bytes))
    }

    /// Passes the private state of an earlier instance.
    pub(crate) fn restore(&mut self, version: u32, state: &[u8], sink: &mut Sink<'_>) -> Result<(), Refusal> {
        let restore = self.table.restore.ok_or_else(unsupported)?;
        // SAFETY: as above.
        let code =
            sink.during(|host| unsafe { restore(self.planner, host, version, state.as_ptr(), state.len()) });
        accept(code, sink)
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if let Some(destroy) = self.table.destroy {
            // SAFETY: it is the planner's own pointer and is not used again.
            unsafe { destroy(self.planner) }
        }
    }
}
