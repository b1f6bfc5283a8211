//! Velocities and accelerations that are summed up along the axes where their terms are known, and turned once.
//! In: terms, rotations. Out: expressions along the axes of W or of a link. Never knows joints.

use crate::expr::{Expr, Mat3, Scope, Vec3};

/// Along which axes accelerations and forces are summed up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Axes {
    /// Accelerations of origins along those of W, each turned to its link once; else from link to link.
    pub accelerations_in_ground: bool,
    /// Forces along those of W; else from link to link.
    pub forces_in_ground: bool,
    /// Of those, what a link's mass does at its joint comes by the acceleration of the joint on the parent link.
    pub masses_inboard: bool,
    /// What a joint on the ground feels of links outboard comes along their axes, to which its screw is turned; else along its own.
    /// So does what every joint feels of masses.
    pub screws_outboard: bool,
}

impl Axes {
    /// Every choice, that of the links' own axes first.
    pub const ALL: [Self; 6] = [
        Self::new(false, false, false),
        Self::new(true, false, false),
        Self::new(false, true, false),
        Self::new(true, true, false),
        Self::new(false, true, true),
        Self::new(true, true, true),
    ];

    /// A further choice where rows ask for the screws along the axes of links outboard, too.
    pub const BY_SCREWS: Self = Self { screws_outboard: true, ..Self::ALL[1] };

    /// All of them, or those that long chains are tried along: each takes them as long as all the rest of a check.
    pub fn choices(all: bool) -> &'static [Self] {
        if all { &Self::ALL } else { &Self::ALL[..4] }
    }

    /// The [`Self::choices`] with accelerations along the axes of this one.
    pub fn with_these_accelerations(self, all: bool) -> impl Iterator<Item = Self> {
        let is_alike = move |other: &Self| other.accelerations_in_ground == self.accelerations_in_ground;
        Self::choices(all).iter().copied().filter(is_alike)
    }

    const fn new(accelerations_in_ground: bool, forces_in_ground: bool, masses_inboard: bool) -> Self {
        Self { accelerations_in_ground, forces_in_ground, masses_inboard, screws_outboard: false }
    }
}

/// A vector of a link with terms along the axes of W and terms along the link's own.
#[derive(Clone, Copy, Debug)]
pub struct Turned<'g> {
    ground: Vec3<'g>,
    own: Vec3<'g>,
}

/// What turning a link adds to a rate of its points: a matrix that a point's place is multiplied with.
pub struct Lever<'g> {
    /// Along the link's axes.
    own: Mat3<'g>,
    /// Along those of W, where the link turns about one of them: what it takes is the place along the axes of W, which more
    /// than one rate needs.
    ground: Option<Mat3<'g>>,
}

/// `skew(alpha) + skew(omega)²`.
pub fn spin<'g>(omega: Vec3<'g>, alpha: Vec3<'g>) -> Mat3<'g> {
    let squares = omega.map(Expr::square);
    let mut matrix = omega.scope().matrix([[0.0; 3]; 3]);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        matrix[i][i] = -(squares[j] + squares[k]);
        let product = omega[i] * omega[j];
        matrix[i][j] = product - alpha[k];
        matrix[j][i] = product + alpha[k];
    }
    matrix
}

impl<'g> Lever<'g> {
    /// Of velocities, for a link that `turn` takes to the axes of W.
    pub fn of_velocity(turn: Mat3<'g>, omega: Vec3<'g>) -> Self {
        let turned = turn * omega;
        Self { own: omega.skew(), ground: along_one_axis([turned, turned]).then(|| turned.skew()) }
    }

    /// Of accelerations.
    pub fn of_acceleration(turn: Mat3<'g>, omega: Vec3<'g>, alpha: Vec3<'g>) -> Self {
        let turned = [omega, alpha].map(|vector| turn * vector);
        let ground = along_one_axis(turned).then(|| spin(turned[0], turned[1]));
        Self { own: spin(omega, alpha), ground }
    }
}

fn along_one_axis(vectors: [Vec3<'_>; 2]) -> bool {
    let idle = |axis: usize| vectors.iter().all(|vector| vector[axis].is_zero());
    (0..3).filter(|axis| !idle(*axis)).count() < 2
}

/// Whether to turn a vector takes nothing: it lies along axes that stay where they are.
fn stays<'g>(turn: Mat3<'g>, vector: Vec3<'g>) -> bool {
    let fixed = |axis: usize| turn.into_iter().all(|row| row[axis].as_number().is_some());
    (0..3).all(|axis| vector[axis].is_zero() || fixed(axis))
}

impl<'g> Turned<'g> {
    pub fn zero(g: &'g Scope) -> Self {
        Self::own(g.zero_vector())
    }

    /// All of it known along the link's axes.
    pub fn own(own: Vec3<'g>) -> Self {
        Self { ground: own.scope().zero_vector(), own }
    }

    /// With another term along the link's axes.
    pub fn plus(self, own: Vec3<'g>) -> Self {
        Self { own: self.own + own, ..self }
    }

    /// The same rate of a point of the link, if this is that of its origin.
    pub fn at(self, turn: Mat3<'g>, lever: &Lever<'g>, point: Vec3<'g>) -> Self {
        match lever.ground {
            Some(matrix) if stays(turn, self.own) => {
                let place = turn * point;
                Self { ground: self.ground + matrix * place, ..self }
            }
            _ => self.plus(lever.own * point),
        }
    }

    /// Of the parallel link that slides from there: what is known along the axes of one is known along those of the other.
    pub fn at_parallel(self, lever: &Lever<'g>, point: Vec3<'g>) -> Self {
        self.plus(lever.own * point)
    }

    /// Along the axes of W.
    pub fn in_ground(self, turn: Mat3<'g>) -> Vec3<'g> {
        self.ground + turn * self.own
    }

    /// Of a link that turns against this one, whose axes count no more.
    pub fn left(self, turn: Mat3<'g>) -> Self {
        Self { ground: self.in_ground(turn), own: self.own.scope().zero_vector() }
    }

    /// The two parts: along the axes of W, and along the link's.
    pub fn parts(self) -> [Vec3<'g>; 2] {
        [self.ground, self.own]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(vector: Vec3<'_>) -> [f64; 3] {
        vector.0.map(|x| x.as_number().expect("numbers make a number"))
    }

    #[test]
    fn points_move_the_same_along_whichever_axes_terms_are_summed() {
        let g = Scope::new();
        let about_z = g.matrix([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]);
        let tilted = g.matrix([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]);
        let point = g.vector([0.3, -0.7, 0.2]);
        for (turn, axis) in [(about_z, [0.0, 0.0, 1.0]), (tilted, [0.5, -1.0, 2.0])] {
            let (omega, alpha) = (3.0 * g.vector(axis), -2.0 * g.vector(axis));
            let levers = [
                (Lever::of_velocity(turn, omega), omega.cross(point)),
                (Lever::of_acceleration(turn, omega, alpha), spin(omega, alpha) * point),
            ];
            for (lever, expected) in levers {
                for own in [[0.0; 3], [0.0, 0.0, 0.4], [1.0, 2.0, 0.0]] {
                    let origin = Turned::zero(&g).plus(g.vector(own));
                    let expected = numbers(turn * (g.vector(own) + expected));
                    let ways = [origin.at(turn, &lever, point), origin.at_parallel(&lever, point)];
                    for found in ways.map(|way| numbers(way.left(turn).in_ground(tilted))) {
                        // A few roundings of numbers of the order of ten.
                        let apart = (0..3).all(|i| (found[i] - expected[i]).abs() < 1e-14);
                        assert!(apart, "{found:?} is not {expected:?}");
                    }
                }
            }
        }
    }
}
