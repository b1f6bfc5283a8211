//! Rockwell C numbers of steel as pressures.
//! In: a number. Out: the pressure of the Vickers number beside it in the table for non-austenitic steels of ASTM E140
//! (hardness conversion tables for metals, table 1), linear between its rows. Never knows formulas.

/// Vickers numbers of 20 to 68 HRC.
const VICKERS: [f64; 49] = [
    238.0, 243.0, 248.0, 254.0, 260.0, 266.0, 272.0, 279.0, 286.0, 294.0, 302.0, 310.0, 318.0, 327.0, 336.0,
    345.0, 354.0, 363.0, 372.0, 382.0, 392.0, 402.0, 412.0, 423.0, 434.0, 446.0, 458.0, 471.0, 484.0, 498.0,
    513.0, 528.0, 544.0, 560.0, 577.0, 595.0, 613.0, 633.0, 653.0, 674.0, 697.0, 720.0, 746.0, 772.0, 800.0,
    832.0, 865.0, 900.0, 940.0,
];

/// Numbers that the table has.
pub(super) const RANGE: [f64; 2] = [20.0, 68.0];

/// A Vickers number is kgf/mm^2 [Pa].
const VICKERS_UNIT: f64 = 9_806_650.0;

/// The pressure of a Rockwell C number [Pa]; `None` outside the table.
pub(super) fn pressure(number: f64) -> Option<f64> {
    let [lowest, highest] = RANGE;
    if !(lowest..=highest).contains(&number) {
        return None;
    }
    let above = number - lowest;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 48")]
    let row = above.floor() as usize;
    let here = VICKERS.get(row)?;
    let next = VICKERS.get(row + 1).unwrap_or(here);
    Some((here + (above - above.floor()) * (next - here)) * VICKERS_UNIT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_met_and_there_is_nothing_beyond_them() {
        for (number, vickers) in [(20.0, 238.0), (40.0, 392.0), (60.0, 697.0), (68.0, 940.0), (60.5, 708.5)] {
            assert_eq!(pressure(number), Some(vickers * VICKERS_UNIT), "{number}");
        }
        for number in [19.9, 68.1, f64::NAN] {
            assert_eq!(pressure(number), None, "{number}");
        }
    }

    #[test]
    fn harder_steel_has_the_larger_number() {
        assert!(VICKERS.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(VICKERS.len(), 49);
    }
}
