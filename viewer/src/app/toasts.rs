//! What was told, as toasts that go by themselves in the order in which they came. One at rest asks for no frames: its end is
//! waited for.

use crate::log::{Level, Log};
use egui::{Color32, Context, TextStyle};
use std::collections::VecDeque;
use std::time::Duration;

/// How long an error stays, and anything else, seconds.
const STAYS_S: [f64; 2] = [12.0, 4.0];

/// Longer lines are broken, points: paths and causes are long, and a toast does not break lines itself.
const WIDEST: f32 = 520.0;

/// The toasts.
pub struct Toasts {
    shown: egui_notify::Toasts,
    ends_s: VecDeque<f64>,
}

impl Default for Toasts {
    fn default() -> Self {
        let shown = egui_notify::Toasts::default().with_anchor(egui_notify::Anchor::BottomRight);
        Self { shown, ends_s: VecDeque::new() }
    }
}

impl Toasts {
    /// Shows what was told for the first time, and what was told shortly before.
    pub fn show(&mut self, ctx: &Context, log: &mut Log) {
        let now_s = ctx.input(|input| input.time);
        for entry in log.take_fresh() {
            let text = broken(ctx, &entry.line());
            let toast = match entry.level {
                Level::Error => self.shown.error(text),
                Level::Warning => self.shown.warning(text),
                Level::Note => self.shown.info(text),
            };
            // With a duration of its own it would ask for frame after frame to count it down.
            toast.duration(None).closable(true).show_progress_bar(false);
            self.ends_s.push_back(now_s + STAYS_S[usize::from(entry.level != Level::Error)]);
        }
        // One that is going has left the queue and is still on the screen.
        let is_still = self.ends_s.len() == self.shown.len();
        if is_still && self.ends_s.pop_front_if(|end_s| *end_s <= now_s).is_some() {
            self.shown.dismiss_oldest_toast();
        }
        self.shown.show(ctx);

        // Who closed one by hand need not wait for it.
        while self.ends_s.len() > self.shown.len() {
            self.ends_s.pop_front();
        }
        if let Some(end_s) = self.ends_s.front() {
            ctx.request_repaint_after(Duration::from_secs_f64((end_s - now_s).max(0.0)));
        }
    }
}

/// A line broken into as many as fit one below the other.
fn broken(ctx: &Context, line: &str) -> String {
    let widest = WIDEST.min(0.6 * ctx.content_rect().width());
    let font = TextStyle::Body.resolve(&ctx.global_style());
    let galley = ctx.fonts_mut(|fonts| fonts.layout(line.to_owned(), font, Color32::WHITE, widest));
    let rows: Vec<String> = galley.rows.iter().map(|row| row.text().trim_end().to_owned()).collect();
    rows.join("\n")
}
