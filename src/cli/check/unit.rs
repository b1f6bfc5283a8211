//! Units of dimensions as people read them.

use linkwear_codegen::spec::Dimension;

/// SI unit of a dimension in base units: `kg m^-3`.
pub fn unit(dimension: Dimension) -> String {
    let parts = [("kg", dimension.mass), ("m", dimension.length), ("s", dimension.time)];
    let shown: Vec<String> = parts
        .into_iter()
        .filter(|(_, exponent)| *exponent != 0)
        .map(|(name, exponent)| if exponent == 1 { name.to_owned() } else { format!("{name}^{exponent}") })
        .collect();
    if shown.is_empty() { "1".to_owned() } else { shown.join(" ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_written_in_base_units() {
        assert_eq!(unit(Dimension { length: -3, mass: 1, time: 0 }), "kg m^-3");
        assert_eq!(unit(Dimension { length: 1, mass: 0, time: -2 }), "m s^-2");
        assert_eq!(unit(Dimension::default()), "1");
    }
}
