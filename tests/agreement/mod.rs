//! Recorded rows against the independent model (crate `linkwear-oracle`): the oracle is put into each state by the output
//! columns, and must see the same accelerations, drive forces, joint wrenches (where unique) and energies.

use linkwear_codegen::id::JointId;
use linkwear_oracle::{BodyState, Oracle};

/// States nearer to a singular position (smallest singular value of the oracle's rows) are not compared.
const CONDITION: f64 = 2e-3;
/// Last places of the accelerations by loads alone, over the smallest singular value, that the oracle's own may be off: it takes
/// sums over all rows, of some ten last places each, and carries them from body to body. Beside a gravity of 1e12 m/s^2, which no
/// driven linkage feels, that is all the oracle tells.
const ROUNDING: f64 = 100.0 * f64::EPSILON;

/// Two numbers that should be equal.
struct Entry {
    name: String,
    ours: f64,
    theirs: f64,
    /// On which to judge them.
    scale: f64,
    /// What the oracle's number may be off by.
    rounding: f64,
}

/// Pairs of numbers that should be equal.
#[derive(Default)]
pub struct Ledger {
    entries: Vec<Entry>,
}

impl Ledger {
    fn add(&mut self, name: String, ours: f64, theirs: f64, scale: f64) {
        self.entries.push(Entry { name, ours, theirs, scale, rounding: 0.0 });
    }

    /// The pair that differs most, as a share of one and its scale, with what it is. `forgiven` is the part of the oracle's own
    /// rounding that counts as no difference: loads out of all proportion make it large.
    pub fn worst(&self, forgiven: f64) -> Option<(String, f64)> {
        let error = |entry: &Entry| {
            let Entry { name, ours, theirs, scale, rounding } = entry;
            let error = ((ours - theirs).abs() - forgiven * rounding).max(0.0) / (1.0 + scale);
            let is_number = !ours.is_nan() && !theirs.is_nan();
            (
                format!("{name}: {ours} against the oracle's {theirs}"),
                if is_number { error } else { f64::INFINITY },
            )
        };
        self.entries.iter().map(error).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn compare_sample(oracle: &Oracle, t: f64, column: &dyn Fn(&str) -> Option<f64>, ledger: &mut Ledger) {
    let states = oracle.states_from(column).expect("columns reach every body");
    let largest = |part: &dyn Fn(&BodyState) -> f64| states.iter().map(part).fold(0.0, f64::max);
    let size = largest(&|state| state.centre.amax());
    let speed = largest(&|state| state.velocity.amax().max(state.omega.amax()));
    ledger.add(format!("t = {t}: open loops"), 0.0, oracle.constraint_residual(t, &states), size);
    ledger.add(format!("t = {t}: open speeds"), 0.0, oracle.velocity_residual(t, &states), speed);
    let solution = oracle.accelerations(t, &states);
    if solution.smallest_kept < CONDITION {
        return;
    }
    let scale = solution.alpha.iter().chain(&solution.acceleration).fold(0.0, |s: f64, a| s.max(a.amax()));
    let rounding = ROUNDING * solution.unconstrained / solution.smallest_kept;
    let force = solution.wrenches.iter().fold(0.0, |s: f64, w| s.max(w.force.amax()).max(w.moment.amax()));
    let mut drives = solution.drives.iter();
    for (index, joint) in oracle.mechanism.joints.iter().enumerate() {
        let name = &joint.name;
        let accelerations = oracle.joint_accelerations(JointId::new(index), &states, &solution);
        let several = accelerations.len() > 1;
        let suffix = |k: usize| if several { (k + 1).to_string() } else { String::new() };
        for (k, theirs) in accelerations.iter().enumerate() {
            let label = format!("{name}.a{}", suffix(k));
            let (name, ours) = (format!("t = {t}: {label}"), column(&label).unwrap_or(f64::NAN));
            ledger.entries.push(Entry { name, ours, theirs: *theirs, scale, rounding });
        }
        for drive in &joint.drives {
            let label = format!("{name}.drive{}", suffix(drive.coordinate));
            let theirs = *drives.next().expect("one force per drive");
            ledger.add(format!("t = {t}: {label}"), column(&label).unwrap_or(f64::NAN), theirs, force);
        }
        let wrench = &solution.wrenches[index];
        let theirs: Vec<f64> = wrench.force.iter().chain(&wrench.moment).copied().collect();
        for (k, part) in ["Fx", "Fy", "Fz", "Mx", "My", "Mz"].into_iter().enumerate() {
            if wrench.unique[k] {
                let label = format!("{name}.{part}");
                ledger.add(format!("t = {t}: {label}"), column(&label).unwrap_or(f64::NAN), theirs[k], force);
            }
        }
    }
    let kinetic = oracle.kinetic_energy(&states);
    ledger.add(format!("t = {t}: T"), column("energy.kinetic").unwrap_or(f64::NAN), kinetic, kinetic);
}

/// Compares rows at their times; potential energies up to their constant.
pub fn compare<'a>(
    oracle: &Oracle,
    rows: impl Iterator<Item = (f64, &'a [f64])>,
    index: &dyn Fn(&str) -> Option<usize>,
) -> Ledger {
    let mut ledger = Ledger::default();
    let mut offset = None;
    for (t, row) in rows {
        let column = |name: &str| index(name).map(|index| row[index]);
        compare_sample(oracle, t, &column, &mut ledger);
        let states = oracle.states_from(&column).expect("columns reach every body");
        let (ours, theirs) =
            (column("energy.potential").unwrap_or(f64::NAN), oracle.potential_energy(t, &states));
        let offset = *offset.get_or_insert(ours - theirs);
        ledger.add(format!("t = {t}: V"), ours - offset, theirs, theirs.abs() + ours.abs());
    }
    ledger
}
