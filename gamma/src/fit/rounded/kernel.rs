//! The law of one increment between two windows. In: a process, a difference of readings. Out: chances to go from a part to a part, or
//! the slope of a density that hardly changes. Never knows what came before.

use std::ops::RangeInclusive;

use rustc_hash::FxHashMap;

use super::nodes::{Density, Nodes};
use super::window::{Even, Window};
use crate::data::{Increment, Rounding};
use crate::process::Process;

/// Change of the logarithm of the density from part to part below which its values give the chances: differences of
/// integrals would lose their digits there, and Simpson's rule has an error of some 1e-9.
const SMOOTH: f64 = 0.02;
/// Change of the logarithm of the density over all parts below which a parabola through three values has the others: the cubic
/// term is below 1e-8, as are products of bends. A fine gauge has a difference of its own for nearly every increment, which would
/// cost 33 values each, and parts by parts products.
const NEARLY_EVEN: f64 = 2e-3;

/// The law of increments: a process, with the logarithms of its parameters over exposure 1 for each.
#[derive(Clone, Copy)]
pub struct Laws<'a> {
    pub process: &'a dyn Process,
    pub logs: &'a dyn Fn(&Increment) -> [f64; 2],
}

/// What is known of one law at places of the lattice that all windows share, so that neighbouring readings need few of their own:
/// the distribution function and what it lacks to 1, and the integrals of both. And its density, once that was asked for.
#[derive(Default)]
pub(super) struct Known {
    density: Option<Option<Density>>,
    chances: [FxHashMap<u64, f64>; 2],
    integrals: [FxHashMap<u64, f64>; 2],
}

/// How chances of a law are found.
pub(super) enum By<'a> {
    /// By its integrals alone.
    Integrals,
    /// By its density, where that is smooth enough; logarithms of wear are kept for all laws.
    Densities(&'a mut FxHashMap<u64, Vec<f64>>),
}

/// Increments over one exposure whose readings differ by a number of steps.
pub(super) struct Kernel<'a> {
    pub process: &'a dyn Process,
    pub logs: [f64; 2],
    pub part: f64,
    pub parts: usize,
    /// Wear between the middles of both windows.
    pub middle: f64,
    /// The same in units of the lattice, and a part in them.
    place: f64,
    pitch: f64,
}

impl<'a> Kernel<'a> {
    pub fn new(laws: Laws<'a>, increment: &Increment, rounding: Rounding, window: &Window) -> Self {
        let steps = libm::round(increment.wear / rounding.step);
        Self::of(laws.process, (laws.logs)(increment), (steps, rounding), window)
    }

    pub fn of(
        process: &'a dyn Process,
        logs: [f64; 2],
        (steps, rounding): (f64, Rounding),
        window: &Window,
    ) -> Self {
        let Window { part, parts, ratio: [of_step, pitch], .. } = *window;
        Self { process, logs, part, parts, middle: steps * rounding.step, place: steps * of_step, pitch }
    }

    /// Equal spans have equal laws, ...
    pub fn law(&self) -> [u64; 2] {
        self.logs.map(f64::to_bits)
    }

    /// ... and equal differences of readings then equal chances.
    pub fn key(&self) -> [u64; 3] {
        [self.logs[0], self.logs[1], self.middle].map(f64::to_bits)
    }

    pub fn wear(&self, k: isize) -> f64 {
        self.middle + k as f64 * self.part
    }

    pub fn below(&self, wear: f64) -> f64 {
        if wear > 0.0 { self.process.cumulative(self.logs, 1.0, wear) } else { 0.0 }
    }

    /// Integral of the distribution function up to part `k`.
    pub fn shortfall(&self, k: isize) -> f64 {
        self.process.mean_shortfall(self.logs, self.wear(k)).unwrap_or(f64::NAN)
    }

    /// Integral of what the distribution function lacks to 1 from part `k` on.
    pub fn excess(&self, k: isize) -> f64 {
        self.process.mean_excess(self.logs, self.wear(k)).unwrap_or(f64::NAN)
    }

    pub fn ln_density(&self, k: isize) -> f64 {
        if self.wear(k) > 0.0 { self.process.ln_density(self.logs, self.wear(k)) } else { f64::NAN }
    }

    /// The density, where it hardly changes.
    pub fn even(&self) -> Option<Even> {
        self.even_within(NEARLY_EVEN)
    }

    /// The density, where it changes by less than `most` over all parts.
    pub fn even_within(&self, most: f64) -> Option<Even> {
        let last = self.parts as isize;
        let [low, middle, high] = [-last, 0, last].map(|k| self.ln_density(k));
        let reach = self.parts as f64 * self.part;
        [low, high].into_iter().all(|end| (end - middle).abs() < most).then(|| Even {
            ln: middle,
            slope: 0.5 * (high - low) / reach,
            bend: (0.5 * (high + low) - middle) / (reach * reach),
        })
    }

    /// Densities at the places of the lattice and halfway between them, up to `reach` half parts from the middle.
    fn nodes(&self, known: &mut Known, by: By<'_>, reach: usize) -> Option<Nodes> {
        let By::Densities(logarithms) = by else { return None };
        let of_law = || Density::new(self.process.density_terms(self.logs)?, self.part);
        let density = (*known.density.get_or_insert_with(of_law))?;
        let (last, half) = (2 * self.parts, 0.5 * self.part);
        let wear = |at: usize| self.middle + half * (at as f64 - last as f64);
        let ln = |wear: f64| if wear > 0.0 { libm::log(wear) } else { f64::NAN };
        let logs = logarithms
            .entry(self.middle.to_bits())
            .or_insert_with(|| (0..=2 * last).map(|at| ln(wear(at))).collect());
        let first = last - reach;
        Nodes::new(density, self.part, wear(first), &logs[first..=last + reach])
    }

    /// Chances of all differences of parts, from -(parts - 1) on.
    pub fn chances(&self, known: &mut Known, by: By<'_>) -> Vec<f64> {
        let last = self.parts as isize;
        if let Some(nodes) = self.nodes(known, by, 2 * self.parts) {
            // Of differences from `smooth` on; those below by integrals.
            let smooth = (1..2 * self.parts).find(|at| nodes.is_smooth(2 * at)).unwrap_or(2 * self.parts);
            let mut chances = match smooth {
                1 => Vec::new(),
                _ => self.by_integrals(known, -last..=smooth as isize - last),
            };
            chances.extend((smooth..2 * self.parts).map(|at| nodes.chance(2 * at)));
            return chances;
        }
        let ends = [-last, last - 1].map(|k| (self.ln_density(k + 1) - self.ln_density(k)).abs());
        if ends.into_iter().all(|change| change < SMOOTH) {
            let values: Vec<f64> = (-last..=last).map(|k| libm::exp(self.ln_density(k))).collect();
            return values
                .windows(3)
                .map(|v| self.part * (v[1] + (v[0] - 2.0 * v[1] + v[2]) / 12.0))
                .collect();
        }
        self.by_integrals(known, -last..=last)
    }

    /// Second differences of integrals between the first and the last of these parts.
    fn by_integrals(&self, known: &mut Known, parts: RangeInclusive<isize>) -> Vec<f64> {
        // The integral that is small there keeps the digits of its differences.
        let is_upper = self.excess(0) < self.shortfall(0);
        let known = &mut known.integrals[usize::from(is_upper)];
        let mut integral = |k: isize| {
            let new = || if is_upper { self.excess(k) } else { self.shortfall(k) };
            *known.entry((self.place + k as f64 * self.pitch).to_bits()).or_insert_with(new)
        };
        let values: Vec<f64> = parts.map(&mut integral).collect();
        values.windows(3).map(|v| ((v[0] - 2.0 * v[1] + v[2]) / self.part).max(0.0)).collect()
    }

    /// Masses of the parts of the next window before it is read, after wear that is known exactly.
    pub fn after_exact(&self, known: &mut Known, by: By<'_>) -> Vec<f64> {
        // Middles of parts are odd numbers of half parts from the first edge, and nodes begin one before that.
        let nodes = self.nodes(known, by, self.parts + 1);
        let smooth = |k: &usize| nodes.as_ref().is_some_and(|nodes| nodes.is_smooth(2 * k + 2));
        let first = (0..self.parts).find(smooth).unwrap_or(self.parts);
        let is_upper = first > 0 && self.below(self.middle) > 0.5;
        let known = &mut known.chances[usize::from(is_upper)];
        let mut chance = |k: usize| {
            let place = k as f64 - 0.5 * self.parts as f64;
            let wear = self.middle + place * self.part;
            let new = || match is_upper {
                true if wear > 0.0 => self.process.failure(self.logs, 1.0, wear),
                true => 1.0,
                false => self.below(wear),
            };
            *known.entry((self.place + place * self.pitch).to_bits()).or_insert_with(new)
        };
        let edges: Vec<f64> = if first == 0 { Vec::new() } else { (0..=first).map(&mut chance).collect() };
        let rest = nodes.iter().flat_map(|nodes| (first..self.parts).map(|k| nodes.mass(2 * k + 2)));
        edges.windows(2).map(|edge| (edge[1] - edge[0]).abs()).chain(rest).collect()
    }
}
