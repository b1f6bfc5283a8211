//! Forces that depend on accelerations and joint forces of the same instant, solved for.
//! In: their laws, the forward dynamics over symbols of these forces. Out: what stands for the symbols. Never knows elements.
//!
//! Accelerations, multipliers and joint forces r are affine in the forces y that ask for them: `r = b + A y`. The laws
//! say `y = phi(r)`. Where phi is affine too, one elimination of `(1 - phi' A) y = phi(b)` solves it; else Newton's method
//! takes [`STEPS`] steps from `phi(b)`, and what misses the laws by more than [`MISS`] then is no number.

use rustc_hash::FxHashSet;

use super::deriver::{Deriver, Instant};
use super::joint_forces::JointForces;
use crate::derive::couplings::size;
use crate::derive::forward::Forward;
use crate::derive::link_mass::LinkMass;
use crate::expr::{Affine, Expr, ExprId, Scope};
use crate::model::Response;

/// Steps of Newton's method. Near the solution each doubles the digits: from two right ones three steps reach rounding. As
/// many again are there to come near.
const STEPS: usize = 6;

/// Part of a force (of 1 N or 1 N m, where it is smaller) that its law may be missed by: far below what an integrator's
/// tolerance lets through, far above rounding in the elimination.
const MISS: f64 = 1e-8;

/// Teeth are pressed apart by the size of a multiplier, in which no response is affine. So the size is one of the forces that are solved
/// for, and the multiplier one of the responses that its law asks for.
struct Pressed<'g> {
    multiplier: Expr<'g>,
    size: Expr<'g>,
    /// Symbol of the multiplier in the law.
    asked: Expr<'g>,
    /// Symbol of the size.
    unknown: Expr<'g>,
}

/// A symbol and what stands for it.
type Values<'g> = Vec<(Expr<'g>, Expr<'g>)>;

impl<'g> Deriver<'g> {
    /// What stands for the forces that ask and for what they ask for. `laws`: of the forces, in the order of their symbols.
    pub(super) fn response_values(
        &self,
        masses: &[LinkMass<'g>],
        solved: Option<&Forward<'g>>,
        laws: &[Expr<'g>],
    ) -> Values<'g> {
        let g = self.geometry.g;
        let (asked, unknowns) = (self.responses.asked(), self.responses.unknowns());
        if asked.is_empty() {
            return Vec::new();
        }
        let Some(solved) = solved else {
            let symbols = asked.iter().map(|(_, symbol)| symbol).chain(&unknowns);
            return symbols.map(|symbol| (*symbol, g.zero())).collect();
        };
        let instant = self.instant(self.driven_state(&self.v_dot));
        let by_symbols = self.responses_by_symbols(masses, &asked, &instant);
        let pressed = self.pressed(&by_symbols, &instant);
        let mut values = self.solution_values(solved);
        let multipliers = g.with(&pressed.iter().map(|one| one.multiplier).collect::<Vec<_>>(), &values);
        values.extend(pressed.iter().map(|one| (one.size, one.unknown)));
        let mut responses = g.with(&by_symbols, &values);
        responses.extend(multipliers);
        let own = pressed.iter().map(|one| one.asked);
        let symbols: Vec<Expr<'g>> = asked.iter().map(|(_, symbol)| *symbol).chain(own).collect();
        let unknowns: Vec<Expr<'g>> =
            unknowns.into_iter().chain(pressed.iter().map(|one| one.unknown)).collect();
        let laws: Vec<Expr<'g>> =
            laws.iter().copied().chain(pressed.iter().map(|one| size(one.asked))).collect();
        let laws = &*laws;
        g.begin_section("accelerations and joint forces that forces ask for");
        #[expect(
            clippy::expect_used,
            reason = "equations of motion are linear in forces, sizes of multipliers are unknowns"
        )]
        let affine = g.affine(&responses, &unknowns).expect("accelerations are affine in forces");
        let linear = g.affine(laws, &symbols);
        let forces = match &linear {
            Some(laws) => by_elimination(g, &affine, laws),
            None => by_newton(g, &affine, laws, &symbols),
        };
        let at = symbols.into_iter().zip(responses_at(&affine, &forces));
        unknowns.into_iter().zip(forces).chain(at).collect()
    }

    /// The rigid couplings whose flanks press on something that is asked for.
    fn pressed(&self, by_symbols: &[Expr<'g>], instant: &Instant<'g>) -> Vec<Pressed<'g>> {
        let g = self.geometry.g;
        let ids: Vec<ExprId> = by_symbols.iter().map(|response| response.id()).collect();
        let used: FxHashSet<ExprId> = g.nodes(&ids).into_iter().map(|(id, _)| id).collect();
        let multipliers = &self.lambda[self.lambda.len() - instant.couplings.len()..];
        let sizes = multipliers.iter().map(|multiplier| (*multiplier, size(*multiplier)));
        let pressed = sizes.filter(|(_, size)| used.contains(&size.id())).enumerate();
        let one = |(at, (multiplier, size)): (usize, (Expr<'g>, Expr<'g>))| Pressed {
            multiplier,
            size,
            asked: g.symbol(format!("pressing{}", at + 1)),
            unknown: g.symbol(format!("pressed{}", at + 1)),
        };
        pressed.map(one).collect()
    }

    /// What is asked for, over symbols of accelerations, multipliers, drive forces and of the forces that ask.
    pub(super) fn responses_by_symbols(
        &self,
        masses: &[LinkMass<'g>],
        asked: &[(Response, Expr<'g>)],
        instant: &Instant<'g>,
    ) -> Vec<Expr<'g>> {
        let mut joints = JointForces::new(self, instant);
        for (coupling, by) in joints.couplings() {
            joints.add(coupling, &by);
        }
        let transmitted = std::cell::OnceCell::new();
        let wrench = |joint| joints.wrench(joint, transmitted.get_or_init(|| joints.transmitted(masses)));
        let state = &instant.state;
        let value = |response: &Response| match *response {
            Response::JointAcceleration(joint, c) => {
                state.coordinates(self.geometry.g, joint).acceleration[c]
            }
            Response::PointAcceleration(point, axis) => state.point_acceleration(point)[axis],
            Response::BodyAcceleration(body, axis) => state.spin_rate(body)[axis],
            Response::JointForce(joint, axis) => wrench(joint)[1][axis],
            Response::JointMoment(joint, axis) => wrench(joint)[0][axis],
            Response::Drive(joint, c) => {
                let driver = self
                    .drivers
                    .iter()
                    .zip(&self.drive)
                    .find(|(driver, _)| driver.joint == joint && driver.joint_coordinate == c);
                driver.map_or_else(|| self.geometry.g.zero(), |(_, force)| *force)
            }
        };
        asked.iter().map(|(response, _)| value(response)).collect()
    }

    /// The forward dynamics in place of the symbols of accelerations, multipliers and drive forces.
    fn solution_values(&self, solved: &Forward<'g>) -> Values<'g> {
        let accelerations = self.v_dot.iter().copied().zip(solved.solution.accelerations.iter().copied());
        let mut kept = solved.solution.multipliers.iter().copied();
        let multipliers = self.lambda.iter().zip(&self.keep).map(|(symbol, keep)| {
            let value = if *keep { kept.next() } else { None };
            (*symbol, value.unwrap_or_else(|| self.geometry.g.zero()))
        });
        let drives = self.drive.iter().copied().zip(solved.drive.iter().copied());
        accelerations.chain(multipliers).chain(drives).collect()
    }
}

/// `b + A y`.
fn responses_at<'g>(affine: &[Affine<'g>], forces: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let at = |response: &Affine<'g>| {
        response.factors.iter().fold(response.constant, |sum, (k, factor)| sum + *factor * forces[*k])
    };
    affine.iter().map(at).collect()
}

/// `1 - phi' A`, where `slope` is the slope of a law by something asked for.
fn matrix<'g>(
    g: &'g Scope,
    affine: &[Affine<'g>],
    laws: usize,
    slope: impl Fn(usize, usize) -> Expr<'g>,
) -> Vec<Vec<Expr<'g>>> {
    let entry = |k: usize, j: usize| {
        let own = g.number(f64::from(u8::from(k == j)));
        affine.iter().enumerate().fold(own, |sum, (at, response)| sum - slope(k, at) * response.factor(j))
    };
    (0..laws).map(|k| (0..laws).map(|j| entry(k, j)).collect()).collect()
}

fn by_elimination<'g>(g: &'g Scope, affine: &[Affine<'g>], laws: &[Affine<'g>]) -> Vec<Expr<'g>> {
    let constants: Vec<Expr<'g>> = affine.iter().map(|response| response.constant).collect();
    let right = responses_at(laws, &constants);
    eliminate(matrix(g, affine, laws.len(), |k, at| laws[k].factor(at)), right)
}

fn by_newton<'g>(
    g: &'g Scope,
    affine: &[Affine<'g>],
    laws: &[Expr<'g>],
    symbols: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    let slopes: Vec<Vec<Expr<'g>>> =
        laws.iter().map(|law| symbols.iter().map(|symbol| law.derivative(*symbol)).collect()).collect();
    let flat: Vec<Expr<'g>> = laws.iter().chain(slopes.iter().flatten()).copied().collect();
    // Laws and their slopes where these forces act.
    let at = |forces: &[Expr<'g>]| {
        let values: Values<'g> = symbols.iter().copied().zip(responses_at(affine, forces)).collect();
        let mut all = g.with(&flat, &values);
        let slopes = all.split_off(laws.len());
        (all, slopes)
    };
    let size = g.size();
    let (mut forces, _) = at(&vec![g.zero(); laws.len()]);
    for _ in 0..STEPS {
        let (values, slopes) = at(&forces);
        let wrong = values.iter().zip(&forces).map(|(value, force)| *value - *force).collect();
        let matrix = matrix(g, affine, laws.len(), |k, response| slopes[k * symbols.len() + response]);
        let step = eliminate(matrix, wrong);
        forces = forces.into_iter().zip(step).map(|(force, step)| force + step).collect();
    }
    // Pieces of laws at forces that are not yet right begin where no step has to end.
    g.keep_quiet_since(size);
    let (values, _) = at(&forces);
    let checked = forces.iter().zip(values).map(|(force, value)| {
        let allowed = (MISS * MISS) * (force.square() + 1.0);
        let left = allowed - (value - *force).square();
        left.keep_quiet();
        // The root of what is negative is not a number.
        left.below_zero(left.sqrt(), *force)
    });
    checked.collect()
}

/// Solves `matrix x = right` in the order of the rows. On the diagonal stands 1 less what a force does to itself.
fn eliminate<'g>(mut matrix: Vec<Vec<Expr<'g>>>, mut right: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
    let count = right.len();
    for k in 0..count {
        let (above, below) = matrix.split_at_mut(k + 1);
        let pivot = &above[k];
        let reciprocal = pivot[k].recip();
        let known = right[k];
        for (row, right) in below.iter_mut().zip(&mut right[k + 1..]) {
            if row[k].is_zero() {
                continue;
            }
            let factor = row[k] * reciprocal;
            for (entry, over) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                *entry -= factor * *over;
            }
            *right -= factor * known;
        }
    }
    for k in (0..count).rev() {
        let known = matrix[k][k + 1..].iter().zip(&right[k + 1..]);
        let left = known.fold(right[k], |sum, (entry, value)| sum - *entry * *value);
        right[k] = left / matrix[k][k];
    }
    right
}
