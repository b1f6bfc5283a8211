//! What controllers hold between their samples, of one mechanism. In: times, states. Out: where steps end, what is held from there on.
//! Never takes a step.

use super::Evaluator;
use super::sampled::same;

impl Evaluator<'_> {
    /// Whether anything is held between samples.
    pub(crate) fn has_samplers(&self) -> bool {
        !self.sampled.is_empty()
    }

    /// Number of controllers that hold something between samples.
    pub(crate) fn samplers(&self) -> usize {
        self.sampled.len()
    }

    /// Where a step that begins at `t` and may go up to `stop` ends because of a sample.
    pub(crate) fn stop_at_sample(&self, t: f64, stop: f64) -> f64 {
        let next = self.sampled.iter().map(|own| own.after(t)).fold(f64::INFINITY, f64::min);
        if next < stop - same(stop) { next } else { stop }
    }

    /// Whether one of two times means the other: a row at a sample.
    pub(crate) fn is_same_time(&self, a: f64, b: f64) -> bool {
        a == b || (self.has_samplers() && (a - b).abs() <= same(b))
    }

    /// Whether a controller acts at `t`: behind a step that began at `from`, or where a run begins.
    pub(crate) fn acts(&self, sampler: usize, from: Option<f64>, t: f64) -> bool {
        let own = &self.sampled[sampler];
        from.map_or_else(|| own.begins(t), |from| own.acts(from, t))
    }

    /// What a controller holds from `t` on, put among the speeds; the state is that of the last forward dynamics. The name of
    /// a column that is no number, if one is.
    pub(crate) fn hold(
        &mut self,
        sampler: usize,
        (t, q): (f64, &[f64]),
        v: &mut [f64],
    ) -> Result<(), String> {
        let held = std::mem::take(&mut self.sampled[sampler].held);
        let columns = self.observe(t, q, v);
        let next: Vec<f64> = held.iter().map(|(column, _)| columns[*column]).collect();
        let wrong = held.iter().zip(&next).find(|(_, value)| !value.is_finite());
        let outcome = match wrong {
            Some(((column, _), _)) => Err(self.description.channels[*column].name.to_string()),
            None => {
                held.iter().zip(&next).for_each(|((_, speed), value)| v[*speed] = *value);
                Ok(())
            }
        };
        self.sampled[sampler].held = held;
        outcome
    }
}
