//! A plan for a mission that has not been run: its figures for scripts and people, and its picture.

use crate::{
    drawing::plan::{Drawn, svg},
    leg::{Leg, legs},
};
use account::{LeftOut, estimate::time_s};
use mission::{MissionConfig, Parameters, TaskConfig, event::RunOpened, tether::certify_from_start};
use planner_api::Plan;
use serde::Serialize;
use world::{
    Cell, CoverageGrid, ObstacleMap, Point, Shape, SweptArea, Tool, World,
    coverage::percent_text,
    polyline,
    tether::{Cable, Certificate},
};

/// A measured time below this consists mostly of the round trip to the planner's process, milliseconds.
const RESOLVED_MS: f64 = 0.05;

/// A plan for scripts.
#[derive(Debug, Serialize)]
pub struct Planned {
    pub(crate) planner: String,
    parameters: Parameters,
    pub(crate) path: Vec<Point>,
    pub(crate) legs: Vec<Leg>,
    /// Lines that the tethered robot never crosses.
    pub(crate) cuts: Vec<Vec<Point>>,
    pub(crate) length_m: f64,
    /// Time to drive the path at full speed, with stops to turn at corners, seconds.
    mission_time_s: f64,
    /// Time to compute the plan, milliseconds; absent if it is too short to distinguish from the round trip to the
    /// planner.
    plan_time_ms: Option<f64>,
    pub(crate) complete: bool,
    /// The reason why the plan is not complete.
    reason: Option<String>,
    /// Warnings from the planner: which floor it omits and why, and how it handles cases that the published method does
    /// not define.
    warnings: Vec<String>,
    /// The reachable floor as the reports define it; absent for missions without a scan.
    floor: Option<PlannedFloor>,
    /// The requested floor that the plan leaves out, with the reasons; absent for missions without a scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<LeftOut>,
    /// The tether along the path; absent without a tether.
    certificate: Option<Certificate>,
}

/// The reachable floor as the reports define it: with the whole swath, including the overlap of lanes.
#[derive(Debug, Serialize)]
struct PlannedFloor {
    /// Width of floor scanned in one pass, metres.
    swath_m: f64,
    /// Floor that the tool can reach, square metres.
    reachable_m2: f64,
    /// Floor along the shell that the tool cannot reach, square metres.
    shell_margin_m2: f64,
    /// Floor that the tool cannot test because of the welds, square metres; absent if it can test all floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    untestable_m2: Option<f64>,
    /// Share of the reachable floor that the path scans, counted in cells, 0 to 1.
    scanned: f64,
    /// Share of the reachable floor that the path scans, from the exact area that the tool sweeps; absent if no floor
    /// is reachable.
    scanned_exact: Option<f64>,
}

/// The answer of a planner.
#[derive(Debug)]
pub struct Made {
    /// The plan.
    pub plan: Plan,
    /// Time to compute the plan, milliseconds.
    pub plan_time_ms: f64,
    /// The reason why the plan is not complete.
    pub reason: Option<String>,
    /// Warnings from the planner: which floor it omits and why, and how it handles cases that the published method does
    /// not define.
    pub warnings: Vec<String>,
}

impl Planned {
    /// A plan for the mission of a run that has not begun, on the drawing of its tank.
    pub fn new(run: &RunOpened, made: Made) -> Self {
        let Made { plan, plan_time_ms, reason, warnings } = made;
        let (mission, drawing) = (&run.mission, &run.world.as_drawn());
        let map = ObstacleMap::new(&drawing.boundary, &drawing.obstacles);
        Self {
            planner: mission.planner.id.clone(),
            parameters: mission.planner.parameters.clone(),
            legs: legs(&plan),
            length_m: polyline::length_m(&plan.path),
            mission_time_s: time_s(mission, &map, &plan.path),
            plan_time_ms: Some(plan_time_ms).filter(|time_ms| *time_ms >= RESOLVED_MS),
            complete: plan.complete,
            reason,
            warnings,
            floor: planned_floor(mission, drawing, &plan.path),
            left_out: LeftOut::of(run, &plan.path, &plan.cuts, plan.complete),
            certificate: certificate(mission, drawing, &plan),
            cuts: plan.cuts,
            path: plan.path,
        }
    }

    /// Length of the plan's path, metres, and time to drive the path at full speed, with stops to turn at corners,
    /// seconds.
    pub fn effort(&self) -> (f64, f64) {
        (self.length_m, self.mission_time_s)
    }

    /// Whether the plan achieves the whole task and has a valid tether certificate, so that the mission would accept
    /// it.
    pub fn flies(&self, mission: &MissionConfig) -> bool {
        let must_be_certified = mission.tether.as_ref().is_some_and(|tether| !tether.allow_uncertified);
        let is_certified = self.certificate.as_ref().is_some_and(|certificate| certificate.certified);
        self.complete && (is_certified || !must_be_certified)
    }

    /// The plan as a picture, an SVG document.
    pub fn svg(&self, mission: &MissionConfig, drawing: &World) -> String {
        let preset = match &mission.task {
            TaskConfig::Follow { path, .. } => Some(path.as_slice()),
            TaskConfig::Cover { .. } | TaskConfig::Goto { .. } | TaskConfig::Survey { .. } => None,
        };
        let anchor = mission.tether.as_ref().map(|tether| tether.anchor);
        let cable = anchor.and_then(|anchor| longest_cable(anchor, drawing, &self.path)).unwrap_or_default();
        svg(&Drawn {
            world: drawing,
            room_m: mission.room_m(),
            swath_m: mission.swath_m,
            preset,
            anchor,
            path: &self.path,
            legs: &self.legs,
            cuts: &self.cuts,
            cable: &cable,
        })
    }

    /// The figures as text.
    pub fn human(&self) -> String {
        let reason = self.reason.as_ref().map(|reason| format!("reason    {reason}\n")).unwrap_or_default();
        format!(
            "planner   {}\nlength    {:.2} m, {} points\n{}computed  in {}\ncomplete  {}\n{reason}{}{}{}{}",
            self.planner,
            self.length_m,
            self.path.len(),
            lengths(self),
            self.plan_time_ms
                .map_or_else(|| format!("under {RESOLVED_MS} ms"), |time_ms| format!("{time_ms:.2} ms")),
            complete(self),
            warnings(self),
            self.floor.as_ref().map(floor).unwrap_or_default(),
            self.left_out.as_ref().map(left_out).unwrap_or_default(),
            self.certificate.as_ref().map(certified).unwrap_or_default(),
        )
    }
}

fn planned_floor(mission: &MissionConfig, drawing: &World, path: &[Point]) -> Option<PlannedFloor> {
    let TaskConfig::Cover { .. } = &mission.task else { return None };
    let (maker, swath_m) = (mission.floor_maker(drawing), mission.swath_m);
    let floor = maker.clone().into_floor();
    let area_m2 = |kind: Cell| {
        (0..floor.len()).filter(|index| floor.kind(*index) == kind).count() as f64 * floor.cell_m2()
    };
    let (reachable_m2, shell_margin_m2) = (area_m2(Cell::Reachable), area_m2(Cell::Margin));
    let untestable_m2 = Some(area_m2(Cell::Untestable)).filter(|area_m2| *area_m2 > 0.0);
    let (mut cells, mut area) = (CoverageGrid::new(floor), SweptArea::new(&drawing.boundary));
    Tool::along(path, |from, to| {
        cells.mark(mission.tool(), from, to);
        area.pass(mission.tool(), from, to);
    });
    let shapes: Vec<Shape> = drawing.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
    let scanned_exact = area.share_of(&maker, &drawing.boundary, &shapes);
    Some(PlannedFloor {
        swath_m,
        reachable_m2,
        shell_margin_m2,
        untestable_m2,
        scanned: cells.fraction_reachable(),
        scanned_exact,
    })
}

/// Certifies the tether along the path, independently of the planner; `None` without a tether.
fn certificate(mission: &MissionConfig, drawing: &World, plan: &Plan) -> Option<Certificate> {
    let tether = mission.tether.as_ref().filter(|_| !plan.path.is_empty())?;
    Some(certify_from_start(tether, mission, &plan.path, &plan.cuts, drawing))
}

fn longest_cable(anchor: Point, world: &World, path: &[Point]) -> Option<Vec<Point>> {
    let shapes: Vec<Shape> = world.obstacles.iter().map(|obstacle| obstacle.shape.clone()).collect();
    let cable = Cable::new(anchor, &world.boundary, &shapes).ok()?;
    Some(cable.at_longest(path).taut_line())
}

/// Lengths by tag, as text.
fn lengths(planned: &Planned) -> String {
    let length_m = |tag| -> f64 {
        let legs = planned.legs.iter().filter(|leg| leg.tag == tag);
        legs.map(|leg| polyline::length_m(&planned.path[leg.first..=leg.last])).sum()
    };
    let by_tag = ["swath", "connector", "retract", "travel"].map(|tag| (tag, length_m(tag)));
    let parts: Vec<String> = by_tag
        .iter()
        .filter(|(_, length_m)| *length_m > 0.0)
        .map(|(tag, length_m)| format!("{tag} {length_m:.1} m"))
        .collect();
    if parts.is_empty() { String::new() } else { format!("legs      {}\n", parts.join(", ")) }
}

/// The warnings as text, except the warning that is already printed as the reason.
fn warnings(planned: &Planned) -> String {
    let fresh = planned.warnings.iter().filter(|warning| Some(*warning) != planned.reason.as_ref());
    fresh.map(|warning| format!("warning   {warning}\n")).collect::<Vec<_>>().concat()
}

/// Whether the planner achieves the task. A planner counts the floor that its own lanes can reach, so a complete plan may
/// leave out requested floor.
fn complete(planned: &Planned) -> String {
    if !planned.complete {
        return "no".into();
    }
    match planned.left_out.as_ref().filter(|left_out| !left_out.areas.is_empty()) {
        Some(left_out) => {
            let share = percent_text(1.0 - left_out.scanned(), 2);
            format!("as the planner counts; {share} % of the requested floor is left out")
        }
        None => "yes".into(),
    }
}

/// The most areas that are listed as text.
const MOST_AREAS: usize = 5;

/// The requested floor that the plan leaves out, as text: the largest areas with their reasons.
fn left_out(left_out: &LeftOut) -> String {
    let n = left_out.areas.len();
    if n == 0 {
        return String::new();
    }
    let areas: Vec<String> =
        left_out.areas.iter().take(MOST_AREAS).map(|area| format!("          {area}\n")).collect();
    let more = n.checked_sub(MOST_AREAS + 1).map(|more| format!("          and {} more\n", more + 1));
    let plural = if n == 1 { "" } else { "s" };
    format!(
        "left out  {:.2} m² in {n} area{plural}\n{}{}",
        left_out.area_m2(),
        areas.concat(),
        more.unwrap_or_default()
    )
}

/// The floor as text.
fn floor(floor: &PlannedFloor) -> String {
    let PlannedFloor { swath_m, reachable_m2, shell_margin_m2, untestable_m2, scanned, scanned_exact } =
        floor;
    let untestable = untestable_m2
        .map(|area_m2| format!(", {area_m2:.2} m² not testable by this tool"))
        .unwrap_or_default();
    let exact = scanned_exact
        .map(|share| format!(", {} % by exact area", percent_text(share, 2)))
        .unwrap_or_default();
    format!(
        "floor     {reachable_m2:.1} m² reachable, {shell_margin_m2:.2} m² shell margin{untestable}; as in reports, for \
         the full swath of {swath_m} m\nscanned   {} % of it in cells of the report{exact}\n",
        percent_text(*scanned, 2)
    )
}

/// The certificate as text.
fn certified(certificate: &Certificate) -> String {
    let Certificate { tether_length_max_m, eccentricity_m, wrap_max_rad, wrap_total_max_rad, .. } =
        certificate;
    let reasons: Vec<String> = certificate.reasons.iter().map(|why| format!("          {why}\n")).collect();
    format!(
        "tether    {}, at most {tether_length_max_m:.2} m out (minimum possible {eccentricity_m:.2} m), \
         wrap {:.0}° on one obstacle, {:.0}° in total\n{}{}",
        match (certificate.certified, certificate.warnings.is_empty()) {
            (true, true) => "certified",
            (true, false) => "certified with a warning",
            (false, _) => "NOT certified",
        },
        wrap_max_rad.to_degrees(),
        wrap_total_max_rad.to_degrees(),
        reasons.concat(),
        pull(certificate),
    )
}

/// The pull as text.
fn pull(certificate: &Certificate) -> String {
    let warnings: Vec<String> = certificate.warnings.iter().map(|why| format!("warning   {why}\n")).collect();
    let text = certificate.pull_text();
    let figures = certificate.pull.map_or_else(String::new, |pull| {
        format!(", ratio {:.2}; the robot pulls at most {:.1} N", pull.ratio(), pull.robot_needed_n)
    });
    let own_gap = certificate.own_gap.map_or_else(String::new, |own_gap| {
        format!(
            "own gap   on the way in, the hull comes no nearer than {} to its own taut tether\n",
            own_gap.text()
        )
    });
    format!("{}{figures}\n{own_gap}{}", text.replacen("pull ", "pull      ", 1), warnings.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::round_tank;

    #[test]
    fn a_complete_plan_that_leaves_floor_out_says_so_with_its_reasons() {
        let run = round_tank(0.05);
        let lanes = (0..14).flat_map(|k| [-3.0, 3.0].map(|x| Point::new(x, -3.9 + 0.6 * f64::from(k))));
        let plan = Plan { path: lanes.collect(), complete: true, ..Plan::default() };
        let text =
            Planned::new(&run, Made { plan, plan_time_ms: 1.0, reason: None, warnings: vec![] }).human();
        assert!(text.contains("complete  as the planner counts; "), "{text}");
        assert!(
            text.contains("\nleft out  ") && text.contains("no lane of the plan runs along it here"),
            "{text}"
        );
    }

    #[test]
    fn a_time_that_cannot_be_told_from_the_way_to_the_planner_is_no_figure() {
        let run = round_tank(0.05);
        let planned = |plan_time_ms| {
            let made = Made { plan: Plan::default(), plan_time_ms, reason: None, warnings: vec![] };
            Planned::new(&run, made)
        };
        assert_eq!(planned(0.014).plan_time_ms, None);
        assert!(planned(0.014).human().contains("computed  in under 0.05 ms\n"));
        assert!(planned(1.5).human().contains("computed  in 1.50 ms\n"));
        // The length of a plan without a path is 0, without a sign.
        assert!(planned(1.5).length_m.is_sign_positive());
    }
}
