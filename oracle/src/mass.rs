//! Mass, centre and inertia of a body, from its description, by textbook formulas.
//! In: [`Inertia`]. Out: [`MassProperties`]. Never knows joints.

use linkwear_codegen::id::PointId;
use linkwear_codegen::model::{Amount, Inertia};
use nalgebra::{Matrix3, Vector3};

/// A rigid body's matter in its own reference pose.
#[derive(Clone, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass in W at the reference pose [m].
    pub centre: Vector3<f64>,
    /// Inertia about the centre in W axes at the reference pose [kg m²].
    pub inertia: Matrix3<f64>,
}

impl MassProperties {
    /// Properties of `inertia`; `position` gives points on this body's branch, `value` the value of a formula.
    pub(crate) fn new(
        inertia: &Inertia,
        position: &dyn Fn(PointId) -> Vector3<f64>,
        value: &dyn Fn(&linkwear_codegen::model::Formula) -> f64,
    ) -> Self {
        let mass_of = |amount: &Amount, volume: f64| match amount {
            Amount::Density(density) => value(density) * volume,
            Amount::Mass(mass) => value(mass),
        };
        match inertia {
            Inertia::Rod { ends, radius, inner_radius, amount } => {
                let [a, b] = ends.map(position);
                let (outer, inner) = (value(radius), value(inner_radius));
                let length = (b - a).norm();
                let volume = std::f64::consts::PI * (outer * outer - inner * inner) * length;
                let mass = mass_of(amount, volume);
                let radii = outer * outer + inner * inner;
                let along = mass * radii / 2.0;
                let across = mass * (3.0 * radii + length * length) / 12.0;
                let e = (b - a) / length;
                let inertia = across * Matrix3::identity() + (along - across) * e * e.transpose();
                Self { mass, centre: (a + b) / 2.0, inertia }
            }
            Inertia::Box { ends, width, width_axis, amount } => {
                let [a, b] = ends.map(position);
                let (w, h) = (value(&width[0]), value(&width[1]));
                let length = (b - a).norm();
                let mass = mass_of(amount, w * h * length);
                let z = (b - a) / length;
                let x = Vector3::from(*width_axis).normalize();
                let y = z.cross(&x);
                let about = |p: f64, q: f64| mass * (p * p + q * q) / 12.0;
                let inertia = about(h, length) * x * x.transpose()
                    + about(w, length) * y * y.transpose()
                    + about(w, h) * z * z.transpose();
                Self { mass, centre: (a + b) / 2.0, inertia }
            }
            Inertia::Given { mass, centre, inertia, axes } => {
                let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(|k| value(&inertia[k]));
                let local = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                let axes = Matrix3::from_columns(&axes.map(Vector3::from));
                Self {
                    mass: value(mass),
                    centre: position(*centre),
                    inertia: axes * local * axes.transpose(),
                }
            }
        }
    }
}
