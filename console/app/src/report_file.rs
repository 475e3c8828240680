//! `tankops report RUN... -o FILE`: writes the inspection report to a file, signed or unsigned.

use crate::{
    cli::ReportArgs,
    output::{check_free, write_file},
    package::{self, Content, Parts},
    signing::{
        Chain, refuse_doubts, refuse_not_located_again, refuse_not_recomputed, refuse_open_items,
        refuse_other_signer, seal, signature,
    },
};
use account::Inspection;
use command::json::pretty_json;
use flight::{
    failure::{COMPLETE, bad_input},
    texts,
};
use planner_host::PluginDirs;
use report::{
    Document, PastRun,
    document::{Context, Revision, csv, dxf, geojson, html, located_json},
    print::say_line,
};
use review::register;
use runs::{Past, find};
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// The file extensions of the supported formats.
const FORMATS: [&str; 5] = ["html", "json", "csv", "geojson", "dxf"];

/// Writes the report to a file, into a package, or both.
pub(crate) fn write(args: &ReportArgs, plugins: &PluginDirs) -> anyhow::Result<ExitCode> {
    let output = args.output.as_deref().map(|output| Ok::<_, anyhow::Error>((output, format_of(output)?)));
    let output = output.transpose()?;
    if let Some((file, _)) = output.filter(|(_, format)| args.sign.is_some() && *format != "html") {
        return Err(bad_input(format!("--sign needs an .html file as output, not {}", file.display())));
    }
    if let Some(package) = &args.package {
        package::check(package, args.force)?;
    }
    let folders: Vec<PathBuf> =
        args.runs.iter().map(|run| find(run, &args.logs.folder())).collect::<Result<_, _>>()?;
    let mut chain = Chain::of(&folders, &register());
    for file in output.into_iter().flat_map(|(output, format)| names(output, format)) {
        may_write(&file, args, &chain.revisions)?;
    }
    let read = review::read_all(&args.runs, &args.logs.folder())?;
    let inspection = inspection(args, read.last())?;
    let indications = args.indications.as_deref().map(texts::read).transpose()?;
    let name = args.indications.as_ref().map(|file| file.display().to_string());
    if let Some(by) = &args.sign {
        refuse_other_signer(by, inspection.inspector.as_deref())?;
    }
    let of_kind = |is_located: bool| -> Vec<PathBuf> {
        let those =
            read.iter().zip(&folders).filter(|(past, _)| past.opened.measured.is_some() == is_located);
        those.map(|(_, folder)| folder.clone()).collect()
    };
    let (flown, located) = (of_kind(false), of_kind(true));
    let past: Vec<PastRun> = read.into_iter().map(|past| past.run).collect();
    chain.compare(&folders, &past, &register());
    let signature = args.sign.as_deref().map(signature);
    let context = Context {
        inspection,
        indications_csv: name.as_deref().zip(indications.as_deref()),
        version: env!("CARGO_PKG_VERSION"),
        revisions: chain.revisions.clone(),
        signature: signature.clone(),
    };
    let mut document = Document::new(&past, context).map_err(bad_input)?;
    if signature.is_some() {
        refuse_doubts(&chain)?;
        refuse_open_items(&document)?;
        refuse_not_recomputed(&flown, plugins)?;
        refuse_not_located_again(&located)?;
    }
    for doubt in &chain.doubts {
        say_line(&format!("WARNING: {doubt}"))?;
    }
    for (past, doubt) in past.iter().flat_map(|past| past.files.doubts.iter().map(move |doubt| (past, doubt)))
    {
        say_line(&format!("WARNING: run {}: {doubt}", past.name))?;
    }
    let has_page = args.package.is_some() || output.is_some_and(|(_, format)| format == "html");
    let parts = has_page.then(|| Parts::of(&document, &past, &folders)).transpose()?;
    if let Some(parts) = &parts {
        document.packed = parts.digests(&past)?;
    }
    let written = output.map(|(output, format)| files(output, format, &document, &past)).transpose()?;
    for (file, text) in written.into_iter().flatten() {
        write_file("the report", &file, &text)?;
        say_line(&file.display().to_string())?;
        if let Some(signature) = &signature {
            chain.revisions.push(seal((&file, &text), &document, signature, (&folders, &past))?);
        }
    }
    if let Some((file, parts)) = args.package.as_ref().zip(parts.as_ref()) {
        let (document, past, revisions) = (&document, &past[..], &chain.revisions[..]);
        package::write(file, &Content { document, past, parts, revisions })?;
    }
    Ok(ExitCode::from(COMPLETE))
}

fn format_of(output: &Path) -> anyhow::Result<&'static str> {
    let extension = output.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    FORMATS.into_iter().find(|format| *format == extension).ok_or_else(|| {
        let formats = FORMATS.map(|format| format!(".{format}")).join(", ");
        bad_input(format!(
            "{}: unknown report format; use {formats}, or leave out -o to print the report",
            output.display()
        ))
    })
}

/// The files that make up a report in a format.
fn names(output: &Path, format: &str) -> Vec<PathBuf> {
    if format != "csv" {
        return vec![output.to_owned()];
    }
    let stem = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    csv::SUFFIXES.iter().map(|suffix| output.with_file_name(format!("{stem}{suffix}.csv"))).collect()
}

/// Refuses to overwrite an existing file without `--force`, and always refuses to overwrite a signed report of these
/// runs. [`check_free`] protects the signed reports in the register.
fn may_write(output: &Path, args: &ReportArgs, revisions: &[Revision]) -> anyhow::Result<()> {
    let path = fs::canonicalize(output).unwrap_or_else(|_| output.to_owned()).display().to_string();
    if let Some(revision) = revisions.iter().find(|revision| revision.file == path) {
        let letter = &revision.revision;
        return Err(bad_input(format!(
            "{path} is the signed revision {letter}, which must not be changed; choose another name"
        )));
    }
    let inputs: Vec<&Path> =
        [&args.inspection, &args.indications].into_iter().flatten().map(PathBuf::as_path).collect();
    check_free(output, Some(args.force), &inputs)
}

/// The facts of the scenario, overridden by those of the `--inspection` file.
fn inspection(args: &ReportArgs, last: Option<&Past>) -> anyhow::Result<Inspection> {
    let known = last.map(review::inspection).transpose()?.unwrap_or_default();
    let Some(file) = &args.inspection else { return Ok(known) };
    let later = scenario::inspection(&texts::read(file)?, &file.display().to_string());
    Ok(known.updated(later.map_err(|errors| bad_input(errors.render()))?))
}

/// The files that make up a report in a format, with their contents.
fn files(
    output: &Path,
    format: &str,
    document: &Document,
    past: &[PastRun],
) -> anyhow::Result<Vec<(PathBuf, String)>> {
    let one = |text: String| vec![(output.to_owned(), text)];
    Ok(match format {
        "html" => one(html(document)),
        "json" if document.located.is_some() => one(pretty_json("the report", &located_json(document)?)?),
        "json" => one(pretty_json("the report", document)?),
        "geojson" => one(geojson::geojson(document, past)),
        "dxf" => one(dxf::dxf(document, past)),
        _ => names(output, format).into_iter().zip(csv::tables(document, past)).collect(),
    })
}
