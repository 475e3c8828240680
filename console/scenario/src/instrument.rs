//! Reads the instrument that tests the floor: `[instrument]`.

use super::{problem::Complaint, section::Section};
use mission::{InstrumentConfig, InstrumentKind, Sampling};
use world::{DeadBands, PlateLayout};

/// Reads `[instrument]`, if there is one. `cell_m` is the edge of a cell of the coverage grid.
pub(crate) fn instrument(
    root: &Section<'_>,
    plates: Option<&PlateLayout>,
    cell_m: Option<f64>,
) -> Option<InstrumentConfig> {
    if !root.has("instrument") {
        return None;
    }
    let section = root.table("instrument")?;
    let kind = section.word("kind").map(|word| match word {
        "ut" => InstrumentKind::Ut,
        _ => InstrumentKind::Mfl,
    });
    let (band_m, square_m) = (section.number("dead_band_m"), section.number("dead_square_m"));
    if let (Some(band_m), Some(square_m), Some(cell_m)) = (band_m, square_m, cell_m) {
        check_cells(&section, ("dead_band_m", band_m), cell_m / 2.0, "half of");
        check_cells(&section, ("dead_square_m", square_m), cell_m, "equal to");
    }
    let sampling = if section.has("channels") { Some(sampling(&section)?) } else { None };
    let (kind, band_m, square_m) = (kind?, band_m?, square_m?);
    if band_m <= 0.0 && square_m <= 0.0 {
        return Some(InstrumentConfig { kind, dead_bands: None, sampling });
    }
    if !root.has("plates") {
        root.require(
            "plates",
            "add [plates], whose seams are the welds, or leave out dead_band_m and dead_square_m",
        );
    }
    let plates = plates?.clone();
    Some(InstrumentConfig { kind, dead_bands: Some(DeadBands { plates, band_m, square_m }), sampling })
}

/// Reads how the instrument reads thickness.
fn sampling(section: &Section<'_>) -> Option<Sampling> {
    let (channels, pitch_m) = (section.whole("channels"), section.number("pitch_m"));
    let (sigma_mm, threshold) = (section.number("sigma_mm"), section.number("threshold"));
    if !section.has("thickness_mm") {
        section.require(
            "thickness_mm",
            "add thickness_mm = ..., in mm, the nominal thickness of the floor, from which loss is measured",
        );
    }
    Some(Sampling {
        channels: channels? as u16,
        pitch_m: pitch_m?,
        thickness_mm: section.number("thickness_mm")?,
        sigma_mm: sigma_mm?,
        threshold: threshold?,
    })
}

/// Complains about a width that is above zero but too small to show in cells.
fn check_cells(section: &Section<'_>, (key, width_m): (&str, f64), least_m: f64, part: &str) {
    if width_m > 0.0 && width_m < least_m {
        let wanted = format!(
            "0, or at least {least_m} m, {part} [mission] cell_m: a smaller cell_m allows a smaller value"
        );
        section.complain(key, Complaint::OutOfRange(wanted));
    }
}
