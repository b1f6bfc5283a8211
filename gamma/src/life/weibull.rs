//! Weibull's law of life, for tests: closed forms for everything.

use super::lifetime::Lifetime;

pub struct Weibull {
    pub scale: f64,
    pub shape: f64,
}

impl Weibull {
    fn passed(&self, t: f64) -> f64 {
        (t.max(0.0) / self.scale).powf(self.shape)
    }
}

impl Lifetime for Weibull {
    fn reliability(&self, t: f64) -> f64 {
        (-self.passed(t)).exp()
    }

    fn failed(&self, t: f64) -> f64 {
        -(-self.passed(t)).exp_m1()
    }

    fn typical(&self) -> f64 {
        self.scale
    }
}
