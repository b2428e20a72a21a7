//! Where do layers begin and end, and which class is each?

use super::super::settings::{Class, Classes, Settings, Split};

/// Weight of the logarithm in practical splits: half and half (Zhang et al. 2006).
const PRACTICAL: f32 = 0.5;

/// Depths that the camera sees: how many pixels by depth.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Of the first object, metres along the gaze.
    pub first_m: f32,
    /// Of the last.
    pub last_m: f32,
    /// Pixels by depth: bin b holds depths from 2^(b / [`Seen::BINS_AN_OCTAVE`]) times [`Seen::LEAST_M`] on.
    pub pixels: Vec<u32>,
}

impl Seen {
    /// Bins of a factor of two: depths within 4%.
    pub const BINS_AN_OCTAVE: u32 = 16;
    /// Where the first bin begins, metres.
    pub const LEAST_M: f32 = 0.25;
    /// Bins: depths to 16 km.
    pub const BINS: u32 = 16 * Self::BINS_AN_OCTAVE;

    /// Depth in the middle of a bin.
    fn middle_m(bin: usize) -> f64 {
        f64::from(Self::LEAST_M) * ((bin as f64 + 0.5) / f64::from(Self::BINS_AN_OCTAVE)).exp2()
    }

    /// Variance over mean of the depths between two, metres; none where nothing lies there.
    pub fn dispersion_m(&self, from_m: f32, to_m: f32) -> Option<f64> {
        let inside = |bin: usize| (f64::from(from_m)..f64::from(to_m)).contains(&Self::middle_m(bin));
        let bins = || self.pixels.iter().enumerate().filter(|(bin, _)| inside(*bin));
        let moment = |power: i32| bins().map(|(bin, n)| f64::from(*n) * Self::middle_m(bin).powi(power)).sum::<f64>();
        let [pixels, sum, squares] = [0, 1, 2].map(moment);
        let mean = sum / pixels;
        (pixels > 0.0).then(|| (squares / pixels - mean * mean).max(0.0) / mean)
    }
}

/// Bounds of layers by the camera's depth, metres: one more than layers. `depths_m` is what the frustum reaches of the scene.
pub fn by_camera(settings: &Settings, depths_m: [f32; 2], seen: Option<&Seen>, in_perspective: bool) -> Vec<f32> {
    let [near_m, far_m] = depths_m;
    match (settings.split, seen) {
        (Split::CameraLogarithm, Some(seen)) if in_perspective => {
            logarithmic(seen.first_m.max(near_m), seen.last_m.min(far_m), settings.layers)
        }
        (Split::CameraPractical, _) if in_perspective => {
            let even = even(near_m, far_m, settings.layers);
            let logarithmic = logarithmic(near_m, far_m, settings.layers);
            let mixed = |(even, logarithmic): (&f32, &f32)| even + PRACTICAL * (logarithmic - even);
            even.iter().zip(&logarithmic).map(mixed).collect()
        }
        // A parallel projection shows all depths at one size: nothing asks for a logarithm.
        _ => even(near_m, far_m, settings.layers),
    }
}

/// Bounds of layers by the light's depth, metres along the rays. The logarithm is the camera's, from the first object to the
/// last, laid on to the light's range: its own has no beginning, for the sun is infinitely far.
pub fn by_light(settings: &Settings, [near_m, far_m]: [f32; 2], seen: Option<&Seen>) -> Vec<f32> {
    match (settings.split, seen) {
        (Split::LightLogarithm, Some(seen)) if seen.last_m > seen.first_m => {
            let bounds = logarithmic(seen.first_m, seen.last_m, settings.layers);
            let share = |bound: f32| (bound - seen.first_m) / (seen.last_m - seen.first_m);
            bounds.into_iter().map(|bound| near_m + share(bound) * (far_m - near_m)).collect()
        }
        _ => even(near_m, far_m, settings.layers),
    }
}

/// The classes of layers by the camera's depth.
pub fn classes(settings: &Settings, bounds_m: &[f32], seen: Option<&Seen>) -> Vec<Class> {
    let layers = bounds_m.len().saturating_sub(1);
    match (settings.classes, seen) {
        (Classes::Logarithm, Some(seen)) => {
            bounds_m[..layers].iter().map(|from_m| by_logarithm(*from_m, seen.first_m, seen.last_m)).collect()
        }
        (Classes::Dispersion, Some(seen)) => {
            by_dispersion(bounds_m.windows(2).map(|ends| seen.dispersion_m(ends[0], ends[1])).collect())
        }
        _ => vec![Class::A; layers],
    }
}

/// The classes of layers by the light's depth: those that the camera's layers of the same numbers have.
pub fn classes_by_light(settings: &Settings, layers: usize, seen: Option<&Seen>) -> Vec<Class> {
    let Some(seen) = seen else { return vec![Class::A; layers] };
    classes(settings, &logarithmic(seen.first_m, seen.last_m, layers), Some(seen))
}

/// The class at a depth: x counts from the first object on, in distances of the first object.
fn by_logarithm(from_m: f32, first_m: f32, last_m: f32) -> Class {
    let log = |depth_m: f32| ((depth_m - first_m) / first_m).max(f32::MIN_POSITIVE).log10();
    let d = log(from_m);
    if d <= 0.0 {
        Class::A
    } else if d <= log(last_m) / 2.0 {
        Class::B
    } else {
        Class::C
    }
}

/// Classes by thirds of the logarithm of dispersion. Depths that hardly differ are near and fine.
fn by_dispersion(indices: Vec<Option<f64>>) -> Vec<Class> {
    let known = || indices.iter().flatten().copied().filter(|index| *index > 0.0).map(f64::ln);
    let (low, high) = (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    let class = |index: &Option<f64>| {
        let share = index.map(|index| (index.ln() - low) / (high - low));
        match share {
            // One layer's dispersion says nothing, and what has none has no depths to tell apart.
            Some(share) if share.is_nan() || share <= 1.0 / 3.0 => Class::A,
            Some(share) if share <= 2.0 / 3.0 => Class::B,
            Some(_) => Class::C,
            None => Class::C,
        }
    };
    indices.iter().map(class).collect()
}

/// Bounds that grow evenly.
fn even(near_m: f32, far_m: f32, layers: usize) -> Vec<f32> {
    (0..=layers).map(|bound| near_m + (far_m - near_m) * bound as f32 / layers as f32).collect()
}

/// Bounds that grow by the same factor.
fn logarithmic(near_m: f32, far_m: f32, layers: usize) -> Vec<f32> {
    let near_m = near_m.max(f32::MIN_POSITIVE);
    let ratio = (far_m / near_m).max(1.0);
    let bound = |bound: usize| match bound {
        // The ends to the bit.
        0 => near_m,
        bound if bound == layers => far_m.max(near_m),
        bound => near_m * ratio.powf(bound as f32 / layers as f32),
    };
    (0..=layers).map(bound).collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::settings::Method;
    use super::*;

    fn seen(first_m: f32, last_m: f32) -> Seen {
        let mut pixels = vec![0; Seen::BINS as usize];
        for pixel in 0..10_000 {
            let depth_m = first_m + (last_m - first_m) * pixel as f32 / 10_000.0;
            pixels[((depth_m / Seen::LEAST_M).log2() * Seen::BINS_AN_OCTAVE as f32) as usize] += 1;
        }
        Seen { first_m, last_m, pixels }
    }

    /// The paper's street: the nearest object at 10 m, the farthest at 380 m.
    #[test]
    fn the_papers_street_is_divided_from_its_first_object_on() {
        let seen = seen(10.0, 380.0);
        let settings = Method::Hsm.settings(1024, 4);
        let bounds = by_camera(&settings, [0.01, 450.0], Some(&seen), true);
        for (bound, expected) in bounds.iter().zip([10.0, 24.83, 61.64, 153.05, 380.0]) {
            assert!((bound / expected - 1.0).abs() < 1e-3, "{bounds:?}");
        }
        assert_eq!(classes(&settings, &bounds, Some(&seen)), [Class::A, Class::B, Class::B, Class::C]);
        let practical = by_camera(&Method::Csm.settings(1024, 4), [0.01, 450.0], None, true);
        assert_eq!((practical[0], practical[4]), (0.01, 450.0));
        assert!((practical[2] - 0.5 * (225.0 + 4.5_f32.sqrt())).abs() < 0.1, "{practical:?}");
    }

    #[test]
    fn dispersion_is_variance_over_mean_and_orders_the_classes() {
        // Even between a and b: variance (b - a)^2/12, mean (a + b)/2.
        let seen = seen(10.0, 380.0);
        let index = seen.dispersion_m(0.0, 1e4).unwrap();
        assert!((index / (370.0 * 370.0 / 12.0 / 195.0) - 1.0).abs() < 0.02, "{index}");
        assert_eq!(seen.dispersion_m(1.0, 5.0), None);
        let settings = Settings { classes: Classes::Dispersion, ..Method::Hsm.settings(1024, 6) };
        let bounds = by_camera(&settings, [0.01, 450.0], Some(&seen), true);
        let classes = classes(&settings, &bounds, Some(&seen));
        assert_eq!(classes, [Class::A, Class::A, Class::B, Class::B, Class::C, Class::C]);
    }

    #[test]
    fn bounds_grow_whatever_is_seen() {
        for method in Method::ALL {
            for (first_m, last_m) in [(10.0, 380.0), (0.3, 0.31), (5.0, 5.0)] {
                let (settings, seen) = (method.settings(256, 7), seen(first_m, last_m));
                for bounds in [
                    by_camera(&settings, [0.01, 500.0], Some(&seen), true),
                    by_camera(&settings, [-3.0, 500.0], None, false),
                    by_light(&settings, [-50.0, 70.0], Some(&seen)),
                ] {
                    assert_eq!(bounds.len(), settings.layers + 1);
                    assert!(bounds.windows(2).all(|ends| ends[0] <= ends[1]), "{method:?} {bounds:?}");
                }
                assert_eq!(classes_by_light(&settings, 7, Some(&seen)).len(), 7);
            }
        }
    }

    #[test]
    fn the_lights_logarithm_has_the_cameras_shape() {
        let settings = Method::HsmLight.settings(256, 4);
        let bounds = by_light(&settings, [100.0, 200.0], Some(&seen(10.0, 380.0)));
        let expected = [100.0, 104.01, 113.96, 138.66, 200.0];
        assert!(bounds.iter().zip(expected).all(|(bound, expected)| (bound - expected).abs() < 0.02), "{bounds:?}");
    }
}
