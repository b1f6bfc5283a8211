//! One finite element of a beam, of any degree.
//!
//! Nodal functions are the exact static solutions between two nodes (for bending with shear: the interdependent
//! cubic and quadratic of deflection and rotation); inner functions are integrated Legendre polynomials, in energy
//! orthogonal to the nodal ones and to each other, with strain energy 1/2. So the stiffness matrix of a uniform
//! element is a small nodal block beside an identity, and low frequencies do not drown in the rounding of a fine mesh:
//! a hundred cubic elements would lose seven digits, a few elements of degree 14 lose none that matter.

use nalgebra::DMatrix;

use super::legendre::{double_integral, integral, legendre};

/// What resists along the element.
#[derive(Clone, Copy, Debug)]
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
#[derive(Clone, Debug)]
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
    /// Nodal unknowns at each end: deflection and rotation, or the value alone.
    pub fn per_node(&self) -> usize {
        match self.rigidity {
            Rigidity::Bending { .. } => 2,
            Rigidity::Bar(_) => 1,
        }
    }

    /// Inner functions, beyond the nodal ones.
    pub fn inner(&self) -> usize {
        match self.rigidity {
            Rigidity::Bending { shear: None, .. } => self.degree - 3,
            Rigidity::Bending { shear: Some(_), .. } => 2 * self.degree - 3,
            Rigidity::Bar(_) => self.degree - 1,
        }
    }

    /// All functions at s in [-1, 1]: nodal ones (left end, right end), then inner ones.
    pub fn fields(&self, s: f64) -> Vec<Field> {
        match self.rigidity {
            Rigidity::Bending { bending, shear } => {
                let mut fields = self.static_bending(s, bending, shear).to_vec();
                self.push_bending(s, bending, shear, &mut fields);
                fields
            }
            Rigidity::Bar(rigidity) => {
                let (h, p) = (self.length, legendre(self.degree, s));
                let nodal =
                    |sign: f64| Field { value: (1.0 + sign * s) / 2.0, strain: sign / h, ..Field::default() };
                let mut fields = vec![nodal(-1.0), nodal(1.0)];
                fields.extend((1..self.degree).map(|j| {
                    let scale = ((2 * j + 1) as f64 / (rigidity * h)).sqrt();
                    Field {
                        value: scale * h / 2.0 * integral(&p, j),
                        strain: scale * p[j],
                        ..Field::default()
                    }
                }));
                fields
            }
        }
    }

    /// Functions of the unit end deflections and rotations without load between the ends.
    fn static_bending(&self, s: f64, bending: f64, shear: Option<f64>) -> [Field; 4] {
        let h = self.length;
        let phi = shear_ratio(bending, shear, h);
        let over = 1.0 / (1.0 + phi);
        let x = f64::midpoint(1.0, s);
        let bubble = x * (1.0 - x);
        let ends = |sign: f64| Field {
            value: if sign < 0.0 {
                over * (1.0 - x * x * (3.0 - 2.0 * x) + phi * (1.0 - x))
            } else {
                over * (x * x * (3.0 - 2.0 * x) + phi * x)
            },
            rotation: sign * 6.0 * over * bubble / h,
            strain: sign * 6.0 * over * (1.0 - 2.0 * x) / (h * h),
            shear: sign * over * phi / h,
        };
        let left = Field {
            value: h * over * bubble * (1.0 - x + phi / 2.0),
            rotation: over * (1.0 - x) * (1.0 - 3.0 * x + phi),
            strain: over * (6.0 * x - 4.0 - phi) / h,
            shear: -over * phi / 2.0,
        };
        let right = Field {
            value: -h * over * bubble * (x + phi / 2.0),
            rotation: over * x * (3.0 * x - 2.0 + phi),
            strain: over * (6.0 * x - 2.0 + phi) / h,
            shear: -over * phi / 2.0,
        };
        [ends(-1.0), left, ends(1.0), right]
    }

    /// Inner functions: curvature P_j with the section normal to the axis; shear P_j with sections at rest; and the one
    /// mix of curvature P_1 and shear P_0 that leaves both ends at rest.
    fn push_bending(&self, s: f64, bending: f64, shear: Option<f64>, fields: &mut Vec<Field>) {
        let (h, half) = (self.length, self.length / 2.0);
        let p = legendre(self.degree, s);
        fields.extend((2..=self.degree - 2).map(|j| {
            let scale = ((2 * j + 1) as f64 / (bending * h)).sqrt();
            Field {
                value: scale * half * half * double_integral(&p, j),
                rotation: scale * half * integral(&p, j),
                strain: scale * p[j],
                shear: 0.0,
            }
        }));
        let Some(shear) = shear else { return };
        fields.extend((1..self.degree).map(|j| {
            let scale = ((2 * j + 1) as f64 / (shear * h)).sqrt();
            Field { value: scale * half * integral(&p, j), shear: scale * p[j], ..Field::default() }
        }));
        let scale = 1.0 / (bending * h / 3.0 + shear * h * h * h / 36.0).sqrt();
        // ∫∫ P_1 = (s³ - 3 s - 2) / 6; with the deflection of the shear h/6 it is 0 at both ends.
        let bend = half * half * (s * s * s - 3.0 * s - 2.0) / 6.0;
        fields.push(Field {
            value: scale * (bend + h / 6.0 * half * (1.0 + s)),
            rotation: scale * half * integral(&p, 1),
            strain: scale * s,
            shear: scale * h / 6.0,
        });
    }

    /// Stiffness between the nodal functions; the rest of the element's stiffness matrix is the identity.
    pub fn nodal_stiffness(&self) -> DMatrix<f64> {
        let h = self.length;
        match self.rigidity {
            Rigidity::Bar(rigidity) => {
                let k = rigidity / h;
                DMatrix::from_row_slice(2, 2, &[k, -k, -k, k])
            }
            Rigidity::Bending { bending, shear } => {
                let phi = shear_ratio(bending, shear, h);
                let k = bending / (h * h * h * (1.0 + phi));
                let (a, b) = (12.0 * k, 6.0 * k * h);
                let (c, d) = ((4.0 + phi) * k * h * h, (2.0 - phi) * k * h * h);
                #[rustfmt::skip]
                let rows = [
                     a,  b, -a,  b,
                     b,  c, -b,  d,
                    -a, -b,  a, -b,
                     b,  d, -b,  c,
                ];
                DMatrix::from_row_slice(4, 4, &rows)
            }
        }
    }
}

/// 12 E I / (kappa G A h²).
fn shear_ratio(bending: f64, shear: Option<f64>, h: f64) -> f64 {
    shear.map_or(0.0, |shear| 12.0 * bending / (shear * h * h))
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
    fn strain_energy_is_the_nodal_block_beside_an_identity() {
        for element in elements() {
            let n = 2 * element.per_node() + element.inner();
            let mut energy = DMatrix::<f64>::zeros(n, n);
            for (s, weight) in gauss(12) {
                let fields = element.fields(s);
                let (e, g) = match element.rigidity {
                    Rigidity::Bending { bending, shear } => (bending, shear.unwrap_or(0.0)),
                    Rigidity::Bar(rigidity) => (rigidity, 0.0),
                };
                for i in 0..n {
                    for j in 0..n {
                        energy[(i, j)] += weight * element.length / 2.0
                            * (e * fields[i].strain * fields[j].strain
                                + g * fields[i].shear * fields[j].shear);
                    }
                }
            }
            let mut expected = DMatrix::identity(n, n);
            let nodal = element.nodal_stiffness();
            expected.view_mut((0, 0), nodal.shape()).copy_from(&nodal);
            // Entries up to 70, twelve points: rounding.
            assert!((energy - expected).amax() < 1e-12, "{:?}", element.rigidity);
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
    fn inner_functions_leave_the_ends_at_rest() {
        for element in elements() {
            for (end, s) in [(0, -1.0), (1, 1.0)] {
                let per = element.per_node();
                for (index, field) in element.fields(s).iter().enumerate() {
                    let nodal = |which| if index == end * per + which { 1.0 } else { 0.0 };
                    // Values are of order 1: rounding.
                    assert!((field.value - nodal(0)).abs() < 1e-14, "{index} {field:?}");
                    assert!(per == 1 || (field.rotation - nodal(1)).abs() < 1e-14, "{index} {field:?}");
                }
            }
        }
    }
}
