//! Every name of the recording SDK that this crate uses, so that the SDK can be exchanged in one place.

pub(crate) use re_log_encoding::{DecoderApp, Encoder, EncodingOptions};
pub(crate) use rerun::{
    AnyValues, AsComponents, ComponentIdentifier, RecordingStream, RecordingStreamBuilder,
    RecordingStreamError, SerializationError, SerializedComponentBatch, SerializedComponentColumn, StoreId,
    StoreKind, TimeCell, TimeColumn,
    archetypes::{
        AnnotationContext, Arrows2D, Ellipses2D, LineStrips2D, Points2D, RecordingInfo, Scalars,
        SegmentationImage, SeriesLines, StateChange, StateConfiguration, TextDocument, TextLog, Transform3D,
    },
    blueprint as bp,
    components::{Color, ImageFormat, LineStrip2D, MediaType, Radius, Text, TextLogLevel},
    datatypes::{self, Angle, AnnotationInfo, ChannelDatatype, Rgba32, RotationAxisAngle},
    external::{
        arrow::array::{Array, ArrayRef, Float64Array, UInt64Array},
        re_build_info::CrateVersion,
        re_log_types::BlueprintActivationCommand,
        re_sdk_types::blueprint::{archetypes as view, components as view_part, datatypes as view_data},
    },
    log::{Chunk, ChunkBatcherConfig, LogMsg},
    sink::{LogSink, SinkFlushError},
};
