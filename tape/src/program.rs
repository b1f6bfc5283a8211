//! All of a mechanism that a run needs. In: description, tapes. Out: [`Program`], whose parts fit each other.

use linkwear_runtime::{Description, Entry, InputRole, Layout, SegmentInfo, Sizes};

use crate::interpreter::Interpreted;
use crate::stored::{Damage, Stored, sealed, unsealed};
use crate::tape::Tape;
use crate::verify::verify;

/// A mechanism without its file: what it tells about itself, and its equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    description: Description,
    /// In the order of [`Entry::ALL`].
    tapes: Vec<Tape>,
    sizes: Sizes,
}

impl Program {
    /// Of tapes in the order of [`Entry::ALL`].
    ///
    /// # Errors
    /// If a tape makes no sense, or they do not fit the description.
    pub fn new(description: Description, tapes: Vec<Tape>) -> Result<Self, Damage> {
        let sizes = sizes(&description, &tapes)?;
        if tapes.len() != Entry::ALL.len() {
            return Err(Damage::value(format!("{} tapes, not {}", tapes.len(), Entry::ALL.len())));
        }
        for (entry, tape) in Entry::ALL.into_iter().zip(&tapes) {
            let defect = |defect| Damage::value(format!("tape `{}`: {defect}", entry.name()));
            verify(tape).map_err(defect)?;
            if (tape.input_len(), tape.output_len()) != (sizes.input(entry), sizes.output(entry)) {
                return Err(defect("it does not fit the description".to_owned()));
            }
        }
        Ok(Self { description, tapes, sizes })
    }

    /// Names, units, rows and channels.
    pub const fn description(&self) -> &Description {
        &self.description
    }

    /// One tape per entry, in the order of [`Entry::ALL`].
    pub fn tapes(&self) -> &[Tape] {
        &self.tapes
    }

    /// Lengths of inputs and outputs; each back end has a workspace of its own.
    pub const fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// The mechanism as a runtime system, without a compiler.
    pub fn interpreter(&self) -> Interpreted {
        Interpreted::new(&self.tapes, self.sizes, self.description.clone())
    }

    /// As bytes, from which [`Self::from_bytes`] makes the same program.
    pub fn to_bytes(&self) -> Vec<u8> {
        sealed(self)
    }

    /// A program from its bytes.
    ///
    /// # Errors
    /// If they are damaged, or another linkwear wrote them.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Damage> {
        unsealed(bytes)
    }
}

impl Stored for Program {
    fn write(&self, to: &mut Vec<u8>) {
        self.description.write(to);
        self.tapes.write(to);
    }

    fn read(from: &mut &[u8]) -> Result<Self, Damage> {
        Self::new(Stored::read(from)?, Stored::read(from)?)
    }
}

/// What the description says of lengths; what tapes hold between two calls is in the tape.
fn sizes(description: &Description, tapes: &[Tape]) -> Result<Sizes, Damage> {
    let fits = |holds: bool, what: &str| if holds { Ok(()) } else { Err(Damage::value(what)) };
    let (rows, drivers) = (&description.rows, description.drivers.len());
    let mut kept: Vec<usize> = rows.iter().filter_map(|row| row.kept).collect();
    kept.sort_unstable();
    fits(kept.iter().copied().eq(0..kept.len()), "a kept row is missing or there twice")?;
    let mut driven: Vec<usize> = description.motions.iter().filter_map(|motion| motion.driver()).collect();
    driven.sort_unstable();
    fits(driven.iter().copied().eq(0..drivers), "a driver drives nothing or twice")?;
    fits(description.turn_driver.is_none_or(|driver| driver < drivers), "no driver turns")?;
    let missions = description.missions.iter();
    let mut segments = missions.flat_map(|mission| mission.segments.iter().chain(mission.coarser.iter()));
    let known = |segment: &SegmentInfo| {
        segment.factors.len() == description.contacts.len()
            && segment.values.iter().all(|(place, _)| *place < description.parameters.len())
    };
    fits(segments.all(known), "a mission sets what is not there")?;
    let coordinates = description.coordinates.len();
    let within = |first: &usize| first.checked_add(4).is_some_and(|end| end <= coordinates);
    fits(description.quaternions.iter().all(within), "a quaternion is outside the coordinates")?;
    fits(description.inputs.len() <= description.parameters.len(), "there are more inputs than parameters")?;
    // An input has no rates or two.
    let mut inputs = description.inputs.chunk_by(|_, next| *next == InputRole::RateOfPrevious);
    let whole = |input: &[InputRole]| input[0] == InputRole::Value && matches!(input.len(), 1 | 3);
    fits(inputs.all(whole), "an input has too few or too many rates")?;
    let layout = Layout::new(&description.motions);
    let sizes = Sizes {
        parameters: description.parameters.len(),
        coordinates,
        speeds: description.speeds.len(),
        all_coordinates: layout.all_coordinates,
        all_speeds: layout.all_speeds,
        rows: kept.len(),
        all_rows: rows.len(),
        drivers,
        contacts: description.contacts.len(),
        channels: description.channels.len(),
        held: 0,
        workspace: 0,
    };
    let contacts = tapes.get(Entry::Contacts as usize).map_or(0, Tape::output_len);
    let held = contacts.checked_sub(sizes.output(Entry::Contacts));
    let held = held.ok_or_else(|| Damage::value("contacts are missing from their tape"))?;
    Ok(Sizes { held, ..sizes })
}
