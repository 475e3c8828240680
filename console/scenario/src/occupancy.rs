//! Occupancy maps in the form of the ROS map server: a YAML file that names an image and gives its scale.
//!
//! The YAML is flat: `key: value` lines, comments, one list. Of the image only brightness counts. Cells that are not
//! known to be free count as solid, as the robots of the papers treat them.

use std::{fs, path::Path};
use world::Point;

/// A larger file is no map, bytes.
const LARGEST_BYTES: u64 = 20_000_000;
/// More cells than this along a side are not taken.
const MOST_CELLS: usize = 4000;

/// A map: which cells are solid, row by row from the lower left.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OccupancyMap {
    /// Cells along x.
    pub columns: usize,
    /// Whether a cell is solid.
    pub is_solid: Vec<bool>,
    /// Edge of a cell, metres.
    pub cell_m: f64,
    /// Lower left corner of the lower left cell, metres.
    pub origin: Point,
}

/// What is wrong with a map, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}{}{}: {what}", line.map(|line| format!(", line {line}")).unwrap_or_default(),
    key.as_ref().map(|key| format!(", {key}")).unwrap_or_default())]
pub(crate) struct MapError {
    /// The file.
    pub file: String,
    /// Line in it, from 1.
    pub line: Option<usize>,
    /// Key of that line.
    pub key: Option<String>,
    /// What is wrong and what would be right.
    pub what: String,
}

/// The keys of the YAML file.
struct Settings {
    image: String,
    resolution_m: f64,
    origin: [f64; 3],
    negate: bool,
    occupied: f64,
    free: f64,
}

impl OccupancyMap {
    /// Reads a map by its YAML file; the image lies beside it unless its path is absolute.
    ///
    /// # Errors
    /// File, line and key of what is wrong.
    pub(crate) fn read(yaml: &Path) -> Result<Self, MapError> {
        let text = read_file(yaml)?;
        let text =
            String::from_utf8(text).map_err(|_| of_file(yaml, "no text, the YAML file of a map is"))?;
        let settings = Settings::parse(yaml, &text)?;
        let image = yaml.parent().unwrap_or(Path::new("")).join(&settings.image);
        let (columns, grey) = read_image(&image)?;
        let rows = grey.len() / columns.max(1);
        if columns == 0 || rows == 0 || columns > MOST_CELLS || rows > MOST_CELLS {
            let what = format!("{columns} by {rows} cells; 1 to {MOST_CELLS} along a side are taken");
            return Err(of_file(&image, &what));
        }
        let is_solid = |value: u8| {
            let share = f64::from(value) / 255.0;
            let occupied = if settings.negate { share } else { 1.0 - share };
            // Between the thresholds nothing is known.
            occupied > settings.free.min(settings.occupied)
        };
        // Images begin at the upper left.
        let upward = grey.chunks(columns).rev().flatten().map(|value| is_solid(*value));
        Ok(Self {
            columns,
            is_solid: upward.collect(),
            cell_m: settings.resolution_m,
            origin: Point::new(settings.origin[0], settings.origin[1]),
        })
    }
}

impl Settings {
    fn parse(file: &Path, text: &str) -> Result<Self, MapError> {
        let mut found: Vec<(usize, &str, &str)> = Vec::new();
        for (line, written) in text.lines().enumerate() {
            let written = written.split('#').next().unwrap_or_default().trim();
            if written.is_empty() || written == "---" || written == "..." {
                continue;
            }
            let Some((key, value)) = written.split_once(':') else {
                let what = "no `key: value`; the YAML file of a map has one on each line".to_owned();
                return Err(MapError { file: shown(file), line: Some(line + 1), key: None, what });
            };
            found.push((line + 1, key.trim(), value.trim()));
        }
        let of = |key: &str| found.iter().find(|(_, known, _)| *known == key);
        let wrong = |line: usize, key: &str, what: String| MapError {
            file: shown(file),
            line: Some(line),
            key: Some(key.to_owned()),
            what,
        };
        let missing = |key: &str, example: &str| MapError {
            file: shown(file),
            line: None,
            key: Some(key.to_owned()),
            what: format!("missing; add a line as `{key}: {example}`"),
        };
        let number = |key: &str, example: &str| -> Result<(usize, f64), MapError> {
            let (line, _, written) = of(key).ok_or_else(|| missing(key, example))?;
            let number = written.parse::<f64>().ok().filter(|number| number.is_finite());
            number
                .map(|number| (*line, number))
                .ok_or_else(|| wrong(*line, key, format!("`{written}` is no finite number, as {example} is")))
        };
        let (line, _, image) = of("image").ok_or_else(|| missing("image", "map.pgm"))?;
        let image = image.trim_matches(['"', '\'']).to_owned();
        if image.is_empty() {
            return Err(wrong(*line, "image", "no file name; write the image's, as map.pgm".into()));
        }
        let (line, resolution_m) = number("resolution", "0.05")?;
        if !(1e-3..=10.0).contains(&resolution_m) {
            let what = format!("{resolution_m} m to the cell; 0.001 to 10 are taken");
            return Err(wrong(line, "resolution", what));
        }
        let share = |key: &str, default: f64| -> Result<f64, MapError> {
            if of(key).is_none() {
                return Ok(default);
            }
            let (line, share) = number(key, "0.65")?;
            let is_share = (0.0..=1.0).contains(&share);
            is_share.then_some(share).ok_or_else(|| wrong(line, key, format!("{share} is not from 0 to 1")))
        };
        let negate = match of("negate") {
            None | Some((_, _, "0" | "false")) => false,
            Some((_, _, "1" | "true")) => true,
            Some((line, key, written)) => {
                return Err(wrong(*line, key, format!("`{written}` is neither 0 nor 1")));
            }
        };
        Ok(Self {
            image,
            resolution_m,
            origin: Self::origin(file, of("origin").copied())?,
            negate,
            occupied: share("occupied_thresh", 0.65)?,
            free: share("free_thresh", 0.196)?,
        })
    }

    fn origin(file: &Path, found: Option<(usize, &str, &str)>) -> Result<[f64; 3], MapError> {
        let Some((line, key, written)) = found else { return Ok([0.0; 3]) };
        let wrong =
            |what: String| MapError { file: shown(file), line: Some(line), key: Some(key.to_owned()), what };
        let inner = written.trim_start_matches('[').trim_end_matches(']');
        let numbers: Vec<f64> = inner.split(',').filter_map(|part| part.trim().parse().ok()).collect();
        let Ok([x, y, turn_rad]) = <[f64; 3]>::try_from(numbers) else {
            return Err(wrong(format!("`{written}` is not [x, y, angle] in metres and radians")));
        };
        if ![x, y].iter().all(|v| v.is_finite() && v.abs() <= 10_000.0) || turn_rad != 0.0 {
            let what =
                format!("`{written}`: x and y must be within 10 km, and turned maps are not taken (angle 0)");
            return Err(wrong(what));
        }
        Ok([x, y, turn_rad])
    }
}

fn shown(file: &Path) -> String {
    file.display().to_string()
}

fn of_file(file: &Path, what: &str) -> MapError {
    MapError { file: shown(file), line: None, key: None, what: what.to_owned() }
}

fn read_file(path: &Path) -> Result<Vec<u8>, MapError> {
    let unreadable = |error: std::io::Error| of_file(path, &format!("cannot be read: {error}"));
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() || about.len() > LARGEST_BYTES {
        let what = format!("no plain file of at most {} MB", LARGEST_BYTES / 1_000_000);
        return Err(of_file(path, &what));
    }
    fs::read(path).map_err(unreadable)
}

/// Number of columns and brightness of every pixel, from the upper left.
fn read_image(path: &Path) -> Result<(usize, Vec<u8>), MapError> {
    let bytes = read_file(path)?;
    if bytes.starts_with(b"P5") || bytes.starts_with(b"P2") {
        return grey_map(&bytes).map_err(|what| of_file(path, &what));
    }
    if !bytes.starts_with(b"\x89PNG") {
        return Err(of_file(path, "neither PGM (P2, P5) nor PNG; save the map as one of them"));
    }
    let bad = |error: image::ImageError| of_file(path, &format!("no PNG that can be read: {error}"));
    let reader = image::ImageReader::with_format(std::io::Cursor::new(&bytes), image::ImageFormat::Png);
    let (columns, rows) = reader.into_dimensions().map_err(bad)?;
    if columns as usize > MOST_CELLS || rows as usize > MOST_CELLS {
        let what = format!("{columns} by {rows} cells; 1 to {MOST_CELLS} along a side are taken");
        return Err(of_file(path, &what));
    }
    let image = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png).map_err(bad)?;
    Ok((columns as usize, image.into_luma8().into_raw()))
}

/// A portable grey map: `P5 columns rows most` and a byte for each pixel, or `P2` and numbers.
fn grey_map(bytes: &[u8]) -> Result<(usize, Vec<u8>), String> {
    let mut at = 2;
    let mut next = || -> Option<usize> {
        loop {
            match bytes.get(at)? {
                b'#' => at += bytes[at..].iter().position(|b| *b == b'\n')?,
                b if b.is_ascii_whitespace() => at += 1,
                _ => break,
            }
        }
        let digits = bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
        let number = std::str::from_utf8(&bytes[at..at + digits]).ok()?.parse().ok();
        at += digits;
        number
    };
    let header = (|| Some([next()?, next()?, next()?]))();
    let [columns, rows, most] =
        header.ok_or("a PGM begins with P5 or P2, columns, rows and largest value")?;
    if columns == 0 || rows == 0 || columns > MOST_CELLS || rows > MOST_CELLS {
        return Err(format!("{columns} by {rows} cells; 1 to {MOST_CELLS} along a side are taken"));
    }
    if !(1..=255).contains(&most) {
        return Err(format!("the largest value is {most}; 1 to 255 are taken"));
    }
    let scaled = |value: usize| (value.min(most) * 255 / most) as u8;
    let n = columns * rows;
    let grey: Vec<u8> = if bytes.starts_with(b"P2") {
        (0..n).map_while(|_| next()).map(scaled).collect()
    } else {
        // One blank ends the header.
        bytes.iter().skip(at + 1).take(n).map(|value| scaled(usize::from(*value))).collect()
    };
    if grey.len() < n {
        return Err(format!("{} of {n} pixels are there; the file is cut off", grey.len()));
    }
    Ok((columns, grey))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(yaml: &str, pgm: &[u8]) -> Result<OccupancyMap, MapError> {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("m.pgm"), pgm).unwrap();
        fs::write(dir.path().join("m.yaml"), yaml).unwrap();
        OccupancyMap::read(&dir.path().join("m.yaml")).map_err(|error| {
            let file = Path::new(&error.file).file_name().unwrap().to_string_lossy().into_owned();
            MapError { file, ..error }
        })
    }

    const YAML: &str = "image: m.pgm\nresolution: 0.5\norigin: [1.0, -2.0, 0.0]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    #[test]
    fn the_image_begins_at_the_upper_left_and_the_unknown_is_solid() {
        let read = map(YAML, b"P5 # made by hand\n2 2\n255\n\xfe\x00\xcd\xfe").unwrap();
        // Below: unknown grey, free; above: free, occupied.
        assert_eq!(read.is_solid, [true, false, false, true]);
        assert_eq!((read.columns, read.cell_m, read.origin), (2, 0.5, Point::new(1.0, -2.0)));
        assert_eq!(map(YAML, b"P2 2 2 255 254 0 205 254"), Ok(read));
    }

    #[test]
    fn errors_name_file_line_and_key() {
        let pgm = b"P5 1 1 255 \xfe";
        let message = |yaml: &str| map(yaml, pgm).unwrap_err().to_string();
        assert_eq!(message(""), "m.yaml, image: missing; add a line as `image: map.pgm`");
        assert_eq!(
            message(&YAML.replace("0.5", "fine")),
            "m.yaml, line 2, resolution: `fine` is no finite number, as 0.05 is"
        );
        assert_eq!(
            message(&YAML.replace("[1.0, -2.0, 0.0]", "[1.0, 2.0]")),
            "m.yaml, line 3, origin: `[1.0, 2.0]` is not [x, y, angle] in metres and radians"
        );
        assert_eq!(
            message(&YAML.replace("negate: 0", "negate: maybe")),
            "m.yaml, line 4, negate: `maybe` is neither 0 nor 1"
        );
        assert!(message(&YAML.replace("m.pgm", "n.pgm")).starts_with("n.pgm: cannot be read"));
        let cut = map(YAML, b"P5 3 3 255 \xfe").unwrap_err().to_string();
        assert_eq!(cut, "m.pgm: 1 of 9 pixels are there; the file is cut off");
        let jpeg = map(YAML, b"\xff\xd8\xff").unwrap_err().to_string();
        assert_eq!(jpeg, "m.pgm: neither PGM (P2, P5) nor PNG; save the map as one of them");
    }
}
