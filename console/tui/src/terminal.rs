//! The shell around the pure part: takes the terminal over and always gives it back.

mod clipboard;
mod key;
mod output;
mod pointer;
mod restore;

pub use key::Keyboard;
pub use pointer::Pointer;
pub use restore::{RESTORE, install_panic_hook, restore, restore_from_signal};

use crossterm::event::{EnableBracketedPaste, EnableFocusChange};
use crossterm::terminal::{Clear, ClearType, EnterAlternateScreen, enable_raw_mode};
use crossterm::{cursor, execute, queue};
use output::FrameOutput;
use ratatui::backend::CrosstermBackend;
use ratatui::{Frame, Terminal};
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Reports of buttons and wheel, of movement with a button down, in a form without bounds.
const MOUSE_ON: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// No reports of the mouse.
const MOUSE_OFF: &[u8] = b"\x1b[?1006l\x1b[?1002l\x1b[?1000l";

/// The terminal while the console has it; gives it back when dropped.
///
/// The thread that enters owns the terminal: a panic of another thread leaves it alone.
pub struct TerminalGuard {
    terminal: Terminal<CrosstermBackend<FrameOutput>>,
    has_mouse: bool,
    sent: Arc<AtomicUsize>,
}

impl TerminalGuard {
    /// Takes the terminal over: raw mode, alternate screen, bracketed paste, reports of focus.
    ///
    /// # Errors
    /// If there is no terminal or it cannot be written to; the terminal is restored before the error is returned.
    pub fn enter() -> io::Result<Self> {
        restore::own();
        let sent = Arc::default();
        let open = || {
            take_over()?;
            Terminal::new(CrosstermBackend::new(FrameOutput::counted(Arc::clone(&sent))))
        };
        match open() {
            Ok(terminal) => Ok(Self { terminal, has_mouse: false, sent }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Draws a frame: what changed since the last one leaves in one write, as one synchronized update. Gives its bytes.
    ///
    /// # Errors
    /// If the terminal cannot be written.
    pub fn draw(&mut self, view: impl FnOnce(&mut Frame)) -> io::Result<usize> {
        self.terminal.draw(view)?;
        Ok(self.sent.swap(0, Ordering::Relaxed))
    }

    /// Makes the next frame draw every cell. The terminal is not asked anything.
    ///
    /// # Errors
    /// If the terminal cannot be written.
    pub fn redraw(&mut self) -> io::Result<()> {
        queue!(self.terminal.backend_mut(), Clear(ClearType::All))?;
        // Both buffers are blank after this, so every cell counts as changed.
        self.terminal.swap_buffers();
        Ok(())
    }

    /// Puts a text into the clipboard of the terminal, if the terminal allows it; it gives no answer.
    ///
    /// # Errors
    /// If the terminal cannot be written.
    pub fn copy(&mut self, text: &str) -> io::Result<()> {
        let out = self.terminal.backend_mut();
        out.write_all(clipboard::sequence(text).as_bytes())?;
        out.flush()
    }

    /// Gives the terminal back for a while, as before stopping the process.
    pub fn suspend(&mut self) {
        restore();
    }

    /// Takes the terminal over again; the next frame draws every cell.
    ///
    /// # Errors
    /// If the terminal cannot be written.
    pub fn resume(&mut self) -> io::Result<()> {
        restore::own();
        take_over()?;
        self.take_mouse(self.has_mouse)?;
        self.redraw()
    }

    /// Takes the mouse from the terminal, or gives it back: buttons, wheel and dragging, but no bare movement.
    ///
    /// # Errors
    /// If the terminal cannot be written.
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
