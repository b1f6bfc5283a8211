//! States of a file's own that go on while turns wear alike: a bush that warms over thousands of turns, an integrator. In: their values
//! at the ends of turns. Out: whether a turn may be measured. Runs no turn.

use crate::error::RunError;
use crate::simulate::TurnRunner;

/// A state that goes one way and whose way shrinks by less than this from turn to turn is slow; any other has settled with the turns.
const SLOW: f64 = 0.5;
/// Factors that differ by less than this part of what they leave are one: the way of a state to its rest is then that of a decay, and
/// it is put there.
const STEADY: f64 = 0.05;
/// So often a state is put where it would come to rest, and then left alone: laws that are no decay may lead it astray.
const MOST_PUT: u32 = 20;
/// Turns that slow states are waited for, ...
const LONGEST: u32 = 5000;
/// ... and turns with ways of one length, where a state goes on for ever; ways that grow or shrink are others than this part.
const ENDLESS: u32 = 50;
const EVEN: f64 = 1e-7;
/// Parts of a turn at which is asked what states do.
const PHASES: u32 = 8;
/// Accelerations below this part of the largest do not count.
const NOTHING: f64 = 1e-6;
/// Where nothing is known of how a way shrinks, it may be this many times as long; ...
const UNKNOWN: f64 = 1e3;
/// ... so many times where it is seen not to shrink.
const LONG: f64 = 1e6;

/// A state on its way.
#[derive(Clone, Copy, Debug)]
struct Way {
    place: usize,
    /// Its value where the turn began.
    before: f64,
    /// What the last turns changed it by, and by which factor less the last but one did.
    change: Option<f64>,
    factor: Option<f64>,
    /// Whether it has turned back: then it swings with the turns.
    swings: bool,
    /// For how many turns its ways have been of one length.
    endless: u32,
}

/// The states that may be slow.
#[derive(Clone, Debug, Default)]
pub(super) struct SlowStates {
    ways: Vec<Way>,
    waited: u32,
    put: u32,
}

impl SlowStates {
    /// Of a mechanism.
    pub fn new(runner: &TurnRunner<'_>) -> Self {
        let way = |place| Way { place, before: 0.0, change: None, factor: None, swings: false, endless: 0 };
        Self { ways: runner.own_states().into_iter().map(way).collect(), waited: 0, put: 0 }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ways.is_empty()
    }

    /// A turn begins.
    pub fn begin(&mut self, runner: &TurnRunner<'_>) {
        self.ways.iter_mut().for_each(|way| way.before = runner.speed(way.place));
    }

    /// The turn that began last is done: whether states have come to rest, but for what changes accelerations by no more than this part of
    /// themselves. If not, the turn does not count; states may have been put nearer to where they rest.
    ///
    /// # Errors
    /// [`RunError::NeverAlike`] if they do not.
    pub fn have_settled(&mut self, runner: &mut TurnRunner<'_>, settled: f64) -> Result<bool, RunError> {
        let mut rests = Vec::new();
        let mut all_steady = true;
        for way in &mut self.ways {
            let change = runner.speed(way.place) - way.before;
            let last = way.change.replace(change);
            if change == 0.0 || way.swings {
                continue;
            }
            let factor = last.filter(|last| *last != 0.0).map(|last| change / last);
            let known = std::mem::replace(&mut way.factor, factor);
            let left = match factor {
                None => UNKNOWN * change,
                Some(factor) if factor < 0.0 => {
                    way.swings = true;
                    continue;
                }
                Some(factor) if factor <= SLOW => change,
                Some(factor) => change * factor / (1.0 - factor),
            };
            let is_even = factor.is_some_and(|factor| (factor - 1.0).abs() <= EVEN);
            way.endless = if is_even { way.endless + 1 } else { 0 };
            let left = if factor.is_some_and(|factor| factor >= 1.0 - EVEN) { LONG * change } else { left };
            let is_steady = factor.zip(known).is_some_and(|(factor, known)| {
                (SLOW..1.0).contains(&factor) && (factor - known).abs() <= STEADY * (1.0 - factor)
            });
            let rest = (way.place, runner.speed(way.place) + left);
            // What only counts, such as a work, goes on for ever and moves nothing.
            if is_even && effect(runner, &[rest]) <= settled {
                continue;
            }
            all_steady &= is_steady;
            rests.push(rest);
        }
        if rests.is_empty() || effect(runner, &rests) <= settled {
            return Ok(true);
        }
        self.waited += 1;
        let endless = self
            .ways
            .iter()
            .find(|way| way.endless >= ENDLESS && rests.iter().any(|rest| rest.0 == way.place));
        if self.waited > LONGEST || endless.is_some() {
            let place = endless.map_or(rests[0].0, |way| way.place);
            let what =
                format!("state `{}` goes on changing what moves the mechanism", runner.name_of_speed(place));
            return Err(RunError::NeverAlike { turns: self.waited as usize, what });
        }
        if all_steady && self.put < MOST_PUT {
            runner.set_speeds(&rests);
            runner.rest_journals();
            self.put += 1;
            self.ways.iter_mut().for_each(|way| (way.change, way.factor, way.endless) = (None, None, 0));
        }
        Ok(false)
    }

    /// The turns of the next measurement are counted anew.
    pub fn forget(&mut self) {
        (self.waited, self.put) = (0, 0);
        for way in &mut self.ways {
            (way.change, way.factor, way.swings, way.endless) = (None, None, false, 0);
        }
    }
}

/// By which part of themselves accelerations change with these speeds in place of the present ones, of all that moves.
fn effect(runner: &mut TurnRunner<'_>, speeds: &[(usize, f64)]) -> f64 {
    let begin = runner.t();
    let Ok(end) = runner.part_of_turn(begin, 1.0) else { return 0.0 };
    let now = runner.speeds().to_vec();
    let mut then = now.clone();
    speeds.iter().for_each(|(place, value)| then[*place] = *value);
    let own = runner.own_states();
    let (mut sizes, mut changes) = (vec![0.0_f64; now.len()], vec![0.0_f64; now.len()]);
    for phase in 0..PHASES {
        let t = begin + (end - begin) * (f64::from(phase) + 0.5) / f64::from(PHASES);
        let as_now = runner.accelerations_at(t, &now).to_vec();
        let as_then = runner.accelerations_at(t, &then);
        for (place, (a, b)) in as_now.iter().zip(as_then).enumerate() {
            sizes[place] = sizes[place].max(a.abs()).max(b.abs());
            changes[place] = changes[place].max((a - b).abs());
        }
    }
    let moves = |place: &usize| !own.contains(place);
    let largest = (0..now.len()).filter(moves).map(|place| sizes[place]).fold(0.0, f64::max);
    let counts = |place: &usize| moves(place) && sizes[*place] > NOTHING * largest;
    (0..now.len()).filter(counts).map(|place| changes[place] / sizes[place]).fold(0.0, f64::max)
}
