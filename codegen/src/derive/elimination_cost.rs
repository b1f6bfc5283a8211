//! Operations that the elimination of an unknown causes, by which entries are zero, numbers or values.
//! In: a symmetric matrix of expressions. Out: counts. Never knows what is eliminated first.

use crate::expr::Expr;

/// What an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Zero,
    /// One or minus one, with which a product costs nothing.
    One,
    Number,
    Value,
}

/// Kinds of all entries.
pub struct Costs(Vec<Vec<Kind>>);

/// Counts operations as they are named.
#[derive(Default)]
struct Counter(usize);

impl Counter {
    fn product(&mut self, a: Kind, b: Kind) -> Kind {
        match (a, b) {
            (Kind::Zero, _) | (_, Kind::Zero) => Kind::Zero,
            (Kind::One, other) | (other, Kind::One) => other,
            (Kind::Number, Kind::Number) => Kind::Number,
            _ => {
                self.0 += 1;
                Kind::Value
            }
        }
    }

    fn sum(&mut self, a: Kind, b: Kind) -> Kind {
        match (a, b) {
            (Kind::Zero, other) | (other, Kind::Zero) => other,
            (Kind::Value, _) | (_, Kind::Value) => {
                self.0 += 1;
                Kind::Value
            }
            _ => Kind::Number,
        }
    }

    fn reciprocal(&mut self, a: Kind) -> Kind {
        self.0 += usize::from(a == Kind::Value);
        a
    }
}

impl Costs {
    /// Of a matrix.
    pub fn new(matrix: &[Vec<Expr<'_>>]) -> Self {
        let kind = |entry: &Expr<'_>| match entry.as_number() {
            Some(0.0) => Kind::Zero,
            Some(number) if number.abs() == 1.0 => Kind::One,
            Some(_) => Kind::Number,
            None => Kind::Value,
        };
        Self(matrix.iter().map(|row| row.iter().map(kind).collect()).collect())
    }

    /// Of an unknown by its diagonal, with `others` that have entries with it.
    pub fn alone(&self, k: usize, others: &[usize]) -> usize {
        let (matrix, mut counter) = (&self.0, Counter::default());
        let reciprocal = counter.reciprocal(matrix[k][k]);
        for (position, &i) in others.iter().enumerate() {
            let factor = counter.product(matrix[i][k], reciprocal);
            for &j in &others[position..] {
                let less = counter.product(factor, matrix[j][k]);
                counter.sum(matrix[i][j], less);
            }
            // Right-hand side, and back substitution.
            for entry in [factor, matrix[i][k]] {
                let less = counter.product(entry, Kind::Value);
                counter.sum(Kind::Value, less);
            }
        }
        counter.product(reciprocal, Kind::Value);
        counter.0
    }

    /// Of a speed and a row by their common number, with `others` that have entries with either.
    pub fn pair(&self, s: usize, r: usize, others: &[usize]) -> usize {
        let (matrix, mut counter) = (&self.0, Counter::default());
        let (constant, diagonal) = (matrix[r][s], matrix[s][s]);
        let known = counter.product(constant, Kind::Value);
        let own = counter.product(diagonal, known);
        let left_over = counter.sum(Kind::Value, own);
        let mut shares = Vec::new();
        for &j in others {
            let share = counter.product(constant, matrix[j][r]);
            let product = counter.product(diagonal, share);
            shares.push((share, counter.sum(matrix[j][s], product)));
        }
        for (position, &i) in others.iter().enumerate() {
            let (share, beside) = (shares[position].0, matrix[i][s]);
            for (other, &j) in others.iter().enumerate().skip(position) {
                let first = counter.product(beside, shares[other].0);
                let second = counter.product(share, shares[other].1);
                let less = counter.sum(first, second);
                counter.sum(matrix[i][j], less);
            }
            for (a, b) in [(beside, known), (share, left_over)] {
                let less = counter.product(a, b);
                counter.sum(Kind::Value, less);
            }
            for entry in [matrix[i][r], matrix[i][s]] {
                let less = counter.product(entry, Kind::Value);
                counter.sum(Kind::Value, less);
            }
        }
        let own = counter.product(diagonal, Kind::Value);
        counter.sum(Kind::Value, own);
        counter.product(constant, Kind::Value);
        counter.product(constant, Kind::Value);
        counter.0
    }
}
