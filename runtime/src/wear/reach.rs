//! What a journal meets of a worn bearing. In: depth by bearing angle, clearance, offset of the journal.
//! Out: penetration with its gradient. Never knows forces.
//!
//! A journal is nearly as large as its bearing: it cannot sink into a worn place that is narrower than the difference
//! of their curvatures lets it. Its centre, at e from that of the bearing, touches where e cos(phi - theta) first
//! reaches c + h(phi): at the edge of a narrow worn place, not in it. The penetration is
//!
//! > p(e) = max over phi of e . n(phi) - c - h(phi), n(phi) = (cos phi, sin phi),
//!
//! the depth of e beyond a convex region. Wear takes edges away until the journal fits, so that the depth stays as
//! smooth as the journal is round.
//!
//! This is asked for at every evaluation of a contact: it goes over those bins alone that may count, four at a time.

use core::f64::consts::PI;

use super::surfaces::Surfaces;
use crate::contact::{Support, bearing_angle};
use crate::elementary::exp_of_moderate;
use crate::scalar::{Scalar, dot};

/// The maximum is smoothed over this many bins to both sides of a round bearing: at 0.8 the ripple from the bins is
/// exp(-2 pi^2 0.8^2) = 3e-6, and what is left in a round bearing is taken off exactly.
const SMOOTHED: f64 = 0.8;
/// exp of less than minus this changes no sum.
const NOTHING: f64 = 40.0;
/// A distance is found to rounding in fewer steps.
const MOST_STEPS: usize = 60;
/// Bins of one pass, so that compilers use vectors.
pub(super) const LANES: usize = 4;

/// Directions of the bins of a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Of the middles of bins, and once more from the first on, so that no window is cut in two.
    normals: [Vec<f64>; 2],
    middles: Vec<f64>,
    /// Cosine of the least angle between a direction and the middle of the bin that is so many from its own, from one on.
    cosines_apart: Vec<f64>,
    /// Smoothing of the maximum over the clearance.
    smoothing: f64,
}

/// Bins one after the other, counted on past the last.
#[derive(Clone, Copy)]
struct Window {
    first: usize,
    count: usize,
}

/// How far a journal reaches along the normals of bins [m].
trait Reaches {
    /// In bins one after the other, of which the first is in the grid; with slopes over the journal's angle [m/rad].
    fn at<const N: usize>(&self, place: usize) -> ([f64; N], [f64; N]);
}

/// The offset of its centre.
struct Unworn<'a> {
    grid: &'a Grid,
    offset: [f64; 2],
}

/// That without the depth that is worn.
struct Worn<'a, 'p> {
    unworn: &'a Unworn<'a>,
    surfaces: Surfaces<'p>,
}

impl Reaches for Unworn<'_> {
    #[inline(always)]
    fn at<const N: usize>(&self, place: usize) -> ([f64; N], [f64; N]) {
        let [x, y] = self.grid.normals_at::<N>(place);
        let [along_x, along_y] = self.offset;
        (core::array::from_fn(|i| along_x * x[i] + along_y * y[i]), [0.0; N])
    }
}

impl Reaches for Worn<'_, '_> {
    #[inline(always)]
    fn at<const N: usize>(&self, place: usize) -> ([f64; N], [f64; N]) {
        let (along, _) = self.unworn.at::<N>(place);
        let (depths, slopes) = self.surfaces.at::<N>(&self.unworn.grid.middles, place);
        (core::array::from_fn(|i| along[i] - depths[i]), slopes)
    }
}

/// A smooth maximum: of the sum of exp((value - largest)/scale), and the mean of what is weighed by it.
struct Smooth {
    largest: f64,
    sum: f64,
    mean: [f64; 2],
    slope: f64,
}

impl Grid {
    /// That of a profile with so many bins.
    pub fn new(bins: usize) -> Self {
        let width = 2.0 * PI / bins as f64;
        let middle = |bin: usize| (bin as f64 + 0.5) * width - PI;
        let twice = |of: fn(f64) -> f64| (0..2 * bins).map(|bin| of(middle(bin % bins))).collect();
        Self {
            normals: [twice(libm::cos), twice(libm::sin)],
            middles: (0..bins).map(middle).collect(),
            cosines_apart: (0..bins / 2).map(|bins| libm::cos((bins as f64 + 0.5) * width)).collect(),
            smoothing: (SMOOTHED * width) * (SMOOTHED * width),
        }
    }

    /// Penetration of a journal at an offset [m] into a bearing with a radial clearance [m], worn by profiles with
    /// the bins of this grid; exactly that of a round bearing where the depth is even.
    pub fn support<'p>(
        &self,
        worn: impl Into<Surfaces<'p>>,
        clearance: f64,
        offset: [f64; 2],
    ) -> Support<f64> {
        let surfaces = worn.into();
        let round = Support::round(offset, clearance);
        let scale = self.smoothing * clearance;
        let nearest = self.bin_at(bearing_angle(offset));
        let unworn = Unworn { grid: self, offset };
        let worn = Worn { unworn: &unworn, surfaces };
        let ([round_reach], _) = unworn.at::<1>(nearest);
        let ([worn_reach], _) = worn.at::<1>(nearest);
        // Bins that reach less than the nearest by so much change no sum.
        let cosine = |reach: f64| (reach - NOTHING * scale) / (round.penetration + clearance);
        let unworn = self.smooth(scale, self.window(nearest, cosine(round_reach)), round_reach, &unworn);
        let window = self.window(nearest, cosine(worn_reach + surfaces.minimum()));
        let worn = self.smooth(scale, window, window.largest(&worn), &worn);
        let deeper = worn.largest - unworn.largest + scale * libm::log(worn.sum / unworn.sum);
        let turned = |axis: usize| round.gradient[axis] + worn.mean[axis] - unworn.mean[axis];
        let gradient = [turned(0), turned(1)];
        Support {
            penetration: round.penetration + deeper,
            gradient,
            length: Some(libm::sqrt(dot(gradient, gradient))),
            turning: surfaces.turn().then_some(worn.slope),
        }
    }

    /// Distance [m] of the journal's centre from the bearing's, along a unit vector, at which the penetration is
    /// `penetration` [m].
    pub fn distance<'p>(
        &self,
        worn: impl Into<Surfaces<'p>>,
        clearance: f64,
        direction: [f64; 2],
        penetration: f64,
    ) -> f64 {
        let surfaces = worn.into();
        // Newton comes from outside, where the penetration is too large: it is convex.
        let mut distance = clearance + penetration + surfaces.maximum();
        for _ in 0..MOST_STEPS {
            let offset = direction.map(|component| distance * component);
            let Support { penetration: found, gradient, .. } = self.support(surfaces, clearance, offset);
            let slope = gradient[0] * direction[0] + gradient[1] * direction[1];
            let step = (found - penetration) / slope;
            if !(step.is_finite() && step.abs() > f64::EPSILON * distance.abs()) {
                break;
            }
            distance -= step;
        }
        distance
    }

    /// The bin that an angle lies in.
    fn bin_at(&self, angle: f64) -> usize {
        let bins = self.middles.len();
        ((angle + PI) * (bins as f64 / (2.0 * PI))).clamp(0.0, bins as f64 - 1.0) as usize
    }

    /// The bins around one whose directions may have a cosine of more than this with any direction in it.
    fn window(&self, nearest: usize, cosine: f64) -> Window {
        let bins = self.middles.len();
        let aside = self.cosines_apart.partition_point(|apart| *apart > cosine);
        // A few more, so that none is left over.
        let count = (2 * aside + 1).next_multiple_of(LANES).min(bins);
        let first = nearest + bins - (count - 1) / 2;
        Window { first: if first < bins { first } else { first - bins }, count }
    }

    /// Normals of bins one after the other.
    #[inline(always)]
    fn normals_at<const N: usize>(&self, place: usize) -> [[f64; N]; 2] {
        [0, 1].map(|axis| self.normals[axis][place..].first_chunk().copied().unwrap_or([f64::NAN; N]))
    }

    /// The smooth maximum of how far a journal reaches in a window, nowhere much more than `largest`.
    #[inline(always)]
    fn smooth(&self, scale: f64, window: Window, largest: f64, reaches: &impl Reaches) -> Smooth {
        let mut sums = Sums { grid: self, largest, per_scale: 1.0 / scale, sums: [[0.0; LANES]; 4] };
        let (chunks, rest) = window.parts();
        chunks.for_each(|place| sums.add::<LANES>(place, reaches));
        rest.for_each(|place| sums.add::<1>(place, reaches));
        let [sum, x, y, slope] = sums.sums.map(|[a, b, c, d]| (a + b) + (c + d));
        Smooth { largest, sum, mean: [x / sum, y / sum], slope: slope / sum }
    }
}

/// What is summed up by weights.
struct Sums<'a> {
    grid: &'a Grid,
    largest: f64,
    per_scale: f64,
    /// Of the weights, the normals and the slopes by them.
    sums: [[f64; LANES]; 4],
}

impl Sums<'_> {
    #[inline(always)]
    fn add<const N: usize>(&mut self, place: usize, reaches: &impl Reaches) {
        let (reach, slopes) = reaches.at::<N>(place);
        let above = reach.map(|reach| (reach - self.largest) * self.per_scale);
        let Some(weights) = weights(above) else { return };
        let [x, y] = self.grid.normals_at::<N>(place);
        for lane in 0..N {
            let weighed = [1.0, x[lane], y[lane], slopes[lane]];
            for (sum, weighed) in self.sums.iter_mut().zip(weighed) {
                sum[lane] += weights[lane] * weighed;
            }
        }
    }
}

/// Exponentials of numbers at most 0, those that change no sum as zero; nothing if all are: in a deep place most bins reach too little.
#[inline(always)]
pub(super) fn weights<const N: usize>(above: [f64; N]) -> Option<[f64; N]> {
    let counts = above.iter().any(|above| -NOTHING < *above);
    counts.then(|| above.map(|above| f64::select((-NOTHING).lt(above), exp_of_moderate(above), 0.0)))
}

impl Window {
    /// Where to begin [`LANES`] bins at a time, and the bins that are left over.
    #[inline(always)]
    fn parts(self) -> (impl Iterator<Item = usize>, impl Iterator<Item = usize>) {
        let end = self.first + self.count;
        let rest = end - self.count % LANES;
        ((self.first..rest).step_by(LANES), rest..end)
    }

    /// The most that a journal reaches in one of them.
    #[inline(always)]
    fn largest(self, reaches: &impl Reaches) -> f64 {
        let (chunks, rest) = self.parts();
        let mut most = [f64::NEG_INFINITY; LANES];
        for place in chunks {
            let (reach, _) = reaches.at::<LANES>(place);
            most = core::array::from_fn(|lane| Scalar::max(most[lane], reach[lane]));
        }
        let rest = rest.map(|place| reaches.at::<1>(place).0[0]);
        rest.chain(most).fold(f64::NEG_INFINITY, Scalar::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wear::profile::peak;
    use crate::wear::{Extent, Profile};

    const CLEARANCE: f64 = 1e-5;

    fn at(grid: &Grid, worn: &Profile, distance: f64, angle: f64) -> Support<f64> {
        grid.support(worn, CLEARANCE, [distance * angle.cos(), distance * angle.sin()])
    }

    fn rough() -> Profile {
        Profile::try_from((0..72).map(|bin| 1e-6 * f64::from(bin * bin % 13)).collect::<Vec<_>>())
            .expect("depths")
    }

    #[test]
    fn an_even_depth_is_a_larger_clearance() {
        let (grid, even) = (Grid::new(72), Profile::try_from(vec![2e-6; 72]).expect("depths"));
        for angle in [0.0, 0.3, 1.0, 3.1, -2.0] {
            let (found, expected) =
                (at(&grid, &even, 1.25e-5, angle), Support::round([1.25e-5, 0.0], 1.2e-5));
            // A few roundings of 1e-5.
            assert!((found.penetration - expected.penetration).abs() < 1e-19, "{found:?}");
            assert!(
                (found.gradient[0] - angle.cos()).abs() < 1e-13
                    && (found.gradient[1] - angle.sin()).abs() < 1e-13
            );
        }
    }

    #[test]
    fn a_journal_does_not_sink_into_a_groove_narrower_than_it_fits() {
        let (grid, groove) = (Grid::new(72), peak(72, 30, 1e-6));
        let angle = groove.middle(30);
        let found = at(&grid, &groove, CLEARANCE, angle);
        // It rests on both edges, one bin of 5 deg away, which lie c (1 - cos 5 deg) = 3.8e-8 m farther; smoothing over
        // 0.8 bins is of that size too.
        assert!((-6e-8..-1e-8).contains(&found.penetration), "{found:?}");
        // Both edges push back evenly, along the groove.
        let across = found.gradient[1] * angle.cos() - found.gradient[0] * angle.sin();
        assert!(across.abs() < 1e-12);
    }

    #[test]
    fn the_gradient_is_the_derivative_of_the_penetration() {
        let (grid, worn) = (Grid::new(72), rough());
        let step = 1e-11;
        for i in 0..40 {
            let (x, y) = (1.4e-5 * (0.7 * f64::from(i)).cos(), 1.4e-5 * (0.7 * f64::from(i)).sin());
            let found = grid.support(&worn, CLEARANCE, [x, y]);
            let penetration = |x, y| grid.support(&worn, CLEARANCE, [x, y]).penetration;
            let slopes = [
                (penetration(x + step, y) - penetration(x - step, y)) / (2.0 * step),
                (penetration(x, y + step) - penetration(x, y - step)) / (2.0 * step),
            ];
            for (exact, slope) in found.gradient.iter().zip(slopes) {
                // Rounding of 1e-21 over the step; curvature 1/5e-8 m squared times the step squared: 4e-8.
                assert!((exact - slope).abs() < 1e-6, "{i}: {exact} {slope}");
            }
        }
    }

    #[test]
    fn distances_have_their_penetration() {
        let (grid, worn) = (Grid::new(72), rough());
        for i in 0..40 {
            let direction = [f64::from(i).cos(), f64::from(i).sin()];
            let distance = grid.distance(&worn, CLEARANCE, direction, 2e-7);
            let found = grid.support(&worn, CLEARANCE, direction.map(|x| distance * x));
            // Rounding of 2e-5 m.
            assert!((found.penetration - 2e-7).abs() < 1e-19, "{i}: {found:?}");
        }
    }

    /// The same over all bins, by the definition.
    fn by_definition(worn: &Surfaces<'_>, bins: usize, offset: [f64; 2]) -> Support<f64> {
        let grid = Grid::new(bins);
        let scale = grid.smoothing * CLEARANCE;
        let smooth = |value: &dyn Fn(usize) -> f64| {
            let largest = (0..bins).map(value).fold(f64::NEG_INFINITY, f64::max);
            let weights: Vec<f64> = (0..bins).map(|bin| libm::exp((value(bin) - largest) / scale)).collect();
            let sum: f64 = weights.iter().sum();
            (largest + scale * libm::log(sum), weights.into_iter().map(move |weight| weight / sum).collect())
        };
        let normal = |bin: usize| [libm::cos(grid.middles[bin]), libm::sin(grid.middles[bin])];
        let along = |bin: usize| offset[0] * normal(bin)[0] + offset[1] * normal(bin)[1];
        let at = |bin: usize| {
            let ([depth], [slope]) = worn.at(&grid.middles, bin);
            (depth, slope)
        };
        let (unworn, by_unworn): (f64, Vec<f64>) = smooth(&along);
        let (deep, by_deep): (f64, Vec<f64>) = smooth(&|bin| along(bin) - at(bin).0);
        let round = Support::round(offset, CLEARANCE);
        let turned = |axis: usize| {
            (0..bins).map(|bin| (by_deep[bin] - by_unworn[bin]) * normal(bin)[axis]).sum::<f64>()
        };
        let slope = (0..bins).map(|bin| by_deep[bin] * at(bin).1).sum();
        Support {
            penetration: round.penetration + deep - unworn,
            gradient: [round.gradient[0] + turned(0), round.gradient[1] + turned(1)],
            length: None,
            turning: worn.turn().then_some(slope),
        }
    }

    #[test]
    fn bins_that_are_left_out_count_for_nothing() {
        // Few bins and many, holes as deep as four clearances, a journal that is worn too; near the centre all bins count.
        for bins in [4, 5, 9, 72, 101, 720] {
            let depths = |most: f64, factor: usize| {
                let depth = |bin: usize| most * (bin * factor % 17) as f64 / 16.0;
                Profile::try_from((0..bins).map(depth).collect::<Vec<_>>()).expect("depths")
            };
            let hole =
                |bin: usize| 4.0 * CLEARANCE * (-((bin as f64 / bins as f64 - 0.4) / 0.1).powi(2)).exp();
            let hole = Profile::try_from((0..bins).map(hole).collect::<Vec<_>>()).expect("depths");
            let (rough, journal) = (depths(1e-6, 5), depths(3e-7, 3));
            let grid = Grid::new(bins);
            for (bush, journal) in [(&rough, None), (&hole, None), (&hole, Some((&journal, 2.2)))] {
                let extent = Extent::of(Some(bush), journal.map(|(journal, _)| journal));
                let worn = Surfaces::new(extent, Some(bush), journal);
                for i in 0..60 {
                    let angle = 0.7 * f64::from(i);
                    let distance = 5e-5 * f64::from(i % 10) / 9.0;
                    let offset = [distance * angle.cos(), distance * angle.sin()];
                    let found = grid.support(worn, CLEARANCE, offset);
                    let expected = by_definition(&worn, bins, offset);
                    // Roundings of 5e-5 m, and a scale as large as that with few bins.
                    assert!(
                        (found.penetration - expected.penetration).abs() < 1e-18,
                        "{bins} {i}: {found:?}"
                    );
                    let turned = |axis: usize| (found.gradient[axis] - expected.gradient[axis]).abs();
                    // A rounding of the offset over the smoothing, 5e-10 m with 720 bins.
                    assert!(turned(0) < 1e-10 && turned(1) < 1e-10, "{bins} {i}: {found:?} {expected:?}");
                    if let (Some(found), Some(expected)) = (found.turning, expected.turning) {
                        assert!((found - expected).abs() < 1e-14, "{bins} {i}: {found:e} {expected:e}");
                    }
                    assert_eq!(found.turning.is_some(), expected.turning.is_some());
                }
            }
        }
    }
}
