//! How a measurement goes from turn to turn. In: turns, as they are done. Out: whether one more is needed, and what they come to.
//! Never runs one.

use super::returning::Stand;
use super::settings::RevolutionSettings;
use super::settling::{Orbit, Settling};
use super::stability::Left;
use super::steadiness::Steadiness;
use super::wearing::Wearing;
use crate::simulate::{RunWarning, TurnMeasures, TurnState};
use crate::wear::ContactMeasure;

/// A motion whose turns have not settled at this one is taken as one that never does, ...
const MOST_TO_SETTLE: u32 = 4;
/// ... and the mean of it and later ones is taken, of so many that its standard error is this part of it: many measurements of a life
/// average out what is left, and the budget tells it; it counts alone where it is nearly settled; ...
const SCATTERED: f64 = 1e-3;
/// ... or of so many turns, ...
const MOST_TO_AVERAGE: usize = 20;
/// ... or so many times as many as drives and forces need to repeat.
const FEWEST: usize = 2;

/// A measurement under way.
pub(super) struct Measuring {
    settle: Option<u32>,
    average: usize,
    /// How many are averaged at most where turns scatter.
    most: usize,
    /// How many of the driver's turns are measured as one.
    every: u32,
    settling: Settling,
    /// Where journals stood when its last turn ended.
    stand: Stand,
    /// How much room journals have [m].
    rooms: Vec<f64>,
    stage: Stage,
    done: u32,
    /// The part of the measurement that was done when it was begun anew.
    before: f64,
    /// The last turn that settled.
    last: Option<TurnMeasures>,
    /// Those that are measured.
    turns: Vec<TurnMeasures>,
    /// What is doubtful about where the motion has got to.
    doubts: Option<RunWarning>,
}

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Settles,
    /// Turns are alike, or as many have settled as were asked for.
    IsSettled,
    NeverSettles,
}

/// What a measurement has come to.
pub(super) struct Done {
    pub measured: Vec<ContactMeasure>,
    /// Joint by joint.
    pub steadiness: Vec<Steadiness>,
    pub orbit: Orbit,
    /// The turns that it is the mean of.
    pub turns: Vec<TurnMeasures>,
    pub doubts: Option<RunWarning>,
}

impl Measuring {
    /// Of a motion that goes on from an orbit, or begins, with journals that stand so and have so much room [m]; what counts as a turn
    /// are so many of the driver's.
    pub fn new(
        settings: &RevolutionSettings,
        settling: Settling,
        (stand, rooms): (Stand, Vec<f64>),
        every: u32,
    ) -> Self {
        let average = settings.average.max(1) as usize;
        let stage = if settings.settle == Some(0) { Stage::IsSettled } else { Stage::Settles };
        let (settle, last, turns) = (settings.settle, None, Vec::new());
        let most = (MOST_TO_AVERAGE / every.max(1) as usize).max(FEWEST);
        Self {
            settle,
            average,
            most,
            every,
            settling,
            stand,
            rooms,
            stage,
            done: 0,
            before: 0.0,
            last,
            turns,
            doubts: None,
        }
    }

    /// The part of the measurement that the next turn is, from and to. Where nobody knows how many there will be, every turn is half of
    /// what is left.
    pub fn next(&self) -> (f64, f64) {
        let part = |done: u32| match self.settle {
            Some(settle) => f64::from(done) / (f64::from(settle) + self.average as f64),
            None => 1.0 - 0.5_f64.powi(i32::try_from(done).unwrap_or(i32::MAX)),
        };
        let of_rest = |part: f64| self.before + (1.0 - self.before) * part;
        (of_rest(part(self.done)), of_rest(part(self.done + 1)))
    }

    /// A turn that does not count has left journals there.
    pub fn pass(&mut self, stand: Stand) {
        self.stand = stand;
    }

    /// Takes a turn, and where it has left journals; whether it was the last one.
    pub fn take(&mut self, turn: TurnMeasures, stand: Stand, wearing: &Wearing<'_>) -> bool {
        self.done += 1;
        self.settling.moves(stand.from(&self.stand));
        self.stand = stand;
        if let (Stage::Settles, None, Some(last)) = (self.stage, self.settle, &self.last) {
            if self.settling.has_settled([wearing.differs(last, &turn)].into_iter()) {
                self.stage = Stage::IsSettled;
            } else if self.done >= MOST_TO_SETTLE {
                self.stage = Stage::NeverSettles;
            }
        }
        if self.stage != Stage::Settles {
            self.turns.push(turn);
            return self.is_done(wearing);
        }
        self.last = Some(turn);
        if self.settle.is_some_and(|settle| self.done >= settle) {
            self.stage = Stage::IsSettled;
        }
        false
    }

    fn is_done(&self, wearing: &Wearing<'_>) -> bool {
        let count = self.turns.len();
        let enough = self.stage == Stage::IsSettled
            || count == 1 && self.settling.has_nearly_settled()
            || count >= self.most
            || wearing.is_known_to(SCATTERED, &self.turns);
        count >= self.average && enough
    }

    /// Whether it is done by turns that agree, though nothing tells that the motion would come back to itself.
    pub fn shows_nothing(&self, wearing: &Wearing<'_>) -> bool {
        let is_steady = || self.turns.last().is_some_and(|turn| wearing.has_steady_load(turn));
        let is_short = self.every as usize <= MOST_TO_AVERAGE;
        self.has_settled() && is_short && self.settling.shows_nothing(&self.rooms, is_steady)
    }

    /// How many of the driver's turns are measured as one.
    pub const fn every(&self) -> u32 {
        self.every
    }

    /// That was tried, and has left journals there. If the motion has left, with what is doubtful about it, it is measured anew.
    pub fn is_tried(&mut self, left: Option<Left>, stand: Stand) {
        self.settling.is_tried(self.rooms.clone(), left.as_ref());
        self.stand = stand;
        if let Some(Left { doubts, .. }) = left {
            (self.before, _) = self.next();
            (self.stage, self.done, self.last, self.doubts) = (Stage::Settles, 0, None, doubts);
            self.turns.clear();
        }
    }

    /// Whether turns have settled of themselves.
    fn has_settled(&self) -> bool {
        self.settle.is_none() && self.stage == Stage::IsSettled
    }

    /// What it has come to, at the end of its last turn.
    pub fn end(self, turn: TurnState, wearing: &Wearing<'_>) -> Done {
        let steadiness = wearing.steadiness(self.last.as_ref(), &self.turns).collect();
        let measured = wearing.mean(&self.turns);
        let (contraction, lasting) = (self.settling.contraction(), self.settling.lasting());
        let tried =
            if self.has_settled() { self.settling.tried(self.rooms) } else { self.settling.tried_before() };
        let orbit = Orbit { turn, contraction, tried, lasting };
        Done { measured, steadiness, orbit, turns: self.turns, doubts: self.doubts }
    }
}
