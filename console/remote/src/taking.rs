//! Takes a vehicle over for a flight: connects to its adapter, and refuses a vehicle that does not fit the scenario.

use crate::{Address, Remote, loopback::looped_back};
use flight::{Flight, failure::bad_input};
use planner_api::Motion;
use scenario::Scenario;
use vehicle::{
    port::{LEASE_S, VehicleInfo},
    wire::message::{Has, Hello, MotionKind},
};

/// A vehicle that is to be driven.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wanted {
    /// The address of its adapter; `None` for the address in the scenario.
    pub at: Option<Address>,
    /// Whether the adapter may be on another machine.
    pub network: bool,
}

/// The flight, with a real vehicle if one is requested.
///
/// # Errors
/// The vehicle cannot be reached, or does not fit the scenario; the message says what to do.
pub fn connected(flight: Flight, scenario: &Scenario, wanted: Option<&Wanted>) -> anyhow::Result<Flight> {
    let Some(wanted) = wanted else { return Ok(flight) };
    if wanted.at == Some(Address::Loopback) {
        return looped_back(flight, scenario).map_err(|misfit| bad_input(misfit.to_string()));
    }
    let (remote, info) = taken(scenario, wanted)?;
    Ok(flight.with_vehicle(scenario, Box::new(remote), info))
}

/// Checks that a vehicle fits a scenario, without driving it.
///
/// # Errors
/// See [`connected`].
pub fn fitting(scenario: &Scenario, wanted: &Wanted) -> anyhow::Result<VehicleInfo> {
    taken(scenario, wanted).map(|(_, info)| info)
}

fn taken(scenario: &Scenario, wanted: &Wanted) -> anyhow::Result<(Remote, VehicleInfo)> {
    let address = match (&wanted.at, &scenario.vehicle.at) {
        (Some(at), _) => at.clone(),
        (None, Some(at)) => {
            at.parse().map_err(|error: crate::address::NoAddress| bad_input(error.to_string()))?
        }
        (None, None) => {
            return Err(bad_input(
                "--vehicle has no address, and the scenario has none either (`vehicle.at`); write \
                 `--vehicle unix:PATH`, tcp:HOST:PORT, udp:HOST:PORT or run:COMMAND",
            ));
        }
    };
    let connected = Remote::connect(&address, wanted.network, &scenario.sim.world.stations);
    let (remote, hello) = connected.map_err(|error| bad_input(error.to_string()))?;
    let misfits = misfits(scenario, &hello);
    if !misfits.is_empty() {
        let name = foreign::plain(&hello.name).into_owned();
        return Err(bad_input(format!(
            "vehicle {name} at {address} does not fit scenario {}: {}",
            scenario.name,
            misfits.join("; ")
        )));
    }
    let info = info(&hello, &address.to_string());
    Ok((remote, info))
}

/// The reasons why a vehicle does not fit a scenario, with the remedies.
fn misfits(scenario: &Scenario, hello: &Hello) -> Vec<String> {
    let (mission, needs) = (&scenario.mission, &scenario.vehicle);
    let Has { odometry, pose, contact, tether, ae, .. } = hello.has;
    let mut found = Vec::new();
    let mut refuse = |is_wrong: bool, why: String| found.extend(is_wrong.then_some(why));
    let most_tick_s = LEASE_S / 2.0;
    refuse(
        mission.tick_s > most_tick_s,
        format!(
            "a tick of {} s is too long for leases of {LEASE_S} s; at most {most_tick_s} s is allowed",
            mission.tick_s
        ),
    );
    refuse(
        hello.lease_max_s < LEASE_S,
        format!("it honours leases of at most {} s; {LEASE_S} s is needed", hello.lease_max_s),
    );
    refuse(
        hello.period_s > LEASE_S,
        format!("it sends readings every {} s; at most {LEASE_S} s is allowed", hello.period_s),
    );
    let is_unicycle = mission.limits.motion == Motion::Unicycle;
    refuse(
        !is_unicycle && hello.motion == MotionKind::Unicycle,
        "the robot of the scenario moves in any direction (`robot.motion`), but the vehicle cannot".into(),
    );
    let (speed, turn) = (mission.limits.v_max_m_per_s, mission.limits.w_max_rad_per_s);
    let limits = hello.limits;
    refuse(
        speed > limits.speed_m_per_s,
        format!(
            "the scenario drives at {speed} m/s (`robot.speed_max_m_per_s`); the vehicle's limit is {}",
            limits.speed_m_per_s
        ),
    );
    refuse(
        turn > limits.turn_rad_per_s,
        format!(
            "the scenario turns at {turn:.3} rad/s (`robot.turn_rate_max_deg_per_s`); the vehicle's limit is {:.3}",
            limits.turn_rad_per_s
        ),
    );
    refuse(
        limits.radius_m > mission.limits.radius_m + 1e-9,
        format!(
            "its hull has a radius of {} m; the scenario states {} m",
            limits.radius_m, mission.limits.radius_m
        ),
    );
    refuse(
        hello.stop_time_s > needs.stop_max_s,
        format!(
            "it needs {} s to stop; at most {} s is allowed (`vehicle.stop_max_s`)",
            hello.stop_time_s, needs.stop_max_s
        ),
    );
    refuse(!odometry && !pose, "it measures neither odometry nor a pose".into());
    refuse(
        !contact && !needs.without_contact,
        "it has no bumper (`vehicle.without_contact` allows this)".into(),
    );
    let has_stations = !scenario.sim.world.stations.is_empty();
    refuse(
        has_stations && !ae && !needs.without_ranges,
        "it has no ranges to the stations (`vehicle.without_ranges` allows this)".into(),
    );
    refuse(
        mission.tether.is_some() && !tether && !needs.without_reel,
        "it does not measure the tether (`vehicle.without_reel` allows this)".into(),
    );
    found
}

/// The description of a vehicle at an address.
pub(crate) fn info(hello: &Hello, at: &str) -> VehicleInfo {
    // The ids of obstacles are not a sensor.
    let has = Has { drawn_ids: false, ..hello.has };
    VehicleInfo {
        name: foreign::plain(&hello.name).into_owned(),
        at: at.to_owned(),
        protocol: hello.protocol,
        lease_s: hello.lease_max_s,
        stop_s: hello.stop_time_s,
        speed_max_m_per_s: hello.limits.speed_m_per_s,
        turn_max_rad_per_s: hello.limits.turn_rad_per_s,
        has: has.parts().into_iter().map(str::to_owned).collect(),
    }
}
