//! Whether a motion that repeats itself would come back to itself. In: a runner whose turns agree. Out: the growth of a small displacement
//! in a turn; and the runner after as many turns as it takes to get where the motion goes. Never knows what turns wear.
//!
//! A life begins with the machine under way, where every journal runs steadily. Begun there it stays there, though a machine would not: a
//! friction that falls with speed, or one that couples the swing of a journal with its tilt, makes a swing grow, and a computed motion has
//! nothing but rounding to grow from. So turns that agree without having been seen to come nearer to each other tell nothing. Here they
//! are run once more with every journal displaced a little, which gives the matrix of a turn, by Arnoldi's iteration; its largest
//! eigenvalue is the factor by which a displacement grows from turn to turn.

use std::f64::consts::TAU;

use crate::error::RunError;
use crate::linear::{add_scaled, dot};
use crate::simulate::{RunWarning, TurnRunner, TurnState};
use crate::watch::Watch;

/// Displacements [radial clearances]: a hundredth of what a light load presses a journal in by. The factors of rotors and of journals
/// that tilt are those of a tenth as much to 2e-5, and of a hundred times as much to 4e-4.
const DISPLACED: f64 = 1e-5;
/// Tolerance of steps meanwhile. A contact that rests shakes within it and in proportion, by the same number of steps: at 1e-6 by ten
/// times a displacement in rates, at 1e-8 by so little that factors are those at 1e-12 to 2e-4.
const EXACT: f64 = 1e-8;
/// Displacements that are tried at most. Two joints with two freedoms and their rates have as many; of more, those that grow most show.
const MOST_TRIED: usize = 8;
/// A direction that is left by less than this part of a displacement is none, but nonlinearity.
const NO_DIRECTION: f64 = 1e-6;
/// A swing that nothing damps comes out with a factor of 1 to 2e-4, as of rotors with a coefficient of friction of 0 and 0.1; one that
/// grows by less than this in a turn is taken for it.
const GROWS: f64 = 1e-3;
/// Steps of a turn at most: what a million of them shake a contact by is as much as a displacement, so that factors between 1 and 1.5 come
/// out by chance. A life with such turns is taken as steady.
const LOUD: u64 = 300_000;
/// Displacements ten times as large grow by the same factor, up to this part of its logarithm, or it is chance.
const SAME: f64 = 0.2;
const LARGER: f64 = 10.0;
/// Squarings of the matrix: its largest eigenvalue by the 2^30th power is exact to rounding.
const SQUARINGS: i32 = 30;
/// The push from which a growing motion starts, in the natural sizes of offsets and rates: well beyond rounding, and in its offset, of a
/// swing ten times as fast as the turn, a hundredth of the clearance.
const PUSHED: f64 = 0.1;
/// It has grown to all that it will, and settled there, in the turns in which a displacement would grow by the exponential of this: five
/// to fill the clearance, as many to come to rest in its lasting swing.
const FULL: f64 = 10.0;
/// The swing that lasts gets over a change of wear in the turns in which a displacement of the steady motion would grow by the
/// exponential of this: near it, amplitudes go back twice as fast as small ones grow, to 1/400 of what a wear step changes.
const OVER: f64 = 3.0;
/// Turns at most: those of a steady load take a millisecond or some.
const MOST_TURNS: f64 = 3000.0;
/// Steps in them at most, some ten seconds.
const MOST_STEPS: u64 = 20_000_000;

/// How a displacement of journals grows in a turn.
#[derive(Clone, Debug)]
struct Growth {
    factor: f64,
    /// What grows so: offsets, then rates.
    direction: Vec<f64>,
}

/// A motion that was left.
#[derive(Debug)]
pub(super) struct Left {
    /// Turns, or so often as many as it takes to repeat, in which the motion that was found instead gets over a change of wear.
    pub lasting: u32,
    /// What is doubtful about where it has got to.
    pub doubts: Option<RunWarning>,
}

/// If a motion that is alike after so many turns does not come back to itself: goes on until it has got where it goes. If it does, the runner stays
/// where it is.
///
/// # Errors
/// As [`TurnRunner::measure`].
pub(super) fn leave(
    runner: &mut TurnRunner<'_>,
    every: u32,
    watch: Watch<'_>,
) -> Result<Option<Left>, RunError> {
    let begin = runner.state();
    let method = runner.go_by(runner.method().at_least(EXACT));
    let growth = certain_growth(runner, (&begin, every), watch);
    runner.go_by(method);
    runner.restore(&begin)?;
    let Some(Growth { factor, direction }) = growth? else { return Ok(None) };
    let folds = factor.ln();
    let turns = (FULL / folds).ceil();
    let scales = scales(runner)?;
    let size = crate::linear::largest(&direction);
    displace(runner, &direction.iter().map(|x| PUSHED / size * x).collect::<Vec<_>>(), &scales);
    let (mut ran, mut steps) = (0, 0);
    while ran < turns.min(MOST_TURNS / f64::from(every)) as u32 && steps < MOST_STEPS {
        steps += go_on(runner, every, watch)?;
        ran += 1;
    }
    let slow = RunWarning::GrowsSlowly { turns: f64::from(every) / folds, ran: ran * every };
    let lasting = ((OVER / folds).ceil() as u32).min(ran);
    Ok(Some(Left { lasting, doubts: (f64::from(ran) < turns).then_some(slow) }))
}

/// The growth in the turn from a state, if there is any that does not depend on how far journals are displaced.
fn certain_growth(
    runner: &mut TurnRunner<'_>,
    (begin, every): (&TurnState, u32),
    watch: Watch<'_>,
) -> Result<Option<Growth>, RunError> {
    let Some(found) =
        growth(runner, (begin, every), DISPLACED, watch)?.filter(|growth| growth.factor > 1.0 + GROWS)
    else {
        return Ok(None);
    };
    let larger = growth(runner, (begin, every), LARGER * DISPLACED, watch)?;
    let is_same = |larger: &Growth| (larger.factor / found.factor).ln().abs() <= SAME * found.factor.ln();
    Ok(larger.is_some_and(|larger| is_same(&larger)).then_some(found))
}

/// The growth in the turn from a state, of displacements [radial clearances]; nothing where journals cannot be displaced.
fn growth(
    runner: &mut TurnRunner<'_>,
    (begin, every): (&TurnState, u32),
    displaced: f64,
    watch: Watch<'_>,
) -> Result<Option<Growth>, RunError> {
    let scales = scales(runner)?;
    runner.restore(begin)?;
    let stand = standing(runner, &scales);
    if go_on(runner, every, watch)? > LOUD {
        return Ok(None);
    }
    let reached = standing(runner, &scales);
    let most = stand.len().min(MOST_TRIED);
    // Along no axis, and none twice.
    let first: Vec<f64> = (1..=stand.len()).map(|place| 1.0 / place as f64).collect();
    let mut basis = vec![unit(first)];
    let mut matrix = vec![vec![0.0; most]; most];
    while let Some(tried) = basis.last().filter(|_| basis.len() <= most).cloned() {
        let column = basis.len() - 1;
        runner.restore(begin)?;
        let by: Vec<f64> = tried.iter().map(|x| displaced * x).collect();
        if !displace(runner, &by, &scales) {
            return Ok(None);
        }
        go_on(runner, every, watch)?;
        let now = standing(runner, &scales);
        let mut grown: Vec<f64> = now.iter().zip(&reached).map(|(a, b)| (a - b) / displaced).collect();
        let before = dot(&grown, &grown).sqrt();
        // Twice: what rounding leaves of the first time is taken away the second.
        for _ in 0..2 {
            for (row, direction) in basis.iter().enumerate().take(most) {
                let along = dot(&grown, direction);
                matrix[row][column] += along;
                add_scaled(&mut grown, -along, direction);
            }
        }
        let left = dot(&grown, &grown).sqrt();
        if left <= NO_DIRECTION * before.max(1.0) || basis.len() == most {
            break;
        }
        matrix[column + 1][column] = left;
        basis.push(unit(grown));
    }
    let count = basis.len();
    let matrix: Vec<Vec<f64>> = matrix[..count].iter().map(|row| row[..count].to_vec()).collect();
    let (factor, amounts) = largest_eigenvalue(matrix);
    let mut direction = vec![0.0; stand.len()];
    basis.iter().zip(&amounts).for_each(|(basis, amount)| add_scaled(&mut direction, *amount, basis));
    Ok(Some(Growth { factor, direction }))
}

/// Runs as many turns as motions take to repeat; their steps.
fn go_on(runner: &mut TurnRunner<'_>, every: u32, watch: Watch<'_>) -> Result<u64, RunError> {
    (0..every).map(|_| Ok(runner.measure(watch)?.statistics.steps)).sum()
}

/// Magnitude of the largest eigenvalue of a matrix, and a vector of what it grows.
fn largest_eigenvalue(mut power: Vec<Vec<f64>>) -> (f64, Vec<f64>) {
    let count = power.len();
    let mut logarithm = 0.0;
    for squaring in 0..=SQUARINGS {
        let size = power.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
        if size == 0.0 || !size.is_finite() {
            return (0.0, vec![0.0; count]);
        }
        power.iter_mut().flatten().for_each(|x| *x /= size);
        logarithm += size.ln() / 2.0_f64.powi(squaring);
        if squaring < SQUARINGS {
            let entry =
                |row: usize, column: usize| (0..count).map(|k| power[row][k] * power[k][column]).sum();
            power = (0..count).map(|row| (0..count).map(|column| entry(row, column)).collect()).collect();
        }
    }
    // The largest column: none is along what does not grow but by chance.
    let column = |at: usize| -> Vec<f64> { power.iter().map(|row| row[at]).collect() };
    let longest = (0..count).map(column).max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)));
    (logarithm.exp(), longest.unwrap_or_default())
}

fn unit(vector: Vec<f64>) -> Vec<f64> {
    let size = dot(&vector, &vector).sqrt();
    vector.iter().map(|x| x / size).collect()
}

/// Natural sizes of offsets [m] and rates [m/s]: radial clearances, and as many radians of the turn.
fn scales(runner: &mut TurnRunner<'_>) -> Result<Vec<[f64; 2]>, RunError> {
    let turn = runner.seconds_per_turn()?.unwrap_or(1.0);
    Ok(runner.journals().iter().map(|place| [place.clearance, place.clearance * TAU / turn]).collect())
}

/// Offsets, then rates of journals in their sizes.
fn standing(runner: &mut TurnRunner<'_>, scales: &[[f64; 2]]) -> Vec<f64> {
    let places = runner.journals();
    let offsets = places.iter().zip(scales).map(|(place, [metres, _])| place.offset / metres);
    let rates = places.iter().zip(scales).map(|(place, [_, speed])| place.rate / speed);
    offsets.chain(rates).collect()
}

/// Displaces journals by offsets, then rates in their sizes; whether loops let them.
fn displace(runner: &mut TurnRunner<'_>, by: &[f64], scales: &[[f64; 2]]) -> bool {
    let (offsets, rates) = by.split_at(scales.len());
    let each = scales.iter().zip(offsets).zip(rates);
    let by: Vec<_> = each.map(|(([metres, speed], offset), rate)| [metres * offset, speed * rate]).collect();
    runner.displace(&by)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_eigenvalue_is_found_of_pairs_and_beside_equal_ones() {
        // A turn by 1 rad that grows by 1.01, beside what dies out.
        let (sine, cosine) = 1.0_f64.sin_cos();
        let pair = |grows: f64| {
            vec![
                vec![grows * cosine, -grows * sine, 0.3],
                vec![grows * sine, grows * cosine, -0.7],
                vec![0.0, 0.0, 0.2],
            ]
        };
        let (factor, direction) = largest_eigenvalue(pair(1.01));
        assert!((factor - 1.01).abs() < 1e-7 && direction[2].abs() < 1e-12, "{factor} {direction:?}");
        assert!((largest_eigenvalue(pair(1.0)).0 - 1.0).abs() < 1e-7);
        // Equal eigenvalues with one direction.
        let (factor, _) = largest_eigenvalue(vec![vec![0.5, 1.0], vec![0.0, 0.5]]);
        assert!((factor - 0.5).abs() < 1e-7, "{factor}");
        assert_eq!(largest_eigenvalue(vec![vec![0.0, 1.0], vec![0.0, 0.0]]).0, 0.0);
    }
}
