//! The program: arguments, then the window or a picture of it.

use anyhow::{Result, anyhow};
use clap::Parser;
use eframe::{NativeOptions, Renderer};
use lightvein::job::{Cancel, Cancelled};
use lightvein_viewer::app::App;
use lightvein_viewer::args::{Args, Command};
use lightvein_viewer::shadows::study::command;
use lightvein_viewer::shot;
use std::process::ExitCode;

/// Raised by Ctrl-C and by a polite kill while a command runs.
static CANCEL: Cancel = Cancel::new();

/// Exit code of a command that was interrupted: 128 + SIGINT, as shells have it.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    let args = Args::parse();
    match run(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.is::<Cancelled>() => {
            eprintln!("interrupted; nothing was written");
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: Args) -> Result<()> {
    if let Some(Command::Shadows(args)) = &args.command {
        listen_to_ctrl_c();
        return command::run(args, &CANCEL);
    }
    if let Some(to) = args.screenshot.clone() {
        return shot::run(&args, &to);
    }
    let [wide, high] = args.size.map(|side| side as f32);
    let viewport = egui::ViewportBuilder::default()
        .with_title("Lightvein")
        .with_app_id("lightvein")
        .with_inner_size([wide, high])
        .with_min_inner_size([640.0, 400.0]);
    let options = NativeOptions { viewport, renderer: Renderer::Wgpu, ..NativeOptions::default() };
    let opened = eframe::run_native("lightvein", options, Box::new(move |cc| Ok(Box::new(App::of_window(cc, args)))));
    opened.map_err(|error| {
        // What stands before the last colon is where in winit's source it failed.
        let cause = error.to_string();
        let cause = cause.rsplit(": ").next().unwrap_or_default().trim_end_matches('.');
        anyhow!(
            "no window can be opened: {cause}. It needs a display and a Vulkan driver (Debian's mesa-vulkan-drivers has one \
             in software); `lightvein-viewer SCENE --screenshot FILE` needs no display, and `lightvein analyse SCENE` neither"
        )
    })
}

/// The first Ctrl-C asks the command to stop, the second ends the program.
fn listen_to_ctrl_c() {
    let second_time_ends_it = || {
        if CANCEL.is_cancelled() {
            std::process::exit(i32::from(INTERRUPTED));
        }
        CANCEL.cancel();
    };
    if let Err(error) = ctrlc::set_handler(second_time_ends_it) {
        eprintln!("warning: Ctrl-C will end the program at once: {error}");
    }
}
