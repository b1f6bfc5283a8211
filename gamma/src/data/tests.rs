//! Readings turned into increments, and those that cannot be.

use super::*;

fn readings(rows: &[(&str, f64, f64)]) -> Vec<Reading> {
    let reading = |(at, (unit, exposure, wear)): (usize, &(&str, f64, f64))| Reading {
        unit: (*unit).to_owned(),
        exposure: *exposure,
        wear: *wear,
        covariates: Vec::new(),
        row: at + 2,
        ..Reading::default()
    };
    rows.iter().enumerate().map(reading).collect()
}

fn refused(rows: &[(&str, f64, f64)], gauge: Gauge) -> DataError {
    Observations::new(&readings(rows), false, gauge).unwrap_err()
}

#[test]
fn increments_are_taken_within_units_even_when_their_rows_are_mixed() {
    let rows = readings(&[("a", 1.0, 2.0), ("b", 1.0, 1.0), ("a", 3.0, 5.0), ("b", 2.0, 4.0)]);
    let seen = Observations::new(&rows, false, Gauge::Exact).unwrap();
    let found: Vec<_> = seen.increments.iter().map(|i| (i.unit, i.from, i.to, i.wear, i.row)).collect();
    assert_eq!(found, [(0, 1.0, 3.0, 3.0, 4), (1, 1.0, 2.0, 3.0, 5)]);
    let seen = Observations::new(&rows, true, Gauge::Exact).unwrap();
    assert_eq!(seen.increments.len(), 4);
    assert_eq!((seen.increments[0].from, seen.increments[0].wear), (0.0, 2.0));
}

#[test]
fn every_fault_names_its_row_and_a_cure() {
    let faults = [
        (refused(&[("a", 2.0, 1.0), ("a", 1.0, 2.0)], Gauge::Exact), 3, "goes back"),
        (refused(&[("a", 2.0, 1.0), ("a", 2.0, 2.0)], Gauge::Exact), 3, "twice"),
        (refused(&[("a", 1.0, 1.0), ("a", 2.0, 2.0), ("b", 1.0, 1.0)], Gauge::Exact), 4, "one reading"),
        (refused(&[("a", 1.0, 1.0), ("a", 2.0, f64::NAN)], Gauge::Exact), 3, "NaN"),
        (refused(&[("a", -1.0, 1.0), ("a", 2.0, 3.0)], Gauge::Exact), 2, "exposure is -1"),
        (refused(&[("a", 1.0, 1.0), ("a", 2.0, 1.0)], Gauge::Exact), 2, "constant"),
    ];
    for (fault, row, words) in faults {
        assert_eq!(fault.row(), Some(row), "{fault}");
        assert!(fault.to_string().contains(words) && !fault.cure().is_empty(), "{fault}");
    }
    assert_eq!(Observations::new(&[], false, Gauge::Exact), Err(DataError::Empty));
}

#[test]
fn all_rows_that_do_not_grow_are_named_and_zeros_pass_with_a_resolution() {
    let rows = [("a", 1.0, 1.0), ("a", 2.0, 1.0), ("a", 3.0, 2.0), ("b", 1.0, 3.0), ("b", 2.0, 2.5)];
    let text = refused(&rows, Gauge::Exact).to_string();
    assert!(
        text.contains("row 3 (unit a: 1 after 1)") && text.contains("row 6 (unit b: 2.5 after 3)"),
        "{text}"
    );
    let DataError::NotIncreasing(bad) = refused(&rows, Gauge::Resolution(Rounding::to(0.5))) else {
        panic!()
    };
    assert_eq!(bad.len(), 1);
    assert!(Observations::new(&readings(&rows), false, Gauge::Noisy).is_ok());
    let errs = Gauge::Resolution(Rounding { step: 0.5, error: 0.2 });
    assert!(Observations::new(&readings(&[("a", 1.0, 1.0), ("a", 2.0, 0.5)]), false, errs).is_ok());
    let off = refused(&[("a", 1.0, 1.0), ("a", 2.0, 1.6)], Gauge::Resolution(Rounding::to(0.5)));
    assert!(off.row() == Some(3) && off.to_string().contains("no multiple"), "{off}");
}

#[test]
fn of_many_rows_that_do_not_grow_the_first_are_named_and_the_others_counted() {
    let rows: Vec<(&str, f64, f64)> = (0..50).map(|at| ("a", f64::from(at), f64::from(-at))).collect();
    let fault = refused(&rows, Gauge::Exact);
    let text = fault.to_string();
    assert!(
        text.starts_with("49 increment(s)") && text.ends_with("row 12 (unit a: -10 after -9), and 39 more")
    );
    assert!(!text.contains("row 13") && fault.row() == Some(3), "{text}");
    let text = refused(&rows[..11], Gauge::Exact).to_string();
    assert!(text.contains("row 12") && !text.contains("more"), "{text}");
}

#[test]
fn of_a_hundred_thousand_units_each_has_its_readings_and_each_bad_row_is_found() {
    // Minutes, if each unit looked through all rows: twenty thousand million comparisons of names.
    let mut rows = Vec::new();
    for unit in 0..100_000 {
        for at in [0.0, 1.0] {
            rows.push(Reading {
                unit: unit.to_string(),
                row: rows.len() + 2,
                exposure: at,
                wear: at,
                ..Reading::default()
            });
        }
    }
    let seen = Observations::new(&rows, false, Gauge::Exact).unwrap();
    assert_eq!(
        (seen.units.len(), &*seen.units[70_000], seen.increments[70_000].row),
        (100_000, "70000", 140_003)
    );
    rows.iter_mut().filter(|row| row.row > 3).for_each(|row| row.wear = 0.0);
    let refused = Observations::new(&rows, false, Gauge::Exact).unwrap_err();
    assert!(matches!(&refused, DataError::NotIncreasing(bad) if bad.len() == 99_999), "{refused}");
}

/// A reading with what was done to the part after it.
fn row(unit: &str, exposure: f64, wear: f64, reset: Option<Reset>) -> Reading {
    let row = libm::round(exposure) as usize;
    Reading { unit: unit.to_owned(), exposure, wear, row, reset, ..Reading::default() }
}

fn seen(exposure: f64, wear: f64, seen: Seen) -> Reading {
    Reading { seen, ..row("a", exposure, wear, None) }
}

/// Unit, from, to, wear, what is known.
type Found = (usize, f64, f64, f64, Known);

fn found(observations: &Observations) -> Vec<Found> {
    observations.increments.iter().map(|one| (one.unit, one.from, one.to, one.wear, one.known)).collect()
}

#[test]
fn parts_that_are_replaced_age_anew_and_parts_that_are_reground_age_on() {
    let rows = [
        row("a", 10.0, 1.0, None),
        row("a", 20.0, 2.0, Some(Reset::Replaced(Some(0.0)))),
        row("a", 25.0, 0.5, None),
        row("a", 30.0, 1.5, Some(Reset::Reground(Some(0.25)))),
        row("a", 40.0, 1.0, Some(Reset::Reground(None))),
        row("a", 40.0, 0.5, None),
        row("a", 50.0, 0.75, Some(Reset::Replaced(None))),
        row("a", 60.0, 0.125, None),
        row("a", 70.0, 0.25, Some(Reset::Reground(Some(0.0625)))),
    ];
    let (data, wear) = Observations::with_wear(&rows, true, Gauge::Exact).unwrap();
    assert_eq!(data.units, ["a", "a#2", "a#3"]);
    let expected = [
        (0, 0.0, 10.0, 1.0, Known::Exact),
        (0, 10.0, 20.0, 1.0, Known::Exact),
        (1, 0.0, 5.0, 0.5, Known::FromLevel),
        (1, 5.0, 10.0, 1.0, Known::Exact),
        (1, 10.0, 20.0, 0.75, Known::FromLevel),
        (1, 20.0, 30.0, 0.25, Known::Anew),
        (2, 10.0, 20.0, 0.125, Known::Exact),
    ];
    assert_eq!(found(&data), expected);
    // Two were taken out; the last was set to a level after its last reading.
    assert!(wear[0].is_nan() && wear[1].is_nan(), "{wear:?}");
    assert_eq!(wear[2], 0.0625);
    assert!(data.is_plain());
}

#[test]
fn bounds_stand_between_known_wear_and_the_next() {
    let rows = [
        seen(1.0, 0.25, Seen::Below),
        seen(2.0, 0.5, Seen::Below),
        seen(3.0, 1.0, Seen::Exact),
        seen(4.0, 1.75, Seen::Below),
        Reading { reset: Some(Reset::Reground(Some(0.5))), ..seen(5.0, 2.0, Seen::Below) },
        seen(6.0, 3.0, Seen::AtLeast),
        seen(7.0, 3.0, Seen::AtLeast),
    ];
    let (data, wear) = Observations::with_wear(&rows, true, Gauge::Exact).unwrap();
    // Of bounds in a row on wear that does not fall the last says all.
    let expected = [
        (0, 0.0, 3.0, 1.0, Known::Through { at: 2.0, below: 0.5 }),
        (0, 3.0, 5.0, 1.0, Known::Below),
        (0, 5.0, 6.0, 2.5, Known::AtLeast),
    ];
    assert_eq!(found(&data), expected);
    assert!(wear[0].is_nan() && data.has_bounds());
}

#[test]
fn readings_that_no_part_can_have_are_refused_with_row_and_cure() {
    let refused = |rows: &[Reading], from_zero: bool, gauge: Gauge| {
        Observations::new(rows, from_zero, gauge).expect_err("cannot be")
    };
    let fine = seen(1.0, 1.0, Seen::Exact);
    let entered = |limit: f64, row: &Reading| Reading { entered_below: Some(limit), ..row.clone() };
    let cases = [
        (
            refused(&[seen(2.0, 1.0, Seen::Below), fine.clone()], false, Gauge::Exact),
            2,
            "before it is not known",
        ),
        (refused(&[fine.clone(), seen(2.0, 0.5, Seen::AtLeast)], false, Gauge::Exact), 2, "passed before"),
        (refused(&[fine.clone(), seen(2.0, 0.5, Seen::Below)], false, Gauge::Exact), 2, "passed before"),
        (
            refused(
                &[fine.clone(), seen(2.0, 3.0, Seen::AtLeast), seen(3.0, 4.0, Seen::Exact)],
                false,
                Gauge::Exact,
            ),
            3,
            "passed the gauge's range",
        ),
        (
            refused(
                &[fine.clone(), seen(2.0, 3.0, Seen::Below), seen(3.0, 4.0, Seen::AtLeast)],
                false,
                Gauge::Exact,
            ),
            3,
            "right after an upper one",
        ),
        (
            refused(
                &[fine.clone(), seen(2.0, 3.0, Seen::Below), seen(3.0, 3.0, Seen::Below)],
                false,
                Gauge::Noisy,
            ),
            3,
            "second bound",
        ),
        (
            refused(
                &[fine.clone(), seen(2.0, 3.0, Seen::AtLeast)],
                false,
                Gauge::Resolution(Rounding::to(1.0)),
            ),
            2,
            "together with a resolution",
        ),
        (
            refused(&[entered(0.5, &fine), entered(0.5, &seen(2.0, 2.0, Seen::Exact))], false, Gauge::Exact),
            1,
            "not below the limit of entry",
        ),
        (
            refused(&[entered(1.5, &fine), seen(2.0, 2.0, Seen::Exact)], false, Gauge::Exact),
            2,
            "another limit",
        ),
        (
            refused(
                &[row("a", 1.0, 1.0, Some(Reset::Reground(Some(-1.0)))), row("a", 2.0, 2.0, None)],
                false,
                Gauge::Exact,
            ),
            1,
            "level of wear after a reset is -1",
        ),
        // Wear at one exposure after a reset to a level that is known: two numbers for one thing.
        (
            refused(
                &[row("a", 1.0, 1.0, Some(Reset::Reground(Some(0.5)))), row("a", 1.0, 0.25, None)],
                false,
                Gauge::Exact,
            ),
            1,
            "twice",
        ),
        (
            refused(
                &[
                    row("a", 1.0, 1.0, Some(Reset::Replaced(Some(0.0)))),
                    row("a", 2.0, 0.5, None),
                    row("a#2", 3.0, 1.0, None),
                    row("a#2", 4.0, 2.0, None),
                ],
                true,
                Gauge::Exact,
            ),
            1,
            "would be called a#2",
        ),
    ];
    for (fault, row, words) in cases {
        assert_eq!(fault.row(), Some(row), "{fault}");
        assert!(fault.to_string().contains(words) && !fault.cure().is_empty(), "{words}: {fault}");
    }
}
