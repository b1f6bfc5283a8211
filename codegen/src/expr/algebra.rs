//! Expressions, vectors and matrices with operators, so that a formula reads like the book's.
//! In: expressions of one [`Scope`]. Out: expressions of it. Never knows frames: those live in `derive`
//! (docs/notation.md).

use std::fmt;
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use super::{ExprId, Graph, Scope};

/// An expression: a node and the graph that it belongs to.
#[derive(Clone, Copy)]
pub struct Expr<'g> {
    scope: &'g Scope,
    id: ExprId,
}

/// Three components.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<'g>(pub [Expr<'g>; 3]);

/// Three rows of three.
#[derive(Clone, Copy, Debug)]
pub struct Mat3<'g>(pub [Vec3<'g>; 3]);

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.id.fmt(f)
    }
}

impl From<Expr<'_>> for ExprId {
    fn from(expression: Expr<'_>) -> Self {
        expression.id
    }
}

impl<'g> Expr<'g> {
    pub(super) const fn new(scope: &'g Scope, id: ExprId) -> Self {
        Self { scope, id }
    }

    /// The node.
    #[must_use]
    pub const fn id(self) -> ExprId {
        self.id
    }

    /// The graph under construction.
    #[must_use]
    pub const fn scope(self) -> &'g Scope {
        self.scope
    }

    /// The number, if it is one.
    #[must_use]
    pub fn as_number(self) -> Option<f64> {
        self.scope.make(|g| g.as_constant(self.id))
    }

    /// Whether it is the number zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.as_number() == Some(0.0)
    }

    /// Gives the node a readable name, unless it is a constant, an input or named already.
    pub fn label(self, name: impl Into<String>) {
        self.scope.make(|g| g.label(self.id, name));
    }

    fn with(self, build: impl FnOnce(&mut Graph) -> ExprId) -> Self {
        Self { id: self.scope.make(build), ..self }
    }

    /// `1 / self`.
    #[must_use]
    pub fn recip(self) -> Self {
        self.with(|g| g.reciprocal(self.id))
    }

    /// `self²`.
    #[must_use]
    pub fn square(self) -> Self {
        self * self
    }

    /// `self ^ n` by repeated squaring.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        self.with(|g| g.power(self.id, n))
    }

    /// Square root.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.with(|g| g.sqrt(self.id))
    }

    /// Sine of an angle [rad].
    #[must_use]
    pub fn sin(self) -> Self {
        self.with(|g| g.sin(self.id))
    }

    /// Cosine of an angle [rad].
    #[must_use]
    pub fn cos(self) -> Self {
        self.with(|g| g.cos(self.id))
    }

    /// Exponential.
    #[must_use]
    pub fn exp(self) -> Self {
        self.with(|g| g.exp(self.id))
    }

    /// Natural logarithm.
    #[must_use]
    pub fn ln(self) -> Self {
        self.with(|g| g.ln(self.id))
    }

    /// Angle of the vector (`x`, `self`) [rad].
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        self.with(|g| g.atan2(self.id, x.id))
    }

    /// theta / sin theta, where `self` is sin² theta; series-safe at zero.
    #[must_use]
    pub fn angle_over_sine(self, cosine: Self) -> Self {
        self.with(|g| g.angle_over_sine(self.id, cosine.id))
    }

    /// Series-safe coefficient of the inverse Jacobian of SE(3) at theta² = `self`, `rank` times differentiated by it.
    #[must_use]
    pub fn log_coefficient(self, rank: u8) -> Self {
        self.with(|g| g.log_coefficient(rank, self.id))
    }

    /// Derivative by the symbol `variable`.
    #[must_use]
    pub fn derivative(self, variable: Self) -> Self {
        self.with(|g| g.derivative(self.id, variable.id))
    }
}

macro_rules! operator {
    ($trait:ident $method:ident, $assign:ident $assign_method:ident) => {
        impl $trait for Expr<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(|g| g.$method(self.id, other.id))
            }
        }

        impl $trait for Vec3<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::from_fn(|i| self[i].$method(other[i]))
            }
        }

        impl $trait for Mat3<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self[i].$method(other[i])))
            }
        }

        operator!(assigned $trait $method $assign $assign_method Expr);
        operator!(assigned $trait $method $assign $assign_method Vec3);
        operator!(assigned $trait $method $assign $assign_method Mat3);
    };
    (assigned $trait:ident $method:ident $assign:ident $assign_method:ident $type:ident) => {
        impl $assign for $type<'_> {
            fn $assign_method(&mut self, other: Self) {
                *self = $trait::$method(*self, other);
            }
        }
    };
}
operator!(Add add, AddAssign add_assign);
operator!(Sub sub, SubAssign sub_assign);

macro_rules! product {
    ($trait:ident $method:ident) => {
        impl $trait for Expr<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(|g| g.$method(self.id, other.id))
            }
        }
    };
}
product!(Mul mul);
product!(Div div);

macro_rules! with_number {
    ($($trait:ident $method:ident),*) => {$(
        impl<'g> $trait<Expr<'g>> for f64 {
            type Output = Expr<'g>;
            fn $method(self, other: Expr<'g>) -> Expr<'g> {
                other.scope.number(self).$method(other)
            }
        }

        impl $trait<f64> for Expr<'_> {
            type Output = Self;
            fn $method(self, number: f64) -> Self {
                self.$method(self.scope.number(number))
            }
        }
    )*};
}
with_number!(Add add, Sub sub, Mul mul, Div div);

macro_rules! scaled {
    ($($factor:ty),*) => {$(
        impl<'g> Mul<Vec3<'g>> for $factor {
            type Output = Vec3<'g>;
            fn mul(self, vector: Vec3<'g>) -> Vec3<'g> {
                vector.map(|component| self * component)
            }
        }

        impl<'g> Mul<Mat3<'g>> for $factor {
            type Output = Mat3<'g>;
            fn mul(self, matrix: Mat3<'g>) -> Mat3<'g> {
                Mat3(matrix.0.map(|row| self * row))
            }
        }
    )*};
}
scaled!(Expr<'g>, f64);

impl Neg for Expr<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(|g| g.neg(self.id))
    }
}

impl Neg for Vec3<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|component| -component)
    }
}

impl<'g> Vec3<'g> {
    /// From its components by index.
    #[must_use]
    pub fn from_fn(component: impl FnMut(usize) -> Expr<'g>) -> Self {
        Self(std::array::from_fn(component))
    }

    /// The first three of a list.
    ///
    /// # Panics
    /// If the list is shorter.
    #[must_use]
    pub fn first_of(list: &[Expr<'g>]) -> Self {
        Self::from_fn(|i| list[i])
    }

    /// With a function applied to every component.
    #[must_use]
    pub fn map(self, function: impl FnMut(Expr<'g>) -> Expr<'g>) -> Self {
        Self(self.0.map(function))
    }

    /// Scalar product.
    #[must_use]
    pub fn dot(self, other: Self) -> Expr<'g> {
        self[0] * other[0] + self[1] * other[1] + self[2] * other[2]
    }

    /// Cross product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            self[j] * other[k] - self[k] * other[j]
        })
    }

    /// The matrix with `a.skew() * b = a.cross(b)`.
    #[must_use]
    pub fn skew(self) -> Mat3<'g> {
        let (zero, minus) = (self[0].scope.zero(), -self);
        Mat3([
            Vec3([zero, minus[2], self[1]]),
            Vec3([self[2], zero, minus[0]]),
            Vec3([minus[1], self[0], zero]),
        ])
    }
}

impl<'g> Mat3<'g> {
    /// From its entries by row and column.
    #[must_use]
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Expr<'g>) -> Self {
        Self(std::array::from_fn(|i| Vec3::from_fn(|j| entry(i, j))))
    }

    /// Rows and columns exchanged.
    #[must_use]
    pub fn transpose(self) -> Self {
        Self::from_fn(|i, j| self[j][i])
    }

    /// Sum of the diagonal.
    #[must_use]
    pub fn trace(self) -> Expr<'g> {
        self[0][0] + self[1][1] + self[2][2]
    }

    /// `A_zy - A_yz`, and cyclic: the vector `a` with `A - Aᵀ = a.skew()`.
    #[must_use]
    pub fn axial(self) -> Vec3<'g> {
        Vec3::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            self[k][j] - self[j][k]
        })
    }
}

impl<'g> Mul<Vec3<'g>> for Mat3<'g> {
    type Output = Vec3<'g>;
    fn mul(self, vector: Vec3<'g>) -> Vec3<'g> {
        Vec3(self.0.map(|row| row.dot(vector)))
    }
}

impl Mul for Mat3<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let columns = other.transpose();
        Self::from_fn(|i, j| self[i].dot(columns[j]))
    }
}

macro_rules! indexed {
    ($type:ident, $item:ident) => {
        impl<'g> Index<usize> for $type<'g> {
            type Output = $item<'g>;
            fn index(&self, index: usize) -> &$item<'g> {
                &self.0[index]
            }
        }

        impl<'g> IndexMut<usize> for $type<'g> {
            fn index_mut(&mut self, index: usize) -> &mut $item<'g> {
                &mut self.0[index]
            }
        }

        impl<'g> IntoIterator for $type<'g> {
            type Item = $item<'g>;
            type IntoIter = std::array::IntoIter<$item<'g>, 3>;
            fn into_iter(self) -> Self::IntoIter {
                self.0.into_iter()
            }
        }
    };
}
indexed!(Vec3, Expr);
indexed!(Mat3, Vec3);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axial_vector_of_a_skew_matrix_is_twice_its_vector() {
        let scope = Scope::new();
        let a = scope.vector([1.0, -2.0, 0.5]);
        let twice = a.skew().axial().0.map(Expr::as_number);
        assert_eq!(twice, [Some(2.0), Some(-4.0), Some(1.0)]);
    }

    #[test]
    fn matrix_product_and_cross_product_agree() {
        let scope = Scope::new();
        let (a, b) = (scope.vector([1.0, -2.0, 0.5]), scope.vector([0.25, 4.0, -1.0]));
        let crossed = a.cross(b).0.map(Expr::as_number);
        assert_eq!((a.skew() * b).0.map(Expr::as_number), crossed);
        assert_eq!(crossed, [Some(0.0), Some(1.125), Some(4.5)]);
    }
}
