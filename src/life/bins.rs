//! Whether bins of a bearing are fine enough for the depth that decides. In: a joint, worn. Out: what is to be said. Never lives
//! anything.

use linkwear_runtime::life::{JointLife, WearOf, WearState};
use linkwear_runtime::wear::{Measure, Profile};

/// Part of W that bins may leave out without a word.
const LEFT_OUT: f64 = 0.01;
/// Bins that are advised are a multiple of these, and no more than ten for each degree.
const BINS: f64 = 36.0;
const MOST_BINS: f64 = 3600.0;

/// What is to be said of a joint whose W is the largest depth, where that is of a place as narrow as a bin.
pub(super) fn too_coarse((joint, state): (&JointLife, &WearState)) -> Option<String> {
    let (WearOf::Profile(Measure::Maximum), Some(bins)) = (joint.wear, joint.bins) else { return None };
    let surfaces = [&state.profile, &state.journal].into_iter().flatten();
    let part = surfaces.map(Profile::deeper_within_bin).sum::<f64>() / state.wear;
    if part.is_nan() || part <= LEFT_OUT {
        return None;
    }
    // What is left out goes with the square of the width of a bin.
    let enough = (bins as f64 * (part / LEFT_OUT).sqrt() / BINS).ceil() * BINS;
    Some(format!(
        "{}: W is the largest depth of bins of {:.3} deg, and its deepest place is nearly as narrow: it may be {:.0} % deeper, and the \
         life shorter by as much; `bins = {:.0}` in [wear] tell it to a per cent",
        joint.joint,
        360.0 / bins as f64,
        100.0 * part,
        enough.min(MOST_BINS)
    ))
}
