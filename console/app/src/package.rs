//! `tankops report RUN --package FILE.zip`: the report with everything that belongs to it, in one file that can be checked
//! without the runs.

use crate::output::check_free;
use ::package::{Writer, is_name, sha256_of};
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
    io::{self, Write},
    path::{Path, PathBuf},
};

/// What is packed.
pub(crate) struct Content<'a> {
    pub(crate) document: &'a Document,
    pub(crate) past: &'a [PastRun],
    /// The files that the page of the document states.
    pub(crate) parts: &'a Parts,
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

report.html states the SHA-256 of the other files, so its signature also covers them.
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

/// A file of a package.
struct Part {
    name: String,
    content: Source,
}

/// Where the content of a file comes from; a long content is not kept in memory.
enum Source {
    Text(String),
    PlateGrid,
    File(PathBuf),
}

impl Part {
    fn text(name: &str, text: String) -> Self {
        Self { name: name.to_owned(), content: Source::Text(text) }
    }

    /// A file of a run, if it exists.
    fn of_run(name: String, path: PathBuf) -> Option<Self> {
        path.exists().then_some(Self { name, content: Source::File(path) })
    }

    fn write(&self, past: &[PastRun], sink: &mut dyn Write) -> anyhow::Result<()> {
        match &self.content {
            Source::Text(text) => Ok(sink.write_all(text.as_bytes())?),
            Source::PlateGrid => plate_grid(past, sink).map_err(anyhow::Error::msg),
            Source::File(path) => {
                let reading = || format!("cannot read {}", path.display());
                let mut file = File::open(path).with_context(reading)?;
                io::copy(&mut file, sink).map(drop).with_context(reading)
            }
        }
    }
}

/// The files of a package that belong to its page.
pub(crate) struct Parts(Vec<Part>);

impl Parts {
    /// The files of a report on some runs; `folders` are the folders of the runs.
    pub(crate) fn of(document: &Document, past: &[PastRun], folders: &[PathBuf]) -> anyhow::Result<Self> {
        let json = match document.located {
            Some(_) => pretty_json("the report", &located_json(document)?)?,
            None => pretty_json("the report", document)?,
        };
        let names = names(past);
        let manifest = pretty_json("the list of the runs", &Manifest::new(document, past, &names))?;
        let mut parts = vec![Part::text("README.txt", README.to_owned()), Part::text("report.json", json)];
        let tables = csv::SUFFIXES.iter().zip(csv::tables(document, past));
        parts.extend(tables.map(|(suffix, table)| Part::text(&format!("report{suffix}.csv"), table)));
        parts.push(Part::text("report.geojson", geojson::geojson(document, past)));
        parts.push(Part::text("report.dxf", dxf::dxf(document, past)));
        if document.thickness.is_some() {
            parts.push(Part { name: "plate-grid.csv".to_owned(), content: Source::PlateGrid });
        }
        for (run, folder) in names.iter().zip(folders) {
            parts.extend(Part::of_run(readings_name(run), folder.join(READINGS_FILE)));
            parts.extend(Part::of_run(format!("notes/{run}.json"), folder.join(NOTES_FILE)));
        }
        parts.push(Part::text(MANIFEST, manifest));
        Ok(Self(parts))
    }

    /// The names of the files and their SHA-256, hexadecimal, for the page.
    pub(crate) fn digests(&self, past: &[PastRun]) -> anyhow::Result<Vec<(String, String)>> {
        let digest = |part: &Part| -> anyhow::Result<(String, String)> {
            let sha256 = sha256_of(|sink| part.write(past, sink))?;
            Ok((part.name.clone(), sha256))
        };
        self.0.iter().map(digest).collect()
    }
}

/// The names of the runs in a package.
fn names(past: &[PastRun]) -> Vec<String> {
    let name = |(number, past): (usize, &PastRun)| {
        if is_name(&past.name) { past.name.clone() } else { format!("run-{number}") }
    };
    (1..).zip(past.iter()).map(name).collect()
}

fn fill(out: &mut File, content: &Content<'_>) -> anyhow::Result<()> {
    let Content { document, past, parts, revisions } = content;
    let mut package = Writer::new(out);
    package.add(PAGE, html(document).as_bytes())?;
    for part in &parts.0 {
        let packed = package.add_with(&part.name, |sink| part.write(past, sink))?;
        let stated = document.packed.iter().find(|(name, _)| *name == part.name);
        if stated.is_none_or(|(_, sha256)| *sha256 != packed) {
            return Err(bad_input(format!(
                "{} was changed while the report was written; write the package again",
                part.name
            )));
        }
    }
    let manifest = Manifest::new(document, past, &names(past));
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
    package.add(SIGNATURES, pretty_json("the signatures", revisions)?.as_bytes())?;
    package.finish()?;
    Ok(())
}
