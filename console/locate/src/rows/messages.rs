//! Reads an MCAP file in which each JSON message gives one row.

use crate::problem::Problem;
use csv::StringRecord;
use mcap::{
    parse_record,
    records::Record,
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};
use serde_json::{Map, Value};
use std::{collections::HashMap, fs::File, io::Read};

/// The longest record that is read, bytes. A damaged length must not cause huge amounts of memory to be allocated.
const LONGEST_RECORD: usize = 64_000_000;

/// The longest message that is accepted as a row, bytes.
const LONGEST_ROW: usize = 1 << 16;
/// Maximum ratio of the length of the unpacked records, less `FREE_BYTES`, to the number of bytes read.
const MOST_EXPANSION: u64 = 1000;
const FREE_BYTES: u64 = 64 << 20;

/// The messages of a file, in file order.
pub(crate) struct Messages {
    file: File,
    reader: LinearReader,
    /// Topic and encoding of each channel.
    channels: HashMap<u16, (String, String)>,
    header: StringRecord,
    /// The first message, kept until it is returned as a row; its keys form the header.
    first: Option<Map<String, Value>>,
    count: u64,
    /// The number of bytes read, and the number of bytes of the unpacked records.
    read: u64,
    held: u64,
}

impl Messages {
    /// Opens a file; the keys of its first message name the columns.
    pub(crate) fn open(file: File) -> Result<Self, String> {
        let mut messages = Self {
            file,
            reader: LinearReader::new_with_options(
                LinearReaderOptions::default().with_record_length_limit(LONGEST_RECORD),
            ),
            channels: HashMap::new(),
            header: StringRecord::new(),
            first: None,
            count: 0,
            read: 0,
            held: 0,
        };
        let first = messages.message().map_err(|problem| problem.to_string())?;
        let first = first.ok_or_else(|| {
            format!(
                "no readings; each must be a message with a JSON object such as \
                 {{\"t_s\": 0.5, \"station\": \"A\"}}; topics: {}",
                messages.topics()
            )
        })?;
        messages.header = first.keys().map(String::as_str).collect();
        messages.first = Some(first);
        Ok(messages)
    }

    /// Lists the topics, each with its encoding, for people.
    fn topics(&self) -> String {
        let mut topics: Vec<String> =
            self.channels.values().map(|(topic, encoding)| format!("{topic} ({encoding})")).collect();
        topics.sort();
        if topics.is_empty() { "none".into() } else { topics.join(", ") }
    }

    pub(crate) fn header(&self) -> &StringRecord {
        &self.header
    }

    pub(crate) fn next(&mut self, cells: &mut StringRecord) -> Result<Option<u64>, Problem> {
        let message = match self.first.take() {
            Some(first) => first,
            None => match self.message()? {
                Some(message) => message,
                None => return Ok(None),
            },
        };
        cells.clear();
        for name in &self.header {
            match message.get(name) {
                None | Some(Value::Null) => cells.push_field(""),
                Some(Value::String(text)) => cells.push_field(text),
                Some(other) => cells.push_field(&other.to_string()),
            }
        }
        match message.keys().find(|key| !self.header.iter().any(|name| name == *key)) {
            Some(new) => {
                let what = format!("the key `{new}` is missing from the first message");
                Err(Problem { line: self.count, column: None, what, is_end: false })
            }
            None => Ok(Some(self.count)),
        }
    }

    /// Returns the next message.
    fn message(&mut self) -> Result<Option<Map<String, Value>>, Problem> {
        let Self { file, reader, channels, count, read, held, .. } = self;
        let problem = |line: u64, what: String| Problem { line, column: None, what, is_end: false };
        let damaged = |line: u64, error: &dyn std::fmt::Display| Problem {
            is_end: true,
            ..problem(line, format!("damaged MCAP: {error}"))
        };
        while let Some(event) = reader.next_event() {
            match event.map_err(|error| damaged(*count + 1, &error))? {
                LinearReadEvent::ReadRequest(length) => {
                    let length = file.read(reader.insert(length)).map_err(|error| damaged(*count, &error))?;
                    *read += length as u64;
                    reader.notify_read(length);
                }
                // No record has this number. A file that was never written contains only zeros.
                LinearReadEvent::Record { opcode: 0, .. } => {
                    return Err(damaged(*count + 1, &"record of kind 0"));
                }
                LinearReadEvent::Record { data, .. }
                    if {
                        *held += data.len() as u64;
                        *held > FREE_BYTES + MOST_EXPANSION * *read
                    } =>
                {
                    return Err(damaged(*count, &"it unpacks to more data than any valid recording holds"));
                }
                LinearReadEvent::Record { opcode, data } => match parse_record(opcode, data) {
                    Ok(Record::Channel(channel)) => {
                        channels.insert(channel.id, (channel.topic, channel.message_encoding));
                    }
                    Ok(Record::Message { header, data }) => {
                        *count += 1;
                        let Some((topic, encoding)) = channels.get(&header.channel_id) else {
                            return Err(damaged(*count, &"message without a channel"));
                        };
                        // Other topics of a recording are ignored.
                        if encoding == "json" && data.len() > LONGEST_ROW {
                            return Err(problem(
                                *count,
                                format!("topic {topic}: message is too long: {} bytes", data.len()),
                            ));
                        }
                        if encoding == "json" {
                            let row = serde_json::from_slice(&data);
                            let bad =
                                |error| problem(*count, format!("topic {topic}: not a JSON object: {error}"));
                            return row.map(Some).map_err(bad);
                        }
                    }
                    Ok(_) => {}
                    Err(error) => return Err(damaged(*count, &error)),
                },
            }
        }
        Ok(None)
    }
}
