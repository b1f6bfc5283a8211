//! Floating-frame inertia of a flexible body, [CS (4)-(6)].
//! In: constants of the body ([`crate::flexible::ModalData`]), modal coordinates. Out: mass properties of the
//! deformed body and the terms its modes feel. Never knows where the constants come from.
//!
//! A point of the body is `r = rbar + sum phi_k q_k + 1/2 sum chi_kl q_k q_l`. With
//! `Gamma_k(q) = ∫ dr/dq_k dm` and `D_k(q) = ∫ r (dr/dq_k)ᵀ dm`, kept up to the order that makes the kinetic
//! energy exact to second order in q:
//!   s = s0 + sum q_k Gamma_k + ...,   P = P0 + sum q_k (C_k + C_kᵀ) + ...,   J = tr(P) 1 - P
//!   force       = m a_O + spin s + 2 omega x sum Gamma_k q'_k + sum Gamma_k q''_k + sum Gamma_kl q'_k q'_l
//!   moment      = s x a_O + axial(spin P) + 2 (tr(D') omega - D'ᵀ omega) + sum axial*(D_k) q''_k,  D' = sum D_k q'_k
//!   modal force = Gamma_k . a_O + tr(spin D_k) + 2 omega . sum q'_l axial*(N_lk) + sum M_kl q''_l
//! where `axial*(D) = ∫ r x phi dm`.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::flexible::ModalData;

use super::kinematics::{Acceleration, Twist};
use super::mass_properties::MassProperties;
use super::motion::ModalState;
use super::wrench::Wrench;

/// What the modes of one body feel, for given modal coordinates.
#[derive(Clone, Debug)]
pub struct ModalMass<'g> {
    /// `Gamma_k(q)`, floating frame.
    pub gamma: Vec<Vec3<'g>>,
    /// `D_k(q)`, floating frame.
    pub moment: Vec<Mat3<'g>>,
    /// Constants of the body.
    pub data: &'g ModalData,
}

/// `∫ r x phi dm` of `∫ r phiᵀ dm`.
fn axial_of_numbers(m: [[f64; 3]; 3]) -> [f64; 3] {
    core::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        m[j][k] - m[k][j]
    })
}

/// `∫ r x phi dm` of `∫ r phiᵀ dm`.
fn axial<'g>(m: Mat3<'g>) -> Vec3<'g> {
    m.transpose().axial()
}

/// `tr(a b)`.
fn trace_of_product<'g>(a: Mat3<'g>, b: Mat3<'g>) -> Expr<'g> {
    let pairs = a.into_iter().zip(b.transpose()).flat_map(|(row, column)| row.into_iter().zip(column));
    a[0].scope().sum(pairs.map(|(x, y)| x * y))
}

/// Mass properties of the deformed body and what its modes feel.
pub fn deformed<'g>(
    g: &'g Scope,
    data: &'g ModalData,
    q: &[Expr<'g>],
) -> (MassProperties<'g>, ModalMass<'g>) {
    let mut modal = ModalMass {
        gamma: data.gamma.iter().map(|gamma| g.vector(*gamma)).collect(),
        moment: data.moment.iter().map(|moment| g.matrix(*moment)).collect(),
        data,
    };
    let properties = mass_properties(g, data, q);
    for k in 0..q.len() {
        let column: Vec<[[f64; 3]; 3]> = data.coupling.iter().map(|row| row[k]).collect();
        modal.moment[k] += g.weighted_matrices(&column, q);
        if let Some(second) = &data.second_order {
            modal.moment[k] += g.weighted_matrices(&second.moment[k], q);
            modal.gamma[k] += g.weighted_vectors(&second.gamma[k], q);
        }
    }
    (properties, modal)
}

/// m, s(q), P(q).
fn mass_properties<'g>(g: &'g Scope, data: &ModalData, q: &[Expr<'g>]) -> MassProperties<'g> {
    let n = q.len();
    let mut first = g.vector(data.first_moment) + g.weighted_vectors(&data.gamma, q);
    let both: Vec<[[f64; 3]; 3]> = data
        .moment
        .iter()
        .map(|c| core::array::from_fn(|i| core::array::from_fn(|j| c[i][j] + c[j][i])))
        .collect();
    let mut second = g.matrix(data.second_moment) + g.weighted_matrices(&both, q);
    for k in 0..n {
        for l in k..n {
            // Coefficient of q_k q_l, which stands twice in the double sum unless k = l.
            let factor = if k == l { 0.5 } else { 1.0 };
            let coupling = (&data.coupling[k][l], &data.coupling[l][k]);
            let bent = data.second_order.as_ref().map_or([[0.0; 3]; 3], |order| order.moment[k][l]);
            let coefficient: [[f64; 3]; 3] = core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    factor * (coupling.0[i][j] + coupling.1[i][j] + bent[i][j] + bent[j][i])
                })
            });
            let product = q[k] * q[l];
            second += g.weighted_matrices(&[coefficient], &[product]);
            if let Some(second) = &data.second_order {
                first += g.weighted_vectors(&[second.gamma[k][l].map(|x| factor * x)], &[product]);
            }
        }
    }
    // One triangle, mirrored, so that P is symmetric to the bit.
    let second = Mat3::from_fn(|i, j| second[i.min(j)][i.max(j)]);
    MassProperties { mass: g.number(data.mass), first, second }
}

impl<'g> ModalMass<'g> {
    /// Inertial wrench about the origin of the body's deformation, in its frame.
    pub fn wrench(&self, twist: &Twist<'g>, modes: &ModalState<'g>) -> Wrench<'g> {
        let g = twist.omega.scope();
        let two = g.number(2.0);
        let (mut drift, mut force, mut moment) = (g.zero_vector(), g.zero_vector(), g.zero_vector());
        let mut rate = g.matrix([[0.0; 3]; 3]);
        for (k, (v, v_dot)) in modes.v.iter().zip(&modes.v_dot).enumerate() {
            drift += *v * self.gamma[k];
            force += *v_dot * self.gamma[k];
            rate += *v * self.moment[k];
            moment += *v_dot * axial(self.moment[k]);
            if let Some(second) = &self.data.second_order {
                force += *v * g.weighted_vectors(&second.gamma[k], &modes.v);
                let row: Vec<[f64; 3]> = second.moment[k].iter().map(|m| axial_of_numbers(*m)).collect();
                moment += *v * g.weighted_vectors(&row, &modes.v);
            }
        }
        let coriolis = two * twist.omega.cross(drift);
        let swung = two * (rate.trace() * twist.omega - rate.transpose() * twist.omega);
        Wrench { moment: moment + swung, force: force + coriolis }
    }

    /// Inertial force of every mode.
    pub fn modal_forces(
        &self,
        twist: &Twist<'g>,
        acceleration: &Acceleration<'g>,
        modes: &ModalState<'g>,
    ) -> Vec<Expr<'g>> {
        let g = twist.omega.scope();
        let two = g.number(2.0);
        (0..modes.v.len())
            .map(|k| {
                let carried = self.gamma[k].dot(acceleration.origin);
                let turned = trace_of_product(acceleration.spin, self.moment[k]);
                let row: Vec<[f64; 3]> =
                    self.data.coupling.iter().map(|row| axial_of_numbers(row[k])).collect();
                let coriolis = two * twist.omega.dot(g.weighted_vectors(&row, &modes.v));
                let deforming = self.momentum(k, &modes.v_dot);
                carried + turned + coriolis + deforming
            })
            .collect()
    }

    /// `sum_l M_kl x_l`.
    fn momentum(&self, k: usize, x: &[Expr<'g>]) -> Expr<'g> {
        x[k].scope().weighted(self.data.mass_matrix[k].iter().copied(), x)
    }

    /// Momentum of the body per unit of modal speed `k`.
    pub fn column(&self, k: usize) -> Wrench<'g> {
        Wrench { moment: axial(self.moment[k]), force: self.gamma[k] }
    }

    /// Twice the kinetic energy of deformation: what modal speeds add to that of the rigid body [J].
    pub fn double_energy(&self, twist: &Twist<'g>, v: &[Expr<'g>]) -> Expr<'g> {
        let g = twist.omega.scope();
        let two = g.number(2.0);
        g.sum(v.iter().enumerate().map(|(k, speed)| {
            *speed * (two * self.column(k).power(twist.omega, twist.origin) + self.momentum(k, v))
        }))
    }
}
