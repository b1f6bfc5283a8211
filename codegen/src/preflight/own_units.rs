//! Lengths in units of the mechanism's own size, so that what preflight answers is the same for a watch and a crane.
//! In: joint points at the reference pose. Out: factors of speeds, rows and columns. Never judges.

use linkwear_runtime::Description;

use crate::model::{Mechanism, Position};

/// Factors from pure numbers, lengths in units of the mechanism's size, to SI.
#[derive(Clone, Debug)]
pub struct OwnUnits {
    /// The unit of length [m].
    pub length: f64,
    /// Of every speed.
    pub speeds: Vec<f64>,
    /// Of the residual of every row.
    pub rows: Vec<f64>,
    /// Of every output column: lengths and velocities by the length, moments too; forces stay.
    pub channels: Vec<f64>,
}

impl OwnUnits {
    /// The units of a mechanism, for the layout of a derivation without drivers.
    pub fn new(mechanism: &Mechanism, description: &Description) -> Self {
        let length = size(mechanism);
        let linear = |unit: &str, units: &[&str]| if units.contains(&unit) { length } else { 1.0 };
        Self {
            length,
            speeds: description.speeds.iter().map(|speed| linear(&speed.unit, &["m/s"])).collect(),
            rows: description.rows.iter().map(|row| if row.angular { 1.0 } else { length }).collect(),
            channels: description
                .channels
                .iter()
                .map(|channel| linear(&channel.unit, &["m", "m/s", "N m"]))
                .collect(),
        }
    }
}

/// Largest distance [m] along a ground axis between points where joints are; of a mechanism without any, 1 m.
fn size(mechanism: &Mechanism) -> f64 {
    let parameters = mechanism.parameter_values();
    let places: Vec<[f64; 3]> = mechanism
        .joints
        .iter()
        .flat_map(|joint| match &mechanism.point(joint.at).position {
            Position::Shared(place) => vec![place],
            Position::PerBody(places) => places.iter().map(|(_, place)| place).collect(),
        })
        .map(|place| std::array::from_fn(|axis| place[axis].value(&parameters).unwrap_or(0.0)))
        .collect();
    let extent = |axis: usize| {
        let values = places.iter().map(|place| place[axis]);
        values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
    };
    let size = (0..3).map(extent).fold(0.0, f64::max);
    if size.is_finite() && size > 0.0 { size } else { 1.0 }
}
