//! Generated equations against an independent numeric model (crate `linkwear-oracle`: absolute coordinates,
//! every joint a set of rows, no tree, no symbols), along the motion of shipped and of random mechanisms.
//!
//! A short run gives states away from the reference pose, with drives at work. At each of them the oracle is
//! put into the same state by the output columns, and must see the same accelerations, drive forces, joint
//! wrenches (where unique) and energies.

mod agreement;
mod support;
mod truth;

use std::collections::HashSet;

use agreement::compare;
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_oracle::Kind;
use linkwear_oracle::Oracle;
use linkwear_oracle::random::Recipe;
use linkwear_runtime::{Integrator, Settings, Span, Watch, simulate};

use support::{compile_source, in_data, shipped};
use truth::reached;

/// Largest share of a quantity's scale by which the two may differ. Both are exact up to rounding; loops are
/// closed to about 1e-13, and near singular positions that is amplified by up to 500, twice.
const AGREEMENT: f64 = 1e-8;
/// Samples of a run, both ends included.
const SAMPLES: usize = 5;

/// Runs for some time, or until a driver meets a dead point, and compares what was recorded: the largest difference.
fn check(source: &SourceFile, closure: Option<Closure>, seconds: f64) -> f64 {
    let compiled: Compiled = compile_source(source, &[], closure);
    let integrator = Integrator::Dopri5 { tolerance: 1e-9, max_step: None };
    let settings = Settings::new(integrator, Span::Time(seconds), SAMPLES);
    let description = compiled.description();
    let names: HashSet<&str> = description.channels.iter().map(|channel| channel.name.as_ref()).collect();
    assert_eq!(names.len(), description.channels.len(), "two columns of {} have one name", source.name);
    let system = compiled.interpreter();
    let run = simulate(&system, description, &compiled.parameters(), &settings, Watch::NONE)
        .unwrap_or_else(|error| panic!("{}: {error}\n{}", source.name, source.text));
    let oracle = Oracle::with_defaults(&compiled.mechanism).expect("the oracle reads what we read");
    let rows = run.times.iter().copied().zip(run.rows.iter().map(Vec::as_slice));
    let ledger = compare(&oracle, rows, &|name| run.index(name).ok());
    let (name, error) = ledger.worst(0.0).expect("at least the start");
    assert!(error < AGREEMENT, "{} {closure:?}: {name} ({error:.1e})\n{}", source.name, source.text);
    error
}

/// The row of the largest of these on the page of truth.
fn worst(figure: &str, errors: impl Iterator<Item = f64>) {
    reached("motion, forces and energies against the oracle", figure, errors.fold(0.0, f64::max), AGREEMENT);
}

fn random(recipe: &Recipe) -> SourceFile {
    SourceFile { name: format!("random {recipe:?}"), text: recipe.toml() }
}

const SHIPPED: [(&str, f64); 14] = [
    ("andrews", 0.02),
    ("bennett", 0.7),
    ("cam", 0.2),
    ("five_link", 0.3),
    ("geneva", 0.25),
    ("bricard", 0.7),
    ("flyball", 0.05),
    ("four_bar", 0.7),
    ("n_four_bar_2", 0.4),
    ("pendulum", 0.7),
    ("rssr_rigid", 0.3),
    ("six_bar", 0.7),
    ("slider_crank", 0.3),
    ("spatial_slider_crank", 0.3),
];

#[test]
fn shipped_mechanisms_agree() {
    let both = |(name, seconds): (&str, f64)| {
        let source = shipped(name);
        [Closure::Joint, Closure::Log].map(|closure| check(&source, Some(closure), seconds))
    };
    worst("shipped mechanisms, of each scale", SHIPPED.into_iter().flat_map(both));
}

/// Six legs under a plate, three parallelograms over a platform: many loops meet at one body.
#[test]
fn platforms_agree() {
    let both = |name: &str| {
        let source = in_data(name);
        [Closure::Joint, Closure::Log].map(|closure| check(&source, Some(closure), 0.2))
    };
    worst("platforms on many legs, of each scale", ["delta", "stewart"].into_iter().flat_map(both));
}

#[test]
fn every_joint_kind_alone_agrees() {
    let three = |kind: Kind| [0, 1, 2].map(|seed| check(&random(&Recipe::alone(kind, seed)), None, 0.2));
    worst("every joint kind alone, of each scale", Kind::ALL.into_iter().flat_map(three));
}

#[test]
fn random_trees_agree() {
    worst("random trees, of each scale", (0..16).map(|seed| check(&random(&Recipe::tree(seed)), None, 0.2)));
}

#[test]
fn random_loops_agree_with_both_closures() {
    let both = |seed: u64| {
        let source = random(&Recipe::closed(seed));
        [Closure::Joint, Closure::Log].map(|closure| check(&source, Some(closure), 0.2))
    };
    worst("random loops, of each scale", (0..16).flat_map(both));
}

#[test]
fn a_driven_planar_joint_is_pushed_at_the_childs_point_also_when_the_ground_is_the_child() {
    let text = r#"
        spec = 1
        name = "sledge"
        gravity = ["1 m/s^2", "2 m/s^2", "-9 m/s^2"]
        [points]
        P = ["0.1 m", "0.2 m", "-0.1 m"]
        [bodies]
        b = { mass = "2 kg", centre = ["0.3 m", "0.1 m", "0 m"], inertia = ["0.1 kg m^2", "0.15 kg m^2", "0.2 kg m^2"] }
        [joints.plane]
        planar = ["b", "ground"]
        at = "P"
        axis = [1, 2, 3]
        first = [3, 0, -1]
        drive = { q1 = "50 mm*sin(3 Hz*t)" }
        [initial]
        plane = { q2 = "80 mm", q3 = "0.4 rad", v2 = "0.3 m/s", v3 = "2 rad/s" }
    "#;
    check(&SourceFile { name: "sledge".to_owned(), text: text.to_owned() }, None, 0.2);
}
