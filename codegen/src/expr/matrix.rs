//! Vectors and 3x3 matrices of expressions. In: a graph. Out: expressions of it.
//! Never knows frames: those live in `screw` and `derive` (docs/notation.md).

use super::{ExprId, Graph};

/// Three components.
pub type Vec3 = [ExprId; 3];
/// Three rows of three.
pub type Mat3 = [Vec3; 3];

impl Graph {
    /// A vector of numbers.
    pub fn vector(&mut self, values: [f64; 3]) -> Vec3 {
        values.map(|value| self.constant(value))
    }

    /// The zero vector.
    pub fn zero_vector(&mut self) -> Vec3 {
        self.vector([0.0; 3])
    }

    /// A matrix of numbers, row by row.
    pub fn matrix(&mut self, rows: [[f64; 3]; 3]) -> Mat3 {
        rows.map(|row| self.vector(row))
    }

    /// `a + b`.
    pub fn add3(&mut self, a: Vec3, b: Vec3) -> Vec3 {
        core::array::from_fn(|i| self.add(a[i], b[i]))
    }

    /// `a - b`.
    pub fn sub3(&mut self, a: Vec3, b: Vec3) -> Vec3 {
        core::array::from_fn(|i| self.sub(a[i], b[i]))
    }

    /// `-a`.
    pub fn neg3(&mut self, a: Vec3) -> Vec3 {
        a.map(|x| self.neg(x))
    }

    /// `factor * a`.
    pub fn scale3(&mut self, factor: ExprId, a: Vec3) -> Vec3 {
        a.map(|x| self.mul(factor, x))
    }

    /// Scalar product.
    pub fn dot3(&mut self, a: Vec3, b: Vec3) -> ExprId {
        self.dot(&[(a[0], b[0]), (a[1], b[1]), (a[2], b[2])])
    }

    /// Cross product.
    pub fn cross3(&mut self, a: Vec3, b: Vec3) -> Vec3 {
        core::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (left, right) = (self.mul(a[j], b[k]), self.mul(a[k], b[j]));
            self.sub(left, right)
        })
    }

    /// `m a`.
    pub fn mul_vec3(&mut self, m: Mat3, a: Vec3) -> Vec3 {
        m.map(|row| self.dot3(row, a))
    }

    /// `mᵀ a`.
    pub fn transpose_mul_vec3(&mut self, m: Mat3, a: Vec3) -> Vec3 {
        self.mul_vec3(transpose(m), a)
    }

    /// `a b`.
    pub fn mul_mat3(&mut self, a: Mat3, b: Mat3) -> Mat3 {
        let columns = transpose(b);
        a.map(|row| core::array::from_fn(|j| self.dot3(row, columns[j])))
    }

    /// The matrix with `skew(a) b = a x b`.
    pub fn skew3(&mut self, a: Vec3) -> Mat3 {
        let zero = self.zero();
        let minus = self.neg3(a);
        [[zero, minus[2], a[1]], [a[2], zero, minus[0]], [minus[1], a[0], zero]]
    }

    /// `a + b`.
    pub fn add_mat3(&mut self, a: Mat3, b: Mat3) -> Mat3 {
        core::array::from_fn(|i| self.add3(a[i], b[i]))
    }
}

/// Rows and columns exchanged.
#[must_use]
pub fn transpose(m: Mat3) -> Mat3 {
    core::array::from_fn(|i| core::array::from_fn(|j| m[j][i]))
}
