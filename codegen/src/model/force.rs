//! Force elements between bodies: what acts where.

use super::{Carrier, Formula};
use crate::id::PointId;
use crate::source::Span;
use crate::spec::{Bodies, Dimension, ForceKind};

/// A force element between bodies.
#[derive(Clone, Debug)]
pub struct Force {
    /// Name in the file.
    pub name: String,
    /// What acts.
    pub kind: &'static ForceKind,
    /// The two bodies; of a kind that acts on one, that body and the one that takes the reaction.
    pub bodies: [Carrier; 2],
    /// Where it acts on each; twice the same point if the kind has one.
    pub at: [PointId; 2],
    /// x, y and z axis of an element with directions: unit vectors in W at the reference pose.
    pub directions: [[f64; 3]; 3],
    /// Axes of components: W, or W-parallel at the reference pose and moving with this body.
    pub axes: Carrier,
    /// The kind's values in their order, SI; those by axis take three places.
    pub formulas: Vec<Formula>,
    /// Whether it is the spring of a joint, after which it is called.
    pub of_joint: bool,
    /// Where it is written.
    pub span: Span,
}

impl Force {
    /// An element with the axes of W, which no file tells.
    ///
    /// # Panics
    /// If no kind has this name.
    #[expect(clippy::expect_used, reason = "documented: names are written in code, never read from files")]
    pub fn new(kind: &str, bodies: [Carrier; 2], at: [PointId; 2], formulas: Vec<Formula>) -> Self {
        Self {
            name: kind.to_owned(),
            kind: ForceKind::named(kind).expect("the name of a kind of force element"),
            bodies,
            at,
            directions: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            axes: Carrier::Ground,
            formulas,
            of_joint: false,
            span: Span::default(),
        }
    }

    /// The values of a kind whose `N` values are single numbers.
    pub fn numbers<const N: usize>(&self) -> [&Formula; N] {
        std::array::from_fn(|at| &self.formulas[at])
    }

    /// The values of a kind whose `N` values are by axis.
    ///
    /// # Panics
    /// If there are fewer formulas.
    pub fn triples<const N: usize>(&self) -> [&[Formula; 3]; N] {
        std::array::from_fn(|at| &self.formulas.as_chunks().0[at])
    }

    /// Whether the formulas are over the state; else they are over parameters.
    pub const fn is_over_state(&self) -> bool {
        matches!(self.kind.bodies, Bodies::One(_))
    }

    /// Behind its own name, that of a column of its kind: springs of joints tell their moments, beside the joint's own.
    pub fn column(&self, name: &str, dimension: Dimension) -> Option<String> {
        match self.of_joint {
            false => Some(name.to_owned()),
            true => (dimension == Dimension::TORQUE).then(|| format!("spring_{name}")),
        }
    }

    /// Points at which bodies are pushed.
    pub fn attachments(&self) -> Vec<(Carrier, PointId)> {
        let sides = self.bodies.into_iter().zip(self.at);
        if self.kind.points == 0 { Vec::new() } else { sides.collect() }
    }
}
