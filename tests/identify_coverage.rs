//! Whether 95 % intervals of `identify` hold the truth in 95 % of simulated measurements: a smooth mechanism by its drive torque, a
//! joint with clearance by the torque of a start, wear by inspections. The table of docs/identification.md is that of the long runs:
//! `cargo test --release --test identify_coverage -- --ignored --nocapture`.

use std::path::Path;
use std::sync::OnceLock;
use std::thread::{available_parallelism, scope};

use linkwear::backend::Backend;
use linkwear::codegen::Options;
use linkwear::identify::{
    Curve, CurveColumn, Free, Group, IdentifySettings, Inspections, Machine, Model, ModelFault, Readings,
    State, WearPath, identify,
};
use linkwear::mechanism::read_source;
use linkwear::runtime::{Integrator, RevolutionSettings, Span, Watch};
use linkwear::study::{Axis, Cases, Points};
use linkwear_gamma::special::normal_quantile;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// What is sought in which measurements.
struct Case {
    file: &'static str,
    free: &'static [&'static str],
    truth: &'static [f64],
    /// A column, its noise, times [s] from 0 to the last, and how many; none: inspections.
    curve: Option<(&'static str, f64, f64, usize)>,
}

const SMOOTH: Case = Case {
    file: "examples/data/rocker_drive.toml",
    free: &["c_rocker=0.005..0.5 N m s/rad", "m_load=0.1 kg..2 kg"],
    truth: &[0.05, 0.5],
    curve: Some(("R1.drive", 0.05, 1.0, 81)),
};
/// The start of a weight on a loose pin: the pin rolls and slides in the bush.
const LOOSE: Case = Case {
    file: "examples/data/worn_bush.toml",
    free: &["c0=10 um..250 um", "d_pin=0.001..0.1 N m s/rad"],
    truth: &[50.0, 0.01],
    curve: Some(("R1.drive", 0.005, 0.2, 41)),
};
const WORN: Case = Case {
    file: "examples/data/worn_bush.toml",
    free: &["k_wear=1e-8..1e-6", "c0=10 um..250 um"],
    truth: &[2e-7, 50.0],
    curve: None,
};
/// Standard error of the gauge of inspections [m].
const GAUGE: f64 = 2e-6;

fn axes(case: &Case) -> Vec<Axis> {
    case.free.iter().map(|text| Axis::parse(text).expect("an axis")).collect()
}

fn frees(case: &Case) -> Vec<Free> {
    axes(case).iter().map(|axis| Free::new(axis).expect("a range")).collect()
}

fn cases(case: &Case) -> Cases {
    let points = Points::sobol(axes(case), 1, 1).expect("points");
    let source = read_source(Path::new(case.file)).expect("the file");
    Cases::new(&source, &Options::default(), Backend::Auto, ("--free", &points)).expect("a mechanism")
}

fn curve(case: &Case) -> Option<Curve> {
    let (name, noise, last, count) = case.curve?;
    let times: Vec<f64> = (0..count).map(|at| last * at as f64 / (count - 1) as f64).collect();
    // Noise is estimated: the level serves the simulation alone. Readings are of the truth, which is not yet known.
    let values = times.iter().map(|t| t * noise).collect();
    let integrator = if case.file.contains("bush") {
        Integrator::Rk43 { tolerance: 1e-6, max_step: None }
    } else {
        Integrator::Dopri5 { tolerance: 1e-9, max_step: None }
    };
    let column = CurveColumn { name: name.to_owned(), values, noise: None };
    Some(Curve { times, columns: vec![column], settle: Span::Time(0.0), integrator })
}

fn inspections() -> Inspections {
    let at: Vec<f64> = (1..=15).map(|at| 1e5 * f64::from(at)).collect();
    let wear = at.iter().map(|at| 1.3e-10 * at).collect();
    Inspections { joint: "R2".to_owned(), at, by_time: false, wear, gauge: None }
}

/// Paths of wear at clearances that are apart by equal factors, and cubics between them: a life for each prediction would take days.
/// `paths_between_paths_are_right` holds them against lives.
struct Paths {
    ln_first: f64,
    step: f64,
    all: Vec<WearPath>,
}

/// Paths from one bound of the clearance to the other.
const PATHS: usize = 33;

fn live(c0: f64) -> WearPath {
    let case = Case { free: &["c0=1 um..1 mm"], ..WORN };
    let mut options = Options::default();
    options.overrides.push(("c0".to_owned(), format!("{c0} um")));
    let source = read_source(Path::new(case.file)).expect("the file");
    let mechanism = linkwear::mechanism::Mechanism::compile(&source, &options, Backend::Auto);
    let settings = RevolutionSettings::default();
    WearPath::live(&mechanism.expect("a mechanism"), &[inspections()], settings, Watch::NONE).expect("a life")
}

impl Paths {
    /// The same for all who ask.
    fn known() -> &'static Self {
        static PATHS: OnceLock<Paths> = OnceLock::new();
        PATHS.get_or_init(Self::live)
    }

    fn live() -> Self {
        let (first, last) = (10.0_f64.ln(), 250.0_f64.ln());
        let step = (last - first) / (PATHS - 1) as f64;
        let all = (0..PATHS).map(|at| live((first + step * at as f64).exp())).collect();
        Self { ln_first: first, step, all }
    }
}

impl Model for Paths {
    fn predict(&self, values: &[f64], _: Watch<'_>) -> Result<Vec<f64>, ModelFault> {
        let x = (values[1].ln() - self.ln_first) / self.step;
        let at = (x.floor() as usize).clamp(1, PATHS - 3);
        let s = x - at as f64;
        // Lagrange's cubic through four paths.
        let weights = [
            -s * (s - 1.0) * (s - 2.0) / 6.0,
            (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0,
            -(s + 1.0) * s * (s - 2.0) / 2.0,
            (s + 1.0) * s * (s - 1.0) / 6.0,
        ];
        let mut sum = vec![0.0; inspections().at.len()];
        for (path, weight) in self.all[at - 1..].iter().zip(weights) {
            for (sum, wear) in sum.iter_mut().zip(path.at(&inspections(), values[0])?) {
                *sum += weight * wear.ln();
            }
        }
        Ok(sum.into_iter().map(f64::exp).collect())
    }
}

fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
    (0..count).map(|_| normal_quantile(uniform())).collect()
}

/// Of each parameter: intervals that hold the truth, and estimates.
fn held(case: &Case, seeds: std::ops::Range<u64>) -> Vec<(u64, u64)> {
    let paths = case.curve.is_none().then(Paths::known);
    let threads = available_parallelism().map_or(1, |count| count.get() as u64);
    let count_of = |thread: u64| {
        let (cases, frees) = (cases(case), frees(case));
        let places = (curve(case), case.curve.map_or_else(|| vec![inspections()], |_| Vec::new()));
        let machine = Machine::new(&cases, &frees, places, RevolutionSettings::default());
        let model: &dyn Model = paths.map_or(&machine, |paths| paths);
        let clean = model.predict(case.truth, Watch::NONE).expect("a run");
        let group = machine.readings().expect("readings").groups()[0].clone();
        let level = case.curve.map_or(GAUGE, |(_, level, ..)| level);
        let settings =
            IdentifySettings { starts: 2, begin: Some(case.truth.to_vec()), ..IdentifySettings::default() };
        let mut held = vec![(0, 0); frees.len()];
        for seed in seeds.clone().filter(|seed| seed % threads == thread) {
            let noisy = clean.iter().zip(noise(clean.len(), seed)).map(|(value, e)| value + level * e);
            let group = Group { values: noisy.collect(), ..group.clone() };
            let readings = Readings::new(vec![group]).expect("readings");
            let found = identify(&frees, &readings, model, &settings, Watch::NONE).expect("a fit");
            for ((count, one), truth) in held.iter_mut().zip(&found.parameters).zip(case.truth) {
                let [lower, upper] = one.interval;
                // An end beyond a bound holds all on its side.
                let holds = lower.is_none_or(|end| end <= *truth) && upper.is_none_or(|end| *truth <= end);
                let is_estimated = one.state == State::Estimated;
                *count = (count.0 + u64::from(holds && is_estimated), count.1 + u64::from(is_estimated));
            }
        }
        held
    };
    let all: Vec<Vec<(u64, u64)>> = scope(|scope| {
        let work: Vec<_> = (0..threads).map(|thread| scope.spawn(move || count_of(thread))).collect();
        work.into_iter().map(|thread| thread.join().expect("no panic")).collect()
    });
    let sum = |at: usize| all.iter().map(|one| one[at]).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
    (0..case.truth.len()).map(sum).collect()
}

/// Runs after which a long study says what it has counted so far, so that one that is broken off has counted something.
const AT_ONCE: u64 = 100;

fn told(case: &Case, runs: u64) -> Vec<(u64, u64)> {
    let mut all = vec![(0, 0); case.truth.len()];
    let mut done = 0;
    while done < runs {
        let next = (done + AT_ONCE).min(runs);
        for (sum, more) in all.iter_mut().zip(held(case, done..next)) {
            *sum = (sum.0 + more.0, sum.1 + more.1);
        }
        done = next;
        for (name, (held, of)) in case.free.iter().zip(&all) {
            println!("{name}: {held} of {of} intervals hold the truth, {done} runs, {}", case.file);
        }
    }
    all
}

/// Of few runs: not below four standard deviations of 95 %.
fn holds_in_few(case: &Case, runs: u64) {
    for (held, of) in told(case, runs) {
        let expected = 0.95 * runs as f64;
        let least = expected - 4.0 * (0.05 * expected).sqrt();
        assert!(of == runs && held as f64 >= least, "{held} of {of}");
    }
}

/// Of many: 95 +- 3 %.
fn holds_in_many(case: &Case) {
    for (held, of) in told(case, 1000) {
        let part = held as f64 / of as f64;
        assert!(of > 990 && (part - 0.95).abs() <= 0.03, "{held} of {of}");
    }
}

#[test]
fn a_damper_and_a_load_lie_in_their_intervals() {
    holds_in_few(&SMOOTH, 24);
}

#[test]
fn paths_between_paths_are_right_and_wear_lies_in_its_intervals() {
    let paths = Paths::known();
    for c0 in [11.0, 33.3, 47.0, 111.0, 222.0] {
        let right = live(c0).at(&inspections(), 2e-7).expect("wear");
        let found = paths.predict(&[2e-7, c0], Watch::NONE).expect("wear");
        let apart = right.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Below a quarter of the gauge's error: tables are known to a few thousandths of the wear.
        assert!(apart < 0.25 * GAUGE, "c0 {c0} um: {apart:e} m");
    }
    holds_in_few(&WORN, 24);
}

#[test]
fn a_clearance_lies_in_its_interval() {
    holds_in_few(&LOOSE, 12);
}

#[test]
#[ignore = "minutes"]
fn a_damper_and_a_load_lie_in_their_intervals_as_often_as_they_say() {
    holds_in_many(&SMOOTH);
}

#[test]
#[ignore = "ten minutes"]
fn a_clearance_lies_in_its_interval_as_often_as_it_says() {
    holds_in_many(&LOOSE);
}

#[test]
#[ignore = "minutes"]
fn wear_and_clearance_lie_in_their_intervals_as_often_as_they_say() {
    holds_in_many(&WORN);
}
