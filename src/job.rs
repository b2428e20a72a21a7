//! How does a long step report where it is, and how is it stopped?
//!
//! Every step that can take more than a tenth of a second takes a [`Progress`] and a [`Cancel`]. The library never reads
//! the clock and never prints: whoever owns the `Progress` times the stages and draws the bars.

use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that asks a running step to stop. Cheap to read, shared by reference among threads.
#[derive(Debug, Default)]
pub struct Cancel(AtomicBool);

impl Cancel {
    /// A flag that nobody has raised yet; `const`, so that a signal handler can own a static one.
    pub const fn new() -> Self {
        Self(AtomicBool::new(false))
    }

    /// Asks the work that reads this flag to stop; it cannot be taken back.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// `Err(Cancelled)` once somebody asked to stop, for use with `?` inside loops.
    ///
    /// # Errors
    /// [`Cancelled`] when [`Cancel::cancel`] was called.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }
}

/// The step was stopped by its [`Cancel`]; nothing it was to give exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Cancelled;

/// Hears of the stages of a run. All methods may be called from any thread; none may panic.
pub trait Progress: Sync {
    /// A stage begins: its name ("voxels", "collapse"), and how many units of work it has, 0 where that is not known.
    fn begin(&self, stage: &str, total: u64);
    /// So many more units of the current stage are done.
    fn advance(&self, units: u64);
    /// The innermost stage that began has ended; stages nest.
    fn end(&self);
}

/// Hears nothing: for tests, examples and callers that do not show progress.
#[derive(Debug, Clone, Copy, Default)]
pub struct Quiet;

impl Progress for Quiet {
    fn begin(&self, _stage: &str, _total: u64) {}
    fn advance(&self, _units: u64) {}
    fn end(&self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raised_flag_stays_raised() {
        let cancel = Cancel::new();
        assert_eq!(cancel.check(), Ok(()));
        cancel.cancel();
        assert_eq!(cancel.check(), Err(Cancelled));
        assert!(cancel.is_cancelled());
    }
}
