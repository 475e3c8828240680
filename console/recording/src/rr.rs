//! Every name of the recording SDK that this crate uses, so that the SDK can be replaced in one place.

pub(crate) use re_build_info::CrateVersion;
pub(crate) use re_log_encoding::{DecoderApp, Encoder, EncodingOptions};
pub(crate) use re_sdk_types::{
    AnyValues,
    archetypes::{
        AnnotationContext, Arrows2D, Ellipses2D, LineStrips2D, Points2D, Scalars, SegmentationImage,
        SeriesLines, StateChange, StateConfiguration, TextDocument, TextLog, Transform3D,
    },
    blueprint::{archetypes as view, components as view_part, datatypes as view_data},
    components::{Color, ImageFormat, LineStrip2D, MediaType, Radius, Text, TextLogLevel},
    datatypes::{self, Angle, AnnotationInfo, ChannelDatatype, Rgba32, RotationAxisAngle},
};
pub(crate) use rerun::{
    AsComponents, ComponentIdentifier, RecordingInfo, RecordingStream, RecordingStreamBuilder,
    RecordingStreamError, SerializationError, SerializedComponentBatch, SerializedComponentColumn, StoreId,
    StoreKind, TimeCell, blueprint as bp,
    external::{
        arrow::array::{Array, ArrayRef, Float64Array, UInt64Array},
        re_log_types::BlueprintActivationCommand,
    },
    log::{Chunk, ChunkBatcherConfig, LogMsg, TimeColumn},
    sink::{LogSink, SinkFlushError},
};
