//! The adapter that the tests of this crate draw with, one for all of them.

use super::{NoAdapter, Offscreen};
use std::sync::{Mutex, MutexGuard, OnceLock};

/// The adapter; None (and why) where there is none and none is demanded.
pub(crate) fn offscreen() -> Option<MutexGuard<'static, Offscreen>> {
    static OFFSCREEN: OnceLock<Result<Mutex<Offscreen>, NoAdapter>> = OnceLock::new();
    match OFFSCREEN.get_or_init(|| Offscreen::new().map(Mutex::new)) {
        Ok(offscreen) => Some(offscreen.lock().unwrap_or_else(|poisoned| poisoned.into_inner())),
        Err(error) if std::env::var_os("LIGHTVEIN_NEED_GPU").is_some() => panic!("{error}"),
        Err(error) => {
            println!("skipped: {error}");
            None
        }
    }
}
