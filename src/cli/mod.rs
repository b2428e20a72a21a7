//! The program: what was typed (`args`) becomes what will run (`plan`), and runs (`run`).
//!
//! Exit codes: 0 done, 1 bad input or a failed job, 2 wrong usage, 130 interrupted. Tables and JSON go to stdout, bars and
//! warnings to stderr.

mod args;
mod chart;
mod daylight;
mod expose;
mod guide;
mod peer;
mod plan;
mod report;
mod run;
mod sky;
mod stages;
mod stress;
mod table;
mod tolerance;
mod write;

use crate::job::{Cancel, Cancelled};
use clap::Parser;
use std::fmt::Display;
use std::io::Write;
use std::process::ExitCode;

/// Raised by Ctrl-C and by a polite kill.
static CANCEL: Cancel = Cancel::new();

/// Exit code of a run that was interrupted: 128 + SIGINT, as shells have it.
const INTERRUPTED: u8 = 130;

/// Runs the program on the process's own arguments.
pub fn main() -> ExitCode {
    let args = args::Args::parse();
    let second_time_ends_it = || {
        if CANCEL.is_cancelled() {
            std::process::exit(i32::from(INTERRUPTED));
        }
        CANCEL.cancel();
    };
    if let Err(error) = ctrlc::set_handler(second_time_ends_it) {
        tell(format_args!("warning: Ctrl-C will end the program at once: {error}"));
    }

    match run::run(args, &CANCEL) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_interrupt(&error) => {
            tell("interrupted; nothing was written");
            ExitCode::from(INTERRUPTED)
        }
        // A reader that closed the pipe early (`| head`) has had enough; that is not a failure of ours.
        Err(error) if is_closed_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            tell(format_args!("error: {error:#}"));
            ExitCode::FAILURE
        }
    }
}

/// A line on stderr. Where nobody reads it any more (`2>&1 | head`) it is lost, which is no failure of ours.
fn tell(line: impl Display) {
    _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Whether a run ended because it was asked to; a job that stops for Ctrl-C may say so in a library error of its own.
fn is_interrupt(error: &anyhow::Error) -> bool {
    CANCEL.is_cancelled() || error.chain().any(|cause| cause.is::<Cancelled>())
}

fn is_closed_pipe(error: &anyhow::Error) -> bool {
    let io = error.chain().filter_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.into_iter().any(|cause| cause.kind() == std::io::ErrorKind::BrokenPipe)
}
