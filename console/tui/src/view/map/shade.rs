//! The floor below everything else on the map: what has been scanned and what not, each by a character and a colour.

use super::shapes::Window;
use crate::model::{FloorClass, Raster, replay::Scans, ui::MapLayer};
use crate::theme::Role;
use crate::view::look::Look;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::rc::Rc;
use world::Point;

/// How some floor is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shade {
    Scanned,
    Overlap,
    Partial,
    Missed,
    Unreachable,
    Margin,
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
    fn of(class: FloorClass) -> Option<Self> {
        match class {
            FloorClass::ToDo => None,
            FloorClass::Missed => Some(Self::Missed),
            FloorClass::Scanned => Some(Self::Scanned),
            FloorClass::Overlap => Some(Self::Overlap),
            FloorClass::Partial => Some(Self::Partial),
            FloorClass::Margin => Some(Self::Margin),
            FloorClass::Unreachable => Some(Self::Unreachable),
        }
    }

    /// The character for it.
    pub(super) fn glyph(self) -> char {
        match self {
            Self::Scanned => '▒',
            Self::Overlap => '▚',
            Self::Partial => '░',
            Self::Missed => '▓',
            Self::Unreachable => '/',
            Self::Margin => '-',
            Self::PoorFix => '%',
            Self::WeakFix => ':',
            Self::OnlyA => 'A',
            Self::OnlyB => 'B',
        }
    }

    /// What its colour stands for.
    pub(super) fn role(self) -> Role {
        match self {
            Self::Scanned => Role::Scanned,
            Self::Overlap => Role::Overlap,
            Self::Partial => Role::Partly,
            Self::Missed => Role::Missed,
            Self::Unreachable => Role::Unreachable,
            Self::Margin => Role::Margin,
            Self::PoorFix => Role::Crit,
            Self::WeakFix => Role::Warn,
            Self::OnlyA => Role::Good,
            Self::OnlyB => Role::Ghost,
        }
    }

    /// The colour behind it, on which lines are drawn.
    fn ground(self) -> Option<Role> {
        matches!(self, Self::Scanned | Self::Overlap).then_some(Role::Scanned)
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
        Scans::Both => Some(Shade::Partial),
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
