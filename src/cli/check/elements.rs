//! What `check` says of couplings, stops, states and sensors, as they were read. In: a mechanism. Out: tables, entries for machines.

use std::fmt::Write as _;

use linkwear_codegen::id::JointId;
use linkwear_codegen::model::{Coupling, Formula, Mechanism, Stop, StopLoss};

use super::super::answer::check::{CoupledAnswer, CouplingAnswer, SensorAnswer, StateAnswer, StopAnswer};
use super::super::table::short_table;
use super::unit::unit;
use crate::number::number;

/// A mechanism with the values of its parameters.
pub struct Elements<'a> {
    mechanism: &'a Mechanism,
    values: Vec<f64>,
}

impl<'a> Elements<'a> {
    pub fn of(mechanism: &'a Mechanism) -> Self {
        Self { mechanism, values: mechanism.parameter_values() }
    }

    fn value(&self, formula: &Formula) -> Option<f64> {
        formula.value(&self.values)
    }

    /// A joint coordinate as formulas name it.
    fn coordinate(&self, joint: JointId, coordinate: usize) -> String {
        let joint = self.mechanism.joint(joint);
        match joint.model.coordinates().len() {
            1 => format!("{}.q", joint.name),
            _ => format!("{}.q{}", joint.name, coordinate + 1),
        }
    }

    pub fn couplings(&self) -> Vec<CouplingAnswer<'a>> {
        let answer = |coupling: &'a Coupling| CouplingAnswer {
            name: &coupling.name,
            kind: coupling.kind,
            terms: coupling
                .terms
                .iter()
                .map(|term| CoupledAnswer {
                    coordinate: self.coordinate(term.joint, term.coordinate),
                    factor: self.value(&term.factor),
                })
                .collect(),
            offset: self.value(&coupling.offset),
            unit: length_or_angle(coupling.angular),
            rigid: coupling.compliance.is_none(),
        };
        self.mechanism.couplings.iter().map(answer).collect()
    }

    pub fn stops(&self) -> Vec<StopAnswer<'a>> {
        let limit = |limit: &Option<Formula>| limit.as_ref().and_then(|limit| self.value(limit));
        let answer = |stop: &'a Stop| StopAnswer {
            name: &stop.name,
            coordinate: self.coordinate(stop.joint, stop.coordinate),
            lower: limit(&stop.limits[0]),
            upper: limit(&stop.limits[1]),
            unit: length_or_angle(stop.angular),
            stiffness: self.value(&stop.stiffness),
            loss: match stop.loss {
                StopLoss::None => "none",
                StopLoss::Damping(_) => "damping",
                StopLoss::Hysteresis { .. } => "restitution",
                StopLoss::BySpeed { .. } => "law",
            },
        };
        self.mechanism.stops.iter().map(answer).collect()
    }

    pub fn states(&self) -> Vec<StateAnswer<'a>> {
        let states = self.mechanism.states.iter();
        let answer = states.map(|state| StateAnswer {
            name: &state.name,
            initial: self.value(&state.initial),
            unit: unit(state.initial.dimension),
        });
        answer.collect()
    }

    pub fn sensors(&self) -> Vec<SensorAnswer<'a>> {
        let sensors = self.mechanism.sensors.iter();
        let answer =
            sensors.map(|sensor| SensorAnswer { name: &sensor.name, unit: unit(sensor.value.dimension) });
        answer.collect()
    }

    /// A table of each, where there are any.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut add = |title: &str, head: &[&str], rows: Vec<Vec<String>>| {
            if !rows.is_empty() {
                let _ = write!(text, "\n{title}\n{}", short_table(head, rows));
            }
        };
        let shown = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), number);
        let rows = self.couplings().into_iter().map(|coupling| {
            let terms =
                coupling.terms.iter().map(|term| format!("{} {}", shown(term.factor), term.coordinate));
            let sum = terms.collect::<Vec<_>>().join(" + ").replace("+ -", "- ");
            let end = if coupling.rigid { "" } else { "gives way" };
            let equation = format!("{sum} = {} {}", shown(coupling.offset), coupling.unit);
            vec![coupling.name.to_owned(), coupling.kind.to_owned(), equation, end.to_owned()]
        });
        add("Couplings", &["name", "kind", "", ""], rows.collect());
        let rows = self.stops().into_iter().map(|stop| {
            let [lower, upper] = [stop.lower, stop.upper].map(shown);
            let of = stop.coordinate.clone();
            vec![stop.name.to_owned(), of, lower, upper, stop.unit.to_owned(), stop.loss.to_owned()]
        });
        add("Stops", &["name", "of", "lower", "upper", "unit", "loss"], rows.collect());
        let rows = self
            .states()
            .into_iter()
            .map(|state| vec![state.name.to_owned(), shown(state.initial), state.unit]);
        add("States", &["name", "initial", "unit"], rows.collect());
        let rows = self.sensors().into_iter().map(|sensor| vec![sensor.name.to_owned(), sensor.unit]);
        add("Sensors", &["name", "unit"], rows.collect());
        text
    }
}

const fn length_or_angle(angular: bool) -> &'static str {
    if angular { "rad" } else { "m" }
}
