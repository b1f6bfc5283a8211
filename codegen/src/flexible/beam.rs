//! A beam as the user describes it, checked.
//! In: segments, concentrated masses, theory, how it is held, how many modes. Out: the same, known to make sense.
//!
//! The axis is +x from 0 to the length; y and z are principal axes of every section.

use super::error::BeamError;
use super::section::{Material, Properties, Section};

/// Most modes one family is resolved for; beyond, a beam is not a beam.
pub const MODE_LIMIT: usize = 40;

/// A uniform piece of the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Length [m].
    pub length: f64,
    /// Cross-section.
    pub section: Section,
    /// Material.
    pub material: Material,
}

/// A body rigidly fixed to one section, with its centre of mass on the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConcentratedMass {
    /// Place along the axis [m].
    pub x: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Moments of inertia about x, y, z through its centre of mass [kg m²]; zeros for a point.
    pub inertia: [f64; 3],
}

/// What of a section moves and resists in bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theory {
    /// Sections stay normal to the axis and have no rotary inertia.
    EulerBernoulli,
    /// Sections stay normal to the axis; rotary inertia.
    Rayleigh,
    /// Shear deformation and rotary inertia.
    Timoshenko,
}

/// A place where something attaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attachment {
    /// Place along the axis [m].
    pub x: f64,
    /// Whether it passes moments that bend along y and along z, so that a static shape of its rotation is worth a mode.
    pub rotation: [bool; 2],
}

/// How the beam is held: boundary conditions of the modes, and with them the floating frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Hold {
    /// Chord frame: the axis of the frame passes through two places of the beam, where deflection is 0.
    /// Its origin stays on x = 0 of the undeformed axis. `None`: both ends.
    Pinned(Option<[f64; 2]>),
    /// The frame is fixed to a section.
    Clamped {
        /// Place of the section [m].
        at: f64,
        /// Another place, where something pulls and twists: the first axial and the first torsional mode are the static ones.
        far: Option<f64>,
    },
    /// Modes of the free beam; the frame follows the mean motion.
    Free,
    /// Chord frame through the first and the last attachment, static shapes of the others, fixed-interface modes,
    /// then made eigenmodes of what they span.
    CraigBampton(Vec<Attachment>),
}

/// How many modes of each family.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Bending modes: the lowest of both planes; equal ones first along y, then along z. With [`Hold::CraigBampton`]
    /// the fixed-interface modes; static shapes come on top.
    pub bending: usize,
    /// Axial modes.
    pub axial: usize,
    /// Torsional modes.
    pub torsion: usize,
}

/// A beam and what to compute of it.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamInput {
    /// Uniform pieces from x = 0 on.
    pub segments: Vec<Segment>,
    /// Concentrated masses.
    pub masses: Vec<ConcentratedMass>,
    /// Theory of bending.
    pub theory: Theory,
    /// How it is held.
    pub hold: Hold,
    /// How many modes.
    pub modes: Counts,
    /// Damping ratio zeta of every mode: D_ff = 2 zeta omega.
    pub damping_ratio: f64,
    /// Whether the quadratic displacement field (foreshortening) is computed.
    pub second_order: bool,
}

impl Hold {
    /// Clamped at x = 0, with nothing else attached.
    pub const CANTILEVER: Self = Self::Clamped { at: 0.0, far: None };
}

impl BeamInput {
    /// Length of the beam [m].
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// Sections of the segments, when everything makes sense.
    pub(super) fn checked(&self) -> Result<Vec<Properties>, BeamError> {
        if self.segments.is_empty() {
            return Err(BeamError::NoSegment);
        }
        let sections = self.segments.iter().enumerate().map(|(index, segment)| segment.checked(index));
        let sections: Vec<Properties> = sections.collect::<Result<_, _>>()?;
        if self.theory == Theory::Timoshenko
            && let Some(segment) = sections.iter().position(|section| section.shear.is_none())
        {
            return Err(BeamError::NoShearCoefficient { segment });
        }
        for (index, mass) in self.masses.iter().enumerate() {
            if !mass.is_real() {
                return Err(BeamError::ConcentratedMass { index });
            }
            self.place(mass.x)?;
        }
        self.check_hold()?;
        if !(self.damping_ratio.is_finite() && self.damping_ratio >= 0.0) {
            return Err(BeamError::DampingRatio { value: self.damping_ratio });
        }
        let asked = self.modes.bending.max(self.modes.axial).max(self.modes.torsion);
        if asked > MODE_LIMIT {
            return Err(BeamError::TooManyModes { asked, limit: MODE_LIMIT });
        }
        Ok(sections)
    }

    /// A place on the beam, moved onto an end that it misses by rounding only.
    pub(super) fn place(&self, x: f64) -> Result<f64, BeamError> {
        let length = self.length();
        let near = same_place(length);
        if !x.is_finite() || x < -near || x > length + near {
            return Err(BeamError::Outside { x, length });
        }
        Ok(x.clamp(0.0, length))
    }

    /// Held places or attachments in rising order; both ends of the chord first and last.
    pub(super) fn attachments(&self) -> Vec<Attachment> {
        let at = |x| Attachment { x, rotation: [false; 2] };
        match &self.hold {
            Hold::Pinned(None) => vec![at(0.0), at(self.length())],
            Hold::Pinned(Some(held)) => held.iter().copied().map(at).collect(),
            Hold::Clamped { .. } | Hold::Free => vec![],
            Hold::CraigBampton(attachments) => attachments.clone(),
        }
    }

    /// Places that the hold names, in rising order.
    pub(super) fn held(&self) -> Vec<f64> {
        let mut places: Vec<f64> = match &self.hold {
            Hold::Clamped { at, far } => std::iter::once(*at).chain(*far).collect(),
            _ => self.attachments().iter().map(|attachment| attachment.x).collect(),
        };
        places.sort_by(f64::total_cmp);
        places
    }

    /// Where the axis keeps its place in the floating frame [m]; nothing if no place does.
    pub(super) fn origin(&self) -> Option<f64> {
        match &self.hold {
            Hold::Clamped { at, .. } => Some(*at),
            _ => self.attachments().first().map(|first| first.x),
        }
    }

    /// Where what pulls and twists at the other end stretches and twists the beam statically; nothing if nothing does.
    pub(super) fn far(&self) -> Option<f64> {
        match &self.hold {
            Hold::Clamped { far, .. } => *far,
            _ => self.attachments().last().map(|last| last.x),
        }
    }

    fn check_hold(&self) -> Result<(), BeamError> {
        let held = self.held();
        for place in &held {
            self.place(*place)?;
        }
        if matches!(self.hold, Hold::CraigBampton(_)) && held.len() < 2 {
            return Err(BeamError::NoChord);
        }
        let near = 1e3 * same_place(self.length());
        if held.windows(2).any(|pair| pair[1] - pair[0] < near) {
            return Err(BeamError::HeldTogether);
        }
        Ok(())
    }
}

/// Places closer than this are one place [m]: sums of written lengths differ by rounding, 1e-16 of the length.
pub fn same_place(length: f64) -> f64 {
    1e-10 * length
}

impl Segment {
    fn checked(&self, segment: usize) -> Result<Properties, BeamError> {
        let Material { youngs_modulus, poisson_ratio, density } = self.material;
        let numbers = [("length", self.length), ("Young's modulus", youngs_modulus), ("density", density)];
        for (what, value) in numbers {
            if !(value.is_finite() && value > 0.0) {
                return Err(BeamError::NotPositive { what, segment, value });
            }
        }
        if !(poisson_ratio > -1.0 && poisson_ratio <= 0.5) {
            return Err(BeamError::PoissonRatio { segment, value: poisson_ratio });
        }
        self.section.checked(poisson_ratio, segment)
    }
}

impl ConcentratedMass {
    /// ∫ (component)² dm about its centre along x, y, z [kg m²].
    pub(super) fn spread(&self) -> [f64; 3] {
        let [x, y, z] = self.inertia;
        [(y + z - x) / 2.0, (z + x - y) / 2.0, (x + y - z) / 2.0]
    }

    fn is_real(&self) -> bool {
        let largest = self.inertia.iter().copied().fold(0.0, f64::max);
        // A flat body has a spread of 0, which written numbers miss by rounding.
        let spread = self.spread().into_iter().all(|each| each >= -1e-12 * largest);
        self.mass.is_finite()
            && self.mass > 0.0
            && self.inertia.iter().all(|each| each.is_finite() && *each >= 0.0)
            && spread
    }
}
