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

use super::inertia::MassProperties;
use super::kinematics::{Acceleration, Twist};
use super::motion::ModalState;
use super::wrench::Wrench;

/// What the modes of one body feel, for given modal coordinates.
#[derive(Clone, Debug)]
pub struct ModalMass<'g> {
    /// `Gamma_k(q)`, floating frame.
    pub gamma: Vec<Vec3<'g>>,
    /// `D_k(q)`, floating frame.
    pub moment: Vec<Mat3<'g>>,
    /// `Gamma_kl`; empty without second order.
    pub gamma2: Vec<Vec<[f64; 3]>>,
    /// `∫ rbar chi_klᵀ dm`; empty without second order.
    pub moment2: Vec<Vec<[[f64; 3]; 3]>>,
    /// `∫ phi_l x phi_k dm`, at `[l][k]`.
    pub gyroscopic: Vec<Vec<[f64; 3]>>,
    /// `M_ff`.
    pub matrix: Vec<Vec<f64>>,
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
    let columns = b.transpose();
    let terms = a.into_iter().zip(columns).flat_map(|(row, column)| row.into_iter().zip(column));
    a[0][0].scope().sum(terms.map(|(x, y)| x * y))
}

/// Mass properties of the deformed body and what its modes feel.
pub fn deformed<'g>(g: &'g Scope, data: &ModalData, q: &[Expr<'g>]) -> (MassProperties<'g>, ModalMass<'g>) {
    let n = q.len();
    let second = data.second_order.as_ref();
    let (gamma2, moment2) =
        second.map_or((Vec::new(), Vec::new()), |order| (order.gamma.clone(), order.moment.clone()));
    let transposed = |l: usize, k: usize| data.coupling[l][k];
    let mut own = ModalMass {
        gamma: data.gamma.iter().map(|gamma| g.vector(*gamma)).collect(),
        moment: data.moment.iter().map(|moment| g.matrix(*moment)).collect(),
        gyroscopic: (0..n).map(|l| (0..n).map(|k| axial_of_numbers(transposed(l, k))).collect()).collect(),
        matrix: data.mass_matrix.clone(),
        gamma2,
        moment2,
    };
    let properties = mass_properties(g, data, &own, q);
    for k in 0..n {
        let column: Vec<[[f64; 3]; 3]> = (0..n).map(|l| transposed(l, k)).collect();
        let linear = g.weighted_matrices(&column, q);
        own.moment[k] = g.add_mat3(own.moment[k], linear);
        if let Some(row) = own.moment2.get(k).cloned() {
            let bent = g.weighted_matrices(&row, q);
            own.moment[k] = g.add_mat3(own.moment[k], bent);
        }
        if let Some(row) = own.gamma2.get(k).cloned() {
            let bent = g.weighted_vectors(&row, q);
            own.gamma[k] = g.add3(own.gamma[k], bent);
        }
    }
    (properties, own)
}

/// m, s(q), P(q).
fn mass_properties<'g>(
    g: &'g Scope,
    data: &ModalData,
    own: &ModalMass<'g>,
    q: &[Expr<'g>],
) -> MassProperties<'g> {
    let n = q.len();
    let rest = g.vector(data.first_moment);
    let linear = g.weighted_vectors(&data.gamma, q);
    let mut first = g.add3(rest, linear);
    let both: Vec<[[f64; 3]; 3]> = data
        .moment
        .iter()
        .map(|c| core::array::from_fn(|i| core::array::from_fn(|j| c[i][j] + c[j][i])))
        .collect();
    let rest = g.matrix(data.second_moment);
    let linear = g.weighted_matrices(&both, q);
    let mut second = g.add_mat3(rest, linear);
    for k in 0..n {
        for l in k..n {
            // Coefficient of q_k q_l, which stands twice in the double sum unless k = l.
            let factor = if k == l { 0.5 } else { 1.0 };
            let coupling = (&data.coupling[k][l], &data.coupling[l][k]);
            let bent = own.moment2.get(k).map_or([[0.0; 3]; 3], |row| row[l]);
            let coefficient: [[f64; 3]; 3] = core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    factor * (coupling.0[i][j] + coupling.1[i][j] + bent[i][j] + bent[j][i])
                })
            });
            let product = g.mul(q[k], q[l]);
            let term = g.weighted_matrices(&[coefficient], &[product]);
            second = g.add_mat3(second, term);
            if let Some(row) = own.gamma2.get(k) {
                let term = g.weighted_vectors(&[row[l].map(|x| factor * x)], &[product]);
                first = g.add3(first, term);
            }
        }
    }
    // One triangle, mirrored, so that P is symmetric to the bit.
    let upper = second;
    let second = Mat3::from_fn(|i, j| upper[i.min(j)][i.max(j)]);
    MassProperties { mass: g.constant(data.mass), first, second }
}

impl<'g> ModalMass<'g> {
    /// Inertial wrench about the origin of the body's deformation, in its frame.
    pub fn wrench(&self, g: &'g Scope, twist: &Twist<'g>, modes: &ModalState<'g>) -> Wrench<'g> {
        let (n, two) = (modes.v.len(), g.constant(2.0));
        let (mut drift, mut force) = (g.zero_vector(), g.zero_vector());
        let mut rate = g.matrix([[0.0; 3]; 3]);
        let mut moment = g.zero_vector();
        for k in 0..n {
            let moved = g.scale3(modes.v[k], self.gamma[k]);
            drift = g.add3(drift, moved);
            let pushed = g.scale3(modes.v_dot[k], self.gamma[k]);
            force = g.add3(force, pushed);
            let turning = modes.v[k] * self.moment[k];
            rate = g.add_mat3(rate, turning);
            let axial = axial(self.moment[k]);
            let spun = g.scale3(modes.v_dot[k], axial);
            moment = g.add3(moment, spun);
            if !self.gamma2.is_empty() {
                let bent = g.weighted_vectors(&self.gamma2[k], &modes.v);
                let bent = g.scale3(modes.v[k], bent);
                force = g.add3(force, bent);
                let row: Vec<[f64; 3]> = self.moment2[k].iter().map(|m| axial_of_numbers(*m)).collect();
                let bent = g.weighted_vectors(&row, &modes.v);
                let bent = g.scale3(modes.v[k], bent);
                moment = g.add3(moment, bent);
            }
        }
        let turned = g.cross3(twist.omega, drift);
        let coriolis = g.scale3(two, turned);
        let trace = {
            let partial = g.add(rate[0][0], rate[1][1]);
            g.add(partial, rate[2][2])
        };
        let along = g.scale3(trace, twist.omega);
        let across = g.transpose_mul_vec3(rate, twist.omega);
        let difference = g.sub3(along, across);
        let swung = g.scale3(two, difference);
        Wrench { moment: g.add3(moment, swung), force: g.add3(force, coriolis) }
    }

    /// Inertial force of every mode.
    pub fn modal_forces(
        &self,
        g: &'g Scope,
        twist: &Twist<'g>,
        acceleration: &Acceleration<'g>,
        modes: &ModalState<'g>,
    ) -> Vec<Expr<'g>> {
        let n = modes.v.len();
        let two = g.constant(2.0);
        (0..n)
            .map(|k| {
                let carried = g.dot3(self.gamma[k], acceleration.origin);
                let turned = trace_of_product(acceleration.spin, self.moment[k]);
                let row: Vec<[f64; 3]> = (0..n).map(|l| self.gyroscopic[l][k]).collect();
                let gyroscopic = g.weighted_vectors(&row, &modes.v);
                let half = g.dot3(twist.omega, gyroscopic);
                let coriolis = g.mul(two, half);
                let own = self.own(g, k, &modes.v_dot);
                let sum = g.add(carried, turned);
                let sum = g.add(sum, coriolis);
                g.add(sum, own)
            })
            .collect()
    }

    /// `sum_l M_kl x_l`.
    fn own(&self, g: &'g Scope, k: usize, x: &[Expr<'g>]) -> Expr<'g> {
        let terms: Vec<(Expr<'g>, Expr<'g>)> =
            self.matrix[k].iter().zip(x).map(|(m, x)| (g.constant(*m), *x)).collect();
        g.dot(&terms)
    }

    /// Momentum of the body per unit of modal speed `k`.
    pub fn column(&self, k: usize) -> Wrench<'g> {
        Wrench { moment: axial(self.moment[k]), force: self.gamma[k] }
    }

    /// Twice the kinetic energy of deformation: what modal speeds add to that of the frozen body [J].
    pub fn double_energy(&self, g: &'g Scope, twist: &Twist<'g>, v: &[Expr<'g>]) -> Expr<'g> {
        let two = g.constant(2.0);
        let mut sum = g.zero();
        for k in 0..v.len() {
            let momentum = self.column(k).power(g, twist.omega, twist.origin);
            let mixed = g.mul(two, momentum);
            let own = self.own(g, k, v);
            let both = g.add(mixed, own);
            let part = g.mul(v[k], both);
            sum = g.add(sum, part);
        }
        sum
    }
}
