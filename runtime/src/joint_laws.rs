//! The laws of one joint with clearance, built once, on any scalar. In: [`ContactInfo`]; then motion, clearance, memory. Out:
//! [`Response`]s. Never knows wear by bearing angle; does not allocate.

use crate::contact::{
    Friction, GuideContact, GuideMotion, ImpactMemory, Laws, Normal, OutOfRange, RevoluteContact,
    RevoluteMotion, SphericalContact, SphericalMotion, Stiffness, Support, positive,
};
use crate::scalar::Scalar;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};
use crate::tables::{ContactInfo, WearInfo};
use crate::wear::{Archard, Load, MOST_LIVE, Pair, ScalarFeedback, Step, factor, is_sound};

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

/// The laws of a joint with clearance.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLaws {
    laws: Laws,
    stiffness: Stiffness,
    radius: f64,
    length: f64,
    modulus: f64,
    touch: Touch,
    wear: Option<(Archard, WearInfo)>,
}

/// What the laws of a joint say at one instant; SI.
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
    /// Mean pressure by the joint's contact area; zero if it does not wear.
    pub pressure: T,
    /// Rate of the depth.
    pub depth_rate: T,
    /// Factor on the wear coefficient, where there is one.
    pub wear_factor: Option<T>,
    /// Force and moment on the journal.
    pub wrench: [T; CONTACT_WRENCH],
}

impl JointLaws {
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
            wear,
        })
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

    /// Whether a factor on the wear coefficient makes sense, and the joint wears.
    pub(crate) fn check_factor(&self, steps: &[Step]) -> Result<(), OutOfRange> {
        let live = if self.touch == Touch::Journal { MOST_LIVE } else { 0 };
        if self.wear.is_some() && is_sound(steps, 2 + live) {
            return Ok(());
        }
        let (name, need) = (
            "steps of the factor on the wear coefficient",
            "of a joint that wears, at most 1024 (a table has a dozen a row)",
        );
        Err(OutOfRange { name, value: steps.len() as f64, need })
    }

    /// Whether it is a ball in a socket.
    pub fn is_ball(&self) -> bool {
        self.touch == Touch::Ball
    }

    /// Whether it is a journal that turns in its bearing alone.
    pub fn is_journal(&self) -> bool {
        self.touch == Touch::Journal
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

    /// Geometry for areas at a clearance [m].
    pub fn pair<T: Scalar>(&self, clearance: T) -> Pair<T> {
        let [journal_radius, length, modulus] = [self.radius, self.length, self.modulus].map(T::constant);
        Pair { journal_radius, length, clearance, modulus }
    }

    /// Offset of the journal's centre from the bearing's: a journal leaves the axis, and does not slide along it.
    #[inline(always)]
    pub fn offset<T: Scalar>(&self, motion: &[T; CONTACT_MOTION]) -> [T; 3] {
        let along = if self.touch == Touch::Ball { motion[2] } else { T::constant(0.0) };
        [motion[0], motion[1], along]
    }

    /// The laws at one instant: lanes run them as they are. `motion` as [`crate::Entry::Contacts`] gives it; `support`: how the
    /// bearing meets a journal's centre; radial clearance with its mean wear [m] and K there. The wear coefficient counts as it
    /// stands.
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
        let zero = T::constant(0.0);
        let pair = self.pair(clearance);
        let (pressure, depth_rate) = self.wear.as_ref().map_or((zero, zero), |(archard, _)| {
            let pressure = archard.area().pressure(&load, &pair);
            (pressure, archard.depth_rate(pressure, sliding_speed))
        });
        Response {
            penetration,
            penetration_rate,
            normal_force,
            sliding_speed,
            elastic_energy: force.normal.elastic_energy,
            loss: damping_loss + force.friction_loss,
            wear_power: normal_force * sliding_speed.abs(),
            pressure,
            depth_rate,
            wear_factor: None,
            wrench: [fx, fy, fz, mx, my, mz],
        }
    }

    /// The same with a factor on the wear coefficient: zero apart.
    #[inline(always)]
    pub(crate) fn with_factor<T: Scalar>(
        &self,
        steps: &[Step],
        response: Response<T>,
        motion: &[T; CONTACT_MOTION],
    ) -> Response<T> {
        let Response { normal_force, pressure, sliding_speed, .. } = response;
        let given = [pressure, sliding_speed.abs(), motion[5], motion[6], motion[7]];
        let zero = T::constant(0.0);
        let factor = T::select(zero.lt(normal_force), factor(steps, &given), zero);
        Response { depth_rate: response.depth_rate * factor, wear_factor: Some(factor), ..response }
    }
}
