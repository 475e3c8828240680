//! The files of a package, as its page states them. A signature covers the page alone, so the page states the SHA-256 of
//! every other file.

use super::{page::Block, sections::closing::grouped};
use std::collections::BTreeMap;

/// The heading above the list of the files.
const HEADING: &str = "Files of this report";

/// The list of the files; nothing for a page that is not part of a report with files.
pub(super) fn blocks(files: &[(String, String)]) -> Vec<Block> {
    if files.is_empty() {
        return Vec::new();
    }
    let stated = files.iter().map(|(name, sha256)| (name.clone(), grouped(sha256))).collect();
    vec![
        Block::Heading(HEADING.into()),
        Block::Text(
            "The SHA-256 of the files that belong to this page in a package of the report. \u{201c}tankops verify\u{201d} \
             compares the files of a package with this list, so a signature of this page also covers them."
                .into(),
        ),
        Block::Hashes(stated),
    ]
}

/// The files that a page states, each with its SHA-256, hexadecimal; empty for a page without this list.
pub fn stated_files(page: &str) -> BTreeMap<String, String> {
    // The list is at the end of the page.
    let list = page.rsplit_once(HEADING).and_then(|(_, rest)| rest.split_once("</dl>"));
    let entry = |entry: &str| {
        let (name, rest) = entry.split_once("</dt>")?;
        let digest = rest.split_once("class=\"hash\">")?.1.split_once('<')?.0;
        Some((name.to_owned(), digest.split_whitespace().collect()))
    };
    list.into_iter().flat_map(|(list, _)| list.split("<dt>").skip(1).filter_map(entry)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_without_the_list_states_no_file() {
        assert!(blocks(&[]).is_empty());
        assert_eq!(
            stated_files("<dl><dt>report.json</dt><dd><span class=\"hash\">ab</span></dd></dl>").len(),
            0
        );
    }
}
