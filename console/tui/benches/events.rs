//! How long a key takes in the filter of 100 000 events.
#![allow(missing_docs, reason = "criterion writes a function without docs")]

use criterion::{Criterion, criterion_group, criterion_main};
use mission::{Event, EventKind, Severity};
use positioning::Exclusion;
use std::hint::black_box;
use tui::model::Run;
use tui::model::log::MAX_LINES;
use tui::model::log::matches::Matches;
use world::StationId;

/// Filters as they are typed, letter by letter.
const TYPED: [&str; 4] =
    ["rejected", "sev>=watch source=ae,tether", "station=17 t>00:05", "-rejected \"in use\" -plan"];

/// A run whose log is full: stations are rejected and used again, and the console reports messages.
fn full_run() -> Run {
    let mut run = Run::default();
    for tick in 0..MAX_LINES as u64 {
        let (t_s, station) = (tick as f64 * 0.1, StationId(tick as u32 % 40));
        if tick % 5 == 0 {
            run.log.add(t_s, Severity::Info, "console", format!("line {tick}, no event of the mission"));
            continue;
        }
        let reason = Exclusion::Residual { residual_m: tick as f64 * 1e-5, gate_m: 0.15 };
        let kind = match tick % 2 {
            0 => EventKind::StationRejected { station, reason },
            _ => EventKind::StationRestored { station },
        };
        run.fold(&Event { tick, t_s, kind });
    }
    assert_eq!(run.log.len(), MAX_LINES);
    run
}

fn filter(criterion: &mut Criterion) {
    let run = full_run();
    for typed in TYPED {
        criterion.bench_function(&format!("filter {typed}, last letter"), |bencher| {
            bencher.iter_batched_ref(
                || {
                    let mut matches = Matches::default();
                    matches.refresh(&typed[..typed.len() - 1], &run.log);
                    matches
                },
                |matches| {
                    matches.refresh(typed, &run.log);
                    black_box(matches.len())
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    criterion.bench_function("filter, nothing new", |bencher| {
        let mut matches = Matches::default();
        matches.refresh(TYPED[0], &run.log);
        bencher.iter(|| matches.refresh(black_box(TYPED[0]), &run.log));
    });
}

criterion_group!(benches, filter);
criterion_main!(benches);
