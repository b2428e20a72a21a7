//! What tells one shadow method from another: a few settings, and the methods of the literature as values of them.

use serde::{Deserialize, Serialize};

/// Most layers of a map: what the shaders' table holds.
pub const MOST_LAYERS: usize = 16;
/// Texels a side of a map, least and most.
pub const RESOLUTIONS: std::ops::RangeInclusive<u32> = 16..=4096;

/// A shadow method: the same passes, these settings apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// How a map answers.
    pub filter: Filter,
    /// What the layers divide.
    pub split: Split,
    /// How many layers, 1 to [`MOST_LAYERS`]; one where [`Split::Whole`].
    pub layers: usize,
    /// Which layers have fewer and shorter numbers.
    pub classes: Classes,
    /// What holds where two layers overlap.
    pub overlap: Overlap,
    /// Texels a side of a map of class A, within [`RESOLUTIONS`].
    pub resolution: u32,
    /// Gaussian blur of the moments, 5 x 5 texels.
    pub blurred: bool,
    /// How far a receiver is lifted off its surface, in texels of its map: too little and surfaces shade themselves (acne), too
    /// much and shadows come off their feet (peter-panning).
    pub lift_texels: f32,
    /// Whether texels are compared with the depth that the receiver's plane has at each (Isidoro 2006), not with the receiver's
    /// own: it needs little lift then.
    pub follows_planes: bool,
}

/// How a map answers whether a point lies in the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Filter {
    /// The nearest texel's depth is compared: yes or no (Williams 1978).
    Compare,
    /// Comparisons of 4 x 4 texels, averaged with the weights of a bilinear 3 x 3 filter (Reeves et al. 1987).
    Pcf,
    /// Chebyshev's upper bound from two moments of the depth (Donnelly & Lauritzen 2006).
    Variance,
    /// [`Filter::Pcf`] in class A, [`Filter::Variance`] in the others.
    Hybrid,
}

/// What the layers divide, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Split {
    /// Nothing: one map for all that the camera sees.
    Whole,
    /// The depth seen from the light, evenly; one map, many pairs of moments (Lauritzen & McCool 2008).
    LightEven,
    /// The depth seen from the light, growing by the camera's logarithm from the light's first object on.
    LightLogarithm,
    /// The depth seen from the camera, from its near plane on, halfway between even and logarithmic (Zhang et al. 2006); a map
    /// for each (Dimitrov 2007).
    CameraPractical,
    /// The depth seen from the camera, by logarithm from the first object on (Kolivand & Sunar 2012); a map for each.
    CameraLogarithm,
}

/// Which class a layer belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Classes {
    /// All are of class A.
    One,
    /// By d = log x, x the distance past the first object in distances of the first object: A to x = 1, then halfway in d.
    Logarithm,
    /// By the dispersion index (variance over mean) of the depths in the layer, in thirds of its logarithm.
    Dispersion,
}

/// What holds where two layers overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Overlap {
    /// The layer that the point belongs to; the other is not asked.
    Own,
    /// The medium bound of Kolivand & Sunar: min(a, b) + |a - b|/2.
    Medium,
}

/// The methods that have a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Method {
    /// The plain shadow map.
    Plain,
    /// Percentage-closer filtering.
    Pcf,
    /// Variance shadow map.
    Vsm,
    /// Layered variance shadow map.
    Lvsm,
    /// Cascaded shadow maps.
    Csm,
    /// Hybrid shadow map, its layers over the camera's depth.
    Hsm,
    /// Hybrid shadow map, its layers over the light's depth: the paper's other reading.
    HsmLight,
}

impl Method {
    /// All of them, the simplest first.
    pub const ALL: [Self; 7] = [Self::Plain, Self::Pcf, Self::Vsm, Self::Lvsm, Self::Csm, Self::Hsm, Self::HsmLight];

    /// As tables, menus and the command line call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Pcf => "pcf",
            Self::Vsm => "vsm",
            Self::Lvsm => "lvsm",
            Self::Csm => "csm",
            Self::Hsm => "hsm",
            Self::HsmLight => "hsm-light",
        }
    }

    /// The method of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// In words, for menus and documents.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Plain => "Plain shadow map",
            Self::Pcf => "Percentage-closer filtering",
            Self::Vsm => "Variance shadow map",
            Self::Lvsm => "Layered variance shadow map",
            Self::Csm => "Cascaded shadow maps",
            Self::Hsm => "Hybrid shadow map",
            Self::HsmLight => "Hybrid shadow map over light depth",
        }
    }

    /// Whether it has more than one layer.
    pub const fn is_layered(self) -> bool {
        matches!(self, Self::Lvsm | Self::Csm | Self::Hsm | Self::HsmLight)
    }

    /// Layers by default: those of the usual demonstrations, and 0.8 of LVSM's for HSM, as its paper has it.
    pub const fn default_layers(self) -> usize {
        match self {
            Self::Plain | Self::Pcf | Self::Vsm => 1,
            Self::Csm => 4,
            Self::Lvsm => 5,
            Self::Hsm | Self::HsmLight => 4,
        }
    }

    /// Its settings at a resolution and a number of layers; both are clamped to what there is.
    pub fn settings(self, resolution: u32, layers: usize) -> Settings {
        let (filter, split) = match self {
            Self::Plain => (Filter::Compare, Split::Whole),
            Self::Pcf => (Filter::Pcf, Split::Whole),
            Self::Vsm => (Filter::Variance, Split::Whole),
            Self::Lvsm => (Filter::Variance, Split::LightEven),
            Self::Csm => (Filter::Pcf, Split::CameraPractical),
            Self::Hsm => (Filter::Hybrid, Split::CameraLogarithm),
            Self::HsmLight => (Filter::Hybrid, Split::LightLogarithm),
        };
        let is_hybrid = matches!(self, Self::Hsm | Self::HsmLight);
        Settings {
            filter,
            split,
            layers: if self.is_layered() { layers.clamp(1, MOST_LAYERS) } else { 1 },
            classes: if is_hybrid { Classes::Logarithm } else { Classes::One },
            overlap: if is_hybrid { Overlap::Medium } else { Overlap::Own },
            resolution: resolution.clamp(*RESOLUTIONS.start(), *RESOLUTIONS.end()),
            blurred: matches!(filter, Filter::Variance | Filter::Hybrid),
            lift_texels: Settings::DEFAULT_LIFT_TEXELS,
            follows_planes: true,
        }
    }
}

impl Settings {
    /// What a plane that is followed, or a variance that knows of a tilt, leaves to rounding and to edges.
    pub const DEFAULT_LIFT_TEXELS: f32 = 0.25;
}

impl Filter {
    /// Whether layers of a class are compared with; else they are moments.
    pub const fn compares(self, class: Class) -> bool {
        match self {
            Self::Compare | Self::Pcf => true,
            Self::Variance => false,
            Self::Hybrid => matches!(class, Class::A),
        }
    }
}

/// How fine a layer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// All texels, numbers of 32 bits.
    A,
    /// Half the texels a side, numbers of 16 bits.
    B,
    /// A quarter of the texels a side, numbers of 16 bits.
    C,
}

impl Class {
    /// Texels a side where class A has so many.
    pub const fn resolution(self, of_a: u32) -> u32 {
        let fewer = match self {
            Self::A => of_a,
            Self::B => of_a / 2,
            Self::C => of_a / 4,
        };
        if fewer == 0 { 1 } else { fewer }
    }

    /// As tables name it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
        }
    }
}

impl Split {
    /// Whether each layer has a map of its own, and a point's layer is told by its depth from the camera; else all are made of one map,
    /// and it is told by the depth from the light.
    pub const fn has_map_each(self) -> bool {
        matches!(self, Self::CameraPractical | Self::CameraLogarithm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_have_names_and_settings_of_their_own() {
        for method in Method::ALL {
            assert_eq!(Method::from_name(method.name()), Some(method));
            let settings = method.settings(512, 3);
            assert_eq!(settings.layers, if method.is_layered() { 3 } else { 1 });
            assert_eq!(settings.layers > 1, settings.split != Split::Whole);
        }
        assert_eq!(Method::Lvsm.settings(1 << 20, 99).layers, MOST_LAYERS);
        assert_eq!(Method::Lvsm.settings(1 << 20, 99).resolution, *RESOLUTIONS.end());
        assert_eq!(Method::from_name("shadow"), None);
    }
}
