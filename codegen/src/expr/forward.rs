//! The builders of the graph by name, for formulas that are not yet written with operators.

use super::{Expr, Mat3, Scope, Vec3};

#[allow(missing_docs, reason = "named as in the graph")]
impl Scope {
    pub fn constant<'g>(&'g self, x: f64) -> Expr<'g> {
        self.number(x)
    }
    pub fn one<'g>(&'g self) -> Expr<'g> {
        self.number(1.0)
    }
    pub fn add<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a + b
    }
    pub fn sub<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a - b
    }
    pub fn mul<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a * b
    }
    pub fn div<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a / b
    }
    pub fn atan2<'g>(&'g self, y: Expr<'g>, x: Expr<'g>) -> Expr<'g> {
        y.atan2(x)
    }
    pub fn angle_over_sine<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a.angle_over_sine(b)
    }
    pub fn derivative<'g>(&'g self, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
        a.derivative(b)
    }
    pub fn neg<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        -a
    }
    pub fn reciprocal<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.recip()
    }
    pub fn square<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.square()
    }
    pub fn sqrt<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.sqrt()
    }
    pub fn sin<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.sin()
    }
    pub fn cos<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.cos()
    }
    pub fn exp<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.exp()
    }
    pub fn ln<'g>(&'g self, a: Expr<'g>) -> Expr<'g> {
        a.ln()
    }
    pub fn power<'g>(&'g self, a: Expr<'g>, n: i32) -> Expr<'g> {
        a.powi(n)
    }
    pub fn log_coefficient<'g>(&'g self, rank: u8, a: Expr<'g>) -> Expr<'g> {
        a.log_coefficient(rank)
    }
    pub fn dot<'g>(&'g self, pairs: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        self.sum(pairs.iter().map(|(a, b)| *a * *b))
    }
    pub fn add3<'g>(&'g self, a: Vec3<'g>, b: Vec3<'g>) -> Vec3<'g> {
        a + b
    }
    pub fn sub3<'g>(&'g self, a: Vec3<'g>, b: Vec3<'g>) -> Vec3<'g> {
        a - b
    }
    pub fn cross3<'g>(&'g self, a: Vec3<'g>, b: Vec3<'g>) -> Vec3<'g> {
        a.cross(b)
    }
    pub fn neg3<'g>(&'g self, a: Vec3<'g>) -> Vec3<'g> {
        -a
    }
    pub fn scale3<'g>(&'g self, x: Expr<'g>, a: Vec3<'g>) -> Vec3<'g> {
        x * a
    }
    pub fn dot3<'g>(&'g self, a: Vec3<'g>, b: Vec3<'g>) -> Expr<'g> {
        a.dot(b)
    }
    pub fn mul_vec3<'g>(&'g self, m: Mat3<'g>, a: Vec3<'g>) -> Vec3<'g> {
        m * a
    }
    pub fn transpose_mul_vec3<'g>(&'g self, m: Mat3<'g>, a: Vec3<'g>) -> Vec3<'g> {
        m.transpose() * a
    }
    pub fn mul_mat3<'g>(&'g self, a: Mat3<'g>, b: Mat3<'g>) -> Mat3<'g> {
        a * b
    }
    pub fn skew3<'g>(&'g self, a: Vec3<'g>) -> Mat3<'g> {
        a.skew()
    }
    pub fn add_mat3<'g>(&'g self, a: Mat3<'g>, b: Mat3<'g>) -> Mat3<'g> {
        a + b
    }
    pub fn label<'g>(&'g self, a: Expr<'g>, name: impl Into<String>) -> () {
        a.label(name)
    }
    pub fn as_constant<'g>(&'g self, a: Expr<'g>) -> Option<f64> {
        a.as_number()
    }
    pub fn is_zero<'g>(&'g self, a: Expr<'g>) -> bool {
        a.is_zero()
    }
}
