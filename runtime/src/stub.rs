//! STUB, to be deleted at merge: the simulation interface, with plain RK4 and nothing else.
#![allow(missing_docs, clippy::all)]

use std::fmt;
use std::ops::ControlFlow;

use crate::{Description, Entry, Scalar, System};

impl Scalar for f64 {
    type Mask = bool;
    fn constant(value: f64) -> Self { value }
    fn mul_add(self, f: Self, s: Self) -> Self { f64::mul_add(self, f, s) }
    fn sqrt(self) -> Self { f64::sqrt(self) }
    fn sin_cos(self) -> (Self, Self) { f64::sin_cos(self) }
    fn exp(self) -> Self { f64::exp(self) }
    fn ln(self) -> Self { f64::ln(self) }
    fn atan2(self, x: Self) -> Self { f64::atan2(self, x) }
    fn abs(self) -> Self { f64::abs(self) }
    fn max(self, o: Self) -> Self { f64::max(self, o) }
    fn lt(self, o: Self) -> bool { self < o }
    fn select(mask: bool, yes: Self, no: Self) -> Self { if mask { yes } else { no } }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    Rk4 { step: f64 },
    Dopri5 { tolerance: f64 },
    GeneralizedAlpha { step: f64, rho: f64 },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    Time(f64),
    Turns(f64),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub integrator: Integrator,
    pub span: Span,
    pub settle: f64,
    pub samples: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { integrator: Integrator::Dopri5 { tolerance: 1e-9 }, span: Span::Time(1.0), settle: 0.0, samples: 201 }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(non_snake_case)]
pub struct Statistics {
    pub steps: usize,
    pub rejected: usize,
    pub evaluations: usize,
    pub projections: usize,
    pub rank_revealing_solves: usize,
    pub max_loop_error_m: f64,
    pub max_loop_error_rad: f64,
    pub energy_error_J: f64,
    pub energy_throughput_J: f64,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    pub times: Vec<f64>,
    pub rows: Vec<Vec<f64>>,
    pub statistics: Statistics,
    pub stopped: Option<RunError>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum RunError {
    Interrupted { time: f64 },
    NoTurns,
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interrupted { time } => write!(f, "stopped at t = {time} s on request"),
            Self::NoTurns => f.write_str("no driven revolute joint"),
        }
    }
}
impl std::error::Error for RunError {}

pub fn simulate(
    system: &dyn System<f64>,
    _description: &Description,
    parameters: &[f64],
    settings: &Settings,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, RunError> {
    let sizes = system.sizes();
    let Span::Time(end) = settings.span else { return Err(RunError::NoTurns) };
    let mut workspace = vec![0.0; sizes.workspace];
    let mut start = vec![0.0; sizes.output(Entry::Start)];
    let mut input = parameters.to_vec();
    input.push(0.0);
    system.evaluate(Entry::Start, &input, &mut start, &mut workspace);
    let mut run = Run::default();
    let mut state = start;
    let per = 50;
    let h = end / (settings.samples - 1) as f64 / per as f64;
    for row in 0..settings.samples {
        let t = row as f64 * per as f64 * h;
        let mut x = parameters.to_vec();
        x.push(t);
        x.extend(&state);
        let mut fd = vec![0.0; sizes.output(Entry::ForwardDynamics)];
        system.evaluate(Entry::ForwardDynamics, &x, &mut fd, &mut workspace);
        x.push(fd[0]);
        let mut out = vec![0.0; sizes.channels];
        system.evaluate(Entry::Observe, &x, &mut out, &mut workspace);
        run.times.push(t);
        run.rows.push(out);
        if progress(row as f64 / (settings.samples - 1) as f64).is_break() {
            run.stopped = Some(RunError::Interrupted { time: t });
            return Ok(run);
        }
        for _ in 0..per {
            let mut f = |s: &[f64]| {
                let mut x = parameters.to_vec();
                x.push(t);
                x.extend(s);
                let mut fd = vec![0.0; 1];
                system.evaluate(Entry::ForwardDynamics, &x, &mut fd, &mut workspace);
                run.statistics.evaluations += 1;
                [s[1], fd[0]]
            };
            let add = |s: &[f64], k: [f64; 2], h: f64| vec![s[0] + h * k[0], s[1] + h * k[1]];
            let k1 = f(&state);
            let k2 = f(&add(&state, k1, h / 2.0));
            let k3 = f(&add(&state, k2, h / 2.0));
            let k4 = f(&add(&state, k3, h));
            state = (0..2).map(|i| state[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect();
            run.statistics.steps += 1;
        }
    }
    Ok(run)
}

pub mod record {
    use super::Run;
    use crate::Description;
    use std::io::{self, Write};

    pub fn write_csv(out: &mut impl Write, description: &Description, run: &Run) -> io::Result<()> {
        write!(out, "t [s]")?;
        for channel in description.channels.iter() {
            write!(out, ",{} [{}]", channel.name, channel.unit)?;
        }
        writeln!(out)?;
        for (t, row) in run.times.iter().zip(&run.rows) {
            write!(out, "{t}")?;
            for value in row {
                write!(out, ",{value}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

#[macro_export]
macro_rules! include_mechanism {
    ($name:literal) => {
        #[allow(dead_code, unused_imports, unused_qualifications, missing_docs, clippy::all, clippy::pedantic)]
        mod generated {
            include!(concat!(env!("OUT_DIR"), "/", $name, ".rs"));
        }
        #[allow(unused_imports)]
        pub use generated::*;
    };
}
