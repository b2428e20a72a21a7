//! Times the stages that the library reports, draws their bars on a terminal, and reads the peak of memory after each.

use crate::job::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A stage that has ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// How many stages it stood within.
    pub depth: usize,
    /// How long it took.
    pub seconds: f64,
    /// The most memory the process had taken by its end, MB; `None` where the system does not tell.
    pub peak_memory_mb: Option<f64>,
}

/// The stages of a run.
#[derive(Debug)]
pub struct Stages {
    state: Mutex<State>,
    is_shown: bool,
}

#[derive(Debug, Default)]
struct State {
    open: Vec<Open>,
    ended: Vec<Stage>,
}

/// A stage under way; `slot` is its place in the list of the ended, so that stages stand in the order in which they began.
#[derive(Debug)]
struct Open {
    slot: usize,
    began: Instant,
    bar: ProgressBar,
}

/// Bars of stages shorter than this would only flicker.
const FIRST_DRAWN_AFTER: Duration = Duration::from_millis(300);

impl Stages {
    /// No stages yet; draws bars on stderr where that is a terminal.
    pub fn new(is_shown: bool) -> Self {
        Self { state: Mutex::default(), is_shown }
    }

    /// All stages so far, in the order in which they began.
    pub fn ended(&self) -> Vec<Stage> {
        self.lock().ended.clone()
    }

    /// Seconds of all outermost stages of that name together.
    pub fn seconds_of(&self, name: &str) -> f64 {
        let state = self.lock();
        state.ended.iter().filter(|stage| stage.depth == 0 && stage.name == name).map(|stage| stage.seconds).sum()
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn bar(&self, name: &str, depth: usize, total: u64) -> ProgressBar {
        if !self.is_shown {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::with_draw_target((total > 0).then_some(total), ProgressDrawTarget::stderr_with_hz(10));
        let template = if total > 0 {
            "{prefix}{msg:24} {bar:40} {percent:>3}% {eta}"
        } else {
            "{prefix}{msg:24} {spinner} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_prefix("  ".repeat(depth));
        bar.set_message(name.to_owned());
        bar.enable_steady_tick(FIRST_DRAWN_AFTER);
        bar
    }
}

impl Progress for Stages {
    fn begin(&self, stage: &str, total: u64) {
        let mut state = self.lock();
        let depth = state.open.len();
        let bar = self.bar(stage, depth, total);
        let slot = state.ended.len();
        state.ended.push(Stage { name: stage.to_owned(), depth, seconds: 0.0, peak_memory_mb: None });
        state.open.push(Open { slot, began: Instant::now(), bar });
    }

    fn advance(&self, units: u64) {
        if let Some(open) = self.lock().open.last() {
            open.bar.inc(units);
        }
    }

    fn end(&self) {
        let mut state = self.lock();
        let Some(open) = state.open.pop() else { return };
        open.bar.finish_and_clear();
        if let Some(stage) = state.ended.get_mut(open.slot) {
            stage.seconds = open.began.elapsed().as_secs_f64();
            stage.peak_memory_mb = peak_memory_mb();
        }
    }
}

/// The most memory this process has had resident, MB (1e6 bytes), as Linux tells it; `None` elsewhere.
pub fn peak_memory_mb() -> Option<f64> {
    kilobytes("/proc/self/status", "VmHWM:").map(|kilobytes| kilobytes * 1024.0 / 1e6)
}

/// Memory that can be taken without swapping, bytes, as Linux tells it; `None` elsewhere.
pub fn available_bytes() -> Option<u64> {
    kilobytes("/proc/meminfo", "MemAvailable:").map(|kilobytes| (kilobytes * 1024.0) as u64)
}

/// Processor time that all threads of this process have had, seconds, as Linux tells it; `None` elsewhere.
pub fn processor_seconds() -> Option<f64> {
    let threads = std::fs::read_dir("/proc/self/task").ok()?;
    // A thread may end while the list is read.
    let nanoseconds = threads.filter_map(|thread| {
        let text = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    });
    let nanoseconds: Vec<f64> = nanoseconds.collect();
    (!nanoseconds.is_empty()).then(|| nanoseconds.iter().sum::<f64>() / 1e9)
}

/// The entry of that name in one of Linux's tables of sizes.
fn kilobytes(table: &str, name: &str) -> Option<f64> {
    let text = std::fs::read_to_string(table).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn processor_time_passes_while_work_is_done() {
        let before = processor_seconds().unwrap();
        let sum: u64 = (0..20_000_000_u64).map(std::hint::black_box).sum();
        assert!(sum > 0 && processor_seconds().unwrap() > before);
    }

    #[test]
    fn stages_nest_and_keep_their_order() {
        let stages = Stages::new(false);
        stages.begin("voxels", 0);
        stages.begin("flood", 10);
        stages.advance(10);
        stages.end();
        stages.end();
        stages.begin("skeleton", 0);
        stages.end();
        let seen: Vec<_> = stages.ended().into_iter().map(|stage| (stage.name, stage.depth)).collect();
        assert_eq!(seen, [("voxels".to_owned(), 0), ("flood".to_owned(), 1), ("skeleton".to_owned(), 0)]);
        assert!(stages.seconds_of("voxels") >= stages.seconds_of("flood"));
    }
}
