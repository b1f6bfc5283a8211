//! A journal in a bearing that stands still: free across the axis, turning freely or driven. Mass and inertia
//! of the journal, gravity in -y, a load by time. Parameters: gravity [m/s²], clearance [m].

use linkwear_runtime::contact::{Onset, Restitution, Stiffness, Strength};
use linkwear_runtime::wear::{Area, Step};
use linkwear_runtime::{
    CONTACT_MOTION, CONTACT_WRENCH, Channel, CoefficientFactor, ContactInfo, Description, DriverInfo, Entry,
    JournalWear, Motion, ParameterInfo, Sizes, System, VariableInfo, WearInfo,
};

use super::others::by_others;

/// Force on the journal [N] by time.
pub type Load = fn(f64) -> [f64; 2];

pub struct Journal {
    pub mass: f64,
    pub inertia: f64,
    /// Damping of the journal's centre against ground [N s/m].
    pub damping: f64,
    pub load: Load,
    /// Speed of the driver [rad/s]; free to turn without one.
    pub driven: Option<f64>,
    /// Start: offset and its rate, each with whether it is held, and the joint's speed.
    pub offset: ([f64; 2], bool),
    pub offset_rate: [f64; 2],
    pub turning: f64,
    pub description: Description,
}

pub fn no_load(_: f64) -> [f64; 2] {
    [0.0; 2]
}

/// Steel, journal of 10 mm radius in a bearing of 20 mm length, without friction, lossless, not wearing.
pub fn smooth() -> ContactInfo {
    ContactInfo {
        joint: "R".into(),
        ball: false,
        journal_radius: 0.01,
        length: 0.02,
        modulus: 115e9,
        stiffness: Stiffness::Hertz { modulus: 115e9 },
        law: Restitution::Exact,
        restitution: 1.0,
        exponent: 1.5,
        impact_speed_floor: 1e-3,
        friction: None,
        wear: None,
    }
}

pub fn coulomb(coefficient: f64) -> Option<(Strength, Onset, f64)> {
    Some((Strength::Coulomb { coefficient }, Onset::Smoothed { speed: 1e-3 }, 0.0))
}

pub fn wear(area: Area, profile: bool) -> Option<WearInfo> {
    Some(WearInfo {
        coefficient: 1e-8,
        hardness: 3.5e9,
        area,
        measure: None,
        feedback: 1.0,
        profile,
        bins: 72,
        threshold: 80e-6,
        revolutions_per_cycle: 1e6,
        pressure_speed: None,
        scatter: None,
        cycle_variation: None,
    })
}

impl Journal {
    pub fn new(contact: ContactInfo) -> Self {
        let variable = |name: &'static str, unit: &'static str| VariableInfo {
            name: name.into(),
            unit: unit.into(),
            held: false,
        };
        let parameter =
            |name: &'static str, default| ParameterInfo { name: name.into(), unit: "1".into(), default };
        let channel = |name: &'static str| Channel { name: name.into(), unit: "m".into(), wraps: false };
        let scalar = Motion::Scalar { driver: None };
        let description = Description {
            name: "journal".into(),
            parameters: vec![parameter("gravity", 9.81), parameter("clearance", 1e-5)].into(),
            coordinates: vec![variable("R.x", "m"), variable("R.y", "m"), variable("R.q", "rad")].into(),
            speeds: vec![variable("R.vx", "m/s"), variable("R.vy", "m/s"), variable("R.v", "rad/s")].into(),
            motions: vec![scalar; 3].into(),
            inputs: vec![].into(),
            quaternions: vec![].into(),
            rows: vec![].into(),
            drivers: vec![].into(),
            channels: vec![channel("R.x")].into(),
            turn_driver: None,
            contacts: vec![contact].into(),
            journals: Vec::new().into(),
            guides: Vec::new().into(),
            bends: Vec::new().into(),
            coefficients: Vec::new().into(),
            missions: Vec::new().into(),
        };
        Self {
            mass: 1.0,
            inertia: 1e-3,
            damping: 0.0,
            load: no_load,
            driven: None,
            offset: ([0.0; 2], false),
            offset_rate: [0.0; 2],
            turning: 0.0,
            description,
        }
    }

    /// Offset and rate that the file demands.
    pub fn held(mut self, offset: [f64; 2], rate: [f64; 2]) -> Self {
        (self.offset, self.offset_rate) = ((offset, true), rate);
        self.description.coordinates.to_mut()[..2].iter_mut().for_each(|x| x.held = true);
        self
    }

    /// Turned at a constant speed [rad/s].
    pub fn driven(mut self, speed: f64) -> Self {
        self.driven = Some(speed);
        let description = &mut self.description;
        description.coordinates.to_mut().pop();
        description.speeds.to_mut().pop();
        description.motions.to_mut()[2] = Motion::Scalar { driver: Some(0) };
        description.drivers = vec![DriverInfo { joint: "R".into(), angular: true }].into();
        description.turn_driver = Some(0);
        self
    }

    /// With a factor on its wear coefficient, over pressure, sliding speed and the gravity of the parameters.
    pub fn wearing_by(mut self, steps: Vec<Step>) -> Self {
        self.description.coefficients = vec![CoefficientFactor { contact: 0, steps: steps.into() }].into();
        self
    }

    /// With a journal that wears, by its volume over that of the bush.
    pub fn wearing(mut self, ratio: f64) -> Self {
        self.description.journals = vec![JournalWear { contact: 0, ratio }].into();
        self
    }

    fn free(&self) -> usize {
        if self.driven.is_some() { 2 } else { 3 }
    }

    /// Forces and torque on the journal besides those of a driver.
    fn forces(&self, gravity: f64, t: f64, v: &[f64], wrench: &[f64]) -> [f64; 3] {
        let [x, y] = (self.load)(t);
        let drag = |i: usize| -self.damping * v[i];
        [wrench[0] + x + drag(0), wrench[1] + y + drag(1) - self.mass * gravity, wrench[5]]
    }
}

impl System<f64> for Journal {
    fn sizes(&self) -> Sizes {
        Sizes {
            parameters: 2,
            coordinates: self.free(),
            speeds: self.free(),
            all_coordinates: 3,
            all_speeds: 3,
            drivers: self.description.drivers.len(),
            contacts: 1,
            channels: 1,
            ..Sizes::default()
        }
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], _: &mut [f64]) {
        let (gravity, clearance, t) = (input[0], input[1], input[2]);
        let n = if entry == Entry::EquationsOfMotion { 3 } else { self.free() };
        let rest = &input[3..];
        let state = || (&rest[..n], &rest[n..2 * n], &rest[2 * n..]);
        let speed = |v: &[f64]| self.driven.unwrap_or_else(|| v[2]);
        let masses = [self.mass, self.mass, self.inertia];
        match entry {
            Entry::Prescribed => {
                if let Some(speed) = self.driven {
                    output.copy_from_slice(&[speed * t, speed, 0.0]);
                }
            }
            Entry::Start => {
                output[..2].copy_from_slice(&self.offset.0);
                output[n..n + 2].copy_from_slice(&self.offset_rate);
                if self.driven.is_none() {
                    (output[2], output[n + 2]) = (0.0, self.turning);
                }
            }
            Entry::ForwardDynamics => {
                let (_, v, wrench) = state();
                assert_eq!(wrench.len(), CONTACT_WRENCH);
                let forces = self.forces(gravity, t, v, wrench);
                for i in 0..n {
                    output[i] = forces[i] / masses[i];
                }
                if self.driven.is_some() {
                    output[2] = -forces[2];
                }
            }
            Entry::Accelerations | Entry::Derivative => by_others(self, entry, input, output),
            Entry::Rates => {
                let (_, v, drives) = state();
                output[..n].copy_from_slice(v);
                let [x, y] = (self.load)(t);
                let driver: f64 = drives.iter().map(|drive| drive * speed(v)).sum();
                output[n] = driver + x * v[0] + y * v[1];
                output[n + 1] = self.damping * (v[0] * v[0] + v[1] * v[1]);
            }
            Entry::Closure => {}
            Entry::Energy => {
                let (q, v, _) = state();
                let turning = speed(v);
                output[0] =
                    0.5 * (self.mass * (v[0] * v[0] + v[1] * v[1]) + self.inertia * turning * turning);
                output[1] = self.mass * gravity * q[1];
            }
            Entry::Observe => output[0] = rest[0],
            Entry::EquationsOfMotion => {
                let (_, v, wrench) = state();
                output.fill(0.0);
                (output[0], output[3], output[5]) = (masses[0], masses[1], masses[2]);
                for (bias, force) in output[6..9].iter_mut().zip(self.forces(gravity, t, v, wrench)) {
                    *bias = -force;
                }
            }
            Entry::Contacts => {
                let (q, v, _) = state();
                assert_eq!(output.len(), CONTACT_MOTION);
                let angle = self.driven.map_or_else(|| q[2], |speed| speed * t);
                let angle = if self.description.journals.is_empty() { 0.0 } else { angle };
                let live = if self.description.coefficients.is_empty() { 0.0 } else { gravity };
                output.copy_from_slice(&[q[0], q[1], angle, v[0], v[1], live, 0.0, 0.0, speed(v), clearance]);
            }
        }
    }
}
