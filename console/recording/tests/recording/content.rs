//! The content of a recording, regardless of its division into chunks.

use re_log_encoding::DecoderApp;
use rerun::{
    StoreKind,
    external::arrow::{
        array::{Array, ArrayRef},
        util::display::{ArrayFormatter, FormatOptions},
    },
    log::{Chunk, LogMsg},
};
use std::{collections::BTreeMap, fs::File, io::BufReader, path::Path};

/// Entity and component.
pub(crate) type Key = (String, String);
/// Timelines with their times, and the value as text.
pub(crate) type Row = (Vec<(String, i64)>, String);
/// Every value of a recording, in order of time.
pub(crate) type Content = BTreeMap<Key, Vec<Row>>;

/// Decodes a recording.
pub(crate) fn content(path: &Path) -> Content {
    let mut content = Content::new();
    for message in DecoderApp::decode_lazy(BufReader::new(File::open(path).expect("the file is there"))) {
        if let LogMsg::ArrowMsg(store, arrow) = message.expect("the file is whole")
            && store.kind() == StoreKind::Recording
        {
            take(&Chunk::from_arrow_msg(&arrow).expect("a chunk"), &mut content);
        }
    }
    for rows in content.values_mut() {
        rows.sort();
    }
    content
}

/// The number of chunks of data in a recording.
pub(crate) fn chunks(path: &Path) -> usize {
    let messages = DecoderApp::decode_lazy(BufReader::new(File::open(path).expect("the file is there")));
    let is_data = |message: &LogMsg| matches!(message, LogMsg::ArrowMsg(store, _) if store.kind() == StoreKind::Recording);
    messages.filter(|message| is_data(message.as_ref().expect("the file is whole"))).count()
}

fn take(chunk: &Chunk, content: &mut Content) {
    let entity = chunk.entity_path().to_string().trim_start_matches('/').to_owned();
    for component in chunk.components_identifiers() {
        let lists = chunk.components().get_array(component).expect("listed above");
        for row in (0..chunk.num_rows()).filter(|row| lists.is_valid(*row)) {
            let mut times: Vec<_> = chunk
                .timelines()
                .iter()
                .map(|(name, column)| (name.to_string(), column.times_raw()[row]))
                .collect();
            times.sort();
            let rows = content.entry((entity.clone(), component.to_string())).or_default();
            rows.push((times, full(&lists.value(row))));
        }
    }
}

/// Every element as text; the short form would leave out the middle of long ones.
fn full(array: &ArrayRef) -> String {
    let options = FormatOptions::default().with_null("null");
    let formatter = ArrayFormatter::try_new(array.as_ref(), &options).expect("every type can be shown");
    (0..array.len()).map(|index| formatter.value(index).to_string()).collect::<Vec<_>>().join(" ")
}
