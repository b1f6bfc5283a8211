//! Motion of a node of a flexible body relative to its floating frame, [CS (4), (5)].
//! In: shapes at the node, modal coordinates. Out: place, orientation, and how the modes move them.
//! Never knows mass.
//!
//! A section turns by the small-rotation vector `theta = sum psi_k q_k`. To stay a rotation for every
//! `theta` it is taken as the Gibbs vector `g = theta / 2`, which needs no branch and no sine:
//!   R = 1 + tau (skew(g) + skew(g)²),  omega = tau (g_dot + g x g_dot),  tau = 2 / (1 + g.g).

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::flexible::Node;

use super::frame::Frame;

/// Shapes of all modes at one node, in the floating frame.
#[derive(Clone, Debug)]
pub struct NodeShape {
    /// Place in the undeformed body [m].
    pub position: [f64; 3],
    /// Displacement per unit of each modal coordinate.
    pub displacement: Vec<[f64; 3]>,
    /// Rotation vector per unit of each modal coordinate; empty if the node's link does not turn.
    pub rotation: Vec<[f64; 3]>,
    /// Displacement of second order: `1/2 sum q_k q_l chi_kl`; empty for none.
    pub second: Vec<Vec<[f64; 3]>>,
}

impl NodeShape {
    /// Shapes at a node; `turns` asks for the section's orientation too.
    #[must_use]
    pub fn new(node: &Node, turns: bool) -> Self {
        let still = node.rotation.iter().flatten().all(|x| *x == 0.0);
        Self {
            position: node.position,
            displacement: node.displacement.clone(),
            rotation: if turns && !still { node.rotation.clone() } else { Vec::new() },
            second: node.displacement2.clone().unwrap_or_default(),
        }
    }

    /// Whether the node moves relative to the floating frame at all.
    #[must_use]
    pub fn moves(&self) -> bool {
        let second = self.second.iter().flatten();
        let moved = self.displacement.iter().chain(second).flatten().any(|x| *x != 0.0);
        moved || !self.rotation.is_empty()
    }
}

/// A node for given modal coordinates, in the floating frame.
#[derive(Clone, Debug)]
pub struct NodePose<'g> {
    /// Place from the frame's origin [m].
    pub place: Vec3<'g>,
    /// Takes components in the section's frame to the floating frame; nothing if it does not turn.
    pub rotation: Option<Mat3<'g>>,
    /// Velocity of the node per unit of each modal speed.
    pub slide: Vec<Vec3<'g>>,
    /// Angular velocity of the section per unit of each modal speed.
    pub turn: Vec<Vec3<'g>>,
    gibbs: Vec3<'g>,
    tau: Expr<'g>,
}

/// Velocity or acceleration of a node relative to its floating frame, in that frame.
#[derive(Clone, Copy, Debug)]
pub struct NodeMotion<'g> {
    /// Of the node [m/s, m/s²].
    pub slide: Vec3<'g>,
    /// Of the section's orientation [rad/s, rad/s²].
    pub turn: Vec3<'g>,
}

/// `sum weight_k vector_k`.
fn combined<'g>(g: &'g Scope, vectors: &[Vec3<'g>], weights: &[Expr<'g>]) -> Vec3<'g> {
    Vec3::from_fn(|i| g.sum(vectors.iter().zip(weights).map(|(vector, weight)| vector[i] * *weight)))
}

impl<'g> NodePose<'g> {
    /// The node for modal coordinates `q`.
    pub fn new(g: &'g Scope, shape: &NodeShape, q: &[Expr<'g>]) -> Self {
        let slide: Vec<Vec3<'g>> = (0..q.len())
            .map(|k| {
                let first = g.vector(shape.displacement[k]);
                match shape.second.get(k) {
                    Some(row) => {
                        let second = g.weighted_vectors(row, q);
                        g.add3(first, second)
                    }
                    None => first,
                }
            })
            .collect();
        let rest = g.vector(shape.position);
        let linear = g.weighted_vectors(&shape.displacement, q);
        let mut place = g.add3(rest, linear);
        if !shape.second.is_empty() {
            let rows: Vec<Vec3<'g>> = shape.second.iter().map(|row| g.weighted_vectors(row, q)).collect();
            let double = combined(g, &rows, q);
            let half = g.constant(0.5);
            let second = g.scale3(half, double);
            place = g.add3(place, second);
        }
        let mut pose =
            Self { place, rotation: None, slide, turn: Vec::new(), gibbs: g.zero_vector(), tau: g.zero() };
        if !shape.rotation.is_empty() {
            pose.turned(g, shape, q);
        }
        pose
    }

    fn turned(&mut self, g: &'g Scope, shape: &NodeShape, q: &[Expr<'g>]) {
        let halves: Vec<[f64; 3]> = shape.rotation.iter().map(|psi| psi.map(|x| 0.5 * x)).collect();
        self.gibbs = g.weighted_vectors(&halves, q);
        let (one, two) = (g.one(), g.constant(2.0));
        let square = g.dot3(self.gibbs, self.gibbs);
        let denominator = g.add(one, square);
        self.tau = g.div(two, denominator);
        let skew = g.skew3(self.gibbs);
        let squared = g.mul_mat3(skew, skew);
        let sum = g.add_mat3(skew, squared);
        let scaled = self.tau * sum;
        let identity = g.matrix(Frame::IDENTITY.0);
        self.rotation = Some(g.add_mat3(identity, scaled));
        self.turn = halves
            .iter()
            .map(|half| {
                let half = g.vector(*half);
                let across = g.cross3(self.gibbs, half);
                let sum = g.add3(half, across);
                g.scale3(self.tau, sum)
            })
            .collect();
    }

    /// Orientation of the section as a unit quaternion, scalar first.
    pub fn quaternion(&self, g: &'g Scope) -> [Expr<'g>; 4] {
        let (one, half, zero) = (g.one(), g.constant(0.5), g.zero());
        if self.rotation.is_none() {
            return [one, zero, zero, zero];
        }
        // 1 / sqrt(1 + g.g) = sqrt(tau / 2).
        let square = g.mul(half, self.tau);
        let scalar = g.sqrt(square);
        let Vec3([x, y, z]) = g.scale3(scalar, self.gibbs);
        [scalar, x, y, z]
    }

    /// Components in the section's frame of a vector in the floating frame.
    pub fn to_section(&self, g: &'g Scope, vector: Vec3<'g>) -> Vec3<'g> {
        match self.rotation {
            Some(rotation) => g.transpose_mul_vec3(rotation, vector),
            None => vector,
        }
    }

    /// Components in the floating frame of a vector in the section's frame.
    pub fn to_floating(&self, g: &'g Scope, vector: Vec3<'g>) -> Vec3<'g> {
        match self.rotation {
            Some(rotation) => g.mul_vec3(rotation, vector),
            None => vector,
        }
    }

    /// Velocity relative to the floating frame.
    pub fn velocity(&self, g: &'g Scope, v: &[Expr<'g>]) -> NodeMotion<'g> {
        NodeMotion { slide: combined(g, &self.slide, v), turn: combined(g, &self.turn, v) }
    }

    /// Second derivative of place and orientation relative to the floating frame.
    pub fn acceleration(
        &self,
        g: &'g Scope,
        shape: &NodeShape,
        v: &[Expr<'g>],
        v_dot: &[Expr<'g>],
    ) -> NodeMotion<'g> {
        let mut slide = combined(g, &self.slide, v_dot);
        if !shape.second.is_empty() {
            let rows: Vec<Vec3<'g>> = shape.second.iter().map(|row| g.weighted_vectors(row, v)).collect();
            let bias = combined(g, &rows, v);
            slide = g.add3(slide, bias);
        }
        let mut turn = combined(g, &self.turn, v_dot);
        if self.rotation.is_some() {
            // omega_dot = tau (g_ddot + g x g_ddot) - tau (g . g_dot) omega.
            let halves: Vec<[f64; 3]> = shape.rotation.iter().map(|psi| psi.map(|x| 0.5 * x)).collect();
            let rate = g.weighted_vectors(&halves, v);
            let along = g.dot3(self.gibbs, rate);
            let weight = g.mul(self.tau, along);
            let omega = combined(g, &self.turn, v);
            let lost = g.scale3(weight, omega);
            turn = g.sub3(turn, lost);
        }
        NodeMotion { slide, turn }
    }

    /// Power per unit of each modal speed of a wrench on the node: moment about the node, floating frame.
    pub fn generalised(&self, g: &'g Scope, moment: Vec3<'g>, force: Vec3<'g>) -> Vec<Expr<'g>> {
        (0..self.slide.len())
            .map(|k| {
                let slid = g.dot3(self.slide[k], force);
                match self.turn.get(k) {
                    Some(turn) => {
                        let turned = g.dot3(*turn, moment);
                        g.add(slid, turned)
                    }
                    None => slid,
                }
            })
            .collect()
    }

    /// Twist of the section's frame relative to the floating frame per unit of modal speed `k`:
    /// angular velocity, velocity of the node; floating frame.
    pub fn screw(&self, g: &'g Scope, k: usize) -> [Vec3<'g>; 2] {
        let turn = self.turn.get(k).copied();
        [turn.unwrap_or_else(|| g.zero_vector()), self.slide[k]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node() -> NodeShape {
        NodeShape {
            position: [0.2, 0.0, 0.0],
            displacement: vec![[0.0, 1.5, 0.0], [0.1, 0.0, -0.7]],
            rotation: vec![[0.3, 0.0, 2.0], [0.0, -1.1, 0.4]],
            second: vec![vec![[-0.4, 0.0, 0.0], [-0.1, 0.0, 0.0]], vec![[-0.1, 0.0, 0.0], [-0.6, 0.0, 0.0]]],
        }
    }

    type Snapshot = ([[f64; 3]; 3], [f64; 3], [[f64; 3]; 4]);

    /// Rotation, place and their rates for q(t) = a + b t + c t²/2.
    fn at(time: f64) -> Snapshot {
        let (a, b, c) = ([0.4, -0.3], [0.9, 1.3], [-0.5, 0.8]);
        let g = Scope::new();
        let pick = |f: &dyn Fn(usize) -> f64| [f(0), f(1)];
        let q = pick(&|i| a[i] + b[i] * time + 0.5 * c[i] * time * time).map(|x| g.constant(x));
        let v = pick(&|i| b[i] + c[i] * time).map(|x| g.constant(x));
        let v_dot = pick(&|i| c[i]).map(|x| g.constant(x));
        let shape = node();
        let pose = NodePose::new(&g, &shape, &q);
        let rate = pose.velocity(&g, &v);
        let acceleration = pose.acceleration(&g, &shape, &v, &v_dot);
        let number = |x: Expr<'_>| x.as_number().expect("functions of numbers fold");
        let rotation = pose.rotation.expect("the node turns").0.map(|row| row.0.map(number));
        let rates = [rate.slide, rate.turn, acceleration.slide, acceleration.turn];
        (rotation, pose.place.0.map(number), rates.map(|v| v.0.map(number)))
    }

    #[test]
    fn rates_are_the_derivatives_of_place_and_orientation() {
        let h = 1e-5;
        let (back, now, next) = (at(-h), at(0.0), at(h));
        for i in 0..3 {
            // Central differences of smooth functions: h² and rounding over h, both below 1e-9.
            let slope = |f: &dyn Fn(&Snapshot) -> f64| (f(&next) - f(&back)) / (2.0 * h);
            assert!((slope(&|s| s.1[i]) - now.2[0][i]).abs() < 1e-8);
            assert!((slope(&|s| s.2[0][i]) - now.2[2][i]).abs() < 1e-8);
            assert!((slope(&|s| s.2[1][i]) - now.2[3][i]).abs() < 1e-8);
            // skew(omega) = R_dot Rᵀ.
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let omega: f64 = (0..3).map(|l| slope(&|s| s.0[k][l]) * now.0[j][l]).sum();
            assert!((omega - now.2[1][i]).abs() < 1e-8);
        }
    }

    #[test]
    fn orientation_stays_a_rotation_for_large_modal_coordinates() {
        let (rotation, ..) = at(1.7);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| rotation[i][k] * rotation[j][k]).sum();
                // A few roundings of numbers below one.
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }
}
