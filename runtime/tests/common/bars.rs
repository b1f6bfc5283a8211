//! Planar mechanisms of uniform bars with absolute angles, from +x counterclockwise; gravity in -y.
//! Pendulums, four-bars and chains of them are lists of bars and loops. The first bar may turn in a bearing with
//! clearance, whose offset is the last two coordinates. Parameter 0: gravity [m/s²], 1: that clearance [m].

use super::{Model, Start, Terms};
use linkwear_runtime::{ContactInfo, Motion};
use nalgebra::{DMatrix, DVector};

/// Where a bar begins or a loop ends.
#[derive(Clone, Copy)]
pub enum At {
    Ground(f64, f64),
    End(usize),
}

/// Prescribed position, speed, acceleration as a function of time.
pub type Law = fn(f64) -> [f64; 3];

/// A uniform bar.
#[derive(Clone)]
pub struct Bar {
    pub from: At,
    pub length: f64,
    pub mass: f64,
    /// Damping against ground [N m s/rad].
    pub damping: f64,
    pub law: Option<Law>,
    pub start: (f64, bool),
    pub speed: (f64, bool),
}

impl Bar {
    /// An undamped bar of 1 m and 1 kg.
    pub fn unit(from: At, angle: f64, speed: f64) -> Self {
        Self {
            from,
            length: 1.0,
            mass: 1.0,
            damping: 0.0,
            law: None,
            start: (angle, false),
            speed: (speed, false),
        }
    }
}

/// Bars (parents first) and loops: the end of a bar stays at a place.
#[derive(Clone, Default)]
pub struct Bars {
    pub bars: Vec<Bar>,
    pub loops: Vec<(usize, At)>,
    /// Offset of a dropped row that repeats the first kept one; 0 is consistent.
    pub redundant: Option<f64>,
    /// Clearance between the first bar and its place on the ground.
    pub bearing: Option<ContactInfo>,
}

impl Bars {
    fn chain(&self, place: At) -> Vec<usize> {
        let mut chain = Vec::new();
        let mut place = place;
        while let At::End(bar) = place {
            chain.push(bar);
            place = self.bars[bar].from;
        }
        chain
    }

    /// Position of a place.
    pub fn position(&self, place: At, q: &[f64]) -> [f64; 2] {
        match place {
            At::Ground(x, y) => [x, y],
            At::End(0) if self.bearing.is_some() => {
                let [x, y] = self.position(self.bars[0].from, q);
                let (n, length) = (self.bars.len(), self.bars[0].length);
                [x + q[n] + length * q[0].cos(), y + q[n + 1] + length * q[0].sin()]
            }
            At::End(bar) => {
                let [x, y] = self.position(self.bars[bar].from, q);
                [x + self.bars[bar].length * q[bar].cos(), y + self.bars[bar].length * q[bar].sin()]
            }
        }
    }

    /// (bar, arm) pairs whose directions add up to the centre of `bar`.
    fn arms(&self, bar: usize) -> Vec<(usize, f64)> {
        let mut arms = vec![(bar, 0.5 * self.bars[bar].length)];
        arms.extend(self.chain(self.bars[bar].from).into_iter().map(|i| (i, self.bars[i].length)));
        arms
    }

    /// Whether a place moves with the first bar in a bearing.
    fn floats(&self, place: At) -> bool {
        self.bearing.is_some() && self.chain(place).last() == Some(&0)
    }

    /// Terms of the offset of the bearing.
    fn add_offset(&self, gravity: f64, q: &[f64], v: &[f64], terms: &mut Terms) {
        let (x, y) = (self.bars.len(), self.bars.len() + 1);
        for (bar, data) in self.bars.iter().enumerate().filter(|(bar, _)| self.floats(At::End(*bar))) {
            terms.mass[(x, x)] += data.mass;
            terms.mass[(y, y)] += data.mass;
            terms.bias[y] += data.mass * gravity;
            for (i, a) in self.arms(bar) {
                let arm = data.mass * a;
                for (axis, direction) in [(x, -q[i].sin()), (y, q[i].cos())] {
                    terms.mass[(i, axis)] += arm * direction;
                    terms.mass[(axis, i)] += arm * direction;
                }
                terms.bias[x] -= arm * q[i].cos() * v[i] * v[i];
                terms.bias[y] -= arm * q[i].sin() * v[i] * v[i];
            }
        }
        for (k, (bar, target)) in self.loops.iter().enumerate() {
            for (place, sign) in [(At::End(*bar), 1.0), (*target, -1.0)] {
                if self.floats(place) {
                    terms.rows[(2 * k, x)] += sign;
                    terms.rows[(2 * k + 1, y)] += sign;
                }
            }
        }
    }

    fn laws(&self) -> impl Iterator<Item = Law> + '_ {
        self.bars.iter().filter_map(|bar| bar.law)
    }
}

impl Model for Bars {
    fn motions(&self) -> Vec<Motion> {
        let mut drivers = 0..;
        let motion = |bar: &Bar| Motion::Scalar { driver: bar.law.and_then(|_| drivers.next()) };
        let offset = self.bearing.iter().flat_map(|_| [Motion::Scalar { driver: None }; 2]);
        self.bars.iter().map(motion).chain(offset).collect()
    }

    fn contacts(&self) -> Vec<ContactInfo> {
        self.bearing.iter().cloned().collect()
    }

    fn contact_motion(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> Vec<f64> {
        let n = self.bars.len();
        let values = |_: &_| [q[n], q[n + 1], 0.0, v[n], v[n + 1], 0.0, 0.0, 0.0, v[0], parameters[1]];
        self.bearing.iter().flat_map(values).collect()
    }

    fn load(&self, terms: &mut Terms, wrenches: &[f64]) {
        if let [fx, fy, _, _, _, moment] = wrenches {
            let n = self.bars.len();
            terms.bias[n] -= fx;
            terms.bias[n + 1] -= fy;
            terms.bias[0] -= moment;
        }
    }

    fn prescribed(&self, t: f64) -> Vec<[f64; 3]> {
        self.laws().map(|law| law(t)).collect()
    }

    fn terms(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> Terms {
        let (n, m) = (q.len(), 2 * self.loops.len());
        let mut terms = Terms {
            mass: DMatrix::zeros(n, n),
            bias: DVector::zeros(n),
            phi: DVector::zeros(m),
            rows: DMatrix::zeros(m, n),
            gamma: DVector::zeros(m),
        };
        for (bar, data) in self.bars.iter().enumerate() {
            let arms = self.arms(bar);
            terms.mass[(bar, bar)] += data.mass * data.length * data.length / 12.0;
            terms.bias[bar] += data.damping * v[bar];
            for (i, a) in &arms {
                terms.bias[*i] += data.mass * parameters[0] * a * q[*i].cos();
                for (j, b) in &arms {
                    // Directions (-sin, cos); centripetal terms pull along (-cos, -sin).
                    terms.mass[(*i, *j)] += data.mass * a * b * (q[*i] - q[*j]).cos();
                    terms.bias[*i] += data.mass * a * b * (q[*i] - q[*j]).sin() * v[*j] * v[*j];
                }
            }
        }
        for (k, (bar, target)) in self.loops.iter().enumerate() {
            let (end, goal) = (self.position(At::End(*bar), q), self.position(*target, q));
            let own = self.chain(At::End(*bar)).into_iter().map(|i| (i, 1.0));
            let other = self.chain(*target).into_iter().map(|i| (i, -1.0));
            for axis in 0..2 {
                terms.phi[2 * k + axis] = end[axis] - goal[axis];
            }
            for (i, sign) in own.chain(other) {
                let arm = sign * self.bars[i].length;
                terms.rows[(2 * k, i)] -= arm * q[i].sin();
                terms.rows[(2 * k + 1, i)] += arm * q[i].cos();
                terms.gamma[2 * k] += arm * q[i].cos() * v[i] * v[i];
                terms.gamma[2 * k + 1] += arm * q[i].sin() * v[i] * v[i];
            }
        }
        if self.bearing.is_some() {
            self.add_offset(parameters[0], q, v, &mut terms);
        }
        terms
    }

    fn dropped(&self, q: &[f64]) -> Vec<f64> {
        let Some(offset) = self.redundant else { return Vec::new() };
        let (bar, target) = self.loops[0];
        vec![self.position(At::End(bar), q)[0] - self.position(target, q)[0] + offset]
    }

    fn energy(&self, parameters: &[f64], q: &[f64], v: &[f64]) -> (f64, f64) {
        let terms = self.terms(parameters, q, v);
        let speeds = DVector::from_column_slice(v);
        let height = |bar: usize| self.arms(bar).iter().map(|(i, arm)| arm * q[*i].sin()).sum::<f64>();
        let ground = |bar: usize| {
            let root = *self.chain(At::End(bar)).last().expect("a bar ends its own chain");
            self.position(self.bars[root].from, q)[1]
        };
        let offset = |bar: usize| if self.floats(At::End(bar)) { q[self.bars.len() + 1] } else { 0.0 };
        let weight =
            |bar: usize| self.bars[bar].mass * parameters[0] * (height(bar) + ground(bar) + offset(bar));
        (0.5 * speeds.dot(&(terms.mass * &speeds)), (0..self.bars.len()).map(weight).sum())
    }

    fn dissipated(&self, v: &[f64]) -> f64 {
        self.bars.iter().zip(v).map(|(bar, v)| bar.damping * v * v).sum()
    }

    fn start(&self) -> (Start, Start) {
        let free = || self.bars.iter().filter(|bar| bar.law.is_none());
        let offset = || self.bearing.iter().flat_map(|_| [(0.0, false); 2]);
        let start = free().map(|bar| bar.start).chain(offset()).collect();
        (start, free().map(|bar| bar.speed).chain(offset()).collect())
    }

    fn channels(&self) -> Vec<(String, &'static str, bool)> {
        let mut channels = Vec::new();
        for bar in 0..self.bars.len() {
            channels.push((format!("bar{bar}.angle"), "rad", true));
            channels.push((format!("bar{bar}.v"), "rad/s", false));
            channels.push((format!("bar{bar}.x"), "m", false));
            channels.push((format!("bar{bar}.y"), "m", false));
        }
        channels.extend((0..2 * self.loops.len()).map(|k| (format!("lambda{k}"), "N", false)));
        channels.extend((0..self.laws().count()).map(|k| (format!("drive{k}"), "N m", false)));
        channels
    }

    fn observe(&self, q: &[f64], v: &[f64], multipliers: &[f64], drives: &[f64]) -> Vec<f64> {
        let mut values = Vec::new();
        for bar in 0..self.bars.len() {
            let [x, y] = self.position(At::End(bar), q);
            values.extend([q[bar].sin().atan2(q[bar].cos()), v[bar], x, y]);
        }
        values.extend(multipliers.iter().chain(drives));
        values
    }
}
