//! The scanned floor as an image.

use super::{
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use mission::event::RunOpened;
use world::{Cell, CellRun, FloorClass, KindRun};

/// Mission time between two images of a small floor, seconds.
const PERIOD_S: f64 = 5.0;
/// Number of cells of the floor for which the interval between images grows by one tick.
const CELLS_PER_TICK: usize = 500;

/// Value of a cell of each class; class 0 is not drawn.
fn id(class: FloorClass) -> u8 {
    match class {
        FloorClass::Outside => 0,
        FloorClass::Unreachable | FloorClass::Margin => 1,
        FloorClass::Scanned | FloorClass::Again | FloorClass::Partial => 2,
        FloorClass::ToDo => 3,
        FloorClass::Missed => 4,
        FloorClass::Untestable => 5,
    }
}

/// Value of a cell that was not scanned.
fn unscanned(kind: Cell) -> u8 {
    id(FloorClass::of(kind, 0))
}

/// The scanned floor, and the time of its last image.
pub(crate) struct Raster {
    classes: Vec<u8>,
    width: usize,
    height: usize,
    period_ticks: i64,
    pictured: Option<i64>,
    changed: bool,
}

impl Raster {
    /// The floor of a run, and the style of its cells.
    pub(crate) fn open(stream: &Stream, run: &RunOpened) -> Result<Self, RecordingError> {
        let floor = &run.floor;
        let place = rr::Transform3D::from_translation_scale(
            [floor.origin.x as f32, floor.origin.y as f32, 0.0],
            [floor.cell_m as f32, floor.cell_m as f32, 1.0],
        );
        stream.always(paths::COVERAGE, &place)?;
        let class = |class: FloorClass, label: &str, [red, green, blue, alpha]: [u8; 4]| rr::AnnotationInfo {
            id: u16::from(id(class)),
            label: Some(label.into()),
            color: Some(rr::Rgba32::from_unmultiplied_rgba(red, green, blue, alpha)),
        };
        let mut classes = vec![
            class(FloorClass::Outside, "no floor", [0, 0, 0, 0]),
            class(FloorClass::Unreachable, "unreachable", style::OUT_OF_REACH),
            class(FloorClass::Scanned, "scanned", style::SCANNED),
            class(FloorClass::ToDo, "to do", style::TO_DO),
            class(FloorClass::Missed, "missed", style::MISSED),
        ];
        let mut cells: Vec<u8> = (0..floor.len()).map(|index| unscanned(floor.kind(index))).collect();
        if cells.contains(&id(FloorClass::Untestable)) {
            classes.push(class(FloorClass::Untestable, "not testable by this tool", style::UNTESTABLE));
        }
        stream.always(paths::COVERAGE, &rr::AnnotationContext::new(classes))?;
        // A journal that was edited by hand may claim more cells than it lists.
        cells.resize(floor.width * floor.height, id(FloorClass::Outside));
        let small_floor = (PERIOD_S / run.mission.tick_s).round().max(1.0) as i64;
        Ok(Self {
            classes: cells,
            width: floor.width,
            height: floor.height,
            period_ticks: small_floor.max((floor.width * floor.height / CELLS_PER_TICK) as i64),
            pictured: None,
            changed: true,
        })
    }

    /// Adds newly scanned cells.
    pub(crate) fn mark(&mut self, runs: &[CellRun]) {
        for run in runs {
            let (first, count) = (run.0 as usize, run.1 as usize);
            let last = (first + count).min(self.classes.len());
            if let Some(cells) = self.classes.get_mut(first..last) {
                cells.fill(id(FloorClass::Scanned));
                self.changed = true;
            }
        }
    }

    /// Adds cells whose class changed.
    pub(crate) fn change(&mut self, changes: &[KindRun]) {
        for KindRun(kind, first, count) in changes {
            let first = (*first as usize).min(self.classes.len());
            let end = first.saturating_add(*count as usize).min(self.classes.len());
            for class in &mut self.classes[first..end] {
                if *class != id(FloorClass::Scanned) || *kind == Cell::Outside {
                    *class = unscanned(*kind);
                }
            }
            self.changed = true;
        }
    }

    /// The mission has ended: floor still to do is now missed.
    pub(crate) fn end(&mut self) {
        for class in self.classes.iter_mut().filter(|class| **class == id(FloorClass::ToDo)) {
            *class = id(FloorClass::Missed);
            self.changed = true;
        }
    }

    /// Writes an image if the floor has changed and the last image is old enough.
    pub(crate) fn picture_if_due(&mut self, stream: &Stream, at: At) -> Result<(), RecordingError> {
        let due = self.pictured.is_none_or(|tick| at.tick - tick >= self.period_ticks);
        if due { self.picture(stream, at) } else { Ok(()) }
    }

    /// Writes an image if the floor has changed.
    pub(crate) fn picture(&mut self, stream: &Stream, at: At) -> Result<(), RecordingError> {
        if !self.changed || self.classes.is_empty() {
            return Ok(());
        }
        self.changed = false;
        self.pictured = Some(at.tick);
        let size = [self.width as u32, self.height as u32];
        let format = rr::ImageFormat::segmentation(size, rr::ChannelDatatype::U8);
        let image = rr::SegmentationImage::new(self.classes.clone(), format);
        stream.once(paths::COVERAGE, at, &image.with_opacity(1.0).with_draw_order(-10.0))
    }
}
