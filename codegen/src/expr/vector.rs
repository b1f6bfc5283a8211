//! Vectors and matrices of expressions with operators, component by component: `array::map` is no loop that compilers unroll.
//! In: expressions of one [`Scope`]. Out: expressions of it. Never knows frames: those live in `derive`
//! (docs/notation.md).

use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use super::expression::Expr;
use super::scope::Scope;

/// Three components.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Vec3<'g>(pub [Expr<'g>; 3]);

/// Three rows of three.
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Mat3<'g>(pub [Vec3<'g>; 3]);

impl Scope {
    /// A vector of numbers.
    pub fn vector(&self, [x, y, z]: [f64; 3]) -> Vec3<'_> {
        Vec3([self.number(x), self.number(y), self.number(z)])
    }

    /// A matrix of numbers, row by row.
    pub fn matrix(&self, [x, y, z]: [[f64; 3]; 3]) -> Mat3<'_> {
        Mat3([self.vector(x), self.vector(y), self.vector(z)])
    }

    /// The zero vector.
    pub fn zero_vector(&self) -> Vec3<'_> {
        let zero = self.zero();
        Vec3([zero, zero, zero])
    }

    /// The identity matrix.
    pub fn identity(&self) -> Mat3<'_> {
        self.matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    }

    /// `sum weight_k vector_k` of constant vectors.
    pub fn weighted_vectors<'g>(&'g self, vectors: &[[f64; 3]], weights: &[Expr<'g>]) -> Vec3<'g> {
        Vec3::from_fn(|i| self.weighted(vectors.iter().map(|vector| vector[i]), weights))
    }

    /// `sum weight_k matrix_k` of constant matrices.
    pub fn weighted_matrices<'g>(&'g self, matrices: &[[[f64; 3]; 3]], weights: &[Expr<'g>]) -> Mat3<'g> {
        Mat3::from_fn(|i, j| self.weighted(matrices.iter().map(|matrix| matrix[i][j]), weights))
    }
}

macro_rules! by_component {
    ($trait:ident $method:ident, $assign:ident $assign_method:ident, $($type:ident),*) => {$(
        impl $trait for $type<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self([self[0].$method(other[0]), self[1].$method(other[1]), self[2].$method(other[2])])
            }
        }

        impl $assign for $type<'_> {
            fn $assign_method(&mut self, other: Self) {
                *self = (*self).$method(other);
            }
        }
    )*};
}
by_component!(Add add, AddAssign add_assign, Vec3, Mat3);
by_component!(Sub sub, SubAssign sub_assign, Vec3, Mat3);

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
                let [x, y, z] = matrix.0;
                Mat3([self * x, self * y, self * z])
            }
        }
    )*};
}
scaled!(Expr<'g>, f64);

impl Neg for Vec3<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|component| -component)
    }
}

impl Neg for Mat3<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        let [x, y, z] = self.0;
        Self([-x, -y, -z])
    }
}

impl<'g> Vec3<'g> {
    /// From its components by index.
    #[inline]
    pub fn from_fn(mut component: impl FnMut(usize) -> Expr<'g>) -> Self {
        Self([component(0), component(1), component(2)])
    }

    /// Whether it is the same three nodes.
    pub fn is(self, other: Self) -> bool {
        (0..3).all(|i| self[i].id() == other[i].id())
    }

    /// The first three of a list.
    ///
    /// # Panics
    /// If the list is shorter.
    pub fn first_of(list: &[Expr<'g>]) -> Self {
        Self::from_fn(|i| list[i])
    }

    /// The graph under construction.
    pub const fn scope(self) -> &'g Scope {
        self.0[0].scope()
    }

    /// With a function applied to every component.
    #[inline]
    pub fn map(self, mut function: impl FnMut(Expr<'g>) -> Expr<'g>) -> Self {
        let [x, y, z] = self.0;
        Self([function(x), function(y), function(z)])
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, other: Self) -> Expr<'g> {
        self[0] * other[0] + self[1] * other[1] + self[2] * other[2]
    }

    /// Cross product.
    #[inline]
    pub fn cross(self, other: Self) -> Self {
        Self::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            self[j] * other[k] - self[k] * other[j]
        })
    }

    /// The matrix with `a.skew() * b = a.cross(b)`.
    pub fn skew(self) -> Mat3<'g> {
        let (zero, minus) = (self.scope().zero(), -self);
        Mat3([
            Vec3([zero, minus[2], self[1]]),
            Vec3([self[2], zero, minus[0]]),
            Vec3([minus[1], self[0], zero]),
        ])
    }
}

impl<'g> Mat3<'g> {
    /// From its entries by row and column.
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Expr<'g>) -> Self {
        let mut row = |i: usize| Vec3::from_fn(|j| entry(i, j));
        Self([row(0), row(1), row(2)])
    }

    /// Rows and columns exchanged.
    pub fn transpose(self) -> Self {
        Self::from_fn(|i, j| self[j][i])
    }

    /// `turn m turnᵀ`.
    pub fn turned_by(self, turn: Self) -> Self {
        turn * self * turn.transpose()
    }

    /// Sum of the diagonal.
    pub fn trace(self) -> Expr<'g> {
        self[0][0] + self[1][1] + self[2][2]
    }

    /// `A_zy - A_yz`, and cyclic: the vector `a` with `A - Aᵀ = a.skew()`.
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
        Vec3::from_fn(|i| self[i].dot(vector))
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
