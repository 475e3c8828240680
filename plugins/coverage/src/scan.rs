//! From lanes to a path: tour, touch-ups, and how good the result is.

use crate::{
    cuts::{Cut, CutRule, cuts},
    floor::FloorGrid,
    ground::Ground,
    lanes::{Lane, Pattern, Reach, lanes},
    polish::{Prices, Track},
    slit::Slit,
    touch::touch_up,
    tour::{Effort, Tour, Ways, tour},
};
use planner_api::{Ctx, Result};
use world::{Point, Vector, polyline};

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
    pub reel_m: f64,
    /// Edge of a cell of the floor, metres.
    pub cell_m: f64,
}

/// Makes a candidate; `None` where the robot has no room at all.
///
/// # Errors
/// When the console wants an end.
pub fn scan(ground: &Ground, recipe: &Recipe, order: &Order<'_>, ctx: &Ctx<'_>) -> Result<Option<Scan>> {
    let home = ground.home();
    let cuts = cuts(ground, &recipe.pattern, &recipe.rule);
    let lines: Vec<Vec<Point>> = cuts.iter().map(|cut| cut.line.clone()).collect();
    let Some(slit) = Slit::new(ground, &lines, home) else { return Ok(None) };
    let mut grid = FloorGrid::new(ground, &slit, order.cell_m);
    grid.keep_within(order.regions);
    let all = lanes(ground, &slit, &cuts, &recipe.pattern, &recipe.reach);
    let in_reach = |at: Point| {
        order.reel_m.is_infinite() || slit.way_m(home, at).is_some_and(|way_m| way_m <= order.reel_m)
    };
    let is_wanted = |at: Point| in_reach(at) && (order.regions.is_empty() || grid.has_reachable_near(at));
    let wants_all = order.reel_m.is_infinite() && order.regions.is_empty();
    let wanted = |lanes: Vec<Lane>| {
        if wants_all { lanes } else { lanes.iter().flat_map(|lane| lane.kept(&is_wanted)).collect() }
    };
    let mut lanes = wanted(all);
    let start = if slit.contains(order.start) { order.start } else { home };
    let mut pieces = toured(&slit, &lanes, (home, start), &recipe.effort, ctx)?;
    for _ in 0..recipe.rounds {
        let mut swept = grid.clone();
        swept.sweep(&joined(&pieces));
        let least = (recipe.touch_m2 / (order.cell_m * order.cell_m)) as usize;
        let missed = swept.missed();
        let large = missed.iter().take_while(|group| group.len() > least);
        let fresh: Vec<Lane> =
            wanted(large.flat_map(|group| touch_up(ground, &slit, &cuts, &swept, group)).collect());
        if fresh.is_empty() {
            break;
        }
        lanes.extend(fresh);
        pieces = toured(&slit, &lanes, (home, start), &recipe.effort, ctx)?;
    }
    let prices =
        Prices { turn_m_per_rad: recipe.effort.turn_m_per_rad, floor_m_per_m2: recipe.floor_m_per_m2 };
    let careful = Prices { floor_m_per_m2: 1e6, ..prices };
    let mut track = Track::new(&slit, &pieces, grid);
    track.shorten(&prices, ctx)?;
    for _ in 0..3 {
        if track.touch_up(ground, &cuts, &in_reach, &prices, recipe.enough, ctx)? == 0 {
            break;
        }
        track.shorten(&careful, ctx)?;
    }
    let (pieces, grid) = (pieces_of(&track.points, &track.on_lane), track.grid);
    Ok(Some(Scan { pieces, cuts, slit, grid }))
}

/// Runs of sides of one kind.
fn pieces_of(points: &[Point], on_lane: &[bool]) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = Vec::new();
    for (k, is_lane) in on_lane.iter().enumerate() {
        match pieces.last_mut() {
            Some(piece) if piece.is_lane == *is_lane => piece.points.push(points[k + 1]),
            _ => pieces.push(Piece { points: vec![points[k], points[k + 1]], is_lane: *is_lane }),
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

fn toured(
    slit: &Slit,
    lanes: &[Lane],
    (home, start): (Point, Point),
    effort: &Effort,
    ctx: &Ctx<'_>,
) -> Result<Vec<Piece>> {
    let ways = Ways::new(slit, lanes, home, start, effort.turn_m_per_rad);
    let order = tour(&ways, effort, ctx)?;
    Ok(assembled(&ways, lanes, &order))
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
    headings.windows(2).map(|w| crate::tour::angle_rad(w[0], w[1])).sum::<f64>() / std::f64::consts::TAU
}

/// Length over area by swath.
pub fn length_ratio(path: &[Point], grid: &FloorGrid, swath_m: f64) -> f64 {
    polyline::length_m(path) / (grid.area_m2() / swath_m)
}
