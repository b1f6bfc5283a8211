//! Dry friction of a joint that carries the joint's own force.

use super::Formula;

/// Coulomb friction with a Stribeck curve and a smooth change of sign.
#[derive(Clone, Debug)]
pub struct DryFriction {
    /// Coefficient of sliding at speed.
    pub coefficient: Formula,
    /// Coefficient just after sliding begins.
    pub at_rest: Formula,
    /// Speed by which the second has fallen to the first [rad/s or m/s]; absent where both are one.
    pub stribeck_speed: Option<Formula>,
    /// Speed within which friction changes its sign [rad/s or m/s].
    pub onset: Formula,
    /// Radius of the bearing of a revolute joint [m].
    pub radius: Option<Formula>,
    /// Distance of the two bearings that carry moments across the axis [m]; absent where one place carries the force.
    pub length: Option<Formula>,
}

impl DryFriction {
    /// All its formulas.
    pub fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let given = [&self.stribeck_speed, &self.radius, &self.length].into_iter().flatten();
        [&self.coefficient, &self.at_rest, &self.onset].into_iter().chain(given)
    }
}
