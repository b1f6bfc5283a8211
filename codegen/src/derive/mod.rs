//! Symbolic derivation: from a mechanism to named outputs over expression graphs.
//! In: `crate::model`. Out: [`Equations`]. Never knows text formats or Rust syntax.
//!
//! Order of reading: `linkage` (frames), `kinematics`, `link_mass`, `closure`, `elements`,
//! `plan`, `rows`, `dynamics`, `solve`, `forward`, `by_rows`, `articulated`, `shortest_way`, then `entries`, which asks them for what each entry point returns.

mod accelerations;
mod articulated;
mod articulated_body;
mod attachment;
mod by_rows;
mod closure;
mod contact_wrench;
mod contacts;
mod couplings;
mod deformation;
mod dynamics;
mod element;
mod elements;
mod elimination_cost;
mod entries;
mod equations;
mod fields;
mod force_values;
mod formula_to_expr;
mod forward;
mod frame;
mod frame_inertia;
mod geometry;
mod guide_contacts;
mod joint_axes;
mod joint_coordinates;
mod joint_markers;
mod joint_rows;
mod joint_state;
mod kept_rows;
mod kinematics;
mod least_elimination;
mod line;
mod link_mass;
mod linkage;
mod linkage_build;
mod loads;
mod local_modes;
mod log_closure;
mod mass_matrix;
mod mass_properties;
mod modal_moments;
mod motion;
mod mount;
mod moving;
mod orientation;
mod orthogonal;
mod own_plan;
mod own_speeds;
mod plan;
mod relative_motion;
mod responses;
mod rigid_part;
mod row;
mod rows;
mod screws;
mod shortest_way;
mod slid_drive;
mod solve;
mod start;
mod stops;
mod surface_row;
#[cfg(test)]
mod tests;
mod turned;
mod wear_factor;
mod wrench;

pub use closure::row_count;
pub(crate) use entries::number_among;
pub use entries::{
    Derived, Purpose, clearly_shorter, derive, equations_of_motion, shorter_in_ground, shorter_off_balls,
    splits_plane_rows,
};
pub use equations::{Derivation, Equations};
pub use linkage::{Freedom, Link, Linkage};
pub use plan::Guide;

use crate::expr::ExprId;

/// A function over the graph: what one entry point computes.
#[derive(Clone, Debug)]
pub struct Function {
    /// Snake-case name, e.g. `forward_dynamics`.
    pub name: String,
    /// What it answers, one or two sentences.
    pub doc: String,
    /// Input blocks; their concatenation is the flat input slice.
    pub inputs: Vec<Block>,
    /// Output blocks; their concatenation (row major) is the flat output slice.
    pub outputs: Vec<Block>,
    /// Whether it goes on from the function before it, which has answered at the same inputs: those begin alike. It may take
    /// over what that one has computed; then that one hands it out, and this one has it as further inputs.
    pub goes_on: bool,
}

/// A named vector or matrix of expressions (of symbols, for inputs).
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Block {
    /// Name, e.g. `phi_q`.
    pub name: String,
    /// What it is: shape, unit, frame.
    pub doc: String,
    /// Equation of the paper, e.g. "[CS (3)]", or empty.
    pub citation: String,
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub columns: usize,
    /// Entries, row major.
    pub entries: Vec<ExprId>,
    /// What each entry is called, where a number would say too little; else empty.
    pub names: Vec<String>,
}

impl Block {
    /// A column vector.
    pub fn vector(name: &str, entries: impl IntoIterator<Item = impl Into<ExprId>>) -> Self {
        let entries: Vec<ExprId> = entries.into_iter().map(Into::into).collect();
        Self::matrix(name, (entries.len(), 1), entries)
    }

    /// A matrix, row major.
    pub fn matrix(
        name: &str,
        (rows, columns): (usize, usize),
        entries: impl IntoIterator<Item = impl Into<ExprId>>,
    ) -> Self {
        let entries: Vec<ExprId> = entries.into_iter().map(Into::into).collect();
        debug_assert_eq!(rows * columns, entries.len());
        Self { name: name.to_owned(), rows, columns, entries, ..Self::default() }
    }

    /// With a sentence about what it is.
    pub fn doc(self, doc: &str) -> Self {
        Self { doc: doc.to_owned(), ..self }
    }

    /// With the equation of the paper.
    pub fn cites(self, citation: &str) -> Self {
        Self { citation: citation.to_owned(), ..self }
    }

    /// What a tape tells of it.
    pub fn header(&self) -> linkwear_tape::Block {
        let (name, doc, citation) = (self.name.clone(), self.doc.clone(), self.citation.clone());
        linkwear_tape::Block { name, doc, citation, rows: self.rows, columns: self.columns }
    }
}
