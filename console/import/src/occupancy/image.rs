//! The image of a map: PGM (P2, P5), PNG or JPEG.

use crate::error::{ImportError, read_file};
use image::{DynamicImage, ImageFormat, ImageReader};
use std::{io::Cursor, path::Path};

/// The largest number of cells along a side.
const MOST_CELLS: usize = 8000;

/// The relevant values of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pixel {
    /// The brightness, 255 for white; 16-bit values are rounded to 8 bits, as in the map server.
    pub grey: u8,
    /// Whether the pixel is fully opaque.
    pub is_opaque: bool,
}

/// The pixels of an image, from the upper left.
pub(super) struct Image {
    pub columns: usize,
    pub pixels: Vec<Pixel>,
}

impl Image {
    pub(super) fn read(path: &Path) -> Result<Self, ImportError> {
        let bytes = read_file(path)?;
        let of_file = |what: String| ImportError::of_file(path, what);
        if bytes.starts_with(b"P5") || bytes.starts_with(b"P2") {
            return grey_map(&bytes).map_err(of_file);
        }
        let format = match &bytes[..] {
            [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
            [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
            _ => {
                return Err(of_file(
                    "not a PGM (P2, P5), PNG or JPEG image; save the map as PGM or PNG".into(),
                ));
            }
        };
        let bad = |error: image::ImageError| of_file(format!("the image cannot be read: {error}"));
        let reader = || ImageReader::with_format(Cursor::new(&bytes), format);
        let (columns, rows) = reader().into_dimensions().map_err(bad)?;
        check_size(columns as usize, rows as usize).map_err(of_file)?;
        let pixels = portable(reader().decode().map_err(bad)?);
        Ok(Self { columns: columns as usize, pixels })
    }
}

fn check_size(columns: usize, rows: usize) -> Result<(), String> {
    let fits = |n: usize| (1..=MOST_CELLS).contains(&n);
    let is_taken = fits(columns) && fits(rows);
    is_taken
        .then_some(())
        .ok_or_else(|| format!("{columns} by {rows} cells; each side must have 1 to {MOST_CELLS}"))
}

/// Decodes a PNG; colours are converted to luminance (Rec. 601).
fn portable(image: DynamicImage) -> Vec<Pixel> {
    match image {
        DynamicImage::ImageLuma8(image) => {
            image.pixels().map(|p| Pixel { grey: p.0[0], is_opaque: true }).collect()
        }
        image => {
            let pixel = |[r, g, b, a]: [u16; 4]| {
                let luminance = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
                Pixel { grey: (luminance / 257.0).round() as u8, is_opaque: a == u16::MAX }
            };
            image.into_rgba16().pixels().map(|p| pixel(p.0)).collect()
        }
    }
}

/// Decodes a portable grey map: `P5 columns rows largest`, then one byte per pixel, or two if `largest` is above 255;
/// or `P2`, then numbers.
fn grey_map(bytes: &[u8]) -> Result<Image, String> {
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
        header.ok_or("a PGM must begin with P5 or P2, columns, rows and largest value")?;
    check_size(columns, rows)?;
    if !(1..=65_535).contains(&most) {
        return Err(format!("the largest value is {most}; it must be 1 to 65535"));
    }
    let pixel = |value: usize| {
        let grey = (value.min(most) as f64 * 255.0 / most as f64).round() as u8;
        Pixel { grey, is_opaque: true }
    };
    let n = columns * rows;
    let pixels: Vec<Pixel> = if bytes.starts_with(b"P2") {
        (0..n).map_while(|_| next()).map(pixel).collect()
    } else {
        // A single blank ends the header.
        let raster = bytes.get(at + 1..).unwrap_or_default();
        let width = if most > 255 { 2 } else { 1 };
        let value = |bytes: &[u8]| bytes.iter().fold(0, |value, byte| value * 256 + usize::from(*byte));
        raster.chunks_exact(width).take(n).map(value).map(pixel).collect()
    };
    if pixels.len() < n {
        return Err(format!("has only {} of {n} pixels; the file is truncated", pixels.len()));
    }
    Ok(Image { columns, pixels })
}
