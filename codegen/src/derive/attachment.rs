//! Where something is attached to a flexible body: motion of a node relative to its floating frame, [CS (4), (5)].
//! In: shapes at the node, modal coordinates. Out: place, orientation, and how the modes move them.
//! Never knows mass.
//!
//! A section turns by the small-rotation vector `theta = sum psi_k q_k`. To stay a rotation for every
//! `theta` it is taken as the Gibbs vector `g = theta / 2`, which needs no branch and no sine:
//!   R = 1 + tau (skew(g) + skew(g)²),  omega = tau (g_dot + g x g_dot),  tau = 2 / (1 + g.g).

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::flexible::Node;

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

/// `sum weight_k weight_l vector_kl` of constant vectors.
fn quadratic<'g>(g: &'g Scope, vectors: &[Vec<[f64; 3]>], weights: &[Expr<'g>]) -> Vec3<'g> {
    let rows: Vec<Vec3<'g>> = vectors.iter().map(|row| g.weighted_vectors(row, weights)).collect();
    combined(g, &rows, weights)
}

/// Half the rotation vector per unit of each modal coordinate: the Gibbs vector's derivatives.
fn halves(rotation: &[[f64; 3]]) -> Vec<[f64; 3]> {
    rotation.iter().map(|psi| psi.map(|x| 0.5 * x)).collect()
}

impl<'g> NodePose<'g> {
    /// The node for modal coordinates `q`.
    pub fn new(g: &'g Scope, shape: &NodeShape, q: &[Expr<'g>]) -> Self {
        let slide: Vec<Vec3<'g>> = (0..q.len())
            .map(|k| {
                let first = g.vector(shape.displacement[k]);
                shape.second.get(k).map_or(first, |row| first + g.weighted_vectors(row, q))
            })
            .collect();
        let mut place = g.vector(shape.position) + g.weighted_vectors(&shape.displacement, q);
        if !shape.second.is_empty() {
            place += 0.5 * quadratic(g, &shape.second, q);
        }
        let mut pose =
            Self { place, rotation: None, slide, turn: Vec::new(), gibbs: g.zero_vector(), tau: g.zero() };
        if !shape.rotation.is_empty() {
            pose.turned(g, &halves(&shape.rotation), q);
        }
        pose
    }

    fn turned(&mut self, g: &'g Scope, halves: &[[f64; 3]], q: &[Expr<'g>]) {
        let gibbs = g.weighted_vectors(halves, q);
        let (one, two) = (g.number(1.0), g.number(2.0));
        let tau = two / (one + gibbs.dot(gibbs));
        let skew = gibbs.skew();
        let turned = tau * (skew + skew * skew);
        self.rotation = Some(g.identity() + turned);
        self.turn = halves
            .iter()
            .map(|half| {
                let half = g.vector(*half);
                tau * (half + gibbs.cross(half))
            })
            .collect();
        (self.gibbs, self.tau) = (gibbs, tau);
    }

    /// Orientation of the section as a unit quaternion, scalar first.
    pub fn quaternion(&self) -> [Expr<'g>; 4] {
        let g = self.tau.scope();
        let (one, half, zero) = (g.number(1.0), g.number(0.5), g.zero());
        if self.rotation.is_none() {
            return [one, zero, zero, zero];
        }
        // 1 / sqrt(1 + g.g) = sqrt(tau / 2).
        let scalar = (half * self.tau).sqrt();
        let Vec3([x, y, z]) = scalar * self.gibbs;
        [scalar, x, y, z]
    }

    /// Components in the section's frame of a vector in the floating frame.
    pub fn to_section(&self, vector: Vec3<'g>) -> Vec3<'g> {
        self.rotation.map_or(vector, |rotation| rotation.transpose() * vector)
    }

    /// Components in the floating frame of a vector in the section's frame.
    pub fn to_floating(&self, vector: Vec3<'g>) -> Vec3<'g> {
        self.rotation.map_or(vector, |rotation| rotation * vector)
    }

    /// Velocity relative to the floating frame.
    pub fn velocity(&self, v: &[Expr<'g>]) -> NodeMotion<'g> {
        let g = self.tau.scope();
        NodeMotion { slide: combined(g, &self.slide, v), turn: combined(g, &self.turn, v) }
    }

    /// Second derivative of place and orientation relative to the floating frame.
    pub fn acceleration(&self, shape: &NodeShape, v: &[Expr<'g>], v_dot: &[Expr<'g>]) -> NodeMotion<'g> {
        let g = self.tau.scope();
        let mut slide = combined(g, &self.slide, v_dot);
        if !shape.second.is_empty() {
            slide += quadratic(g, &shape.second, v);
        }
        let mut turn = combined(g, &self.turn, v_dot);
        if self.rotation.is_some() {
            // omega_dot = tau (g_ddot + g x g_ddot) - tau (g . g_dot) omega.
            let rate = g.weighted_vectors(&halves(&shape.rotation), v);
            turn -= (self.tau * self.gibbs.dot(rate)) * combined(g, &self.turn, v);
        }
        NodeMotion { slide, turn }
    }

    /// Power per unit of each modal speed of a wrench on the node: moment about the node, floating frame.
    pub fn generalised(&self, moment: Vec3<'g>, force: Vec3<'g>) -> Vec<Expr<'g>> {
        (0..self.slide.len())
            .map(|k| {
                let slid = self.slide[k].dot(force);
                self.turn.get(k).map_or(slid, |turn| slid + turn.dot(moment))
            })
            .collect()
    }

    /// Twist of the section's frame relative to the floating frame per unit of modal speed `k`:
    /// angular velocity, velocity of the node; floating frame.
    pub fn screw(&self, k: usize) -> [Vec3<'g>; 2] {
        let turn = self.turn.get(k).copied();
        [turn.unwrap_or_else(|| self.place.scope().zero_vector()), self.slide[k]]
    }

    /// The same along the section's axes, of all modal speeds.
    pub fn section_screws(&self) -> Vec<[Vec3<'g>; 2]> {
        (0..self.slide.len()).map(|k| self.screw(k).map(|part| self.to_section(part))).collect()
    }

    /// Twist of the floating frame per unit of every modal speed where the node is the inboard one, which stays.
    pub fn frame_screws(&self) -> Vec<[Vec3<'g>; 2]> {
        let against = |[turn, slide]: [Vec3<'g>; 2]| {
            let lever = turn.cross(self.place);
            [-turn, lever - slide]
        };
        (0..self.slide.len()).map(|k| against(self.screw(k))).collect()
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
        let q = pick(&|i| a[i] + b[i] * time + 0.5 * c[i] * time * time).map(|x| g.number(x));
        let v = pick(&|i| b[i] + c[i] * time).map(|x| g.number(x));
        let v_dot = pick(&|i| c[i]).map(|x| g.number(x));
        let shape = node();
        let pose = NodePose::new(&g, &shape, &q);
        let rate = pose.velocity(&v);
        let acceleration = pose.acceleration(&shape, &v, &v_dot);
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
