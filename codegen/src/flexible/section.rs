//! Cross-sections and materials.
//! In: shape and sizes. Out: area, second moments, torsion constant, shear coefficients, outermost fibres.

use std::f64::consts::PI;

use super::data::Outline;
use super::error::BeamError;

/// An isotropic linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio nu; the shear modulus is E / (2 (1 + nu)).
    pub poisson_ratio: f64,
    /// Density [kg/m³].
    pub density: f64,
}

/// A cross-section; y and z are its principal axes through the centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Section {
    /// A full circle.
    Round {
        /// Radius [m].
        radius: f64,
    },
    /// A circular tube.
    Tube {
        /// Outer radius [m].
        outer: f64,
        /// Inner radius [m].
        inner: f64,
    },
    /// A full rectangle.
    Rectangle {
        /// Full size along y [m].
        y: f64,
        /// Full size along z [m].
        z: f64,
    },
    /// Anything else, by its properties.
    General(Properties),
}

/// Properties of a cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Area A [m²].
    pub area: f64,
    /// Iy = ∫ z² dA [m⁴]: bending along z.
    pub iy: f64,
    /// Iz = ∫ y² dA [m⁴]: bending along y.
    pub iz: f64,
    /// Torsion constant J [m⁴].
    pub torsion: f64,
    /// Shear coefficients for forces along y and z; Timoshenko's theory needs them.
    pub shear: Option<[f64; 2]>,
    /// Where the outermost fibres are; bending stress needs it.
    pub outline: Option<Outline>,
}

impl Section {
    /// Properties of the section; `nu` enters Cowper's shear coefficients.
    ///
    /// G. R. Cowper, The Shear Coefficient in Timoshenko's Beam Theory, J. Appl. Mech. 33 (1966).
    pub fn properties(&self, nu: f64) -> Properties {
        match *self {
            Self::Round { radius } => tube(radius, 0.0, nu),
            Self::Tube { outer, inner } => tube(outer, inner, nu),
            Self::Rectangle { y, z } => {
                let kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
                Properties {
                    area: y * z,
                    iy: y * (z * z * z) / 12.0,
                    iz: z * (y * y * y) / 12.0,
                    torsion: rectangle_torsion(y.max(z), y.min(z)),
                    shear: Some([kappa; 2]),
                    outline: Some(Outline::Box { y: y / 2.0, z: z / 2.0 }),
                }
            }
            Self::General(properties) => properties,
        }
    }

    /// Checked properties of segment number `segment`.
    pub(super) fn checked(&self, nu: f64, segment: usize) -> Result<Properties, BeamError> {
        let positive = |(what, value): (&'static str, f64)| {
            let fine = value.is_finite() && value > 0.0;
            if fine { Ok(()) } else { Err(BeamError::NotPositive { what, segment, value }) }
        };
        let sizes = match *self {
            Self::Round { radius } => vec![("radius", radius)],
            Self::Tube { outer, inner } => vec![("outer radius", outer), ("inner radius", inner)],
            Self::Rectangle { y, z } => vec![("size along y", y), ("size along z", z)],
            Self::General(_) => vec![],
        };
        sizes.into_iter().try_for_each(positive)?;
        if matches!(*self, Self::Tube { outer, inner } if inner >= outer) {
            return Err(BeamError::Bore { segment });
        }
        let properties = self.properties(nu);
        let Properties { area, iy, iz, torsion, .. } = properties;
        [("area", area), ("Iy", iy), ("Iz", iz), ("torsion constant", torsion)]
            .into_iter()
            .try_for_each(positive)?;
        let shear = properties.shear.into_iter().flatten();
        shear.map(|coefficient| ("shear coefficient", coefficient)).try_for_each(positive)?;
        let fibres = match properties.outline {
            Some(Outline::Round { radius }) => vec![radius],
            Some(Outline::Box { y, z }) => vec![y, z],
            None => vec![],
        };
        fibres.into_iter().map(|distance| ("fibre distance", distance)).try_for_each(positive)?;
        Ok(properties)
    }
}

fn tube(outer: f64, inner: f64, nu: f64) -> Properties {
    let (outer2, inner2) = (outer * outer, inner * inner);
    let second = PI / 4.0 * (outer2 * outer2 - inner2 * inner2);
    let ratio2 = inner2 / outer2;
    let wide = (1.0 + ratio2) * (1.0 + ratio2);
    let kappa = 6.0 * (1.0 + nu) * wide / ((7.0 + 6.0 * nu) * wide + (20.0 + 12.0 * nu) * ratio2);
    Properties {
        area: PI * (outer2 - inner2),
        iy: second,
        iz: second,
        torsion: 2.0 * second,
        shear: Some([kappa; 2]),
        outline: Some(Outline::Round { radius: outer }),
    }
}

/// Torsion constant of a rectangle with sides `long` >= `short`: Saint-Venant's series.
fn rectangle_torsion(long: f64, short: f64) -> f64 {
    let ratio = long / short;
    // Terms fall like n⁻⁵: after 400 odd terms the rest is below 1e-13 of the sum.
    let series: f64 = (0..400)
        .rev()
        .map(|term| {
            let n = f64::from(2 * term + 1);
            tanh(n * PI * ratio / 2.0) / (n * n * n * n * n)
        })
        .sum();
    let pi5 = PI * PI * PI * PI * PI;
    long * (short * short * short) / 3.0 * (1.0 - 192.0 / pi5 / ratio * series)
}

/// tanh for arguments above 1, from plain arithmetic: the platform's own may differ between machines in the last bit.
fn tanh(x: f64) -> f64 {
    // Beyond 20 the difference from 1 is below half a unit in the last place.
    if x > 20.0 {
        return 1.0;
    }
    let small = -2.0 * x / 1024.0;
    // |small| < 0.04: eight terms leave an error below 1e-17.
    let mut power: f64 = (1..=8).rev().fold(1.0, |sum, n| 1.0 + sum * small / f64::from(n));
    for _ in 0..10 {
        power *= power;
    }
    (1.0 - power) / (1.0 + power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cowper_coefficients_of_steel_sections() {
        let kappa = |section: Section| section.properties(0.3).shear.expect("known sections shear")[0];
        // Quotients worked out by hand from Cowper's formulas; 1e-4 is their printed rounding.
        assert!((kappa(Section::Round { radius: 0.006 }) - 0.8864).abs() < 1e-4);
        assert!((kappa(Section::Rectangle { y: 0.01, z: 0.02 }) - 0.8497).abs() < 1e-4);
        // A thin tube: 2 (1 + nu) / (4 + 3 nu) = 0.5306, approached quadratically in the wall.
        assert!((kappa(Section::Tube { outer: 1.0, inner: 0.999 }) - 0.5306).abs() < 1e-4);
    }

    #[test]
    fn a_square_twists_as_in_the_tables() {
        // Timoshenko and Goodier: 0.1406 a⁴ for a square, 0.2287 a b³ for 1 : 2; four printed digits.
        assert!((rectangle_torsion(1.0, 1.0) - 0.1406).abs() < 5e-5);
        assert!((rectangle_torsion(2.0, 1.0) / 2.0 - 0.2287).abs() < 5e-5);
    }

    #[test]
    fn tanh_is_the_usual_one() {
        for x in [1.0, 1.5, 3.0, 10.0, 19.0] {
            // Ten squarings double the rounding of exp ten times: 1024 units of 1e-16.
            assert!((tanh(x) - f64::tanh(x)).abs() < 2e-13 * (1.0 - f64::tanh(x)).max(1e-3), "{x}");
        }
    }

    #[test]
    fn a_bore_as_wide_as_the_tube_is_refused() {
        let tube = Section::Tube { outer: 0.01, inner: 0.01 };
        assert_eq!(tube.checked(0.3, 2), Err(BeamError::Bore { segment: 2 }));
    }
}
