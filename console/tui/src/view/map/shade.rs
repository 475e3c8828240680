//! The floor layer at the bottom of the map: scanned and unscanned floor, each with its own character and colour.

use super::shapes::Window;
use super::survey;
use crate::model::{Live, Raster, Run, Together, replay::Scans, survey::Survey, ui::MapLayer};
use crate::theme::Role;
use crate::view::{look::Look, text};
use account::InDoubt;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;
use std::{borrow::Cow, rc::Rc};
use world::{CellRun, FloorClass, Point};

/// The shade of a piece of floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shade {
    /// The shade of a floor class; never [`FloorClass::ToDo`].
    Floor(FloorClass),
    /// Scanned floor that lost its guarantee because a station was wrong.
    InDoubt,
    /// Floor to which the rest of the plan led when the mission ended.
    NotReached,
    /// Floor that the mission did not have to scan, and did not scan.
    NotRequested,
    /// Scanned by a run before this re-scan, and not by the re-scan.
    Before,
    /// Forecast: the error of a fix exceeds the limit here, or no fix is possible.
    PoorFix,
    /// Forecast: the error of a fix exceeds half the limit here.
    WeakFix,
    /// Forecast: the protection level of a fix exceeds the limit here, or a fix is not protected.
    NotProtected,
    /// Forecast: the protection level of a fix exceeds half the limit here.
    HighLevel,
    /// Scanned only by the run being replayed.
    OnlyA,
    /// Scanned only by the run with which it is compared.
    OnlyB,
    /// Scanned by both runs.
    Both,
    /// In a survey: floor that no scan has shown.
    NotSeen,
    /// In a survey: an object that is not a column.
    Object,
}

impl Shade {
    /// The shade of a class; `None` for floor still to be scanned, and where there is no floor.
    fn of(class: FloorClass) -> Option<Self> {
        (!matches!(class, FloorClass::Outside | FloorClass::ToDo)).then_some(Self::Floor(class))
    }

    /// The character and the role.
    fn look(self) -> (char, Role) {
        match self {
            Self::Floor(FloorClass::Outside | FloorClass::ToDo) => (' ', Role::Dim),
            Self::Floor(FloorClass::Scanned) => ('▒', Role::Scanned),
            Self::Floor(FloorClass::Again) => ('▚', Role::Overlap),
            Self::Floor(FloorClass::Partial) | Self::Both => ('░', Role::Partly),
            Self::Floor(FloorClass::Missed) => ('▓', Role::Missed),
            Self::Floor(FloorClass::Unreachable) => ('/', Role::Unreachable),
            Self::Floor(FloorClass::Margin) => ('-', Role::Margin),
            Self::Floor(FloorClass::Untestable) => ('[', Role::Untestable),
            Self::InDoubt => ('d', Role::Warn),
            Self::NotReached => ('◦', Role::Dim),
            Self::NotRequested => ('⋅', Role::Dim),
            Self::Before => ('+', Role::Dim),
            Self::PoorFix => ('$', Role::Crit),
            Self::WeakFix => ('_', Role::Warn),
            Self::NotProtected => ('?', Role::Crit),
            Self::HighLevel => ('(', Role::Warn),
            Self::OnlyA => ('A', Role::Good),
            Self::OnlyB => ('B', Role::Ghost),
            Self::NotSeen => ('\\', Role::Unreachable),
            Self::Object => ('#', Role::Found),
        }
    }

    /// The character.
    pub(super) fn glyph(self) -> char {
        self.look().0
    }

    /// The role.
    pub(super) fn role(self) -> Role {
        self.look().1
    }

    /// Whether this run has left the floor unscanned although it could have been scanned.
    fn is_unscanned(self) -> bool {
        matches!(self, Self::NotReached | Self::NotRequested | Self::Floor(FloorClass::Missed))
    }

    /// Whether the floor was scanned.
    fn is_scanned(self) -> bool {
        use FloorClass::{Again, Partial, Scanned};
        matches!(self, Self::InDoubt | Self::Floor(Scanned | Again | Partial))
    }

    /// Whether a character is drawn instead of a filled half of a cell.
    fn is_drawn(self) -> bool {
        matches!(self, Self::NotReached | Self::NotRequested | Self::Before)
    }

    /// The role for the background on which lines are drawn.
    fn ground(self) -> Option<Role> {
        matches!(self, Self::Floor(FloorClass::Scanned | FloorClass::Again)).then_some(Role::Ground)
    }
}

/// The floor of a run, and why parts of it were left unscanned.
struct Ground<'a> {
    raster: &'a Raster,
    has_missed: bool,
    in_doubt: Vec<bool>,
    not_reached: Vec<bool>,
    not_requested: Vec<bool>,
}

impl<'a> Ground<'a> {
    /// The floor of a run or, for a re-scan, the floor of all runs together.
    fn new(raster: &'a Raster, run: &Run, together: Option<&Together>) -> Self {
        // Only floor that was missed is divided by reason.
        let has_missed = run.has_missed();
        let not_requested = || together.map_or_else(|| run.not_requested(), Together::not_requested);
        let if_missed = |cells: &dyn Fn() -> Vec<bool>| if has_missed { cells() } else { Vec::new() };
        Self {
            raster,
            has_missed,
            in_doubt: Vec::new(),
            not_reached: if_missed(&|| run.not_reached()),
            not_requested: if_missed(&not_requested),
        }
    }

    /// The floor of the open run with the part of it that is in doubt.
    fn open(raster: &'a Raster, live: &Live) -> Self {
        let in_doubt = live.doubtful(raster.floor().len());
        Self { in_doubt, ..Self::new(raster, &live.run, live.together()) }
    }

    /// The shade of the floor in a square around a point. Floor that was missed is divided: the mission did not have to
    /// scan it, or the rest of the plan led there.
    fn shade(&self, at: Point, edge_m: f64) -> Option<Shade> {
        let shade = Shade::of(self.raster.class_in(at, edge_m, self.has_missed)?)?;
        let cell = self.raster.floor().cell_at(at);
        let is_in = |cells: &[bool]| cell.and_then(|cell| cells.get(cell)).is_some_and(|is| *is);
        Some(match shade {
            Shade::Floor(FloorClass::Missed) if is_in(&self.not_requested) => Shade::NotRequested,
            Shade::Floor(FloorClass::Missed) if is_in(&self.not_reached) => Shade::NotReached,
            Shade::Floor(FloorClass::Scanned | FloorClass::Again | FloorClass::Partial)
                if is_in(&self.in_doubt) =>
            {
                Shade::InDoubt
            }
            shade => shade,
        })
    }
}

/// More about the floor at a place, in words: why the open run left it unscanned, or that its scan is in doubt; `None` if
/// its class says all.
pub(super) fn why_left(look: &Look, at: Point) -> Option<&'static str> {
    match Ground::open(look.model.live.scanned()?, &look.model.live).shade(at, 0.0)? {
        Shade::InDoubt => Some("scanned, in doubt"),
        Shade::NotRequested => Some("not requested"),
        Shade::NotReached => Some("not reached: mission ended"),
        _ => None,
    }
}

/// The shades in a window, and which of them occur.
#[derive(Debug)]
pub(crate) struct Painted {
    /// Row by row from the north-west.
    dots: Vec<Option<Shade>>,
    /// For each line of [`LEGEND`], whether its shade occurs.
    occurs: [bool; LEGEND.len()],
}

/// The shades in a window, shared with the cache.
pub(crate) type Shades = Rc<Painted>;

impl FromIterator<Option<Shade>> for Painted {
    fn from_iter<T: IntoIterator<Item = Option<Shade>>>(dots: T) -> Self {
        let (mut occurs, mut last) = ([false; LEGEND.len()], None);
        let note = |shade: Option<Shade>| {
            // Neighbours mostly have the same shade.
            if shade != last {
                let line = LEGEND.iter().position(|(known, _)| Some(*known) == shade);
                if let Some(line) = line {
                    occurs[line] = true;
                }
                last = shade;
            }
            shade
        };
        let dots = dots.into_iter().map(note).collect();
        Self { dots, occurs }
    }
}

/// The inputs from which the shades are computed; the stamps are those of the raster, of the raster with which it is
/// compared, and of the forecast that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Key {
    raster: Option<u64>,
    other: Option<u64>,
    before: Option<u64>,
    forecast: Option<(MapLayer, u64)>,
    survey: Option<u64>,
    window: Window,
    /// Shade rows per character row.
    rows_per_row: u16,
    /// The last tick and the length of the plan in points, once the run has missed floor: they tell runs apart that
    /// scanned the same cells.
    ended: Option<(u64, usize)>,
    /// The number of times that floor lost its guarantee, and of the cells that are in doubt.
    doubt: (usize, u32),
}

impl Key {
    fn ended(run: &Run) -> Option<(u64, usize)> {
        let plan = run.planning.plan.as_ref();
        run.has_missed().then(|| (run.clock.tick, plan.map_or(0, |plan| plan.path.len())))
    }

    fn doubt(in_doubt: &[InDoubt]) -> (usize, u32) {
        let cells = in_doubt.iter().flat_map(|doubt| &doubt.cells).map(|CellRun(_, count)| count);
        (in_doubt.len(), cells.sum())
    }
}

/// The shades in the order of the legend, the most important first, each with its legend text.
pub(super) const LEGEND: [(Shade, &str); 20] = [
    (Shade::Floor(FloorClass::Missed), "missed"),
    (Shade::InDoubt, "in doubt"),
    (Shade::NotReached, "not reached"),
    (Shade::NotRequested, "not requested"),
    (Shade::PoorFix, "poor fix"),
    (Shade::WeakFix, "weak fix"),
    (Shade::NotProtected, "not protected"),
    (Shade::HighLevel, "high level"),
    (Shade::Floor(FloorClass::Scanned), "scanned"),
    (Shade::Before, "scanned before"),
    (Shade::Floor(FloorClass::Again), "overlap"),
    (Shade::Floor(FloorClass::Partial), "partial"),
    (Shade::Floor(FloorClass::Unreachable), "unreachable"),
    (Shade::Floor(FloorClass::Margin), "margin"),
    (Shade::Floor(FloorClass::Untestable), "not testable"),
    (Shade::OnlyA, "only A"),
    (Shade::OnlyB, "only B"),
    (Shade::Both, "both"),
    (Shade::NotSeen, "not seen"),
    (Shade::Object, "object"),
];

/// The shades that are on the map now, with their legend texts.
pub(super) fn shown(look: &Look, window: Window) -> impl Iterator<Item = (Shade, &'static str)> {
    occurring(shades(look, window, rows_per_row(look)))
}

/// The shades that occur, with their legend texts.
pub(super) fn occurring(shades: Shades) -> impl Iterator<Item = (Shade, &'static str)> {
    LEGEND.into_iter().enumerate().filter(move |(line, _)| shades.occurs[*line]).map(|(_, entry)| entry)
}

/// The number of shades in the height of a character: halves need colours.
fn rows_per_row(look: &Look) -> u16 {
    if look.is_plain() { 1 } else { 2 }
}

/// Paints the floor where nothing else is drawn, and the background under lines.
pub(super) fn paint(look: &Look, window: Window, area: Rect, buffer: &mut Buffer) {
    lay(look, &shades(look, window, rows_per_row(look)), area, buffer);
}

/// Paints shades where nothing else is drawn, and the background under lines.
pub(in crate::view) fn lay(look: &Look, shades: &Painted, area: Rect, buffer: &mut Buffer) {
    let halves = !look.is_plain();
    let columns = usize::from(area.width);
    for (row, y) in (area.top()..area.bottom()).enumerate() {
        for (column, x) in (area.left()..area.right()).enumerate() {
            let at = |half: usize| {
                let row = if halves { 2 * row + half } else { row };
                shades.dots.get(row * columns + column).copied().flatten()
            };
            paint_cell(look, at(0), at(1), &mut buffer[(x, y)]);
        }
    }
}

/// Paints one character; if its two halves differ, each gets its own colour.
fn paint_cell(look: &Look, upper: Option<Shade>, lower: Option<Shade>, cell: &mut ratatui::buffer::Cell) {
    let color = |shade: Shade| look.theme.color(shade.role());
    let filled = |shade: Option<Shade>| shade.filter(|shade| !shade.is_drawn());
    if cell.symbol() == " " {
        match (filled(upper), filled(lower)) {
            (Some(one), Some(other)) if one != other && !look.is_plain() => {
                cell.set_char('▀').set_fg(color(one)).set_bg(color(other));
                return;
            }
            (Some(one), None) if !look.is_plain() => {
                cell.set_char('▀').set_fg(color(one));
                return;
            }
            (None, Some(other)) => {
                cell.set_char('▄').set_fg(color(other));
                return;
            }
            (one, _) => {
                if let Some(one) = one.or(upper).or(lower) {
                    cell.set_char(one.glyph()).set_fg(color(one));
                }
            }
        }
    }
    // A background fills the whole character, so that it would spill over the wall if one half were beyond it.
    let ground = upper.filter(|_| lower.is_some()).and_then(Shade::ground).filter(|_| !look.is_plain());
    // Labels are bold; they stand on the terminal's background, so that every colour can be read.
    if let Some(ground) = ground.filter(|_| !cell.modifier.contains(Modifier::BOLD)) {
        cell.set_bg(look.theme.color(ground));
    }
}

/// The shades of the forecast if it is shown; otherwise the shades of the floor. They rarely change, so they are cached
/// between frames.
fn shades(look: &Look, window: Window, rows_per_row: u16) -> Shades {
    let (run, layers) = (look.run, look.model.ui.layers);
    let survey = survey::shown(look);
    // A survey scans no floor for its instrument.
    let is_scanning = !run.is_survey() && layers.shows(MapLayer::Scanned);
    let raster = look.model.live.scanned().filter(|_| is_scanning || survey.is_some());
    let forecasts = [MapLayer::Accuracy, MapLayer::Protection];
    let shown = forecasts.into_iter().find(|layer| layers.shows(*layer));
    // The combined map shows what all runs have scanned.
    let before = look.model.live.scanned_before.as_ref().filter(|_| look.model.live.together().is_none());
    let before = before.map(|before| &before.raster);
    let other = compared(look).filter(|_| shown.is_none());
    let key = Key {
        raster: raster.map(Raster::stamp),
        other: other.map(Raster::stamp),
        before: before.map(Raster::stamp),
        forecast: shown.map(|layer| (layer, run.accuracy_stamp)),
        survey: survey.map(Survey::stamp),
        window,
        rows_per_row,
        ended: Key::ended(run),
        doubt: Key::doubt(&look.model.live.in_doubt),
    };
    look.cache.borrow_mut().shades(key, || {
        let dots = window.dots(rows_per_row);
        let ground = raster.map(|raster| Ground::open(raster, &look.model.live));
        let floor = |ground: &Ground<'_>, at, edge_m| match survey {
            Some(survey) => survey::shade(survey, at, edge_m).filter(|_| is_floor(ground.raster, at, edge_m)),
            None => ground.shade(at, edge_m),
        };
        if let Some(layer) = shown {
            let own = |at, edge_m| ground.as_ref().and_then(|ground| floor(ground, at, edge_m));
            let shade = |(at, edge_m)| {
                let own = own(at, edge_m);
                let is_kept = own.is_some_and(Shade::is_scanned) && is_even(at, edge_m);
                forecast(look, layer, at).filter(|_| !is_kept).or(own)
            };
            return Rc::new(dots.map(shade).collect());
        }
        let Some(ground) = &ground else { return Rc::new(Painted::from_iter([])) };
        let raster = ground.raster;
        // Floor that this re-scan has to scan is not laid over by earlier runs.
        let not_requested = before.map_or_else(Vec::new, |_| run.not_requested());
        let is_requested = |at: Point| {
            let cell = raster.floor().cell_at(at);
            cell.is_some_and(|cell| not_requested.get(cell) == Some(&false))
        };
        let shade = |(at, edge_m)| {
            if let Some(other) = other {
                return Scans::in_square(raster, other, at, edge_m).and_then(difference);
            }
            let own = floor(ground, at, edge_m);
            let before = before.filter(|_| own.is_none_or(Shade::is_unscanned) && !is_requested(at));
            before.and_then(|before| scanned_before(before, at, edge_m)).or(own)
        };
        let is_inside = |at, edge_m| is_inside(raster, rows_per_row, (at, edge_m));
        Rc::new(dots.map(|dot| shade(dot).filter(|_| is_inside(dot.0, dot.1))).collect())
    })
}

/// The shades of the floor of a run that need not be the open one, without forecasts and comparisons; `together` is the
/// scan of all runs of a re-scan.
pub(in crate::view) fn of_run(
    look: &Look,
    (run, together): (&Run, Option<&Together>),
    window: Window,
) -> Option<Shades> {
    let raster = together.and_then(|all| all.raster.as_ref()).or(run.coverage.as_ref())?;
    let rows_per_row = rows_per_row(look);
    let key = Key {
        raster: Some(raster.stamp()),
        other: None,
        before: None,
        forecast: None,
        survey: None,
        window,
        rows_per_row,
        ended: Key::ended(run),
        doubt: Key::doubt(&[]),
    };
    let make = || {
        let ground = Ground::new(raster, run, together);
        let shade =
            |(at, edge_m)| ground.shade(at, edge_m).filter(|_| is_inside(raster, rows_per_row, (at, edge_m)));
        Rc::new(window.dots(rows_per_row).map(shade).collect())
    };
    Some(look.cache.borrow_mut().shades(key, make))
}

/// Whether a dot is shaded: half a character that is partly beyond the wall stays blank, and a whole character whose middle is
/// beyond it.
fn is_inside(raster: &Raster, rows_per_row: u16, (at, edge_m): (Point, f64)) -> bool {
    if rows_per_row > 1 {
        return is_floor(raster, at, edge_m);
    }
    let floor = raster.floor();
    floor.cell_at(at).is_some_and(|cell| floor.is_floor(cell))
}

/// The floor of the run with which the replay is compared, if the difference is shown.
fn compared<'a>(look: &Look<'a>) -> Option<&'a Raster> {
    let replay = look.model.live.replay.as_ref().filter(|replay| replay.shows_difference)?;
    replay.other.as_ref()?.run.coverage.as_ref()
}

/// Whether a square is floor up to its corners.
fn is_floor(raster: &Raster, center: Point, edge_m: f64) -> bool {
    let floor = raster.floor();
    // A little less than half of the edge, so that rounding does not reach the next square.
    let half_m = 0.45 * edge_m;
    [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].into_iter().all(|(right, up)| {
        let corner = Point::new(center.x + right * half_m, center.y + up * half_m);
        floor.cell_at(corner).is_some_and(|cell| floor.is_floor(cell))
    })
}

fn difference(scans: Scans) -> Option<Shade> {
    match scans {
        Scans::None => None,
        Scans::OnlyA => Some(Shade::OnlyA),
        Scans::OnlyB => Some(Shade::OnlyB),
        Scans::Both => Some(Shade::Both),
    }
}

/// The shade of floor that a run before a re-scan has scanned.
fn scanned_before(before: &Raster, at: Point, edge_m: f64) -> Option<Shade> {
    let class = before.class_in(at, edge_m, false)?;
    matches!(class, FloorClass::Scanned | FloorClass::Again | FloorClass::Partial).then_some(Shade::Before)
}

/// Whether a square is one of every other one, as on a chessboard: there, a forecast leaves scanned floor to be seen.
fn is_even(at: Point, edge_m: f64) -> bool {
    let [column, row] =
        [at.x, at.y].map(|length_m| (length_m / edge_m.max(f64::MIN_POSITIVE)).floor() as i64);
    (column + row).rem_euclid(2) == 0
}

/// The word of a shade in the legend: that of a forecast with its limit.
pub(super) fn word(look: &Look, (shade, word): (Shade, &'static str)) -> Cow<'static, str> {
    let limit_m = look.run.about.as_ref().map(|about| about.mission.position_limit_m);
    let share = match shade {
        Shade::HighLevel | Shade::WeakFix => 0.5,
        Shade::PoorFix => 1.0,
        _ => return word.into(),
    };
    limit_m
        .map_or(word.into(), |limit_m| format!("{word}, above {} m", text::number(share * limit_m, 2)).into())
}

/// The shade of a forecast at a point: beyond the limit, or beyond half of the limit.
fn forecast(look: &Look, layer: MapLayer, at: Point) -> Option<Shade> {
    let limit_m = look.run.about.as_ref()?.mission.position_limit_m;
    let here = look.run.accuracy.as_ref()?.at(at)?;
    let (radius, weak, poor) = match layer {
        MapLayer::Protection => {
            (here.checks.and_then(|checks| checks.level_m), Shade::HighLevel, Shade::NotProtected)
        }
        _ => (here.error_95_m, Shade::WeakFix, Shade::PoorFix),
    };
    match radius {
        Some(radius_m) if radius_m <= limit_m / 2.0 => None,
        Some(radius_m) if radius_m <= limit_m => Some(weak),
        _ => Some(poor),
    }
}
