//! The oracle: a mechanism with numbers, and what can be read off its state.
//! In: [`Mechanism`] and parameter values. Out: positions, joint coordinates, residuals, energies.
//! Never knows how accelerations are solved for.

use linkwear_codegen::id::{BodyId, JointId, PointId};
use linkwear_codegen::model::{Carrier, Formula, Mechanism};
use nalgebra::Vector3;

use crate::check::{check_constants, check_coordinates, check_responses};
use crate::error::OracleError;
use crate::formula::{State, evaluate};
use crate::frame::{BodyState, Frame};
use crate::jet::Jet;
use crate::joint::{JointGeometry, JointMotion};
use crate::kind::Kind;
use crate::mass::MassProperties;
use crate::row::{Pair, Row};

/// A mechanism with numbers in place of formulas that are constant.
#[derive(Clone, Debug)]
pub struct Oracle {
    /// The description.
    pub mechanism: Mechanism,
    /// Values of all parameters, file order, SI.
    pub parameters: Vec<f64>,
    /// Bodies in file order.
    pub bodies: Vec<MassProperties>,
    /// Singular values below this share of the largest count as zero. Rows are scaled to equal length
    /// first. Default 1e-9: redundant rows of a closed configuration leave about 1e-12.
    pub rank_tolerance: f64,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) joints: Vec<JointGeometry>,
}

/// States of all bodies, with the ground beside them.
#[derive(Clone, Copy)]
pub(crate) struct Frames<'a> {
    pub oracle: &'a Oracle,
    pub states: &'a [BodyState],
}

impl Oracle {
    /// A numeric model of `mechanism` with `parameters` (all of them, file order, SI).
    ///
    /// # Errors
    /// If a mass is not positive, or a formula that must be constant is not.
    pub fn new(mechanism: &Mechanism, parameters: &[f64]) -> Result<Self, OracleError> {
        check_constants(mechanism, parameters)?;
        check_responses(mechanism)?;
        let place =
            |formulas: &[Formula; 3]| Vector3::from(formulas.each_ref().map(|f| number(f, parameters)));
        let position = |point: PointId, carrier| place(mechanism.point(point).position_for(carrier));
        let mut bodies = Vec::new();
        for (index, body) in mechanism.bodies.iter().enumerate() {
            let carrier = Carrier::Body(BodyId::new(index));
            let at = |point| position(point, carrier);
            let matter =
                MassProperties::new(&body.inertia, &at, &|f| number(f, parameters)).with_some_inertia();
            if matter.mass.is_nan() || matter.mass <= 0.0 || matter.inertia.cholesky().is_none() {
                return Err(OracleError::NotPositive { body: body.name.clone(), mass: matter.mass });
            }
            bodies.push(matter);
        }
        let joints = mechanism
            .joints
            .iter()
            .map(|joint| {
                let [on_parent, on_child] = joint.points();
                let points = [position(on_parent, joint.parent), position(on_child, joint.child)];
                JointGeometry::new(joint, points, parameters)
            })
            .collect::<Vec<_>>();
        check_coordinates(mechanism, &joints)?;
        Ok(Self {
            gravity: place(&mechanism.gravity),
            mechanism: mechanism.clone(),
            parameters: parameters.to_vec(),
            bodies,
            rank_tolerance: 1e-9,
            joints,
        })
    }

    /// As [`Oracle::new`], with the parameter values of the file.
    ///
    /// # Errors
    /// As there.
    pub fn with_defaults(mechanism: &Mechanism) -> Result<Self, OracleError> {
        let values: Vec<f64> = mechanism.parameters.iter().map(|parameter| parameter.value).collect();
        Self::new(mechanism, &values)
    }

    /// All bodies at rest in their reference poses; loops may be open.
    pub fn reference_states(&self) -> Vec<BodyState> {
        let rest = Frame::ground().state;
        self.bodies.iter().map(|body| BodyState { centre: body.centre, ..rest }).collect()
    }

    /// Position [m] and velocity [m/s] in W of a named point, as material of its carrier.
    pub fn point(&self, point: PointId, states: &[BodyState]) -> (Vector3<f64>, Vector3<f64>) {
        let frames = self.frames(states);
        let carrier = self.mechanism.point(point).carrier;
        let moving = frames.of(carrier).point(&self.reference(point, carrier));
        (moving.position, moving.velocity)
    }

    /// Coordinates and speeds of a joint, tree or cut alike.
    pub fn joint_motion(&self, joint: JointId, states: &[BodyState]) -> JointMotion {
        self.joints[joint.index()].motion(&self.frames(states).pair(joint))
    }

    /// Position in W [m] of a joint's point on the child.
    pub fn joint_point(&self, joint: JointId, states: &[BodyState]) -> Vector3<f64> {
        self.frames(states).pair(joint).child_point.position
    }

    /// Largest violation of joints and drives [m or rad] at time `t`.
    pub fn constraint_residual(&self, t: f64, states: &[BodyState]) -> f64 {
        self.rows(t, states).iter().fold(0.0, |worst, (_, row)| worst.max(row.residual.abs()))
    }

    /// Largest violation of joints and drives by speeds [m/s or rad/s] at time `t`.
    pub fn velocity_residual(&self, t: f64, states: &[BodyState]) -> f64 {
        self.rows(t, states).iter().fold(0.0, |worst, (_, row)| worst.max(row.rate.abs()))
    }

    /// Kinetic energy [J].
    pub fn kinetic_energy(&self, states: &[BodyState]) -> f64 {
        let energy = |(body, s): (&MassProperties, &BodyState)| {
            let spin = s.rotation.transpose() * s.omega;
            0.5 * (body.mass * s.velocity.norm_squared() + spin.dot(&(body.inertia * spin)))
        };
        self.bodies.iter().zip(states).map(energy).sum()
    }

    /// All rows with the joint they belong to, joint by joint: constraints first, then drives.
    pub(crate) fn rows(&self, t: f64, states: &[BodyState]) -> Vec<(JointId, Row)> {
        let frames = self.frames(states);
        let mut rows = Vec::new();
        for index in 0..self.joints.len() {
            let joint = JointId::new(index);
            let pair = frames.pair(joint);
            rows.extend(self.joints[index].rows(&pair).into_iter().map(|row| (joint, row)));
            for drive in &self.mechanism.joints[index].drives {
                let law = self.law(&drive.law, t, states);
                let coordinate = self.joints[index].coordinate(drive.coordinate, &pair);
                rows.push((joint, self.driven(joint, drive.coordinate, coordinate, &law)));
            }
        }
        rows
    }

    /// The row `coordinate - law`, to the nearest whole turn.
    pub(crate) fn driven(&self, joint: JointId, k: usize, mut coordinate: Row, law: &Jet) -> Row {
        coordinate.residual -= law.value;
        if self.wraps(joint, k) {
            let turns = (coordinate.residual / std::f64::consts::TAU).round();
            coordinate.residual -= turns * std::f64::consts::TAU;
        }
        coordinate.rate -= law.first;
        coordinate.bias -= law.second;
        coordinate
    }

    /// Whether a coordinate is an angle known only up to whole turns.
    fn wraps(&self, joint: JointId, k: usize) -> bool {
        matches!(
            (self.joints[joint.index()].kind, k),
            (Kind::Revolute | Kind::Universal, _) | (Kind::Cylindrical, 0) | (Kind::Planar, 2)
        )
    }

    /// Value and time derivatives of a formula in the present state.
    pub(crate) fn law(&self, formula: &Formula, t: f64, states: &[BodyState]) -> Jet {
        evaluate(&formula.term, &self.parameters, t, &self.frames(states))
    }

    /// Value of a constant formula; checked by `new`.
    pub(crate) fn number(&self, formula: &Formula) -> f64 {
        number(formula, &self.parameters)
    }

    /// Where a point is at the reference pose of `carrier`'s branch.
    pub(crate) fn reference(&self, point: PointId, carrier: Carrier) -> Vector3<f64> {
        let position = self.mechanism.point(point).position_for(carrier);
        Vector3::from(position.each_ref().map(|f| self.number(f)))
    }

    pub(crate) fn frames<'a>(&'a self, states: &'a [BodyState]) -> Frames<'a> {
        Frames { oracle: self, states }
    }
}

impl Frames<'_> {
    pub fn of(&self, carrier: Carrier) -> Frame {
        match carrier {
            Carrier::Ground => Frame::ground(),
            Carrier::Body(id) => {
                let reference = self.oracle.bodies[id.index()].centre;
                Frame { state: self.states[id.index()], reference }
            }
        }
    }

    pub fn pair(&self, joint: JointId) -> Pair {
        let geometry = &self.oracle.joints[joint.index()];
        Pair::new(self.of(geometry.parent), self.of(geometry.child), &geometry.points)
    }
}

impl State for Frames<'_> {
    fn joint_position(&self, joint: JointId, coordinate: usize) -> f64 {
        self.oracle.joint_motion(joint, self.states).position[coordinate]
    }
    fn joint_speed(&self, joint: JointId, coordinate: usize) -> f64 {
        self.oracle.joint_motion(joint, self.states).speed[coordinate]
    }
    fn point_position(&self, point: PointId, component: usize) -> f64 {
        self.oracle.point(point, self.states).0[component]
    }
    fn point_speed(&self, point: PointId, component: usize) -> f64 {
        self.oracle.point(point, self.states).1[component]
    }
}

/// Value of a formula that `check_constants` has seen.
fn number(formula: &Formula, parameters: &[f64]) -> f64 {
    formula.value(parameters).unwrap_or(f64::NAN)
}
