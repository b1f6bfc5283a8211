//! Where expressions are made: a graph behind a shared reference. Out: [`Expr`]s, then the finished [`Graph`].
//! Never knows what is computed.

use std::cell::RefCell;

use super::algebra::{Expr, Mat3, Vec3};
use super::{ExprId, Graph};

/// A graph under construction. Nodes are made in the order in which Rust evaluates the operands of a formula.
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

    /// What `build` makes of the graph.
    pub(super) fn make<R>(&self, build: impl FnOnce(&mut Graph) -> R) -> R {
        build(&mut self.0.borrow_mut())
    }

    /// The expression of a node.
    const fn expr(&self, id: ExprId) -> Expr<'_> {
        Expr::new(self, id)
    }

    /// A new input, `name` as it reads in generated code.
    pub fn symbol(&self, name: impl Into<String>) -> Expr<'_> {
        self.expr(self.make(|g| g.symbol(name)))
    }

    /// Starts a section: nodes first made from here on belong to it.
    pub fn begin_section(&self, title: impl Into<String>) {
        self.make(|g| g.begin_section(title));
    }

    /// A number.
    pub fn number(&self, value: f64) -> Expr<'_> {
        self.expr(self.make(|g| g.constant(value)))
    }

    /// A vector of numbers.
    pub fn vector(&self, components: [f64; 3]) -> Vec3<'_> {
        Vec3(components.map(|component| self.number(component)))
    }

    /// A matrix of numbers, row by row.
    pub fn matrix(&self, rows: [[f64; 3]; 3]) -> Mat3<'_> {
        Mat3(rows.map(|row| self.vector(row)))
    }

    /// Zero.
    pub fn zero(&self) -> Expr<'_> {
        self.number(0.0)
    }

    /// The zero vector.
    pub fn zero_vector(&self) -> Vec3<'_> {
        self.vector([0.0; 3])
    }

    /// The identity matrix.
    pub fn identity(&self) -> Mat3<'_> {
        self.matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    }

    /// Sum of any number of terms.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        terms.into_iter().fold(self.zero(), |sum, term| sum + term)
    }

    /// `sum weight_k number_k`.
    pub fn weighted<'g>(&'g self, numbers: impl IntoIterator<Item = f64>, weights: &[Expr<'g>]) -> Expr<'g> {
        self.sum(numbers.into_iter().zip(weights).map(|(number, weight)| number * *weight))
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
