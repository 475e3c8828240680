//! The pipeline of a plan: candidates, their first tours, the finished candidates, and the chosen one.

use crate::draft::Draft;
use crate::jobs::{Job, run_all};
use crate::scan::Scan;
use crate::scope::Scope;
use crate::slit_domain::SlitDomain;
use crate::stages::{Stage, Stages};
use crate::tether::{Tethered, comes_in};
use crate::tether_safe::candidate::{Candidate, Worth};
use crate::tether_safe::parameters::{Choice, Preferences};
use crate::tuning::choice::{ANGLES, CLOSE, DRAFT_CABLE, DRAFT_WRAP, HOPELESS, MOST_FINISHED, MOST_ROUGHED};
use crate::workspace::Workspace;
use planner_api::{Ctx, LogLevel, Result, Site};
use world::tether::Cable;

/// The data shared by the steps of a plan.
#[derive(Clone, Copy)]
pub(super) struct Pipeline<'a> {
    pub site: &'a Site<'a>,
    pub workspace: &'a Workspace,
    pub preferences: &'a Preferences,
    pub scope: Scope<'a>,
    /// The cable as it lies; `None` at the anchor.
    pub cable: Option<&'a Cable>,
    /// Whether candidates are limited to cuts that the cable does not cross.
    pub must_come_in: bool,
}

/// A candidate with its first tour.
struct Drafted<'a> {
    name: String,
    /// Estimated cost of the finished path, metres.
    estimate_m: f64,
    /// Whether its tether may still meet the preferences for length and wrap.
    may_meet: bool,
    draft: Draft<'a>,
}

/// A finished candidate.
struct Finished<'a> {
    name: String,
    worth: Worth,
    /// Kept only for the best candidate: the floor of a large tank takes megabytes.
    scan: Option<Scan<'a>>,
}

/// All finished candidates, and those set aside because of their tether.
#[derive(Default)]
pub(super) struct Tried<'a> {
    finished: Vec<Finished<'a>>,
    left: Vec<Drafted<'a>>,
}

impl<'a> Pipeline<'a> {
    /// Finishes the promising candidates. Tries straighter cuts if none meets the preferences.
    pub(super) fn run(&self, stages: &mut Stages<'_>) -> Result<Tried<'a>> {
        let end = stages.end;
        let mut tried = Tried::default();
        let skipped = if self.workspace.is_crowded() { ANGLES.len() - 1 } else { 0 };
        for (k, share) in ANGLES.into_iter().enumerate().skip(skipped) {
            stages.end = stages.toward(end, 0.7);
            let (touring, finishing) = match k {
                _ if k == skipped => ("first tours", "candidates"),
                _ => ("first tours, straighter cuts", "candidates, straighter cuts"),
            };
            let drafts = self.drafts(self.preferences.alpha_rad * share, &stages.next(0.25, touring))?;
            self.finish_promising(drafts, stages, finishing, &mut tried)?;
            if self.preferences.alpha_rad == 0.0 || tried.is_enough(self.preferences) {
                break;
            }
        }
        if !tried.is_enough(self.preferences) && !tried.left.is_empty() {
            stages.end = end;
            let left = std::mem::take(&mut tried.left);
            self.finish(left, stages, (1.0, "candidates with a longer tether"), &mut tried)?;
        }
        Ok(tried)
    }

    /// The first tours of all candidates with cuts up to the given angle, cheapest first.
    fn drafts(&self, alpha_rad: f64, stage: &Stage<'_>) -> Result<Vec<Drafted<'a>>> {
        let Self { workspace, preferences, scope, .. } = *self;
        let drafted = |candidate: Candidate, job: &Job| {
            job.stage(0.25);
            let comes_in = |domain: &SlitDomain<'_>| {
                !self.must_come_in || self.cable.is_none_or(|cable| comes_in(domain, cable))
            };
            let Some(domain) = candidate.domain(workspace, preferences).filter(comes_in) else {
                return Ok(None);
            };
            let draft = Draft::new(&candidate.pattern, domain, scope, preferences.effort, job)?;
            Ok(Some(self.estimated(candidate.name(), draft)))
        };
        let drafts = run_all(Candidate::all(workspace, preferences, alpha_rad), stage, drafted)?;
        Ok(cheapest_first(drafts.into_iter().flatten()))
    }

    /// Estimates the cost and the tether of a draft.
    fn estimated(&self, name: String, draft: Draft<'a>) -> Drafted<'a> {
        let Self { site, preferences, cable, .. } = *self;
        let estimate_m = draft.estimate_m(preferences.choice_turn_m);
        let tethered = Tethered { domain: draft.domain(), path: &draft.path(), cable };
        let strain = tethered.strain(site, preferences.demands());
        let lenient = preferences.with_leeway(DRAFT_CABLE, DRAFT_WRAP);
        let may_meet = strain.is_some_and(|strain| lenient.allow(&strain));
        Drafted { name, estimate_m, may_meet, draft }
    }

    /// Finishes the promising drafts. If none of them meets the preferences, also finishes some that look worse. The
    /// cheapest drafts whose tether is too long or winds too much are set aside.
    fn finish_promising(
        &self,
        mut drafts: Vec<Drafted<'a>>,
        stages: &mut Stages<'_>,
        what: &'static str,
        tried: &mut Tried<'a>,
    ) -> Result<()> {
        let left = drafts.extract_if(.., |draft| !draft.may_meet);
        tried.left.extend(left.take(MOST_ROUGHED));
        drafts.retain(|draft| draft.may_meet);
        let least_m = drafts.first().map_or(0.0, |draft| draft.estimate_m);
        let mut hopeless = self.hopeless(&mut drafts, HOPELESS, MOST_ROUGHED);
        let (ctx, n) = (stages.ctx, drafts.len() as f64);
        ctx.scalar("candidates finished", n, "");
        // The probability that some of the worse-looking drafts are finished as well is assumed to be one half.
        let n_expected = n + hopeless.len().min(MOST_ROUGHED) as f64 / 2.0;
        self.finish(drafts, stages, (n / n_expected.max(1.0), what), tried)?;
        if !tried.is_enough(self.preferences) && !hopeless.is_empty() {
            hopeless.truncate(MOST_ROUGHED);
            return self.finish(hopeless, stages, (1.0, what), tried);
        }
        if let (Some(next), Some(last)) = (hopeless.first(), hopeless.last()) {
            let [from_m, to_m] = [next, last].map(|draft| draft.estimate_m - least_m);
            let n = hopeless.len();
            let more = format!("{n} more candidates not worked out ({from_m:.0} to {to_m:.0} m longer)");
            ctx.log(LogLevel::Debug, &more);
        }
        Ok(())
    }

    /// If only the cheapest candidate is wanted, removes and returns all drafts beyond the first `most`, and those that
    /// exceed the lowest cost by more than `share`.
    fn hopeless(&self, drafts: &mut Vec<Drafted<'a>>, share: f64, most: usize) -> Vec<Drafted<'a>> {
        if self.preferences.choice != Choice::Shortest {
            return Vec::new();
        }
        let least_m = drafts.first().map_or(0.0, |draft| draft.estimate_m);
        let n = drafts.partition_point(|draft| draft.estimate_m <= least_m * (1.0 + share));
        drafts.split_off(n.min(most))
    }

    /// Polishes drafts in coarse cells, and then finishes the promising drafts. If none of these meets the preferences,
    /// finishes all remaining drafts.
    fn finish(
        &self,
        drafts: Vec<Drafted<'a>>,
        stages: &mut Stages<'_>,
        (share, what): (f64, &'static str),
        tried: &mut Tried<'a>,
    ) -> Result<()> {
        let end = stages.end;
        stages.end = stages.toward(end, share);
        let roughed = |Drafted { name, draft, .. }, job: &Job| Ok(self.estimated(name, draft.roughed(job)?));
        let roughed = run_all(drafts, &stages.next(0.6, what), roughed)?;
        let (mut close, mut rest): (Vec<_>, Vec<_>) = roughed.into_iter().partition(|draft| draft.may_meet);
        close = cheapest_first(close.into_iter());
        rest.extend(self.hopeless(&mut close, CLOSE, MOST_FINISHED));
        self.touch_up(close, &stages.next(0.6, what), tried)?;
        if !tried.is_enough(self.preferences) {
            self.touch_up(rest, &stages.next(1.0, what), tried)?;
        }
        stages.end = end;
        Ok(())
    }

    /// Finishes drafts, and keeps the scan of the best candidate so far.
    fn touch_up(&self, drafts: Vec<Drafted<'a>>, stage: &Stage<'_>, tried: &mut Tried<'a>) -> Result<()> {
        let Self { site, preferences, cable, .. } = *self;
        tried.finished.extend(run_all(drafts, stage, |Drafted { name, draft, .. }, job| {
            let scan = draft.finished(job)?;
            job.stage(1.0);
            let worth = Worth::of(site, preferences, &scan, cable);
            Ok(Finished { name, worth, scan: Some(scan) })
        })?);
        tried.keep_best(preferences);
        Ok(())
    }
}

fn cheapest_first<'a>(drafts: impl Iterator<Item = Drafted<'a>>) -> Vec<Drafted<'a>> {
    let mut drafts: Vec<Drafted<'a>> = drafts.collect();
    drafts.sort_by(|a, b| a.estimate_m.total_cmp(&b.estimate_m));
    drafts
}

impl<'a> Tried<'a> {
    /// Whether any candidate meets the preferences.
    fn is_enough(&self, preferences: &Preferences) -> bool {
        self.finished.iter().any(|finished| finished.worth.meets(preferences))
    }

    /// Whether any candidate is certified.
    pub(super) fn is_certified(&self) -> bool {
        self.finished.iter().any(|finished| finished.worth.certificate.certified)
    }

    fn keep_best(&mut self, preferences: &Preferences) {
        let mut best = 0;
        for k in 1..self.finished.len() {
            let is_better = self.finished[k].worth.is_before(&self.finished[best].worth, preferences);
            let worse = if is_better { std::mem::replace(&mut best, k) } else { k };
            self.finished[worse].scan = None;
        }
    }

    /// Returns the best candidate. Logs every candidate that no other beats.
    pub(super) fn chosen(self, ctx: &Ctx<'_>) -> Option<(Worth, Scan<'a>)> {
        for Finished { name, worth, .. } in &self.finished {
            if !self.finished.iter().any(|other| worth.is_beaten_by(&other.worth)) {
                ctx.log(LogLevel::Debug, &worth.summary(name));
            }
        }
        self.finished.into_iter().find_map(|finished| Some((finished.worth, finished.scan?)))
    }
}
