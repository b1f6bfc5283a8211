//! How the drawing that a body is written in is turned in the whole: what goes by the axes of the drawing goes by them there too.
//! In: rotations of parts, from the innermost out. Out: directions before and after them.

/// A rotation.
pub(super) type Turn = [[f64; 3]; 3];

/// Components of directions before a turn are whole multiples of this: choices between axes go by zeros and by numbers that are alike,
/// which turning back leaves rounding of, 1e-16.
const WHOLE: f64 = 1e-12;

/// The rotation of a drawing; none where it is not turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drawn(Option<Turn>);

impl Drawn {
    /// The same, turned once more.
    pub(super) fn turned(self, by: &Turn) -> Self {
        let Some(turn) = self.0 else { return Self(Some(*by)) };
        let entry = |i: usize, j: usize| (0..3).map(|k| by[i][k] * turn[k][j]).sum();
        Self(Some(std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))))
    }

    /// A direction of the whole as it is in the drawing.
    pub fn before(self, direction: [f64; 3]) -> [f64; 3] {
        let Some(turn) = self.0 else { return direction };
        let back = |j: usize| (0..3).map(|i| turn[i][j] * direction[i]).sum::<f64>();
        std::array::from_fn(|j| (back(j) / WHOLE).round() * WHOLE)
    }

    /// A direction of the drawing as it is in the whole.
    pub fn after(self, direction: [f64; 3]) -> [f64; 3] {
        let Some(turn) = self.0 else { return direction };
        turn.map(|row| row.iter().zip(direction).map(|(factor, x)| factor * x).sum())
    }

    /// Whether it is turned.
    pub fn is_turned(self) -> bool {
        self.0.is_some()
    }
}
