//! The thread that computes: takes what was asked last, tells each part of the answer as it is ready, and stops when told to.
//!
//! One thread, one task at a time; the library shares its work among the cores itself. Of requests only the latest waits: while
//! a slider is dragged the run under way gets on to its first answer, or for a quarter of a second, and gives way then, so that
//! the view follows the hand and does not starve.

mod asking;
mod cache;
mod steps;
mod watch;

pub use steps::stand_m;
pub use watch::Watch;

use crate::request::Request;
use crate::results::{Answer, Failed, Results};
use crate::state::Running;
use cache::Cache;
use lightvein::job::Cancel;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// Something to be done.
#[derive(Debug)]
pub enum Task {
    /// Answers a request; of several only the latest is done.
    Answer(Box<Request>),
    /// Writes the files of the analysis into a folder.
    Export(PathBuf, Box<Results>),
    /// Measures every method at every quality, for the chart.
    Measure(Box<Results>, u64),
}

/// What the worker tells.
pub enum Told {
    /// The results so far, and the request that they belong to.
    Found(Box<Request>, Box<Results>),
    /// The request was answered in full.
    Answered(Box<Request>),
    /// Every method at every quality, and the results that they belong to.
    Measured(Box<Results>, Vec<Answer>),
    /// Files were written, into this folder.
    Written(PathBuf, usize),
    /// The task gave nothing, or nothing more.
    Failed {
        /// What it was about: a file, a folder.
        about: String,
        /// Why.
        why: Failed,
        /// Whether it was a request; another task leaves what is shown as it is.
        of_request: bool,
    },
}

/// The thread and the ways to it. Dropping it stops the thread.
pub struct Worker {
    shared: Arc<Shared>,
    told: Receiver<Told>,
    thread: Option<JoinHandle<()>>,
}

/// What both sides see.
struct Shared {
    inbox: Mutex<Inbox>,
    filled: Condvar,
    watch: Watch,
}

#[derive(Default)]
struct Inbox {
    latest: Option<Box<Request>>,
    others: Vec<Task>,
    under_way: Option<UnderWay>,
    forgets: bool,
    closes: bool,
}

struct UnderWay {
    cancel: Arc<Cancel>,
    source: Option<crate::request::Source>,
}

impl Worker {
    /// Starts the thread. `wake` is called whenever there is something new to show.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let shared =
            Arc::new(Shared { inbox: Mutex::default(), filled: Condvar::new(), watch: Watch::new(Arc::clone(&wake)) });
        let (tell, told) = channel();
        let of_thread = Arc::clone(&shared);
        let work = move || of_thread.work(&tell, &*wake);
        let thread = std::thread::Builder::new().name("worker".to_owned()).spawn(work)?;
        Ok(Self { shared, told, thread: Some(thread) })
    }

    /// Asks for something. A request replaces one that waits, and has the one under way give way once it has shown something.
    pub fn ask(&self, task: Task) {
        let mut inbox = self.shared.lock();
        match task {
            Task::Answer(request) => {
                if let Some(UnderWay { cancel, source: Some(source) }) = &inbox.under_way {
                    // Another scene: nothing of the old one will be looked at.
                    if *source != request.source {
                        cancel.cancel();
                    }
                    self.shared.watch.supersede();
                }
                inbox.latest = Some(request);
            }
            other => inbox.others.push(other),
        }
        drop(inbox);
        self.shared.filled.notify_one();
    }

    /// Forgets what is known of files, so that the next request reads them again.
    pub fn forget(&self) {
        self.shared.lock().forgets = true;
    }

    /// Stops what is under way and what waits.
    pub fn cancel(&self) {
        let mut inbox = self.shared.lock();
        inbox.latest = None;
        inbox.others.clear();
        if let Some(under_way) = &inbox.under_way {
            under_way.cancel.cancel();
        }
    }

    /// What was told since the last look.
    pub fn told(&self) -> Vec<Told> {
        self.told.try_iter().collect()
    }

    /// How the run goes.
    pub fn running(&self) -> Running {
        let inbox = self.shared.lock();
        match (&inbox.under_way, inbox.latest.is_some() || !inbox.others.is_empty()) {
            (Some(_), _) => self.shared.watch.running(),
            (None, true) => Running::Stage { name: "waiting".to_owned(), share: None, seconds: 0.0 },
            (None, false) => Running::Idle,
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.cancel();
        self.shared.lock().closes = true;
        self.shared.filled.notify_one();
        if let Some(thread) = self.thread.take() {
            // A panic in it was told already.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Inbox> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The thread's life: one task after the other.
    fn work(&self, tell: &Sender<Told>, wake: &dyn Fn()) {
        let mut cache = Cache::default();
        while let Some((task, cancel)) = self.next(&mut cache) {
            self.watch.begin_run(Arc::clone(&cancel));
            let (about, of_request) = match &task {
                Task::Answer(request) => (request.source.name(), true),
                Task::Export(folder, _) => (folder.display().to_string(), false),
                Task::Measure(..) => ("chart".to_owned(), false),
            };
            let done = catch_unwind(AssertUnwindSafe(|| self.run(task, &mut cache, &cancel, tell, wake)));
            let done = done.unwrap_or_else(|panic| {
                cache = Cache::default();
                Err(Failed::Because(anyhow::anyhow!("an error in the program itself: {}", words(&*panic))))
            });
            // A request that gave way to a newer one is not worth a word.
            let gave_way = self.lock().latest.is_some();
            if let Err(why) = done
                && !(gave_way && of_request && matches!(why, Failed::Cancelled))
            {
                // Nobody listens once the window is closed.
                let _ = tell.send(Told::Failed { about, why, of_request });
            }
            self.lock().under_way = None;
            self.watch.end_run();
            wake();
        }
    }

    /// Waits for a task; `None` when the window closes.
    fn next(&self, cache: &mut Cache) -> Option<(Task, Arc<Cancel>)> {
        let mut inbox = self.lock();
        loop {
            if inbox.closes {
                return None;
            }
            if std::mem::take(&mut inbox.forgets) {
                *cache = Cache::default();
            }
            let task = match inbox.latest.take() {
                Some(request) => Some(Task::Answer(request)),
                None if !inbox.others.is_empty() => Some(inbox.others.remove(0)),
                None => None,
            };
            if let Some(task) = task {
                let cancel = Arc::new(Cancel::new());
                let source = if let Task::Answer(request) = &task { Some(request.source.clone()) } else { None };
                inbox.under_way = Some(UnderWay { cancel: Arc::clone(&cancel), source });
                return Some((task, cancel));
            }
            inbox = self.filled.wait(inbox).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn run(
        &self,
        task: Task,
        cache: &mut Cache,
        cancel: &Cancel,
        tell: &Sender<Told>,
        wake: &dyn Fn(),
    ) -> Result<(), Failed> {
        match task {
            Task::Answer(request) => {
                let mut found = |results: &Results| {
                    let mut results = results.clone();
                    results.stages = self.watch.stages();
                    let _ = tell.send(Told::Found(request.clone(), Box::new(results)));
                    self.watch.has_shown();
                    wake();
                };
                let results = steps::answer(&request, cache, &self.watch, cancel, &mut found)?;
                found(&results);
                let _ = tell.send(Told::Answered(request));
            }
            Task::Export(folder, results) => {
                let written = steps::export(&folder, &results, &self.watch, cancel)?;
                let _ = tell.send(Told::Written(folder, written));
            }
            Task::Measure(results, seed) => {
                let rungs = asking::every_quality(&results, seed, &self.watch, cancel)?;
                let _ = tell.send(Told::Measured(results, rungs));
            }
        }
        Ok(())
    }
}

/// What a panic said.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no reason given".to_owned())
}
