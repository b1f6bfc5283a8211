//! Frames: where they are and how they are turned. In and out: numbers. Never knows what has them.

/// Rows of a matrix.
pub type Matrix = [[f64; 3]; 3];

/// Entries of a rotation below this are rounding of right angles.
const ROUNDING: f64 = 1e-15;

/// A frame in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Its origin [m].
    pub origin: [f64; 3],
    /// Its axes, as columns.
    pub turn: Matrix,
}

impl Default for Place {
    fn default() -> Self {
        Self { origin: [0.0; 3], turn: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    }
}

impl Place {
    /// Turned by roll, pitch and yaw: about the fixed axes x, y, z in this order.
    pub fn of(origin: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Self {
        let ([sr, cr], [sp, cp], [sy, cy]) = (turned(roll), turned(pitch), turned(yaw));
        let turn = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ];
        Self { origin, turn: turn.map(|row| row.map(clean)) }
    }

    /// A place that is known in this frame, in the one this frame is known in.
    pub fn then(&self, inner: &Self) -> Self {
        let turn = product(&self.turn, &inner.turn).map(|row| row.map(clean));
        Self { origin: self.point(inner.origin), turn }
    }

    /// A point likewise.
    pub fn point(&self, at: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(at);
        std::array::from_fn(|i| self.origin[i] + turned[i])
    }

    /// A direction likewise.
    pub fn direction(&self, d: [f64; 3]) -> [f64; 3] {
        self.turn.map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2])
    }

    /// A symmetric matrix of components likewise.
    pub fn tensor(&self, t: &Matrix) -> Matrix {
        let back = std::array::from_fn(|i| std::array::from_fn(|j| self.turn[j][i]));
        product(&product(&self.turn, t), &back)
    }
}

fn turned(angle: f64) -> [f64; 2] {
    [libm::sin(angle), libm::cos(angle)].map(clean)
}

fn clean(entry: f64) -> f64 {
    let near = entry.round();
    if (entry - near).abs() < ROUNDING { near + 0.0 } else { entry }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
