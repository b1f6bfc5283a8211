//! Closure by the logarithm on SE(3): Phi = Log(T_b^-1 T_a)^vee, [CS (3)], with its exact Jacobian.
//! In: relative motion of the end body's two branches. Out: six rows, rotation first.
//!
//! With X = T_b^-1 T_a = (R, p), phi = log R, and V the twist of branch a relative to branch b in the
//! frame of a: Phi_dot = J_r^-1(Phi) V. For Phi = (phi, rho), rho = J_l^-1(phi) p:
//!   J_r^-1(Phi) = [ A 0 ; B A ],  A = 1 + skew(phi)/2 + b skew(phi)²,  x = |phi|²,
//!   B = d(A)[rho] = skew(rho)/2 + b (skew(phi) skew(rho) + skew(rho) skew(phi)) + 2 b' (phi.rho) skew(phi)².
//! b(x) and its derivatives are series-safe intrinsics.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::relative_motion::RelativeMotion;
use super::row::{Bias, Row};

/// The six rows of a split end body; `motion` is in the frame of the copy (branch a). Without `exact`
/// the Jacobian is that of closed positions, where `J_r^-1` is the identity.
pub fn log_rows<'g>(motion: &RelativeMotion<'g>, exact: bool) -> Vec<Row<'g>> {
    let g = motion.distance.scope();
    let logarithm = Logarithm::new(g, motion.rotation(), motion.distance);
    let zero = g.zero_vector();
    let (a, b) = if exact { logarithm.inverse_jacobian(g) } else { (g.identity(), Mat3([zero; 3])) };
    // Spatial acceleration of the relative twist in the frame of a, for V = 0: Phi_ddot = J_r^-1 V_dot.
    let residual: Vec<Expr<'g>> = logarithm.phi.into_iter().chain(logarithm.rho).collect();
    (0..6)
        .map(|i| {
            let (moment, force) = if i < 3 { (a[i], zero) } else { (b[i - 3], a[i - 3]) };
            let (way, axis) =
                (if i < 3 { "rotation about" } else { "translation along" }, ["x", "y", "z"][i % 3]);
            let bias = moment.dot(motion.alpha) + force.dot(motion.acceleration);
            Row {
                meaning: format!("{way} {axis} of the end body"),
                angular: i < 3,
                residual: residual[i],
                moment,
                force,
                rate: moment.dot(motion.omega) + force.dot(motion.slide),
                bias: Bias { whole: bias, closed: bias },
            }
        })
        .collect()
}

/// Logarithm of a pose and what its Jacobian needs.
pub struct Logarithm<'g> {
    /// Rotation vector phi [rad].
    pub phi: Vec3<'g>,
    rho: Vec3<'g>,
    square: Expr<'g>,
}

impl<'g> Logarithm<'g> {
    /// `distance` is the position of a from b in the frame of a.
    pub fn new(g: &'g Scope, rotation: Mat3<'g>, distance: Vec3<'g>) -> Self {
        let sine = Vec3::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            0.5 * (rotation[k][j] - rotation[j][k])
        });
        let cosine = 0.5 * (rotation.trace() - 1.0);
        let phi = sine.dot(sine).angle_over_sine(cosine) * sine;
        let square = phi.dot(phi);
        // rho = J_l^-1(phi) p with p in b; A = J_r^-1 = J_l^-1ᵀ and p_a = Rᵀ p give rho = J_r^-1 p_a.
        let mut logarithm = Self { phi, rho: phi, square };
        logarithm.rho = logarithm.half_jacobian(g) * distance;
        logarithm
    }

    /// A = 1 + skew(phi)/2 + b skew(phi)².
    pub fn half_jacobian(&self, g: &'g Scope) -> Mat3<'g> {
        let b = self.square.log_coefficient(0);
        let skew = self.phi.skew();
        let squared = skew * skew;
        let (linear, quadratic) = (0.5 * skew, b * squared);
        g.identity() + linear + quadratic
    }

    /// The blocks A and B of the inverse right Jacobian.
    fn inverse_jacobian(&self, g: &'g Scope) -> (Mat3<'g>, Mat3<'g>) {
        let a = self.half_jacobian(g);
        let (b, slope) = (self.square.log_coefficient(0), self.square.log_coefficient(1));
        let (phi, rho) = (self.phi.skew(), self.rho.skew());
        let mixed = phi * rho + rho * phi;
        let squared = phi * phi;
        let along = self.phi.dot(self.rho);
        let weight = 2.0 * slope * along;
        let (first, second, third) = (0.5 * rho, b * mixed, weight * squared);
        (a, first + second + third)
    }
}
