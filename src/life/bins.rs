//! Whether bins of a bearing are fine enough for the depth that decides. In: a joint, worn. Out: what is to be said. Never lives
//! anything.

use std::f64::consts::TAU;

use linkwear_runtime::life::{JointLife, WearOf, WearState};
use linkwear_runtime::wear::Measure;

/// Part of W that bins may leave out without a word.
const LEFT_OUT: f64 = 0.01;
/// Bins that are advised are a multiple of these.
const BINS: f64 = 36.0;
/// The most that `bins` takes.
const MOST_BINS: f64 = 1e4;

/// What is to be said of a joint whose W is the largest depth, where that is of a place as narrow as a bin.
pub(super) fn too_coarse((joint, state): (&JointLife, &WearState)) -> Option<String> {
    let (WearOf::Profile(Measure::Maximum), Some(bins)) = (joint.wear, joint.bins) else { return None };
    let half_width = state.half_angle;
    let surfaces = || [&state.profile, &state.journal].into_iter().flatten();
    let part = surfaces().map(|profile| profile.deeper_within_bin(half_width)).sum::<f64>() / state.wear;
    if part.is_nan() || part <= LEFT_OUT {
        return None;
    }
    let narrow = surfaces().any(|profile| profile.is_narrow(half_width));
    let deg = 360.0 / bins as f64;
    let place = if narrow {
        format!("its contact is {:.3} deg wide", (2.0 * half_width).to_degrees())
    } else {
        "its deepest place is nearly as narrow".to_owned()
    };
    let enough = if narrow {
        TAU / (half_width * widest_bin())
    } else {
        // What is left out goes with the square of the width of a bin.
        bins as f64 * (part / LEFT_OUT).sqrt()
    };
    let enough = (enough / BINS).ceil() * BINS;
    let advice = if enough <= MOST_BINS {
        format!("`bins = {enough}` in [wear] tell it to a per cent")
    } else if bins as f64 >= MOST_BINS {
        "no more bins are possible".to_owned()
    } else {
        let left = if narrow {
            format!(", which leave it up to {}", deeper(1.0 / held(TAU / MOST_BINS / half_width) - 1.0))
        } else {
            String::new()
        };
        format!("that takes {enough} `bins` in [wear]; {MOST_BINS} are possible{left}")
    };
    Some(format!(
        "{}: W is the largest depth of bins of {deg:.3} deg, and {place}: it may be {}, and the life shorter by as much; {advice}",
        joint.joint,
        deeper(part)
    ))
}

/// By how much something is deeper, as a part.
fn deeper(part: f64) -> String {
    if part < 1.0 {
        format!("{:.0} % deeper", 100.0 * part)
    } else {
        format!("{:.1} times as deep", 1.0 + part)
    }
}

/// Part of the depth of a half ellipse that a bin tells whose border lies at its middle, by the width of the bin in half-widths.
fn held(width: f64) -> f64 {
    if width < 1.0 {
        0.5 * ((1.0 - width * width).sqrt() + width.asin() / width)
    } else {
        TAU / (8.0 * width)
    }
}

/// Width of a bin in half-widths of a contact that leaves out what may be: [`held`] is 1 - width^2/6 there.
fn widest_bin() -> f64 {
    (6.0 * LEFT_OUT).sqrt()
}

#[cfg(test)]
mod tests {
    use linkwear_runtime::wear::Profile;

    use super::*;

    #[test]
    fn a_bin_holds_what_a_deposit_leaves_in_it() {
        for width in [0.1, widest_bin(), 0.7, 1.0, 1.7, 30.0] {
            let mut profile = Profile::unworn(72).expect("bins");
            let bin = profile.bin_angle();
            profile.deposit(0.0, bin / width, 1.0);
            let deepest = 2.0 * width / (TAU / 2.0 * bin);
            assert!((profile.maximum() / deepest / held(width) - 1.0).abs() < 1e-9, "{width}");
        }
        assert!((held(widest_bin()) - (1.0 - LEFT_OUT)).abs() < 1e-4);
    }
}
