//! Messages of an MCAP file whose content is a JSON object, each a row.

use crate::problem::Problem;
use csv::StringRecord;
use mcap::{
    parse_record,
    records::Record,
    sans_io::linear_reader::{LinearReadEvent, LinearReader},
};
use serde_json::{Map, Value};
use std::{collections::HashMap, fs::File, io::Read};

/// The messages of a file, in the order of the file.
pub(crate) struct Messages {
    file: File,
    reader: LinearReader,
    /// Topic and encoding of each channel.
    channels: HashMap<u16, (String, String)>,
    header: StringRecord,
    /// The message that gave the header.
    first: Option<Map<String, Value>>,
    count: u64,
}

impl Messages {
    /// The messages of a file; the keys of the first one are the names of the columns.
    pub(crate) fn open(file: File) -> Result<Self, String> {
        let mut messages = Self {
            file,
            reader: LinearReader::new(),
            channels: HashMap::new(),
            header: StringRecord::new(),
            first: None,
            count: 0,
        };
        let first = messages.message().map_err(|problem| problem.to_string())?;
        let first =
            first.ok_or("no messages; each is to be a JSON object, as {\"t_s\": 0.5, \"station\": \"A\"}")?;
        messages.header = first.keys().map(String::as_str).collect();
        messages.first = Some(first);
        Ok(messages)
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
                let what = format!("the first message had no `{new}`");
                Err(Problem { line: self.count, column: None, what, is_end: false })
            }
            None => Ok(Some(self.count)),
        }
    }

    /// The next message.
    fn message(&mut self) -> Result<Option<Map<String, Value>>, Problem> {
        let Self { file, reader, channels, count, .. } = self;
        let problem = |line: u64, what: String| Problem { line, column: None, what, is_end: false };
        let damaged = |line: u64, error: &dyn std::fmt::Display| Problem {
            is_end: true,
            ..problem(line, format!("damaged MCAP: {error}"))
        };
        while let Some(event) = reader.next_event() {
            match event.map_err(|error| damaged(*count + 1, &error))? {
                LinearReadEvent::ReadRequest(length) => {
                    let read = file.read(reader.insert(length));
                    reader.notify_read(read.map_err(|error| damaged(*count, &error))?);
                }
                LinearReadEvent::Record { opcode, data } => match parse_record(opcode, data) {
                    Ok(Record::Channel(channel)) => {
                        channels.insert(channel.id, (channel.topic, channel.message_encoding));
                    }
                    Ok(Record::Message { header, data }) => {
                        *count += 1;
                        let row = object(channels.get(&header.channel_id), &data);
                        return row.map(Some).map_err(|what| problem(*count, what));
                    }
                    Ok(_) => {}
                    Err(error) => return Err(damaged(*count, &error)),
                },
            }
        }
        Ok(None)
    }
}

/// The object that a message holds.
fn object(channel: Option<&(String, String)>, data: &[u8]) -> Result<Map<String, Value>, String> {
    let (topic, encoding) = channel.ok_or("damaged MCAP: a message without a channel")?;
    if encoding != "json" {
        return Err(format!("topic {topic} is encoded as `{encoding}`; readings are JSON objects"));
    }
    serde_json::from_slice(data).map_err(|error| format!("topic {topic}: no JSON object: {error}"))
}
