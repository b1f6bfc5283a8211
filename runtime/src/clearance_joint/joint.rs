//! One joint with clearance: its laws, built once, and one evaluation of them.
//! In: [`ContactInfo`]; then motion, wear so far, memory. Out: [`ContactState`].

use std::f64::consts::{PI, TAU};

use crate::contact::{ImpactMemory, Normal, OutOfRange, Support, bearing_angle, positive};
use crate::joint_laws::{JointLaws, Response};
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};
use crate::tables::{ContactInfo, WearInfo};
use crate::wear::{Archard, Grid, Load, Pair, Step, Surfaces};

/// A joint with clearance and its laws.
#[derive(Clone, Debug, PartialEq)]
pub struct Clearance {
    laws: JointLaws,
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
    /// Mean pressure by the joint's contact area [Pa]; zero if it does not wear.
    pub pressure: f64,
    /// Rate of the depth by the joint's contact area [m/s]; zero if it does not wear.
    pub depth_rate: f64,
    /// Factor on the wear coefficient [1]; nothing is known of it where it is one throughout.
    pub wear_factor: Option<f64>,
    /// Force on the journal [N] and moment about its centre [N m], in the bearing's frame.
    pub wrench: [f64; CONTACT_WRENCH],
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
            pressure: response.pressure,
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
        let laws = JointLaws::new(info)?;
        let kept = laws.wear().filter(|(_, wear)| wear.keeps_profile());
        let grid = kept.map(|(_, wear)| Grid::new(wear.bins));
        Ok(Self { laws, journal: None, factor: None, grid })
    }

    /// The same with a journal that wears beside its bush, by its volume over that of the bush.
    ///
    /// # Errors
    /// If the ratio is not above zero, or the joint does not wear, or is no journal that turns in its bearing alone.
    pub fn with_journal(mut self, ratio: f64) -> Result<Self, OutOfRange> {
        let name = "wear of the journal over that of the bush";
        let wear = self.laws.wear().filter(|_| self.laws.is_journal());
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
        self.laws = self.laws.as_guide()?;
        Ok(self)
    }

    /// The same with a factor on its wear coefficient.
    ///
    /// # Errors
    /// If it makes no sense, or the joint does not wear.
    pub fn with_factor(mut self, steps: &[Step]) -> Result<Self, OutOfRange> {
        self.laws.check_factor(steps)?;
        self.factor = Some(steps.to_vec());
        Ok(self)
    }

    /// Worn volume of the journal over that of the bush; nothing if it does not wear.
    pub fn journal_ratio(&self) -> Option<f64> {
        self.journal
    }

    /// Directions in which the journal is free: two across the axis, or three of a ball.
    pub fn freedoms(&self) -> usize {
        if self.laws.is_ball() { 3 } else { 2 }
    }

    /// Radius of the journal or ball [m].
    pub fn journal_radius(&self) -> f64 {
        self.laws.journal_radius()
    }

    /// Length of the bearing [m].
    pub fn length(&self) -> f64 {
        self.laws.length()
    }

    /// Its law of normal force.
    pub fn normal_law(&self) -> &Normal {
        self.laws.normal_law()
    }

    /// Archard's law and what was said about wear; nothing if it does not wear.
    pub fn wear(&self) -> Option<&(Archard, WearInfo)> {
        self.laws.wear()
    }

    /// K at a clearance [m], [N/m^n].
    pub fn stiffness<T: Scalar>(&self, clearance: T) -> T {
        self.laws.stiffness(clearance)
    }

    /// Penetration [m] of a contact at rest that carries `force` [N] at a clearance [m].
    pub fn resting_penetration(&self, clearance: f64, force: f64) -> f64 {
        self.laws.normal_law().resting_penetration(self.stiffness(clearance), force)
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
        self.laws.pair(clearance)
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
        let response = self.laws.respond(motion, support, (clearance, stiffness), memory);
        match &self.factor {
            Some(steps) => self.laws.with_factor(steps, response, motion),
            None => response,
        }
    }

    /// Offset of the journal's centre from the bearing's: a journal leaves the axis, and does not slide along it.
    #[inline(always)]
    pub fn offset<T: Scalar>(&self, motion: &[T; CONTACT_MOTION]) -> [T; 3] {
        self.laws.offset(motion)
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
        let (depth, n) = (touch.penetration(), self.laws.normal_law().exponent());
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
