//! Random mechanisms and states, in trees and in loops, every joint kind, against the independent model in absolute
//! coordinates (crate `oracle`): joint wrenches, drive forces, energies, power.

mod support;

use std::collections::HashMap;

use linkwear_codegen::compile::Compiled;
use linkwear_codegen::model::Closure;
use linkwear_codegen::source::SourceFile;
use linkwear_oracle::Oracle;
use linkwear_oracle::random::{Kind, Recipe};
use linkwear_runtime::{Evaluator, State, assemble};
use proptest::prelude::*;
use support::{compile_source, compiled};

/// Relative to the largest force and moment of the mechanism. The oracle solves 6 n equations by singular values and
/// keeps 11 digits of well-conditioned systems.
const AGREE: f64 = 1e-9;
/// States whose constraints are worse conditioned than this are not compared: both sides lose digits there.
const CONDITION: f64 = 1e-4;

/// Columns by name at a state.
fn observe(compiled: &Compiled, state: &State) -> HashMap<String, f64> {
    let system = compiled.interpreter();
    let mut evaluator =
        Evaluator::new(&system, compiled.description(), &compiled.parameters()).expect("numbers fit");
    evaluator.forward(0.0, &state.q, &state.v);
    let values = evaluator.observe(0.0, &state.q, &state.v).to_vec();
    let names = compiled.description().channels.iter().map(|channel| channel.name.to_string());
    names.zip(values).collect()
}

/// Both models at the assembled start; `None` where the start is too near a singular position.
fn compare(compiled: &Compiled) -> Option<()> {
    let system = compiled.interpreter();
    let state = assemble(&system, compiled.description(), &compiled.parameters(), 0.0).expect("it closes");
    let columns = observe(compiled, &state);
    let oracle = Oracle::with_defaults(&compiled.mechanism).expect("the oracle reads what we read");
    let states = oracle.states_from(&|name| columns.get(name).copied()).expect("every body is reached");
    // The loops close to 1e-13 m here, and again when the oracle rebuilds the bodies from columns.
    assert!(oracle.constraint_residual(0.0, &states) < 1e-10);
    let solution = oracle.accelerations(0.0, &states);
    if solution.smallest_kept < CONDITION {
        return None;
    }
    let kinetic = oracle.kinetic_energy(&states);
    let scale = kinetic.max(1e-3);
    assert!((columns["energy.kinetic"] - kinetic).abs() < AGREE * scale, "kinetic energy");
    let size = |moment: bool| {
        let parts = solution.wrenches.iter().map(|w| if moment { w.moment.amax() } else { w.force.amax() });
        parts.fold(1e-3, f64::max)
    };
    let (forces, moments) = (size(false), size(true));
    for (joint, wrench) in compiled.mechanism.joints.iter().zip(&solution.wrenches) {
        for (k, axis) in ["x", "y", "z"].iter().enumerate() {
            for (letter, value, scale, unique) in [
                ("F", wrench.force[k], forces, wrench.unique[k]),
                ("M", wrench.moment[k], moments.max(forces), wrench.unique[3 + k]),
            ] {
                let name = format!("{}.{letter}{axis}", joint.name);
                if compiled.analysis.non_unique.contains(&name) {
                    continue;
                }
                assert!(unique, "{name} is said to be unique and is not");
                let error = (columns[&name] - value).abs() / scale;
                assert!(error < AGREE, "{name}: {} against {value}: {error:e}", columns[&name]);
            }
        }
    }
    compare_drives(compiled, &columns, &solution.drives, forces.max(moments));
    Some(())
}

fn compare_drives(compiled: &Compiled, columns: &HashMap<String, f64>, expected: &[f64], scale: f64) {
    let names = compiled.description().channels.iter().filter(|channel| channel.name.contains(".drive"));
    for (channel, expected) in names.zip(expected) {
        let error = (columns[channel.name.as_ref()] - expected).abs() / scale;
        assert!(error < AGREE, "{}: {error:e}", channel.name);
    }
}

fn compiled_from(recipe: &Recipe, closure: Option<Closure>) -> Compiled {
    let source = SourceFile { name: format!("seed {}", recipe.seed), text: recipe.toml() };
    compile_source(&source, &[], closure)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_trees_agree(seed in 0_u64..1_000_000) {
        compare(&compiled_from(&Recipe::tree(seed), None));
    }

    #[test]
    fn random_loops_agree(seed in 0_u64..1_000_000) {
        compare(&compiled_from(&Recipe::closed(seed), None));
    }

    #[test]
    fn random_loops_agree_with_closure_log(seed in 0_u64..1_000_000) {
        compare(&compiled_from(&Recipe::closed(seed), Some(Closure::Log)));
    }
}

#[test]
fn every_joint_kind_alone_agrees() {
    for kind in Kind::ALL {
        for seed in 0..8 {
            assert!(compare(&compiled_from(&Recipe::alone(kind, seed), None)).is_some(), "{kind:?} {seed}");
        }
    }
}

#[test]
fn shipped_mechanisms_agree() {
    for name in [
        "pendulum",
        "four_bar",
        "slider_crank",
        "rssr_rigid",
        "andrews",
        "n_four_bar_2",
        "bricard",
        "bennett",
        "flyball",
        "six_bar",
        "spatial_slider_crank",
    ] {
        compare(&compiled(name, &[], None));
    }
}
