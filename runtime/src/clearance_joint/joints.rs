//! All joints with clearance of a mechanism, with what each remembers and how far it is worn.
//! In: the answer of [`crate::Entry::Contacts`]. Out: [`ContactState`]es and the wrenches. Does not allocate while it runs.

use super::joint::{Clearance, ContactState};
use crate::contact::{ImpactMemory, crossing_speed};
use crate::description::Description;
use crate::error::SetupError;
use crate::system::{CONTACT_MOTION, CONTACT_WRENCH};
use crate::tables::ContactInfo;
use crate::wear::{Extent, Profile, Surfaces};

/// What belongs to a joint with clearance between two steps, besides coordinates and speeds: saved and
/// restored with them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClearanceState {
    /// What the running contact remembers.
    pub memory: ImpactMemory<f64>,
    /// Radial clearance on top of that of the parameters [m].
    pub worn: f64,
    /// Depth of the bush by bearing angle, on top of both.
    pub profile: Option<Profile>,
    /// Depth of the journal by its own angle, on top of all.
    #[cfg_attr(feature = "serde", serde(default))]
    pub journal: Option<Profile>,
}

impl ClearanceState {
    /// An unworn joint, apart.
    pub fn unworn() -> Self {
        Self { memory: ImpactMemory::apart(), worn: 0.0, profile: None, journal: None }
    }

    /// What is worn, by angle, of a journal that has turned so far [rad]; by the extent of both.
    fn surfaces(&self, extent: Extent, turned: f64) -> Surfaces<'_> {
        let journal = self.journal.as_ref().map(|journal| (journal, turned));
        Surfaces::new(extent, self.profile.as_ref(), journal)
    }

    fn extent(&self) -> Extent {
        Extent::of(self.profile.as_ref(), self.journal.as_ref())
    }
}

/// The joints with clearance of one mechanism; empty for most.
#[derive(Clone, Debug, Default)]
pub struct Clearances {
    joints: Vec<Clearance>,
    states: Vec<ClearanceState>,
    /// Of what is worn by angle, of each.
    extents: Vec<Extent>,
    contacts: Vec<ContactState>,
    wrenches: Vec<f64>,
    /// Whether the states changed since the last evaluation.
    changed: bool,
    /// Whether wear may have changed since then.
    worn: bool,
}

impl Clearances {
    /// Builds the laws of every joint.
    ///
    /// # Errors
    /// [`SetupError::Contact`] if a constant is out of range.
    pub fn of(description: &Description) -> Result<Self, SetupError> {
        let Description { contacts, journals, coefficients, guides, .. } = description;
        let build = |(at, info): (usize, &ContactInfo)| {
            let joint = Clearance::new(info);
            let joint = if guides.contains(&at) { joint.and_then(Clearance::as_guide) } else { joint };
            let journal = journals.iter().find(|journal| journal.contact == at);
            let joint = match journal {
                Some(journal) => joint.and_then(|joint| joint.with_journal(journal.ratio)),
                None => joint,
            };
            let factor = coefficients.iter().find(|factor| factor.contact == at);
            let joint = match factor {
                Some(factor) => joint.and_then(|joint| joint.with_factor(&factor.steps)),
                None => joint,
            };
            joint.map_err(|reason| SetupError::Contact { joint: info.joint.to_string(), reason })
        };
        let joints = contacts.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            states: vec![ClearanceState::unworn(); joints.len()],
            contacts: vec![ContactState::default(); joints.len()],
            wrenches: vec![0.0; CONTACT_WRENCH * joints.len()],
            extents: vec![Extent::default(); joints.len()],
            changed: true,
            worn: true,
            joints,
        })
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// The joints.
    pub fn joints(&self) -> &[Clearance] {
        &self.joints
    }

    /// What belongs to each between two steps.
    pub fn states(&self) -> &[ClearanceState] {
        &self.states
    }

    /// The same, to restore it or to change wear. As many as joints.
    pub fn states_mut(&mut self) -> &mut [ClearanceState] {
        self.changed = true;
        self.worn = true;
        &mut self.states
    }

    /// Every contact at the last evaluation.
    pub fn contacts(&self) -> &[ContactState] {
        &self.contacts
    }

    /// The wrenches of the last evaluation, joint by joint.
    pub fn wrenches(&self) -> &[f64] {
        &self.wrenches
    }

    /// Energy stored in all contacts at the last evaluation [J].
    pub fn elastic_energy(&self) -> f64 {
        self.contacts.iter().map(|touch| touch.elastic_energy).sum()
    }

    /// Distance [m] of a journal's centre from the bearing's, along the unit vector `direction`, at which the
    /// penetration is `penetration` [m], worn as at the last evaluation.
    pub fn distance(&self, index: usize, direction: [f64; 3], penetration: f64) -> f64 {
        let state = &self.states[index];
        let surfaces = state.surfaces(state.extent(), self.contacts[index].turned);
        let round = self.contacts[index].clearance - surfaces.mean();
        self.joints[index].distance(round, surfaces, direction, penetration)
    }

    /// Whether the laws would answer otherwise to the motions of the last evaluation.
    pub(crate) fn has_changed(&self) -> bool {
        self.changed
    }

    /// Applies the laws to motions as [`crate::Entry::Contacts`] gives them.
    pub fn evaluate(&mut self, motions: &[f64]) {
        self.changed = false;
        if core::mem::take(&mut self.worn) {
            let each = self.extents.iter_mut().zip(&self.states);
            each.for_each(|(extent, state)| *extent = state.extent());
        }
        let (motions, _) = motions.as_chunks::<CONTACT_MOTION>();
        let (wrenches, _) = self.wrenches.as_chunks_mut::<CONTACT_WRENCH>();
        let states = self.states.iter().zip(&self.extents);
        let each = self.joints.iter().zip(states).zip(&mut self.contacts);
        for (((joint, (state, extent)), touch), (motion, wrench)) in each.zip(motions.iter().zip(wrenches)) {
            let surfaces = state.surfaces(*extent, joint.turned(motion));
            *touch = joint.evaluate(motion, (state.worn, surfaces), &state.memory, touch);
            *wrench = touch.wrench;
        }
    }

    /// Takes over contacts evaluated elsewhere, each by what it was.
    pub(crate) fn take_over(&mut self, state: impl Fn(usize, &ContactState) -> ContactState) {
        self.changed = false;
        let (wrenches, _) = self.wrenches.as_chunks_mut::<CONTACT_WRENCH>();
        for (joint, (touch, wrench)) in self.contacts.iter_mut().zip(wrenches).enumerate() {
            *touch = state(joint, touch);
            *wrench = touch.wrench;
        }
    }

    /// Brings the memories up to date after a step from `before` to the last evaluation. A gap that closed
    /// within it remembers the speed at the crossing, both taken as linear.
    pub fn remember(&mut self, before: &[ContactState]) {
        for ((state, before), now) in self.states.iter_mut().zip(before).zip(&self.contacts) {
            // A contact that goes on keeps what it remembers, and one that is apart has nothing to.
            if (state.memory.touching > 0.5) == (now.penetration() > 0.0) {
                continue;
            }
            let at = |touch: &ContactState| (touch.penetration(), touch.penetration_rate);
            let speed = crossing_speed(at(before), at(now));
            let memory = state.memory.updated(now.penetration(), speed);
            self.changed |= memory != state.memory;
            state.memory = memory;
        }
    }

    /// A gap that closes just now, whatever rounding says of its sign.
    pub fn close(&mut self, index: usize) {
        let speed = self.contacts[index].penetration_rate.max(0.0);
        self.states[index].memory = ImpactMemory::in_contact(speed);
        self.changed = true;
    }

    /// Memories of contacts that nobody has followed so far: those that touch take their present rate.
    pub fn begin(&mut self) {
        for (state, now) in self.states.iter_mut().zip(&self.contacts) {
            state.memory = ImpactMemory::apart().updated(now.penetration(), now.penetration_rate);
        }
        self.changed = true;
    }
}
