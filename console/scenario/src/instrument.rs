//! Reads the instrument that tests the floor: `[instrument]`.

use super::{problem::Complaint, section::Section};
use mission::{InstrumentConfig, InstrumentKind};
use world::{DeadBands, PlateLayout};

/// Reads `[instrument]`. `cell_m` is the edge of a cell of the coverage grid.
pub(crate) fn instrument(
    root: &Section<'_>,
    plates: Option<&PlateLayout>,
    cell_m: Option<f64>,
) -> Option<InstrumentConfig> {
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
    let (kind, band_m, square_m) = (kind?, band_m?, square_m?);
    if band_m <= 0.0 && square_m <= 0.0 {
        return Some(InstrumentConfig { kind, dead_bands: None });
    }
    if !root.has("plates") {
        root.require(
            "plates",
            "add [plates], whose seams are the welds, or leave out dead_band_m and dead_square_m",
        );
    }
    let plates = plates?.clone();
    Some(InstrumentConfig { kind, dead_bands: Some(DeadBands { plates, band_m, square_m }) })
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
