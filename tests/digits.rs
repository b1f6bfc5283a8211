//! How many digits rounding costs: forward dynamics in double precision against the same operations in arithmetic of 31 digits.

mod truth;

use std::ops::{Add, Div, Mul, Neg, Sub};
use std::path::Path;

use linkwear_codegen::compile::{Compiled, Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{CONTACT_WRENCH, Entry, Scalar, System, assemble};
use nalgebra::DMatrix;
use truth::reached;
use twofloat::TwoFloat;

/// A number of two doubles, 31 digits.
#[derive(Clone, Copy)]
struct Wide(TwoFloat);

impl Add for Wide {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Wide {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Wide {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for Wide {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for Wide {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Scalar for Wide {
    type Mask = bool;

    fn constant(value: f64) -> Self {
        Self(TwoFloat::from(value))
    }

    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// The series of a thousandth of the angle, doubled ten times; angles here are of a few turns.
    fn sin_cos(self) -> (Self, Self) {
        let angle = self / Self::constant(1024.0);
        let square = angle * angle;
        let term = |at: i32, sum: Self| {
            Self::constant(1.0) - square / Self::constant(f64::from(at * (at + 1))) * sum
        };
        // The last terms are below 1e-36.
        let one = Self::constant(1.0);
        let [mut sine, mut cosine] =
            [2, 1].map(|first| (0..7).rev().fold(one, |sum, k| term(first + 2 * k, sum)));
        sine = sine * angle;
        for _ in 0..10 {
            (sine, cosine) = (Self::constant(2.0) * sine * cosine, cosine * cosine - sine * sine);
        }
        (sine, cosine)
    }

    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    fn ln(self) -> Self {
        Self(self.0.ln())
    }

    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn max(self, other: Self) -> Self {
        if self.0 > other.0 { self } else { other }
    }

    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

/// A small generator (xorshift), so that states repeat: numbers between -1 and 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn compiled(name: &str) -> Compiled {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms").join(format!("{name}.toml"));
    let source = SourceFile { name: name.to_owned(), text: std::fs::read_to_string(path).expect("a file") };
    compile(&source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn answer<T: Scalar>(system: &impl System<T>, entry: Entry, input: &[f64]) -> Vec<T> {
    let sizes = system.sizes();
    let zero = T::constant(0.0);
    let (mut output, mut workspace) = (vec![zero; sizes.output(entry)], vec![zero; sizes.workspace]);
    let input: Vec<T> = input.iter().map(|value| T::constant(*value)).collect();
    system.evaluate(entry, &input, &mut output, &mut workspace);
    output
}

/// Of the loop Jacobian, whose last columns of the closures' answer it is.
fn condition(closure: &[f64], rows: usize, speeds: usize) -> f64 {
    if rows == 0 {
        return 1.0;
    }
    let jacobian = DMatrix::from_row_slice(rows, speeds, &closure[closure.len() - rows * speeds..]);
    let values = jacobian.singular_values();
    values.max() / values.min()
}

/// Largest error of accelerations, multipliers and drive forces, beside the largest number of the answer, over 20 states whose
/// loops are well conditioned; and how many such states there were.
fn worst(compiled: &Compiled) -> (f64, usize) {
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    let parameters = compiled.parameters();
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let (mut worst, mut states) = (0.0_f64, 0);
    for at in 0..200 {
        if states == 20 {
            break;
        }
        let t = 0.0137 * f64::from(at);
        let Ok(mut state) = assemble(&system, compiled.description(), &parameters, t) else { continue };
        // Beside closed positions, what is lost to rounding is the same. What nothing drives is set in motion.
        let push = if sizes.drivers == 0 { 1.0 } else { 1e-3 };
        state.q.iter_mut().for_each(|place| *place += 1e-3 * random.next());
        state.v.iter_mut().for_each(|speed| *speed += push * random.next());
        let wrenches = (0..CONTACT_WRENCH * sizes.contacts).map(|_| 10.0 * random.next());
        let base = [parameters.as_slice(), &[t], &state.q, &state.v].concat();
        let closure = answer::<f64>(&system, Entry::Closure, &base);
        if condition(&closure, sizes.rows, sizes.speeds) > 1e6 {
            continue;
        }
        states += 1;
        let input: Vec<f64> = base.into_iter().chain(wrenches).collect();
        let found = answer::<f64>(&system, Entry::ForwardDynamics, &input);
        let exact = answer::<Wide>(&system, Entry::ForwardDynamics, &input);
        let asked = sizes.speeds + sizes.rows + sizes.drivers;
        let (found, exact) = (&found[..asked], &exact[..asked]);
        let size = found.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        let off = |(x, y): (&f64, &Wide)| f64::from(y.0 - *x).abs() / size;
        worst =
            found.iter().zip(exact).map(off).fold(worst, |worst, off| if off <= worst { worst } else { off });
    }
    (worst, states)
}

#[test]
fn sine_and_cosine_have_far_more_digits_than_a_double() {
    for at in 1..40 {
        let (sine, cosine) = Wide::constant(0.17 * f64::from(at)).sin_cos();
        let one = sine * sine + cosine * cosine - Wide::constant(1.0);
        // Roundings of 1e-32, grown by a thousand and a few thousand operations; a double has 1e-16.
        assert!(f64::from(one.0).abs() < 1e-24, "{at}: {:e}", f64::from(one.0));
    }
}

#[test]
fn forward_dynamics_loses_few_digits() {
    for name in [
        "andrews",
        "bennett",
        "bricard",
        "flyball",
        "four_bar",
        "n_four_bar_2",
        "pendulum",
        "rssr",
        "rssr_ball_wear",
        "rssr_flexible",
        "rssr_rigid",
        "six_bar",
        "slider_crank",
        "slider_crank_clearance",
        "spatial_slider_crank",
    ] {
        let (error, states) = worst(&compiled(name));
        assert_eq!(states, 20, "{name}");
        // A condition of 1e4 on roundings of 1e-16.
        reached(
            &format!("{name}, rounding"),
            "forward dynamics beside 31 digits, of the largest",
            error,
            1e-12,
        );
    }
}
