use super::*;

fn read_bytes(bytes: &[u8]) -> Result<FloorPlan, String> {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("c.csv");
    std::fs::write(&file, bytes).unwrap();
    let shown = |error: ImportError| ImportError { file: "c.csv".into(), ..error }.to_string();
    read(&Input::read(&file).unwrap(), 10.0)
        .map_err(|errors| errors.into_iter().map(shown).collect::<Vec<_>>().join("\n"))
}

fn found(text: &[u8]) -> Vec<(String, f64, f64, f64)> {
    let rounded = |v: f64| (v * 1e9).round() / 1e9;
    let one = |named: Named| match named.shape {
        Shape::Disc { center, radius_m } => {
            (named.name, rounded(center.x), rounded(center.y), rounded(radius_m))
        }
        other => panic!("{other:?}"),
    };
    read_bytes(text).unwrap().obstacles.into_iter().map(one).collect()
}

#[test]
fn fields_come_in_any_order_and_with_semicolons() {
    let all = found(b"# survey\nname;diameter_m;y_m;x_m\nA1;0.5;1;2\n;1;-3;0\n");
    assert_eq!(all, [("A1".into(), 2.0, 1.0, 0.25), ("column 2".into(), 0.0, -3.0, 0.5)]);
}

#[test]
fn lists_of_spreadsheets_are_read_as_they_are_saved() {
    let expected = [("Stütze 1".to_owned(), 2.5, -1.25, 0.3)];
    let german = "Nr;Name;X [mm];Y [mm];Diameter [mm]\r\n1;Stütze 1;2500,0;-1250;600,0\r\n;;;;\r\n";
    let tabs = german.replace(';', "\t");
    let windows: Vec<u8> = german.chars().map(|letter| letter as u8).collect();
    let utf16: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(tabs.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let quoted =
        "\u{feff}\"Name\",\"x in cm\",\"y (cm)\",\"radius_ft\"\n\"Stütze 1\",\"250\",-125,0.984251968504\n";
    for text in [german.as_bytes(), tabs.as_bytes(), &windows, &utf16, quoted.as_bytes()] {
        assert_eq!(found(text), expected);
    }
    assert_eq!(read_bytes(german.as_bytes()).unwrap().notes, ["not used: field Nr"]);
}

#[test]
fn all_bad_rows_are_named() {
    let text = "name,x_m,y_m,radius_m\nA,1,2,0.3\nB,x,2,0.3\nC,1,2\nA,3,3,-1\nD,30,2,0.3\n";
    assert_eq!(
        read_bytes(text.as_bytes()).unwrap_err().lines().collect::<Vec<_>>(),
        [
            "c.csv, line 3, x_m: `x` is not a number; write it without a unit and without thousands separators",
            "c.csv, line 4: 3 cells, but the first line has 4",
            "c.csv, line 5, radius_m: the radius is -1 m; it must be greater than 0",
            "c.csv, line 5, name: the name `A` is used twice",
            "c.csv, line 6, x_m: (30, 2) is outside the tank of radius 10 m; x and y are measured from its centre",
        ]
    );
}

#[test]
fn errors_name_line_and_field() {
    let message = |text: &str| read_bytes(text.as_bytes()).unwrap_err();
    let header = "x_m,y_m,radius_m\n";
    assert_eq!(message("x,y_m\n"), "c.csv, line 1, x: has no unit; append one, as in x_m or x [mm]");
    assert_eq!(
        message("# a\nx_m,y [furlong],radius_m\n"),
        "c.csv, line 2, y [furlong]: `furlong` is not a known unit of length; use m, cm, mm, in or ft"
    );
    assert_eq!(
        message("x_m,y_m,Nr\n1,2,3\n"),
        "c.csv, line 1, radius_m: missing from the first line; write, for example, x_m,y_m,radius_m \
         (also diameter; mm, cm, in, ft); the fields are: x_m, y_m, Nr"
    );
    assert_eq!(
        message("x_m,y_m,radius_m,diameter_mm\n"),
        "c.csv, line 1, diameter_mm: has the same meaning as another field; remove one of them"
    );
    assert_eq!(
        message(&format!("{header}1,2,0.3\n1,b,0.3\n")),
        "c.csv, line 3, y_m: `b` is not a number; write it without a unit and without thousands separators"
    );
    assert_eq!(
        message("x_mm;y_mm;radius_mm\n1.234,5;0;300\n"),
        "c.csv, line 2, x_mm: `1.234,5` is not a number; write it without a unit and without thousands separators"
    );
    assert_eq!(
        message(&format!("{header}1,2,0\n")),
        "c.csv, line 2, radius_m: the radius is 0 m; it must be greater than 0"
    );
    assert_eq!(
        message(&format!("{header}11,2,0.3\n")),
        "c.csv, line 2, x_m: (11, 2) is outside the tank of radius 10 m; x and y are measured from its centre"
    );
    assert_eq!(message(&format!("{header}1,2\n")), "c.csv, line 2: 2 cells, but the first line has 3");
    let far = "# a\r\nx_m,y_m,radius_m\r\n1,1,0.2\r\n# b\r\n\r\n2,b,0.2";
    for text in [far.to_owned(), far.replace('\r', ""), far.replace('\n', "")] {
        assert!(message(&text).starts_with("c.csv, line 6, y_m: "), "{}", message(&text));
    }
    assert_eq!(message(header), "c.csv: no columns: the list has no rows below the first line");
    assert!(
        message(&format!("{header}1,1,\u{0}0.2")).contains("line 2: not a text file: contains a zero byte")
    );
}

#[test]
fn thousands_beside_decimals_are_refused_with_both_lines() {
    let text = b"name;x_mm;y_mm;diameter_mm\nA;4.000;250,5;500\nB;-4.000;1.250;500,0\n";
    assert_eq!(
        read_bytes(text).unwrap_err(),
        "c.csv, line 2, y_mm: `250,5`, and `4.000` in line 2: two decimal marks in one list; use only one, \
         and no thousands separators"
    );
}

#[test]
fn columns_on_one_spot_are_named() {
    let text = b"name,x_m,y_m,radius_m\nA,1,1,0.3\nB,4,1,0.3\nC,1.004,1,0.3\nD,1.5,1,0.3\n";
    assert_eq!(
        read_bytes(text).unwrap().notes,
        ["`C` (line 4) overlaps `A` (line 2): their centres are 4 mm apart"]
    );
}
