//! Applied forces: gravity, joint springs, dampers and actuators, force elements; their powers and
//! potentials. In: a state. Out: loads on bodies, watts, joules. Never knows constraints.

use linkwear_codegen::id::{JointId, PointId};
use linkwear_codegen::model::{Carrier, Force, Formula, Passive};
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6};

use crate::frame::{BodyState, Load};
use crate::model::{Frames, Oracle};
use crate::row::Row;

/// What all applied forces do at one instant.
#[derive(Clone, Debug)]
pub(crate) struct Applied {
    /// Load on every body.
    pub loads: Vec<Load>,
    /// Per joint: what springs, dampers and actuators in it do to the child, about the child's centre
    /// (about W's origin for the ground).
    pub passive: Vec<Load>,
    /// By actuators and by point forces and torques [W].
    pub power_supplied: f64,
    /// Taken by dampers [W], not negative for positive coefficients.
    pub power_dissipated: f64,
    /// Of gravity and springs [J].
    pub potential: f64,
}

impl Oracle {
    /// Potential energy of gravity, joint springs and spring elements [J]; zero for masses at W's origin
    /// and springs of rest length (of no length, for a preload).
    pub fn potential_energy(&self, t: f64, states: &[BodyState]) -> f64 {
        self.applied(t, states).potential
    }

    /// Power that dampers take away [W].
    pub fn power_dissipated(&self, t: f64, states: &[BodyState]) -> f64 {
        self.applied(t, states).power_dissipated
    }

    pub(crate) fn applied(&self, t: f64, states: &[BodyState]) -> Applied {
        let mut applied = Applied {
            loads: vec![Load::default(); self.bodies.len()],
            passive: Vec::new(),
            power_supplied: 0.0,
            power_dissipated: 0.0,
            potential: 0.0,
        };
        for (index, (body, state)) in self.bodies.iter().zip(states).enumerate() {
            let weight = body.mass * self.gravity;
            applied.loads[index].force += weight;
            applied.potential -= weight.dot(&state.centre);
        }
        let frames = self.frames(states);
        for index in 0..self.joints.len() {
            self.add_passive(JointId::new(index), t, &frames, &mut applied);
        }
        for force in &self.mechanism.forces {
            self.add_element(force, t, &frames, &mut applied);
        }
        applied
    }

    fn add_passive(&self, joint: JointId, t: f64, frames: &Frames<'_>, applied: &mut Applied) {
        let geometry = &self.joints[joint.index()];
        let pair = frames.pair(joint);
        let mut on_child = Load::default();
        for passive in &self.mechanism.joint(joint).passive {
            let (row, force) = match passive {
                Passive::Damping { coefficient, .. } if geometry.scalars() == 0 => {
                    let c = self.number(coefficient);
                    for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                        let row = pair.turn(0.0, &axis, &Vector3::zeros());
                        applied.power_dissipated += c * row.rate * row.rate;
                        on_child.add(-c * row.rate, &row.child);
                        applied.push(geometry.parent, geometry.child, -c * row.rate, &row);
                    }
                    continue;
                }
                Passive::Damping { coordinate, coefficient } => {
                    let row = geometry.coordinate(*coordinate, &pair);
                    let force = -self.number(coefficient) * row.rate;
                    applied.power_dissipated -= force * row.rate;
                    (row, force)
                }
                Passive::Spring { coordinate, stiffness, rest, preload } => {
                    let row = geometry.coordinate(*coordinate, &pair);
                    let (k, stretch) = (self.number(stiffness), row.residual - self.number(rest));
                    let preload = self.number(preload);
                    applied.potential += 0.5 * k * stretch * stretch + preload * stretch;
                    (row, -k * stretch - preload)
                }
                Passive::Actuator { coordinate, force } => {
                    let row = geometry.coordinate(*coordinate, &pair);
                    let force = self.law(force, t, frames.states).value;
                    applied.power_supplied += force * row.rate;
                    (row, force)
                }
                // Refused before a model is made.
                Passive::DryFriction(_) => continue,
            };
            on_child.add(force, &row.child);
            applied.push(geometry.parent, geometry.child, force, &row);
        }
        applied.passive.push(on_child);
    }

    fn add_element(&self, force: &Force, t: f64, frames: &Frames<'_>, applied: &mut Applied) {
        let Force { bodies, at, axes, .. } = force;
        let vector = || -> Vector3<f64> {
            let [components] = force.triples();
            let value = Vector3::from(components.each_ref().map(|f| self.law(f, t, frames.states).value));
            frames.of(*axes).state.rotation * value
        };
        let [body, reaction] = bodies;
        match force.kind.name {
            "spring" => {
                let ends = [0, 1].map(|k| self.end(bodies[k], at[k], frames));
                let apart = ends[1].position - ends[0].position;
                let length = apart.norm();
                let line = apart / length;
                let rate = line.dot(&(ends[1].velocity - ends[0].velocity));
                let [k, rest, c, p] = force.numbers().map(|f| self.number(f));
                let stretch = length - rest;
                let pull = k * stretch + c * rate + p;
                applied.load(bodies[0], 1.0, &Load::at(&ends[0].arm, &(pull * line)));
                applied.load(bodies[1], -1.0, &Load::at(&ends[1].arm, &(pull * line)));
                applied.potential += 0.5 * k * stretch * stretch + p * length;
                applied.power_dissipated += c * rate * rate;
            }
            "cable" => {
                let ends = [0, 1].map(|k| self.end(bodies[k], at[k], frames));
                let apart = ends[1].position - ends[0].position;
                let line = apart.normalize();
                let rate = line.dot(&(ends[1].velocity - ends[0].velocity));
                let [k, rest, c, p] = force.numbers().map(|f| self.number(f));
                let elastic = k * (apart.norm() - rest) + p;
                if elastic > 0.0 {
                    let pull = (elastic + c * rate).max(0.0);
                    applied.load(bodies[0], 1.0, &Load::at(&ends[0].arm, &(pull * line)));
                    applied.load(bodies[1], -1.0, &Load::at(&ends[1].arm, &(pull * line)));
                    applied.potential += elastic * elastic / (2.0 * k);
                    applied.power_dissipated += (pull - elastic) * rate;
                }
            }
            "bushing" => self.add_bushing(force, frames, applied),
            "force" => {
                let push = vector();
                let place = self.end(*body, at[0], frames);
                let base = frames.of(*reaction);
                applied.load(*body, 1.0, &Load::at(&place.arm, &push));
                applied.load(*reaction, -1.0, &Load::at(&(place.position - base.state.centre), &push));
                let slip = place.velocity - base.velocity_at(&place.position);
                applied.power_supplied += push.dot(&slip);
            }
            "torque" => {
                let torque = vector();
                let load = Load { force: Vector3::zeros(), torque };
                applied.load(*body, 1.0, &load);
                applied.load(*reaction, -1.0, &load);
                let slip = frames.of(*body).state.omega - frames.of(*reaction).state.omega;
                applied.power_supplied += torque.dot(&slip);
            }
            other => unreachable!("no kind of force element is called `{other}`"),
        }
    }

    /// Force along the first body's axes and moment `-dV/d(turn)` of the energy of the rotation vector, whose rate is
    /// `(1 - [phi]/2 + (1/t² - (1 + cos t)/(2 t sin t)) [phi]²) omega` in the first body's axes, t = |phi|.
    fn add_bushing(&self, bushing: &Force, frames: &Frames<'_>, applied: &mut Applied) {
        let Force { bodies, at, directions, .. } = bushing;
        let [k, c, kr, cr, p, pr] =
            bushing.triples().map(|list: &[Formula; 3]| list.each_ref().map(|f| self.number(f)));
        let full = |first: usize| {
            let entries = bushing.formulas[first..first + 36].iter().map(|f| self.number(f));
            Matrix6::from_row_iterator(entries)
        };
        let diagonal = |a: [f64; 3], b: [f64; 3]| {
            Matrix6::from_diagonal(&Vector6::from_iterator(a.into_iter().chain(b)))
        };
        let (stiffness, damping) = (diagonal(k, kr) + full(18), diagonal(c, cr) + full(54));
        let preload = Vector6::from_iterator(p.into_iter().chain(pr));
        let [a, b] = bodies.map(|body| frames.of(body));
        let ends = [0, 1].map(|i| self.end(bodies[i], at[i], frames));
        let directions = Matrix3::from_columns(&directions.map(Vector3::from));
        let [first, second] = [a, b].map(|frame| frame.state.rotation * directions);
        let apart = ends[1].position - ends[0].position;
        let slip = ends[1].velocity - a.velocity_at(&ends[1].position);
        let (d, rate) = (first.transpose() * apart, first.transpose() * slip);
        let turned = Rotation3::from_matrix_unchecked(first.transpose() * second);
        // By the quaternion: an arc cosine of the trace is no number where rounding takes it past 1.
        let phi = UnitQuaternion::from_rotation_matrix(&turned).scaled_axis();
        let angle = phi.norm();
        // 1/12 is the limit; the next term is angle²/720.
        let b2 = if angle < 1e-4 {
            1.0 / 12.0
        } else {
            1.0 / (angle * angle) - (1.0 + angle.cos()) / (2.0 * angle * angle.sin())
        };
        let skew = phi.cross_matrix();
        let jacobian = Matrix3::identity() - 0.5 * skew + b2 * skew * skew;
        let own_rate = second.transpose() * (b.state.omega - a.state.omega);
        let join = |one: Vector3<f64>, other: Vector3<f64>| {
            Vector6::new(one.x, one.y, one.z, other.x, other.y, other.z)
        };
        let split =
            |both: Vector6<f64>| [both.fixed_rows::<3>(0).into_owned(), both.fixed_rows::<3>(3).into_owned()];
        let (x, rates) = (join(d, phi), join(rate, own_rate));
        let [elastic, turning] = split(stiffness * x + preload);
        let [viscous, drag] = split(damping * rates);
        let force = -first * (elastic + viscous);
        let moment = -first * jacobian.transpose() * turning - second * drag;
        applied.load(bodies[1], 1.0, &Load { force, torque: ends[1].arm.cross(&force) + moment });
        let arm = ends[1].position - a.state.centre;
        applied.load(bodies[0], -1.0, &Load { force, torque: arm.cross(&force) + moment });
        applied.potential += 0.5 * x.dot(&(stiffness * x)) + preload.dot(&x);
        applied.power_dissipated += rates.dot(&(damping * rates));
    }

    fn end(&self, body: Carrier, point: PointId, frames: &Frames<'_>) -> crate::frame::MovingPoint {
        frames.of(body).point(&self.reference(point, body))
    }

    /// Inertia of a body about its centre in W axes now [kg m²].
    pub(crate) fn inertia_now(&self, body: usize, state: &BodyState) -> Matrix3<f64> {
        state.rotation * self.bodies[body].inertia * state.rotation.transpose()
    }
}

impl Applied {
    fn load(&mut self, carrier: Carrier, scale: f64, load: &Load) {
        if let Carrier::Body(id) = carrier {
            self.loads[id.index()].add(scale, load);
        }
    }

    fn push(&mut self, parent: Carrier, child: Carrier, force: f64, row: &Row) {
        self.load(parent, force, &row.parent);
        self.load(child, force, &row.child);
    }
}
