//! Mass matrix and forces of flexible links against an independent model: the rods as clouds of mass points on an
//! analytic displacement field, their Jacobians and accelerations by dual numbers. Nothing of the generator is used.

mod support;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Dual, Entry, Scalar, System};
use proptest::prelude::*;
use support::compile_source;

const LENGTH: f64 = 0.4;
const RADIUS: f64 = 0.005;
const DENSITY: f64 = 7850.0;
const YOUNG: f64 = 210e9;
const ZETA: f64 = 0.02;
const MODES: usize = 4;
const GRAVITY: [f64; 3] = [1.3, -9.81, 2.4];

/// A crank, a flexible coupler and a flywheel on the coupler's far end, all by revolutes: slopes of both ends count.
const FILE: &str = r#"
spec = 1
name = "bent"
gravity = ["1.3 m/s^2", "-9.81 m/s^2", "2.4 m/s^2"]

[points]
O = ["0 m", "0 m", "0 m"]
A = ["0.1 m", "0 m", "0 m"]
B = ["0.5 m", "0 m", "0 m"]
C = ["0.55 m", "0.03 m", "-0.02 m"]

[bodies]
crank = { mass = "0.3 kg", centre = "A" }
coupler = { rod = ["A", "B"], radius = "5 mm", density = "7850 kg/m^3", flexible = { modes = 4, young = "210 GPa", damping = 0.02, theory = "euler_bernoulli" } }
wheel = { mass = "0.2 kg", centre = "C" }

[joints]
R1 = { revolute = ["ground", "crank"], at = "O", axis = [0, 1, 0] }
R2 = { revolute = ["crank", "coupler"], at = "A", axis = [0, 0, 1] }
R3 = { revolute = ["coupler", "wheel"], at = "B", axis = [0, 1, 0] }
"#;

type V3<T> = [T; 3];
type M3<T> = [[T; 3]; 3];

fn constant<T: Scalar>(v: [f64; 3]) -> V3<T> {
    v.map(T::constant)
}

fn turn<T: Scalar>(m: &M3<T>, v: V3<T>) -> V3<T> {
    std::array::from_fn(|i| m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2])
}

fn product<T: Scalar>(a: &M3<T>, b: &M3<T>) -> M3<T> {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    })
}

fn transposed<T: Scalar>(m: &M3<T>) -> M3<T> {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

fn add<T: Scalar>(a: V3<T>, b: V3<T>) -> V3<T> {
    std::array::from_fn(|i| a[i] + b[i])
}

fn about<T: Scalar>(axis: usize, angle: T) -> M3<T> {
    let (s, c) = angle.sin_cos();
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    match axis {
        1 => [[c, zero, s], [zero, one, zero], [-s, zero, c]],
        _ => [[c, -s, zero], [s, c, zero], [zero, zero, one]],
    }
}

/// The rotation of the Gibbs vector theta / 2, docs/notation.md.
fn gibbs<T: Scalar>(theta: V3<T>) -> M3<T> {
    let g = theta.map(|x| x * T::constant(0.5));
    let zero = T::constant(0.0);
    let skew = [[zero, -g[2], g[1]], [g[2], zero, -g[0]], [-g[1], g[0], zero]];
    let square = product(&skew, &skew);
    let tau = T::constant(2.0) / (T::constant(1.0) + g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let unit = T::constant(f64::from(u8::from(i == j)));
            unit + tau * (skew[i][j] + square[i][j])
        })
    })
}

/// Deflection along y and z and the slopes there; modes y1, z1, y2, z2 of a pinned Euler-Bernoulli rod.
fn field<T: Scalar>(x: f64, eta: &[T]) -> (V3<T>, V3<T>) {
    let mass = DENSITY * std::f64::consts::PI * RADIUS * RADIUS * LENGTH;
    let size = (2.0 / mass).sqrt();
    let mut moved = constant([0.0; 3]);
    let mut turned: V3<T> = constant([0.0; 3]);
    for (mode, eta) in eta.iter().enumerate() {
        let wave = (mode / 2 + 1) as f64 * std::f64::consts::PI / LENGTH;
        let (shape, slope) = (size * (wave * x).sin(), size * wave * (wave * x).cos());
        if mode % 2 == 0 {
            moved[1] = moved[1] + T::constant(shape) * *eta;
            turned[2] = turned[2] + T::constant(slope) * *eta;
        } else {
            moved[2] = moved[2] + T::constant(shape) * *eta;
            turned[1] = turned[1] - T::constant(slope) * *eta;
        }
    }
    (moved, turned)
}

/// Gauss-Legendre points and weights on (0, 1), by Newton on the Legendre polynomial.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    (0..count)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..50 {
                let (mut before, mut now) = (1.0, x);
                for k in 2..=count {
                    let k = k as f64;
                    (before, now) = (now, ((2.0 * k - 1.0) * x * now - (k - 1.0) * before) / k);
                }
                slope = n * (x * now - before) / (x * x - 1.0);
                x -= now / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// What a mass point belongs to.
#[derive(Clone, Copy)]
enum Body {
    Crank,
    /// Place along the rod and in its section.
    Coupler(f64, [f64; 2]),
    Wheel,
}

/// Position of a mass point for q = (R1, R2, eta 1..4, R3).
fn position<T: Scalar>(body: Body, q: &[T]) -> V3<T> {
    let crank = about(1, q[0]);
    let tip = turn(&crank, constant([0.1, 0.0, 0.0]));
    let eta = &q[2..2 + MODES];
    // The joint turns the section at A; the floating frame differs from it by the slope there.
    let section = product(&crank, &about(2, q[1]));
    let floating = product(&section, &transposed(&gibbs(field(0.0, eta).1)));
    match body {
        Body::Crank => tip,
        Body::Coupler(x, [y, z]) => {
            let (moved, _) = field(x, eta);
            add(tip, turn(&floating, add(constant([x, y, z]), moved)))
        }
        Body::Wheel => {
            let (moved, turned) = field(LENGTH, eta);
            let end = add(tip, turn(&floating, add(constant([LENGTH, 0.0, 0.0]), moved)));
            let wheel = product(&product(&floating, &gibbs(turned)), &about(1, q[2 + MODES]));
            add(end, turn(&wheel, constant([0.05, 0.03, -0.02])))
        }
    }
}

fn cloud() -> Vec<(Body, f64)> {
    let mut points = vec![(Body::Crank, 0.3), (Body::Wheel, 0.2)];
    let mass = DENSITY * std::f64::consts::PI * RADIUS * RADIUS * LENGTH;
    // Four points at r / sqrt(2) have the second moment of a full circle.
    let off = RADIUS * 0.5_f64.sqrt();
    for (x, weight) in gauss(20) {
        for place in [[off, 0.0], [-off, 0.0], [0.0, off], [0.0, -off]] {
            points.push((Body::Coupler(x * LENGTH, place), 0.25 * weight * mass));
        }
    }
    points
}

/// M and h of the cloud.
fn independent(q: &[f64], v: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    type Twice = Dual<Dual<f64>>;
    let n = q.len();
    let (mut mass, mut force) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for (body, weight) in cloud() {
        let columns: Vec<[f64; 3]> = (0..n)
            .map(|j| {
                let lifted: Vec<Dual<f64>> =
                    (0..n).map(|i| Dual::new(q[i], f64::from(u8::from(i == j)))).collect();
                position(body, &lifted).map(|x| x.derivative)
            })
            .collect();
        // Second derivative along q + v t: the acceleration for v̇ = 0.
        let lifted: Vec<Twice> =
            (0..n).map(|i| Dual::new(Dual::new(q[i], v[i]), Dual::new(v[i], 0.0))).collect();
        let bias = position(body, &lifted).map(|x| x.derivative.derivative);
        for i in 0..n {
            for j in 0..n {
                mass[i][j] += weight * (0..3).map(|k| columns[i][k] * columns[j][k]).sum::<f64>();
            }
            force[i] += weight * (0..3).map(|k| columns[i][k] * (bias[k] - GRAVITY[k])).sum::<f64>();
        }
    }
    let second = std::f64::consts::PI * RADIUS.powi(4) / 4.0;
    let line = DENSITY * std::f64::consts::PI * RADIUS * RADIUS;
    for mode in 0..MODES {
        let wave = (mode / 2 + 1) as f64 * std::f64::consts::PI / LENGTH;
        let omega = wave * wave * (YOUNG * second / line).sqrt();
        force[2 + mode] += omega * omega * q[2 + mode] + 2.0 * ZETA * omega * v[2 + mode];
    }
    (mass, force)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mass_matrix_and_forces_are_those_of_a_cloud_of_mass_points(
        angles in prop::array::uniform3(-3.0_f64..3.0),
        // Up to 15 mm of deflection: far beyond what a link does, so that every product shows.
        eta in prop::array::uniform4(-0.005_f64..0.005),
        speeds in prop::array::uniform3(-20.0_f64..20.0),
        eta_speeds in prop::array::uniform4(-2.0_f64..2.0),
    ) {
        let source = SourceFile { name: "bent.toml".into(), text: FILE.into() };
        let compiled = compile_source(&source, &[], None);
        let system = compiled.interpreter();
        let sizes = System::<f64>::sizes(&system);
        let state = |ends: [f64; 3], modes: [f64; 4]| [&ends[..2], &modes, &ends[2..]].concat();
        let (q, v) = (state(angles, eta), state(speeds, eta_speeds));
        let input = [&[0.0][..], &q, &v].concat();
        let mut output = vec![0.0; sizes.output(Entry::EquationsOfMotion)];
        let mut workspace = vec![0.0; sizes.workspace];
        system.evaluate(Entry::EquationsOfMotion, &input, &mut output, &mut workspace);
        let n = q.len();
        let (mass, force) = independent(&q, &v);
        let mut entries = output.iter();
        for i in 0..n {
            for j in i..n {
                let ours = entries.next().unwrap();
                let size = (mass[i][i] * mass[j][j]).sqrt();
                // Shapes from finite elements are good to 1e-11.
                prop_assert!((ours - mass[i][j]).abs() < 1e-9 * size, "M{i}{j}: {ours} not {}", mass[i][j]);
            }
        }
        let largest = force.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for (i, (ours, theirs)) in entries.zip(&force).enumerate() {
            prop_assert!((ours - theirs).abs() < 1e-9 * largest, "h{i}: {ours} not {theirs}");
        }
        // Positive definite: Cholesky finds only positive pivots.
        let mut left = mass;
        for k in 0..n {
            prop_assert!(left[k][k] > 0.0);
            for i in k + 1..n {
                let factor = left[i][k] / left[k][k];
                let pivot = left[k].clone();
                left[i].iter_mut().zip(&pivot).for_each(|(entry, above)| *entry -= factor * above);
            }
        }
    }
}

/// Weight at rest is the gradient of the potential that the cloud has; well-known code forgets its torque.
#[test]
fn weight_on_the_deformed_link_is_the_gradient_of_its_potential() {
    let source = SourceFile { name: "bent.toml".into(), text: FILE.into() };
    let compiled = compile_source(&source, &[], None);
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    let q = [0.7, -1.1, 0.004, -0.003, 0.002, 0.001, 2.2];
    let n = q.len();
    let input = [&[0.0][..], &q, &vec![0.0; n]].concat();
    let mut output = vec![0.0; sizes.output(Entry::EquationsOfMotion)];
    let mut workspace = vec![0.0; sizes.workspace];
    system.evaluate(Entry::EquationsOfMotion, &input, &mut output, &mut workspace);
    let ours = &output[n * (n + 1) / 2..n * (n + 1) / 2 + n];
    for j in 0..n {
        let lifted: Vec<Dual<f64>> = (0..n).map(|i| Dual::new(q[i], f64::from(u8::from(i == j)))).collect();
        let weight: f64 = cloud()
            .into_iter()
            .map(|(body, mass)| {
                let place = position(body, &lifted);
                -mass * (0..3).map(|k| GRAVITY[k] * place[k].derivative).sum::<f64>()
            })
            .sum();
        let (_, still) = independent(&q, &[0.0; 7]);
        let elastic = still[j] - weight;
        // Of the elastic force in the same row, or of the weight.
        let size = ours[j].abs().max(1.0);
        assert!((ours[j] - elastic - weight).abs() < 1e-10 * size, "row {j}");
        // The potential of the generated code has the same gradient.
        let state: Vec<Dual<f64>> = std::iter::once(Dual::new(0.0, 0.0))
            .chain(lifted)
            .chain((0..n).map(|_| Dual::new(0.0, 0.0)))
            .collect();
        let mut energy = vec![Dual::new(0.0, 0.0); 2];
        let mut workspace = vec![Dual::new(0.0, 0.0); sizes.workspace];
        system.evaluate(Entry::Energy, &state, &mut energy, &mut workspace);
        assert!((energy[1].derivative - ours[j]).abs() < 1e-10 * size, "row {j}");
    }
}
