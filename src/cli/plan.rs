//! What will run: the command line and the scene file's `[model]` joined; what is typed goes before what the file says.

use super::args::Flags;
use crate::light::Settings;
use crate::scene::{Method, ModelChoice};

/// What a run was asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Voxel edge, metres; `None` to choose one.
    pub voxel_m: Option<f32>,
    /// The method of `analyse`; `None` to choose one.
    pub method: Option<Method>,
    /// Seed, samples, bounces.
    pub settings: Settings,
    /// Threads to work on; `None` for one a core.
    pub threads: Option<usize>,
    /// The factor within which `analyse` is to be right; `None` where none was given.
    pub tolerance: Option<f64>,
}

impl Plan {
    /// The plan of a command: its common flags, its own choices, and the scene file's.
    pub fn new(
        flags: &Flags,
        tolerance: Option<f64>,
        method: Option<Method>,
        settings: Settings,
        file: &ModelChoice,
    ) -> Self {
        Self {
            voxel_m: flags.voxel.or(file.voxel_m),
            method: method.or(file.method),
            settings: Settings { seed: flags.seed.or(file.seed).unwrap_or(0), ..settings },
            threads: flags.threads.map(usize::from).or(file.threads),
            tolerance: tolerance.or(file.tolerance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_goes_before_what_the_file_says() {
        let file =
            ModelChoice { voxel_m: Some(0.1), method: Some(Method::Forward), seed: Some(7), ..Default::default() };
        let plan = Plan::new(&Flags::default(), None, None, Settings::default(), &file);
        assert_eq!((plan.voxel_m, plan.method, plan.settings.seed), (Some(0.1), Some(Method::Forward), 7));

        let typed = Flags { voxel: Some(0.2), seed: Some(1), ..Flags::default() };
        let plan = Plan::new(&typed, None, Some(Method::Backward), Settings::default(), &file);
        assert_eq!((plan.voxel_m, plan.method, plan.settings.seed), (Some(0.2), Some(Method::Backward), 1));
    }
}
