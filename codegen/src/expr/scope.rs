//! Where expressions are made: a graph behind a shared reference, so that formulas need no `&mut`.
//! Out: a finished [`Graph`]. Never knows what is computed.

use std::cell::RefCell;

use super::{ExprId, Graph, Mat3, Vec3};

/// A graph under construction. Nodes are made in the order in which formulas are written.
#[derive(Debug, Default)]
pub struct Scope(RefCell<Graph>);

impl Scope {
    /// An empty graph.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The finished graph.
    #[must_use]
    pub fn into_graph(self) -> Graph {
        self.0.into_inner()
    }

    /// A new input, `name` as it reads in generated code.
    pub fn symbol(&self, name: impl Into<String>) -> ExprId {
        self.0.borrow_mut().symbol(name)
    }

    /// Starts a section: nodes first made from here on belong to it.
    pub fn begin_section(&self, title: impl Into<String>) {
        self.0.borrow_mut().begin_section(title);
    }

    /// Gives a node a readable name, unless it is a constant, an input or named already.
    pub fn label(&self, id: ExprId, name: impl Into<String>) {
        self.0.borrow_mut().label(id, name);
    }

    /// The number behind a node, if it is one.
    pub fn as_constant(&self, id: ExprId) -> Option<f64> {
        self.0.borrow().as_constant(id)
    }

    /// Whether the node is the number zero.
    pub fn is_zero(&self, id: ExprId) -> bool {
        self.0.borrow().is_zero(id)
    }
}

// The builders of the graph under the same names.
#[allow(missing_docs, reason = "documented at the graph's builders")]
impl Scope {
    pub fn constant(&self, value: f64) -> ExprId {
        self.0.borrow_mut().constant(value)
    }
    pub fn zero(&self) -> ExprId {
        self.0.borrow_mut().zero()
    }
    pub fn one(&self) -> ExprId {
        self.0.borrow_mut().one()
    }
    pub fn add(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().add(a, b)
    }
    pub fn sub(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().sub(a, b)
    }
    pub fn mul(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().mul(a, b)
    }
    pub fn div(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().div(a, b)
    }
    pub fn atan2(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().atan2(a, b)
    }
    pub fn angle_over_sine(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().angle_over_sine(a, b)
    }
    pub fn derivative(&self, a: ExprId, b: ExprId) -> ExprId {
        self.0.borrow_mut().derivative(a, b)
    }
    pub fn neg(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().neg(a)
    }
    pub fn reciprocal(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().reciprocal(a)
    }
    pub fn square(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().square(a)
    }
    pub fn sqrt(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().sqrt(a)
    }
    pub fn sin(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().sin(a)
    }
    pub fn cos(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().cos(a)
    }
    pub fn exp(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().exp(a)
    }
    pub fn ln(&self, a: ExprId) -> ExprId {
        self.0.borrow_mut().ln(a)
    }
    pub fn power(&self, a: ExprId, n: i32) -> ExprId {
        self.0.borrow_mut().power(a, n)
    }
    pub fn log_coefficient(&self, rank: u8, theta_squared: ExprId) -> ExprId {
        self.0.borrow_mut().log_coefficient(rank, theta_squared)
    }
    pub fn dot(&self, pairs: &[(ExprId, ExprId)]) -> ExprId {
        self.0.borrow_mut().dot(pairs)
    }
    pub fn derivative_along(&self, a: ExprId, seeds: &[(ExprId, ExprId)]) -> ExprId {
        self.0.borrow_mut().derivative_along(a, seeds)
    }
    pub fn vector(&self, values: [f64; 3]) -> Vec3 {
        self.0.borrow_mut().vector(values)
    }
    pub fn zero_vector(&self) -> Vec3 {
        self.0.borrow_mut().zero_vector()
    }
    pub fn matrix(&self, rows: [[f64; 3]; 3]) -> Mat3 {
        self.0.borrow_mut().matrix(rows)
    }
    pub fn add3(&self, a: Vec3, b: Vec3) -> Vec3 {
        self.0.borrow_mut().add3(a, b)
    }
    pub fn sub3(&self, a: Vec3, b: Vec3) -> Vec3 {
        self.0.borrow_mut().sub3(a, b)
    }
    pub fn cross3(&self, a: Vec3, b: Vec3) -> Vec3 {
        self.0.borrow_mut().cross3(a, b)
    }
    pub fn neg3(&self, a: Vec3) -> Vec3 {
        self.0.borrow_mut().neg3(a)
    }
    pub fn scale3(&self, factor: ExprId, a: Vec3) -> Vec3 {
        self.0.borrow_mut().scale3(factor, a)
    }
    pub fn dot3(&self, a: Vec3, b: Vec3) -> ExprId {
        self.0.borrow_mut().dot3(a, b)
    }
    pub fn mul_vec3(&self, m: Mat3, a: Vec3) -> Vec3 {
        self.0.borrow_mut().mul_vec3(m, a)
    }
    pub fn transpose_mul_vec3(&self, m: Mat3, a: Vec3) -> Vec3 {
        self.0.borrow_mut().transpose_mul_vec3(m, a)
    }
    pub fn mul_mat3(&self, a: Mat3, b: Mat3) -> Mat3 {
        self.0.borrow_mut().mul_mat3(a, b)
    }
    pub fn skew3(&self, a: Vec3) -> Mat3 {
        self.0.borrow_mut().skew3(a)
    }
    pub fn add_mat3(&self, a: Mat3, b: Mat3) -> Mat3 {
        self.0.borrow_mut().add_mat3(a, b)
    }
}
