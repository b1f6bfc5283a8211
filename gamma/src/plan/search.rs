//! The minimum of a function of one number. In: values on a grid, the function. Never knows its meaning.

/// 2 - the golden ratio.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Where golden section ends: near a smooth minimum values differ by the square of the distance, so that the value is good to
/// 1e-12 of itself.
const CLOSE: f64 = 1e-6;

/// Place and value of the smallest of `f` between the neighbours of the grid's best point; the grid is ascending and has
/// at least one point.
pub(super) fn least(grid: &[f64], f: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
    let values: Vec<f64> = grid.iter().map(|x| f(*x)).collect();
    let best = (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
    let (mut low, mut high) = (grid[best.saturating_sub(1)], grid[(best + 1).min(grid.len() - 1)]);
    let (mut a, mut b) = (low + GOLDEN * (high - low), high - GOLDEN * (high - low));
    let (mut at_a, mut at_b) = (f(a), f(b));
    // Where the end of the grid is best, at zero say, nothing is small beside it: the pieces of the grid tell then.
    let piece = high - low;
    while high - low > CLOSE * high.abs().max(CLOSE * piece) {
        if at_a <= at_b {
            high = b;
            (b, at_b) = (a, at_a);
            a = low + GOLDEN * (high - low);
            at_a = f(a);
        } else {
            low = a;
            (a, at_a) = (b, at_b);
            b = high - GOLDEN * (high - low);
            at_b = f(b);
        }
    }
    let found = if at_a <= at_b { (a, at_a) } else { (b, at_b) };
    if values[best] < found.1 { (grid[best], values[best]) } else { found }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_value_at_zero_is_found_in_few_questions() {
        let mut asked = 0;
        let mut rising = |x: f64| {
            asked += 1;
            1.0 + x
        };
        let (place, value) = least(&[0.0, 1.0, 2.0], &mut rising);
        assert_eq!((place, value), (0.0, 1.0));
        // Golden section gains a digit in five questions: twelve digits of the first piece.
        assert!(asked < 70, "{asked}");
    }
}
