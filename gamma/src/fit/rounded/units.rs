//! Rounded readings of units that differ. In: the law of the units' own parameter, readings. Out: the log-likelihood, and transforms
//! for the goodness of fit. Never knows how it is maximised.
//!
//! The readings of a unit are a chain given its parameter; their likelihood is the mean of the chain's over the law of the parameter.
//! That is a sum over places of the law that are evenly apart, the same for all units, so that units share their chains' laws. The
//! trapezoid rule errs by exp(-2 pi^2 / spacing^2), in standard deviations of what a unit's readings leave of its parameter.

use std::cell::Cell;
use std::collections::VecDeque;
use std::ops::Range;

use rand::RngExt;
use rand::distr::Open01;

use super::chain::Chain;
use super::kernel::Laws;
use crate::data::{Increment, Rounding};
use crate::fit::model::{Model, units};
use crate::process::RandomEffect;
use crate::random::Stream;

/// Places are so far apart, in standard deviations of the narrowest law after readings: an error of 1e-12 for a normal law.
const SPACING: f64 = 0.85;
/// ... and in the logarithm of the parameter, where few readings leave a skew law: 1e-10 of an exponential one.
const WIDEST: f64 = 0.4;
/// ln below the largest term at which the sum ends: what is left out is 1e-9 of it, and second differences over 2e-3 have three digits.
const DEPTH: f64 = 20.0;
/// Places on either side of the largest at most; 10 are usual.
const MOST: usize = 2000;
/// Places that a unit has, about: what the likelihood costs beside that of units which are alike.
const USUAL: usize = 20;

/// Units that differ, at parameters `phi`.
pub struct Differing<'a> {
    model: &'a Model,
    effect: &'static dyn RandomEffect,
    phi: &'a [f64],
    cv: f64,
    chain: Chain,
    /// From place to place, in those of the law.
    spacing: f64,
}

/// Places of one unit's parameter with their ln terms, from a first one on.
struct Terms {
    first: i64,
    ln: VecDeque<f64>,
    top: f64,
}

impl<'a> Differing<'a> {
    /// How many times a likelihood costs that of units which are alike.
    pub const COST: usize = USUAL;

    /// None for a process whose units do not differ.
    pub fn new(
        model: &'a Model,
        phi: &'a [f64],
        increments: &[Increment],
        rounding: Rounding,
    ) -> Option<Self> {
        let effect = model.process.random_effect()?;
        let cv = libm::exp(phi[phi.len() - 1]);
        let mut own = Self { model, effect, phi, cv, chain: Chain::of_many_laws(rounding), spacing: 0.0 };
        let left = |unit: &[Increment]| own.after(unit, rounding).map_or(cv, |(_, cv)| cv);
        let narrowest = units(increments).map(left).fold(cv, f64::min);
        own.spacing = (SPACING * narrowest).min(WIDEST) / cv;
        Some(own)
    }

    /// Log-likelihood, per unit of wear.
    pub fn ln_likelihood(&mut self, increments: &[Increment], rounding: Rounding) -> f64 {
        units(increments)
            .map(|unit| {
                let Terms { ln, top, .. } = self.terms(unit, rounding);
                let sum: f64 = ln.into_iter().map(|term| libm::exp(term - top)).sum();
                top + libm::log(self.spacing * sum)
            })
            .sum()
    }

    /// Probability integral transforms of the readings, each given those of its unit before it, spread evenly over its step.
    pub fn transforms(
        &mut self,
        increments: &[Increment],
        rounding: Rounding,
        stream: &mut Stream,
    ) -> Vec<f64> {
        let mut transforms = Vec::with_capacity(increments.len());
        for unit in units(increments) {
            let mut places: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
            for at in self.all_places(unit, rounding) {
                let mut seen = Vec::with_capacity(unit.len());
                let density = self.follow(at, unit, &mut |chance, below| seen.push([chance, below()]));
                places.push((libm::exp(density), seen));
            }
            for at in 0..unit.len() {
                let all: f64 = places.iter().map(|(weight, _)| weight).sum();
                let spread: f64 = stream.sample(Open01);
                let below: f64 =
                    places.iter().map(|(weight, seen)| weight * (seen[at][1] + spread * seen[at][0])).sum();
                transforms.push(below / all);
                // Scaled, so that long histories do not leave the range of numbers.
                places.iter_mut().for_each(|(weight, seen)| *weight *= seen[at][0] / all);
            }
        }
        transforms
    }

    /// The law of a unit's parameter after its readings as if they were exact: where the sum is looked for.
    fn after(&self, unit: &[Increment], rounding: Rounding) -> Option<([f64; 2], f64)> {
        let seen = self.model.seen(self.phi, unit);
        let own = self.model.sized(self.phi, seen.ln_size);
        self.effect.after(own, self.cv, seen.exposure, seen.wear.max(0.5 * rounding.step))
    }

    /// All terms that count, uphill from where exact readings would have the largest.
    fn terms(&mut self, unit: &[Increment], rounding: Rounding) -> Terms {
        let seen = self.model.seen(self.phi, unit);
        let own = self.model.sized(self.phi, seen.ln_size);
        let place =
            self.after(unit, rounding).map_or(0.0, |(logs, _)| self.effect.place_of(own, self.cv, logs));
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let mut at = libm::round(place / self.spacing) as i64;
        let mut term = |at: i64| self.term(at, unit);
        let (mut top, mut down, mut up) = (term(at), term(at - 1), term(at + 1));
        for _ in 0..MOST {
            if up > top {
                (at, down, top, up) = (at + 1, top, up, term(at + 2));
            } else if down > top {
                (at, down, top, up) = (at - 1, term(at - 2), down, top);
            } else {
                break;
            }
        }
        let mut terms = Terms { first: at - 1, ln: VecDeque::from([down, top, up]), top };
        for _ in 0..MOST {
            if terms.ln.front().is_none_or(|ln| *ln > top - DEPTH) {
                terms.first -= 1;
                terms.ln.push_front(term(terms.first));
            } else {
                break;
            }
        }
        for _ in 0..MOST {
            if terms.ln.back().is_none_or(|ln| *ln > top - DEPTH) {
                let next = terms.first + terms.ln.len() as i64;
                terms.ln.push_back(term(next));
            } else {
                break;
            }
        }
        terms
    }

    /// Places that count before any reading or after all.
    fn all_places(&mut self, unit: &[Increment], rounding: Rounding) -> Range<i64> {
        let Terms { first, ln, .. } = self.terms(unit, rounding);
        let (mut from, mut to) = (first, first + ln.len() as i64);
        let middle = [self.phi[0], self.phi[1]];
        let density =
            |at: i64| self.effect.place(middle, self.cv, self.spacing * at as f64).map(|(_, ln)| ln);
        let counts = |at: i64| density(at).is_some_and(|ln| ln > -DEPTH);
        // The law itself has its top at about 0.
        for _ in 0..MOST {
            from -= i64::from(from > 0 || counts(from));
            to += i64::from(to < 0 || counts(to));
        }
        from..to
    }

    /// ln of density times likelihood at a place.
    fn term(&mut self, at: i64, unit: &[Increment]) -> f64 {
        let (mut sum, step) = (0.0, self.chain.step());
        let density = self.follow(at, unit, &mut |chance, _| sum += libm::log(chance / step));
        density + sum
    }

    /// Along a unit whose parameter is at a place; ln of the density of that.
    fn follow(&mut self, at: i64, unit: &[Increment], seen: &mut dyn FnMut(f64, &dyn Fn() -> f64)) -> f64 {
        let place = self.spacing * at as f64;
        let Self { model, effect, phi, cv, chain, .. } = self;
        let placed = |logs: [f64; 2]| effect.place(logs, *cv, place).unwrap_or(([f64::NAN; 2], f64::NAN));
        // Neighbouring increments mostly have one law.
        let last = Cell::new(([f64::NAN; 2], [f64::NAN; 2]));
        let logs = |one: &Increment| {
            let own = model.logs(phi, one);
            if last.get().0 != own {
                last.set((own, placed(own).0));
            }
            last.get().1
        };
        chain.follow(Laws { process: model.process, logs: &logs }, unit, seen);
        placed([phi[0], phi[1]]).1
    }
}
