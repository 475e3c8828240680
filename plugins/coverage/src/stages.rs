//! Progress of a plan, reported stage by stage.

use planner_api::Ctx;

/// The stages of a plan. Every stage takes a share of the remaining progress, so progress never decreases, whatever the
/// number of later stages.
pub(crate) struct Stages<'a> {
    /// The console.
    pub ctx: Ctx<'a>,
    done: f64,
    /// The share of the plan at which the next stages end.
    pub end: f64,
}

/// A stage: its start and end as shares of the whole plan, and its name.
pub(crate) struct Stage<'a> {
    /// The console.
    pub ctx: Ctx<'a>,
    from: f64,
    to: f64,
    what: &'static str,
}

impl<'a> Stages<'a> {
    /// Creates the stages of a plan that has not started.
    pub(crate) fn new(ctx: &Ctx<'a>) -> Self {
        Self { ctx: *ctx, done: 0.0, end: 1.0 }
    }

    /// The point that is this share of the way from the current progress to `end`.
    pub(crate) fn toward(&self, end: f64, share: f64) -> f64 {
        self.done + (end - self.done) * share
    }

    /// Starts the next stage, which takes this share of the remaining progress, 0 to 1.
    pub(crate) fn next(&mut self, share_of_rest: f64, what: &'static str) -> Stage<'a> {
        let from = self.done;
        self.done = self.toward(self.end, share_of_rest).max(from);
        Stage { ctx: self.ctx, from, to: self.done, what }
    }
}

impl Stage<'_> {
    /// Reports that the stage begins.
    pub(crate) fn begin(&self) {
        self.ctx.progress(self.from, self.what);
    }

    /// Reports the progress of the stage, 0 to 1.
    pub(crate) fn reached(&self, share: f64) {
        self.ctx.progress(self.at(share), self.what);
    }

    /// Reports how many of `n` items are done, and the progress of all of them, 0 to 1.
    pub(crate) fn report(&self, share: f64, n_done: usize, n: usize) {
        self.ctx.progress(self.at(share), &format!("{}: {n_done} of {n} worked out", self.what));
    }

    fn at(&self, share: f64) -> f64 {
        self.from + (self.to - self.from) * share.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner_api::testing::Bench;

    #[test]
    fn stages_share_what_is_left() {
        let bench = Bench::new();
        let mut stages = Stages::new(&bench.ctx());
        stages.end = 0.5;
        stages.next(0.5, "cuts").begin();
        stages.next(1.0, "lanes").report(0.5, 1, 2);
        stages.end = 1.0;
        stages.next(0.5, "tour").reached(0.5);
        stages.next(1.0, "the rest").report(9.0, 2, 2);
        let progress = |share, what: &str| (share, what.to_owned());
        let all = [
            progress(0.0, "cuts"),
            progress(0.375, "lanes: 1 of 2 worked out"),
            progress(0.625, "tour"),
            progress(1.0, "the rest: 2 of 2 worked out"),
        ];
        assert_eq!(bench.progress(), all);
    }

    #[test]
    fn stages_never_go_back() {
        let bench = Bench::new();
        let mut stages = Stages::new(&bench.ctx());
        stages.next(0.8, "first").reached(1.0);
        stages.end = 0.5;
        stages.next(1.0, "second").reached(1.0);
        assert_eq!(bench.progress(), [(0.8, "first".to_owned()), (0.8, "second".to_owned())]);
    }
}
