//! Hand-written mechanisms for the tests: a dense adapter from textbook terms to the runtime's contract.
//! In: a [`Model`] (mass matrix, bias, constraint rows). Out: a `System<f64>` with its description.
//! Written for clarity: it allocates, and it eliminates like generated code does (no pivoting).
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod bars;
pub mod body;
pub mod journal;
pub mod others;

use linkwear_runtime::{
    CONTACT_WRENCH, Channel, ContactInfo, Description, DriverInfo, Entry, Layout, Motion, ParameterInfo,
    RowInfo, Sizes, System, VariableInfo,
};
use nalgebra::{DMatrix, DVector};
use others::by_others;

/// `mass * a + bias = rowsᵀ lambda + drive`, `rows * a = gamma`, over all coordinates.
pub struct Terms {
    pub mass: DMatrix<f64>,
    pub bias: DVector<f64>,
    pub phi: DVector<f64>,
    pub rows: DMatrix<f64>,
    pub gamma: DVector<f64>,
}

/// Start values, each with whether it is held.
pub type Start = Vec<(f64, bool)>;

/// A mechanism in textbook form.
pub trait Model {
    fn motions(&self) -> Vec<Motion>;
    /// Position, speed, acceleration of every driver.
    fn prescribed(&self, _t: f64) -> Vec<[f64; 3]> {
        Vec::new()
    }
    fn terms(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> Terms;
    /// Residuals of dropped rows.
    fn dropped(&self, _q: &[f64]) -> Vec<f64> {
        Vec::new()
    }
    fn energy(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> (f64, f64);
    fn dissipated(&self, _v: &[f64]) -> f64 {
        0.0
    }
    /// Joints with clearance.
    fn contacts(&self) -> Vec<ContactInfo> {
        Vec::new()
    }
    /// Values of `Entry::Contacts` from all coordinates and speeds.
    fn contact_motion(&self, _parameters: &[f64], _q: &[f64], _v: &[f64]) -> Vec<f64> {
        Vec::new()
    }
    /// Puts the wrenches of contacts into the bias.
    fn load(&self, _terms: &mut Terms, _wrenches: &[f64]) {}
    /// Start values of the free coordinates and speeds.
    fn start(&self) -> (Start, Start);
    /// Channel names with units and whether they wrap.
    fn channels(&self) -> Vec<(String, &'static str, bool)>;
    /// Values of the channels from all coordinates and speeds, multipliers and drive forces.
    fn observe(&self, q: &[f64], v: &[f64], multipliers: &[f64], drives: &[f64]) -> Vec<f64>;
}

/// The model as the runtime sees it, with its description.
pub struct Dense<M> {
    pub model: M,
    pub description: Description,
    layout: Layout,
    sizes: Sizes,
}

impl<M: Model> Dense<M> {
    /// `parameters`: names and defaults.
    pub fn new(model: M, parameters: &[(&str, f64)]) -> Self {
        let layout = Layout::new(&model.motions());
        let prescribed = model.prescribed(0.0);
        let defaults: Vec<f64> = parameters.iter().map(|(_, value)| *value).collect();
        let (zero_q, zero_v) = (vec![0.5; layout.all_coordinates], vec![0.0; layout.all_speeds]);
        let rows = model.terms(&defaults, &zero_q, &zero_v).phi.len();
        let dropped = model.dropped(&zero_q).len();
        let (q0, v0) = model.start();
        let variable = |prefix: &str, unit: &str, held: &[(f64, bool)]| {
            held.iter()
                .enumerate()
                .map(|(i, (_, held))| VariableInfo {
                    name: format!("{prefix}{i}").into(),
                    unit: unit.to_owned().into(),
                    held: *held,
                })
                .collect::<Vec<_>>()
        };
        let row = |i: usize| RowInfo {
            joint: format!("loop{}", i / 2).into(),
            meaning: "a translation".into(),
            angular: false,
            kept: (i < rows).then_some(i),
        };
        let channels: Vec<Channel> = model
            .channels()
            .into_iter()
            .map(|(name, unit, wraps)| Channel { name: name.into(), unit: unit.into(), wraps })
            .collect();
        let sizes = Sizes {
            parameters: parameters.len(),
            coordinates: layout.coordinates,
            speeds: layout.speeds,
            all_coordinates: layout.all_coordinates,
            all_speeds: layout.all_speeds,
            rows,
            all_rows: rows + dropped,
            drivers: prescribed.len(),
            contacts: model.contacts().len(),
            channels: channels.len(),
            ..Sizes::default()
        };
        let driver = |i| DriverInfo { joint: format!("driver{i}").into(), angular: true };
        let description = Description {
            name: "test".into(),
            parameters: parameters
                .iter()
                .map(|(name, default)| ParameterInfo {
                    name: (*name).to_owned().into(),
                    unit: "1".into(),
                    default: *default,
                })
                .collect(),
            coordinates: variable("q", "rad", &q0).into(),
            speeds: variable("v", "rad/s", &v0).into(),
            motions: model.motions().into(),
            inputs: vec![].into(),
            quaternions: vec![].into(),
            rows: (0..rows + dropped).map(row).collect(),
            drivers: (0..prescribed.len()).map(driver).collect(),
            channels: channels.into(),
            turn_driver: (!prescribed.is_empty()).then_some(0),
            contacts: model.contacts().into(),
            journals: Vec::new().into(),
            guides: Vec::new().into(),
            bends: Vec::new().into(),
            coefficients: Vec::new().into(),
            missions: Vec::new().into(),
        };
        Self { model, description, layout, sizes }
    }

    /// Default parameter values.
    pub fn parameters(&self) -> Vec<f64> {
        self.description.parameters.iter().map(|p| p.default).collect()
    }

    fn all(&self, t: f64, q: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let prescribed = self.model.prescribed(t).concat();
        let mut all = (vec![0.0; self.sizes.all_coordinates], vec![0.0; self.sizes.all_speeds]);
        self.layout.expand((q, v), &prescribed, (&mut all.0, &mut all.1));
        all
    }

    /// Places of (free, driven by driver) speeds among all speeds.
    fn places(&self) -> (Vec<usize>, Vec<usize>) {
        let mut driven = vec![0; self.sizes.drivers];
        let mut free = Vec::new();
        for group in &self.layout.groups {
            match group.motion.driver() {
                Some(driver) => driven[driver] = group.all_speed,
                None => free.extend((0..group.motion.lengths().1).map(|i| group.all_speed + i)),
            }
        }
        (free, driven)
    }

    fn forward(&self, p: &[f64], t: f64, (q, v, wrenches): (&[f64], &[f64], &[f64]), output: &mut [f64]) {
        let (all_q, all_v) = self.all(t, q, v);
        let mut terms = self.model.terms(p, &all_q, &all_v);
        self.model.load(&mut terms, wrenches);
        let (free, driven) = self.places();
        let mut a = DVector::zeros(all_v.len());
        for (law, place) in self.model.prescribed(t).iter().zip(&driven) {
            a[*place] = law[2];
        }
        let known = &terms.mass * &a + &terms.bias;
        let right = &terms.gamma - &terms.rows * &a;
        let mass = terms.mass.select_rows(&free).select_columns(&free);
        let rows = terms.rows.select_columns(&free);
        let inverse = mass.try_inverse().expect("the mass matrix is positive definite");
        let unconstrained = -&inverse * known.select_rows(&free);
        let schur = &rows * &inverse * rows.transpose();
        let (lambda, pivots) = solve_unpivoted(schur, right - &rows * &unconstrained);
        let free_a = unconstrained + inverse * rows.transpose() * &lambda;
        for (place, value) in free.iter().zip(free_a.iter()) {
            a[*place] = *value;
        }
        let balance = &terms.mass * &a + &terms.bias - terms.rows.transpose() * &lambda;
        let values = free_a.iter().chain(lambda.iter()).copied();
        let values = values.chain(driven.iter().map(|place| balance[*place])).chain(pivots);
        output.iter_mut().zip(values).for_each(|(out, value)| *out = value);
    }

    fn rates(&self, p: &[f64], t: f64, q: &[f64], v: &[f64], drives: &[f64], output: &mut [f64]) {
        let _ = p;
        for group in self.layout.free() {
            let (out, x, v) = (&mut output[group.coordinate..], &q[group.coordinate..], &v[group.speed..]);
            match group.motion {
                Motion::Scalar { .. } => out[0] = v[0],
                Motion::Rotation => out[..4].copy_from_slice(&body::quaternion_rate(x, v)),
                Motion::Pose => {
                    out[..4].copy_from_slice(&body::quaternion_rate(x, v));
                    let velocity = body::rotation(x) * nalgebra::Vector3::new(v[3], v[4], v[5]);
                    out[4..7].copy_from_slice(velocity.as_slice());
                }
            }
        }
        let laws = self.model.prescribed(t);
        output[self.sizes.coordinates] = laws.iter().zip(drives).map(|(law, force)| law[1] * force).sum();
        output[self.sizes.coordinates + 1] = self.model.dissipated(&self.all(t, q, v).1);
    }

    fn closure(&self, p: &[f64], t: f64, q: &[f64], v: &[f64], output: &mut [f64]) {
        let (all_q, all_v) = self.all(t, q, v);
        let terms = self.model.terms(p, &all_q, &all_v);
        let speeds = &terms.rows * DVector::from_column_slice(&all_v);
        let jacobian = terms.rows.select_columns(&self.places().0).transpose();
        let dropped = self.model.dropped(&all_q);
        // A column-major transpose is row major.
        let values = terms.phi.iter().chain(&dropped).chain(speeds.iter()).chain(jacobian.iter());
        output.iter_mut().zip(values).for_each(|(out, value)| *out = *value);
    }
}

/// LDLᵀ without pivoting, as generated code eliminates: solution and pivots.
fn solve_unpivoted(mut s: DMatrix<f64>, mut b: DVector<f64>) -> (DVector<f64>, Vec<f64>) {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = s[(i, k)] / s[(k, k)];
            for j in k..n {
                s[(i, j)] -= factor * s[(k, j)];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            b[k] -= s[(k, j)] * b[j];
        }
        b[k] /= s[(k, k)];
    }
    (b, (0..n).map(|k| s[(k, k)]).collect())
}

impl<M: Model> System<f64> for Dense<M> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn evaluate(&self, entry: Entry, input: &[f64], output: &mut [f64], _: &mut [f64]) {
        let (p, rest) = input.split_at(self.sizes.parameters);
        let (t, rest) = (rest[0], &rest[1..]);
        let (n, s) = (self.sizes.coordinates, self.sizes.speeds);
        let state = || (&rest[..n], &rest[n..n + s], &rest[n + s..]);
        match entry {
            Entry::Prescribed => output.copy_from_slice(&self.model.prescribed(t).concat()),
            Entry::Start => {
                let (q, v) = self.model.start();
                output.iter_mut().zip(q.iter().chain(&v)).for_each(|(out, (value, _))| *out = *value);
            }
            Entry::ForwardDynamics => self.forward(p, t, state(), output),
            Entry::Accelerations | Entry::Derivative => by_others(self, entry, input, output),
            Entry::Rates => self.rates(p, t, state().0, state().1, state().2, output),
            Entry::Closure => self.closure(p, t, state().0, state().1, output),
            Entry::Energy => {
                let (q, v) = self.all(t, state().0, state().1);
                (output[0], output[1]) = self.model.energy(p, &q, &v);
            }
            Entry::Observe => {
                let (q, v) = self.all(t, state().0, state().1);
                let (multipliers, drives) = state().2[s..].split_at(self.sizes.all_rows);
                let drives = &drives[..self.sizes.drivers];
                // Dropped rows of the models here have no share in their columns.
                let multipliers = &multipliers[..self.sizes.rows];
                output.copy_from_slice(&self.model.observe(&q, &v, multipliers, drives));
            }
            Entry::Contacts => {
                let (q, v) = self.all(t, state().0, state().1);
                output.copy_from_slice(&self.model.contact_motion(p, &q, &v));
            }
            Entry::EquationsOfMotion => {
                let (q, v) = rest.split_at(self.sizes.all_coordinates);
                let (v, wrenches) = v.split_at(self.sizes.all_speeds);
                assert_eq!(wrenches.len(), CONTACT_WRENCH * self.sizes.contacts);
                let mut terms = self.model.terms(p, q, v);
                self.model.load(&mut terms, wrenches);
                let size = v.len();
                let upper = (0..size).flat_map(|i| (i..size).map(move |j| (i, j))).map(|at| terms.mass[at]);
                let rows = terms.rows.transpose();
                // Dropped rows repeat what kept ones say, here as rows of zeros.
                let dropped = self.model.dropped(q);
                let zeros = |count: usize| std::iter::repeat_n(0.0, count);
                let values = upper.chain(terms.bias.iter().copied());
                let values = values.chain(terms.phi.iter().copied()).chain(dropped.iter().copied());
                let values = values.chain(rows.iter().copied()).chain(zeros(dropped.len() * size));
                let values = values.chain(terms.gamma.iter().copied()).chain(zeros(dropped.len()));
                output.iter_mut().zip(values).for_each(|(out, value)| *out = value);
            }
        }
    }
}
