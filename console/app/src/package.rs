//! `tankops report RUN --package FILE.zip`: the report with everything that belongs to it, in one file that can be checked
//! without the runs.

use crate::output::check_free;
use ::package::{PackageError, Writer, is_name};
use anyhow::Context;
use command::json::pretty_json;
use flight::failure::bad_input;
use recording::{READINGS_FILE, sha256};
use report::{
    Document, PastRun,
    document::{Revision, csv, dxf, geojson, grid::plate_grid, html, located_json},
    print::say_line,
};
use review::package::{MANIFEST, Manifest, PAGE, SIGNATURES, readings_name, signed_name};
use runs::{NOTES_FILE, write_whole_with};
use std::{
    fs::File,
    io,
    path::{Path, PathBuf},
};

/// What is packed.
pub(crate) struct Content<'a> {
    pub(crate) document: &'a Document,
    pub(crate) past: &'a [PastRun],
    /// The folders of the runs.
    pub(crate) folders: &'a [PathBuf],
    /// All signed reports on the runs, with the one that was signed now.
    pub(crate) revisions: &'a [Revision],
}

/// Text for people who receive a package.
const README: &str = "\
A report on the inspection of a tank floor, packed by tankops.

report.html         the report; open it with a browser and print it from there
report.json         the same figures for programs
report*.csv         tables: plates, missed areas, critical zone, obstacles, indications, track, follow-up
report.geojson      drawing for geographic information systems
report.dxf          drawing for CAD programs
plate-grid.csv      thickness in each cell of floor that was tested, if the tool reads thickness
readings/           the readings of the instrument, Parquet
notes/              notes that people wrote about the runs
signatures.json     the signed reports on these runs, each with the SHA-256 of its page
signed/             the pages of earlier signed reports
package.json        the runs, with the SHA-256 of their files
SHA256SUMS          the SHA-256 of every file here

To check that nothing was changed: `tankops verify FILE.zip`, or unpack and run `sha256sum -c SHA256SUMS`.
";

/// Whether a package may be written to a file.
pub(crate) fn check(file: &Path, force: bool) -> anyhow::Result<()> {
    let is_zip = file.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("zip"));
    if !is_zip {
        return Err(bad_input(format!("--package needs a name that ends in .zip, not {}", file.display())));
    }
    check_free(file, Some(force), &[])
}

/// Writes a package, and prints its name and SHA-256.
pub(crate) fn write(file: &Path, content: &Content<'_>) -> anyhow::Result<()> {
    write_whole_with(file, |out| fill(out, content))
        .with_context(|| format!("cannot write the package {}", file.display()))?;
    let sha256 = sha256(file).with_context(|| format!("cannot read the package {}", file.display()))?;
    Ok(say_line(&format!("{}, sha256 {sha256}", file.display()))?)
}

fn fill(out: &mut File, content: &Content<'_>) -> anyhow::Result<()> {
    let Content { document, past, folders, revisions } = content;
    let mut package = Writer::new(out);
    let text = |package: &mut Writer<_>, name: &str, text: &str| -> Result<(), PackageError> {
        package.add(name, text.as_bytes()).map(drop)
    };
    text(&mut package, "README.txt", README)?;
    text(&mut package, PAGE, &html(document))?;
    let json = match document.located {
        Some(_) => pretty_json("the report", &located_json(document)?)?,
        None => pretty_json("the report", document)?,
    };
    text(&mut package, "report.json", &json)?;
    for (suffix, table) in csv::SUFFIXES.iter().zip(csv::tables(document, past)) {
        text(&mut package, &format!("report{suffix}.csv"), &table)?;
    }
    text(&mut package, "report.geojson", &geojson::geojson(document, past))?;
    text(&mut package, "report.dxf", &dxf::dxf(document, past))?;
    if document.thickness.is_some() {
        package.add_with("plate-grid.csv", |sink| plate_grid(past, sink).map_err(anyhow::Error::msg))?;
    }
    let name = |(number, past): (usize, &PastRun)| {
        if is_name(&past.name) { past.name.clone() } else { format!("run-{number}") }
    };
    let names: Vec<String> = (1..).zip(past.iter()).map(name).collect();
    for (run, folder) in names.iter().zip(folders.iter()) {
        add_file(&mut package, &readings_name(run), &folder.join(READINGS_FILE))?;
        add_file(&mut package, &format!("notes/{run}.json"), &folder.join(NOTES_FILE))?;
    }
    let manifest = Manifest::new(document, past, &names);
    for revision in revisions.iter().filter(|revision| !manifest.is(revision)) {
        let page = File::open(&revision.file).with_context(|| {
            format!("cannot read the signed revision {}: {}", revision.revision, revision.file)
        })?;
        let packed = package.add(&signed_name(revision), page)?;
        if packed != revision.sha256 {
            return Err(bad_input(format!(
                "signed revision {} was changed after it was signed: {}; restore the file",
                revision.revision, revision.file
            )));
        }
    }
    text(&mut package, SIGNATURES, &pretty_json("the signatures", revisions)?)?;
    text(&mut package, MANIFEST, &pretty_json("the list of the runs", &manifest)?)?;
    package.finish()?;
    Ok(())
}

/// Adds a file of a run, if it exists.
fn add_file(package: &mut Writer<&mut File>, name: &str, path: &Path) -> anyhow::Result<()> {
    match File::open(path) {
        Ok(file) => {
            package.add(name, file)?;
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error).with_context(|| format!("cannot read {}", path.display())),
    }
}
