//! One joint with clearance: its laws, built once, and one evaluation of them.
//! In: [`ContactInfo`]; then motion, wear so far, memory. Out: [`ContactState`].

use std::f64::consts::{PI, TAU};

use crate::contact::{
    Friction, GuideContact, GuideMotion, ImpactMemory, Laws, Normal, OutOfRange, RevoluteContact,
    RevoluteMotion, SphericalContact, SphericalMotion, Stiffness, Support, bearing_angle, positive,
};
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};
use crate::tables::{ContactInfo, WearInfo};
use crate::wear::{Archard, Grid, Load, MOST_LIVE, Pair, ScalarFeedback, Step, Surfaces, factor, is_sound};

/// What touches what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Touch {
    /// A journal its bearing, in which it turns.
    Journal,
    /// A rod its bush, which it may turn in, slide along and lean in.
    Guide,
    /// A ball its socket.
    Ball,
}

/// A joint with clearance and its laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    laws: Laws,
    stiffness: Stiffness,
    radius: f64,
    length: f64,
    modulus: f64,
    touch: Touch,
    wear: Option<(Archard, WearInfo)>,
    /// Worn volume of the journal over that of the bush, if it wears.
    journal: Option<f64>,
    /// Factor on the wear coefficient; nothing if it is one.
    factor: Option<Vec<Step>>,
    /// Bins of the profiles, if one is kept.
    grid: Option<Grid>,
}

/// A contact at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactState {
    /// Journal centre minus bearing centre, in the bearing's frame [m].
    pub offset: [f64; 3],
    /// How far the journal has turned in the bearing [rad]; zero if it does not wear.
    pub turned: f64,
    /// Radial clearance with its mean wear [m]: what stiffness and area go by.
    pub clearance: f64,
    /// Gap where the bodies are nearest, negative while they touch [m].
    pub gap: f64,
    /// Rate of the penetration [m/s].
    pub penetration_rate: f64,
    /// Normal force, never negative [N].
    pub normal_force: f64,
    /// K at the clearance [N/m^n].
    pub stiffness: f64,
    /// Sliding speed [m/s]; of a journal with its sign, of a ball or a rod in its bush the magnitude.
    pub sliding_speed: f64,
    /// Energy stored in the contact [J].
    pub elastic_energy: f64,
    /// Power lost in damping and friction [W].
    pub loss: f64,
    /// Rate of the wear integral, F_n |v_t| [W].
    pub wear_power: f64,
    /// Rate of the depth by the joint's contact area [m/s]; zero if it does not wear.
    pub depth_rate: f64,
    /// Factor on the wear coefficient [1]; nothing is known of it where it is one throughout.
    pub wear_factor: Option<f64>,
    /// Force on the journal [N] and moment about its centre [N m], in the bearing's frame.
    pub wrench: [f64; CONTACT_WRENCH],
}

/// What the laws of a joint say at one instant; units as in [`ContactState`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response<T> {
    /// Penetration, negative while the bodies are apart.
    pub penetration: T,
    /// Its rate.
    pub penetration_rate: T,
    /// Normal force.
    pub normal_force: T,
    /// Sliding speed.
    pub sliding_speed: T,
    /// Energy stored in the contact.
    pub elastic_energy: T,
    /// Power lost in damping and friction.
    pub loss: T,
    /// Rate of the wear integral.
    pub wear_power: T,
    /// Rate of the depth.
    pub depth_rate: T,
    /// Factor on the wear coefficient, where there is one.
    pub wear_factor: Option<T>,
    /// Force and moment on the journal.
    pub wrench: [T; CONTACT_WRENCH],
}

impl ContactState {
    /// By its offset [m], clearance [m] with the stiffness there [N/m^n], and what the laws say.
    #[inline(always)]
    pub(crate) fn of(
        (offset, turned): ([f64; 3], f64),
        (clearance, stiffness): (f64, f64),
        response: &Response<f64>,
    ) -> Self {
        Self {
            offset,
            turned,
            clearance,
            gap: -response.penetration,
            penetration_rate: response.penetration_rate,
            normal_force: response.normal_force,
            stiffness,
            sliding_speed: response.sliding_speed,
            elastic_energy: response.elastic_energy,
            loss: response.loss,
            wear_power: response.wear_power,
            depth_rate: response.depth_rate,
            wear_factor: response.wear_factor,
            wrench: response.wrench,
        }
    }

    /// Angle of a journal's offset about the joint's axis, in (-pi, pi] [rad]. A ball has no such axis.
    pub fn angle(&self) -> f64 {
        bearing_angle([self.offset[0], self.offset[1]])
    }

    /// The same in the frame of the journal, in (-pi, pi]: which place of it touches [rad].
    pub fn journal_angle(&self) -> f64 {
        let angle = (self.angle() - self.turned).rem_euclid(TAU);
        if angle > PI { angle - TAU } else { angle }
    }

    /// Minus the gap [m].
    pub fn penetration(&self) -> f64 {
        -self.gap
    }

    /// Unit vector from the bearing's centre to the contact, in the bearing's frame; the first axis if centred.
    pub fn normal(&self) -> [f64; 3] {
        let [x, y, z] = self.offset;
        let distance = (x * x + y * y + z * z).sqrt();
        if distance > 0.0 { self.offset.map(|component| component / distance) } else { [1.0, 0.0, 0.0] }
    }
}

impl Clearance {
    /// The laws of a joint.
    ///
    /// # Errors
    /// If a constant is out of range.
    pub fn new(info: &ContactInfo) -> Result<Self, OutOfRange> {
        let normal = Normal::new(info.law, info.restitution, info.exponent, info.impact_speed_floor)?;
        let friction = match info.friction {
            Some((strength, onset, slope)) => Friction::new(strength, onset, slope)?,
            None => Friction::none(),
        };
        let wear = match info.wear {
            Some(wear) => {
                ScalarFeedback::new(wear.feedback)?;
                if info.ball && wear.keeps_profile() {
                    let need = "left out: a ball has no bearing angle";
                    return Err(OutOfRange { name: "wear profile of a ball", value: wear.bins as f64, need });
                }
                Some((Archard::new(wear.coefficient, wear.hardness, wear.area)?, wear))
            }
            None => None,
        };
        Ok(Self {
            laws: Laws { normal, friction },
            stiffness: info.stiffness.checked()?,
            radius: positive("journal radius", info.journal_radius)?,
            length: positive("bearing length", info.length)?,
            modulus: positive("contact modulus", info.modulus)?,
            touch: if info.ball { Touch::Ball } else { Touch::Journal },
            journal: None,
            factor: None,
            grid: wear.filter(|(_, wear)| wear.keeps_profile()).map(|(_, wear)| Grid::new(wear.bins)),
            wear,
        })
    }

    /// The same with a journal that wears beside its bush, by its volume over that of the bush.
    ///
    /// # Errors
    /// If the ratio is not above zero, or the joint does not wear, or is no journal that turns in its bearing alone.
    pub fn with_journal(mut self, ratio: f64) -> Result<Self, OutOfRange> {
        let name = "wear of the journal over that of the bush";
        let wear = self.wear.as_ref().filter(|_| self.touch == Touch::Journal);
        let Some((_, wear)) = wear else {
            return Err(OutOfRange {
                name,
                value: ratio,
                need: "left out: only a revolute joint that wears has it",
            });
        };
        self.grid = Some(Grid::new(wear.bins));
        self.journal = Some(positive(name, ratio)?);
        Ok(self)
    }

    /// The same as a rod at one place of a bush along which it may slide and in which it may lean.
    ///
    /// # Errors
    /// If it is a ball.
    pub fn as_guide(mut self) -> Result<Self, OutOfRange> {
        if self.touch == Touch::Ball {
            let need = "left out: a ball has no axis to slide along";
            return Err(OutOfRange { name: "guide", value: self.radius, need });
        }
        self.touch = Touch::Guide;
        Ok(self)
    }

    /// The same with a factor on its wear coefficient.
    ///
    /// # Errors
    /// If it makes no sense, or the joint does not wear.
    pub fn with_factor(mut self, steps: &[Step]) -> Result<Self, OutOfRange> {
        let live = if self.touch == Touch::Journal { MOST_LIVE } else { 0 };
        if self.wear.is_none() || !is_sound(steps, 2 + live) {
            let (name, need) = (
                "steps of the factor on the wear coefficient",
                "of a joint that wears, at most 1024 (a table has a dozen a row)",
            );
            return Err(OutOfRange { name, value: steps.len() as f64, need });
        }
        self.factor = Some(steps.to_vec());
        Ok(self)
    }

    /// Factor on the wear coefficient at one instant; zero apart.
    #[inline(always)]
    fn wear_factor<T: Scalar>(
        &self,
        load: &Load<T>,
        clearance: T,
        motion: &[T; CONTACT_MOTION],
    ) -> Option<T> {
        let (steps, (archard, _)) = self.factor.as_ref().zip(self.wear.as_ref())?;
        let pressure = archard.area().pressure(load, &self.pair(clearance));
        let given = [pressure, load.sliding_speed.abs(), motion[5], motion[6], motion[7]];
        let zero = T::constant(0.0);
        Some(T::select(zero.lt(load.normal_force), factor(steps, &given), zero))
    }

    /// Worn volume of the journal over that of the bush; nothing if it does not wear.
    pub fn journal_ratio(&self) -> Option<f64> {
        self.journal
    }

    /// Directions in which the journal is free: two across the axis, or three of a ball.
    pub fn freedoms(&self) -> usize {
        if self.touch == Touch::Ball { 3 } else { 2 }
    }

    /// Radius of the journal or ball [m].
    pub fn journal_radius(&self) -> f64 {
        self.radius
    }

    /// Length of the bearing [m].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Its law of normal force.
    pub fn normal_law(&self) -> &Normal {
        &self.laws.normal
    }

    /// Archard's law and what was said about wear; nothing if it does not wear.
    pub fn wear(&self) -> Option<&(Archard, WearInfo)> {
        self.wear.as_ref()
    }

    /// K at a clearance [m], [N/m^n].
    pub fn stiffness<T: Scalar>(&self, clearance: T) -> T {
        self.stiffness.value(T::constant(self.radius), clearance)
    }

    /// Penetration [m] of a contact at rest that carries `force` [N] at a clearance [m].
    pub fn resting_penetration(&self, clearance: f64, force: f64) -> f64 {
        self.laws.normal.resting_penetration(self.stiffness(clearance), force)
    }

    /// Distance [m] of the journal's centre from the bearing's, along the unit vector `direction`, at which the
    /// penetration is `penetration` [m]; `clearance` [m] is that of the round bearing, without profiles.
    pub(super) fn distance(
        &self,
        clearance: f64,
        surfaces: Surfaces<'_>,
        direction: [f64; 3],
        penetration: f64,
    ) -> f64 {
        match self.grid.as_ref().filter(|_| !surfaces.are_round()) {
            Some(grid) => grid.distance(surfaces, clearance, [direction[0], direction[1]], penetration),
            None => clearance + penetration,
        }
    }

    /// Geometry for areas at a clearance [m].
    pub fn pair<T: Scalar>(&self, clearance: T) -> Pair<T> {
        let [journal_radius, length, modulus] = [self.radius, self.length, self.modulus].map(T::constant);
        Pair { journal_radius, length, clearance, modulus }
    }

    /// One evaluation: `motion` as [`crate::Entry::Contacts`] gives it, `worn` [m] on top of its clearance, worn
    /// profiles on top of that; `before`: this joint's contact at any other instant.
    ///
    /// Stiffness and area go by the clearance plus the mean of the profiles, which stays the same through a
    /// run: a stiffness that changed along the way would not give back the energy it took.
    #[inline]
    pub fn evaluate(
        &self,
        motion: &[f64; CONTACT_MOTION],
        (worn, surfaces): (f64, Surfaces<'_>),
        memory: &ImpactMemory<f64>,
        before: &ContactState,
    ) -> ContactState {
        let round = motion[9] + worn;
        let clearance = round + surfaces.mean();
        // A root and two divisions, mostly of the same numbers.
        let known = before.stiffness > 0.0 && before.clearance.to_bits() == clearance.to_bits();
        let stiffness = if known { before.stiffness } else { self.stiffness(clearance) };
        let support = |offset| match self.grid.as_ref().filter(|_| !surfaces.are_round()) {
            Some(grid) => grid.support(surfaces, round, offset),
            None => Support::round(offset, round),
        };
        let response = self.respond(motion, support, (clearance, stiffness), memory);
        ContactState::of((self.offset(motion), self.turned(motion)), (clearance, stiffness), &response)
    }

    /// The laws at one instant, on any scalar: lanes run them as they are. `motion` as [`crate::Entry::Contacts`] gives it;
    /// `support`: how the bearing meets a journal's centre; radial clearance with its mean wear [m] and K there.
    #[inline(always)]
    pub fn respond<T: Scalar>(
        &self,
        motion: &[T; CONTACT_MOTION],
        support: impl FnOnce([T; 2]) -> Support<T>,
        (clearance, stiffness): (T, T),
        memory: &ImpactMemory<T>,
    ) -> Response<T> {
        let three = |at: usize| [motion[at], motion[at + 1], motion[at + 2]];
        let (offset, offset_rate, turning) = (three(0), three(3), three(6));
        let radius = T::constant(self.radius);
        let ([penetration, penetration_rate, sliding_speed], force) = match self.touch {
            Touch::Ball => {
                let motion = SphericalMotion { offset, offset_rate, angular_velocity: turning };
                let contact = SphericalContact::new(&motion, radius, clearance);
                let geometry = [contact.penetration, contact.penetration_rate, contact.sliding_speed];
                (geometry, contact.force(&self.laws, stiffness, memory))
            }
            Touch::Guide => {
                let offset = [offset[0], offset[1]];
                let motion = GuideMotion { offset, offset_rate, angular_velocity: turning };
                let contact = GuideContact::new(&motion, radius, &support(offset));
                let geometry = [contact.penetration, contact.penetration_rate, contact.sliding_speed];
                (geometry, contact.force(&self.laws, stiffness, memory))
            }
            Touch::Journal => {
                let [[x, y, _], [vx, vy, _]] = [offset, offset_rate];
                let motion =
                    RevoluteMotion { offset: [x, y], offset_rate: [vx, vy], joint_speed: turning[2] };
                let contact = RevoluteContact::new(&motion, radius, &support([x, y]));
                let geometry = [contact.penetration, contact.penetration_rate, contact.sliding_speed];
                (geometry, contact.force(&self.laws, stiffness, memory))
            }
        };
        let ([fx, fy, fz], [mx, my, mz]) = (force.force, force.moment);
        let (normal_force, damping_loss) = (force.normal.force, force.normal.damping_loss);
        let load = Load { normal_force, penetration, sliding_speed };
        let depth_rate =
            |(archard, _): &(Archard, WearInfo)| archard.rates(&load, &self.pair(clearance)).depth;
        let wear_factor = self.wear_factor(&load, clearance, motion);
        let depth = self.wear.as_ref().map_or(T::constant(0.0), depth_rate);
        Response {
            penetration,
            penetration_rate,
            normal_force,
            sliding_speed,
            elastic_energy: force.normal.elastic_energy,
            loss: damping_loss + force.friction_loss,
            wear_power: normal_force * sliding_speed.abs(),
            depth_rate: wear_factor.map_or(depth, |factor| depth * factor),
            wear_factor,
            wrench: [fx, fy, fz, mx, my, mz],
        }
    }

    /// Offset of the journal's centre from the bearing's: a journal leaves the axis, and does not slide along it.
    #[inline(always)]
    pub fn offset<T: Scalar>(&self, motion: &[T; CONTACT_MOTION]) -> [T; 3] {
        let along = if self.touch == Touch::Ball { motion[2] } else { T::constant(0.0) };
        [motion[0], motion[1], along]
    }

    /// How far a journal that wears has turned: a journal does not slide along its axis, so that its angle has the place.
    pub fn turned<T: Scalar>(&self, motion: &[T; CONTACT_MOTION]) -> T {
        if self.journal.is_some() { motion[2] } else { T::constant(0.0) }
    }

    /// Whether wear by angle is kept, of bush or journal.
    pub fn keeps_profiles(&self) -> bool {
        self.grid.is_some()
    }

    /// Slope of the elastic force over the penetration [N/m]; zero apart.
    pub fn tangent_stiffness(&self, touch: &ContactState) -> f64 {
        let (depth, n) = (touch.penetration(), self.laws.normal.exponent());
        // n K p^(n-1), from the energy K p^(n+1)/(n+1).
        if depth > 0.0 { n * (n + 1.0) * touch.elastic_energy / (depth * depth) } else { 0.0 }
    }

    /// What acts on the contact, for laws of wear.
    pub fn load(touch: &ContactState) -> Load<f64> {
        Load {
            normal_force: touch.normal_force,
            penetration: touch.penetration(),
            sliding_speed: touch.sliding_speed,
        }
    }
}
