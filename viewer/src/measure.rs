//! What is shown in colours: the quantities, their titles and units, their scales, and where their values come from.

use crate::colour::{self, ColourMap, Scale};
use crate::outdoors::values_of;
use crate::results::Results;
use lightvein::daylight::Quantity;
use lightvein::light::{Reading, Status};
use serde::{Deserialize, Serialize};

/// A quantity with a colour scale of its own, shared by all layers that show it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Measure {
    /// Irradiance, W/m2: at sensors, nodes and faces.
    Irradiance,
    /// The flux through an edge, W.
    Flux,
    /// The radius of a node's ball, metres.
    Radius,
    /// Distance to matter, metres.
    Distance,
    /// Estimate over reference.
    Ratio,
    /// Sun and sky together, kWh/m2.
    Exposure,
    /// The sun, kWh/m2.
    Beam,
    /// The sky, kWh/m2.
    Sky,
    /// What surfaces send, kWh/m2.
    Reflected,
    /// Sky view factor.
    Svf,
    /// Hours of sun.
    SunHours,
    /// Energy of the exposure map, kWh/m2/sr.
    MapRadiance,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Irradiance,
        Self::Flux,
        Self::Radius,
        Self::Distance,
        Self::Ratio,
        Self::Exposure,
        Self::Beam,
        Self::Sky,
        Self::Reflected,
        Self::Svf,
        Self::SunHours,
        Self::MapRadiance,
    ];

    /// What it is, for the title of its legend.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Irradiance => "Irradiance",
            Self::Flux => "Flux through edges",
            Self::Radius => "Ball radius",
            Self::Distance => "Distance to matter",
            Self::Ratio => "Estimate / reference",
            Self::Exposure => "Sun and sky",
            Self::Beam => "Sun",
            Self::Sky => "Sky",
            Self::Reflected => "Reflected",
            Self::Svf => "Sky view factor",
            Self::SunHours => "Hours of sun",
            Self::MapRadiance => "Exposure map",
        }
    }

    /// Its unit; empty for a plain number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Irradiance => "W/m²",
            Self::Flux => "W",
            Self::Radius | Self::Distance => "m",
            Self::Ratio | Self::Svf => "",
            Self::Exposure | Self::Beam | Self::Sky | Self::Reflected => "kWh/m²",
            Self::SunHours => "h",
            Self::MapRadiance => "kWh/m²/sr",
        }
    }

    /// The measure that shows a quantity of an exposure.
    pub const fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Total => Self::Exposure,
            Quantity::Beam => Self::Beam,
            Quantity::Sky => Self::Sky,
            Quantity::Reflected => Self::Reflected,
            Quantity::Svf => Self::Svf,
            Quantity::SunHours => Self::SunHours,
        }
    }

    /// The map that it is shown in at first.
    pub const fn map(self) -> ColourMap {
        match self {
            Self::Ratio => ColourMap::Diverging,
            _ => ColourMap::Viridis,
        }
    }

    /// Whether its scale is logarithmic.
    pub const fn is_logarithmic(self) -> bool {
        matches!(self, Self::Irradiance | Self::Flux | Self::Ratio | Self::MapRadiance)
    }

    /// A scale fitted to its values.
    pub fn fitted(self, values: &[f32], map: ColourMap) -> Scale {
        let values = values.iter().copied();
        let (low, high) = match self {
            Self::Ratio => colour::ratio_range(values),
            Self::Svf => (0.0, 1.0),
            // The whole sky has light: its darkest part is the foot of the scale, not four decades below the brightest.
            Self::MapRadiance => colour::linear_range(values.filter(|value| *value > 0.0)),
            _ if self.is_logarithmic() => colour::flux_range(values),
            _ => colour::linear_range(values),
        };
        Scale { map, low, high, logarithmic: self.is_logarithmic() }
    }

    /// All its values in the results, missing ones as NaN; empty where there are none.
    pub fn values(self, results: &Results) -> Vec<f32> {
        let estimate = results.estimate.as_deref();
        match self {
            Self::Irradiance => {
                let at_nodes = estimate.iter().flat_map(|estimate| &estimate.at_nodes.readings);
                let at_sensors = estimate.iter().flat_map(|estimate| &estimate.at_sensors.readings);
                let at_faces = results.faces.iter().flat_map(|faces| &faces.field.readings);
                at_nodes.chain(at_sensors).chain(at_faces).map(shown).collect()
            }
            Self::Flux => estimate
                .iter()
                .flat_map(|estimate| &estimate.through_edges_w)
                .map(|flux_w| flux_w.abs() as f32)
                .collect(),
            Self::Radius => {
                let nodes = results.model.iter().flat_map(|model| model.skeleton.graph.node_weights());
                nodes.map(|node| node.radius_m).collect()
            }
            Self::Distance => {
                let nodes = results.model.iter().flat_map(|model| {
                    let voxel_m = model.voxels.lattice.voxel_m;
                    model.skeleton.graph.node_weights().map(move |node| f32::from(node.distance_voxels) * voxel_m)
                });
                nodes.collect()
            }
            Self::Ratio => {
                ratios(results).into_iter().map(|ratio| ratio.map_or(f32::NAN, |ratio| ratio as f32)).collect()
            }
            _ => results.outdoors.values(self),
        }
    }
}

impl Measure {
    /// Its value at each sensor, NaN where there is none; empty for what sensors do not have.
    pub fn at_sensors(self, results: &Results) -> Vec<f32> {
        let readings = || results.estimate.iter().flat_map(|estimate| &estimate.at_sensors.readings);
        match self {
            Self::Irradiance => readings().map(shown).collect(),
            Self::Ratio => self.values(results),
            _ => {
                let quantity = Quantity::ALL.into_iter().find(|&quantity| Self::of(quantity) == self);
                let exposures = results.outdoors.sensors.as_ref().map_or(&[][..], |sensors| &sensors.exposures);
                quantity.map_or_else(Vec::new, |quantity| values_of(exposures, quantity).collect())
            }
        }
    }
}

/// A reading as it is coloured: NaN where there is no value.
pub fn shown(reading: &Reading) -> f32 {
    match reading.status {
        Status::Ok | Status::Dark => reading.value_w_m2 as f32,
        Status::InSolid | Status::Unreached | Status::Outside => f32::NAN,
    }
}

/// Estimate over reference at each sensor; `None` where one of them is missing or zero.
pub fn ratios(results: &Results) -> Vec<Option<f64>> {
    let (Some(scene), Some(estimate)) = (&results.scene, &results.estimate) else { return Vec::new() };
    let readings = estimate.at_sensors.readings.iter();
    let ratio = |(number, reading): (usize, &Reading)| {
        let reference = scene.reference.get(number).copied().flatten()?.irradiance_w_m2;
        (reading.status == Status::Ok && reference > 0.0).then(|| reading.value_w_m2 / reference)
    };
    readings.enumerate().map(ratio).collect()
}
