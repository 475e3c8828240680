//! Flies a robot according to a law: the forces at its estimated position give the direction, and the pilot limits
//! speed and distance.

use crate::{
    escape::Situation,
    law::{Beside, Law, RotationForm},
    response::TrapResponse,
    settings::{FieldSettings, RotationUse},
    turning::Turning,
};
use geometry::{Vector, convex::Part};
use planner_api::{Command, Ctx, Layer, Result, Sensed, Site};
use steering::{
    Contact, Decision, Forces, Pilot, Side, Source, Tick, detour::Detour, drawing::FAR_M, evade,
    wall_contacts,
};

/// Factor by which the speed is multiplied if the force reverses.
const TURNED_BACK: f64 = 0.5;
/// Factor by which the speed is multiplied if the force does not reverse.
const GOES_ON: f64 = 1.2;
/// Minimum speed, as a share of the speed that the pilot allows.
const LEAST_SHARE: f64 = 0.02;

/// Flies a robot along the resultant of a law.
#[derive(Debug, Clone)]
pub struct ForcePilot {
    pilot: Pilot,
    response: TrapResponse,
    settling: Settling,
    /// The time at which the next move of the plan would begin, seconds: the paper checks for traps between moves.
    due_s: f64,
}

/// The motion of the robot, and the reasons for it.
#[derive(Debug, Clone)]
pub struct Reasoned {
    /// The motion.
    pub decision: Decision,
    /// The forces behind the motion.
    pub forces: Forces,
    /// The detour in progress, if any.
    pub detour: Option<Detour>,
}

impl ForcePilot {
    /// Creates a pilot for a site.
    pub fn new(settings: &FieldSettings, site: &Site<'_>) -> Self {
        let response = TrapResponse::new(settings);
        let settling = Settling { share: 1.0, last: Vector::zeros() };
        Self { pilot: Pilot::pursuing(site), response, settling, due_s: f64::NEG_INFINITY }
    }

    /// Applies changed settings during the flight. The rotating force starts over with its gate closed; all other state
    /// is kept.
    pub fn reset(&mut self, settings: &FieldSettings) {
        self.response.turning = Turning::new(settings.reading, settings.rule, settings.gate);
    }

    /// Returns the command for one tick, and draws the forces.
    ///
    /// # Errors
    /// The console requests a stop.
    pub fn step(&mut self, settings: &FieldSettings, sensed: &Sensed<'_>, ctx: &Ctx<'_>) -> Result<Command> {
        ctx.check()?;
        let (movers, standing) = evade::sorted_if(settings.evades, sensed, self.pilot.bodies(sensed));
        let tick = Tick::toward_target(sensed, &standing);
        let Reasoned { decision, forces, detour } = self.decide(settings, &tick);
        forces.show(ctx, sensed.pose.position, settings.law.k_att);
        show_detour(ctx, detour.as_ref());
        Ok(self.pilot.past(&movers, decision, &tick, ctx))
    }

    /// Decides the motion in a situation, without a console.
    pub fn decide(&mut self, settings: &FieldSettings, tick: &Tick<'_>) -> Reasoned {
        let flight = &settings.flight;
        let status = self.pilot.watch(flight, tick);
        let detour = match settings.rotation_use {
            RotationUse::Paper => None,
            RotationUse::Gaps => self.pilot.way_round(tick, self.pilot.keep_m(flight, &tick.pose)),
        };
        let contacts = self.contacts(&settings.law, tick, detour.as_ref());
        let forces = self.forces(settings, tick, &contacts, detour.as_ref());
        let along = self.pilot.velocity(flight, tick, forces.resultant(), &contacts);
        let velocity = match settings.rotation_use {
            RotationUse::Paper => along * self.settling.share(forces.resultant()),
            RotationUse::Gaps => along,
        };
        Reasoned { decision: Decision { velocity, status }, forces, detour }
    }

    /// The contacts that act on the robot: the nearest part of every body, the closed gaps of a detour, and the wall.
    fn contacts(&self, law: &Law, tick: &Tick<'_>, detour: Option<&Detour>) -> Vec<Contact> {
        let (at, hull_m) = (tick.pose.position, self.pilot.limits().radius_m);
        let mut contacts: Vec<Contact> = tick
            .bodies
            .iter()
            .filter_map(|body| body.nearest_contact(at, hull_m))
            .filter(|contact| contact.distance_m < law.rho_0_m)
            .collect();
        for &(a, b) in detour.map_or(&[][..], |detour| &detour.closed) {
            let (distance_m, away) = Part::segment(a, b).distance(at);
            let contact = Contact { source: Source::Gap, distance_m: distance_m - hull_m, away };
            // A robot that is already in the gap must be able to leave it on either side.
            if (0.0..law.rho_0_m).contains(&contact.distance_m) {
                contacts.push(contact);
            }
        }
        if law.wall_gain > 0.0 {
            contacts.extend(wall_contacts(self.pilot.wall(), at, hull_m, law.reach_m(Source::Wall)));
        }
        contacts
    }

    fn forces(
        &mut self,
        settings: &FieldSettings,
        tick: &Tick<'_>,
        contacts: &[Contact],
        detour: Option<&Detour>,
    ) -> Forces {
        let at = tick.pose.position;
        match settings.rotation_use {
            RotationUse::Gaps => {
                // The printed form would make the robot jerk at the range of every obstacle.
                let law = Law { rotation: RotationForm::Smooth, beside: Beside::All, ..settings.law };
                let goal = at + (tick.target - at).cap_magnitude(FAR_M);
                unopposed(law.forces(at, goal, contacts, |c| side_of(detour, c)))
            }
            RotationUse::Paper => {
                self.look_out_for_traps(settings, tick, contacts);
                let side = |c: &Contact| self.response.turning.side(c);
                let forces = settings.law.forces(at, tick.target, contacts, side);
                let escape = self.response.escape;
                let mut forces = settings.law.beside.left_of(forces, escape != Vector::zeros());
                forces.attraction += escape;
                forces
            }
        }
    }

    fn look_out_for_traps(&mut self, settings: &FieldSettings, tick: &Tick<'_>, contacts: &[Contact]) {
        if tick.t_s < self.due_s {
            return;
        }
        let (step_m, law) = (settings.walking.step_m, &settings.law);
        self.due_s = tick.t_s + step_m / self.pilot.limits().v_max_m_per_s.max(1e-3);
        let now = Situation { at: tick.pose.position, goal: tick.target, contacts, law, step_m };
        self.response.update(&now, step_m);
    }
}

/// Reduces the speed when the force reverses and increases it otherwise, as Riedmiller and Braun 1993 adapt step sizes.
/// A tick is much longer than a move of a plan. In a local minimum, a robot at full speed would therefore oscillate
/// around the point where the plan stops, and bounce along a wall far from that point.
#[derive(Debug, Clone, Copy)]
struct Settling {
    share: f64,
    last: Vector,
}

impl Settling {
    /// The share of the speed to use, given the current force.
    fn share(&mut self, force: Vector) -> f64 {
        let turns_back = force.dot(&self.last) < 0.0;
        let share = self.share * if turns_back { TURNED_BACK } else { GOES_ON };
        *self = Self { share: share.clamp(LEAST_SHARE, 1.0), last: force };
        self.share
    }
}

/// Removes the components of the forces that oppose the rotation, so that nothing stops the robot on its way around.
fn unopposed(forces: Forces) -> Forces {
    let Some(around) = forces.rotation.try_normalize(1e-9) else { return forces };
    let along = |force: Vector| force - around * force.dot(&around).min(0.0);
    Forces { attraction: along(forces.attraction), repulsion: along(forces.repulsion), ..forces }
}

fn side_of(detour: Option<&Detour>, contact: &Contact) -> Option<Side> {
    let detour = detour?;
    let belongs = match contact.source {
        Source::Obstacle(id) => detour.members.contains(&id),
        Source::Gap => true,
        Source::Wall => false,
    };
    belongs.then_some(detour.side)
}

fn show_detour(ctx: &Ctx<'_>, detour: Option<&Detour>) {
    if let Some(detour) = detour.filter(|_| ctx.wants_drawing()) {
        for &(a, b) in &detour.closed {
            ctx.polyline(Layer::Virtual, &[a, b]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_the_force_turns_back_the_robot_settles_and_goes_on_at_full_speed_where_it_does_not() {
        let mut settling = Settling { share: 1.0, last: Vector::zeros() };
        assert!((0..9).all(|k| settling.share(Vector::new(1.0, 0.1 * f64::from(k))) > 0.999));
        let (mut at_m, spring) = (0.31, |at_m: f64| Vector::new(-30.0 * at_m, 0.0));
        for _ in 0..200 {
            let force = spring(at_m);
            at_m += 0.1 * settling.share(force) * force.x.signum();
        }
        assert!(at_m.abs() < 0.005, "{at_m}");
        let recovered = (0..40).fold(0.0, |_, _| settling.share(Vector::y()));
        assert!(recovered > 0.999);
    }
}
