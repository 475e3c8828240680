use super::*;
use std::{fmt::Write, fs};
use world::shape::ring_area_m2;

/// Assumptions that contain only a width of pipes.
fn plain() -> Assumed {
    Assumed { unit_m: None, pipe_width_m: 0.1, layers: Layers::default() }
}

/// Reads a drawing given as groups `code value`, separated by commas; the caller provides sections and tables.
fn read_text(units: &str, blocks: &str, entities: &str, assumed: &Assumed) -> Result<FloorPlan, String> {
    let groups = |text: &str| {
        let pairs = text.split(',').map(str::trim).filter(|pair| !pair.is_empty());
        pairs.map(|pair| pair.replacen(' ', "\n", 1) + "\n").collect::<String>()
    };
    let section = |name: &str, body: &str| {
        format!("{}{}{}", groups(&format!("0 SECTION,2 {name}")), groups(body), groups("0 ENDSEC"))
    };
    let header = format!("9 $ACADVER,1 AC1015{units}");
    let text =
        section("HEADER", &header) + &section("BLOCKS", blocks) + &section("ENTITIES", entities) + "0\nEOF\n";
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, text).unwrap();
    read(&Input::read(&file).unwrap(), assumed).map_err(|error| {
        let file = "d.dxf".into();
        ImportError { file, ..error }.to_string()
    })
}

fn shapes(all: &[Named]) -> Vec<String> {
    let rounded = |p: &Point| format!("({:.3} {:.3})", p.x, p.y);
    let shown = |named: &Named| match &named.shape {
        Shape::Disc { center, radius_m } => format!("{}: disc {} {radius_m:.3}", named.name, rounded(center)),
        Shape::Polygon { vertices } => format!("{}: polygon of {} corners", named.name, vertices.len()),
        Shape::Polyline { points, half_width_m } => {
            let points: Vec<String> = points.iter().map(rounded).collect();
            format!("{}: line {} {:.3}", named.name, points.join(" "), 2.0 * half_width_m)
        }
    };
    all.iter().map(shown).collect()
}

const SHELL: &str = "0 CIRCLE,8 SHELL,10 20000,20 15000,40 10000,";

#[test]
fn a_round_tank_in_millimetres_is_centred_and_scaled() {
    let block = "0 BLOCK,8 0,2 COL,10 0,20 0,0 CIRCLE,8 0,10 0,20 0,40 200,0 ENDBLK";
    let entities = [
        SHELL,
        "0 INSERT,8 COLUMNS,2 COL,10 17000,20 15000,41 2,42 2,",
        "0 LWPOLYLINE,8 PIPES,90 2,70 0,43 150,10 15000,20 10000,10 18000,20 10000,",
        "0 LINE,8 PIPES,10 25000,20 18000,11 25000,21 20000,",
        "0 CIRCLE,8 SUMP,10 13000,20 17000,40 300,",
        "0 LINE,8 PLATES,10 0,20 0,11 1,21 1,",
        "0 CIRCLE,8 COLUMNS,10 90000,20 0,40 10",
    ];
    let plan = read_text(",9 $INSUNITS,70 4", block, &entities.concat(), &plain()).unwrap();
    assert_eq!(plan.boundary, Boundary::Circle { radius_m: 10.0 });
    assert_eq!(
        shapes(&plan.obstacles),
        [
            "column 1: disc (-3.000 0.000) 0.400",
            "pipe 1: line (-5.000 -5.000) (-2.000 -5.000) 0.150",
            "pipe 2: line (5.000 3.000) (5.000 5.000) 0.100",
        ]
    );
    assert_eq!(shapes(&plan.no_go), ["sump 1: disc (-7.000 2.000) 0.300"]);
    assert_eq!(
        plan.notes,
        [
            "(20.000, 15.000) m in the drawing is [0, 0] in the scenario",
            "PIPES: lines without a width (1) were assumed to be 0.1 m wide",
            "PLATES: lines that divide no floor were left out (1); end each seam at another seam or at the shell",
            "column 2 is outside the shell and was left out",
        ]
    );
}

#[test]
fn two_half_circles_are_a_round_shell_and_lines_in_any_order_a_straight_one() {
    let halves = "0 LWPOLYLINE,8 TANK-SHELL,90 2,70 1,10 -6,20 0,42 1,10 6,20 0,42 1";
    let plan = read_text(",9 $INSUNITS,70 6", "", halves, &plain()).unwrap();
    let Boundary::Circle { radius_m } = plan.boundary else { panic!("{:?}", plan.boundary) };
    assert!((radius_m - 6.0).abs() < 1e-9);
    let sides = [
        "0 LINE,8 SHELL,10 12,20 8,11 0,21 8,",
        "0 LINE,8 SHELL,10 0,20 0,11 12,21 0,",
        "0 LINE,8 SHELL,10 0,20 0,11 0,21 8,",
        "0 LINE,8 SHELL,10 12,20 0,11 12,21 8,",
        "0 LWPOLYLINE,8 column,90 6,70 1,10 2,20 2,10 4,20 2,10 4,20 3,10 3,20 3,10 3,20 4,10 2,20 4",
    ];
    let plan = read_text("", "", &sides.concat(), &Assumed { unit_m: Some(1.0), ..plain() }).unwrap();
    assert!((plan.boundary.area_m2() - 96.0).abs() < 1e-9);
    assert_eq!(shapes(&plan.obstacles), ["column 1: polygon of 5 corners"]);
    assert_eq!(
        plan.notes,
        [
            "the drawing states no unit; one unit was taken as 1 m",
            "column 1 is not convex and was replaced by its convex hull"
        ]
    );
}

#[test]
fn what_is_missing_is_named() {
    let error = |units: &str, entities: &str| read_text(units, "", entities, &plain()).unwrap_err();
    assert_eq!(
        error("", SHELL),
        "d.dxf: the header ($INSUNITS) states no unit of length; give it with --units, for example --units mm"
    );
    assert_eq!(
        error(",9 $INSUNITS,70 6", "0 LINE,8 SHELL,10 0,20 0,11 1,21 1"),
        "d.dxf: no circle or closed outline on the layer SHELL; draw the inner side of the shell there, or name its \
         layer, for example --layer SHELL=0; layers: `SHELL` (1 LINE)"
    );
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, "this is not a drawing\nat all\n").unwrap();
    assert!(
        read(&Input::read(&file).unwrap(), &plain())
            .unwrap_err()
            .to_string()
            .contains("line 1: not a DXF drawing: `this is not a drawin` is not a group code")
    );
}

#[test]
fn the_scenario_holds_shell_obstacles_and_zones() {
    let entities = format!(
        "{SHELL}0 CIRCLE,8 COLUMNS,10 20000,20 15000,40 250,0 CIRCLE,8 NOGO,10 15000,20 15000,40 500"
    );
    let text = read_text(",9 $INSUNITS,70 4", "", &entities, &plain()).unwrap().scenario(
        "t",
        "d.dxf",
        "tether-safe",
    );
    for wanted in [
        "radius_m = 10\n",
        "[[obstacles]]\nname = \"column 1\"\nkind = \"circle\"\ncenter_m = [0, 0]\nradius_m = 0.25\n",
        "[[zones]]\nname = \"no-go area 1\"\nkind = \"no_go\"\nshape = \"circle\"\ncenter_m = [-5, 0]\n",
    ] {
        assert!(text.contains(wanted), "{text}");
    }
}

#[test]
fn blocks_that_insert_each_other_without_end_are_refused() {
    let mut text =
        String::from("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n");
    for k in 0..12 {
        let next = (k + 1) % 12;
        let insert = format!("0\nINSERT\n8\nSHELL\n2\nB{next}\n70\n1000\n71\n1000\n");
        write!(text, "0\nBLOCK\n2\nB{k}\n{insert}{insert}0\nENDBLK\n").unwrap();
    }
    text += "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nINSERT\n8\nSHELL\n2\nB0\n0\nENDSEC\n0\nEOF\n";
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, text).unwrap();
    let message = read(&Input::read(&file).unwrap(), &plain()).unwrap_err().to_string();
    assert!(message.contains("more than 1000000 entities"), "{message}");
}

#[test]
fn fifty_thousand_lines_are_joined_to_the_shell() {
    let n = 50_000;
    let mut text =
        String::from("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n");
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * (k % n) as f64 / n as f64;
        (35.0 * angle.cos(), 21.0 * angle.sin())
    };
    for k in 0..n {
        let ((x, y), (u, v)) = (at(k * 7 % n), at(k * 7 % n + 1));
        write!(text, "0\nLINE\n8\nSHELL\n10\n{x:.6}\n20\n{y:.6}\n11\n{u:.6}\n21\n{v:.6}\n").unwrap();
    }
    text += "0\nENDSEC\n0\nEOF\n";
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, text).unwrap();
    let plan = read(&Input::read(&file).unwrap(), &plain()).unwrap();
    let lost_m2 = std::f64::consts::PI * 735.0 - plan.boundary.area_m2();
    assert!((0.0..2.0).contains(&lost_m2), "{lost_m2}");
}

#[test]
fn an_ellipse_is_an_outline_turned_as_drawn() {
    let shell = "0 CIRCLE,8 SHELL,10 0,20 0,40 10,";
    let ellipse = "0 ELLIPSE,8 NOGO,10 3,20 0,11 0,21 2,40 0.5,41 0,42 6.283185307179586";
    let plan = read_text(",9 $INSUNITS,70 6", "", &format!("{shell}{ellipse}"), &plain()).unwrap();
    let (low, high) = plan.no_go[0].shape.bounds();
    let is_near = |at: Point, x: f64, y: f64| (at - Point::new(x, y)).norm() < 0.02;
    assert!(is_near(low, 2.0, -2.0) && is_near(high, 4.0, 2.0), "{low} {high}");
}

#[test]
fn a_drawing_that_is_cut_off_is_refused_for_what_is_missing_could_be_columns() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\nSHELL\n10\n0\n20\n0\n40\n5\n").unwrap();
    let message = read(&Input::read(&file).unwrap(), &plain()).unwrap_err().to_string();
    assert!(
        message.ends_with("the drawing is truncated: it does not end with EOF; save it again"),
        "{message}"
    );
}

/// Reads a drawing with roles assigned to its layers.
fn with_layers(layers: &[(Role, &str)], entities: &str) -> Result<FloorPlan, String> {
    let layers = Layers::new(layers.iter().map(|(role, name)| (*role, (*name).to_owned())).collect());
    read_text(",9 $INSUNITS,70 6", "", entities, &Assumed { layers, ..plain() })
}

#[test]
fn layers_of_any_name_are_read_if_somebody_says_what_they_hold() {
    let entities = "0 CIRCLE,8 Mantel,10 0,20 0,40 9,0 CIRCLE,8 St\\U+00FCtzen,10 2,20 0,40 0.3,\
                    0 CIRCLE,8 Column-Text,10 4,20 0,40 1";
    let named = [(Role::Shell, "mantel"), (Role::Columns, "Stützen"), (Role::Ignored, "COLUMN-TEXT")];
    let plan = with_layers(&named, entities).unwrap();
    assert_eq!(shapes(&plan.obstacles), ["column 1: disc (2.000 0.000) 0.300"]);
    assert_eq!(plan.notes, Vec::<String>::new());
    assert_eq!(
        with_layers(&[(Role::Shell, "Wand")], entities).unwrap_err(),
        "d.dxf: layer `Wand` is empty or does not exist; layers: `Column-Text` (1 CIRCLE), `Mantel` (1 CIRCLE), `Stützen` (1 CIRCLE)"
    );
    let plan = with_layers(&[(Role::Shell, "Mantel"), (Role::Ignored, "Column-Text")], entities).unwrap();
    assert!(
        plan.notes.iter().any(|note| note.starts_with("no columns or pipes were found")),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_drawing_of_one_layer_is_a_shell_and_what_stands_within() {
    let circles: String = [(0.0, 0.0, 8.0), (3.0, 1.0, 0.4), (-3.0, 1.0, 0.4)]
        .map(|(x, y, r)| format!("0 CIRCLE,8 0,10 {x},20 {y},40 {r},"))
        .concat();
    let plan = with_layers(&[(Role::Shell, "0"), (Role::Columns, "0")], &circles).unwrap();
    assert_eq!(plan.boundary, Boundary::Circle { radius_m: 8.0 });
    assert_eq!(plan.obstacles.len(), 2);
}

#[test]
fn hatches_splines_and_filled_areas_are_columns() {
    let shell = "0 CIRCLE,8 SHELL,10 0,20 0,40 10,";
    let hatch = "0 HATCH,8 COLUMNS,10 0,20 0,30 0,2 SOLID,70 1,71 0,91 1,92 7,72 1,73 1,93 2,10 5,20 0,42 1,10 7,20 0,42 1,97 0,";
    let solid = "0 SOLID,8 COLUMNS,10 0,20 0,11 1,21 0,12 0,22 2,13 1,23 2,";
    let spline = "0 SPLINE,8 COLUMNS,70 8,71 1,72 7,73 5,40 0,40 0,40 1,40 2,40 3,40 4,40 4,10 -5,20 0,10 -4,20 0,10 -4,20 1,\
                  10 -5,20 1,10 -5,20 0";
    let plan =
        read_text(",9 $INSUNITS,70 6", "", &format!("{shell}{hatch}{solid}{spline}"), &plain()).unwrap();
    let boxes: Vec<_> = plan
        .obstacles
        .iter()
        .map(|named| named.shape.bounds())
        .map(|(low, high)| [low.x, low.y, high.x, high.y].map(|v| (v * 1e3).round() / 1e3 + 0.0))
        .collect();
    let mut sorted = boxes.clone();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!(sorted, [[-5.0, 0.0, -4.0, 1.0], [0.0, 0.0, 1.0, 2.0], [5.0, -1.0, 7.0, 1.0]]);
    assert_eq!(plan.notes, Vec::<String>::new());
}

#[test]
fn a_stated_unit_counts_more_than_the_header_and_a_tank_of_a_wrong_size_is_refused() {
    let small = "0 CIRCLE,8 SHELL,10 0,20 0,40 12,0 CIRCLE,8 COLUMNS,10 0,20 0,40 0.3";
    let in_millimetres = |unit_m| read_text(",9 $INSUNITS,70 4", "", small, &Assumed { unit_m, ..plain() });
    assert_eq!(
        in_millimetres(None).unwrap_err(),
        "d.dxf: the shell is 0.024000 m across if the drawing's unit is 0.001 m; tanks must be 1 to 1000 m across: \
         state the unit, for example --units mm"
    );
    let plan = in_millimetres(Some(1.0)).unwrap();
    assert_eq!(plan.boundary, Boundary::Circle { radius_m: 12.0 });
    assert_eq!(plan.notes, ["one unit was taken as 1 m, as given; the header states 0.001 m"]);
}

#[test]
fn old_encodings_hidden_layers_and_coordinates_of_a_survey() {
    let groups = [
        "0",
        "SECTION",
        "2",
        "HEADER",
        "9",
        "$DWGCODEPAGE",
        "3",
        "ANSI_1252",
        "9",
        "$INSUNITS",
        "70",
        "6",
        "0",
        "ENDSEC",
        "0",
        "SECTION",
        "2",
        "TABLES",
        "0",
        "TABLE",
        "2",
        "LAYER",
        "0",
        "LAYER",
        "2",
        "SHELL",
        "70",
        "0",
        "62",
        "-7",
        "0",
        "ENDTAB",
        "0",
        "ENDSEC",
        "0",
        "SECTION",
        "2",
        "ENTITIES",
        "0",
        "LWPOLYLINE",
        "8",
        "SHELL",
        "90",
        "4",
        "70",
        "1",
        "10",
        "3500000",
        "20",
        "5800000",
        "10",
        "3500020",
        "20",
        "5800000",
        "10",
        "3500020",
        "20",
        "5800010",
        "10",
        "3500000",
        "20",
        "5800010",
        "0",
        "CIRCLE",
        "8",
        "St\u{fc}tze",
        "10",
        "3500005",
        "20",
        "5800005",
        "40",
        "0.2",
        "0",
        "ENDSEC",
        "0",
        "EOF",
        "",
    ];
    let bytes: Vec<u8> = groups.join("\r\n").chars().map(|letter| letter as u8).collect();
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("d.dxf");
    fs::write(&file, bytes).unwrap();
    let layers = Layers::new(vec![(Role::Columns, "Stütze".into())]);
    let plan = read(&Input::read(&file).unwrap(), &Assumed { layers, ..plain() }).unwrap();
    assert_eq!(shapes(&plan.obstacles), ["column 1: disc (-5.000 0.000) 0.200"]);
    assert_eq!(
        plan.notes,
        [
            "layer SHELL is off or frozen in the drawing, but its contents were used",
            "(3500010.000, 5800005.000) m in the drawing is [0, 0] in the scenario",
        ]
    );
}

/// The names of the plates with their areas, in the order of the plan.
fn plates(plan: &FloorPlan) -> Vec<(&str, f64)> {
    let area = |plate: &world::DrawnPlate| (ring_area_m2(&plate.vertices_m) * 1e3).round() / 1e3;
    plan.plates.iter().map(|plate| (plate.name.as_str(), area(plate))).collect()
}

#[test]
fn seams_and_the_shell_enclose_plates_that_texts_name() {
    let entities = [
        "0 LWPOLYLINE,8 SHELL,90 4,70 1,10 0,20 0,10 6,20 0,10 6,20 4,10 0,20 4,",
        "0 LINE,8 PLATES,10 0,20 2,11 6,21 2.003,",
        "0 LINE,8 PLATES,10 2,20 0,11 2,21 1.996,",
        "0 ARC,8 PLATES,10 6,20 4,40 1,50 180,51 270,",
        "0 TEXT,8 PLATES,10 0.2,20 0.2,40 0.1,1 %%uW-7,",
        "0 TEXT,8 TEXTS,10 0,20 0,11 4,21 1,72 1,1 E-7,",
        // Two plates would have this name, so neither does.
        "0 MTEXT,8 TEXTS,10 1,20 3,1 {\\fArial;t = 8},",
        "0 MTEXT,8 TEXTS,10 5.8,20 3.8,1 t = 8,",
        "0 TEXT,8 TEXTS,10 9,20 9,1 Tank 7",
    ];
    let plan = read_text(",9 $INSUNITS,70 6", "", &entities.concat(), &plain()).unwrap();
    let quarter_m2 = std::f64::consts::PI / 4.0;
    let [a, b, c, d] = plates(&plan)[..] else { panic!("{:?}", plates(&plan)) };
    assert!(a.0 == "P-02" && (a.1 - quarter_m2).abs() < 0.002, "{a:?}");
    assert!(b.0 == "W-7" && (b.1 - 4.0).abs() < 0.01, "{b:?}");
    assert!(c.0 == "E-7" && (c.1 - 8.0).abs() < 0.01, "{c:?}");
    assert!(d.0 == "P-01" && (d.1 - 12.0 + quarter_m2).abs() < 0.02, "{d:?}");
    assert!(plan.notes.contains(&"not used: layer TEXTS: MTEXT (2)".into()), "{:?}", plan.notes);
    assert!(plan.notes.contains(&"not used: layer TEXTS: TEXT (1)".into()), "{:?}", plan.notes);
    // The scenario's outlines are those of the plan.
    let text = plan.scenario("t", "d.dxf", "tether-safe");
    assert!(text.contains("[plates]\noutlines = [\n    { name = \"P-02\", vertices_m = [["), "{text}");
}

#[test]
fn closed_outlines_are_plates_as_they_are_drawn() {
    let entities = [
        "0 CIRCLE,8 SHELL,10 10000,20 0,40 5000,",
        "0 LWPOLYLINE,8 Bleche,90 2,70 1,10 8000,20 0,42 1,10 10000,20 0,42 0,",
        "0 CIRCLE,8 Bleche,10 12000,20 0,40 1000,",
        "0 LWPOLYLINE,8 Bleche,90 4,70 1,10 9000,20 -3000,10 9000,20 -1000,10 13000,20 -1000,10 13000,20 -3000,",
        "0 CIRCLE,8 Bleche,10 30000,20 0,40 1000",
    ];
    let layers = Layers::new(vec![(Role::Plates, "Bleche".into())]);
    let assumed = Assumed { layers, ..plain() };
    let plan = read_text(",9 $INSUNITS,70 4", "", &entities.concat(), &assumed).unwrap();
    let found = plates(&plan);
    let names: Vec<&str> = found.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["P-02", "P-03", "P-01"], "small ones first, numbered from the south");
    assert!((found[0].1 - std::f64::consts::FRAC_PI_2).abs() < 0.01, "a half disc: {found:?}");
    assert!((found[1].1 - std::f64::consts::PI).abs() < 0.01 && (found[2].1 - 8.0).abs() < 1e-3, "{found:?}");
    assert_eq!(plan.plates[2].vertices_m.len(), 4);
    assert!(
        plan.plates[1].vertices_m.iter().all(|at| ((at - Point::new(2.0, 0.0)).norm() - 1.0).abs() < 1e-3)
    );
    assert!(
        plan.notes.contains(&"PLATES: outlines outside the shell were left out (1)".into()),
        "{:?}",
        plan.notes
    );
}

#[test]
fn attributes_of_blocks_are_numbers_of_plates() {
    let blocks = "0 BLOCK,8 0,2 PL0,10 0,20 0,0 LWPOLYLINE,8 PLATES,90 4,70 1,10 0,20 0,10 3,20 0,10 3,20 4,10 0,20 4,0 ENDBLK";
    let insert = |x: i32, number: &str| {
        format!(
            "0 INSERT,8 0,66 1,2 PL0,10 {x},20 -2,0 ATTRIB,8 PLATES,10 {m},20 -1,40 0.2,1 8 mm,2 THICKNESS,70 0,\
             0 ATTRIB,8 0,10 {m},20 0,40 0.2,1 {number},2 PLATE_NO,70 0,0 SEQEND,8 0,",
            m = f64::from(x) + 1.5
        )
    };
    let entities = format!("0 CIRCLE,8 SHELL,10 0,20 0,40 6,{}{}", insert(-3, "B7"), insert(0, "B8"));
    let plan = read_text(",9 $INSUNITS,70 6", blocks, &entities, &plain()).unwrap();
    let mut found = plates(&plan);
    found.sort_unstable_by(|a, b| a.0.cmp(b.0));
    assert_eq!(found, [("B7", 12.0), ("B8", 12.0)]);
    assert!(plan.notes.contains(&"not used: layer PLATES: ATTRIB (2)".into()), "{:?}", plan.notes);
}

#[test]
fn texts_of_what_else_is_drawn_name_no_plate() {
    let entities = [
        "0 CIRCLE,8 SHELL,10 0,20 0,40 6,",
        "0 LINE,8 PLATES,10 -6,20 0,11 6,21 0,",
        "0 LWPOLYLINE,8 MISSED,90 4,70 1,10 1,20 1,10 2,20 1,10 2,20 2,10 1,20 2,0 TEXT,8 MISSED,10 1.5,20 1.5,1 4,",
        "0 TEXT,8 NUMBERS,10 0,20 -2,1 S-1",
    ];
    let plan = read_text(",9 $INSUNITS,70 6", "", &entities.concat(), &plain()).unwrap();
    let names: Vec<&str> = plates(&plan).into_iter().map(|(name, _)| name).collect();
    assert!(names.contains(&"S-1") && names.contains(&"P-01") && names.len() == 2, "{names:?}");
    assert!(plan.notes.contains(&"not used: layer MISSED: TEXT (1)".into()), "{:?}", plan.notes);
}

/// The four sides of a tank of 10 by 8 m in millimetres, with a gap after the first.
const GAPPED: &str = "0 LINE,8 SHELL,10 0,20 0,11 9980,21 0,0 LINE,8 SHELL,10 10000,20 0,11 10000,21 8000,\
                      0 LINE,8 SHELL,10 10000,20 8000,11 0,21 8000,0 LINE,8 SHELL,10 0,20 8000,11 0,21 0,";

#[test]
fn an_outline_with_a_gap_is_named_with_its_place() {
    let told = "an outline 10.000 m across is nearly closed: one gap of 20.0 mm, from (9980, 0) to (10000, 0) in the \
                drawing; join the ends there";
    assert_eq!(
        read_text(",9 $INSUNITS,70 4", "", GAPPED, &plain()).unwrap_err(),
        format!("d.dxf: no shell on the layer SHELL: {told}; layers: `SHELL` (4 LINE)")
    );
    // A column drawn on the same layer is not a shell.
    let with_column = format!("{GAPPED}0 CIRCLE,8 SHELL,10 3000,20 3000,40 1000");
    assert_eq!(
        read_text(",9 $INSUNITS,70 4", "", &with_column, &plain()).unwrap_err(),
        format!(
            "d.dxf: no shell on the layer SHELL: the largest closed outline is 2.000 m across, but {told}; layers: `SHELL` \
             (1 CIRCLE, 4 LINE)"
        )
    );
    let columns = "0 CIRCLE,8 SHELL,10 0,20 0,40 6,0 LWPOLYLINE,8 COLUMNS,90 4,70 0,10 1,20 1,10 2,20 1,10 2,20 2,10 1.05,20 1";
    let plan = read_text(",9 $INSUNITS,70 6", "", columns, &plain()).unwrap();
    assert!(
        plan.notes.iter().any(|note| note
            .starts_with("COLUMNS: lines that do not close an outline were left out (1); an outline 1.000 m across is nearly closed")
            && note.ends_with("one gap of 50.0 mm, from (1, 1) to (1.05, 1) in the drawing")),
        "{:?}",
        plan.notes
    );
}

#[test]
fn an_outline_that_crosses_itself_is_named_with_its_place() {
    let crossed = "0 LWPOLYLINE,8 SHELL,90 4,70 1,10 0,20 0,10 10,20 8,10 10,20 0,10 0,20 2";
    assert_eq!(
        read_text(",9 $INSUNITS,70 6", "", crossed, &plain()).unwrap_err(),
        "d.dxf: no shell on the layer SHELL: the outline crosses itself at (2, 1.6) in the drawing; draw it without crossings; layers: \
         `SHELL` (1 LWPOLYLINE)"
    );
}

#[test]
fn a_layer_that_was_named_is_not_asked_for_again() {
    let line = "0 LINE,8 0,10 0,20 0,11 1,21 1";
    assert_eq!(
        with_layers(&[(Role::Shell, "0")], line).unwrap_err(),
        "d.dxf: no circle or closed outline on the layer 0 assigned to SHELL; draw the inner side of the shell \
         there, or name a different layer; layers: `0` (1 LINE)"
    );
    let plan = with_layers(
        &[(Role::Columns, "POSTS")],
        &format!("0 CIRCLE,8 SHELL,10 0,20 0,40 6,{}", line.replace("8 0", "8 POSTS")),
    );
    let notes = plan.unwrap().notes;
    assert!(
        notes.iter().any(|note| note.contains("the layers assigned to them contain none: POSTS")),
        "{notes:?}"
    );
}

#[test]
fn names_of_any_letters_are_written_as_toml_has_them() {
    let names = [
        "St\u{a0}1",
        "Stu\u{308}tze",
        "a\u{200b}b",
        "so\u{ad}ft",
        "\u{2764}\u{fe0f}",
        "\u{915}\u{94d}\u{937}",
        "say \"x\"",
        "back\\slash",
    ];
    let disc = |name: &&str| Named {
        name: (*name).to_owned(),
        shape: Shape::Disc { center: Point::origin(), radius_m: 0.3 },
    };
    let vertices_m = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y)).to_vec();
    let plate = |name: &&str| world::DrawnPlate { name: (*name).to_owned(), vertices_m: vertices_m.clone() };
    let plan = FloorPlan {
        boundary: Boundary::Circle { radius_m: 6.0 },
        obstacles: names.iter().map(disc).collect(),
        no_go: Vec::new(),
        plates: names.iter().map(plate).collect(),
        notes: vec!["a\nb".into()],
    };
    let text = plan.scenario("t", "plan \"of\" 1\\2.dxf", "tether-safe");
    let read: toml::Table = text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"));
    let of = |list: &toml::Value| -> Vec<String> {
        list.as_array().unwrap().iter().map(|entry| entry["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(of(&read["obstacles"]), names);
    assert_eq!(of(&read["plates"]["outlines"]), names);
    assert_eq!(read["about"].as_str(), Some("The floor of plan \"of\" 1\\2.dxf"));
}
