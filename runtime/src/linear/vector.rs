//! Vectors as slices: scalar product, sum, largest magnitude. The order of summation is fixed.

/// Scalar product, in four running sums.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_blocks, a_rest) = a.as_chunks::<4>();
    let (b_blocks, b_rest) = b.as_chunks::<4>();
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// `y += factor * x`.
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Largest magnitude; NaN if any entry is not a number.
pub fn largest(values: &[f64]) -> f64 {
    // What is not a number stays: it is in the second term from there on.
    let larger = |most: f64, x: f64| if x.abs() <= most { most } else { x.abs() + 0.0 * most };
    let (blocks, rest) = values.as_chunks::<4>();
    let most = blocks
        .iter()
        .fold([0.0; 4], |most: [f64; 4], block| [0, 1, 2, 3].map(|lane| larger(most[lane], block[lane])));
    most.iter().chain(rest).fold(0.0, |most, x| larger(most, *x))
}

/// Whether all are numbers, and none is infinite.
pub fn is_finite(values: &[f64]) -> bool {
    // Without a way out before the end compilers take several at once.
    values.iter().fold(true, |all, x| all & (x.abs() < f64::INFINITY))
}
