//! Expressions with operators, so that a formula reads like the book's: constants fold, identities hold.
//! In: a [`Scope`]. Out: [`Expr`]s of it. Never knows what is computed.

use std::fmt;
use std::sync::Arc;

use rustc_hash::{FxHashMap, FxHashSet};

use super::scope::Scope;
use super::{Binary, ExprId, Node, Unary};

/// An expression: a node and the graph that it belongs to.
#[derive(Clone, Copy)]
#[must_use]
pub struct Expr<'g> {
    scope: &'g Scope,
    id: ExprId,
    form: Form,
}

/// What operators ask of most operands, beside the id, so that they need not look into the graph for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Zero,
    Number,
    Negative,
    Other,
}

impl Form {
    #[inline]
    fn of(node: Node) -> Self {
        match node {
            // Zero has one form: -0.0 is no number of a graph.
            Node::Constant(0) => Self::Zero,
            Node::Constant(_) => Self::Number,
            Node::Unary(Unary::Neg, _) => Self::Negative,
            _ => Self::Other,
        }
    }
}

impl Scope {
    /// A new input, `name` as it reads in generated code.
    pub fn symbol(&self, name: impl Into<String>) -> Expr<'_> {
        self.at(self.make(|g| g.symbol(name)))
    }

    /// A number. `-0.0` becomes `0.0`.
    #[inline]
    pub fn number(&self, value: f64) -> Expr<'_> {
        if value == 0.0 {
            return self.zero();
        }
        self.expression(Node::Constant((value + 0.0).to_bits()))
    }

    #[inline]
    fn expression(&self, node: Node) -> Expr<'_> {
        self.make(|g| {
            let id = g.intern(node);
            // Beyond the limit the first node stands for all.
            let node = if id.index() == 0 { g.node(id) } else { node };
            Expr { scope: self, id, form: Form::of(node) }
        })
    }

    /// A node that is there.
    #[inline]
    pub(super) fn at(&self, id: ExprId) -> Expr<'_> {
        Expr { scope: self, id, form: Form::of(self.make(|g| g.node(id))) }
    }

    /// Zero.
    #[inline]
    pub fn zero(&self) -> Expr<'_> {
        match self.make(|g| g.zero) {
            Some(id) => Expr { scope: self, id, form: Form::Zero },
            None => self.first_zero(),
        }
    }

    #[cold]
    fn first_zero(&self) -> Expr<'_> {
        let zero = self.expression(Node::Constant(0));
        // Beyond the limit another node stands for it.
        if zero.is_zero() {
            self.make(|g| g.zero = Some(zero.id));
        }
        zero
    }

    /// The nodes that roots need, themselves included, each after those that it reads.
    pub fn nodes(&self, roots: &[ExprId]) -> Vec<(ExprId, Node)> {
        self.make(|g| {
            let uses = g.uses(roots);
            g.live(&uses).into_iter().map(|id| (id, g.node(id))).collect()
        })
    }

    /// Sum of any number of terms.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        terms.into_iter().fold(self.zero(), |sum, term| sum + term)
    }

    /// What the pieces that roots need are chosen by: values whose sign changes where another piece begins, each once.
    pub fn switches<'g>(&'g self, roots: &[ExprId]) -> Vec<Expr<'g>> {
        let mut needed = self.nodes(roots);
        self.make(|g| {
            needed.retain(|(_, node)| !matches!(node, Node::Select(by, ..) if g.quiet.contains(by)))
        });
        let own = |id| self.at(id);
        let (mut switches, mut known) = (Vec::new(), FxHashSet::default());
        for (_, node) in needed {
            let switch = match node {
                Node::Select(by, ..) => own(by),
                // Where it jumps, and half way in between.
                Node::Unary(Unary::Floor, of) => own(of) - own(of).floor() - 0.5,
                _ => continue,
            };
            if known.insert(switch.id) {
                switches.push(switch);
            }
        }
        switches
    }

    /// Operations that these roots need so far; see [`super::Graph::operations`].
    pub fn operations<'g>(&'g self, roots: impl IntoIterator<Item = Expr<'g>>) -> usize {
        let roots: Vec<ExprId> = roots.into_iter().map(Expr::id).collect();
        self.make(|g| g.operations(&roots))
    }

    /// `sum weight_k number_k`.
    pub fn weighted<'g>(&'g self, numbers: impl IntoIterator<Item = f64>, weights: &[Expr<'g>]) -> Expr<'g> {
        self.sum(numbers.into_iter().zip(weights).map(|(number, weight)| number * *weight))
    }
}

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
    /// The node's id.
    #[inline]
    pub const fn id(self) -> ExprId {
        self.id
    }

    /// The graph under construction.
    #[inline]
    pub const fn scope(self) -> &'g Scope {
        self.scope
    }

    /// The number, if it is one.
    #[inline]
    pub fn as_number(self) -> Option<f64> {
        match self.form {
            Form::Zero => Some(0.0),
            Form::Number => self.scope.make(|g| g.as_constant(self.id)),
            Form::Negative | Form::Other => None,
        }
    }

    /// About how large it gets while symbols and functions are of the order of one: what numbers in it make of it.
    pub fn size(self) -> f64 {
        self.size_by(&mut FxHashMap::default())
    }

    fn size_by(self, known: &mut FxHashMap<ExprId, f64>) -> f64 {
        if let Some(size) = known.get(&self.id) {
            return *size;
        }
        let mut of = |id| self.at(id).size_by(known);
        let size = match self.node() {
            Node::Constant(bits) => f64::from_bits(bits).abs(),
            Node::Unary(Unary::Neg, a) => of(a),
            Node::Binary(Binary::Mul, a, b) => of(a) * of(b),
            Node::Binary(Binary::Add | Binary::Sub, a, b) => of(a).max(of(b)),
            _ => 1.0,
        };
        known.insert(self.id, size);
        size
    }

    /// Whether it is the number zero.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.form == Form::Zero
    }

    /// Gives the node a readable name, unless it is a constant, an input or named already.
    pub fn label(self, name: impl Into<Arc<str>>) {
        self.scope.make(|g| g.label(self.id, name));
    }

    /// `1 / self`.
    pub fn recip(self) -> Self {
        1.0 / self
    }

    /// `self²`.
    pub fn square(self) -> Self {
        self * self
    }

    /// `self ^ n` by repeated squaring.
    pub fn powi(self, n: i32) -> Self {
        let mut result = self.scope.number(1.0);
        let mut factor = self;
        let mut left = n.unsigned_abs();
        while left > 0 {
            if left & 1 == 1 {
                result = result * factor;
            }
            left >>= 1;
            if left > 0 {
                factor = factor.square();
            }
        }
        if n < 0 { result.recip() } else { result }
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        self.folded(f64::sqrt, |x| x.unary(Unary::Sqrt))
    }

    /// Sine of an angle [rad].
    pub fn sin(self) -> Self {
        self.folded(f64::sin, |angle| {
            let (x, negated) = angle.strip_sign();
            x.unary(Unary::Sin).with_sign(negated)
        })
    }

    /// Cosine of an angle [rad].
    pub fn cos(self) -> Self {
        self.folded(f64::cos, |angle| angle.strip_sign().0.unary(Unary::Cos))
    }

    /// Exponential.
    pub fn exp(self) -> Self {
        self.folded(f64::exp, |x| x.unary(Unary::Exp))
    }

    /// Natural logarithm.
    pub fn ln(self) -> Self {
        self.folded(f64::ln, |x| x.unary(Unary::Ln))
    }

    /// The largest whole number that is not above it.
    pub fn floor(self) -> Self {
        self.folded(f64::floor, |x| x.unary(Unary::Floor))
    }

    /// `yes` where it is below zero, else `no`.
    pub fn below_zero(self, yes: Self, no: Self) -> Self {
        match self.as_number() {
            _ if yes.id == no.id => yes,
            Some(number) => {
                if number < 0.0 {
                    yes
                } else {
                    no
                }
            }
            None => self.scope.expression(Node::Select(self.id, yes.id, no.id)),
        }
    }

    /// As a condition it is none of [`Scope::switches`].
    pub fn keep_quiet(self) {
        self.scope.make(|g| g.quiet.insert(self.id));
    }

    /// Angle of the vector (`x`, `self`) [rad].
    pub fn atan2(self, x: Self) -> Self {
        match (self.as_number(), x.as_number()) {
            (Some(a), Some(b)) => self.scope.number(a.atan2(b)),
            _ => self.binary(Binary::Atan2, x),
        }
    }

    /// theta / sin theta, where `self` is sin² theta; series-safe at zero.
    pub fn angle_over_sine(self, cosine: Self) -> Self {
        self.binary(Binary::AngleOverSine, cosine)
    }

    /// Series-safe coefficient of the inverse Jacobian of SE(3) at theta² = `self`, `rank` times differentiated by it.
    pub fn log_coefficient(self, rank: u8) -> Self {
        self.unary(Unary::LogCoefficient(rank))
    }

    /// The value of a function of it, by the constructor that folds and orders.
    pub(super) fn through(self, operation: Unary) -> Self {
        match operation {
            Unary::Neg => -self,
            Unary::Sqrt => self.sqrt(),
            Unary::Sin => self.sin(),
            Unary::Cos => self.cos(),
            Unary::Exp => self.exp(),
            Unary::Ln => self.ln(),
            Unary::Floor => self.floor(),
            Unary::LogCoefficient(rank) => self.log_coefficient(rank),
        }
    }

    /// The value of a function of it and another, likewise.
    pub(super) fn joined(self, operation: Binary, other: Self) -> Self {
        match operation {
            Binary::Add => self + other,
            Binary::Sub => self - other,
            Binary::Mul => self * other,
            Binary::Div => self / other,
            Binary::Atan2 => self.atan2(other),
            Binary::AngleOverSine => self.angle_over_sine(other),
        }
    }

    /// Whether it is the negative of another node, or a number.
    #[inline]
    pub(super) fn may_change_sign(self) -> bool {
        self.form != Form::Other
    }

    /// The node behind it.
    #[inline]
    pub(super) fn node(self) -> Node {
        self.scope.make(|g| g.node(self.id))
    }

    /// Another node of the same graph.
    #[inline]
    pub(super) fn at(self, id: ExprId) -> Self {
        self.scope.at(id)
    }

    #[inline]
    pub(super) fn unary(self, operation: Unary) -> Self {
        self.scope.expression(Node::Unary(operation, self.id))
    }

    #[inline]
    pub(super) fn binary(self, operation: Binary, other: Self) -> Self {
        self.scope.expression(Node::Binary(operation, self.id, other.id))
    }

    /// Of a commutative operation.
    #[inline]
    pub(super) fn ordered(self, operation: Binary, other: Self) -> Self {
        if self.id < other.id { self.binary(operation, other) } else { other.binary(operation, self) }
    }

    /// The value of a number, else a node.
    fn folded(self, value: fn(f64) -> f64, make: impl FnOnce(Self) -> Self) -> Self {
        self.as_number().map_or_else(|| make(self), |x| self.scope.number(value(x)))
    }
}
