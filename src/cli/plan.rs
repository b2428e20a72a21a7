//! What will run: the command line and the scene file's `[model]` joined and validated.

use super::args::Common;
use crate::light::Settings;
use crate::scene::{Method, ModelChoice};
use anyhow::{Result, ensure};

/// What a run was asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Voxel edge, metres; `None` to choose one.
    pub voxel_m: Option<f32>,
    /// The estimator of `analyse`.
    pub method: Method,
    /// Seed, samples, bounces.
    pub settings: Settings,
}

/// Threads beyond this are a slip of the keyboard.
const MOST_THREADS: usize = 1024;

/// What can be validated before the scene is read.
///
/// # Errors
/// Names the flag, its value and its bound.
pub fn check(common: &Common) -> Result<()> {
    if let Some(voxel_m) = common.voxel {
        ensure!(voxel_m.is_finite() && voxel_m > 0.0, "--voxel {voxel_m}: a voxel's edge is above 0 m");
    }
    if let Some(tolerance) = common.tolerance {
        ensure!(tolerance.is_finite() && tolerance > 1.0, "--tolerance {tolerance}: a tolerance is a factor above 1");
    }
    if let Some(threads) = common.threads {
        ensure!((1..=MOST_THREADS).contains(&threads), "--threads {threads}: from 1 to {MOST_THREADS}");
    }
    Ok(())
}

/// Joins both: what is typed goes before what the file says.
pub fn plan(common: &Common, method: Option<Method>, samples: u32, bounces: Option<u32>, file: &ModelChoice) -> Plan {
    Plan {
        voxel_m: common.voxel.or(file.voxel_m),
        method: method.or(file.method).unwrap_or(Method::Backward),
        settings: Settings { seed: common.seed.or(file.seed).unwrap_or(0), samples, max_bounces: bounces },
    }
}
