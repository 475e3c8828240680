//! Reads the instrument that tests the floor: `[instrument]`.

use super::{problem::Complaint, section::Section};
use mission::{InstrumentConfig, InstrumentKind, Sampling};
use sim::ChannelFault;
use world::{DeadBands, PlateLayout};

/// Reads `[instrument]`, if there is one, and when channels of the simulated one are dead. `cell_m` is the edge of a cell
/// of the coverage grid.
pub(crate) fn instrument(
    root: &Section<'_>,
    plates: Option<&PlateLayout>,
    cell_m: Option<f64>,
) -> Option<(InstrumentConfig, Vec<ChannelFault>)> {
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
    let dead = channel_faults(&section, sampling.map(|sampling| sampling.channels));
    let (kind, band_m, square_m) = (kind?, band_m?, square_m?);
    if band_m <= 0.0 && square_m <= 0.0 {
        return Some((InstrumentConfig { kind, dead_bands: None, sampling }, dead));
    }
    if !root.has("plates") {
        root.require(
            "plates",
            "add [plates], whose seams are the welds, or leave out dead_band_m and dead_square_m",
        );
    }
    let plates = plates?.clone();
    let dead_bands = Some(DeadBands { plates, band_m, square_m });
    Some((InstrumentConfig { kind, dead_bands, sampling }, dead))
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

/// Reads the times at which channels of the simulated instrument are dead.
fn channel_faults(section: &Section<'_>, channels: Option<u16>) -> Vec<ChannelFault> {
    if !section.has("dead") {
        return Vec::new();
    }
    section.require(
        "channels",
        "add channels = ..., the number of channels across the swath, or leave out dead",
    );
    section.tables("dead").iter().filter_map(|entry| channel_fault(entry, channels)).collect()
}

fn channel_fault(entry: &Section<'_>, channels: Option<u16>) -> Option<ChannelFault> {
    let (channel, from_s, to_s) = (entry.whole("channel"), entry.number("from_s"), entry.number("to_s"));
    if let (Some(channel), Some(channels)) = (channel, channels)
        && channel >= i64::from(channels)
    {
        let wanted = format!(
            "0 to {}: [instrument] has {channels} channels, and channel 0 is on the right",
            channels - 1
        );
        entry.complain("channel", Complaint::OutOfRange(wanted));
    }
    if from_s? >= to_s? {
        entry.complain("to_s", Complaint::OutOfRange(format!("greater than from_s, {} s", from_s?)));
    }
    Some(ChannelFault { channel: channel? as u16, from_s: from_s?, to_s: to_s? })
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
