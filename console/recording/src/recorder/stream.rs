//! The output stream of a recording: static data, single events, and columns of per-tick data.

use crate::{error::RecordingError, identity::Identity, rr, sink::SafeSink};
use std::time::Duration;

/// Name of the application in the viewer, under which the viewer stores layouts.
pub(crate) const APPLICATION: &str = "tankops";
/// Timeline that counts ticks.
pub(crate) const TICK: &str = "tick";
/// Timeline of mission time.
pub(crate) const SIM_TIME: &str = "sim_time";
/// Calendar timeline: the start of the run from its name, plus mission time.
pub(crate) const UTC: &str = "utc";

/// A moment of the mission on all timelines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct At {
    /// Number of the tick.
    pub tick: i64,
    /// Mission time, nanoseconds.
    pub sim_ns: i64,
}

impl At {
    /// The moment of an event.
    pub(crate) fn of(event: &mission::Event) -> Self {
        Self { tick: event.tick as i64, sim_ns: (event.t_s * 1e9).round() as i64 }
    }
}

/// A recording that is being written.
pub(crate) struct Stream {
    inner: rr::RecordingStream,
    began_ns: Option<i64>,
}

type Done = Result<(), RecordingError>;

impl Stream {
    /// Starts a recording.
    pub(crate) fn open(sink: SafeSink, identity: &Identity) -> Result<Self, RecordingError> {
        let builder =
            rr::RecordingStreamBuilder::new(APPLICATION).recording_id(identity.recording_id.clone());
        let (_, store, _, _, hooks, _) = builder.into_args();
        // The start comes from the name, not from the clock: two recordings of one run must not differ.
        let info = rr::RecordingInfo::update_fields().with_name(identity.name.clone());
        let info = match identity.began_ns {
            Some(began_ns) => info.with_start_time(began_ns),
            None => info,
        };
        let batcher =
            rr::ChunkBatcherConfig { flush_tick: Duration::from_secs(5), ..rr::ChunkBatcherConfig::DEFAULT };
        let inner = rr::RecordingStream::new(store, Some(info), Some(batcher), hooks, Box::new(sink));
        let inner = inner.map_err(|error| RecordingError::sdk(&error))?;
        inner.set_log_time_enabled(false);
        inner.set_log_tick_enabled(false);
        Ok(Self { inner, began_ns: identity.began_ns })
    }

    /// Logs data that applies to the whole recording.
    pub(crate) fn always(&self, path: &str, what: &dyn rr::AsComponents) -> Done {
        self.inner.log_static(path, what).map_err(|error| RecordingError::sdk(&error))
    }

    /// Logs a property of the recording.
    pub(crate) fn property(&self, name: &str, values: &rr::AnyValues) -> Done {
        self.inner.send_property(name, values).map_err(|error| RecordingError::sdk(&error))
    }

    /// Logs data at a moment.
    pub(crate) fn once(&self, path: &str, at: At, what: &dyn rr::AsComponents) -> Done {
        self.inner.set_time_sequence(TICK, at.tick);
        self.inner.set_time(SIM_TIME, rr::TimeCell::from_duration_nanos(at.sim_ns));
        if let Some(began_ns) = self.began_ns {
            self.inner.set_time(UTC, rr::TimeCell::from_timestamp_nanos_since_epoch(began_ns + at.sim_ns));
        }
        self.inner.log(path, what).map_err(|error| RecordingError::sdk(&error))
    }

    /// Sends many moments of one entity as one chunk.
    pub(crate) fn columns(&self, path: &str, at: &[At], columns: Vec<rr::SerializedComponentColumn>) -> Done {
        let utc = self.began_ns.map(|began_ns| {
            rr::TimeColumn::new_timestamp_nanos_since_epoch(UTC, at.iter().map(|at| began_ns + at.sim_ns))
        });
        let times = [
            rr::TimeColumn::new_sequence(TICK, at.iter().map(|at| at.tick)),
            rr::TimeColumn::new_duration_nanos(SIM_TIME, at.iter().map(|at| at.sim_ns)),
        ];
        let times = times.into_iter().chain(utc);
        self.inner.send_columns(path, times, columns).map_err(|error| RecordingError::sdk(&error))
    }

    /// Sends the layout.
    pub(crate) fn layout(&self, (messages, activation): (Vec<rr::LogMsg>, rr::BlueprintActivationCommand)) {
        self.inner.send_blueprint(messages, activation);
    }

    /// Starts sending everything logged so far to the file, and does not wait until it is written.
    pub(crate) fn flush(&self) {
        // The sink does not return its error here; it must be read from the sink.
        let _ = self.inner.flush_async();
    }
}
