//! Writes findings as one HTML page.

use crate::{findings::Findings, frozen::Campaign, plots, statistics::Mean, text};
use askama::Template;

#[derive(Template)]
#[template(path = "campaign.html", escape = "html")]
struct Page<'a> {
    campaign: &'a Campaign,
    findings: &'a Findings,
    success: String,
    distribution: Option<String>,
    pareto: Option<String>,
    means: Vec<(&'a str, Vec<String>)>,
    incomplete: Vec<(&'a str, Vec<String>)>,
    differences: Vec<(&'a str, Vec<String>)>,
    scenarios: Vec<(&'a str, Vec<String>)>,
}

/// The page of a campaign; it contains neither a time nor the name of a machine.
///
/// # Errors
/// The template cannot be rendered, which should not happen.
pub fn page(campaign: &Campaign, findings: &Findings) -> Result<String, String> {
    let arms = findings.arms.iter();
    let means =
        arms.clone().map(|arm| (arm.name.as_str(), cells(arm.complete.hits, arm.complete.n, &arm.means)));
    let incomplete = arms.clone().filter(|arm| arm.complete.hits < arm.complete.n).map(|arm| {
        let n = arm.complete.n - arm.complete.hits;
        (arm.name.as_str(), cells(n, arm.complete.n, &arm.means_of_incomplete))
    });
    let differences = arms.clone().skip(1).map(|arm| {
        let others = arm.differences[1..].iter().map(|mean| text::interval(mean.as_ref()));
        let success = text::points(arm.differences[0].as_ref());
        (arm.name.as_str(), std::iter::once(success).chain(others).collect())
    });
    let scenarios = arms.filter(|arm| !arm.scenarios.is_empty()).map(|arm| {
        (arm.name.as_str(), arm.scenarios.iter().map(|(_, success)| text::share(success)).collect())
    });
    let page = Page {
        campaign,
        findings,
        success: plots::success(findings),
        distribution: plots::distribution(findings),
        pareto: plots::pareto(findings),
        means: means.collect(),
        incomplete: incomplete.collect(),
        differences: differences.collect(),
        scenarios: scenarios.collect(),
    };
    page.render().map_err(|error| error.to_string())
}

/// A share of the missions, and the means over these missions.
fn cells(hits: u64, n: u64, means: &[Option<Mean>]) -> Vec<String> {
    let means = means.iter().map(|mean| text::interval(mean.as_ref()));
    std::iter::once(format!("{hits} of {n}")).chain(means).collect()
}

#[cfg(test)]
mod tests {
    use crate::{findings::tests::example, frozen::tests::campaign, table::tests::PLAN};

    #[test]
    fn a_page_has_every_section_and_refers_to_nothing_outside() {
        let page = super::page(&campaign(&PLAN.replace("\"p\"", "\"<p>\"")), &example()).expect("a page");
        for part in
            ["Success", "Paired differences", "Distribution", "Pareto", "Inspect these first", "tankops run"]
        {
            assert!(page.contains(part), "{part}");
        }
        assert_eq!(page.matches("<svg").count(), 3);
        assert!(!page.contains("src=") && !page.contains("href="), "the page stands alone");
    }
}
