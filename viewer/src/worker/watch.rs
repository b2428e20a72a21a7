//! Hears of the stages of a run: which one runs and how far it is, how long each took, and what memory they took.

use crate::results::Stage;
use crate::state::Running;
use lightvein::job::{Cancel, Progress};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A run that a newer request waits for may go on for so long before it has shown anything.
const PATIENCE: Duration = Duration::from_millis(250);

/// The window is woken for progress at most this often.
const WAKE_EVERY: Duration = Duration::from_millis(100);

/// Hears of the stages of a run.
pub struct Watch {
    run: Mutex<Option<Run>>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

struct Run {
    began: Instant,
    woken: Instant,
    cancel: Arc<Cancel>,
    open: Vec<Open>,
    ended: Vec<Stage>,
    is_superseded: bool,
    has_shown: bool,
}

struct Open {
    slot: usize,
    began: Instant,
    total: u64,
    done: u64,
}

impl Watch {
    /// Hears nothing yet; `wake` is called when there is progress to show.
    pub fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        Self { run: Mutex::new(None), wake }
    }

    /// A run begins; it is stopped by `cancel` when a newer request waits for too long.
    pub fn begin_run(&self, cancel: Arc<Cancel>) {
        let now = Instant::now();
        let (open, ended) = (Vec::new(), Vec::new());
        *self.lock() =
            Some(Run { began: now, woken: now, cancel, open, ended, is_superseded: false, has_shown: false });
    }

    /// The run is over.
    pub fn end_run(&self) {
        *self.lock() = None;
    }

    /// A newer request waits.
    pub fn supersede(&self) {
        self.with(|run| run.is_superseded = true);
    }

    /// The run has shown something: now it may give way.
    pub fn has_shown(&self) {
        self.with(|run| run.has_shown = true);
    }

    /// The stages so far, in the order in which they began.
    pub fn stages(&self) -> Vec<Stage> {
        self.lock().as_ref().map_or_else(Vec::new, |run| run.ended.clone())
    }

    /// How the run goes.
    pub fn running(&self) -> Running {
        let run = self.lock();
        let Some(run) = &*run else { return Running::Idle };
        let names: Vec<&str> =
            run.open.iter().filter_map(|open| Some(run.ended.get(open.slot)?.name.as_str())).collect();
        let known = run.open.iter().rev().find(|open| open.total > 0);
        let share = known.map(|open| open.done as f32 / open.total as f32);
        Running::Stage { name: names.join(", "), share, seconds: run.began.elapsed().as_secs_f64() }
    }

    fn with(&self, change: impl FnOnce(&mut Run)) {
        if let Some(run) = &mut *self.lock() {
            change(run);
            if run.is_superseded && (run.has_shown || run.began.elapsed() > PATIENCE) {
                run.cancel.cancel();
            }
        }
    }

    fn wake_sometimes(&self) {
        let now = Instant::now();
        let mut is_time = false;
        self.with(|run| {
            if now.duration_since(run.woken) > WAKE_EVERY {
                run.woken = now;
                is_time = true;
            }
        });
        if is_time {
            (self.wake)();
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<Run>> {
        self.run.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Progress for Watch {
    fn begin(&self, stage: &str, total: u64) {
        self.with(|run| {
            let (slot, depth) = (run.ended.len(), run.open.len());
            run.ended.push(Stage { name: stage.to_owned(), depth, seconds: 0.0, peak_memory_mb: None });
            run.open.push(Open { slot, began: Instant::now(), total, done: 0 });
        });
        self.wake_sometimes();
    }

    fn advance(&self, units: u64) {
        self.with(|run| {
            if let Some(open) = run.open.last_mut() {
                open.done = (open.done + units).min(open.total);
            }
        });
        self.wake_sometimes();
    }

    fn end(&self) {
        self.with(|run| {
            let Some(open) = run.open.pop() else { return };
            if let Some(stage) = run.ended.get_mut(open.slot) {
                stage.seconds = open.began.elapsed().as_secs_f64();
                stage.peak_memory_mb = peak_memory_mb();
            }
        });
    }
}

/// The most memory this process has had resident, MB (1e6 bytes), as Linux tells it; `None` elsewhere.
fn peak_memory_mb() -> Option<f64> {
    kilobytes("/proc/self/status", "VmHWM:").map(|kilobytes| kilobytes * 1024.0 / 1e6)
}

/// Memory that can be taken without swapping, bytes, as Linux tells it; `None` elsewhere.
pub fn available_bytes() -> Option<u64> {
    kilobytes("/proc/meminfo", "MemAvailable:").map(|kilobytes| (kilobytes * 1024.0) as u64)
}

fn kilobytes(table: &str, name: &str) -> Option<f64> {
    let text = std::fs::read_to_string(table).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
