//! End stops: how deep a coordinate is in one, and what pushes it out. In: coordinates. Out: [`Pressed`].
//! Never knows joints.
//!
//! With the depth d and the elastic force `F_e = k d (d/d_0)^(n-1)`, `V = F_e d/(n+1)`, and
//!   viscous     F = max(0, F_e + c d')
//!   by speed    F = F_e max(0, 1 + chi d'/v_0)
//!   hysteresis  F = F_e ((1 + e²)/2 + (1 - e²)/2 d'/sqrt(d'² + v_f²)), and of `V` the mean, (1 + e²)/2, is stored.
//! Outside of all stops F is zero. What is neither stored nor given back is lost: never less than zero.

use crate::expr::{Expr, Scope};
use crate::model::{Stop, StopLoss};

use super::joint_state::JointStates;

/// What a stop does at an instant.
pub struct Pressed<'g> {
    /// How far the coordinate is beyond the limit [rad] or [m]; zero outside.
    pub depth: Expr<'g>,
    /// Force along the coordinate [N m] or [N].
    pub force: Expr<'g>,
    /// Energy stored [J].
    pub stored: Expr<'g>,
    /// Power lost [W].
    pub dissipated: Expr<'g>,
}

/// What a stop does whose coordinate has this position and speed.
pub fn pressed<'g>(
    g: &'g Scope,
    state: &JointStates<'g>,
    stop: &Stop,
    [position, speed]: [Expr<'g>; 2],
) -> Pressed<'g> {
    let against = |gap, rate| Pressed::against(g, state, stop, gap, rate);
    let [lower, upper] =
        stop.limits.each_ref().map(|limit| limit.as_ref().map(|limit| state.lower(g, limit)));
    match (lower, upper) {
        (None, None) => Pressed { depth: g.zero(), force: g.zero(), stored: g.zero(), dissipated: g.zero() },
        (Some(lower), None) => against(lower - position, -speed).reversed(),
        (None, Some(upper)) => against(position - upper, speed),
        (Some(lower), Some(upper)) => {
            // The nearer one alone can touch, and half way between them neither does: no step has to end there.
            let is_low = position - 0.5 * (lower + upper);
            is_low.keep_quiet();
            let gap = is_low.below_zero(lower - position, position - upper);
            let one = against(gap, is_low.below_zero(-speed, speed));
            Pressed { force: is_low.below_zero(-one.force, one.force), ..one }
        }
    }
}

impl<'g> Pressed<'g> {
    /// Of a stop that is `gap` behind the coordinate, which goes on into it at `rate`.
    fn against(g: &'g Scope, state: &JointStates<'g>, stop: &Stop, gap: Expr<'g>, rate: Expr<'g>) -> Self {
        let (zero, one) = (g.zero(), g.number(1.0));
        let outside = -gap;
        // `outside` is below zero where they touch.
        let depth = outside.below_zero(gap, zero);
        let stiffness = state.lower(g, &stop.stiffness);
        let (elastic, share) = match stop.power {
            None => (stiffness * depth, 0.5),
            Some((exponent, unit)) => {
                // Apart, a depth of one unit keeps roots and logarithms finite.
                let ratio = outside.below_zero((1.0 / unit) * gap, one);
                let whole = (unit * stiffness) * power(ratio, exponent);
                (outside.below_zero(whole, zero), 1.0 / (exponent + 1.0))
            }
        };
        let stored = share * (elastic * depth);
        let (force, stored, dissipated) = match &stop.loss {
            StopLoss::None => (elastic, stored, zero),
            StopLoss::Damping(damping) => {
                let pushed = outside.below_zero(elastic + state.lower(g, damping) * rate, zero);
                let force = pushed.below_zero(zero, pushed);
                (force, stored, (force - elastic) * rate)
            }
            StopLoss::BySpeed { factor, impact_speed } => {
                // Only where they touch: elsewhere no step has to end where this would change its sign.
                let damped = one + *factor * (rate / state.lower(g, impact_speed));
                let damped = outside.below_zero(damped, zero);
                let force = elastic * damped.below_zero(zero, damped);
                (force, stored, (force - elastic) * rate)
            }
            StopLoss::Hysteresis { returned, floor } => {
                let floor = state.lower(g, floor);
                let sign = rate / (rate.square() + floor.square()).sqrt();
                let (mean, half) = (0.5 * (1.0 + returned), 0.5 * (1.0 - returned));
                let lost = half * (elastic * sign);
                (mean * elastic + lost, mean * stored, lost * rate)
            }
        };
        Self { depth, force: -force, stored, dissipated }
    }

    /// The same from the other side.
    fn reversed(self) -> Self {
        Self { force: -self.force, ..self }
    }
}

/// `base ^ exponent` of a base above zero; by roots for halves.
fn power(base: Expr<'_>, exponent: f64) -> Expr<'_> {
    let halves = 2.0 * exponent;
    // Above that exponentials are as short.
    if halves.fract() != 0.0 || halves > 12.0 {
        return (exponent * base.ln()).exp();
    }
    #[allow(clippy::cast_possible_truncation, reason = "a whole number up to 6")]
    let whole = base.powi(exponent.floor() as i32);
    if exponent.fract() == 0.0 { whole } else { whole * base.sqrt() }
}
