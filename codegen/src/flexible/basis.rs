//! The displacement field by scalar shape functions: what both planes of a body share is there once.
//! In: tables of a body. Out: [`Basis`]. Plain numbers.
//!
//! The components of all shapes are functions `w_j` of the place: `φ_k = Σ_j e_kj w_j` with constant vectors `e_kj`.
//! Components whose integrals are all in one ratio are one function, because the equations of motion know only integrals.

use super::data::ModalData;

/// Numbers of a body are good to some 1e-14 of what Cauchy and Schwarz allow them, and made equal to 1e-12 of their
/// size: what differs by less than this is the same function.
const SAME: f64 = 1e-12;

/// A function with its integrals over the mass of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFunction {
    /// ∫ w dm.
    pub integral: f64,
    /// ∫ rbar w dm.
    pub first: [f64; 3],
}

/// Shape functions of one body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Basis {
    /// The functions.
    pub functions: Vec<ShapeFunction>,
    /// ∫ w_i w_j dm.
    pub gram: Vec<Vec<f64>>,
    /// e_kj, by mode and function.
    pub directions: Vec<Vec<[f64; 3]>>,
}

/// A component of a shape: mode and axis.
type Component = (usize, usize);

impl ModalData {
    /// The shape functions; nothing where the field is not linear in the modal coordinates, where the mass matrix is
    /// not that of the field, or where the components of the shapes have too little in common.
    pub fn basis(&self) -> Option<Basis> {
        if self.second_order.is_some() || !self.has_mass_of_its_field() {
            return None;
        }
        let modes = self.mode_count();
        let gram = |(k, i): Component, (l, j): Component| self.coupling[k][l][i][j];
        let components: Vec<Component> = (0..modes).flat_map(|k| (0..3).map(move |i| (k, i))).collect();
        let largest = components.iter().map(|c| gram(*c, *c)).fold(0.0, f64::max);
        // The square of a component of the size of its rounding.
        let moving: Vec<Component> =
            components.iter().copied().filter(|c| gram(*c, *c) > 1e-14 * largest).collect();
        let mut chosen: Vec<Component> = Vec::new();
        let mut directions: Vec<Vec<[f64; 3]>> = vec![Vec::new(); modes];
        for component in &moving {
            let known = chosen
                .iter()
                .enumerate()
                .find_map(|(j, other)| self.ratio(*component, *other, &moving).map(|ratio| (j, ratio)));
            let (at, weight) = known.unwrap_or((chosen.len(), 1.0));
            if at == chosen.len() {
                chosen.push(*component);
                directions.iter_mut().for_each(|row| row.push([0.0; 3]));
            }
            directions[component.0][at][component.1] = weight;
        }
        // With as many functions as modes and planes nothing is gained, and large bodies would cost much to find out.
        if chosen.len() > 2 * modes {
            return None;
        }
        let functions = chosen.iter().map(|(k, i)| ShapeFunction {
            integral: self.gamma[*k][*i],
            first: std::array::from_fn(|axis| self.moment[*k][axis][*i]),
        });
        let gram = chosen.iter().map(|a| chosen.iter().map(|b| gram(*a, *b)).collect()).collect();
        Some(Basis { functions: functions.collect(), gram, directions })
    }

    /// Whether M_kl is the trace of N_kl.
    fn has_mass_of_its_field(&self) -> bool {
        let n = self.mode_count();
        let trace = |k: usize, l: usize| (0..3).map(|i| self.coupling[k][l][i][i]).sum::<f64>();
        (0..n).all(|k| {
            (0..n).all(|l| {
                let size = (trace(k, k) * trace(l, l)).sqrt();
                (self.mass_matrix[k][l] - trace(k, l)).abs() <= SAME * size
            })
        })
    }

    /// `a / b`, if all integrals of both components are in this ratio.
    fn ratio(&self, a: Component, b: Component, all: &[Component]) -> Option<f64> {
        let gram = |(k, i): Component, (l, j): Component| self.coupling[k][l][i][j];
        let size = |c: Component| gram(c, c).sqrt();
        let ratio = gram(a, b) / gram(b, b);
        // Equal bits stay equal: a ratio of one is exactly one.
        let ratio = if (ratio.abs() - 1.0).abs() <= SAME { ratio.signum() } else { ratio };
        let same = |of_a: f64, of_b: f64, scale: f64| (of_a - ratio * of_b).abs() <= SAME * scale;
        let integrals = same(self.gamma[a.0][a.1], self.gamma[b.0][b.1], self.mass.sqrt() * size(a));
        let first = (0..3).all(|axis| {
            let scale = self.second_moment[axis][axis].sqrt() * size(a);
            same(self.moment[a.0][axis][a.1], self.moment[b.0][axis][b.1], scale)
        });
        let products = all.iter().all(|c| same(gram(a, *c), gram(b, *c), size(a) * size(*c)));
        (ratio.abs() > SAME && integrals && first && products).then_some(ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::super::cloud::Cloud;
    use super::*;

    /// What the basis makes of the tables, against the tables.
    fn assert_same(data: &ModalData, basis: &Basis) {
        let n = data.mode_count();
        let functions = basis.functions.len();
        // Ratios are exact to 1e-12 of what Cauchy and Schwarz allow; these bodies are of the order of one.
        let same = |a: f64, b: f64| assert!((a - b).abs() < 1e-11, "{a} is not {b}");
        for k in 0..n {
            for i in 0..3 {
                let part = |j: usize| basis.directions[k][j][i];
                same((0..functions).map(|j| part(j) * basis.functions[j].integral).sum(), data.gamma[k][i]);
                for axis in 0..3 {
                    let first = (0..functions).map(|j| part(j) * basis.functions[j].first[axis]);
                    same(first.sum(), data.moment[k][axis][i]);
                }
                for l in 0..n {
                    for m in 0..3 {
                        let sum = (0..functions).flat_map(|j| (0..functions).map(move |h| (j, h)));
                        let sum = sum.map(|(j, h)| part(j) * basis.gram[j][h] * basis.directions[l][h][m]);
                        same(sum.sum(), data.coupling[k][l][i][m]);
                    }
                }
            }
        }
    }

    #[test]
    fn both_planes_of_a_rod_share_their_deflections() {
        for modes in 1..=3 {
            let data = Cloud::rod(modes, 3).data();
            let basis = data.basis().expect("a basis");
            // A deflection for both planes and a tilt for each.
            assert_eq!(basis.functions.len(), 3 * modes);
            assert_same(&data, &basis);
        }
    }

    #[test]
    fn functions_in_several_components_are_found_with_their_weights() {
        for modes in 2..=4 {
            let data = Cloud::any(modes, 11).data();
            let basis = data.basis().expect("a basis");
            assert_same(&data, &basis);
        }
    }

    #[test]
    fn bodies_without_common_functions_have_no_basis() {
        let mut cloud = Cloud::any(2, 5);
        // Three components of each of two modes: six functions.
        let mut next = super::super::cloud::numbers(8);
        cloud.points.iter_mut().for_each(|point| point.shapes = (0..6).map(|_| next()).collect());
        for k in 0..2 {
            cloud.directions[k] =
                (0..6).map(|j| std::array::from_fn(|i| f64::from(u8::from(j == 3 * k + i)))).collect();
        }
        assert_eq!(cloud.data().basis(), None);
    }

    #[test]
    fn a_mass_matrix_that_is_not_of_the_field_has_no_basis() {
        let mut data = Cloud::rod(2, 3).data();
        data.mass_matrix[1][1] *= 1.0 + 1e-9;
        assert_eq!(data.basis(), None);
    }
}
