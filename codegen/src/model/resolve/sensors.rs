//! Sensors: formulas with names, which stand for them wherever all of them may stand.

use super::quantity::{Allowed, Here, Resolved};
use super::resolver::{Resolver, place};
use crate::diagnostic::Code;
use crate::model;
use crate::spec::{Sensor, Table};

impl Resolver<'_> {
    /// Their formulas, from the first on: each may use those above it.
    pub(super) fn resolve_sensors(&mut self, table: &Table<Sensor>) {
        for (name, sensor) in &table.0 {
            let formula = sensor
                .value
                .value()
                .map(|value| self.formula(value, None, Allowed::STATE, &place("value", "sensor", name)));
            if formula.is_none() {
                let message = format!("the sensor `{}` has no value", name.value);
                self.missing(sensor.span, name.span, Code::MissingKey, message)
                    .help(r#"add `value = "..."`, a formula"#);
            }
            self.sensors.push(formula);
            self.sensor_turning
                .push(sensor.value.value().map(|value| self.turns_of(value).of).unwrap_or_default());
        }
    }

    /// What the name of a sensor stands for.
    pub(super) fn sensor_term(&mut self, name: &str, at: usize, here: Here<'_>) -> Resolved {
        match self.sensors.get(at) {
            Some(known) => {
                let formula = known.as_ref()?;
                // One that is wrong is reported there.
                let wrong = matches!(&formula.term, model::Term::Number(value) if value.is_nan());
                (!wrong).then(|| (formula.term.clone(), formula.dimension))
            }
            None => {
                self.refuse_in(
                    here,
                    Code::WrongKindOfName,
                    &format!("the sensor `{name}` comes later in the file"),
                )
                .help("a sensor can use those above it; move it up");
                None
            }
        }
    }

    /// All of them, for columns.
    pub(super) fn take_sensors(&mut self, table: &Table<Sensor>) -> Vec<model::Sensor> {
        let values =
            std::mem::take(&mut self.sensors).into_iter().zip(std::mem::take(&mut self.sensor_turning));
        let named = table.0.iter().zip(values);
        named
            .filter_map(|((name, _), (value, turning))| {
                Some(model::Sensor { name: name.value.clone(), value: value?, turning })
            })
            .collect()
    }
}
