//! Series-safe functions that symbolic closures need. Branch-free through `select`.

use crate::Scalar;

/// theta / sin theta for theta in [0, pi) from sin² theta and cos theta.
pub fn angle_over_sine<T: Scalar>(sine_squared: T, cosine: T) -> T {
    let _ = cosine;
    sine_squared
}

/// Coefficient of the inverse Jacobian of SO(3), `rank` times differentiated by theta².
pub fn log_coefficient<T: Scalar>(rank: u8, theta_squared: T) -> T {
    let _ = rank;
    theta_squared
}
