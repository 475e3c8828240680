//! The shell around the pure part: takes over the terminal and always restores it.

mod backend;
mod cells;
mod clipboard;
mod decode;
mod key;
mod meter;
mod output;
mod pointer;
mod ration;
mod restore;

pub use decode::{Decoder, Gesture, Input, Pointed};
pub use key::Keyboard;
pub use meter::Sent;
pub use pointer::Pointer;
pub use restore::{RESTORE, install_panic_hook, restore, restore_from_signal};

use backend::Thrifty;
use crossterm::event::{EnableBracketedPaste, EnableFocusChange};
use crossterm::terminal::{Clear, ClearType, EnterAlternateScreen, enable_raw_mode};
use crossterm::{cursor, execute, queue};
use meter::Meter;
use output::FrameOutput;
use ratatui::{Frame, Terminal};
use ration::Ration;
use std::io::{self, Write};
use std::time::Duration;

/// Turns on mouse reports: buttons, wheel and dragging, with coordinates of any size.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// Turns off mouse reports.
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1002l\x1b[?1000l";

/// Owns the terminal while the console uses it; restores the terminal when dropped.
///
/// The thread that calls [`Self::enter`] owns the terminal; a panic in any other thread does not restore it.
pub struct TerminalGuard {
    terminal: Terminal<Thrifty>,
    has_mouse: bool,
    meter: Meter,
    ration: Ration,
    /// The bytes that a slow line takes in a short time; `None` if the line is not slow.
    most: Option<usize>,
    /// Whether the last frame left out rows.
    is_behind: bool,
}

impl TerminalGuard {
    /// Takes over the terminal: raw mode, alternate screen, bracketed paste, focus reports. `clock` is a clock that never
    /// goes back, with which the line to the terminal is measured.
    ///
    /// # Errors
    /// Fails if there is no terminal or writing to it fails; the terminal is restored first.
    pub fn enter(clock: fn() -> Duration) -> io::Result<Self> {
        restore::own();
        let meter = Meter::new(clock);
        let open = || {
            take_over()?;
            Terminal::new(Thrifty::new(FrameOutput::measured(meter.clone())))
        };
        match open() {
            Ok(terminal) => Ok(Self {
                terminal,
                has_mouse: false,
                meter,
                ration: Ration::default(),
                most: None,
                is_behind: false,
            }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Draws a frame: sends the changes since the last frame as one synchronized update. A slow line gets the state of the
    /// robot, and the other rows in the frames that follow. Returns what was sent.
    ///
    /// # Errors
    /// Fails if writing to the terminal fails.
    pub fn draw(&mut self, view: impl FnOnce(&mut Frame)) -> io::Result<Sent> {
        let Self { terminal, ration, most, is_behind, .. } = self;
        let shown = terminal.draw(|frame| {
            view(frame);
            *is_behind = most.is_some_and(|most| ration.limit(frame.buffer_mut(), most));
        })?;
        ration.shows(shown.buffer);
        Ok(self.meter.take())
    }

    /// Whether the last frame left out rows, so that another one must follow.
    pub fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// Sets the bytes that a slow line takes in a short time; `None` if the line is not slow. A terminal on a slow line shows
    /// frames while they arrive.
    pub fn set_slow(&mut self, most: Option<usize>) {
        self.most = most;
        self.meter.set_slow(most.is_some());
    }

    /// Makes the next frame draw every cell, without querying the terminal.
    ///
    /// # Errors
    /// Fails if writing to the terminal fails.
    pub fn redraw(&mut self) -> io::Result<()> {
        queue!(self.terminal.backend_mut(), Clear(ClearType::All))?;
        // Both buffers are now blank, so every cell counts as changed.
        self.terminal.swap_buffers();
        self.ration.is_cleared();
        Ok(())
    }

    /// Copies text to the terminal's clipboard, if the terminal allows this; the terminal does not confirm it.
    ///
    /// # Errors
    /// Fails if writing to the terminal fails.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        let out = self.terminal.backend_mut();
        out.write_all(clipboard::sequence(text).as_bytes())?;
        out.flush()
    }

    /// Temporarily restores the terminal before the process is stopped.
    pub fn suspend(&mut self) {
        restore();
    }

    /// Takes over the terminal again; the next frame draws every cell.
    ///
    /// # Errors
    /// Fails if writing to the terminal fails.
    pub fn resume(&mut self) -> io::Result<()> {
        restore::own();
        take_over()?;
        self.take_mouse(self.has_mouse)?;
        self.redraw()
    }

    /// Turns mouse capture on or off: buttons, wheel and dragging, but not plain movement.
    ///
    /// # Errors
    /// Fails if writing to the terminal fails.
    pub fn take_mouse(&mut self, taken: bool) -> io::Result<()> {
        if taken != self.has_mouse || taken {
            let mut output = io::stdout();
            output.write_all(if taken { MOUSE_ON } else { MOUSE_OFF })?;
            output.flush()?;
        }
        self.has_mouse = taken;
        Ok(())
    }
}

impl Drop for TerminalGuard {
    fn drop(&mut self) {
        restore();
    }
}

fn take_over() -> io::Result<()> {
    enable_raw_mode()?;
    execute!(io::stdout(), EnterAlternateScreen, EnableBracketedPaste, EnableFocusChange, cursor::Hide)
}
