//! `tankops report RUN... -o FILE`: the inspection report as a file, signed or not.

use crate::{
    cli::ReportArgs,
    output::{pretty_json, write_file},
};
use flight::failure::{COMPLETE, bad_input};
use recording::sha256_of;
use report::{
    Document, Inspection, PastRun,
    document::{Context, Revision, Signature, csv, dxf, geojson, html},
    print::say_line,
};
use runs::{Past, SIGNED_FILE, add_signed, find, signed_reports};
use scenario::Scenario;
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
    time::SystemTime,
};

/// The formats, by the ends of file names.
const FORMATS: [&str; 5] = ["html", "json", "csv", "geojson", "dxf"];

/// Writes the report.
pub(crate) fn write(args: &ReportArgs, output: &Path) -> anyhow::Result<ExitCode> {
    let format = format_of(output)?;
    if args.sign.is_some() && format != "html" {
        return Err(bad_input(format!("--sign signs an .html file, not {}", output.display())));
    }
    let folders: Vec<PathBuf> =
        args.runs.iter().map(|run| find(run, &args.logs.folder())).collect::<Result<_, _>>()?;
    let (revisions, doubts) = signed_before(&folders)?;
    for doubt in &doubts {
        if args.sign.is_some() {
            return Err(bad_input(format!("not signed: {doubt}; put the signed file back where it was")));
        }
        say_line(&format!("WARNING: {doubt}"))?;
    }
    may_write(output, args.force, &revisions)?;
    let past = review::read_all(&args.runs, &args.logs.folder())?;
    let inspection = inspection(args, past.last())?;
    let indications = args.indications.as_deref().map(read).transpose()?;
    let name = args.indications.as_ref().map(|file| file.display().to_string());
    let past: Vec<PastRun> = past.into_iter().map(|past| past.run).collect();
    if let Some(by) = &args.sign {
        refuse_other_signer(by, inspection.inspector.as_deref())?;
    }
    let signature = args.sign.clone().map(|by| Signature { by, at: now() });
    let context = Context {
        inspection,
        indications_csv: name.as_deref().zip(indications.as_deref()),
        version: env!("CARGO_PKG_VERSION"),
        revisions,
        signature: signature.clone(),
    };
    let document = Document::new(&past, context).map_err(bad_input)?;
    if signature.is_some() {
        refuse_open_items(&document)?;
    }
    for (file, text) in files(output, format, &document, &past)? {
        write_file("the report", &file, &text)?;
        say_line(&file.display().to_string())?;
        if let Some(signature) = &signature {
            let (revision, sha256) = (document.revision.clone(), sha256_of(text.as_bytes()));
            let path = fs::canonicalize(&file).unwrap_or_else(|_| file.clone()).display().to_string();
            let said = format!("signed as revision {revision} by {}, sha256 {sha256}", signature.by);
            let (number, signature) = (document.number.clone(), signature.clone());
            let signed = Revision { number, revision, signature, file: path, sha256 };
            // A signed report that no run knows of could be changed.
            add_signed(&folders, &signed).inspect_err(|_| drop(fs::remove_file(&file)))?;
            seal(&file)?;
            say_line(&said)?;
        }
    }
    Ok(ExitCode::from(COMPLETE))
}

/// The signed reports of some runs, each once, the earliest first, and what speaks against them.
fn signed_before(folders: &[PathBuf]) -> anyhow::Result<(Vec<Revision>, Vec<String>)> {
    let (mut revisions, mut doubts): (Vec<Revision>, Vec<String>) = Default::default();
    for folder in folders {
        let (signed, against) = signed_reports(folder)?;
        revisions.extend(signed.into_iter().filter(|one| !revisions.contains(one)).collect::<Vec<_>>());
        doubts.extend(against.into_iter().filter(|doubt| !doubts.contains(doubt)).collect::<Vec<_>>());
    }
    revisions.sort_by(|a, b| a.signature.at.cmp(&b.signature.at));
    Ok((revisions, doubts))
}

fn format_of(output: &Path) -> anyhow::Result<&'static str> {
    let extension = output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    FORMATS.into_iter().find(|format| *format == extension).ok_or_else(|| {
        let formats = FORMATS.map(|format| format!(".{format}")).join(", ");
        bad_input(format!("{}: a report is one of {formats}; without -o it is printed", output.display()))
    })
}

/// Refuses to write over what is there, and ever over a signed report.
fn may_write(output: &Path, force: bool, revisions: &[Revision]) -> anyhow::Result<()> {
    if !output.exists() {
        return Ok(());
    }
    let path = fs::canonicalize(output).unwrap_or_else(|_| output.to_owned()).display().to_string();
    if let Some(revision) = revisions.iter().find(|revision| revision.file == path) {
        let letter = &revision.revision;
        return Err(bad_input(format!(
            "{path} is the signed revision {letter}, which is never changed; choose another name"
        )));
    }
    if force {
        return Ok(());
    }
    Err(bad_input(format!("{} already exists; choose another name, or --force", output.display())))
}

/// The facts of the scenario, and those of the file in their place.
fn inspection(args: &ReportArgs, last: Option<&Past>) -> anyhow::Result<Inspection> {
    let of_run = last.map(|past| {
        let text = scenario::with_todays_keys(&past.opened.scenario_toml);
        Scenario::parse(&text, "the scenario in the journal").map_err(|errors| bad_input(errors.render()))
    });
    let known = of_run.transpose()?.map(|scenario| scenario.inspection).unwrap_or_default();
    let Some(file) = &args.inspection else { return Ok(known) };
    let later = scenario::inspection(&read(file)?, &file.display().to_string());
    Ok(known.updated(later.map_err(|errors| bad_input(errors.render()))?))
}

fn read(file: &Path) -> anyhow::Result<String> {
    fs::read_to_string(file).map_err(|error| bad_input(format!("{} cannot be read: {error}", file.display())))
}

/// Refuses a signature under the certificate of somebody else. That no inspector is named is an open item.
fn refuse_other_signer(by: &str, inspector: Option<&str>) -> anyhow::Result<()> {
    match inspector {
        Some(inspector) if inspector.trim() != by.trim() => Err(bad_input(format!(
            "not signed: --sign names {by}, but inspection.inspector is {inspector}, whose certificate the report states; let \
             {inspector} sign, or give inspector and inspector_certificate of {by} in a file for --inspection"
        ))),
        _ => Ok(()),
    }
}

/// What keeps a report from being signed.
fn refuse_open_items(document: &Document) -> anyhow::Result<()> {
    let open: Vec<String> = document
        .open_items()
        .map(|item| format!("  {} {}: {}", item.number, item.what, item.missing.join(", ")))
        .collect();
    if open.is_empty() {
        return Ok(());
    }
    let (count, are) = (open.len(), if open.len() == 1 { "is" } else { "are" });
    Err(bad_input(format!(
        "not signed: {count} of {} items {are} open (keys of [inspection] go into a file for --inspection):\n{}",
        document.gate.len(),
        open.join("\n")
    )))
}

/// The files of a format with their texts.
fn files(
    output: &Path,
    format: &str,
    document: &Document,
    past: &[PastRun],
) -> anyhow::Result<Vec<(PathBuf, String)>> {
    let one = |text: String| vec![(output.to_owned(), text)];
    Ok(match format {
        "html" => one(html(document)),
        "json" => one(pretty_json("the report", document)?),
        "geojson" => one(geojson::geojson(document, past)),
        "dxf" => one(dxf::dxf(document, past)),
        _ => {
            let stem = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let name = |suffix: &str| output.with_file_name(format!("{stem}{suffix}.csv"));
            let tables = csv::tables(document, past);
            tables.into_iter().map(|(suffix, text)| (name(suffix), text)).collect()
        }
    })
}

/// Makes a file read-only.
fn seal(file: &Path) -> anyhow::Result<()> {
    let mut permissions = fs::metadata(file)?.permissions();
    permissions.set_readonly(true);
    fs::set_permissions(file, permissions).map_err(|error| {
        bad_input(format!("{} cannot be made read-only: {error}; see {SIGNED_FILE}", file.display()))
    })
}

/// This minute, UTC.
fn now() -> String {
    let utc = runs::utc(SystemTime::now());
    let digits = |range: std::ops::Range<usize>| utc.get(range).unwrap_or_default().to_owned();
    format!("{}-{}-{} {}:{}", digits(0..4), digits(4..6), digits(6..8), digits(9..11), digits(11..13))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn only_the_inspector_whose_certificate_is_stated_signs() {
        assert!(refuse_other_signer("L. Kern", Some(" L. Kern ")).is_ok());
        // That no inspector is named is an open item of the gate.
        assert!(refuse_other_signer("L. Kern", None).is_ok());
        let refused = refuse_other_signer("A. Other", Some("L. Kern")).unwrap_err().to_string();
        assert!(
            refused.starts_with("not signed: --sign names A. Other, but inspection.inspector is L. Kern")
        );
    }

    fn signed(folder: &Path, revision: &str, at: &str) -> Revision {
        let file = folder.join(format!("{revision}.html"));
        fs::write(&file, revision).unwrap();
        let signature = Signature { by: "L. Kern".into(), at: at.into() };
        let (number, revision) = ("1-1".to_owned(), revision.to_owned());
        let file = file.display().to_string();
        Revision { number, sha256: sha256_of(revision.as_bytes()), revision, signature, file }
    }

    #[test]
    fn the_chain_of_several_runs_has_each_signed_report_once_and_a_changed_one_is_a_doubt_of_all() {
        let [one, other] = [(), ()].map(|()| tempfile::tempdir().unwrap());
        let both = signed(one.path(), "B", "2026-11-22 05:00");
        let first = signed(one.path(), "A", "2026-11-22 04:00");
        let of_other = signed(other.path(), "C", "2026-11-22 04:30");
        let folders = [one.path().to_owned(), other.path().to_owned()];
        add_signed(&folders[..1], &first).unwrap();
        add_signed(&folders[1..], &of_other).unwrap();
        add_signed(&folders, &both).unwrap();
        assert_eq!(signed_before(&folders).unwrap(), (vec![first, of_other, both.clone()], vec![]));
        fs::write(&both.file, "forged").unwrap();
        for folders in [&folders[..], &folders[..1], &folders[1..]] {
            let (_, doubts) = signed_before(folders).unwrap();
            assert!(
                doubts.len() == 1 && doubts[0].starts_with("signed revision B was changed"),
                "{doubts:?}"
            );
        }
    }
}
