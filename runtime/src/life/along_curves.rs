//! Steps of a path along curves through few measurements of their own and those of earlier steps: where the wear of every joint is one
//! number. In: what was measured. Out: paths, and by how much they may err. Never knows which step comes next.

use super::curve::{Curve, Measured, apart};
use super::error::LifeError;
use super::path::{Increments, Path, Segment, Step, Walker, rates};
use super::settings::WearStep;
use super::source::WearSource;
use super::worn::WearState;

/// Part of a step at which its second measurement is made: the rest is too short for what a curve through it misses.
const SECOND: f64 = 0.75;
/// Measurements that are nearer to each other than this part of what a step wears tell more of the scatter of the fine scale than of
/// its curve.
const APART: f64 = 0.25;
/// The same of measurements in the middle of cycles.
const MIDDLES_APART: f64 = 0.5;
/// A cycle of a life that is drawn may err by so many times the tolerance: what the curve misses of the fine structure of wear by
/// clearance, a few parts in 1e4 of either sign, is nothing beside what the draw does, and shorter steps would find it again.
const DRAWN: f64 = 4.0;
/// So many are remembered: those of the last few steps.
const REMEMBERED: usize = 6;

impl<F: WearSource> Walker<'_, F> {
    /// One step along curves through its measurements and the nearest earlier one, joint by joint in its own wear; and by how much
    /// of its gain it differs from straight lines.
    pub(super) fn along_curves(
        &mut self,
        rates: &[f64],
        span: u64,
    ) -> Result<(Path, f64), LifeError<F::Error>> {
        let length = span as f64;
        let second: Increments = rates.iter().map(|rate| SECOND * length * rate).collect();
        let then = self::rates(self.settings, &self.go_on_to(&second)?);
        let own = |(i, base): (usize, &WearState)| {
            let begin = Measured { wear: base.wear, rate: rates[i] };
            vec![begin, Measured { wear: base.wear + second[i], rate: then[i] }]
        };
        let own: Vec<Vec<Measured>> = self.base.iter().enumerate().map(own).collect();
        let curves = own.iter().zip(&self.earlier).map(|(own, earlier)| {
            let line = Curve::level(own[0]).through(own[1]);
            let third = apart(own, earlier, APART * (own[1].wear - own[0].wear)).next();
            [line, third.map_or(line, |third| line.through(third))]
        });
        let (path, ratio) = self.by_curves(&curves.collect::<Vec<_>>(), span);
        self.remember(own);
        Ok((path, ratio))
    }

    /// One cycle by a single measurement in its middle, with a curve through it and earlier ones, and that measurement as it would be
    /// at the begin; nothing if there are too few, or if the curve through four differs too much from that through three.
    ///
    /// What a cycle wears goes with the rate in its middle; of what the others say of slope and bend, little is left. For lives that
    /// are drawn.
    pub(super) fn by_middle(&mut self) -> Result<Option<Step>, LifeError<F::Error>> {
        let WearStep::Adaptive { tolerance, remembers: true, .. } = self.settings.step else {
            return Ok(None);
        };
        if self.earlier.len() != self.base.len() || !self.has_numbers_alone() {
            return Ok(None);
        }
        let known = self.base.iter().zip(&self.earlier).map(|(base, earlier)| foretell(base.wear, earlier));
        let Some(foretold) = known.collect::<Option<Increments>>() else { return Ok(None) };
        let mut measured = self.go_on_to(&foretold)?;
        let there = self.base.iter().zip(&foretold).zip(rates(self.settings, &measured));
        let own: Vec<Measured> =
            there.map(|((base, gained), rate)| Measured { wear: base.wear + gained, rate }).collect();
        let curves = own.iter().zip(&self.earlier).map(|(own, earlier)| {
            let mut others = apart(&[*own], earlier, MIDDLES_APART * own.rate);
            let three = Curve::level(*own).through(others.next()?).through(others.next()?);
            Some([three, three.through(others.next()?)])
        });
        let curves = curves.collect::<Option<Vec<_>>>();
        self.remember(own.iter().map(|own| vec![*own]).collect());
        let Some(curves) = curves else { return Ok(None) };
        let (path, ratio) = self.by_curves(&curves, 1);
        if !path.is_finite() || ratio > DRAWN * tolerance {
            return Ok(None);
        }
        let joints = measured.iter_mut().zip(&curves).zip(own.iter().zip(self.base));
        for ((measured, [_, curve]), (own, base)) in joints.filter(|(_, (own, _))| own.rate > 0.0) {
            measured.scale_wear(curve.rate(base.wear) / own.rate);
        }
        Ok(Some((path, measured)))
    }

    /// Whether the wear of every joint is one number.
    pub(super) fn has_numbers_alone(&self) -> bool {
        self.settings.joints.iter().all(|joint| joint.width() == 1)
    }

    /// Keeps what a step has measured, joint by joint, before what earlier ones have.
    pub(super) fn remember(&mut self, mut own: Vec<Vec<Measured>>) {
        self.earlier.resize(own.len(), Vec::new());
        for (own, earlier) in own.iter_mut().zip(&mut self.earlier) {
            own.reverse();
            own.append(earlier);
            own.truncate(REMEMBERED);
        }
        self.earlier = own;
    }

    /// The path along the second curve of every joint, and by how much of its gain it differs from the first.
    fn by_curves(&self, curves: &[[Curve; 2]], span: u64) -> (Path, f64) {
        let length = span as f64;
        let nothing = vec![0.0; curves.len()];
        let (mut to, mut errors) = (nothing.clone(), nothing.clone());
        let (mut from_rate, mut to_rate) = (nothing.clone(), nothing.clone());
        for (i, ([rough, curve], base)) in curves.iter().zip(self.base).enumerate() {
            let end = curve.after(base.wear, length);
            (to[i], errors[i]) = (end - base.wear, end - rough.after(base.wear, length));
            (from_rate[i], to_rate[i]) = (curve.rate(base.wear), curve.rate(end));
        }
        let (error, ratio) = self.judge(&errors, &to, length);
        let segment = Segment { start: 0.0, length, from: nothing, to, from_rate, to_rate };
        (Path { segments: vec![segment], span, end: None, error, seen: Vec::new() }, ratio)
    }
}

/// What half a cycle will add to a wear [m], by the curve through three measurements; nothing if there are less, or if that is none.
fn foretell(wear: f64, earlier: &[Measured]) -> Option<f64> {
    let nearest = earlier.iter().min_by(|a, b| (a.wear - wear).abs().total_cmp(&(b.wear - wear).abs()))?;
    let mut others = apart(&[*nearest], earlier, APART * nearest.rate);
    let curve = Curve::level(*nearest).through(others.next()?).through(others.next()?);
    let gained = curve.after(wear, 0.5) - wear;
    (gained.is_finite() && gained >= 0.0).then_some(gained)
}
