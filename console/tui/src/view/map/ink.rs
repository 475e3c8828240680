//! The kinds of lines on the map: colour, pattern, and letter for terminals without dots.

use super::pattern::Pattern;
use crate::theme::Role;

/// How a kind of line is drawn. Where lines of two kinds can be on the map together, their patterns differ, so that
/// they can be told apart without colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::view) struct Ink {
    pub role: Role,
    pub pattern: Pattern,
    /// The letter that replaces the dots.
    pub letter: char,
}

const fn ink(role: Role, pattern: Pattern, letter: char) -> Ink {
    Ink { role, pattern, letter }
}

/// The wall.
pub(super) const WALL: Ink = ink(Role::Wall, Pattern::Solid, 'o');
/// The robot's trail.
pub(in crate::view) const TRAIL: Ink = ink(Role::Trail, Pattern::Solid, '.');
/// The part of the plan that has been driven.
pub(super) const DRIVEN: Ink = ink(Role::Dim, Pattern::Solid, '.');
/// The lane on which the robot is, or the way to the next one.
pub(super) const LEG: Ink = ink(Role::Target, Pattern::Thick, '*');
/// The plan before the start.
pub(super) const PLAN: Ink = ink(Role::Plan, Pattern::Solid, ',');
/// A way of the plan to a different part of the floor, before the start.
pub(super) const WAY: Ink = ink(Role::Dim, Pattern::Dashed, '|');
/// The plan ahead of the robot.
pub(super) const AHEAD: Ink = ink(Role::Plan, Pattern::Dashed, ',');
/// A better plan that is on offer.
pub(super) const OFFER: Ink = ink(Role::Watch, Pattern::Dotted, '=');
/// The plan or the forecast of a different planner, or the trail of a different run.
pub(super) const OTHER: Ink = ink(Role::Ghost, Pattern::Ticked, 'b');
/// The plan of the planner in shadow.
pub(super) const SHADOW: Ink = ink(Role::Ghost, Pattern::LongDashed, ';');
/// The part of the plan that a zone blocks.
pub(super) const BLOCKED: Ink = ink(Role::Crit, Pattern::Zigzag, 'W');
/// The outline of a zone that is being drawn or asked about.
pub(super) const OUTLINE: Ink = ink(Role::Title, Pattern::Rope, 'Z');
/// The tether.
pub(super) const TETHER: Ink = ink(Role::Tether, Pattern::Double, '~');
/// A simulated tether that can be slack, as it lies on the floor.
pub(super) const CABLE: Ink = ink(Role::Tether, Pattern::Stitched, ']');
/// A planner drawing of a force that attracts the robot.
pub(super) const PULL: Ink = ink(Role::Pull, Pattern::Jagged, '{');
/// A planner drawing of a force that repels the robot.
pub(super) const PUSH: Ink = ink(Role::Push, Pattern::Beaded, '}');
/// The planner's other drawings.
pub(super) const DRAWN: Ink = ink(Role::Drawn, Pattern::DashDotted, '\'');

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_are_on_the_map_together_differ_without_colours() {
        let together: [&[Ink]; 3] = [
            &[TRAIL, LEG, AHEAD, OFFER, SHADOW, TETHER, CABLE, OTHER, PULL, PUSH, DRAWN, OUTLINE, BLOCKED],
            &[PLAN, WAY, OTHER, OFFER],
            &[DRIVEN, LEG, AHEAD, OFFER, SHADOW, OTHER, OUTLINE, BLOCKED],
        ];
        assert_ne!(OUTLINE.role, BLOCKED.role, "both are on the map with the question about a zone");
        for inks in together {
            for (index, one) in inks.iter().enumerate() {
                let differs = |other: &Ink| other.pattern != one.pattern && other.letter != one.letter;
                assert!(inks[index + 1..].iter().all(differs), "{one:?} in {inks:?}");
            }
        }
    }
}
