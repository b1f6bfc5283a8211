//! Formulas as text: `"120 mm"`, `"2*pi*speed*t"`, `"0.5*k*(R4.q - 10 deg)"`.
//! In: a text. Out: [`Expression`], names unresolved. Never knows what the names stand for.
//!
//! A unit follows its number and binds tighter than anything else: `2 mm^2` is two square millimetres.
//! A unit goes on through blanks (`N m`), powers, and `/` with a unit behind it (`m/s`, `N/(m s)`); through
//! `*` only if what follows is not a name of the file (`2 N*m`, but `2 Hz*t` is two hertz times the time).
//! Angles are pure numbers; there is no product by a blank between a number and a name.

mod expression;
mod lex;
mod parser;
mod unit_size;
mod units;

pub use expression::{Expression, Form, Operator, Relation, SyntaxError};

pub use unit_size::UnitSize;

use super::unit::Unit;

/// Longest formula [bytes]: far above any real one.
const LONGEST: usize = 2000;

/// The number and the unit of a text that is one quantity, as written: 120 and `mm`. None of a formula.
pub fn as_written(text: &str) -> Option<(f64, &str)> {
    parse_expression(text, &|_| false).ok()?.quantity()?;
    let text = text.trim();
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest.trim_start()));
    let tokens = lex::tokens(digits).ok()?;
    let first = tokens.first()?;
    match first.kind {
        lex::Kind::Number(number) => Some((sign * number, digits[first.range.end..].trim())),
        _ => None,
    }
}

/// Reads a unit; `1` is none.
pub fn unit_size(unit: &str) -> Option<UnitSize> {
    let read = |text: &str| parser::unit(&lex::tokens(text).ok()?, text.len());
    Some(UnitSize::of(if unit == "1" { Unit::ONE } else { read(unit).filter(|_| unit.len() <= LONGEST)? }))
}

/// Reads a formula. `is_name` says whether a word is a name of the file; it decides `2 N*m`.
///
/// # Errors
/// At the first place that cannot be read.
pub fn parse_expression(text: &str, is_name: &dyn Fn(&str) -> bool) -> Result<Expression, SyntaxError> {
    if text.len() > LONGEST {
        let message = format!("a formula of {} characters; {LONGEST} is the most", text.len());
        return Err(expression::fault(message, 0..text.len()).advise("split it into parameters"));
    }
    parser::parse(&lex::tokens(text)?, text.len(), is_name)
}

#[cfg(test)]
mod tests {
    use super::super::dimension::Dimension;
    use super::*;

    fn read(text: &str) -> Result<Expression, SyntaxError> {
        parse_expression(text, &|name| ["m", "s", "L1", "speed", "t", "pi"].contains(&name))
    }

    fn quantity(text: &str) -> (f64, Dimension) {
        read(text).unwrap().quantity().unwrap_or_else(|| panic!("{text} is more than a quantity"))
    }

    #[test]
    fn quantities_of_the_case_study_read_in_si() {
        let of = Dimension::of;
        for (text, value, dimension) in [
            ("120 mm", 0.12, of(1, 0, 0)),
            ("120mm", 0.12, of(1, 0, 0)),
            ("-9.81 m/s^2", -9.81, of(1, 0, -2)),
            ("7850 kg/m^3", 7850.0, of(-3, 1, 0)),
            ("2 N m s/rad", 2.0, of(2, 1, -1)),
            ("1e-4 N m s/rad", 1e-4, of(2, 1, -1)),
            ("210 GPa", 210e9, of(-1, 1, -2)),
            ("1e-8 m^3/(N m)", 1e-8, of(1, -1, 2)),
            ("10 1/s", 10.0, of(0, 0, -1)),
            ("10 s^-1", 10.0, of(0, 0, -1)),
            ("3 kN", 3000.0, of(1, 1, -2)),
            ("180 deg", std::f64::consts::PI, Dimension::NONE),
            ("5 %", 0.05, Dimension::NONE),
            ("2 t", 2000.0, of(0, 1, 0)),
        ] {
            assert_eq!(quantity(text), (value, dimension), "{text}");
        }
    }

    #[test]
    fn a_quantity_is_shown_as_written_and_a_formula_is_not() {
        assert_eq!(as_written("-9.81 m/s^2"), Some((-9.81, "m/s^2")));
        assert_eq!(as_written("120mm"), Some((120.0, "mm")));
        assert_eq!(as_written("0.3"), Some((0.3, "")));
        assert_eq!(as_written("2*L1"), None);
    }

    #[test]
    fn a_decimal_comma_is_called_by_its_name() {
        assert_eq!(read("160,05 mm").unwrap_err().help.as_deref(), Some("write `160.05`"));
    }

    #[test]
    fn a_unit_binds_to_its_number_first() {
        assert_eq!(quantity("2 mm^2"), (2e-6, Dimension::of(2, 0, 0)));
        let Form::Power(base, 2) = read("(2 mm)^2").unwrap().form else { panic!() };
        assert_eq!(base.quantity(), Some((2e-3, Dimension::LENGTH)));
    }

    #[test]
    fn a_star_before_a_name_is_a_product_and_before_a_unit_goes_on() {
        assert!(matches!(read("2 Hz*t").unwrap().form, Form::Binary(Operator::Mul, ..)));
        assert!(matches!(read("2 N*m").unwrap().form, Form::Binary(Operator::Mul, ..)), "m is a name here");
        let alone = parse_expression("2 N*m", &|_| false).unwrap();
        assert_eq!(alone.quantity(), Some((2.0, Dimension::TORQUE)));
    }

    #[test]
    fn a_slash_before_a_unit_goes_on_and_tells_if_the_unit_is_a_name_too() {
        let speed = read("10 m/s").unwrap();
        assert_eq!(speed.quantity(), Some((10.0, Dimension::of(1, 0, -1))));
        assert_eq!(speed.shadowed, [("s".to_owned(), 5..6)]);
        assert!(read("10 kg/m^3").unwrap().shadowed.len() == 1);
        assert!(read("10 N m").unwrap().shadowed.is_empty(), "no other reading, no warning");
        assert!(
            matches!(read("10/s").unwrap().form, Form::Binary(Operator::Div, ..)),
            "no unit before the slash"
        );
    }

    #[test]
    fn a_blank_product_behind_a_slash_is_refused() {
        let error = read("2 kg/m s").unwrap_err();
        assert!(error.unit);
        assert_eq!(error.help.as_deref(), Some("write `kg/(m s)` or `kg s/m`"));
    }

    #[test]
    fn unary_minus_is_weaker_than_a_power_and_stronger_than_a_product() {
        let Form::Neg(inner) = read("-L1^2").unwrap().form else { panic!() };
        assert!(matches!(inner.form, Form::Power(_, 2)));
        assert!(matches!(read("-L1*2").unwrap().form, Form::Binary(Operator::Mul, ..)));
        assert!(matches!(read("L1^-2").unwrap().form, Form::Power(_, -2)));
    }

    #[test]
    fn mistakes_are_found_where_they_are() {
        for (text, range) in [
            ("2 foo", 2..5),
            ("2 pi", 2..4),
            ("2 speed", 2..7),
            ("L1 + ", 5..5),
            ("(L1", 3..3),
            ("L1 L1", 3..5),
            ("L1^0.5", 3..6),
            ("2 $ 3", 2..3),
            ("", 0..0),
            ("1e999", 0..5),
        ] {
            assert_eq!(read(text).unwrap_err().range, range, "{text}");
        }
    }

    #[test]
    fn deep_and_long_formulas_are_refused_not_overflowed() {
        assert!(read(&"(".repeat(1000)).is_err());
        assert!(read(&"-".repeat(1000)).is_err());
        assert!(read(&format!("1{}", "+1".repeat(3000))).is_err());
        assert!(read(&format!("1{}", "+1".repeat(950))).is_ok());
    }

    proptest::proptest! {
        #[test]
        fn no_text_panics(text in "[ 0-9a-z.*/^()<>=+,µ-]{0,40}") {
            if let Err(error) = read(&text) {
                proptest::prop_assert!(error.range.end <= text.len() && text.get(error.range).is_some());
            }
        }
    }
}
