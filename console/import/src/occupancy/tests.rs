use super::*;
use ::image::{GrayImage, ImageBuffer, Luma, Rgba, RgbaImage};
use std::fs;

const YAML: &str = "image: m.pgm\nresolution: 0.5\norigin: [1.0, -2.0, 0.0]\nnegate: 0\n\
                    occupied_thresh: 0.65\nfree_thresh: 0.196\n";

fn map(yaml: &str, pgm: &[u8]) -> Result<OccupancyMap, ImportError> {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("m.pgm"), pgm).unwrap();
    fs::write(dir.path().join("m.yaml"), yaml).unwrap();
    OccupancyMap::read(&dir.path().join("m.yaml")).map_err(|error| {
        let file = Path::new(&error.file).file_name().unwrap().to_string_lossy().into_owned();
        ImportError { file, ..error }
    })
}

/// Whether each cell in a row of 8-bit values is free.
fn free(yaml: &str, values: &[u8]) -> Vec<bool> {
    let header = format!("P5 {} 1 255 ", values.len());
    map(yaml, &[header.as_bytes(), values].concat()).unwrap().is_free
}

#[test]
fn the_image_begins_at_the_upper_left_and_the_unknown_is_solid() {
    let read = map(YAML, b"P5 # made by hand\n2 2\n255\n\xfe\x00\xcd\xfe").unwrap();
    // Below: unknown grey, free; above: free, occupied.
    assert_eq!(read.is_free, [false, true, true, false]);
    assert_eq!((read.columns, read.cell_m, read.to_tank(0.0, 0.0)), (2, 0.5, Point::new(1.0, -2.0)));
    assert_eq!(map(YAML, b"P2 # comment\n2 2 255 254 0\n# and another\n205 254"), Ok(read));
}

#[test]
fn a_turned_map_turns_about_its_origin() {
    let read = map(&YAML.replace("-2.0, 0.0", "-2.0, 1.5707963267948966"), b"P5 2 1 255 \xfe\xfe").unwrap();
    assert!((read.to_tank(2.0, 0.0) - Point::new(1.0, -1.0)).norm() < 1e-12);
    assert_eq!(read.cell_at(Point::new(0.9, -1.2)), Some((1, 0)));
    assert_eq!(read.cell_at(Point::new(1.1, -1.2)), None);
}

#[test]
fn modes_thresholds_and_negation_are_those_of_the_map_server() {
    let values = [255, 206, 205, 100, 50, 10, 0];
    let mode = |mode: &str| format!("{YAML}mode: {mode}\n");
    assert_eq!(free(YAML, &values), [true, true, false, false, false, false, false]);
    assert_eq!(free(&mode("trinary"), &values), free(YAML, &values));
    // On the scale of 100 steps from 0.196 to 0.65, 205 (0.19608) rounds to 0, but it is the grey of unseen cells.
    assert_eq!(free(&mode("scale"), &values), [true, true, false, false, false, false, false]);
    // Percentages; above 100 is unknown.
    assert_eq!(free(&mode("raw"), &values), [false, false, false, false, false, true, true]);
    let negated = YAML.replace("negate: 0", "negate: true");
    assert_eq!(free(&negated, &values), [false, false, false, false, false, true, true]);
}

#[test]
fn what_nobody_has_seen_is_no_floor_whatever_the_thresholds() {
    let unseen = |yaml: &str, values: &[u8]| {
        let header = format!("P5 {} 1 255 ", values.len());
        let read = map(yaml, &[header.as_bytes(), values].concat()).unwrap();
        (read.is_free, read.unseen)
    };
    let wide = YAML.replace("0.196", "0.25");
    let (is_free, told) = unseen(&wide, &[205, 254, 205, 204, 0]);
    assert_eq!(is_free, [false, true, false, true, false]);
    assert_eq!(told, Some(Unseen { n_cells: 2, grey: 205, free_thresh: 0.25 }));
    // In a negated map, the grey of unseen cells is negated, too.
    let (is_free, told) = unseen(&wide.replace("negate: 0", "negate: 1"), &[50, 1, 51, 205, 255]);
    assert_eq!((is_free, told.unwrap().grey), (vec![false, true, true, false, false], 50));
    // The usual thresholds do not make this grey floor, and raw mode has no greys.
    assert_eq!(unseen(YAML, &[205, 254]).1, None);
    assert_eq!(unseen(&format!("{wide}mode: raw\n"), &[205, 20, 50]), (vec![false, true, false], None));
}

#[test]
fn a_key_that_other_tools_write_is_taken_where_it_says_nothing_new() {
    let values = [255, 206, 205, 0];
    assert_eq!(free(&format!("{YAML}map_type: occupancy\n"), &values), free(YAML, &values));
}

#[test]
fn large_values_and_sixteen_bits_are_scaled() {
    let read = |pgm: &[u8]| map(YAML, pgm).unwrap().is_free;
    assert_eq!(read(b"P2 3 1 100 100 81 80"), [true, true, false]);
    assert_eq!(read(b"P5 2 1 65535 \xff\xff\xcd\x00"), [true, false]);
    assert_eq!(read(b"P2 2 1 65535 65535 52000"), [true, false]);
}

#[test]
fn png_of_any_depth_is_read_and_the_transparent_is_unknown() {
    let dir = tempfile::tempdir().unwrap();
    let read = |yaml: &str| {
        fs::write(dir.path().join("m.yaml"), yaml.replace("m.pgm", "m.png")).unwrap();
        OccupancyMap::read(&dir.path().join("m.yaml")).unwrap().is_free
    };
    let file = dir.path().join("m.png");
    GrayImage::from_raw(2, 1, vec![254, 205]).unwrap().save(&file).unwrap();
    assert_eq!(read(YAML), [true, false]);
    ImageBuffer::<Luma<u16>, _>::from_raw(2, 1, vec![65_000_u16, 52_000]).unwrap().save(&file).unwrap();
    assert_eq!(read(YAML), [true, false]);
    let pixels = [[255, 255, 255, 255], [255, 255, 255, 254], [200, 220, 200, 255], [220, 190, 220, 255]];
    RgbaImage::from_fn(4, 1, |x, _| Rgba(pixels[x as usize])).save(&file).unwrap();
    assert_eq!(read(YAML), [true, false, true, false]);
    assert_eq!(read(&format!("{YAML}mode: scale")), [true, false, true, false]);
}

#[test]
fn block_lists_and_flow_maps_are_yaml_too() {
    let block = YAML.replace("[1.0, -2.0, 0.0]", "\n  - 1\n  - -2.0\n  - 0");
    let flow = "{image: m.pgm, resolution: 5.0e-1, origin: [1, -2, 0], negate: false}";
    let pgm = b"P5 1 1 255 \xfe";
    assert_eq!(map(&block, pgm), map(YAML, pgm));
    assert_eq!(map(flow, pgm), map(YAML, pgm));
}

#[test]
fn errors_name_file_line_and_key() {
    let message = |yaml: &str| map(yaml, b"P5 1 1 255 \xfe").unwrap_err().to_string();
    let with = |from: &str, to: &str| message(&YAML.replace(from, to));
    let cases = [
        (
            message("negate: 0\n"),
            "m.yaml: missing field `image`; a map needs at least image and resolution, for example image: map.pgm",
        ),
        (
            with("0.5", "fine"),
            "m.yaml, line 2, resolution: invalid floating point; it must be metres per cell, for example 0.05",
        ),
        (
            with("[1.0, -2.0, 0.0]", "1.0 -2.0 0.0"),
            "m.yaml, line 3, origin: expected sequence start; it must be [x, y, angle] in metres and radians, for \
             example [-10.0, -5.0, 0.0]",
        ),
        (
            with("[1.0, -2.0, 0.0]", "[1.0, -2.0, 90]"),
            "m.yaml, line 3, origin: an angle of 90 rad is more than one turn; 90° would be 1.5708",
        ),
        (with("0.5", ".nan"), "m.yaml, line 2, resolution: NaN m per cell; must be 0.001 to 10"),
        (
            with("[1.0, -2.0, 0.0]", "[1.0, 2.0]"),
            "m.yaml, line 3, origin: [1.0, 2.0] is not [x, y, angle] in metres and radians",
        ),
        (with("negate: 0", "negate: maybe"), "m.yaml, line 4, negate: must be 0, 1, false or true"),
        (
            with("occupied_thresh: 0.65", "ocupied_thresh: 0.65"),
            "m.yaml, line 5, ocupied_thresh: unknown field `ocupied_thresh`, expected one of image, resolution, origin, \
             negate, occupied_thresh, free_thresh, mode, map_type",
        ),
        (
            with("0.196", "0.7"),
            "m.yaml, line 6, free_thresh: free_thresh 0.7 must be less than occupied_thresh 0.65",
        ),
        (
            message(&format!("{YAML}mode: binary\n")),
            "m.yaml, line 7, mode: `binary` is not a mode; it must be trinary, scale or raw",
        ),
        (
            message(&format!("{YAML}negate: 1\n")),
            "m.yaml, line 7, negate: duplicate key, first in line 4; remove one",
        ),
        (
            message(&format!("{YAML}map_type: costmap\n")),
            "m.yaml, line 7, map_type: `costmap` maps are not supported; use an occupancy map, or leave out this key",
        ),
    ];
    for (message, wanted) in cases {
        assert_eq!(message, wanted);
    }
    let missing = with("m.pgm", "n.pgm");
    assert!(
        missing.starts_with("m.yaml, line 1, image: file ") && missing.contains("n.pgm does not exist"),
        "{missing}"
    );
    let image = |bytes: &[u8]| map(YAML, bytes).unwrap_err().to_string();
    assert_eq!(image(b"P5 3 3 255 \xfe"), "m.pgm: has only 1 of 9 pixels; the file is truncated");
    assert_eq!(image(b"GIF89a"), "m.pgm: not a PGM (P2, P5), PNG or JPEG image; save the map as PGM or PNG");
    assert!(image(b"\xff\xd8\xff\xe0").starts_with("m.pgm: the image cannot be read: "));
    assert_eq!(image(b""), "m.pgm: is empty");
}

#[test]
fn jpeg_is_read_and_thresholds_may_meet() {
    let mut jpeg = Vec::new();
    let grey = ::image::GrayImage::from_fn(16, 8, |x, _| ::image::Luma([if x < 8 { 255 } else { 0 }]));
    let encoder = ::image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 95);
    grey.write_with_encoder(encoder).unwrap();
    let same = YAML.replace("0.65", "0.5").replace("0.196", "0.5");
    let read = map(&same, &jpeg).unwrap();
    let expected: Vec<bool> = (0..128).map(|cell| cell % 16 < 8).collect();
    assert_eq!((read.columns, read.is_free), (16, expected));
    let read = map(&format!("{YAML}mode: Trinary\n"), &jpeg).unwrap();
    assert_eq!(read.columns, 16, "the map server takes capitals");
    assert!(map(&(same + "mode: scale\n"), &jpeg).unwrap_err().what.contains("must be less than"));
}
