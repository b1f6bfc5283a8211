//! State variables of the file's own among coordinates and speeds.
//! A state is a speed, its rate the acceleration and its integral the coordinate: all integrators take it as they take motion.
//! They stand behind all others.

use crate::expr::{Expr, Scope};
use crate::model::Mechanism;
use crate::spec::Dimension;

/// A state as symbols.
pub struct OwnState<'g> {
    pub integral: Expr<'g>,
    pub value: Expr<'g>,
    /// Its rate, handed in where the columns are made.
    pub rate: Expr<'g>,
}

/// Symbols of all states.
pub fn own_states<'g>(g: &'g Scope, mechanism: &Mechanism) -> Vec<OwnState<'g>> {
    let state = |name: String| OwnState {
        integral: g.symbol(format!("{name}_integral")),
        value: g.symbol(&*name),
        rate: g.symbol(format!("{name}_rate")),
    };
    mechanism.states.iter().map(|state_variable| state(state_variable.name.replace('.', "_"))).collect()
}

/// Unit of the value over a power of time.
pub(super) fn unit(dimension: Dimension, seconds: i32) -> String {
    let mut unit = Some(dimension);
    for _ in 0..seconds.abs() {
        unit =
            unit.and_then(
                |unit| {
                    if seconds > 0 { unit.times(Dimension::TIME) } else { unit.over(Dimension::TIME) }
                },
            );
    }
    unit.map(Dimension::si_unit).unwrap_or_default()
}
