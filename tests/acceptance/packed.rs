//! Packages: everything that belongs to a report in one file, checked without the runs.

use crate::{
    bench::{Bench, Ended, scenario},
    report_file::FACTS,
};
use sha2::{Digest, Sha256};
use std::{collections::BTreeMap, fs, io::Cursor, path::PathBuf};

/// The files in a package.
fn files(bench: &Bench, name: &str) -> BTreeMap<String, Vec<u8>> {
    let bytes = fs::read(bench.path().join(name)).unwrap();
    let mut package = package::Package::open(Cursor::new(bytes)).unwrap();
    let names: Vec<String> = package.entries().iter().map(|entry| entry.name.clone()).collect();
    let content = |name: String| {
        let content = package.content(&name, u64::MAX).unwrap().unwrap();
        (name, content)
    };
    names.into_iter().map(content).collect()
}

fn verify(bench: &Bench, name: &str) -> Ended {
    bench.tankops(&["verify", name])
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

/// Packs files again as a forger would: with a list of digests that fits.
fn forge(bench: &Bench, name: &str, files: &BTreeMap<String, Vec<u8>>) {
    let mut writer = package::Writer::new(Cursor::new(Vec::new()));
    for (name, content) in files.iter().filter(|(name, _)| *name != package::SUMS) {
        writer.add(name, &content[..]).unwrap();
    }
    bench.file(name, writer.finish().unwrap().into_inner());
}

/// Changes to one part of a package that contradict the other parts: the file, the text before and after the change, and
/// the finding.
const CONTRADICTIONS: [(&str, &str, &str, &str); 7] = [
    ("package.json", "\"package_version\": 1", "\"package_version\": 2", "has version 2"),
    ("package.json", "\"revision\": \"A\"", "\"revision\": \"B\"", "the revision in report.json is not B"),
    ("package.json", "\"number\": \"2", "\"number\": \"3", "report.html is not the page of report 3"),
    ("package.json", "\"readings\": \"", "\"readings\": null, \"was\": \"", "belongs to none of the runs"),
    ("package.json", "\"journal_sha256\": \"", "\"journal_sha256\": \"0", "different digests of the journal"),
    ("report.json", "\"runs\": [", "\"runs\": [{},", "report.json has 2 runs, but package.json has 1"),
    ("report.json", "\"signature\": null", "\"signature\": 1", "different signatures"),
];

/// Changes files of a package and the digests that other parts state: the page names each change.
fn forgeries_are_named_by_the_page(bench: &Bench, name: &str, content: &BTreeMap<String, Vec<u8>>) {
    // The page vouches for every other file, also for one that no other part describes.
    let grid = content["plate-grid.csv"].clone();
    let figures = String::from_utf8(content["report.json"].clone()).unwrap().replacen("0.", "0.9", 1);
    let notes = format!("notes/{name}.json");
    let changes = [
        ("report.json", figures.into_bytes()),
        ("plate-grid.csv", grid[..grid.len() / 2].to_vec()),
        ("report.geojson", b"{}".to_vec()),
        ("report.dxf", Vec::new()),
        ("report-missed.csv", b"a,b\n".to_vec()),
        (notes.as_str(), b"{}".to_vec()),
        ("README.txt", b"Call this number.".to_vec()),
    ];
    for (file, bytes) in changes {
        let mut forged = content.clone();
        forged.insert(file.into(), bytes);
        forge(bench, "forged.zip", &forged);
        let verified = verify(bench, "forged.zip");
        let why = format!("different: {file} is not the file that belongs to report.html");
        assert!(verified.code == Some(1) && verified.out.contains(&why), "{file}: {verified:?}");
    }
    // Readings, list and report that were changed together.
    let mut forged = content.clone();
    let readings = format!("readings/{name}.parquet");
    let (then, now) = (digest(&content[&readings]), digest(b"PAR1"));
    forged.insert(readings.clone(), b"PAR1".to_vec());
    for list in ["package.json", "report.json"] {
        let text = String::from_utf8(content[list].clone()).unwrap();
        forged.insert(list.into(), text.replace(&then, &now).into_bytes());
    }
    forge(bench, "forged.zip", &forged);
    let verified = verify(bench, "forged.zip");
    let why = format!("different: {readings} is not the file that belongs to report.html");
    assert!(verified.code == Some(1) && verified.out.contains(&why), "{verified:?}");
    for (file, why) in [
        ("report-more.csv", "report-more.csv does not belong to the report: report.html does not state it"),
        ("signed/revision-B.html", "signed/revision-B.html belongs to none of the signatures"),
    ] {
        let mut forged = content.clone();
        forged.insert(file.into(), b"<html>".to_vec());
        forge(bench, "forged.zip", &forged);
        let verified = verify(bench, "forged.zip");
        assert!(verified.code == Some(1) && verified.out.contains(why), "{why}: {verified:?}");
    }
}

#[test]
fn a_package_holds_readings_grid_notes_and_drawings_and_is_checked_without_the_runs() {
    let bench = Bench::new();
    bench.fly(&scenario("inspect-circle.toml"), &[]);
    let run: PathBuf = bench.runs().pop().unwrap();
    let name = run.file_name().unwrap().to_string_lossy().into_owned();
    fs::write(run.join("notes.json"), "{\"remark\": \"seen\", \"bookmarks\": []}\n").unwrap();
    let packed = bench.tankops(&["report", &name, "--package", "a.zip"]);
    assert_eq!(packed.code, Some(0), "{packed:?}");
    let sha256 = digest(&fs::read(bench.path().join("a.zip")).unwrap());
    assert!(packed.out.contains(&sha256), "{packed:?}");
    let page = bench.tankops(&["report", &name, "-o", "r.html"]);
    assert_eq!(page.code, Some(0), "{page:?}");
    let in_run = |file: &str| fs::read(run.join(file)).unwrap();
    let content = files(&bench, "a.zip");
    assert_eq!(content["report.html"], fs::read(bench.path().join("r.html")).unwrap());
    assert_eq!(content[&format!("readings/{name}.parquet")], in_run("readings.parquet"));
    assert_eq!(content[&format!("notes/{name}.json")], in_run("notes.json"));
    for file in
        ["report.json", "report.csv", "report-indications.csv", "report.dxf", "report.geojson", "README.txt"]
    {
        assert!(!content[file].is_empty(), "{file}");
    }
    // Each cell of the grid has a plate, a thickness, and the journal of its run; the readings add up. The error is
    // missing only in the few cells whose centre the tool did not pass.
    let grid = String::from_utf8(content["plate-grid.csv"].clone()).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&content["report.json"]).unwrap();
    let journal = report["runs"][0]["files"]["journal_sha256"].as_str().unwrap();
    let (mut readings, mut without_error) = (0, 0);
    for line in grid.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        assert!(!cells[0].is_empty() && cells[10] == journal && cells[8] == name, "{line}");
        let [mean_mm, least_mm] = [4, 5].map(|k| cells[k].parse::<f64>().unwrap());
        assert!(least_mm <= mean_mm && mean_mm < 10.0, "{line}");
        assert!(cells[3].is_empty() || cells[3].parse::<f64>().unwrap() > 0.0, "{line}");
        without_error += usize::from(cells[3].is_empty());
        readings += cells[6].parse::<u64>().unwrap();
    }
    assert!(1000 * without_error < grid.lines().count(), "{without_error} cells");
    let thickness = &report["thickness"];
    let judged = thickness["readings"].as_u64().unwrap() - thickness["untestable"].as_u64().unwrap();
    assert_eq!(readings, judged);
    // Without the runs.
    fs::remove_dir_all(bench.path().join("logs")).unwrap();
    let verified = verify(&bench, "a.zip");
    assert_eq!(verified.code, Some(0), "{verified:?}");
    for line in
        ["files have the SHA-256 in SHA256SUMS", "has the SHA-256 that run", "draft, not signed", &sha256]
    {
        assert!(verified.out.contains(line), "{line}: {verified:?}");
    }
    // Readings that were exchanged, with a list of digests that fits.
    let mut forged = content.clone();
    forged.insert(format!("readings/{name}.parquet"), b"PAR1".to_vec());
    forge(&bench, "forged.zip", &forged);
    let verified = verify(&bench, "forged.zip");
    assert!(verified.code == Some(1) && verified.out.contains("is not the file of run"), "{verified:?}");
    for (file, from, to, why) in CONTRADICTIONS {
        let text = String::from_utf8(content[file].clone()).unwrap();
        assert!(text.contains(from), "{file} does not contain {from}");
        let mut forged = content.clone();
        forged.insert(file.into(), text.replacen(from, to, 1).into_bytes());
        forge(&bench, "forged.zip", &forged);
        let verified = verify(&bench, "forged.zip");
        assert!(verified.code == Some(1) && verified.out.contains(why), "{why}: {verified:?}");
    }
    forgeries_are_named_by_the_page(&bench, &name, &content);
    let mut without = content.clone();
    without.remove("report.dxf");
    forge(&bench, "without.zip", &without);
    assert!(verify(&bench, "without.zip").out.contains("report.dxf is missing, but report.html states it"));
    let mut emptied = content.clone();
    emptied.insert("report.html".into(), Vec::new());
    forge(&bench, "emptied.zip", &emptied);
    assert!(verify(&bench, "emptied.zip").out.contains("report.html is not the page of report"));
    let mut without = content;
    without.remove("report.json");
    forge(&bench, "without.zip", &without);
    assert!(verify(&bench, "without.zip").out.contains("report.json is missing, which every package has"));
}

#[test]
fn a_signed_page_is_packed_and_a_change_to_it_is_named() {
    let bench = Bench::new();
    bench.fly(&scenario("cover-circle.toml"), &[]);
    bench.file("facts.toml", FACTS);
    bench.file("found.csv", "t_s,kind\n60,pit\n");
    let run = bench.runs().pop().unwrap();
    let run = run.to_str().unwrap();
    let facts = ["--inspection", "facts.toml", "--indications", "found.csv", "--sign", "L. Kern"];
    let sign = |page: &str, package: &str| {
        let signed =
            bench.tankops(&[&["report", run, "-o", page, "--package", package], &facts[..]].concat());
        assert_eq!(signed.code, Some(0), "{signed:?}");
    };
    sign("a.html", "a.zip");
    let content = files(&bench, "a.zip");
    assert_eq!(content["report.html"], fs::read(bench.path().join("a.html")).unwrap());
    assert!(!content.contains_key("plate-grid.csv"), "the tool reads no thickness");
    let verified = verify(&bench, "a.zip");
    assert!(
        verified.code == Some(0) && verified.out.contains("signed: revision A by L. Kern"),
        "{verified:?}"
    );
    assert!(verified.out.contains("your register lists revision A with the same SHA-256"), "{verified:?}");
    // The next revision holds the page of the first one.
    sign("b.html", "b.zip");
    let second = files(&bench, "b.zip");
    let earlier: Vec<&String> = second.keys().filter(|name| name.starts_with("signed/")).collect();
    assert!(earlier.len() == 1 && second[earlier[0]] == content["report.html"], "{earlier:?}");
    assert_eq!(verify(&bench, "b.zip").code, Some(0));
    // Page and signature changed together, with a list of digests that fits: the register shows it.
    let page =
        String::from_utf8(content["report.html"].clone()).unwrap().replace("No remarks", "All is fine");
    let mut forged = content.clone();
    forged.insert("report.html".into(), page.clone().into_bytes());
    forge(&bench, "forged.zip", &forged);
    let verified = verify(&bench, "forged.zip");
    let why = "NOT AS SIGNED: report.html was changed after L. Kern signed it as revision A";
    assert!(verified.code == Some(1) && verified.out.contains(why), "{verified:?}");
    // Nothing says at the same time that the page is as signed.
    assert!(!verified.out.contains("\nsigned: "), "{verified:?}");
    assert!(verified.out.contains("NOT AS SIGNED: your register lists revision A"), "{verified:?}");
    let signatures = String::from_utf8(content["signatures.json"].clone()).unwrap();
    let signatures = signatures.replace(&digest(&content["report.html"]), &digest(page.as_bytes()));
    forged.insert("signatures.json".into(), signatures.into_bytes());
    forge(&bench, "forged.zip", &forged);
    let verified = verify(&bench, "forged.zip");
    let why = "NOT AS SIGNED: your register lists revision A by L. Kern";
    assert!(verified.code == Some(1) && verified.out.contains(why), "{verified:?}");
}

#[test]
fn damaged_packages_and_names_that_do_not_fit_are_refused() {
    let bench = Bench::new();
    bench.fly(&scenario("cover-circle.toml"), &[]);
    let run = bench.runs().pop().unwrap();
    let run = run.to_str().unwrap();
    assert_eq!(bench.tankops(&["report", run, "--package", "a.zip"]).code, Some(0));
    let again = bench.tankops(&["report", run, "--package", "a.zip"]);
    assert!(again.code == Some(2) && again.err.contains("already exists"), "{again:?}");
    let other = bench.tankops(&["report", run, "--package", "a.tar"]);
    assert!(other.code == Some(2) && other.err.contains("needs a name that ends in .zip"), "{other:?}");
    let bytes = fs::read(bench.path().join("a.zip")).unwrap();
    let at = bytes.windows(9).position(|word| word == b"<!doctype").unwrap();
    let mut altered = bytes.clone();
    altered[at + 2] = b'D';
    bench.file("altered.zip", altered);
    let verified = verify(&bench, "altered.zip");
    assert!(verified.code == Some(1) && verified.out.contains("report.html was altered"), "{verified:?}");
    bench.file("short.zip", &bytes[..bytes.len() / 2]);
    let verified = verify(&bench, "short.zip");
    assert!(
        verified.code == Some(1)
            && verified.out.contains("refused: not a package of tankops, or only a part of one"),
        "{verified:?}"
    );
}
