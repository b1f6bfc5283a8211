//! What a journal meets of a worn bearing, and where it then wears it. In: depth by bearing angle, clearance, offset of the
//! journal, wear by the direction of that offset. Out: penetration with its gradient, depth by bearing angle.
//! Never knows forces.
//!
//! A journal is nearly as large as its bearing: it cannot sink into a worn place that is narrower than the difference
//! of their curvatures lets it. Its centre, at e from that of the bearing, touches where e cos(phi - theta) first
//! reaches c + h(phi): at the edge of a narrow worn place, not in it. The penetration is
//!
//! > p(e) = max over phi of e . n(phi) - c - h(phi), n(phi) = (cos phi, sin phi),
//!
//! the depth of e beyond a convex region. Wear takes edges away until the journal fits, so that the depth stays as
//! smooth as the journal is round.

use core::f64::consts::{FRAC_PI_2, PI};

use super::profile::Profile;
use crate::contact::Support;

/// A minimum counts as shared by places this part of the depth of a bin's circular segment above it: small against
/// the segment, so that an unworn bearing is worn where the journal points.
const SHARED: f64 = 1.0 / 8.0;
/// The maximum is smoothed over this many bins to both sides of a round bearing: at 0.8 the ripple from the bins is
/// exp(-2 pi^2 0.8^2) = 3e-6, and what is left in a round bearing is taken off exactly.
const SMOOTHED: f64 = 0.8;
/// exp of less than minus this changes no sum.
const NOTHING: f64 = 40.0;
/// A distance is found to rounding in fewer steps.
const MOST_STEPS: usize = 60;
/// Wear is taken away in pieces of at most this part of that depth, so that edges go before a hole grows.
const PIECE: f64 = 0.25;
/// Upper limit on the number of sub-steps of one wear step.
const MOST_PIECES: f64 = 4096.0;

/// Directions of the bins of a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    normals: Vec<[f64; 2]>,
    middles: Vec<f64>,
    /// Smoothing of the maximum over the clearance.
    smoothing: f64,
}

/// What is worn off a joint: bush, journal, or both. The gap at a bearing angle is the clearance, the depth of the bush there, and
/// that of the journal at the place of it that has come there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surfaces<'p> {
    /// Depth of the bush by bearing angle.
    pub bush: Option<&'p Profile>,
    /// Depth of the journal by its own angle, and how far it has turned in the bearing [rad].
    pub journal: Option<(&'p Profile, f64)>,
}

impl<'p> From<&'p Profile> for Surfaces<'p> {
    fn from(bush: &'p Profile) -> Self {
        Self { bush: Some(bush), journal: None }
    }
}

impl Surfaces<'_> {
    /// Whether nothing is worn.
    pub fn are_round(&self) -> bool {
        self.bush.is_none() && self.journal.is_none()
    }

    /// Depths of both, over the circumference [m].
    pub fn mean(&self) -> f64 {
        let journal = self.journal.map(|(journal, _)| journal.mean());
        let bush = self.bush.map_or(0.0, Profile::mean);
        journal.map_or(bush, |journal| bush + journal)
    }

    /// No less than the largest depth of both together [m].
    fn maximum(&self) -> f64 {
        let journal = self.journal.map_or(0.0, |(journal, _)| journal.maximum());
        self.bush.map_or(0.0, Profile::maximum) + journal
    }

    /// Depth of both together in a bin of the bearing with its middle [m], and the slope of the journal's [m/rad].
    fn at(&self, bin: usize, middle: f64) -> (f64, f64) {
        let bush = self.bush.map_or(0.0, |bush| bush.depths()[bin]);
        self.journal.map_or((bush, 0.0), |(journal, turned)| {
            let (depth, slope) = journal.at(middle - turned);
            (bush + depth, slope)
        })
    }
}

/// A smooth maximum: of the sum of exp(value/scale), and the mean of what is weighed by it.
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
        let normals = (0..bins).map(|bin| [libm::cos(middle(bin)), libm::sin(middle(bin))]).collect();
        let middles = (0..bins).map(middle).collect();
        Self { normals, middles, smoothing: (SMOOTHED * width) * (SMOOTHED * width) }
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
        let along = |normal: &[f64; 2]| offset[0] * normal[0] + offset[1] * normal[1];
        let unworn = self.smooth(scale, self.normals.iter().map(|normal| (along(normal), 0.0)));
        let worn = self.normals.iter().zip(&self.middles).enumerate().map(|(bin, (normal, middle))| {
            let (depth, slope) = surfaces.at(bin, *middle);
            (along(normal) - depth, slope)
        });
        let worn = self.smooth(scale, worn);
        let deeper = worn.largest - unworn.largest + scale * libm::log(worn.sum / unworn.sum);
        let turned = |axis: usize| round.gradient[axis] + worn.mean[axis] - unworn.mean[axis];
        Support {
            penetration: round.penetration + deeper,
            gradient: [turned(0), turned(1)],
            turning: surfaces.journal.map(|_| worn.slope),
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

    fn smooth(&self, scale: f64, values: impl Iterator<Item = (f64, f64)> + Clone) -> Smooth {
        let largest = values.clone().fold(f64::NEG_INFINITY, |most, (value, _)| f64::max(most, value));
        let (mut sum, mut mean, mut turning) = (0.0, [0.0; 2], 0.0);
        for (normal, (value, slope)) in self.normals.iter().zip(values) {
            let below = (largest - value) / scale;
            if below < NOTHING {
                let weight = libm::exp(-below);
                sum += weight;
                mean = [mean[0] + weight * normal[0], mean[1] + weight * normal[1]];
                turning += weight * slope;
            }
        }
        Smooth { largest, sum, mean: mean.map(|component| component / sum), slope: turning / sum }
    }
}

impl Profile {
    /// Takes away wear that is given by the direction of the journal's offset, mean depths [m] of the bins, times a
    /// factor: where the journal touches when it points there. Says whether the bins fit (if not, nothing changes).
    pub fn wear_in(&mut self, by_direction: &[f64], factor: f64, clearance: f64) -> bool {
        if self.depths.len() != by_direction.len() {
            return false;
        }
        // Not a number (a lost measurement): the profile keeps what it has.
        if !(by_direction.iter().all(|depth| depth.is_finite()) && factor.is_finite()) {
            return true;
        }
        let bearing = Bearing::new(self, clearance);
        let most = by_direction.iter().fold(0.0_f64, |most, depth| most.max((factor * depth).abs()));
        let pieces = (most / (PIECE * bearing.segment)).ceil().clamp(1.0, MOST_PIECES);
        let amounts: Vec<f64> = by_direction.iter().map(|depth| factor * depth / pieces).collect();
        let mut more = vec![0.0; amounts.len()];
        for _ in 0..pieces as usize {
            more.fill(0.0);
            for (direction, amount) in amounts.iter().enumerate().filter(|(_, amount)| **amount != 0.0) {
                bearing.share(&self.depths, (direction, *amount), &mut more);
            }
            self.depths.iter_mut().zip(&more).for_each(|(depth, more)| *depth += more);
        }
        true
    }
}

/// Geometry of a bearing cut into bins.
struct Bearing {
    clearance: f64,
    /// Depth [m] of the circular segment of the centre's path that a bin covers.
    segment: f64,
    /// 1/cos of multiples of the angle of a bin, up to a quarter turn.
    inverse_cosines: Vec<f64>,
}

impl Bearing {
    fn new(profile: &Profile, clearance: f64) -> Self {
        let width = profile.bin_angle();
        let quarter = (FRAC_PI_2 / width - 1e-9).floor() as usize;
        let inverse_cosines = (0..=quarter).map(|bins| 1.0 / libm::cos(bins as f64 * width)).collect();
        Self { clearance, segment: clearance * (1.0 - libm::cos(width)), inverse_cosines }
    }

    /// Bins within a quarter turn of a direction, each with how far the journal's centre gets until it touches there.
    fn places<'a>(&'a self, depths: &'a [f64], direction: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let (count, quarter) = (depths.len(), self.inverse_cosines.len() - 1);
        (0..=2 * quarter).map(move |step| {
            let bin = (direction + count + step - quarter) % count;
            (bin, (self.clearance + depths[bin]) * self.inverse_cosines[step.abs_diff(quarter)])
        })
    }

    /// Spreads an amount over the bins that the journal touches when it points in a direction.
    fn share(&self, depths: &[f64], (direction, amount): (usize, f64), more: &mut [f64]) {
        let nearest =
            self.places(depths, direction).fold(f64::INFINITY, |nearest, (_, reach)| nearest.min(reach));
        let scale = SHARED * self.segment;
        let weight = |(bin, reach): (usize, f64)| (bin, libm::exp((nearest - reach) / scale));
        let weights: Vec<(usize, f64)> = self.places(depths, direction).map(weight).collect();
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        for (bin, weight) in weights {
            more[bin] += amount * weight / sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLEARANCE: f64 = 1e-5;

    fn peak(bins: usize, at: usize, depth: f64) -> Profile {
        let mut depths = vec![0.0; bins];
        depths[at] = depth;
        Profile::try_from(depths).expect("depths")
    }

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

    #[test]
    fn little_wear_of_an_unworn_bearing_stays_where_the_journal_points() {
        let mut worn = Profile::unworn(72).expect("bins");
        let by_direction = peak(72, 10, 1e-9);
        assert!(worn.wear_in(by_direction.depths(), 1.0, CLEARANCE));
        // exp(-8) = 3e-4 to either side; less as the middle wears.
        assert!((worn.depths()[10] / 1e-9 - 1.0).abs() < 1e-3, "{:?}", worn.depths());
    }

    #[test]
    fn much_wear_in_one_direction_makes_room_for_the_journal_and_keeps_its_volume() {
        let mut worn = Profile::unworn(72).expect("bins");
        let by_direction = peak(72, 40, 2e-5);
        assert!(worn.wear_in(by_direction.depths(), 0.5, CLEARANCE));
        let sum: f64 = worn.depths().iter().sum();
        // 72 bins and some thousand pieces round.
        assert!((sum / 1e-5 - 1.0).abs() < 1e-10, "{sum}");
        // The journal, moved by d, touches all over an arc: h = (c + d) cos - c, d the depth in the middle, to a
        // piece of wear and the shared minimum, some hundredths of a micrometre.
        let far = worn.depths()[40];
        for offset in 0..4 {
            let expected = (CLEARANCE + far) * (5.0 * offset as f64).to_radians().cos() - CLEARANCE;
            for bin in [40 - offset, 40 + offset] {
                let depth = worn.depths()[bin];
                assert!((depth - expected.max(0.0)).abs() < 3e-8, "{bin}: {depth:e} {expected:e}");
            }
        }
    }

    #[test]
    fn bins_that_do_not_fit_change_nothing() {
        let mut worn = Profile::unworn(8).expect("bins");
        assert!(!worn.wear_in(&[1e-6; 9], 1.0, CLEARANCE));
        assert!(worn.wear_in(&[f64::NAN; 8], 1.0, CLEARANCE));
        assert_eq!(worn, Profile::unworn(8).expect("bins"));
    }
}
