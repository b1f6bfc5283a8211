//! Descriptions as bytes.

use linkwear_runtime::contact::{Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::{Area, Measure, Step};
use linkwear_runtime::{
    BendInfo, Channel, CoefficientFactor, ContactInfo, Description, DriverInfo, GammaRates, InputRole,
    JournalWear, MissionInfo, Motion, ParameterInfo, RowInfo, SegmentInfo, VariableInfo, WearInfo,
};

use super::{Damage, Stored};
use crate::stored;

/// Laws that files pick by a word are stored by that word.
macro_rules! worded {
    ($Law:ident) => {
        impl Stored for $Law {
            fn write(&self, to: &mut Vec<u8>) {
                self.name().to_owned().write(to);
            }

            fn read(from: &mut &[u8]) -> Result<Self, Damage> {
                let word = String::read(from)?;
                let law = Self::ALL.iter().find(|law| law.name() == word);
                law.copied().ok_or_else(|| Damage::value(format!("no law is called `{word}`")))
            }
        }
    };
}

worded!(Restitution);
worded!(Area);
worded!(Measure);
stored!(enum Strength {
    0: Coulomb { coefficient },
    1: Stribeck { static_coefficient, kinetic_coefficient, stribeck_speed, exponent },
});
stored!(enum Onset { 0: Smoothed { speed }, 1: Ambrosio { lower, upper } });
stored!(enum Stiffness { 0: Given(constant), 1: Hertz { modulus } });
stored!(enum Motion { 0: Scalar { driver }, 1: Rotation, 2: Pose });
stored!(enum InputRole { 0: Value, 1: RateOfPrevious });
stored!(struct GammaRates { alpha, beta });
stored!(struct ParameterInfo { name, unit, default });
stored!(struct VariableInfo { name, unit, held });
stored!(struct RowInfo { joint, meaning, angular, kept });
stored!(struct DriverInfo { joint, angular });
stored!(struct Channel { name, unit, wraps });
stored!(struct WearInfo {
    coefficient, hardness, area, measure, feedback, profile, bins, threshold, revolutions_per_cycle,
    pressure_speed, scatter, cycle_variation,
});
stored!(struct ContactInfo {
    joint, ball, journal_radius, length, modulus, stiffness, law, restitution, exponent, impact_speed_floor,
    friction, wear,
});
stored!(struct JournalWear { contact, ratio });
stored!(enum Step {
    0: Number(value), 1: Given(index), 2: Neg(a), 3: Sqrt(a), 4: Sin(a), 5: Cos(a), 6: Exp(a), 7: Ln(a), 8: Floor(a), 9: Add(a, b),
    10: Sub(a, b), 11: Mul(a, b), 12: Div(a, b), 13: Atan2(a, b), 14: Select(a, yes, no),
});
stored!(struct CoefficientFactor { contact, steps });
stored!(struct SegmentInfo { name, amount, values, factors });
stored!(struct MissionInfo { name, ordered, segments, coarser });
stored!(struct BendInfo { body, length, first, modes, shapes });
stored!(struct Description {
    name, parameters, inputs, coordinates, speeds, motions, quaternions, rows, drivers, channels, turn_driver, contacts,
    journals, coefficients, guides, missions, bends,
});
