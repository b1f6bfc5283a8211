//! Derivatives of what settled turns wear. In: turns with tangents, where the motion is. Out: wear and its tangents, once later turns
//! would have the same. Never knows lives.
//!
//! Nothing is solved for: tangents settle as fast as the motion itself. Those of a motion that never settles grow from turn to turn,
//! which is how it is recognised.

use linkwear_runtime::TurnState;
use linkwear_runtime::clearance_joint::ClearanceState;

use super::tangents::Varied;
use super::turn::{State, TooLong, Touch, Turned, Turns};

/// Tangents by the logarithms of parameters have settled when later turns would change them by no more than this part of the wear.
const SETTLED: f64 = 1e-8;
/// Where gaps close now in this step, now in the next, nothing settles quite: after so many turns changes of this size are taken, which
/// the doubts of derivatives tell.
const JITTER: (u32, f64) = (20, 1e-4);
/// Turns at most.
const MOST_TURNS: u32 = 60;
/// Tangents that have grown to this times the wear do not settle.
const GROWN: f64 = 1e14;

/// Directions that are run side by side, and where their tangents were.
pub(super) struct Pass<const N: usize> {
    pub turns: Turns<N>,
    /// Tangents where the motion last began: of coordinates and speeds, of the speeds at which gaps closed.
    tangents: Vec<[f64; N]>,
    /// Tangents of how far clearances have grown [m], joint by joint.
    pub grown: Vec<[f64; N]>,
}

/// A settled turn.
#[derive(Clone, Debug)]
pub(super) struct Settled<const N: usize> {
    pub turned: Turned<N>,
    pub turns: u32,
}

/// Why there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unsettled {
    /// Steps are too long.
    TooLong,
    /// After so many turns the last change was this.
    Never(u32, f64),
}

impl From<TooLong> for Unsettled {
    fn from(_: TooLong) -> Self {
        Self::TooLong
    }
}

impl<const N: usize> Pass<N> {
    pub(super) fn new(turns: Turns<N>, state: usize) -> Self {
        Self { turns, tangents: vec![[0.0; N]; state], grown: Vec::new() }
    }

    /// Where a motion is, with tangents as far as they are known.
    fn state(&mut self, at: &TurnState) -> State<N> {
        let varied = |(value, tangents): (&f64, &[f64; N])| Varied { value: *value, tangents: *tangents };
        let grown = at.joints.iter().enumerate().map(|(joint, state)| {
            let tangents = self.grown.get(joint).copied().unwrap_or([0.0; N]);
            Varied { value: state.worn, tangents }
        });
        self.turns.wear(grown);
        let flat = at.q.iter().chain(&at.v).zip(&self.tangents).map(varied).collect();
        let touch = |(joint, tangents): (&ClearanceState, &[f64; N])| Touch {
            is_touching: joint.memory.touching > 0.5,
            closing_speed: varied((&joint.memory.closing_speed, tangents)),
            before: None,
        };
        let contacts = at.joints.iter().zip(&self.tangents[at.q.len() + at.v.len()..]).map(touch).collect();
        State { t: at.t, flat, contacts }
    }

    /// A single turn from there, in so many steps.
    pub(super) fn once(&mut self, at: &TurnState, steps: u64) -> Result<Turned<N>, TooLong> {
        let mut state = self.state(at);
        self.turns.run(&mut state, steps)
    }

    /// Turns from there until later ones would be the same; `wearing`: places of the joints that wear.
    pub(super) fn settle(
        &mut self,
        at: &TurnState,
        steps: u64,
        wearing: &[usize],
    ) -> Result<Settled<N>, Unsettled> {
        let mut state = self.state(at);
        let (mut last, mut before): (Option<Turned<N>>, Option<f64>) = (None, None);
        for turns in 1..=MOST_TURNS {
            let memories = state.contacts.iter().map(|touch| &touch.closing_speed);
            let begin: Vec<[f64; N]> = state.flat.iter().chain(memories).map(|one| one.tangents).collect();
            let turned = self.turns.run(&mut state, steps)?;
            let change = last.as_ref().map(|last| change(last, &turned, wearing));
            if let Some(change) = change {
                // What settles by a factor a turn leaves this over the factor's distance from one.
                let factor = before.map_or(1.0, |before| (change / before).min(1.0));
                let is_settled = factor < 1.0 && change * factor / (1.0 - factor) <= SETTLED;
                if change <= SETTLED || is_settled || (turns >= JITTER.0 && change <= JITTER.1) {
                    self.tangents = begin;
                    return Ok(Settled { turned, turns });
                }
                if change.is_nan() || change >= GROWN || turns == MOST_TURNS {
                    return Err(Unsettled::Never(turns, change));
                }
            }
            (last, before) = (Some(turned), change);
        }
        Err(Unsettled::Never(MOST_TURNS, f64::INFINITY))
    }
}

/// By how much of the wear a turn differs from the one before, in wear or tangents, where that is most.
fn change<const N: usize>(last: &Turned<N>, now: &Turned<N>, wearing: &[usize]) -> f64 {
    let of = |joint: &usize| {
        let pairs = last.wear[*joint].iter().zip(&now.wear[*joint]);
        pairs.map(|(last, now)| difference(last, now)).fold(0.0, f64::max)
    };
    wearing.iter().map(of).fold(0.0, f64::max)
}

/// The same of one number; what is no number differs without end.
fn difference<const N: usize>(last: &Varied<N>, now: &Varied<N>) -> f64 {
    let tangents = last.tangents.iter().zip(&now.tangents).map(|(last, now)| (now - last).abs());
    let most =
        tangents.fold((now.value - last.value).abs(), |most, one| if one <= most { most } else { one });
    if most == 0.0 { 0.0 } else { most / now.value.abs() }
}
