//! Numbers by which a tool asks for values, and what is behind them. In: a unit, its columns. Out: [`Variables`].

use linkwear_runtime::Channel;

use crate::unit::Unit;

/// What a value reference stands for; indices are those of the description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// The independent variable.
    Time,
    /// A tunable parameter of the file; behind them the inputs.
    Parameter(usize),
    /// An output column.
    Output(usize),
    /// A free coordinate, then a free speed.
    State(usize),
    /// Its derivative.
    Derivative(usize),
    /// Penetration of a joint with clearance.
    Indicator(usize),
    /// A number that generation folded into the equations.
    Constant(usize),
}

/// All variables of a unit; their references count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variables {
    parameters: usize,
    outputs: usize,
    states: usize,
    indicators: usize,
    constants: usize,
}

impl Variables {
    /// Those of a unit whose columns are `channels`.
    pub fn new(unit: &Unit, channels: &[Channel]) -> Self {
        let description = unit.program.description();
        Self {
            parameters: description.parameters.len(),
            outputs: channels.len(),
            states: description.coordinates.len() + description.speeds.len(),
            indicators: description.contacts.len(),
            constants: unit.constants.len(),
        }
    }

    /// Numbers of kinds, in the order of their references.
    const fn counts(&self) -> [usize; 7] {
        [1, self.parameters, self.outputs, self.states, self.states, self.indicators, self.constants]
    }

    /// The variable behind a reference.
    pub fn get(&self, reference: u32) -> Option<Variable> {
        const KINDS: [fn(usize) -> Variable; 7] = [
            |_| Variable::Time,
            Variable::Parameter,
            Variable::Output,
            Variable::State,
            Variable::Derivative,
            Variable::Indicator,
            Variable::Constant,
        ];
        let mut rest = reference as usize;
        for (count, kind) in self.counts().into_iter().zip(KINDS) {
            if rest < count {
                return Some(kind(rest));
            }
            rest -= count;
        }
        None
    }

    /// The reference of a variable.
    pub fn reference(&self, variable: Variable) -> u32 {
        let (kind, index) = match variable {
            Variable::Time => (0, 0),
            Variable::Parameter(index) => (1, index),
            Variable::Output(index) => (2, index),
            Variable::State(index) => (3, index),
            Variable::Derivative(index) => (4, index),
            Variable::Indicator(index) => (5, index),
            Variable::Constant(index) => (6, index),
        };
        let before: usize = self.counts().iter().take(kind).sum();
        u32::try_from(before + index).unwrap_or(u32::MAX)
    }

    /// Every variable, in the order of their references.
    pub fn all(&self) -> impl Iterator<Item = (u32, Variable)> + '_ {
        (0..).map_while(|reference| self.get(reference).map(|variable| (reference, variable)))
    }

    /// Number of states.
    pub const fn states(&self) -> usize {
        self.states
    }

    /// Number of event indicators.
    pub const fn indicators(&self) -> usize {
        self.indicators
    }
}
