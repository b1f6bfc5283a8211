//! Closure by the logarithm on SE(3): Phi = Log(T_b^-1 T_a)^vee, [CS (3)], with its exact Jacobian.
//! In: relative motion of the end body's two branches. Out: six rows, rotation first.
//!
//! With X = T_b^-1 T_a = (R, p), phi = log R, and V the twist of branch a relative to branch b in the
//! frame of a: Phi_dot = J_r^-1(Phi) V. For Phi = (phi, rho), rho = J_l^-1(phi) p:
//!   J_r^-1(Phi) = [ A 0 ; B A ],  A = 1 + skew(phi)/2 + b skew(phi)²,  x = |phi|²,
//!   B = d(A)[rho] = skew(rho)/2 + b (skew(phi) skew(rho) + skew(rho) skew(phi)) + 2 b' (phi.rho) skew(phi)².
//! b(x) and its derivatives are series-safe intrinsics.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::across::{Across, Sides, weld_axes};
use super::geometry::Geometry;
use super::row::Row;

const NAMES: [&str; 6] = [
    "rotation about x of the end body",
    "rotation about y of the end body",
    "rotation about z of the end body",
    "translation along x of the end body",
    "translation along y of the end body",
    "translation along z of the end body",
];

/// The six rows of a split end body; `across` is in the frame of the copy (branch a). Without `exact`
/// the Jacobian is that of closed positions, where `J_r^-1` is the identity.
pub fn log_rows<'g>(
    g: &'g Scope,
    geometry: &Geometry<'g>,
    across: &Across<'g>,
    sides: Sides,
    exact: bool,
) -> Vec<Row<'g>> {
    let axes = weld_axes(geometry, sides);
    let rotation = across.rotation(g, &axes);
    let logarithm = Logarithm::new(g, rotation, across.distance);
    let zero = g.zero_vector();
    let identity = g.matrix(super::frame::Frame::IDENTITY.0);
    let (a, b) = if exact { logarithm.inverse_jacobian(g) } else { (identity, Mat3([zero; 3])) };
    // Spatial acceleration of the relative twist in the frame of a, for V = 0: Phi_ddot = J_r^-1 V_dot.
    let residual: Vec<Expr<'g>> = logarithm.phi.into_iter().chain(logarithm.rho).collect();
    (0..6)
        .map(|i| {
            let (moment, force) = if i < 3 { (a[i], zero) } else { (b[i - 3], a[i - 3]) };
            let (spun, slid) = (g.dot3(moment, across.omega), g.dot3(force, across.slide));
            let rate = g.add(spun, slid);
            let (spun, slid) = (g.dot3(moment, across.alpha), g.dot3(force, across.acceleration));
            let bias = g.add(spun, slid);
            Row {
                meaning: NAMES[i].to_owned(),
                angular: i < 3,
                residual: residual[i],
                moment,
                force,
                rate,
                bias,
            }
        })
        .collect()
}

/// Log of a pose and what its Jacobian needs.
struct Logarithm<'g> {
    phi: Vec3<'g>,
    rho: Vec3<'g>,
    square: Expr<'g>,
}

impl<'g> Logarithm<'g> {
    /// `distance` is the position of a from b in the frame of a.
    fn new(g: &'g Scope, rotation: Mat3<'g>, distance: Vec3<'g>) -> Self {
        let half = g.constant(0.5);
        let sine = Vec3::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let difference = g.sub(rotation[k][j], rotation[j][k]);
            g.mul(half, difference)
        });
        let partial = g.add(rotation[0][0], rotation[1][1]);
        let trace = g.add(partial, rotation[2][2]);
        let one = g.one();
        let shifted = g.sub(trace, one);
        let cosine = g.mul(half, shifted);
        let sine_squared = g.dot3(sine, sine);
        let stretch = g.angle_over_sine(sine_squared, cosine);
        let phi = g.scale3(stretch, sine);
        let square = g.dot3(phi, phi);
        // rho = J_l^-1(phi) p with p in b; A = J_r^-1 = J_l^-1ᵀ and p_a = Rᵀ p give rho = J_r^-1 p_a.
        let mut own = Self { phi, rho: phi, square };
        let a = own.half_jacobian(g);
        own.rho = g.mul_vec3(a, distance);
        own
    }

    /// A = 1 + skew(phi)/2 + b skew(phi)².
    fn half_jacobian(&self, g: &'g Scope) -> Mat3<'g> {
        let b = g.log_coefficient(0, self.square);
        let half = g.constant(0.5);
        let skew = g.skew3(self.phi);
        let squared = g.mul_mat3(skew, skew);
        let identity = g.matrix(super::frame::Frame::IDENTITY.0);
        let first = half * skew;
        let second = b * squared;
        let sum = g.add_mat3(identity, first);
        g.add_mat3(sum, second)
    }

    /// The blocks A and B of the inverse right Jacobian.
    fn inverse_jacobian(&self, g: &'g Scope) -> (Mat3<'g>, Mat3<'g>) {
        let a = self.half_jacobian(g);
        let (b, slope) = (g.log_coefficient(0, self.square), g.log_coefficient(1, self.square));
        let (half, two) = (g.constant(0.5), g.constant(2.0));
        let (phi, rho) = (g.skew3(self.phi), g.skew3(self.rho));
        let (left, right) = (g.mul_mat3(phi, rho), g.mul_mat3(rho, phi));
        let mixed = g.add_mat3(left, right);
        let squared = g.mul_mat3(phi, phi);
        let along = g.dot3(self.phi, self.rho);
        let doubled = g.mul(two, slope);
        let weight = g.mul(doubled, along);
        let first = half * rho;
        let second = b * mixed;
        let third = weight * squared;
        let sum = g.add_mat3(first, second);
        (a, g.add_mat3(sum, third))
    }
}
