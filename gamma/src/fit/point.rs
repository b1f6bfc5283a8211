//! A log-likelihood at one point, with its derivatives. In: a function of the parameters. Out: value, gradient, information. Never knows
//! what is estimated.

/// Steps of differences, in logarithms.
pub const WIDTH: f64 = 2e-3;

/// Value and derivatives at one point.
#[derive(Clone, Debug)]
pub struct Point {
    /// Log-likelihood.
    pub value: f64,
    /// Its gradient in phi.
    pub gradient: Vec<f64>,
    /// Its Hessian in phi, negated: the observed information.
    pub information: Vec<Vec<f64>>,
}

impl Point {
    /// By central differences of order 4, mixed ones of order 2: ample for Newton's method and for standard errors. `width` is the
    /// step of each parameter; the entries of one that is held are 0.
    pub fn by_differences(
        of: &dyn Fn(&[f64]) -> f64,
        phi: &[f64],
        width: &dyn Fn(usize) -> f64,
        held: Option<usize>,
    ) -> Self {
        let size = phi.len();
        let at = |moves: &[(usize, f64)]| {
            let mut moved = phi.to_vec();
            for (i, by) in moves {
                moved[*i] += by * width(*i);
            }
            of(&moved)
        };
        let value = at(&[]);
        let mut point = Self { value, gradient: vec![0.0; size], information: vec![vec![0.0; size]; size] };
        let is_free = |i: &usize| held != Some(*i);
        for i in (0..size).filter(is_free) {
            let [far_down, down, up, far_up] = [-2.0, -1.0, 1.0, 2.0].map(|by| at(&[(i, by)]));
            point.gradient[i] = (8.0 * (up - down) - (far_up - far_down)) / (12.0 * width(i));
            point.information[i][i] =
                -(16.0 * (up + down) - 30.0 * value - (far_up + far_down)) / (12.0 * width(i) * width(i));
            for j in (0..i).filter(is_free) {
                let corner = |a: f64, b: f64| at(&[(i, a), (j, b)]);
                let mixed = corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0);
                point.information[i][j] = -mixed / (4.0 * width(i) * width(j));
                point.information[j][i] = point.information[i][j];
            }
        }
        point
    }

    /// The sum of two likelihoods.
    pub fn add(&mut self, more: Self) {
        self.value += more.value;
        self.gradient.iter_mut().zip(more.gradient).for_each(|(entry, more)| *entry += more);
        let entries = self.information.iter_mut().flatten();
        entries.zip(more.information.into_iter().flatten()).for_each(|(entry, more)| *entry += more);
    }
}
