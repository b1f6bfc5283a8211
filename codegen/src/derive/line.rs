//! Force elements along the line between two points: the line, and the pull of a rope.
//! In: link motion. Out: expressions. Never knows loads and columns.

use crate::expr::{Expr, Vec3};
use crate::model::Force;

use super::geometry::Geometry;
use super::linkage::LinkIndex;
use super::motion::Motion;

/// The line between the two points of an element.
pub struct Line<'g> {
    pub links: [LinkIndex; 2],
    /// In the frames of the links [m].
    pub points: [Vec3<'g>; 2],
    /// From the first to the second, in W.
    pub direction: Vec3<'g>,
    /// [m].
    pub length: Expr<'g>,
    /// Rate of the length [m/s].
    pub speed: Expr<'g>,
}

impl<'g> Line<'g> {
    /// The line at this instant.
    pub fn new(element: &Force, motion: &Motion<'g>) -> Self {
        let geometry = &motion.poses.geometry;
        let links = [0, 1].map(|i| geometry.linkage.link_at(element.bodies[i], element.at[i], false));
        let points = [0, 1].map(|i| geometry.local(links[i], element.at[i]));
        let places = [0, 1].map(|i| motion.poses.position(links[i], points[i]));
        let velocities = [0, 1].map(|i| motion.velocity_in_ground(links[i], points[i]));
        let (apart, rate) = (places[1] - places[0], velocities[1] - velocities[0]);
        let length = apart.dot(apart).sqrt();
        let direction = length.recip() * apart;
        Self { links, points, direction, length, speed: direction.dot(rate) }
    }
}

/// Pull of a rope: with `s = k (l - rest) + preload`, `max(0, s + c l̇)` where s is above zero, else nothing. It stores `s²/2k`.
pub struct Taut<'g> {
    /// [N].
    pub force: Expr<'g>,
    /// [J].
    pub stored: Expr<'g>,
    /// [W].
    pub dissipated: Expr<'g>,
}

impl<'g> Taut<'g> {
    /// The pull at this instant.
    pub fn new(element: &Force, motion: &Motion<'g>, line: &Line<'g>) -> Self {
        let Geometry { g, inputs, .. } = motion.poses.geometry;
        let [stiffness, rest, damping, preload] = element.numbers().map(|formula| inputs.lower(formula));
        let strain = stiffness * (line.length - rest) + preload;
        let slack = -strain;
        let elastic = slack.below_zero(strain, g.zero());
        let stored = 0.5 * (elastic.square() / stiffness);
        if damping.is_zero() {
            return Self { force: elastic, stored, dissipated: g.zero() };
        }
        let pull = slack.below_zero(strain + damping * line.speed, g.zero());
        let force = pull.below_zero(g.zero(), pull);
        Self { force, stored, dissipated: (force - elastic) * line.speed }
    }
}
