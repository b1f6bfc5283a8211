//! Places of points in the frames of their links.
//! In: [`Mechanism`], [`Linkage`]. Out: expressions, constant wherever no tunable parameter occurs.
//! Never knows coordinates.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::id::PointId;
use crate::model::{Carrier, Mechanism};

use super::formula_to_expr::Inputs;
use super::frame::Frame;
use super::linkage::{LinkIndex, Linkage};

/// Entries smaller than this share of the largest are rounding dust of frame changes.
const DUST: f64 = 1e-14;

/// Where points of bodies are in the frames of their links.
#[derive(Clone, Copy)]
pub struct Geometry<'g> {
    pub g: &'g Scope,
    pub mechanism: &'g Mechanism,
    pub linkage: &'g Linkage,
    pub inputs: &'g Inputs<'g>,
}

impl<'g> Geometry<'g> {
    /// Position of a point as `carrier`'s branch describes it, in W at the reference pose [m].
    pub fn described(&self, point: PointId, carrier: Carrier) -> Vec3<'g> {
        self.inputs.lower3(self.mechanism.point(point).position_for(carrier))
    }

    /// A point of a link's body in the link's frame [m]; for the ground in W.
    pub fn local(&self, link: LinkIndex, point: PointId) -> Vec3<'g> {
        let Some(at) = link else { return self.described(point, Carrier::Ground) };
        let link = &self.linkage.links[at];
        let carrier = Carrier::Body(link.body);
        let place = self.described(point, carrier);
        let arm = place - self.described(link.origin, carrier);
        without_dust(self.turn(&link.frame, arm))
    }

    /// Position of a link's inboard joint in the parent link's frame [m].
    pub fn mount(&self, at: usize) -> Vec3<'g> {
        let links = &self.linkage.links;
        let link = &links[at];
        let first_of_chain = link.parent.is_none_or(|parent| links[parent].joint != link.joint);
        if link.node.is_some() || !first_of_chain {
            return self.g.zero_vector();
        }
        self.local(link.parent, self.mechanism.joint(link.joint).at)
    }

    /// Components in a link's frame of a vector in W at the reference pose.
    pub fn turn(&self, frame: &Frame, vector: Vec3<'g>) -> Vec3<'g> {
        self.g.matrix(frame.0).transpose() * vector
    }
}

/// Sets constants that are dust next to the largest constant to zero.
pub fn without_dust<'g>(v: Vec3<'g>) -> Vec3<'g> {
    let size = largest(v);
    v.map(|x| clean(x, size))
}

/// The same for a matrix.
pub fn matrix_without_dust<'g>(m: Mat3<'g>) -> Mat3<'g> {
    let size = m.into_iter().map(largest).fold(0.0, f64::max);
    Mat3(m.0.map(|row| row.map(|x| clean(x, size))))
}

fn largest(v: Vec3<'_>) -> f64 {
    v.into_iter().filter_map(Expr::as_number).fold(0.0, |size, x| size.max(x.abs()))
}

fn clean(x: Expr<'_>, size: f64) -> Expr<'_> {
    match x.as_number() {
        Some(value) if value.abs() < DUST * size => x.scope().zero(),
        _ => x,
    }
}
