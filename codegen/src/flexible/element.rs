//! One finite element of a beam, of any degree, described by its strains.
//!
//! Unknowns are Legendre coefficients of curvature and shear (or stretch, or twist), each with strain energy 1/2 at 1; the
//! motion follows by integration from where the element before ends. So the stiffness matrix is the identity, whatever the
//! lengths and rigidities: a short or stiff element beside a long one costs no digits, where nodal deflections lose
//! (L/h)³ of them, and a hundred cubic elements would leave nine of sixteen. All functions of a static solution are
//! among them, so point loads between elements are met exactly, and shear does not lock.

use super::legendre::{double_integral, integral, legendre};

/// What resists along the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rigidity {
    /// Bending in one plane.
    Bending {
        /// E I [N m²].
        bending: f64,
        /// kappa G A [N]; none: sections stay normal to the axis.
        shear: Option<f64>,
    },
    /// Stretching or twisting: E A [N] or G J [N m²].
    Bar(f64),
}

/// A uniform element in one family of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Where it begins [m].
    pub start: f64,
    /// Its length [m].
    pub length: f64,
    /// Polynomial degree of the deflection.
    pub degree: usize,
    /// What resists.
    pub rigidity: Rigidity,
    /// Inertia per length against `Field::value`: kg/m, or kg m for twisting.
    pub inertia: f64,
    /// Inertia per length against `Field::rotation` [kg m].
    pub rotary: f64,
}

/// The motion at one place of the element.
#[derive(Clone, Copy, Debug, Default)]
pub struct Field {
    /// Deflection [m], stretch [m] or twist [rad].
    pub value: f64,
    /// Rotation of the section in the sense of the slope [rad]; 0 in bars.
    pub rotation: f64,
    /// Derivative of the rotation; in bars, of the value [1/m].
    pub strain: f64,
    /// Slope of the axis less rotation [rad].
    pub shear: f64,
}

impl Field {
    /// Slope of the axis [rad]; meaningless in bars.
    pub fn slope(&self) -> f64 {
        self.rotation + self.shear
    }

    /// Adds `factor` times another.
    pub fn add(&mut self, factor: f64, other: &Self) {
        self.value += factor * other.value;
        self.rotation += factor * other.rotation;
        self.strain += factor * other.strain;
        self.shear += factor * other.shear;
    }
}

impl Element {
    /// Number of unknowns.
    pub fn size(&self) -> usize {
        match self.rigidity {
            Rigidity::Bending { shear: None, .. } => self.degree - 1,
            Rigidity::Bending { shear: Some(_), .. } => 2 * self.degree - 1,
            Rigidity::Bar(_) => self.degree,
        }
    }

    /// The motion of every unknown at 1, at s in [-1, 1], with the start of the element at rest.
    pub fn fields(&self, s: f64) -> Vec<Field> {
        let (h, half) = (self.length, self.length / 2.0);
        let p = legendre(self.degree, s);
        // ∫ P_j² over the element is h / (2 j + 1).
        let scale = |rigidity: f64, j: usize| ((2 * j + 1) as f64 / (rigidity * h)).sqrt();
        match self.rigidity {
            Rigidity::Bending { bending, shear } => {
                let curved = (0..self.degree - 1).map(|j| {
                    let scale = scale(bending, j);
                    Field {
                        value: scale * half * half * double_integral(&p, j),
                        rotation: scale * half * integral(&p, j),
                        strain: scale * p[j],
                        shear: 0.0,
                    }
                });
                let sheared = shear.into_iter().flat_map(|shear| {
                    let p = &p;
                    (0..self.degree).map(move |j| {
                        let scale = scale(shear, j);
                        Field {
                            value: scale * half * integral(p, j),
                            shear: scale * p[j],
                            ..Field::default()
                        }
                    })
                });
                curved.chain(sheared).collect()
            }
            Rigidity::Bar(rigidity) => (0..self.degree)
                .map(|j| {
                    let scale = scale(rigidity, j);
                    Field { value: scale * half * integral(&p, j), strain: scale * p[j], ..Field::default() }
                })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::legendre::gauss;
    use super::*;

    fn elements() -> Vec<Element> {
        let kinds = [
            Rigidity::Bending { bending: 3.0, shear: None },
            Rigidity::Bending { bending: 3.0, shear: Some(7.0) },
            Rigidity::Bar(5.0),
        ];
        let of =
            |rigidity| Element { start: 0.5, length: 0.8, degree: 9, rigidity, inertia: 1.0, rotary: 0.1 };
        kinds.into_iter().map(of).collect()
    }

    #[test]
    fn strain_energy_is_the_identity() {
        for element in elements() {
            let n = element.size();
            assert_eq!(element.fields(0.0).len(), n);
            let (e, g) = match element.rigidity {
                Rigidity::Bending { bending, shear } => (bending, shear.unwrap_or(0.0)),
                Rigidity::Bar(rigidity) => (rigidity, 0.0),
            };
            for i in 0..n {
                for j in 0..n {
                    let energy: f64 = gauss(12)
                        .iter()
                        .map(|(s, weight)| {
                            let fields = element.fields(*s);
                            let (a, b) = (fields[i], fields[j]);
                            weight * element.length / 2.0 * (e * a.strain * b.strain + g * a.shear * b.shear)
                        })
                        .sum();
                    let expected = if i == j { 1.0 } else { 0.0 };
                    // Twelve terms up to 20: rounding.
                    assert!((energy - expected).abs() < 1e-13, "{:?} {i} {j} {energy}", element.rigidity);
                }
            }
        }
    }

    #[test]
    fn slopes_and_strains_are_derivatives() {
        for element in elements() {
            let (step, s) = (1e-5, 0.3);
            let (before, at, after) = (element.fields(s - step), element.fields(s), element.fields(s + step));
            let scale = element.length * step;
            let bar = matches!(element.rigidity, Rigidity::Bar(_));
            for ((before, at), after) in before.iter().zip(&at).zip(&after) {
                let slope = (after.value - before.value) / scale;
                let strain = (after.rotation - before.rotation) / scale;
                // Central differences: step² times a third derivative of at most 1e3.
                let expected = if bar { at.strain } else { at.slope() };
                assert!((slope - expected).abs() < 1e-6, "{slope} {at:?}");
                assert!(bar || (strain - at.strain).abs() < 1e-6, "{strain} {at:?}");
            }
        }
    }

    #[test]
    fn the_start_is_at_rest_and_high_coefficients_leave_the_end_too() {
        for element in elements() {
            assert!(element.fields(-1.0).iter().all(|field| field.value == 0.0 && field.rotation == 0.0));
            let end = element.fields(1.0);
            let moved = end.iter().filter(|field| field.value != 0.0 || field.rotation != 0.0).count();
            // Curvature P_0 and P_1; shear, stretch or twist P_0.
            let expected = match element.rigidity {
                Rigidity::Bending { shear: Some(_), .. } => 3,
                Rigidity::Bending { shear: None, .. } => 2,
                Rigidity::Bar(_) => 1,
            };
            assert_eq!(moved, expected);
        }
    }
}
