//! The functions of the C ABI for any [`Planner`]; only `export_planners!` and the console's tests refer to them.
//!
//! All of the author's code runs under `catch_unwind`, including its `drop`. An instance that panicked is poisoned:
//! every further call returns [`Code::Poisoned`].

mod guard;
mod inputs;
mod services;

use crate::abi::{self, Str, output};
use crate::{Code, Config, Ctx, Kind, ParamSpec, Planner, PlannerError, Result, Stopping, params};
pub use guard::on_own_thread;
use guard::{quietly, run};
use inputs::{
    SensedParts, SiteParts, config_values, plan_request, reason_of, regions_of, task_of, under_way_of,
};
use services::HostServices;
use std::ffi::c_void;

/// A boxed planner; the console keeps the pointer to it.
struct Slot<P> {
    planner: P,
    poisoned: bool,
}

/// Runs `call` on an instance unless it is poisoned, and poisons the instance if `call` panics.
///
/// # Safety
/// `instance` is null or came from [`create`] for the same `P`, and is not in use elsewhere.
unsafe fn on<P: Planner>(
    instance: *mut c_void,
    services: &HostServices,
    call: impl FnOnce(&mut P) -> Result<()>,
) -> i32 {
    // SAFETY: promised by the caller.
    let Some(slot) = (unsafe { instance.cast::<Slot<P>>().as_mut() }) else {
        services.error("called without an instance");
        return Code::State as i32;
    };
    if slot.poisoned {
        services.error("it panicked earlier and cannot be called again");
        return Code::Poisoned as i32;
    }
    let code = run(services, || call(&mut slot.planner));
    slot.poisoned = code == Code::Panic as i32;
    code
}

/// Passes every declared parameter to the console.
///
/// # Safety
/// `host` points to the console's services.
pub unsafe extern "C" fn describe<P: Planner>(host: *const abi::Host) -> i32 {
    // SAFETY: promised by the caller.
    let services = unsafe { HostServices::read(host) };
    run(&services, || {
        for spec in P::PARAMS {
            declare(spec, &services);
        }
        Ok(())
    })
}

fn declare(spec: &ParamSpec, services: &HostServices) {
    let joined;
    let (kind, min, max, options) = match spec.kind {
        Kind::Float { min, max, .. } => (output::PARAM_FLOAT, min, max, ""),
        Kind::Int { min, max, .. } => (output::PARAM_INT, min as f64, max as f64, ""),
        Kind::Flag { .. } => (output::PARAM_FLAG, 0.0, 1.0, ""),
        Kind::Choice { options, .. } => {
            joined = options.join("|");
            (output::PARAM_CHOICE, 0.0, options.len() as f64 - 1.0, joined.as_str())
        }
    };
    services.param(&abi::Param {
        size: size_of::<abi::Param>() as u32,
        kind,
        flags: if spec.live { output::PARAM_LIVE } else { 0 },
        reserved: 0,
        key: Str::of(spec.key),
        label: Str::of(spec.label),
        unit: Str::of(spec.unit),
        help: Str::of(spec.help),
        group: Str::of(spec.group),
        options: Str::of(options),
        min,
        max,
        default: params::default_number(&spec.kind),
    });
}

/// Configures a planner and gives the console a pointer to it.
///
/// # Safety
/// `host` and `site` point to structs of the console, `values` to an array of `n` values, and `instance` to space for a
/// pointer.
pub unsafe extern "C" fn create<P: Planner>(
    host: *const abi::Host,
    site: *const abi::Site,
    values: *const abi::Value,
    n: u32,
    instance: *mut *mut c_void,
) -> i32 {
    // SAFETY: promised by the caller, here and below.
    let services = unsafe { HostServices::read(host) };
    run(&services, || {
        // SAFETY: as above.
        let (parts, values) = unsafe { (SiteParts::read(site)?, config_values(values, n)?) };
        let config = Config::new(P::PARAMS, &values);
        let planner = P::configure(&config, &parts.site()?, &Ctx::new(&services))?;
        let slot = Box::new(Slot { planner, poisoned: false });
        // SAFETY: as above.
        unsafe { instance.write(Box::into_raw(slot).cast()) };
        Ok(())
    })
}

/// Drops a planner; a panic in its `drop` is ignored.
///
/// # Safety
/// `instance` is null or came from [`create`] for the same `P`, and is not used again.
pub unsafe extern "C" fn destroy<P: Planner>(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: promised by the caller.
        let slot = unsafe { Box::from_raw(instance.cast::<Slot<P>>()) };
        quietly(|| drop(slot));
    }
}

/// Gives a planner new values of live parameters.
///
/// # Safety
/// See [`create`] and [`destroy`].
pub unsafe extern "C" fn reconfigure<P: Planner>(
    instance: *mut c_void,
    host: *const abi::Host,
    values: *const abi::Value,
    n: u32,
) -> i32 {
    // SAFETY: promised by the caller.
    unsafe {
        let services = HostServices::read(host);
        on::<P>(instance, &services, |planner| {
            let values = config_values(values, n)?;
            planner.reconfigure(&Config::new(P::PARAMS, &values), &Ctx::new(&services))
        })
    }
}

/// Requests a plan: passes its points, legs and cuts to the console, and writes its cost and completeness to `out`.
///
/// # Safety
/// For `instance` see [`destroy`]; `host`, `input` and `out` point to structs of the console.
pub unsafe extern "C" fn plan<P: Planner>(
    instance: *mut c_void,
    host: *const abi::Host,
    input: *const abi::PlanIn,
    out: *mut abi::PlanOut,
) -> i32 {
    // SAFETY: promised by the caller, here and in the closure.
    let services = unsafe { HostServices::read(host) };
    let call = |planner: &mut P| {
        // SAFETY: as above.
        let input = unsafe { abi::copy_sized(input) };
        // SAFETY: as above.
        let parts = unsafe { SiteParts::read(input.site)? };
        let site = parts.site()?;
        // SAFETY: as above.
        let (reason, regions) = unsafe { (reason_of(&input), regions_of(&input)?) };
        // SAFETY: as above.
        let (task, under_way) = unsafe { (task_of(&input, &regions)?, under_way_of(&input)?) };
        // SAFETY: as above.
        let request = unsafe { plan_request(&input, &reason, task, &site, under_way.as_ref()) };
        let plan = planner
            .plan(&request, &Ctx::new(&services))
            .inspect_err(|error| services.points(&error.partial))?;
        services.points(&plan.path);
        services.legs(&plan.legs);
        plan.cuts.iter().for_each(|cut| services.cut(cut));
        // SAFETY: as above.
        unsafe {
            (*out).cost = plan.cost;
            (*out).complete = u32::from(plan.complete);
        }
        Ok(())
    };
    // SAFETY: promised by the caller.
    unsafe { on::<P>(instance, &services, call) }
}

/// Requests a command and writes it to `out`.
///
/// # Safety
/// See [`plan`].
pub unsafe extern "C" fn step<P: Planner>(
    instance: *mut c_void,
    host: *const abi::Host,
    input: *const abi::StepIn,
    out: *mut abi::StepOut,
) -> i32 {
    // SAFETY: promised by the caller.
    unsafe {
        let services = HostServices::read(host);
        on::<P>(instance, &services, |planner| {
            let parts = SensedParts::read(input)?;
            let command = planner.step(&parts.sensed(), &Ctx::new(&services))?;
            (*out).set(command);
            Ok(())
        })
    }
}

/// Tells a planner that it will be stopped; returns 1 if it needs a few more steps.
///
/// # Safety
/// For `instance` see [`destroy`]; `host` points to the console's services.
pub unsafe extern "C" fn stopping<P: Planner>(instance: *mut c_void, host: *const abi::Host) -> u32 {
    let mut answer = Stopping::Done;
    // SAFETY: promised by the caller.
    unsafe {
        let services = HostServices::read(host);
        on::<P>(instance, &services, |planner| {
            answer = planner.stopping(&Ctx::new(&services));
            Ok(())
        });
    }
    u32::from(answer == Stopping::NeedsSteps)
}

/// Passes a planner's private state to the console.
///
/// # Safety
/// See [`stopping`].
pub unsafe extern "C" fn snapshot<P: Planner>(instance: *mut c_void, host: *const abi::Host) -> i32 {
    // SAFETY: promised by the caller.
    unsafe {
        let services = HostServices::read(host);
        on::<P>(instance, &services, |planner| {
            services.bytes(&planner.snapshot()?);
            Ok(())
        })
    }
}

/// Passes the state of an earlier instance to a planner.
///
/// # Safety
/// See [`stopping`]; `state` points to `n` bytes.
pub unsafe extern "C" fn restore<P: Planner>(
    instance: *mut c_void,
    host: *const abi::Host,
    version: u32,
    state: *const u8,
    n: usize,
) -> i32 {
    // SAFETY: promised by the caller.
    unsafe {
        let services = HostServices::read(host);
        on::<P>(instance, &services, |planner| planner.restore(version, abi::slice(state, n)))
    }
}

fn invalid(message: &str) -> PlannerError {
    PlannerError::new(Code::Invalid, message)
}

#[cfg(test)]
mod tests;
