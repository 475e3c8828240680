//! The YAML file of a map.

use super::image::Pixel;
use crate::error::ImportError;
use serde::Deserialize;
use serde_saphyr::Spanned;
use std::{f64::consts::TAU, path::Path};

/// The grey that map savers write for unseen cells.
const UNSEEN: u8 = 205;

/// The keys of the file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    image: Spanned<String>,
    resolution: Spanned<f64>,
    origin: Option<Spanned<Vec<f64>>>,
    negate: Option<Negate>,
    occupied_thresh: Option<Spanned<f64>>,
    free_thresh: Option<Spanned<f64>>,
    mode: Option<Spanned<String>>,
    /// Converters of ROS 1 maps write `occupancy`, which adds nothing to what the other keys state.
    map_type: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "must be 0, 1, false or true")]
enum Negate {
    Flag(bool),
    Number(i64),
}

/// How the brightness of a pixel is converted to an occupancy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    /// Free, occupied or unknown.
    Trinary,
    /// Like trinary, but with a share for values between the thresholds.
    Scale,
    /// The value is a percentage; above 100 means unknown.
    Raw,
}

impl Mode {
    /// The mode with this name; case-insensitive, as in the map server.
    fn named(name: &str) -> Option<Self> {
        match name.to_lowercase().as_str() {
            "trinary" => Some(Self::Trinary),
            "scale" => Some(Self::Scale),
            "raw" => Some(Self::Raw),
            _ => None,
        }
    }
}

/// The checked settings of the file.
pub(super) struct Settings {
    pub image: String,
    /// The line that names the image, from 1.
    pub image_line: usize,
    pub resolution_m: f64,
    /// The position of the lower left corner in metres, and the rotation about it in radians.
    pub origin: [f64; 3],
    mode: Mode,
    negate: bool,
    occupied: f64,
    /// The occupancy up to which a cell is free.
    pub free: f64,
}

impl Settings {
    pub(super) fn parse(file: &Path, text: &str) -> Result<Self, ImportError> {
        let written: Written = serde_saphyr::from_str(text).map_err(|error| {
            let line = error.location().map(|at| at.line() as usize);
            let whole = error.without_snippet().to_string();
            // The messages of tankops state the position first, so the position is removed from the end of this
            // message.
            let what = whole.rsplit_once(" at line").map_or(whole.as_str(), |(what, _)| what).to_owned();
            match error.without_snippet() {
                serde_saphyr::Error::DuplicateMappingKey { key, .. } => {
                    wrong(file, text, line, twice(text, key.as_deref(), line))
                }
                _ if what.starts_with("missing field") => {
                    let what = format!(
                        "{what}; a map needs at least image and resolution, for example image: map.pgm"
                    );
                    ImportError::of_file(file, what)
                }
                _ => {
                    let error = wrong(file, text, line, what);
                    let says_it = error.what.contains("expected one of") || error.what.starts_with("must be");
                    let right = error.key.as_deref().filter(|_| !says_it).and_then(right_value);
                    let what =
                        right.map_or_else(|| error.what.clone(), |right| format!("{}; {right}", error.what));
                    ImportError { what, ..error }
                }
            }
        })?;
        let at = |line: u64, what: String| wrong(file, text, Some(line as usize), what);
        let image = &written.image;
        if image.value.is_empty() {
            return Err(at(
                image.referenced.line(),
                "no file name; write the name of the image, for example map.pgm".into(),
            ));
        }
        let cell = &written.resolution;
        if !(1e-3..=10.0).contains(&cell.value) {
            let what = format!("{} m per cell; must be 0.001 to 10", cell.value);
            return Err(at(cell.referenced.line(), what));
        }
        let mode = match &written.mode {
            None => Mode::Trinary,
            Some(mode) => Mode::named(&mode.value).ok_or_else(|| {
                let what = format!("`{}` is not a mode; it must be trinary, scale or raw", mode.value);
                at(mode.referenced.line(), what)
            })?,
        };
        let share = |share: Option<&Spanned<f64>>, default: f64| match share {
            None => Ok(default),
            Some(share) if (0.0..=1.0).contains(&share.value) => Ok(share.value),
            Some(share) => {
                Err(at(share.referenced.line(), format!("{} is not between 0 and 1", share.value)))
            }
        };
        let occupied = share(written.occupied_thresh.as_ref(), 0.65)?;
        let free = share(written.free_thresh.as_ref(), 0.196)?;
        // The map server allows equal thresholds, which leave nothing between them; but the mode `scale` divides by
        // their difference.
        if free > occupied || (free >= occupied && mode == Mode::Scale) {
            let line = written.free_thresh.as_ref().or(written.occupied_thresh.as_ref());
            let line = line.map_or(1, |share| share.referenced.line());
            return Err(at(line, format!("free_thresh {free} must be less than occupied_thresh {occupied}")));
        }
        if let Some(kind) = written.map_type.as_ref().filter(|kind| kind.value != "occupancy") {
            let what = format!(
                "`{}` maps are not supported; use an occupancy map, or leave out this key",
                kind.value
            );
            return Err(at(kind.referenced.line(), what));
        }
        let origin = match &written.origin {
            None => [0.0; 3],
            Some(origin) => place(&origin.value).map_err(|what| at(origin.referenced.line(), what))?,
        };
        Ok(Self {
            image: image.value.clone(),
            image_line: image.referenced.line() as usize,
            resolution_m: cell.value,
            origin,
            mode,
            negate: matches!(written.negate, Some(Negate::Flag(true) | Negate::Number(1..))),
            occupied,
            free,
        })
    }

    /// Whether a pixel is known to be free.
    pub(super) fn is_free(&self, pixel: Pixel) -> bool {
        !self.is_unseen(pixel) && self.is_bright(pixel)
    }

    /// Whether a pixel has the grey of unseen cells although the thresholds would make it floor.
    pub(super) fn is_unseen_but_bright(&self, pixel: Pixel) -> bool {
        self.is_unseen(pixel) && self.is_bright(pixel)
    }

    /// The grey of unseen cells as written by map savers; `None` in raw mode.
    pub(super) fn unseen_grey(&self) -> Option<u8> {
        (self.mode != Mode::Raw).then_some(if self.negate { u8::MAX - UNSEEN } else { UNSEEN })
    }

    fn is_unseen(&self, pixel: Pixel) -> bool {
        self.unseen_grey() == Some(pixel.grey)
    }

    /// Whether a pixel is free according to the thresholds alone.
    fn is_bright(&self, pixel: Pixel) -> bool {
        let bright = f64::from(pixel.grey) / 255.0;
        let occupancy = if self.negate { bright } else { 1.0 - bright };
        match self.mode {
            Mode::Trinary => pixel.is_opaque && occupancy <= self.free && occupancy < self.occupied,
            // A value between the thresholds is also free if its share rounds to 0 %.
            Mode::Scale => {
                pixel.is_opaque && (occupancy - self.free) / (self.occupied - self.free) * 100.0 < 0.5
            }
            Mode::Raw => f64::from(pixel.grey) / 100.0 <= self.free,
        }
    }
}

/// The correct form of a key's value.
fn right_value(key: &str) -> Option<&'static str> {
    Some(match key {
        "image" => "it must be the file name of the image, for example map.pgm",
        "resolution" => "it must be metres per cell, for example 0.05",
        "origin" => "it must be [x, y, angle] in metres and radians, for example [-10.0, -5.0, 0.0]",
        "negate" => "it must be 0 or 1",
        "occupied_thresh" | "free_thresh" => "it must be a number from 0 to 1",
        _ => return None,
    })
}

/// A message about a duplicate key.
fn twice(text: &str, key: Option<&str>, line: Option<usize>) -> String {
    let is_it = |written: &&str| written.split_once(':').is_some_and(|(name, _)| Some(name.trim()) == key);
    let lines = text.lines().take(line.unwrap_or_default().saturating_sub(1)).enumerate();
    let first = lines.filter(|(_, written)| is_it(written)).map(|(k, _)| k + 1).next();
    let first = first.map_or_else(String::new, |first| format!(", first in line {first}"));
    format!("duplicate key{first}; remove one")
}

/// Checks an origin: x and y in metres, and an angle in radians.
fn place(numbers: &[f64]) -> Result<[f64; 3], String> {
    let origin = <[f64; 3]>::try_from(numbers)
        .map_err(|_| format!("{numbers:?} is not [x, y, angle] in metres and radians"))?;
    let is_near = |v: &f64| v.abs() <= 10_000.0;
    if !origin.iter().all(is_near) {
        return Err(format!("{numbers:?}: x and y must be finite and within 10 km"));
    }
    let [_, _, angle] = origin;
    if angle.abs() > TAU {
        let right = angle.to_radians();
        return Err(format!("an angle of {angle} rad is more than one turn; {angle}° would be {right:.4}"));
    }
    Ok(origin)
}

/// An error on a line; its key is the key in that line, or the nearest key above it.
fn wrong(file: &Path, text: &str, line: Option<usize>, what: String) -> ImportError {
    let above = text.lines().take(line.unwrap_or_default()).collect::<Vec<_>>();
    let key_of = |line: &&str| {
        let key = line.split_once(':')?.0;
        let is_plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        is_plain.then(|| key.to_owned())
    };
    let key = above.iter().rev().find_map(key_of);
    ImportError { file: file.display().to_string(), line, key, what }
}
