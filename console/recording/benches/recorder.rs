//! Measures the cost of recording: in the simulation's thread, for the journal, and for the fold into the recording.

#[path = "../tests/recording/synthetic.rs"]
mod synthetic;

use account::Fold;
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use mission::Event;
use recording::{Identity, JournalWriter, Options, Recorder, RunRecorder};
use std::{
    io,
    sync::Arc,
    time::{Duration, Instant},
};

const TICKS: u64 = 2000;

fn recording(criterion: &mut Criterion) {
    let batches: Vec<Arc<[Event]>> = synthetic::run(TICKS).into_iter().map(Arc::from).collect();
    let mut group = criterion.benchmark_group("a tick");
    group.throughput(Throughput::Elements(TICKS)).sample_size(20);
    group.bench_function("sent", |bencher| {
        bencher.iter_batched(
            || {
                let folder = tempfile::tempdir().expect("a folder");
                (RunRecorder::start(folder.path(), Options::default()).expect("new files"), folder)
            },
            |(recorder, folder)| {
                for events in &batches {
                    recorder.send(Arc::clone(events));
                }
                (recorder, folder)
            },
            BatchSize::PerIteration,
        );
    });
    group.bench_function("written to the journal", |bencher| {
        bencher.iter(|| {
            let now = Instant::now();
            let mut journal = JournalWriter::unwritten(now);
            for event in batches.iter().flat_map(|events| events.iter()) {
                journal.append(event, now).expect("nothing to fail");
            }
            journal.finish().expect("nothing to fail")
        });
    });
    group.bench_function("folded and encoded", |bencher| {
        bencher.iter(|| {
            let now = Instant::now();
            let identity = Identity::of_run("bench");
            let mut account = Fold::new();
            let mut recorder = Recorder::writing_to(Box::new(io::sink()), &identity, now).expect("opens");
            for event in batches.iter().flat_map(|events| events.iter()) {
                recorder.push(event, &account, now).expect("nothing to fail");
                account.apply(event);
            }
            recorder.finish(&account.summary(), None).expect("nothing to fail");
        });
    });
    group.finish();
}

fn short() -> Criterion {
    Criterion::default().measurement_time(Duration::from_secs(3)).warm_up_time(Duration::from_secs(1))
}

criterion_group! { name = benches; config = short(); targets = recording }
criterion_main!(benches);
