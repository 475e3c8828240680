//! The loss of metal as an image over the scanned floor.

use super::{
    paths,
    stream::{At, Stream},
    style,
};
use crate::{error::RecordingError, rr};
use account::{LOSS_CLASSES, Survey};
use mission::{Sampling, event::RunOpened};

/// Prepares the image: its place, and the colour and range in millimetres of every class. The lowest class and floor
/// that was not tested are not drawn.
pub(crate) fn open(stream: &Stream, run: &RunOpened, sampling: Sampling) -> Result<(), RecordingError> {
    let floor = &run.floor;
    let place = rr::Transform3D::from_translation_scale(
        [floor.origin.x as f32, floor.origin.y as f32, 0.0],
        [floor.cell_m as f32, floor.cell_m as f32, 1.0],
    );
    stream.always(paths::CORROSION, &place)?;
    let mm = |share: f64| format!("{:.1}", share * sampling.thickness_mm);
    let class = |(class, [red, green, blue, alpha]): (usize, [u8; 4])| {
        let from = class.checked_sub(1).map(|below| LOSS_CLASSES[below]);
        let label = match (from, LOSS_CLASSES.get(class)) {
            (None, Some(to)) => format!("not tested, or up to {} mm lost", mm(*to)),
            (Some(from), Some(to)) => format!("{} to {} mm lost", mm(from), mm(*to)),
            (from, None) => format!("more than {} mm lost", mm(from.unwrap_or_default())),
        };
        rr::AnnotationInfo {
            id: class as u16,
            label: Some(label.into()),
            color: Some(rr::Rgba32::from_unmultiplied_rgba(red, green, blue, alpha)),
        }
    };
    let classes: Vec<_> = style::LOSS.into_iter().enumerate().map(class).collect();
    stream.always(paths::CORROSION, &rr::AnnotationContext::new(classes))
}

/// Writes the image.
pub(crate) fn picture(
    survey: &Survey,
    (width, height): (usize, usize),
    stream: &Stream,
    at: At,
) -> Result<(), RecordingError> {
    let cells: Vec<u8> =
        (0..width * height).map(|cell| survey.judge().loss_class(cell).unwrap_or_default()).collect();
    let format = rr::ImageFormat::segmentation([width as u32, height as u32], rr::ChannelDatatype::U8);
    let image = rr::SegmentationImage::new(cells, format);
    stream.once(paths::CORROSION, at, &image.with_opacity(1.0).with_draw_order(-9.0))
}
