//! Progress of a plan, reported stage by stage.

use planner_api::Ctx;

/// The stages of a plan. Every stage takes a share of what is left of its stretch, so that the whole never goes back however
/// many come.
#[derive(Clone, Copy)]
pub struct Stages<'a> {
    ctx: Ctx<'a>,
    done: f64,
    end: f64,
}

/// One stage: where it begins and ends, as shares of the whole plan, and what is being done.
#[derive(Clone, Copy)]
pub struct Part<'a> {
    /// The console.
    pub ctx: Ctx<'a>,
    from: f64,
    to: f64,
    what: &'static str,
}

impl<'a> Stages<'a> {
    /// Nothing is done yet.
    pub fn new(ctx: &Ctx<'a>) -> Self {
        Self { ctx: *ctx, done: 0.0, end: 1.0 }
    }

    /// The console.
    pub fn ctx(&self) -> Ctx<'a> {
        self.ctx
    }

    /// What share of the plan the stages that come lead up to.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The stages that come lead up to this share of the plan.
    pub fn until(&mut self, end: f64) {
        self.end = end;
    }

    /// This far along from what is done to a share of the plan.
    pub fn toward(&self, end: f64, share: f64) -> f64 {
        self.done + (end - self.done) * share
    }

    /// The next stage takes this share of what is left, 0 to 1.
    pub fn next(&mut self, share_of_rest: f64, what: &'static str) -> Part<'a> {
        let from = self.done;
        self.done = self.toward(self.end, share_of_rest).max(from);
        Part { ctx: self.ctx, from, to: self.done, what }
    }
}

impl Part<'_> {
    /// Reports that the stage begins.
    pub fn begin(&self) {
        self.ctx.progress(self.from, self.what);
    }

    /// Reports the progress of the stage, 0 to 1.
    pub fn reached(&self, share: f64) {
        self.ctx.progress(self.at(share), self.what);
    }

    /// Reports how many of `n` items are done, and the progress of all of them, 0 to 1.
    pub fn report(&self, share: f64, n_done: usize, n: usize) {
        self.ctx.progress(self.at(share), &format!("{}, {n_done} of {n} done", self.what));
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
        stages.until(0.5);
        stages.next(0.5, "cuts").begin();
        stages.next(1.0, "lanes").report(0.5, 1, 2);
        stages.until(1.0);
        stages.next(0.5, "tour").reached(0.5);
        stages.next(1.0, "the rest").report(9.0, 2, 2);
        let progress = |share, what: &str| (share, what.to_owned());
        let all = [
            progress(0.0, "cuts"),
            progress(0.375, "lanes, 1 of 2 done"),
            progress(0.625, "tour"),
            progress(1.0, "the rest, 2 of 2 done"),
        ];
        assert_eq!(bench.progress(), all);
    }

    #[test]
    fn stages_never_go_back() {
        let bench = Bench::new();
        let mut stages = Stages::new(&bench.ctx());
        stages.next(0.8, "first").reached(1.0);
        stages.until(0.5);
        stages.next(1.0, "second").reached(1.0);
        assert_eq!(bench.progress(), [(0.8, "first".to_owned()), (0.8, "second".to_owned())]);
    }
}
