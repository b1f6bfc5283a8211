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
    /// Turned by a matrix whose columns are its axes.
    pub fn turned(origin: [f64; 3], turn: Matrix) -> Self {
        Self { origin, turn: turn.map(|row| row.map(clean)) }
    }

    /// Turned by roll, pitch and yaw: about the fixed axes x, y, z in this order.
    pub fn of(origin: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Self {
        let ([sr, cr], [sp, cp], [sy, cy]) = (turned(roll), turned(pitch), turned(yaw));
        let turn: Matrix = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ];
        Self::turned(origin, turn)
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

    /// Where a point of the outer frame is in this one.
    pub fn back(&self, at: [f64; 3]) -> [f64; 3] {
        let from: [f64; 3] = std::array::from_fn(|i| at[i] - self.origin[i]);
        std::array::from_fn(|j| (0..3).map(|i| self.turn[i][j] * from[i]).sum())
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

/// A rotation about an axis of length 1.
pub fn rotation([x, y, z]: [f64; 3], angle: f64) -> Matrix {
    let [s, c] = turned(angle);
    let d = 1.0 - c;
    [
        [c + d * x * x, d * x * y - s * z, d * x * z + s * y],
        [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
        [d * x * z - s * y, d * y * z + s * x, c + d * z * z],
    ]
}

/// A rotation by a quaternion of length 1, its scalar first.
pub fn of_quaternion([w, x, y, z]: [f64; 4]) -> Matrix {
    [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
}

/// The direction of a vector and its length; None of zero and of what is not finite.
pub fn direction<const N: usize>(vector: [f64; N]) -> Option<([f64; N], f64)> {
    // Scaled first, so that neither tiny nor huge components are lost when squared.
    let largest = vector.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let scaled = vector.map(|x| x / largest);
    let norm = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some((scaled.map(|x| x / norm), norm * largest))
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn turned(angle: f64) -> [f64; 2] {
    [libm::sin(angle), libm::cos(angle)].map(clean)
}

fn clean(entry: f64) -> f64 {
    let near = entry.round();
    if (entry - near).abs() < ROUNDING { near + 0.0 } else { entry }
}

/// One rotation after another: `a` turns what `b` has turned.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
