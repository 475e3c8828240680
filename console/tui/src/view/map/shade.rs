//! The floor below everything else on the map: what has been scanned and what not, each by a character and a colour.

use super::shapes::Window;
use crate::model::{Raster, replay::Scans, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::rc::Rc;
use world::{FloorClass, Point};

/// How some floor is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shade {
    /// By what it counts as; never [`FloorClass::ToDo`].
    Floor(FloorClass),
    /// The stations are forecast to locate beyond the limit here, or not at all.
    PoorFix,
    /// They are forecast to locate beyond half of the limit here.
    WeakFix,
    /// Of two runs only the one that is played scanned it.
    OnlyA,
    /// Only the one that it is compared with.
    OnlyB,
}

impl Shade {
    /// What is still to be scanned, and what is no floor, is not shaded.
    fn of(class: FloorClass) -> Option<Self> {
        (!matches!(class, FloorClass::Outside | FloorClass::ToDo)).then_some(Self::Floor(class))
    }

    /// The character for it, and what its colour stands for.
    fn look(self) -> (char, Role) {
        match self {
            Self::Floor(FloorClass::Outside | FloorClass::ToDo) => (' ', Role::Dim),
            Self::Floor(FloorClass::Scanned) => ('▒', Role::Scanned),
            Self::Floor(FloorClass::Again) => ('▚', Role::Overlap),
            Self::Floor(FloorClass::Partial) => ('░', Role::Partly),
            Self::Floor(FloorClass::Missed) => ('▓', Role::Missed),
            Self::Floor(FloorClass::Unreachable) => ('/', Role::Unreachable),
            Self::Floor(FloorClass::Margin) => ('-', Role::Margin),
            Self::PoorFix => ('%', Role::Crit),
            Self::WeakFix => (':', Role::Warn),
            Self::OnlyA => ('A', Role::Good),
            Self::OnlyB => ('B', Role::Ghost),
        }
    }

    /// The character for it.
    pub(super) fn glyph(self) -> char {
        self.look().0
    }

    /// What its colour stands for.
    pub(super) fn role(self) -> Role {
        self.look().1
    }

    /// The colour behind it, on which lines are drawn.
    fn ground(self) -> Option<Role> {
        matches!(self, Self::Floor(FloorClass::Scanned | FloorClass::Again)).then_some(Role::Scanned)
    }
}

/// The shades in a window, row by row from the north west.
pub(crate) type Shades = Rc<[Option<Shade>]>;

/// What the shades of the floor depend on: the stamp of the raster, the window, rows per row, whether the mission has ended,
/// and the stamp of the raster of which the difference is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Key(u64, Window, u16, bool, Option<u64>);

/// Paints the floor where nothing else is drawn, and its ground below lines.
pub(super) fn paint(look: &Look, window: Window, area: Rect, buffer: &mut Buffer) {
    let halves = !look.is_plain();
    let shades = shades(look, window, if halves { 2 } else { 1 });
    let columns = usize::from(area.width);
    for (row, y) in (area.top()..area.bottom()).enumerate() {
        for (column, x) in (area.left()..area.right()).enumerate() {
            let at = |half: usize| {
                let row = if halves { 2 * row + half } else { row };
                shades.get(row * columns + column).copied().flatten()
            };
            paint_cell(look, at(0), at(1), &mut buffer[(x, y)]);
        }
    }
}

/// One character: where its halves differ, each has its colour.
fn paint_cell(look: &Look, upper: Option<Shade>, lower: Option<Shade>, cell: &mut ratatui::buffer::Cell) {
    let color = |shade: Shade| look.theme.color(shade.role());
    if cell.symbol() == " " {
        match (upper, lower) {
            (None, None) => {}
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
            (Some(one), _) => {
                cell.set_char(one.glyph()).set_fg(color(one));
            }
        }
    }
    if let Some(ground) = upper.or(lower).and_then(Shade::ground).filter(|_| !look.is_plain()) {
        cell.set_bg(look.theme.color(ground));
    }
}

/// The forecast where it is shown, else the floor: that changes rarely and is kept from frame to frame.
fn shades(look: &Look, window: Window, rows_per_row: u16) -> Shades {
    let (run, layers) = (look.run, look.model.ui.layers);
    let raster = run.coverage.as_ref().filter(|_| layers.shows(MapLayer::Scanned));
    if layers.shows(MapLayer::Accuracy) {
        return window
            .dots(rows_per_row)
            .map(|(at, edge_m)| forecast(look, at).or_else(|| floor(raster?, at, edge_m, run.has_missed())))
            .collect();
    }
    let Some(raster) = raster else { return Rc::new([]) };
    let other = compared(look);
    let key = Key(raster.stamp(), window, rows_per_row, run.has_missed(), other.map(Raster::stamp));
    look.cache.borrow_mut().shades(key, || {
        let shade = |(at, edge_m)| match other {
            Some(other) => Scans::in_square(raster, other, at, edge_m).and_then(difference),
            None => floor(raster, at, edge_m, run.has_missed()),
        };
        window.dots(rows_per_row).map(shade).collect()
    })
}

/// The floor of the run with which the one that is played is compared, if their difference is shown.
pub(super) fn compared<'a>(look: &Look<'a>) -> Option<&'a Raster> {
    let replay = look.model.live.replay.as_ref().filter(|replay| replay.shows_difference)?;
    replay.other.as_ref()?.run.coverage.as_ref()
}

fn difference(scans: Scans) -> Option<Shade> {
    match scans {
        Scans::None => None,
        Scans::OnlyA => Some(Shade::OnlyA),
        Scans::OnlyB => Some(Shade::OnlyB),
        Scans::Both => Some(Shade::Floor(FloorClass::Partial)),
    }
}

fn floor(raster: &Raster, at: Point, edge_m: f64, has_missed: bool) -> Option<Shade> {
    raster.class_in(at, edge_m, has_missed).and_then(Shade::of)
}

/// Where the stations are forecast to locate badly: beyond the limit, and beyond half of it.
fn forecast(look: &Look, at: Point) -> Option<Shade> {
    let limit_m = look.run.about.as_ref()?.mission.position_limit_m;
    match look.run.accuracy.as_ref()?.at(at)?.error_95_m {
        Some(error_m) if error_m <= limit_m / 2.0 => None,
        Some(error_m) if error_m <= limit_m => Some(Shade::WeakFix),
        _ => Some(Shade::PoorFix),
    }
}
