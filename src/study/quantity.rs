//! What can be asked of a point, by name: numbers of a run and of a life. In: a mechanism's description. Out: quantities with units,
//! and their values. Never knows how runs and lives are made.

use linkwear_runtime::wear::ContactMeasure;
use linkwear_runtime::{Channel, Column, Description, Run, Statistics, channels};
use serde_json::{Value, json};

use crate::life::{LifeNumbers, LifeResult};

/// Cost and quality of a run: name, unit, value.
pub type Statistic = (&'static str, &'static str, fn(&Statistics) -> Value);

/// All of them, as `simulate` tells them.
pub const STATISTICS: [Statistic; 10] = [
    ("steps", "1", |one| json!(one.steps)),
    ("rejected", "1", |one| json!(one.rejected)),
    ("evaluations", "1", |one| json!(one.evaluations)),
    ("projections", "1", |one| json!(one.projections)),
    ("rank_revealing_solves", "1", |one| json!(one.rank_revealing_solves)),
    ("newton_iterations", "1", |one| json!(one.newton_iterations)),
    ("max_loop_error_m", "m", |one| json!(one.max_loop_error_m)),
    ("max_loop_error_rad", "rad", |one| json!(one.max_loop_error_rad)),
    ("energy_error_J", "J", |one| json!(one.energy_error_J)),
    ("energy_throughput_J", "J", |one| json!(one.energy_throughput_J)),
];

/// Name of a number of a turn of a joint with clearance: forces have their long name there.
pub fn turn_key(column: &Column) -> String {
    column.key().replace("_force", "_normal_force")
}

/// Numbers of a turn: those of every contact, then those of a journal that wears.
fn turn_columns() -> impl Iterator<Item = &'static (Column, fn(&ContactMeasure) -> f64)> {
    ContactMeasure::COLUMNS.iter().chain(&ContactMeasure::JOURNAL)
}

/// Number of a life: name behind `life.`, unit, value.
type OfLife = (&'static str, &'static str, fn(&LifeResult, &LifeNumbers) -> Option<f64>);

/// All of them, as `life` tells them.
const LIVES: [OfLife; 13] = [
    ("mean", "cycles", |_, numbers| Some(numbers.mean)),
    ("mean_error", "cycles", |_, numbers| numbers.mean_error),
    ("std", "cycles", |_, numbers| Some(numbers.std)),
    ("cov", "1", |_, numbers| Some(numbers.cov)),
    ("p10", "cycles", |_, numbers| Some(numbers.p10)),
    ("p50", "cycles", |_, numbers| Some(numbers.p50)),
    ("p90", "cycles", |_, numbers| Some(numbers.p90)),
    ("mean_whole_cycles", "cycles", |_, numbers| Some(numbers.mean_whole_cycles)),
    ("mean_path", "cycles", |life, _| Some(life.end.cycles)),
    ("revolutions", "1", |_, numbers| Some(numbers.revolutions)),
    ("hours", "h", |_, numbers| numbers.hours),
    ("table_error", "1", |life, _| life.table_error()),
    ("measurements", "1", |life, _| Some(life.measurements as f64)),
];

/// What must be run for a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// `simulate`.
    Run,
    /// `life`.
    Life,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// SI unit, or that of the name; `1` if it has none.
    pub unit: String,
    of: Of,
}

/// Columns and joints go by their names: what is folded into the equations may give a point more columns than another.
#[derive(Clone, Debug)]
enum Of {
    Statistic(usize),
    /// Largest force, or moment, of a joint.
    Peak {
        joint: String,
        moment: bool,
    },
    /// Of a column.
    Column {
        name: String,
        end: End,
    },
    /// In the last whole turn, of a joint with clearance.
    Turn {
        joint: String,
        column: usize,
    },
    Life(usize),
}

#[derive(Clone, Copy, Debug)]
enum End {
    Least,
    Most,
    /// The larger magnitude of both.
    Largest,
    Last,
}

impl Quantity {
    fn new(name: impl Into<String>, unit: &str, of: Of) -> Self {
        Self { name: name.into(), unit: unit.to_owned(), of }
    }

    /// What must be run for it.
    pub fn needs(&self) -> Needs {
        if matches!(self.of, Of::Life(_)) { Needs::Life } else { Needs::Run }
    }

    /// Its value in a run; nothing where the run has none.
    pub(super) fn of_run(&self, run: &Run, description: &Description) -> Option<f64> {
        let value = match &self.of {
            Of::Statistic(at) => STATISTICS[*at].2(&run.statistics).as_f64(),
            Of::Peak { joint, moment } => {
                let peak = run.peaks.iter().find(|peak| peak.joint == *joint)?;
                Some(if *moment { peak.moment.value } else { peak.force.value })
            }
            Of::Column { name, end } => {
                let at = run.index(name).ok()?;
                let ends = run.extremes.get(at)?;
                let (low, high) = (ends.low.value, ends.high.value);
                Some(match end {
                    End::Least => low,
                    End::Most => high,
                    End::Largest => low.abs().max(high.abs()),
                    End::Last => *run.rows.last()?.get(at)?,
                })
            }
            Of::Turn { joint, column } => {
                let at = description.contacts.iter().position(|contact| *contact.joint == **joint)?;
                let (_, value) = turn_columns().nth(*column)?;
                Some(value(run.turns.last()?.get(at)?))
            }
            Of::Life(_) => None,
        };
        value.filter(|value| value.is_finite())
    }

    /// Its value in a life; nothing where the life has none.
    pub(super) fn of_life(&self, life: &LifeResult, numbers: &LifeNumbers) -> Option<f64> {
        let Of::Life(at) = self.of else { return None };
        LIVES[at].2(life, numbers).filter(|value| value.is_finite())
    }
}

/// What there is of every column, by the word before its name.
const ENDS: [(&str, End); 3] = [("min", End::Least), ("max", End::Most), ("final", End::Last)];

/// Names for people: each, but for those that every column has, which are told as one.
pub fn listed(all: &[Quantity]) -> Vec<String> {
    let is_own = |quantity: &&Quantity| {
        !matches!(quantity.of, Of::Column { end: End::Least | End::Most | End::Last, .. })
    };
    let own = all.iter().filter(is_own).map(|quantity| quantity.name.clone());
    own.chain(ENDS.map(|(word, _)| format!("{word}.COLUMN"))).collect()
}

/// All that a mechanism has.
pub fn quantities(description: &Description) -> Vec<Quantity> {
    let columns = channels(description);
    let mut all = Vec::new();
    for (contact, info) in description.contacts.iter().enumerate() {
        let wears = description.journal_ratio(contact).is_some();
        let count = if wears { usize::MAX } else { ContactMeasure::COLUMNS.len() };
        for (at, (column, _)) in turn_columns().enumerate().take(count) {
            let (name, joint) = (format!("{}.{}", info.joint, turn_key(column)), info.joint.to_string());
            all.push(Quantity::new(name, column.unit, Of::Turn { joint, column: at }));
        }
    }
    let of_column = |word: &str, column: &Channel, end: End| {
        let of = Of::Column { name: column.name.to_string(), end };
        Quantity::new(format!("{word}.{}", column.name), &column.unit, of)
    };
    for joint in columns.iter().filter_map(|column| column.name.strip_suffix(".Fx")) {
        for (load, unit, moment) in [("F", "N", false), ("M", "N m", true)] {
            let of = Of::Peak { joint: joint.to_owned(), moment };
            all.push(Quantity::new(format!("peak.{joint}.{load}"), unit, of));
        }
    }
    let drives = columns.iter().filter(|column| column.name.ends_with(".drive"));
    all.extend(drives.map(|column| of_column("peak", column, End::Largest)));
    if description.contacts.iter().any(|contact| contact.wear.is_some()) {
        let lives = LIVES.iter().enumerate();
        all.extend(
            lives.map(|(at, (name, unit, _))| Quantity::new(format!("life.{name}"), unit, Of::Life(at))),
        );
    }
    let statistics = STATISTICS.iter().enumerate();
    all.extend(statistics.map(|(at, (name, unit, _))| Quantity::new(*name, unit, Of::Statistic(at))));
    for column in &columns {
        let ends = ENDS.map(|(word, end)| of_column(word, column, end));
        all.extend(ends);
    }
    all
}

/// The one of this name.
pub fn named<'q>(name: &str, all: &'q [Quantity]) -> Option<&'q Quantity> {
    all.iter().find(|quantity| quantity.name == name)
}
