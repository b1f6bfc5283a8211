//! Constant orientations and the choice of cheap ones. Numbers only, no expressions.
//! In: directions. Out: [`Frame`]s whose entries are exact zeros and ones wherever possible.

/// Entries below this share of 1 are rounding dust of unit vectors (a few eps) and become zero.
const DUST: f64 = 1e-14;

/// A rotation matrix; columns are axes. `0[i][j]` is component i of axis j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame(pub [[f64; 3]; 3]);

impl Frame {
    /// Parallel to the outer frame.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// From three orthonormal axes.
    pub fn from_axes(x: [f64; 3], y: [f64; 3], z: [f64; 3]) -> Self {
        Self(core::array::from_fn(|i| [x[i], y[i], z[i]])).snapped()
    }

    /// Rotation about e_z.
    pub fn about_z(angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        Self([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    }

    /// A frame with e_x along `direction`; the other axes as near to the outer ones as possible.
    pub fn with_x_along(direction: [f64; 3]) -> Self {
        let x = reduce(unit(direction));
        let least = (0..3).min_by(|a, b| x[*a].abs().total_cmp(&x[*b].abs())).unwrap_or(2);
        // A direction in a coordinate plane keeps the normal of that plane as e_z or e_y.
        let mut helper = [0.0; 3];
        helper[if least == 0 { 2 } else { least }] = 1.0;
        let helper = if dot(helper, x).abs() > 0.9 { [0.0, 1.0, 0.0] } else { helper };
        let z = unit(sub(helper, scale(dot(helper, x), x)));
        Self::from_axes(x, cross(z, x), z)
    }

    /// The smallest rotation that takes unit vector `from` to unit vector `to`.
    pub fn between(from: [f64; 3], to: [f64; 3]) -> Self {
        if from == to {
            return Self::IDENTITY;
        }
        let a = Self::with_z_along(from);
        let axis = cross(from, to);
        let sine = dot(axis, axis).sqrt();
        // Opposite directions: half a turn about any axis at right angles.
        let axis = if sine < DUST { a.axis(0) } else { scale(1.0 / sine, axis) };
        let local = Self::with_z_along(axis);
        let turn = Self::about_z(f64::atan2(sine, dot(from, to)));
        local.times(&turn).times(&local.transposed()).snapped()
    }

    /// A frame with e_z along `z` and e_x as near to `x` as possible.
    pub fn with_z_and_x(z: [f64; 3], x: [f64; 3]) -> Self {
        let z = unit(z);
        let x = unit(sub(x, scale(dot(x, z), z)));
        Self::from_axes(x, cross(z, x), z)
    }

    /// A frame with e_z along `z` and the cheapest e_x.
    pub fn with_z_along(z: [f64; 3]) -> Self {
        canonical_frame(unit(z), |_| None).0
    }

    /// Components in this frame of a vector given in the outer one.
    pub fn local(&self, v: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|j| (0..3).map(|i| self.0[i][j] * v[i]).sum())
    }

    /// Axis `j` in the outer frame.
    pub fn axis(&self, j: usize) -> [f64; 3] {
        core::array::from_fn(|i| self.0[i][j])
    }

    pub fn times(&self, other: &Self) -> Self {
        Self(core::array::from_fn(|i| {
            core::array::from_fn(|j| (0..3).map(|k| self.0[i][k] * other.0[k][j]).sum())
        }))
    }

    pub fn transposed(&self) -> Self {
        Self(core::array::from_fn(|i| core::array::from_fn(|j| self.0[j][i])))
    }

    /// With rounding dust set to exact zeros and ones.
    pub fn snapped(&self) -> Self {
        Self(self.0.map(reduce))
    }

    /// The unit quaternion (scalar first, scalar part not negative) of this rotation.
    pub fn quaternion(&self) -> [f64; 4] {
        let r = &self.0;
        let squares = [
            1.0 + r[0][0] + r[1][1] + r[2][2],
            1.0 + r[0][0] - r[1][1] - r[2][2],
            1.0 - r[0][0] + r[1][1] - r[2][2],
            1.0 - r[0][0] - r[1][1] + r[2][2],
        ];
        let largest = (0..4).max_by(|a, b| squares[*a].total_cmp(&squares[*b])).unwrap_or(0);
        let d = 0.5 * squares[largest].sqrt();
        let (x, y, z) = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]);
        let (xy, xz, yz) = (r[0][1] + r[1][0], r[0][2] + r[2][0], r[1][2] + r[2][1]);
        let f = 0.25 / d;
        let q = match largest {
            0 => [d, x * f, y * f, z * f],
            1 => [x * f, d, xy * f, xz * f],
            2 => [y * f, xy * f, d, yz * f],
            _ => [z * f, xz * f, yz * f, d],
        };
        let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
        q.map(|component| snap(sign * component))
    }
}

/// A frame with e_z = `axis` (unit, in the outer frame) made of as many zeros as possible, and the angle
/// about e_z from it to the direction that `target` wants for e_x.
pub fn canonical_frame(axis: [f64; 3], target: impl Fn([f64; 3]) -> Option<[f64; 3]>) -> (Frame, f64) {
    let z = reduce(axis);
    let mut candidates = Vec::new();
    for j in 0..3 {
        let mut e = [0.0; 3];
        e[j] = 1.0;
        let across = cross(e, z);
        if dot(across, across) > 1e-4 {
            let x = reduce(unit(across));
            candidates.extend([x, scale(-1.0, x), cross(z, x), scale(-1.0, cross(z, x))]);
        }
    }
    let wanted = target(z).and_then(|direction| {
        let flat = sub(direction, scale(dot(direction, z), z));
        (dot(flat, flat) > 1e-16 * dot(direction, direction)).then(|| unit(flat))
    });
    let zeros = |x: &[f64; 3]| {
        let y = cross(z, *x);
        x.iter().chain(&y).filter(|component| component.abs() < DUST).count()
    };
    let angle_to = |x: &[f64; 3]| {
        wanted.map_or(0.0, |w| {
            let angle = f64::atan2(dot(cross(*x, w), z), dot(*x, w));
            if angle.abs() < DUST { 0.0 } else { angle }
        })
    };
    // Most zeros first; among equals the one nearest to the target, preferring parallel to an outer axis.
    let best = candidates
        .iter()
        .copied()
        .min_by(|a, b| {
            let key = |x: &[f64; 3]| (angle_to(x).abs() * 1e9).round();
            let lean = |x: &[f64; 3]| -x.iter().fold(0.0, |sum: f64, c| sum.max(*c));
            zeros(b).cmp(&zeros(a)).then(key(a).total_cmp(&key(b))).then(lean(a).total_cmp(&lean(b)))
        })
        .unwrap_or([1.0, 0.0, 0.0]);
    let frame = Frame::from_axes(best, cross(z, best), z);
    (frame, angle_to(&best))
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

pub fn scale(factor: f64, a: [f64; 3]) -> [f64; 3] {
    a.map(|x| factor * x)
}

/// Scaled to length one.
pub fn unit(a: [f64; 3]) -> [f64; 3] {
    scale(1.0 / dot(a, a).sqrt(), a)
}

/// A unit vector without rounding dust.
pub fn reduce(a: [f64; 3]) -> [f64; 3] {
    a.map(snap)
}

fn snap(x: f64) -> f64 {
    for exact in [0.0, 1.0, -1.0] {
        if (x - exact).abs() < DUST {
            return exact;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_along_y_gets_a_signed_permutation_and_no_offset() {
        let (frame, offset) = canonical_frame([0.0, 1.0, 0.0], |_| Some([1.0, 0.0, 0.0]));
        assert_eq!(offset, 0.0);
        assert_eq!(frame.axis(0), [1.0, 0.0, 0.0]);
        assert_eq!(frame.axis(2), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn quaternion_of_a_frame_rotates_like_it() {
        let frame = Frame::with_x_along([0.3, -0.4, 0.8]);
        let [w, x, y, z] = frame.quaternion();
        let first = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
        for (ours, expected) in first.into_iter().zip(frame.axis(0)) {
            // A few roundings of numbers below one.
            assert!((ours - expected).abs() < 1e-15);
        }
    }
}
