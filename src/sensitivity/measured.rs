//! Wear and its derivatives at states of wear along a life. In: a mechanism, its sides. Out: what turns wear there, and how that
//! varies. Never knows lives.

use std::sync::{Mutex, PoisonError};

use linkwear_codegen::tape::{Tape, side_by_side};
use linkwear_runtime::life::{JointLife, JointWear, WearSource};
use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{DynamicsSource, Layout, Orbit, TurnState, Watch};

use super::error::SensitivityError;
use super::settled::{Pass, Settled, Unsettled};
use super::tangents::Varied;
use super::turn::{Directions, Turned, Turns};
use super::varied::{Sides, Variant};

/// Steps of a turn that are tried first, and the most.
const FIRST_STEPS: u64 = 1 << 10;
const MOST_STEPS: u64 = 1 << 18;
/// Wear of a turn may differ by this part of it from that in half as many steps.
const FINE: f64 = 3e-5;
/// The same may differ by this from that by adaptive steps, which is known to 1e-6 to 1e-5.
const AGREES: f64 = 1e-4;
/// Turns that differ by this part of their wear, after all that may settle, have no period.
const NO_PERIOD: f64 = 1e-3;
/// The part of the work that turns without derivatives are, about.
const MEASURED: f64 = 0.1;
/// A motion that is not followed in so many times the steps that were enough before is not followed at all.
const FINER: u64 = 16;

/// What a settled turn wears at a joint, and its derivatives by all parameters.
#[derive(Clone, Debug)]
pub(super) struct Wear {
    /// Wear integral [J], depth [m].
    pub values: [f64; 2],
    pub slopes: Vec<[f64; 2]>,
}

/// A state of wear.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Wear of the wearing joints [m].
    pub worn: Vec<f64>,
    pub measured: Vec<ContactMeasure>,
    pub wear: Vec<Wear>,
    /// The same in three quarters of the steps, if these are enough for a turn at all.
    pub coarse: Option<Vec<Wear>>,
}

/// All of them, and at what cost.
#[derive(Clone, Debug, Default)]
pub(super) struct Points {
    pub points: Vec<Point>,
    /// From where bodies come apart on, or derivatives do not settle: wears [m] and what turns wear there.
    pub rough: Vec<(Vec<f64>, Vec<ContactMeasure>)>,
    pub steps: u64,
    pub step_error: f64,
    pub turns: u32,
    pub losses: u32,
}

impl Points {
    /// Adds turns without derivatives, which have to be alike.
    fn add_rough(&mut self, state: State) -> Result<(), SensitivityError> {
        let State { worn, measured, change, .. } = state;
        if change > NO_PERIOD {
            return Err(SensitivityError::NoPeriod { wear: worn[0], change });
        }
        self.rough.push((worn, measured));
        Ok(())
    }

    /// Forgets derivatives by all parameters but these.
    pub(super) fn keep(&mut self, is_kept: impl Fn(usize) -> bool) {
        for point in &mut self.points {
            for wear in point.wear.iter_mut().chain(point.coarse.iter_mut().flatten()) {
                let mut place = 0..;
                wear.slopes.retain(|_| place.next().is_some_and(&is_kept));
            }
        }
    }
}

/// A settled turn by adaptive steps at a state of wear.
struct State {
    worn: Vec<f64>,
    measured: Vec<ContactMeasure>,
    /// By how much of it wear changes from turn to turn, where that is most.
    change: f64,
    turn: TurnState,
}

impl State {
    /// Whether bodies stay together.
    fn is_smooth(&self) -> bool {
        self.measured.iter().all(|one| one.losses == 0.0)
    }
}

/// What is measured.
pub(super) struct Survey<'s> {
    pub variant: &'s Variant,
    pub sides: &'s [Sides],
    /// Steps of a turn, if they were chosen.
    pub steps: Option<u64>,
    /// Whether derivatives are asked for all along the path, though bodies come apart on it; else those of the unworn mechanism are
    /// enough there.
    pub is_path_asked: bool,
    /// Threads that share the directions.
    pub threads: usize,
}

impl Survey<'_> {
    /// At these wears of the wearing joints [m], rising.
    pub(super) fn measure<const N: usize>(
        &self,
        source: &mut DynamicsSource<'_>,
        wears: &[Vec<f64>],
        watch: Watch<'_>,
    ) -> Result<Points, SensitivityError> {
        let contacts = &self.variant.compiled.description().contacts;
        let wearing: Vec<usize> = (0..contacts.len()).filter(|at| contacts[*at].wear.is_some()).collect();
        let states = self.states(source, wears, watch)?;
        // How the unworn mechanism wears is told as it is.
        let smooth = 1 + states.iter().skip(1).take_while(|state| state.is_smooth()).count();
        let is_path_told = smooth == states.len() || self.is_path_asked;
        let by_turns = if is_path_told && !self.variant.has_worn_journals() { smooth } else { 1 };
        let mut passes = self.passes::<N>();
        let mut found = Points { steps: self.steps.unwrap_or(0), ..Points::default() };
        for (place, state) in states.into_iter().enumerate() {
            let part = MEASURED + (1.0 - MEASURED) * place as f64 / by_turns as f64;
            if watch.report(part.min(1.0)).is_break() {
                return Err(SensitivityError::Interrupted);
            }
            if place >= by_turns || !found.rough.is_empty() {
                found.add_rough(state)?;
                continue;
            }
            let at = &state.turn;
            self.feed_back(&mut passes, &state.worn, &wearing);
            if found.steps == 0 {
                found.steps = fine(&mut passes[0], at, &wearing)?;
            }
            let settled = match self.settled((&mut passes, at), &state.measured, &wearing, &mut found) {
                // Turns that are smooth have a derivative, though tangents of single steps do not settle to it.
                Err(Unsettled::Never(..)) if place > 0 || state.is_smooth() => {
                    found.add_rough(state)?;
                    continue;
                }
                settled => settled.map_err(|why| self.told(why, state.worn[0]))?,
            };
            found.turns = settled.iter().map(|one| one.turns).fold(found.turns, u32::max);
            found.losses = settled.iter().map(|one| one.turned.losses).fold(found.losses, u32::max);
            let wear =
                |settled: &[Settled<N>]| wearing.iter().map(|joint| self.wear(settled, *joint)).collect();
            let coarse = self.settle(&mut passes, at, found.steps - found.steps / 4, &wearing).ok();
            let (wear, coarse) = (wear(&settled), coarse.map(|settled| wear(&settled)));
            found.points.push(Point { worn: state.worn, measured: state.measured, wear, coarse });
        }
        Ok(found)
    }

    /// Tells turns how clearances that grew by this wear [m] vary with parameters.
    fn feed_back<const N: usize>(&self, passes: &mut [Pass<N>], worn: &[f64], wearing: &[usize]) {
        for (number, pass) in passes.iter_mut().enumerate() {
            let mut grown = vec![[0.0; N]; self.variant.compiled.description().contacts.len()];
            for (at, joint) in wearing.iter().enumerate() {
                grown[*joint] = std::array::from_fn(|lane| {
                    let gamma = |side: &Variant| side.joints[at].gamma();
                    let of = |sides: &Sides| scale(sides) * sides.slope(gamma) * worn[at];
                    self.sides.get(N * number + lane).map_or(0.0, of)
                });
            }
            pass.grown = grown;
        }
    }

    /// Settled turns by adaptive steps, without derivatives.
    fn states(
        &self,
        source: &mut DynamicsSource<'_>,
        wears: &[Vec<f64>],
        watch: Watch<'_>,
    ) -> Result<Vec<State>, SensitivityError> {
        let mut orbit: Option<Orbit> = None;
        let mut states = Vec::with_capacity(wears.len());
        for (place, worn) in wears.iter().enumerate() {
            if watch.report(MEASURED * place as f64 / wears.len() as f64).is_break() {
                return Err(SensitivityError::Interrupted);
            }
            let measured = source
                .measure(&worn_joints(&self.variant.joints, worn), &mut orbit)
                .map_err(|error| SensitivityError::Wear(error.to_string()))?;
            let Some(Orbit { turn, .. }) = &orbit else { continue };
            let drifts = source.steadiness().iter().filter_map(|turns| turns.drift);
            let change = drifts.fold(0.0, |most: f64, drift| most.max(drift.abs()));
            states.push(State { worn: worn.clone(), measured, change, turn: turn.clone() });
        }
        Ok(states)
    }

    /// Settled turns, in steps that are short enough: what they wear agrees with what was measured.
    fn settled<const N: usize>(
        &self,
        (passes, at): (&mut [Pass<N>], &TurnState),
        measured: &[ContactMeasure],
        wearing: &[usize],
        found: &mut Points,
    ) -> Result<Vec<Settled<N>>, Unsettled> {
        let most = self.steps.unwrap_or((FINER * found.steps).min(MOST_STEPS));
        let mut before: Option<Vec<Settled<N>>> = None;
        let mut never = 0;
        loop {
            let settled = self.settle(passes, at, found.steps, wearing);
            // What does not settle in steps of half the length either never will.
            never += u32::from(matches!(settled, Err(Unsettled::Never(..))));
            let most_of = |differs: &dyn Fn(usize, usize) -> f64| {
                wearing.iter().enumerate().map(|(at, joint)| differs(at, *joint)).fold(0.0, f64::max)
            };
            let apart = settled
                .as_ref()
                .map_or(f64::INFINITY, |settled| most_of(&|at, joint| apart(settled, joint, &measured[at])));
            // Where more steps change nothing, it is the measurement that is rough.
            let same = match (&before, &settled) {
                (Some(before), Ok(now)) => {
                    most_of(&|_, joint| moved(&before[0].turned, &now[0].turned, joint)) <= FINE
                }
                _ => false,
            };
            if apart <= AGREES || same || 2 * found.steps > most || never > 1 {
                if settled.is_ok() {
                    found.step_error = found.step_error.max(apart);
                }
                return settled;
            }
            before = settled.ok();
            found.steps *= 2;
        }
    }

    /// All directions, in as many passes as they take.
    fn passes<const N: usize>(&self) -> Vec<Pass<N>> {
        let base = self.variant;
        let lift = |of: fn(&Variant) -> &Tape| {
            let others: Vec<&Tape> = self.sides.iter().flat_map(|sides| &sides.sides).map(of).collect();
            of(base).lifted(&others)
        };
        let (motion, closure) = (lift(|variant| &variant.motion), lift(|variant| &variant.closure));
        let (description, sizes) = (base.compiled.description(), base.compiled.sizes());
        let kept = description.kept_rows(sizes.rows);
        let layout = Layout::new(&description.motions);
        let parameters = base.compiled.parameters();
        let chunk = |(number, sides): (usize, &[Sides])| {
            let first = N * number;
            let varied = |value: f64, slope: &dyn Fn(&Sides, usize) -> f64| {
                let tangents = std::array::from_fn(|lane| {
                    sides.get(lane).map_or(0.0, |sides| scale(sides) * slope(sides, first + lane))
                });
                Varied { value, tangents }
            };
            let lifted = |values: &Vec<f64>| {
                varied(values[0], &|sides, at| (values[2 * at + 2] - values[2 * at + 1]) / (2.0 * sides.step))
            };
            let parameter = |at: usize| {
                varied(parameters[at], &|sides, _| sides.slope(|side| side.compiled.parameters()[at]))
            };
            let directions = Directions {
                parameters: (0..parameters.len()).map(parameter).collect(),
                motion_constants: motion.1.iter().map(lifted).collect(),
                closure_constants: closure.1.iter().map(lifted).collect(),
                period: varied(base.turn, &|sides, _| sides.slope(|side| side.turn)),
            };
            let turns =
                Turns::new([&motion.0, &closure.0], sizes, (layout.clone(), kept.clone()), &directions);
            Pass::new(turns, sizes.coordinates + sizes.speeds + sizes.contacts)
        };
        // Without a parameter, wear is still asked for.
        if self.sides.is_empty() {
            vec![chunk((0, &[]))]
        } else {
            self.sides.chunks(N).enumerate().map(chunk).collect()
        }
    }

    /// Settled turns of all passes.
    fn settle<const N: usize>(
        &self,
        passes: &mut [Pass<N>],
        at: &TurnState,
        steps: u64,
        wearing: &[usize],
    ) -> Result<Vec<Settled<N>>, Unsettled> {
        let passes: Vec<_> = passes.iter_mut().map(Mutex::new).collect();
        let settled = side_by_side(&passes, self.threads, |pass| {
            pass.lock().unwrap_or_else(PoisonError::into_inner).settle(at, steps, wearing)
        });
        settled.into_iter().collect()
    }

    fn wear<const N: usize>(&self, settled: &[Settled<N>], joint: usize) -> Wear {
        let values = settled[0].turned.wear[joint].map(|one| one.value);
        let slopes = self.sides.iter().enumerate().map(|(at, sides)| {
            settled[at / N].turned.wear[joint].map(|one| one.tangents[at % N] / scale(sides))
        });
        Wear { values, slopes: slopes.collect() }
    }

    fn told(&self, why: Unsettled, wear: f64) -> SensitivityError {
        match why {
            Unsettled::TooLong => SensitivityError::TooLong { steps: MOST_STEPS },
            Unsettled::Never(turns, change) => SensitivityError::NotSettled { wear, turns, change },
        }
    }
}

/// The wearing joints, worn by so much [m].
pub(super) fn worn_joints(joints: &[JointLife], worn: &[f64]) -> Vec<JointWear> {
    let one = |(joint, worn): (&JointLife, &f64)| JointWear {
        clearance: joint.clearance + joint.gamma() * worn,
        wear: *worn,
        profile: None,
        journal: None,
    };
    joints.iter().zip(worn).map(one).collect()
}

/// What tangents are counted in: by the logarithm of a parameter where it has one.
fn scale(sides: &Sides) -> f64 {
    if sides.of.value == 0.0 { 1.0 } else { sides.of.value.abs() }
}

/// By how much of it the wear of a turn differs from a measured one.
fn apart<const N: usize>(settled: &[Settled<N>], joint: usize, known: &ContactMeasure) -> f64 {
    let found = settled[0].turned.wear[joint];
    let pairs = [known.wear_integral, known.depth].into_iter().zip(found);
    pairs.map(|(known, found)| difference_of(known, found.value)).fold(0.0, f64::max)
}

/// By how much of it a number differs from another.
fn difference_of(known: f64, found: f64) -> f64 {
    if known == found { 0.0 } else { (found / known - 1.0).abs() }
}

/// By how much of it the wear of a joint differs between two lengths of steps.
fn moved<const N: usize>(before: &Turned<N>, now: &Turned<N>, joint: usize) -> f64 {
    let pairs = before.wear[joint].iter().zip(&now.wear[joint]);
    pairs.map(|(before, now)| difference_of(before.value, now.value)).fold(0.0, f64::max)
}

/// So many steps that half as many give nearly the same.
fn fine<const N: usize>(
    pass: &mut Pass<N>,
    at: &TurnState,
    wearing: &[usize],
) -> Result<u64, SensitivityError> {
    let (mut steps, mut last): (u64, Option<Turned<N>>) = (FIRST_STEPS, None);
    while steps <= MOST_STEPS {
        let turned = pass.once(at, steps).ok();
        if let (Some(last), Some(now)) = (&last, &turned)
            && wearing.iter().all(|joint| moved(last, now, *joint) <= FINE)
        {
            return Ok(steps);
        }
        last = turned;
        steps *= 2;
    }
    Err(SensitivityError::TooLong { steps: MOST_STEPS })
}
