//! Which methods are measured, at which resolutions and numbers of layers?

use crate::shadows::{Classes, MOST_LAYERS, Method, Overlap, RESOLUTIONS, Settings, Split};

/// Resolutions by default: those of the paper's table.
const DEFAULT_RESOLUTIONS: [u32; 3] = [256, 512, 1024];

/// Layers of LVSM by default, and of HSM what its paper says it needs for the same: 0.8 of them, rounded up.
const LVSM_LAYERS: [usize; 4] = [2, 4, 8, 15];
const HSM_LAYERS: [usize; 4] = [2, 4, 7, 12];
const CSM_LAYERS: [usize; 2] = [2, 4];

/// Variants are measured at the resolution nearest to this one, and at the number of layers nearest to that one.
const VARIANTS_AT: (u32, usize) = (1024, 4);

/// Sides of maps are whole multiples of this where they are chosen by memory.
const SIDE_STEP: u32 = 16;

/// What is to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Extent {
    /// The methods.
    pub methods: Vec<Method>,
    /// Texels a side.
    pub resolutions: Vec<u32>,
    /// Layers of every layered method; `None` for those of each by default.
    pub layers: Option<Vec<usize>>,
}

impl Default for Extent {
    fn default() -> Self {
        Self { methods: Method::ALL.to_vec(), resolutions: DEFAULT_RESOLUTIONS.to_vec(), layers: None }
    }
}

/// A method with one of its settings changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Nothing is.
    AsNamed,
    /// Classes by the dispersion index of the depths.
    ByDispersion,
    /// One class: resolution and precision are the same in all layers.
    OneClass,
    /// No blur.
    Sharp,
    /// Where two layers overlap, the point's own alone is asked.
    OwnLayer,
    /// Layers by logarithm from the first object on.
    ByLogarithm,
    /// Planes are not followed; surfaces are lifted by what the filter reaches instead, as is common.
    Lifted,
}

/// Texels that a filter of 4 x 4 reaches from its middle.
const REACH_TEXELS: f32 = 2.0;

impl Variant {
    /// What is changed of a method: what the hybrid map has of its own, and that in the others.
    pub const fn of_method(method: Method) -> &'static [Self] {
        match method {
            Method::Plain => &[],
            Method::Pcf => &[Self::Lifted],
            Method::Vsm | Method::Lvsm => &[Self::Sharp],
            Method::Csm => &[Self::ByLogarithm],
            Method::Hsm => &[Self::ByDispersion, Self::OneClass, Self::Sharp, Self::OwnLayer],
            Method::HsmLight => &[Self::OneClass],
        }
    }

    /// In tables, after the method's name; empty where nothing is changed.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AsNamed => "",
            Self::ByDispersion => "classes by dispersion",
            Self::OneClass => "one class",
            Self::Sharp => "no blur",
            Self::OwnLayer => "no medium bound",
            Self::ByLogarithm => "by logarithm",
            Self::Lifted => "lifted",
        }
    }

    fn of(self, settings: Settings) -> Settings {
        match self {
            Self::AsNamed => settings,
            Self::ByDispersion => Settings { classes: Classes::Dispersion, ..settings },
            Self::OneClass => Settings { classes: Classes::One, ..settings },
            Self::Sharp => Settings { blurred: false, ..settings },
            Self::OwnLayer => Settings { overlap: Overlap::Own, ..settings },
            Self::ByLogarithm => Settings { split: Split::CameraLogarithm, ..settings },
            Self::Lifted => Settings { follows_planes: false, lift_texels: REACH_TEXELS, ..settings },
        }
    }
}

/// What one row of the table is measured with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ask {
    /// The method.
    pub method: Method,
    /// What is changed of it.
    pub variant: Variant,
    /// With that change.
    pub settings: Settings,
    /// Whether its resolution was chosen to take as much memory as another row.
    pub is_by_memory: bool,
}

impl Ask {
    fn new(method: Method, variant: Variant, resolution: u32, layers: usize) -> Self {
        Self { method, variant, settings: variant.of(method.settings(resolution, layers)), is_by_memory: false }
    }

    /// Method and what is changed of it.
    pub fn name(&self) -> String {
        match self.variant {
            Variant::AsNamed => self.method.name().to_owned(),
            variant => format!("{}, {}", self.method.name(), variant.name()),
        }
    }

    /// The same with its size, in words.
    pub fn words(&self) -> String {
        let Settings { resolution, layers, .. } = self.settings;
        let s = if layers == 1 { "" } else { "s" };
        format!("{}, {layers} layer{s} of {resolution}", self.name())
    }
}

/// All rows of a table, method by method, the small maps first; without those that memory decides on ([`as_large_as`]).
pub fn asks(extent: &Extent) -> Vec<Ask> {
    let mut asks = Vec::new();
    for &method in &extent.methods {
        for &resolution in &extent.resolutions {
            for layers in layers_of(method, extent) {
                asks.push(Ask::new(method, Variant::AsNamed, resolution, layers));
            }
        }
        asks.extend(variants(method, extent));
    }
    asks
}

/// The variants of a method at one resolution and number of layers.
fn variants(method: Method, extent: &Extent) -> Vec<Ask> {
    let (near_resolution, near_layers) = VARIANTS_AT;
    let resolution = extent.resolutions.iter().copied().min_by_key(|side| side.abs_diff(near_resolution));
    let layers = layers_of(method, extent).into_iter().min_by_key(|layers| layers.abs_diff(near_layers));
    let (Some(resolution), Some(layers)) = (resolution, layers) else { return Vec::new() };
    Variant::of_method(method).iter().map(|&variant| Ask::new(method, variant, resolution, layers)).collect()
}

fn layers_of(method: Method, extent: &Extent) -> Vec<usize> {
    match (method, &extent.layers) {
        (method, _) if !method.is_layered() => vec![1],
        (_, Some(layers)) => layers.clone(),
        (Method::Lvsm, None) => LVSM_LAYERS.to_vec(),
        (Method::Csm, None) => CSM_LAYERS.to_vec(),
        (_, None) => HSM_LAYERS.to_vec(),
    }
}

/// A row with the resolution at which it takes at least `bytes`, told from what it takes at its own. `None` where no map is so
/// large.
pub fn as_large_as(ask: Ask, its_bytes: u64, bytes: u64) -> Option<Ask> {
    if its_bytes == 0 {
        return None;
    }
    // Memory goes by the texels.
    let side = f64::from(ask.settings.resolution) * (bytes as f64 / its_bytes as f64).sqrt();
    let resolution = (side / f64::from(SIDE_STEP)).ceil() as u32 * SIDE_STEP;
    let settings = Settings { resolution, ..ask.settings };
    RESOLUTIONS.contains(&resolution).then_some(Ask { settings, is_by_memory: true, ..ask })
}

/// Numbers of layers from a list: 1 to [`MOST_LAYERS`].
///
/// # Errors
/// What is wrong with the text, and the bound.
pub fn layers(text: &str) -> Result<usize, String> {
    let number = text.trim().parse().ok().filter(|layers| (1..=MOST_LAYERS).contains(layers));
    number.ok_or_else(|| format!("{text:?} is no number of layers: 1 to {MOST_LAYERS}"))
}

/// A resolution from a list.
///
/// # Errors
/// What is wrong with the text, and the bound.
pub fn resolution(text: &str) -> Result<u32, String> {
    let (least, most) = (RESOLUTIONS.start(), RESOLUTIONS.end());
    let side = text.trim().parse().ok().filter(|side| RESOLUTIONS.contains(side));
    side.ok_or_else(|| format!("{text:?} is no resolution: {least} to {most} texels a side"))
}

/// A method from a list.
///
/// # Errors
/// That there is none of that name, and which there are.
pub fn method(text: &str) -> Result<Method, String> {
    let names = Method::ALL.map(Method::name).join(", ");
    Method::from_name(text.trim()).ok_or_else(|| format!("{text:?} is no shadow method; there are {names}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_table_holds_every_method_at_every_resolution() {
        let asks = asks(&Extent::default());
        for method in Method::ALL {
            for side in DEFAULT_RESOLUTIONS {
                let rows = asks.iter().filter(|ask| ask.method == method && ask.settings.resolution == side);
                let least = if method.is_layered() { 2 } else { 1 };
                assert!(rows.count() >= least, "{method:?} {side}");
            }
        }
        let names: Vec<String> = asks.iter().map(Ask::name).filter(|name| name.contains(',')).collect();
        assert_eq!(names.len(), Method::ALL.into_iter().map(|method| Variant::of_method(method).len()).sum::<usize>());
        assert!(asks.iter().enumerate().all(|(at, ask)| !asks[..at].contains(ask)), "a row stands twice");
    }

    #[test]
    fn every_variant_changes_something() {
        for method in Method::ALL {
            let named = method.settings(512, 4);
            assert_eq!(Variant::AsNamed.of(named), named);
            for variant in Variant::of_method(method) {
                assert_ne!(variant.of(named), named, "{method:?} {variant:?}");
            }
        }
    }

    #[test]
    fn layers_that_are_asked_for_go_to_layered_methods_alone() {
        let extent =
            Extent { methods: vec![Method::Vsm, Method::Lvsm], resolutions: vec![128], layers: Some(vec![3, 5]) };
        let named = asks(&extent).into_iter().filter(|ask| ask.variant == Variant::AsNamed);
        assert_eq!(named.map(|ask| ask.settings.layers).collect::<Vec<_>>(), [1, 3, 5]);
    }

    #[test]
    fn a_map_is_made_as_large_as_another() {
        let ask = Ask::new(Method::Vsm, Variant::AsNamed, 1024, 1);
        let large = as_large_as(ask, 1000, 4000).unwrap();
        assert_eq!((large.settings.resolution, large.is_by_memory), (2048, true));
        // Rounded up, to whole steps.
        assert_eq!(as_large_as(ask, 1000, 1001).unwrap().settings.resolution, 1040);
        assert_eq!(as_large_as(ask, 1000, 100_000), None);
        assert_eq!(as_large_as(ask, 0, 100), None);
    }

    #[test]
    fn what_is_typed_is_bounded() {
        assert_eq!((layers("16"), resolution("256"), method("hsm")), (Ok(16), Ok(256), Ok(Method::Hsm)));
        assert!(layers("17").is_err() && layers("0").is_err() && layers("x").is_err());
        assert!(resolution("8").unwrap_err().contains("16 to 4096") && resolution("-1").is_err());
        assert!(method("hms").unwrap_err().contains("hsm-light"));
    }
}
