//! Closure `log`, [CS (3)], against closure `joint`: two derivations of the same motion.

mod support;
mod truth;

use linkwear_codegen::model::Closure;
use linkwear_runtime::Span;
use support::{Recorded, compiled, largest_difference, run};
use truth::reached;

/// Both runs solve the same equations at tolerance 1e-12; what is left is integration error.
const SAME: f64 = 1e-9;

/// Largest value of a column.
fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Whether a column is a component of an orientation.
fn is_quaternion(column: &str) -> bool {
    ["q0", "q1", "q2", "q3"].iter().any(|suffix| column.ends_with(&format!(".{suffix}")))
}

/// Compares every column that both forms have, against the largest value of its kind: the largest difference.
fn assert_same(name: &str, joint: &Recorded, log: &Recorded, non_unique: &[String], idle: bool) -> f64 {
    let names: Vec<String> = joint.description.channels.iter().map(|c| c.name.to_string()).collect();
    let kind = |name: &str| {
        let quantity = name.split_once('.').map_or(name, |(_, quantity)| quantity);
        quantity.chars().filter(|c| !"xyz".contains(*c)).collect::<String>()
    };
    // The angle of an idle spin is wherever assembly happened to leave it; the spin itself must agree.
    let idle_angle = |column: &str| idle && is_quaternion(column);
    let mut worst: f64 = 0.0;
    for column in names.iter().filter(|column| !column.contains(".lambda")) {
        if idle_angle(column) || non_unique.contains(column) {
            continue;
        }
        let (a, b) = (joint.column(column), log.column(column));
        let scale = names
            .iter()
            .filter(|other| kind(other) == kind(column))
            .map(|other| if other.contains(".lambda") { 0.0 } else { size(&joint.column(other)) })
            .fold(1e-30, f64::max);
        let error = largest_difference(&a, &b) / scale;
        assert!(error < SAME, "{name}: {column} differs by {error:e} of {scale:e}");
        worst = worst.max(error);
    }
    worst
}

fn compare(name: &str, span: Span) {
    let forms = [Closure::Joint, Closure::Log].map(|closure| compiled(name, &[], Some(closure)));
    assert_eq!(forms[0].analysis.mobility, forms[1].analysis.mobility);
    let unique = |form: usize| {
        let mut list = forms[form].analysis.non_unique.clone();
        list.sort();
        list
    };
    assert_eq!(unique(0), unique(1), "{name}: both forms leave the same reactions open");
    let runs = [0, 1].map(|form| run(&forms[form], span, Span::Time(0.0), 26, 1e-12));
    let idle = !forms[0].analysis.idle.is_empty();
    let error = assert_same(name, &runs[0], &runs[1], &forms[0].analysis.non_unique, idle);
    reached(
        "closure `log` against closure `joint`",
        &format!("{name}, of each kind's largest value"),
        error,
        SAME,
    );
}

#[test]
fn rssr() {
    compare("rssr_rigid", Span::Turns(1.0));
}

#[test]
fn four_bar() {
    compare("four_bar", Span::Time(0.5));
}

#[test]
fn bennett() {
    compare("bennett", Span::Time(0.5));
}

#[test]
fn bricard() {
    compare("bricard", Span::Time(0.5));
}

#[test]
fn andrews() {
    compare("andrews", Span::Time(0.005));
}
