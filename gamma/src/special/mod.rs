//! Special functions of the Gamma law and the normal law. In and out: numbers. Never knows wear.
//!
//! Everything goes through `libm`, so that debug and release builds give the same bits. The incomplete Gamma function is
//! given by its logarithm, which is still needed where the function itself is 0 or 1 in all digits.

mod gamma_ratio;
mod incomplete;
mod inverse_gaussian;
mod ln_gamma;
mod normal;
mod polygamma;
mod quantile;
mod reflected_normal;
mod root;
mod shape_slope;
mod student;

pub use gamma_ratio::{f_above, gamma_ratio, ln_gamma_ratio_below, ln_rising};
pub use incomplete::{gamma_p, gamma_q, ln_gamma_p, ln_gamma_p_of_ln, ln_gamma_q};
pub use inverse_gaussian::inverse_gaussian;
pub use ln_gamma::{EULER, LARGE_SHAPE, ln_gamma, ln_gamma_1p, ln_ratio, stirling_rest};
pub use normal::{LN_2_PI, normal_cdf, normal_density, normal_mills, normal_quantile};
pub use polygamma::{digamma, ln_less_digamma, tetragamma, trigamma, trigamma_rest};
pub use quantile::{gamma_quantile, ln_gamma_quantile};
pub use reflected_normal::{ln_above_reflected, ln_reflected_normal, reflected_normal};
pub(crate) use root::{guarded, rising_root, rising_root_within};
pub use shape_slope::ln_gamma_p_slope;
pub use student::student_bound;

#[cfg(test)]
mod tests;
