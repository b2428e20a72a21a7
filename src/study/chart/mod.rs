//! What is the best answer for a given time: every method at every quality and voxel size, its seconds beside its error?
//!
//! [`measure`] runs them, [`timing`] says how long they take for how many sensors, [`equal`] how much longer the path tracer
//! takes for the same error, [`verdict`] puts in words which method wins where. A point that no other beats in time and
//! error at once is on the Pareto front ([`mark_fronts`]).
//!
//! Times are wall times of one machine. Loading the mesh and building the BVH count for no method, since all share them;
//! voxels and skeleton count for each estimator in full, as if it were the only one that is run.

pub mod equal;
pub mod measure;
pub mod timing;
pub mod verdict;

use super::errors::Errors;
use equal::Ratio;

/// How many sensors are asked at, the fewest first: who wins depends on how many share the preparation.
pub const SENSORS: [usize; 4] = [7, 1_000, 10_000, 100_000];

/// All that was measured in one scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneChart {
    /// The scene's name.
    pub scene: String,
    /// Its sensors with a reference good enough to measure errors at.
    pub referenced: usize,
    /// What the seconds of the points are: `time on 2 threads`.
    pub timed_by: String,
    /// Seconds for loading the mesh, which no point includes.
    pub load_seconds: f64,
    /// Seconds for the BVH, which no point includes.
    pub rays_seconds: f64,
    /// The points, those of a series one after the other.
    pub points: Vec<Point>,
    /// What was left out and why, a sentence each.
    pub notes: Vec<String>,
}

/// One method at one quality and voxel size, for one number of sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The method's name.
    pub method: String,
    /// What is set: `coarse`, `64 samples`; empty for a method that has one quality.
    pub quality: String,
    /// Edge of a voxel, metres; `None` for a method without voxels.
    pub voxel_m: Option<f32>,
    /// How many sensors are asked at.
    pub sensors: usize,
    /// Seconds for voxels and skeleton.
    pub prepare_seconds: f64,
    /// Seconds for the estimate, given these.
    pub seconds: f64,
    /// Whether `seconds` was scaled up or down from another number of sensors.
    pub is_scaled: bool,
    /// The errors at the scene's referenced sensors.
    pub errors: Errors,
    /// Whether no other point of the same number of sensors is both faster and more accurate.
    pub is_front: bool,
    /// How many times longer the path tracer takes for the same error; `None` for path tracers.
    pub equal_error: Option<Ratio>,
}

impl Point {
    /// Seconds with the preparation.
    pub fn total_seconds(&self) -> f64 {
        self.prepare_seconds + self.seconds
    }

    /// The error, infinite where a sensor was lost; `None` without a reference.
    pub fn rms_factor(&self) -> Option<f64> {
        self.errors.rms_factor
    }

    /// The method, its quality and its voxels: `network coarse, 0.1 m`.
    pub fn label(&self) -> String {
        let name = format!("{} {}", self.method, self.quality);
        let voxels = self.voxel_m.map_or_else(String::new, |voxel_m| format!(", {voxel_m} m"));
        format!("{}{voxels}", name.trim_end())
    }

    /// Whether it is as good in time and error and better in one of them. A point without a finite error dominates none.
    pub fn dominates(&self, other: &Self) -> bool {
        let finite = |point: &Self| point.rms_factor().filter(|factor| factor.is_finite());
        let Some(mine) = finite(self) else { return false };
        let theirs = finite(other).unwrap_or(f64::INFINITY);
        let (sooner, later) = (self.total_seconds(), other.total_seconds());
        sooner <= later && mine <= theirs && (sooner < later || mine < theirs)
    }
}

impl SceneChart {
    /// The points of one number of sensors.
    pub fn panel(&self, sensors: usize) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(move |point| point.sensors == sensors)
    }

    /// The points on the front of one number of sensors, the fastest first.
    pub fn front(&self, sensors: usize) -> Vec<&Point> {
        let mut front: Vec<&Point> = self.panel(sensors).filter(|point| point.is_front).collect();
        front.sort_by(|a, b| a.total_seconds().total_cmp(&b.total_seconds()));
        front
    }
}

/// Marks the points that no other of the same number of sensors dominates; lost sensors keep a point off every front.
pub fn mark_fronts(points: &mut [Point]) {
    let is_front = |point: &Point| {
        let rivals = points.iter().filter(|rival| rival.sensors == point.sensors);
        point.rms_factor().is_some_and(f64::is_finite) && !rivals.into_iter().any(|rival| rival.dominates(point))
    };
    let fronts: Vec<bool> = points.iter().map(is_front).collect();
    for (point, is_front) in points.iter_mut().zip(fronts) {
        point.is_front = is_front;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A point of that total time and error.
    pub(crate) fn point(method: &str, sensors: usize, seconds: f64, rms_factor: f64) -> Point {
        let lost = usize::from(rms_factor.is_infinite());
        Point {
            method: method.to_owned(),
            quality: String::new(),
            voxel_m: None,
            sensors,
            prepare_seconds: 0.0,
            seconds,
            is_scaled: false,
            errors: Errors {
                rms_factor: Some(rms_factor),
                max_factor: Some(rms_factor),
                median_angle_deg: None,
                counted: 10,
                left_out: 0,
                lost,
                above: 0,
            },
            is_front: false,
            equal_error: None,
        }
    }

    proptest! {
        /// Few distinct values, so that ties occur.
        #[test]
        fn no_point_of_the_front_is_dominated_and_every_other_one_is(
            values in prop::collection::vec((0..2_usize, 1..9_u32, 1..9_u32), 1..40),
        ) {
            let mut points: Vec<Point> = values
                .iter()
                .map(|&(sensors, seconds, factor)| {
                    let factor = if factor == 8 { f64::INFINITY } else { 1.0 + f64::from(factor) };
                    point("any", SENSORS[sensors], f64::from(seconds), factor)
                })
                .collect();
            mark_fronts(&mut points);
            for point in &points {
                let beaten = points.iter().any(|rival| {
                    let (time, error) = (rival.seconds <= point.seconds, rival.rms_factor() <= point.rms_factor());
                    let better = rival.seconds < point.seconds || rival.rms_factor() < point.rms_factor();
                    rival.sensors == point.sensors && rival.errors.lost == 0 && time && error && better
                });
                let lost = point.errors.lost > 0;
                prop_assert_eq!(point.is_front, !beaten && !lost);
            }
        }
    }

    #[test]
    fn a_front_runs_from_fast_to_accurate() {
        let mut points =
            vec![point("a", 7, 3.0, 1.1), point("b", 7, 1.0, 2.0), point("c", 7, 2.0, 2.5), point("d", 7, 0.1, 9.0)];
        mark_fronts(&mut points);
        let chart = SceneChart { points, ..SceneChart::default() };
        let front: Vec<&str> = chart.front(7).iter().map(|point| point.method.as_str()).collect();
        assert_eq!(front, ["d", "b", "a"]);
    }
}
