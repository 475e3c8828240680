//! The list of planners: those that can run the mission, then those that cannot, folded into one line.

use super::Model;
use mission::PlannerInfo;

/// A line of the list of planners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlannerLine<'a> {
    /// A planner.
    Planner(&'a PlannerInfo),
    /// This many planners that cannot run the mission.
    Others(usize),
}

impl Model {
    /// The lines of the list of planners. The planners that cannot run the mission are one line until the list is
    /// unfolded.
    pub fn planner_lines(&self, is_unfolded: bool) -> Vec<PlannerLine<'_>> {
        let run = &self.live.run;
        let is_listed = |planner: &&PlannerInfo| {
            run.cannot_fly(planner).is_none() || run.planner_id() == Some(planner.id.as_str())
        };
        let (first, others): (Vec<_>, Vec<_>) = self.console.planners.iter().partition(is_listed);
        let folded = Some(PlannerLine::Others(others.len())).filter(|_| !is_unfolded && !others.is_empty());
        let unfolded = others.into_iter().filter(|_| is_unfolded).map(PlannerLine::Planner);
        first.into_iter().map(PlannerLine::Planner).chain(folded).chain(unfolded).collect()
    }
}
