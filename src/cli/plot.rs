//! A curve in one line of text, or in two where it swings faster than a line shows.

const LEVELS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The envelope of a curve, piece by piece, as a line of blocks through its middle, lowest to highest; constant curves are
/// a low line. Where a piece holds more than its neighbours tell, the upper and the lower side have a line each.
pub fn sparklines(envelope: &[(f64, f64)]) -> Vec<String> {
    let (low, high) = range(envelope);
    let level = |value: f64| {
        let part = if high > low { (value - low) / (high - low) } else { 0.0 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 8")]
        let level = (part * 8.0) as usize;
        level.min(7)
    };
    let line = |side: fn(&(f64, f64)) -> f64| -> Vec<usize> {
        envelope.iter().map(|piece| level(side(piece))).collect()
    };
    let [lower, middle, upper] =
        [line(|piece| piece.0), line(|piece| 0.5 * (piece.0 + piece.1)), line(|piece| piece.1)];
    let told = |at: usize| {
        let near = &middle[at.saturating_sub(1)..(at + 2).min(middle.len())];
        let (least, most) =
            near.iter().fold((7, 0), |(least, most), level| (least.min(*level), most.max(*level)));
        upper[at] <= most + 1 && lower[at] + 1 >= least
    };
    let lines = if (0..middle.len()).all(told) { vec![middle] } else { vec![upper, lower] };
    lines.into_iter().map(|levels| levels.into_iter().map(|level| LEVELS[level]).collect()).collect()
}

/// Smallest and largest value of an envelope.
fn range(envelope: &[(f64, f64)]) -> (f64, f64) {
    envelope
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), piece| (low.min(piece.0), high.max(piece.1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_climbs_through_all_levels_and_fast_swings_show_both_sides() {
        let ramp: Vec<_> = (0..8).map(|at| (f64::from(at), f64::from(at + 1))).collect();
        assert_eq!(sparklines(&ramp), ["▁▂▃▄▅▆▇█"]);
        assert_eq!(sparklines(&[(1.0, 1.0), (1.0, 1.0)]), ["▁▁"]);
        assert_eq!(sparklines(&[]), [""]);
        assert_eq!(sparklines(&[(0.0, 0.0), (0.0, 8.0), (0.0, 0.0)]), ["▁█▁", "▁▁▁"]);
    }
}
