//! Couplings: one row each on the coordinates of joints, and what wheels feel of its multiplier.
//! In: joint coordinates. Out: [`CouplingRow`]s, wrenches. Never knows how factors follow from teeth.
//!
//! With factors a_i: `phi = sum a_i q_i - offset`, a Jacobian of constants, and nothing of velocities in the bias.

use crate::expr::{Expr, Scope, Vec3};
use crate::id::JointId;
use crate::model::{ByMultiplier, Compliance, Coupling, MeshSide};

use super::joint_state::JointStates;
use super::linkage::LinkIndex;
use super::row::{Bias, Row};
use super::wrench::Wrench;

/// The row of a coupling.
pub struct CouplingRow<'g> {
    /// The row; its unit wrench is not that of two links.
    pub row: Row<'g>,
    /// Columns by all speeds.
    pub jacobian: Vec<Expr<'g>>,
}

/// The rows of all rigid couplings, in the order of the file.
pub fn coupling_rows<'g>(g: &'g Scope, state: &JointStates<'g>) -> Vec<CouplingRow<'g>> {
    state.geometry.mechanism.rigid_couplings().map(|coupling| row_of(g, state, coupling)).collect()
}

/// The sum of a coupling less what it is to be, its rate, and the part of its acceleration that is known.
struct Sum<'g> {
    amount: Expr<'g>,
    rate: Expr<'g>,
    bias: Expr<'g>,
    /// By all speeds.
    factors: Vec<Expr<'g>>,
}

impl<'g> Sum<'g> {
    fn new(g: &'g Scope, state: &JointStates<'g>, coupling: &Coupling) -> Self {
        let linkage = state.geometry.linkage;
        let mut sum = Self {
            amount: g.zero(),
            rate: g.zero(),
            bias: g.zero(),
            factors: vec![g.zero(); linkage.speeds()],
        };
        for term in &coupling.terms {
            let factor = state.lower(g, &term.factor);
            let Some(link) = linkage.link_of_coordinate(term.joint, term.coordinate) else { continue };
            let link = &linkage.links[link];
            // Seen from the other side a joint's axes are opposite, so that its coordinates stay.
            sum.amount += factor * state.q[link.first_coordinate];
            sum.rate += factor * state.v[link.first_speed];
            sum.bias += factor * state.v_dot[link.first_speed];
            sum.factors[link.first_speed] += factor;
        }
        sum.amount -= state.lower(g, &coupling.offset);
        sum
    }
}

fn row_of<'g>(g: &'g Scope, state: &JointStates<'g>, coupling: &Coupling) -> CouplingRow<'g> {
    g.begin_section(format!("coupling {}", coupling.name));
    let Sum { amount, rate, bias, factors } = Sum::new(g, state, coupling);
    let bias = Bias { whole: bias, closed: bias };
    let (moment, force) = (g.zero_vector(), g.zero_vector());
    let meaning = format!("{} of the coupled coordinates", if coupling.angular { "sum" } else { "paths" });
    let row = Row { meaning, angular: coupling.angular, residual: amount, moment, force, rate, bias };
    CouplingRow { row, jacobian: factors }
}

/// The force of a coupling that gives way, in the place of a multiplier; what it stores and takes; its factors by all
/// speeds.
pub struct Given<'g> {
    pub force: Expr<'g>,
    pub stored: Expr<'g>,
    pub dissipated: Expr<'g>,
    pub factors: Vec<Expr<'g>>,
}

/// Damping comes in over this part of half the backlash: a contact begins without a jump.
const SOFT: f64 = 1e-3;

/// Numbers of this size have a square root that is nothing beside any force, and a finite slope at zero.
const NOTHING: f64 = 1e-300;

/// `|x|`.
pub fn size(x: Expr<'_>) -> Expr<'_> {
    (x * x + x.scope().number(NOTHING)).sqrt()
}

/// What a coupling does whose sum misses by x: with half the backlash h, the stretch `d = x - (|x + h| - |x - h|)/2`, and
/// `-force = d max(0, k + c x' d / (d² + s²))`, s a small part of h, so that flanks never pull. Without backlash `k x + c x'`.
pub fn given<'g>(g: &'g Scope, state: &JointStates<'g>, coupling: &Coupling, law: &Compliance) -> Given<'g> {
    let Sum { amount, rate, factors, .. } = Sum::new(g, state, coupling);
    let [k, c, backlash] =
        [&law.stiffness, &law.damping, &law.backlash].map(|formula| state.lower(g, formula));
    if backlash.is_zero() {
        let (elastic, viscous) = (k * amount, c * rate);
        return Given {
            force: -(elastic + viscous),
            stored: 0.5 * (elastic * amount),
            dissipated: viscous * rate,
            factors,
        };
    }
    let half = 0.5 * backlash;
    let stretch = amount - 0.5 * (size(amount + half) - size(amount - half));
    let elastic = k * stretch;
    let soft = (SOFT * half).square();
    let slope = k + c * rate * stretch / (stretch.square() + soft);
    let force = 0.5 * (stretch * (slope + size(slope)));
    Given { force: -force, stored: 0.5 * (elastic * stretch), dissipated: (force - elastic) * rate, factors }
}

/// What follows from a multiplier.
pub struct Multiplied<'g> {
    multiplier: Expr<'g>,
    size: Expr<'g>,
}

impl<'g> Multiplied<'g> {
    pub fn new(multiplier: Expr<'g>) -> Self {
        Self { multiplier, size: size(multiplier) }
    }

    /// A number.
    pub fn number(&self, by: ByMultiplier<f64>) -> Expr<'g> {
        let g = self.multiplier.scope();
        let [constant, signed, pressed] = [by.constant, by.signed, by.pressed].map(|x| g.number(x));
        constant + self.multiplier * signed + self.size * pressed
    }

    fn vector(&self, by: ByMultiplier<[f64; 3]>) -> Vec3<'g> {
        Vec3::from_fn(|i| {
            let ByMultiplier { constant, signed, pressed } = by;
            self.number(ByMultiplier { constant: constant[i], signed: signed[i], pressed: pressed[i] })
        })
    }
}

/// How far a side's body has slid over the carrier, along axes of W at the reference pose.
fn slid<'g>(state: &JointStates<'g>, side: &MeshSide) -> Vec3<'g> {
    let g = state.geometry.g;
    let along = |(joint, direction): &(JointId, [f64; 3])| {
        state.coordinates(g, *joint).position[0] * g.vector(*direction)
    };
    side.slides.iter().map(along).fold(g.zero_vector(), |sum, path| sum + path)
}

/// Wrenches on the links of a coupling's wheels, each in the link's frame about its origin. Teeth meet where the carrier has them, however
/// far a rack has slid.
pub fn mesh_wrenches<'g>(
    state: &JointStates<'g>,
    coupling: &Coupling,
    by: &Multiplied<'g>,
) -> Vec<(LinkIndex, Wrench<'g>)> {
    let (geometry, linkage) = (&state.geometry, state.geometry.linkage);
    let wrench = |side: &MeshSide| {
        let link = Some(linkage.link_of_body[side.body.index()]);
        let carrier = linkage.link(side.carrier);
        let turn = state.motion.poses.rotation_between(carrier, link);
        let to_link = |vector: Vec3<'g>| turn * geometry.turn(&linkage.frame(carrier), vector);
        let force = to_link(by.vector(side.force));
        let place =
            geometry.local(link, geometry.mechanism.joint(side.joint).at) - to_link(slid(state, side));
        (link, Wrench { moment: to_link(by.vector(side.moment)) + place.cross(force), force })
    };
    coupling.meshes.iter().map(wrench).collect()
}
