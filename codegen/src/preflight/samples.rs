//! Closed positions of a mechanism, found by walking along its freedoms with the drivers released.
//! In: the interpreter. Out: positions with their Jacobians. Never knows why they are wanted.

use linkwear_runtime::{AssemblyError, Description, Entry, Motion, System, assemble};
use nalgebra::{DMatrix, DVector};

/// Positions tried beyond the first: enough that a chance singular position cannot decide the rank.
const STEPS: usize = 8;
/// Length of a step along the freedoms [rad, m]: large enough to change the geometry, small enough that a few
/// Newton steps close the loops again.
const STEP: f64 = 0.12;
/// Loops count as closed below this residual [rad, m]; Newton ends near 1e-15.
const CLOSED: f64 = 1e-11;
/// Singular values below this share of the largest are zero. Rounding leaves 1e-14; a mechanism that is not
/// meant to be special has none below 1e-4.
pub const RANK_TOLERANCE: f64 = 1e-8;

/// One closed position.
#[derive(Clone, Debug)]
pub struct Position {
    /// All coordinates.
    pub q: Vec<f64>,
    /// Jacobian of all rows by all speeds, scaled so that lengths count as angles times the mechanism's size.
    pub jacobian: DMatrix<f64>,
}

/// Closed positions, the assembled start first.
pub struct ClosedPositions {
    /// Positions.
    pub positions: Vec<Position>,
    /// Assembled free coordinates at t = 0.
    pub start: Vec<f64>,
    /// Indices of driven speeds among all, in driver order.
    pub driven_speeds: Vec<usize>,
}

impl ClosedPositions {
    /// Assembles the mechanism at t = 0 and walks on from there.
    ///
    /// # Errors
    /// If Newton cannot close the loops.
    pub fn walk(
        description: &Description,
        system: &dyn System<f64>,
        parameters: &[f64],
    ) -> Result<Self, AssemblyError> {
        let state = assemble(system, description, parameters, 0.0)?;
        let layout = Layout::new(description);
        let mut prescribed = vec![0.0; system.sizes().output(Entry::Prescribed)];
        evaluate(system, Entry::Prescribed, &[parameters, &[0.0]].concat(), &mut prescribed);
        let q = layout.all_coordinates(&state.q, &prescribed);
        let walker = Walker { system, parameters, layout: &layout };
        let mut positions = vec![walker.position(q)];
        let mut generator = 0x2545_F491_4F6C_DD1D_u64;
        for step in 0..STEPS {
            // Walk out from the start in turns, so that a bad step does not end the walk.
            let from = if step % 4 == 0 { 0 } else { positions.len() - 1 };
            let next = walker.step(&positions[from], &mut generator);
            positions.extend(next);
        }
        Ok(Self { positions, start: state.q, driven_speeds: layout.driven_speeds })
    }
}

/// Evaluates an entry with a fresh workspace.
pub fn evaluate(system: &dyn System<f64>, entry: Entry, input: &[f64], output: &mut [f64]) {
    let mut workspace = vec![0.0; system.sizes().workspace];
    system.evaluate(entry, input, output, &mut workspace);
}

/// Where coordinates and speeds of each motion are, among all and among the free ones.
struct Layout {
    motions: Vec<Motion>,
    driven_speeds: Vec<usize>,
}

impl Layout {
    fn new(description: &Description) -> Self {
        let motions = description.motions.to_vec();
        let mut driven = vec![0; description.drivers.len()];
        let mut speed = 0;
        for motion in &motions {
            if let Motion::Scalar { driver: Some(driver) } = motion {
                driven[*driver] = speed;
            }
            speed += sizes(*motion).1;
        }
        Self { motions, driven_speeds: driven }
    }

    fn all_coordinates(&self, free: &[f64], prescribed: &[f64]) -> Vec<f64> {
        let mut free = free.iter();
        let mut all = Vec::new();
        for motion in &self.motions {
            match motion {
                Motion::Scalar { driver: Some(driver) } => all.push(prescribed[3 * driver]),
                other => all.extend(free.by_ref().take(sizes(*other).0)),
            }
        }
        all
    }

    /// Moves coordinates by a small speed vector, keeping quaternions unit.
    fn moved(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut moved = q.to_vec();
        let (mut at, mut speed) = (0, 0);
        for motion in &self.motions {
            let (coordinates, speeds) = sizes(*motion);
            match motion {
                Motion::Scalar { .. } => moved[at] += v[speed],
                Motion::Rotation | Motion::Pose => {
                    let turned = turn(&q[at..at + 4], &v[speed..speed + 3]);
                    moved[at..at + 4].copy_from_slice(&turned);
                    if *motion == Motion::Pose {
                        let step = rotate(&q[at..at + 4], &v[speed + 3..speed + 6]);
                        for i in 0..3 {
                            moved[at + 4 + i] += step[i];
                        }
                    }
                }
            }
            at += coordinates;
            speed += speeds;
        }
        moved
    }
}

/// Coordinates and speeds of a motion.
const fn sizes(motion: Motion) -> (usize, usize) {
    match motion {
        Motion::Scalar { .. } => (1, 1),
        Motion::Rotation => (4, 3),
        Motion::Pose => (7, 6),
    }
}

/// q ∘ exp(w / 2), normalised.
fn turn(q: &[f64], w: &[f64]) -> [f64; 4] {
    let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
    let [x, y, z] = [0.5 * w[0], 0.5 * w[1], 0.5 * w[2]];
    let product = [
        a - b * x - c * y - d * z,
        b + a * x + c * z - d * y,
        c + a * y + d * x - b * z,
        d + a * z + b * y - c * x,
    ];
    let norm = product.iter().map(|p| p * p).sum::<f64>().sqrt();
    product.map(|p| p / norm)
}

/// Rotates a vector by a unit quaternion.
fn rotate(q: &[f64], v: &[f64]) -> [f64; 3] {
    let turned = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]))
        * nalgebra::Vector3::new(v[0], v[1], v[2]);
    [turned.x, turned.y, turned.z]
}

struct Walker<'a> {
    system: &'a dyn System<f64>,
    parameters: &'a [f64],
    layout: &'a Layout,
}

impl Walker<'_> {
    /// Residuals and Jacobian of all rows.
    fn constraints(&self, q: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let sizes = self.system.sizes();
        let (n, m) = (sizes.all_speeds, sizes.all_rows);
        let zeros = vec![0.0; n];
        let input = [self.parameters, &[0.0], q, &zeros].concat();
        let mut output = vec![0.0; sizes.output(Entry::EquationsOfMotion)];
        evaluate(self.system, Entry::EquationsOfMotion, &input, &mut output);
        let first = n * (n + 1) / 2 + n;
        let phi = DVector::from_column_slice(&output[first..first + m]);
        let jacobian = DMatrix::from_row_slice(m, n, &output[first + m..first + m + m * n]);
        (phi, jacobian)
    }

    fn position(&self, q: Vec<f64>) -> Position {
        let (_, jacobian) = self.constraints(&q);
        Position { q, jacobian }
    }

    /// A step along a direction that the loops allow, then Newton back onto the closed positions.
    fn step(&self, from: &Position, generator: &mut u64) -> Option<Position> {
        let free = null_space(&from.jacobian);
        if free.ncols() == 0 {
            return None;
        }
        let weights = DVector::from_fn(free.ncols(), |_, _| random(generator));
        let direction = &free * weights;
        let norm = direction.amax();
        if norm == 0.0 {
            return None;
        }
        let scaled = direction * (STEP / norm);
        let mut q = self.layout.moved(&from.q, scaled.as_slice());
        for _ in 0..20 {
            let (phi, jacobian) = self.constraints(&q);
            if phi.iter().all(|residual| residual.abs() < CLOSED) {
                return Some(Position { q, jacobian });
            }
            let correction = least_norm(&jacobian, &-phi)?;
            q = self.layout.moved(&q, correction.as_slice());
        }
        None
    }
}

/// A number in (-1, 1) from a small generator (xorshift), so that generation is reproducible.
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Columns span the null space.
pub fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.ncols();
    if n == 0 {
        return DMatrix::zeros(0, 0);
    }
    // Padding with zero rows makes the decomposition return all right singular vectors.
    let padded = matrix.clone().resize_vertically(matrix.nrows().max(n), 0.0);
    let svd = padded.svd(false, true);
    let largest = svd.singular_values.amax();
    let v_t = svd.v_t.expect("right singular vectors were asked for");
    let rows: Vec<usize> =
        (0..n).filter(|i| svd.singular_values[*i] <= RANK_TOLERANCE * largest || largest == 0.0).collect();
    DMatrix::from_fn(n, rows.len(), |i, j| v_t[(rows[j], i)])
}

/// Shortest solution of a rank-deficient system.
fn least_norm(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    if matrix.is_empty() {
        return Some(DVector::zeros(matrix.ncols()));
    }
    let svd = matrix.clone().svd(true, true);
    let largest = svd.singular_values.amax();
    svd.solve(right, RANK_TOLERANCE * largest).ok()
}
