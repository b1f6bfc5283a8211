//! Dormand-Prince where accuracy limits its steps, Rodas5P where vibrations that nobody asks for would keep them short, or what dies out
//! at once. In: a problem that may tell its fastest vibration, a step. Out: as of the method that takes it. Never knows mechanisms.
//!
//! Where modes vibrate they are known beforehand, and Rodas5P begins. Else Dormand-Prince begins, and its own last stages tell how fast
//! the problem is: stiff dampers and springs, friction that holds.
//!
//! A step of Rodas5P takes several times as long. It pays where it is as many times longer than the longest stable one of
//! Dormand-Prince; and this one's steps are held short by stability where they stay near that length.

use super::adaptive::{Method, Step};
use super::dopri5::Dopri5;
use super::problem::Problem;
use super::rodas5p::Rodas5P;
use crate::error::RunError;

/// Radians of an undamped vibration in a step of Dormand-Prince up to which it does not grow (Hairer, Norsett, Wanner I, II.4: the
/// interval of the imaginary axis).
const STABLE: f64 = 1.0;
/// The same of what dies out without vibrating (the interval of the negative real axis).
const STABLE_DAMPED: f64 = 3.3;
/// Steps beyond this part of it are held short by stability: their lengths scatter about it, as some fail.
const HELD: f64 = 0.7;
/// So many steps more that speak for the other method than against it have it tried: the control of lengths needs some until it has
/// found the right one.
const PATIENCE: u32 = 15;
/// What an evaluation beside a state costs of one on the way: several are made at once. Fixed, so that steps are the same on every
/// back end.
const BESIDE: f64 = 1.0 / 3.0;
/// Multiplications of an evaluation for every component that decides: 25 to 45 for mechanisms with flexible bodies.
const OPERATIONS: f64 = 25.0;

/// Either method, as it pays; with modes, or of what has none.
#[derive(Clone, Debug)]
pub struct Switching<const MODES: bool> {
    explicit: Dopri5,
    implicit: Rodas5P,
    /// Whether the next step is Rodas5P's, and the last one was.
    is_implicit: bool,
    was_implicit: bool,
    /// Steps that speak for the other method, less those against it.
    against: u32,
    /// Fastest vibration [rad/s], known from the first step on, or what the last explicit step told [1/s]; steps of Rodas5P beyond so
    /// many radians of it pay.
    fastest: f64,
    pays: f64,
    implicit_steps: u64,
}

impl<const MODES: bool> Switching<MODES> {
    /// Length of a step of Dormand-Prince up to which what is fastest does not grow, by its speed.
    const STABLE: f64 = if MODES { STABLE } else { STABLE_DAMPED };

    /// Part of the tolerance that errors of the next step may take, of that of both methods.
    fn share(&self) -> f64 {
        (if self.is_implicit { Rodas5P::SHARE } else { Dopri5::SHARE }) / Self::SHARE
    }

    /// Evaluations that a step of Rodas5P takes for one of Dormand-Prince, by the number of deciding components.
    fn ratio(deciding: usize) -> f64 {
        let n = deciding as f64;
        // Half of the components follow others, as coordinates follow speeds.
        let rows = 0.6 * n;
        let system = rows * rows * (2.0 / 3.0 * rows + 16.0) / (OPERATIONS * n.max(1.0));
        (8.0 + BESIDE * (n + 1.0) + system) / 6.0
    }
}

impl<const MODES: bool> Method for Switching<MODES> {
    const ORDER: f64 = 5.0;
    /// Errors are scaled to this by the share of each method. Without modes that of Dormand-Prince, whose steps are to the bit as they
    /// are alone.
    const SHARE: f64 = if MODES { 1.0 } else { Dopri5::SHARE };

    fn new(dimension: usize) -> Self {
        Self {
            explicit: Dopri5::new(dimension),
            implicit: Rodas5P::new(dimension),
            is_implicit: MODES,
            was_implicit: MODES,
            against: 0,
            fastest: 0.0,
            pays: 0.0,
            implicit_steps: 0,
        }
    }

    fn begin(&mut self, problem: &mut dyn Problem, t: f64, y: &[f64]) -> Result<(), RunError> {
        if MODES {
            self.fastest = problem.fastest();
        }
        self.pays = Self::STABLE * Self::ratio(problem.deciding(y.len()));
        self.explicit.begin(problem, t, y)?;
        self.implicit.go_on_with(self.explicit.slope());
        Ok(())
    }

    fn slope(&self) -> &[f64] {
        if self.is_implicit { self.implicit.slope() } else { self.explicit.slope() }
    }

    fn attempt(
        &mut self,
        problem: &mut dyn Problem,
        step: Step<'_>,
        (next, error): (&mut [f64], &mut [f64]),
    ) -> Result<(), RunError> {
        if self.is_implicit {
            self.implicit.attempt(problem, step, (next, error))?;
        } else {
            self.explicit.attempt(problem, step, (next, error))?;
        }
        let share = self.share();
        error.iter_mut().for_each(|error| *error /= share);
        Ok(())
    }

    fn noise(&mut self, problem: &mut dyn Problem, step: Step<'_>, next: &[f64]) -> f64 {
        let noise = if self.is_implicit {
            self.implicit.noise(problem, step, next)
        } else {
            self.explicit.noise(problem, step, next)
        };
        noise / self.share()
    }

    fn accept(&mut self, step: Step<'_>, next: &[f64]) {
        self.was_implicit = self.is_implicit;
        let speaks_against = if self.is_implicit {
            self.implicit_steps += 1;
            self.implicit.accept(step, next);
            self.fastest * step.length < self.pays
        } else {
            if !MODES {
                self.fastest = self.explicit.fastest(next);
            }
            self.explicit.accept(step, next);
            self.fastest * step.length > HELD * Self::STABLE
        };
        self.against = if speaks_against { self.against + 1 } else { self.against.saturating_sub(1) };
        if self.against >= PATIENCE {
            self.against = 0;
            self.is_implicit = !self.is_implicit;
            if self.is_implicit {
                self.implicit.go_on_with(self.explicit.slope());
            } else {
                self.explicit.go_on_with(self.implicit.slope());
            }
        }
    }

    fn take_back(&mut self) {
        self.is_implicit = self.was_implicit;
        if self.is_implicit {
            self.implicit_steps -= 1;
            self.implicit.take_back();
        } else {
            self.explicit.take_back();
        }
    }

    fn interpolate<const N: usize>(&self, s: [f64; N], y: &mut [[f64; N]]) {
        if self.was_implicit { self.implicit.interpolate(s, y) } else { self.explicit.interpolate(s, y) }
    }

    fn implicit_steps(&self) -> u64 {
        self.implicit_steps
    }

    fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.explicit.visit_memory(visit);
        self.implicit.visit_memory(visit);
        let mut numbers = [
            f64::from(u8::from(self.is_implicit)),
            f64::from(u8::from(self.was_implicit)),
            f64::from(self.against),
            self.fastest,
            self.pays,
        ];
        numbers.iter_mut().for_each(visit);
        let [is_implicit, was_implicit, against, fastest, pays] = numbers;
        (self.is_implicit, self.was_implicit) = (is_implicit != 0.0, was_implicit != 0.0);
        (self.against, self.fastest, self.pays) = (against as u32, fastest, pays);
    }
}
