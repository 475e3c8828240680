//! From lanes to a path: tour, touch-ups, and how good the result is.

use crate::{
    cuts::{Cut, CutRule, Domain},
    floor::FloorGrid,
    ground::Ground,
    lanes::{Lane, Pattern, Reach, lanes},
    polish::{Prices, Side, Track},
    side_by_side::Stop,
    slit::Slit,
    touch::touch_up,
    tour::{Costs, Effort, Tour, Ways, tour},
};
use planner_api::Result;
use std::f64::consts::TAU;
use world::{Point, Vector, polyline};

/// Path that missed floor costs in touch-ups, as a multiple of its area by the swath.
const MISSED_SHARE: f64 = 2.5;

/// Share of the search for the order that a draft gets.
const DRAFT_SHARE: f64 = 0.3;
/// Rounds in which the path is bent to missed floor.
const BENDS: usize = 5;
/// Path and turning that such floor may cost, as a multiple of its area by the swath.
const BEND_SHARE: f64 = 24.0;
/// Cells of the smallest group that the path is bent to.
const BEND_CELLS: usize = 3;
/// Share of the floor scanned so far that has to be left when the path is shortened, if only some floor is asked for.
const KEPT: f64 = 0.9;
/// Rounds in which small touch-ups are tied in.
const TOUCH_UPS: usize = 8;
/// Rounds after which a little less is enough, but smaller places count as well.
const SOON_ENOUGH: usize = 3;
/// Cells of the smallest group that gets a touch-up, and of the smallest one late.
const CELLS: usize = 8;
const LATE_CELLS: usize = 4;
/// How much less, as a share of the floor.
const LATE_SHARE: f64 = 0.0001;

/// How far a candidate is after its tour, when what it sweeps is known, when it is shortened and when it is bent, as shares
/// of the time that finishing it takes, about.
const TOURED: f64 = 0.27;
const TRACKED: f64 = 0.32;
const SHORTENED: f64 = 0.63;
const BENT: f64 = 0.92;
/// What the first half of a round of bends takes of the time left for bends.
const HALF_A_BEND: f64 = 0.35;

/// Everything that makes one candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recipe {
    /// How the lanes lie.
    pub pattern: Pattern,
    /// What the cuts may look like.
    pub rule: CutRule,
    /// How near lanes come to what bounds them.
    pub reach: Reach,
    /// Tour.
    pub effort: Effort,
    /// Missed floor below this is left, square metres.
    pub touch_m2: f64,
    /// Rounds of touch-ups.
    pub rounds: usize,
    /// What floor is worth, metres of path per square metre.
    pub floor_m_per_m2: f64,
    /// Coverage that is enough, as a share of the reachable floor.
    pub enough: f64,
}

/// A piece of the path.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Its points.
    pub points: Vec<Point>,
    /// Whether it is a lane; otherwise a way between lanes.
    pub is_lane: bool,
}

/// A path over the floor.
#[derive(Debug, Clone)]
pub struct Scan {
    /// Lanes and ways in turn.
    pub pieces: Vec<Piece>,
    /// The cuts it does not cross.
    pub cuts: Vec<Cut>,
    /// The domain.
    pub slit: Slit,
    /// The floor with what was swept.
    pub grid: FloorGrid,
}

impl Scan {
    /// The cuts as lines.
    pub fn cut_lines(&self) -> Vec<Vec<Point>> {
        self.cuts.iter().map(|cut| cut.line.clone()).collect()
    }

    /// The whole path.
    pub fn path(&self) -> Vec<Point> {
        let mut path: Vec<Point> = Vec::new();
        for point in self.pieces.iter().flat_map(|piece| &piece.points) {
            if path.last().is_none_or(|last| (point - last).norm() > 1e-6) {
                path.push(*point);
            }
        }
        path
    }
}

/// What is to be scanned, from where, and how far the robot may go.
#[derive(Debug, Clone, Copy)]
pub struct Order<'a> {
    /// Where the robot is.
    pub start: Point,
    /// Polygons still to scan; all floor if empty.
    pub regions: &'a [&'a [Point]],
    /// Longest way from home, metres.
    pub reel_length_m: f64,
    /// Edge of a cell of the floor, metres.
    pub cell_m: f64,
}

/// A candidate as far as the first tour: enough to estimate what it will be worth.
pub struct Draft<'a> {
    ground: &'a Ground,
    order: Order<'a>,
    recipe: Recipe,
    cuts: Vec<Cut>,
    slit: Slit,
    /// The floor to scan, without room for sweeps: with it a large one takes many megabytes.
    floor: FloorGrid,
    lanes: Vec<Lane>,
    /// What ways between their ends cost, as far as it is known.
    costs: Costs,
    pieces: Vec<Piece>,
    start: Point,
    /// Length, with what is still to scan, metres.
    length_m: f64,
    turns: f64,
}

impl<'a> Draft<'a> {
    /// The first tour of a candidate.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn new(
        ground: &'a Ground,
        recipe: &Recipe,
        (cuts, slit): Domain,
        order: &Order<'a>,
        stop: &Stop,
    ) -> Result<Self> {
        stop.stage(0.5);
        let home = ground.home();
        let start = if slit.contains(order.start) { order.start } else { home };
        let all = lanes(ground, &slit, &cuts, &recipe.pattern, &recipe.reach);
        let (order, recipe, lanes, pieces) = (*order, *recipe, Vec::new(), Vec::new());
        let (length_m, turns) = (0.0, 0.0);
        let mut grid = FloorGrid::new(ground, &slit, order.cell_m);
        grid.keep_within(order.regions);
        let (floor, costs) = (grid.without_sweeps(), Costs::default());
        let mut draft =
            Self { ground, order, recipe, cuts, slit, floor, lanes, costs, pieces, start, length_m, turns };
        draft.lanes = draft.wanted(&grid, all);
        stop.stage(0.95);
        draft.pieces = draft.toured(DRAFT_SHARE, stop)?;
        stop.stage(1.0);
        let path = joined(&draft.pieces);
        grid.sweep(&path);
        let missed_m2 = (1.0 - grid.coverage()) * grid.area_m2();
        draft.length_m = polyline::length_m(&path) + MISSED_SHARE * missed_m2 / ground.swath_m;
        draft.turns = rotation_turns(&path);
        Ok(draft)
    }

    /// What the finished path will cost, about, metres, at this price of a whole turn.
    pub fn estimate_m(&self, turn_m: f64) -> f64 {
        self.length_m + turn_m * self.turns
    }

    fn toured(&mut self, share_of_kicks: f64, stop: &Stop) -> Result<Vec<Piece>> {
        let effort = self.recipe.effort;
        let effort = Effort { kicks_per_lane: effort.kicks_per_lane * share_of_kicks, ..effort };
        let costs = std::mem::take(&mut self.costs);
        let ends = (self.ground.home(), self.start);
        let ways = Ways::new(&self.slit, &self.lanes, ends, effort.turn_m_per_rad, costs);
        let order = tour(&ways, &effort, stop)?;
        let pieces = assembled(&ways, &self.lanes, &order);
        self.costs = ways.into_costs();
        Ok(pieces)
    }

    fn is_in_reach(&self, at: Point) -> bool {
        let order = &self.order;
        let way_m = || self.slit.way_m(self.ground.home(), at);
        order.reel_length_m.is_infinite() || way_m().is_some_and(|way_m| way_m <= order.reel_length_m)
    }

    fn wanted(&self, grid: &FloorGrid, lanes: Vec<Lane>) -> Vec<Lane> {
        let is_wanted = |at: Point| {
            self.is_in_reach(at) && (self.order.regions.is_empty() || grid.has_reachable_near(at))
        };
        if self.order.reel_length_m.is_infinite() && self.order.regions.is_empty() {
            return lanes;
        }
        lanes.iter().flat_map(|lane| lane.kept(&is_wanted)).collect()
    }

    /// The candidate with its touch-ups, shortened wherever that pays.
    ///
    /// # Errors
    /// When the console wants an end.
    pub fn finished(mut self, stop: &Stop) -> Result<Scan> {
        stop.stage(0.02);
        let mut grid = self.floor.unswept();
        let mut pieces = std::mem::take(&mut self.pieces);
        for round in 0..self.recipe.rounds {
            grid.clear();
            grid.sweep(&joined(&pieces));
            let least = (self.recipe.touch_m2 / (self.order.cell_m * self.order.cell_m)) as usize;
            let missed = grid.missed();
            let large = missed.iter().take_while(|group| group.len() > least);
            let fresh: Vec<Lane> =
                large.flat_map(|g| touch_up(self.ground, &self.slit, &self.cuts, &grid, g)).collect();
            let fresh = self.wanted(&grid, fresh);
            if fresh.is_empty() && round > 0 {
                break;
            }
            self.lanes.extend(fresh);
            // The draft was quick; from here on the order matters.
            stop.stage(TOURED);
            pieces = self.toured(1.0, stop)?;
        }
        stop.stage(TRACKED);
        let mut track = Track::new(&self.slit, &pieces, grid);
        self.polish(&mut track, stop)?;
        let (pieces, grid) = (pieces_of(&track.points, &track.sides), track.grid);
        Ok(Scan { pieces, cuts: self.cuts, slit: self.slit, grid })
    }

    /// Shortens the path, bends it to floor that it misses, and ties in short lanes where that is not enough.
    fn polish(&self, track: &mut Track<'_>, stop: &Stop) -> Result<()> {
        let Recipe { floor_m_per_m2, enough, effort, .. } = self.recipe;
        let prices = Prices { turn_m_per_rad: effort.turn_m_per_rad, floor_m_per_m2 };
        let careful = Prices { floor_m_per_m2: 1e6, ..prices };
        let in_reach = |at: Point| self.is_in_reach(at);
        let asked_for = (!self.order.regions.is_empty()).then(|| track.clone());
        stop.stage(SHORTENED);
        track.shorten(&prices, stop)?;
        if let Some(whole) = asked_for.filter(|whole| track.grid.coverage() < KEPT * whole.grid.coverage()) {
            // A little floor far away is not worth its way, but nothing else was asked for.
            *track = whole;
            track.shorten(&careful, stop)?;
        }
        let mut at = SHORTENED;
        for _ in 0..BENDS {
            at += (BENT - at) * HALF_A_BEND;
            stop.stage(at);
            let most_m_per_m2 = BEND_SHARE / self.ground.swath_m;
            if track.bend(&in_reach, &prices, (enough, BEND_CELLS), most_m_per_m2, stop)? == 0 {
                break;
            }
            at += (BENT - at) * HALF_A_BEND;
            stop.stage(at);
            track.shorten(&careful, stop)?;
        }
        at = BENT;
        let mut is_late = false;
        for round in 0..TOUCH_UPS {
            is_late |= round >= SOON_ENOUGH;
            at += (1.0 - at) / 2.0;
            stop.stage(at);
            let enough = enough - if is_late { LATE_SHARE } else { 0.0 };
            let least = if is_late { LATE_CELLS } else { CELLS };
            if track.touch_up(self.ground, &self.cuts, &in_reach, &prices, (enough, least), stop)? == 0 {
                if std::mem::replace(&mut is_late, true) {
                    break;
                }
                continue;
            }
            track.shorten(&careful, stop)?;
        }
        Ok(())
    }
}

/// Runs of sides of one kind.
fn pieces_of(points: &[Point], sides: &[Side]) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for (k, Side { on_lane: is_lane, .. }) in sides.iter().copied().enumerate() {
        match pieces.last_mut() {
            Some(piece) if piece.is_lane == is_lane => piece.points.push(points[k + 1]),
            _ => pieces.push(Piece { points: vec![points[k], points[k + 1]], is_lane }),
        }
    }
    for piece in &mut pieces {
        piece.points = straightened(&piece.points);
    }
    pieces
}

/// The same line without points that lie on the straight way between their neighbours.
fn straightened(points: &[Point]) -> Vec<Point> {
    let mut kept = vec![points[0]];
    for k in 1..points.len() - 1 {
        let (before, after) = (points[k] - kept[kept.len() - 1], points[k + 1] - points[k]);
        let is_corner = before.perp(&after).abs() > 1e-9 * (1.0 + before.norm()) || before.dot(&after) < 0.0;
        if is_corner {
            kept.push(points[k]);
        }
    }
    kept.push(points[points.len() - 1]);
    kept
}

fn joined(pieces: &[Piece]) -> Vec<Point> {
    pieces.iter().flat_map(|piece| piece.points.iter().copied()).collect()
}

fn assembled(ways: &Ways<'_>, lanes: &[Lane], order: &Tour) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (k, entry) in order.iter().enumerate() {
        if let Some(lane) = lanes.get(entry / 2) {
            let mut points = lane.points.clone();
            if entry % 2 == 1 {
                points.reverse();
            }
            pieces.push(Piece { points, is_lane: true });
        }
        let way = ways.path(entry ^ 1, order[(k + 1) % order.len()]);
        pieces.push(Piece { points: way, is_lane: false });
    }
    pieces
}

/// Sum of the changes of heading along a path, in whole turns.
pub fn rotation_turns(path: &[Point]) -> f64 {
    let headings: Vec<Vector> = path.windows(2).filter_map(|w| (w[1] - w[0]).try_normalize(1e-9)).collect();
    headings.windows(2).map(|w| crate::tour::angle_rad(w[0], w[1])).sum::<f64>() / TAU
}

/// Length over area by swath.
pub fn length_ratio(path: &[Point], grid: &FloorGrid, swath_m: f64) -> f64 {
    polyline::length_m(path) / (grid.area_m2() / swath_m)
}
