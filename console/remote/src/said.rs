//! The last lines that an adapter wrote to its standard error. They must not reach the terminal, because the console
//! draws on it. They show why an adapter has ended.

use std::{
    collections::VecDeque,
    io::Read,
    sync::{Arc, Condvar, Mutex, PoisonError},
    thread,
    time::Duration,
};

/// Maximum number of lines kept.
const MOST_LINES: usize = 3;
/// Maximum number of bytes kept of a line.
const LINE_BYTES: usize = 160;
/// Longest time that the last lines may take to arrive after the end of the adapter's messages.
const LAST_WITHIN: Duration = Duration::from_millis(300);

/// The lines of an adapter so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Said(Arc<(Mutex<Lines>, Condvar)>);

#[derive(Debug, Default)]
struct Lines {
    kept: VecDeque<String>,
    /// The beginning of a line that has not ended yet.
    rest: Vec<u8>,
    /// Whether more lines may follow.
    is_open: bool,
}

impl Said {
    /// Reads on a separate thread until the stream ends.
    pub(crate) fn listen(mut stderr: impl Read + Send + 'static) -> std::io::Result<Self> {
        let said = Self::default();
        said.with(|lines| lines.is_open = true);
        let heard = said.clone();
        thread::Builder::new().name("adapter stderr".into()).spawn(move || {
            let mut chunk = [0; 4096];
            while let Ok(n @ 1..) = stderr.read(&mut chunk) {
                heard.with(|lines| lines.take(&chunk[..n]));
            }
            heard.with(|lines| {
                lines.take(b"\n");
                lines.is_open = false;
            });
            heard.0.1.notify_all();
        })?;
        Ok(said)
    }

    /// The last lines after the adapter has ended; `None` if it wrote none.
    pub(crate) fn at_end(&self) -> Option<String> {
        let lines = self.0.0.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self.0.1.wait_timeout_while(lines, LAST_WITHIN, |lines| lines.is_open);
        let lines = waited.unwrap_or_else(PoisonError::into_inner).0;
        let kept: Vec<&str> = lines.kept.iter().map(String::as_str).collect();
        (!kept.is_empty()).then(|| kept.join(" / "))
    }

    fn with(&self, change: impl FnOnce(&mut Lines)) {
        change(&mut self.0.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Lines {
    fn take(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if *byte != b'\n' {
                if self.rest.len() < LINE_BYTES {
                    self.rest.push(*byte);
                }
                continue;
            }
            let line = String::from_utf8_lossy(&std::mem::take(&mut self.rest)).into_owned();
            let line = foreign::plain(line.trim()).into_owned();
            if !line.is_empty() {
                self.kept.push_back(line);
            }
            if self.kept.len() > MOST_LINES {
                self.kept.pop_front();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Address, Remote};

    #[test]
    fn the_last_lines_of_an_adapter_say_why_it_ended() {
        let command = r"seq 1 1000 >&2; printf 'battery: \033[1mflat\n\nno robot' >&2";
        let failed = Remote::connect(&Address::Run(command.into()), false, &[]).map(|_| ()).unwrap_err();
        let said = failed.to_string();
        assert!(said.contains("it wrote: 1000 / battery:") && said.contains("/ no robot"), "{said}");
        assert!(!said.contains('\u{1b}'), "{said}");
    }

    #[test]
    fn lines_without_an_end_are_cut() {
        let said = Said::listen(std::io::repeat(b'x').take(1 << 20)).unwrap();
        let text = loop {
            // The thread may be slow.
            if let Some(text) = said.at_end() {
                break text;
            }
        };
        assert_eq!(text, "x".repeat(LINE_BYTES));
    }
}
