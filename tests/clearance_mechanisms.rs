//! Shipped mechanisms with clearance run: contact resolved, energy accounted for, wear positive.

mod support;

use std::f64::consts::TAU;

use linkwear_codegen::source::SourceFile;
use linkwear_codegen::{Options, compile};
use linkwear_runtime::{Evaluator, Integrator, Settings, Span, assemble_static_contact};
use support::{compile_source, compiled, run_with, shipped};

/// A few turns at a tolerance that resolves every impact.
fn check(name: &str, turns: f64) {
    let compiled = compiled(name, &[], None);
    let method = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };
    let run = run_with(&compiled, &Settings::new(method, Span::Turns(turns), 11)).run;
    let statistics = &run.statistics;
    println!("{name}: {statistics:?}\n{:?}\n{:?}", run.turns, run.warnings);
    assert!(run.rows.iter().flatten().all(|value| value.is_finite()));
    // Friction, damping of the contacts and of the joints included.
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "{name}: {:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
    assert_eq!(run.turns.len(), turns as usize);
    let contacts = &compiled.description().contacts;
    for (contact, turn) in run.turns.iter().flat_map(|turn| contacts.iter().zip(turn)) {
        let wears = contact.wear.is_some();
        assert!(turn.wear_integral > 0.0 && (turn.depth > 0.0) == wears, "{name}: {turn:?}");
    }
}

#[test]
fn a_loose_pin_flies_and_hits_at_5000_rpm() {
    check("slider_crank_clearance", 3.0);
}

#[test]
fn a_four_bar_wears_at_two_bearings() {
    check("four_bar_wear", 2.0);
}

#[test]
fn a_loose_ball_wears() {
    check("rssr_ball_wear", 1.0);
}

/// What a user is told about a file.
fn refusal(source: &SourceFile, overrides: &[(&str, &str)]) -> String {
    let overrides = overrides.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
    let options = Options { overrides, ..Options::default() };
    compile(source, &options).map(drop).expect_err("its parts do not reach each other").to_string()
}

/// Two bearings that wear, with a part of the text replaced.
fn four_bar(from: &str, to: &str) -> SourceFile {
    let source = shipped("four_bar_wear");
    assert!(source.text.contains(from));
    SourceFile { text: source.text.replace(from, to), ..source }
}

#[test]
fn parts_that_do_not_reach_each_other_are_refused_at_their_joint() {
    let guesses = "[assembly]\nR2 = \"56 deg\"\nR4 = \"97 deg\"\n";
    let axis = "at = \"C\", axis = [0, 0, 1]";
    let cases = [
        ("R1", shipped("rssr"), &[("L2", "42 mm")][..]),
        // The coupler misses both of its bearings alike.
        ("R3", four_bar(guesses, ""), &[]),
        ("R3", four_bar(axis, "at = \"C\", axis = [0, 1, 0]"), &[]),
        // Scaled up, the same.
        ("R3", four_bar(guesses, ""), &[("a", "1 km"), ("b", "3 km"), ("c", "2.5 km"), ("d", "3 km")]),
    ];
    for (joint, source, overrides) in cases {
        let text = refusal(&source, overrides);
        assert!(text.contains("E0601") && text.contains(&format!("the parts of joint `{joint}`")), "{text}");
    }
}

#[test]
fn a_linkage_that_closes_thanks_to_its_clearances_starts_within_them() {
    // Crank, coupler and rocker in line, 30 um too short for their pivots; 20 um of clearance at either end.
    let source = four_bar("R2 = \"56 deg\"\nR4 = \"97 deg\"", "R2 = \"0 deg\"\nR4 = \"180 deg\"");
    let compiled = compile_source(&source, &[("d", "650.03 mm")], None);
    let system = compiled.interpreter();
    let mut evaluator =
        Evaluator::new(&system, compiled.description(), &compiled.parameters()).expect("it fits");
    let start = assemble_static_contact(&mut evaluator, 0.0).expect("it closes");
    evaluator.evaluate_contacts(0.0, &start.q, &start.v);
    for touch in evaluator.clearances().contacts() {
        // The shortest offsets share what is missing; Gauss-Newton ends within a millionth.
        assert!((touch.offset[0].hypot(touch.offset[1]) - 15e-6).abs() < 1e-10, "{:?}", touch.offset);
    }
}

#[test]
fn a_journal_in_the_tree_and_one_across_a_cut_tell_which_place_of_theirs_touches() {
    let run = |more: &str| {
        let source = four_bar("area = \"hertz\"", &format!("area = \"hertz\"\nmeasure = \"mean\"\n{more}"));
        let compiled = compile_source(&source, &[], None);
        let method = Integrator::Dopri5 { tolerance: 1e-8, max_step: None };
        run_with(&compiled, &Settings::new(method, Span::Turns(1.0), 31)).run
    };
    let wearing = run("hardness_ratio = 0.5\ncoefficient_factor = 2");
    for joint in ["R2", "R3"] {
        let column = |name: &str| wearing.column(&format!("{joint}.{name}")).expect("a column");
        let angles = column("contact_angle").into_iter().zip(column("q")).zip(column("journal_angle"));
        for ((contact, turned), journal) in angles {
            let apart = (contact - turned - journal).rem_euclid(TAU);
            // A few roundings of angles below two turns.
            assert!(apart.min(TAU - apart) < 1e-14, "{joint}: {contact} {turned} {journal}");
        }
    }
    let plain = run("");
    for (own, other) in wearing.turns.iter().flatten().zip(plain.turns.iter().flatten()) {
        // Wear moves nothing within a run: the same bits, but for a factor of two.
        assert_eq!((own.wear_integral, own.depth), (other.wear_integral, 2.0 * other.depth));
        let (bush, journal) =
            (own.deposit.as_ref().expect("a profile"), own.journal.as_ref().expect("a profile"));
        // 20 um on 8 mm: the bush is so much larger; a thousand steps round.
        let volumes = journal.mean() / (bush.mean() * (8e-3 + 20e-6) / 8e-3);
        assert!((volumes - 0.5).abs() < 1e-12, "{volumes}");
        assert!((bush.mean() / other.deposit.as_ref().expect("a profile").mean() - 2.0).abs() < 1e-12);
        assert!(other.journal.is_none());
    }
}
