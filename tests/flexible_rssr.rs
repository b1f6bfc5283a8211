//! The RSSR four-bar with a flexible coupler against Exudyn's floating frame, and with second-order terms against its
//! geometrically nonlinear beam (tests/reference/README.md).

mod support;
mod truth;

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::Span;
use support::{Recorded, Table, compile_source, largest_difference, relative_error, run, shipped};
use truth::reached;

/// The shipped file with other words in `flexible`.
fn coupler(words: &str) -> SourceFile {
    let source = shipped("rssr_flexible");
    let text = source.text.replace("flexible = { ", &format!("flexible = {{ {words}"));
    assert!(words.is_empty() || text != source.text);
    SourceFile { name: source.name, text }
}

fn turn(source: &SourceFile, speed: &str, settle: f64, tolerance: f64) -> Recorded {
    let compiled = compile_source(source, &[("speed", speed)], None);
    run(&compiled, Span::Turns(1.0), Span::Time(settle), 201, tolerance)
}

fn norms(y: &[f64], z: &[f64]) -> Vec<f64> {
    y.iter().zip(z).map(|(y, z)| y.hypot(*z)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Largest difference of the deflections, as a share of the amplitude.
fn deflection_error(ours: &Recorded, reference: &Table) -> f64 {
    // Ours spins with the coupler, so that only the size compares.
    let expected = norms(&reference.column("def_y"), &reference.column("def_z"));
    relative_error(&norms(&ours.column("coupler.uy"), &ours.column("coupler.uz")), &expected)
}

/// Three components of a force, sample by sample.
fn force(run: &Recorded, joint: &str) -> [Vec<f64>; 3] {
    ["x", "y", "z"].map(|axis| run.column(&format!("{joint}.F{axis}")))
}

fn compare(reference: &str, rigid: &str, speed: &str, settle: f64, [forces, change]: [f64; 2]) {
    let table = Table::reference(reference);
    let ours = turn(&coupler(""), speed, settle, 1e-9);
    let error = deflection_error(&ours, &table);
    let case = format!("RSSR, flexible coupler, at {speed}, against Exudyn");
    reached(&case, "deflection, of its amplitude", error, 1e-3);
    let mut loads = 0.0_f64;
    for (joint, name, sign) in
        [("R1", "R1_F", 1.0), ("S2", "S2_F", 1.0), ("S3", "S3_F", -1.0), ("R4", "R4_F", 1.0)]
    {
        let theirs = ["x", "y", "z"].map(|axis| table.column(&format!("{name}{axis}")));
        let peak =
            (0..201).map(|i| (0..3).map(|k| theirs[k][i].powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max);
        for (ours, theirs) in force(&ours, joint).iter().zip(&theirs) {
            let ours: Vec<f64> = ours.iter().map(|x| sign * x).collect();
            loads = loads.max(largest_difference(&ours, theirs) / peak);
        }
    }
    let error = relative_error(&ours.column("R1.drive"), &table.column("T_drive"));
    reached(&case, "joint forces, of their peak", loads, forces);
    reached(&case, "drive torque, of its peak", error, forces);
    // What bending changes of the bearing force.
    let rigid = Table::reference(rigid);
    let (mut sizes, mut offs) = (vec![0.0; 201], vec![0.0; 201]);
    for (mine, axis) in force(&ours, "R1").iter().zip(["x", "y", "z"]) {
        let stiff = rigid.column(&format!("R1_F{axis}"));
        let theirs = table.column(&format!("R1_F{axis}"));
        for (at, ((mine, stiff), theirs)) in mine.iter().zip(&stiff).zip(&theirs).enumerate() {
            let expected: f64 = theirs - stiff;
            sizes[at] += expected * expected;
            offs[at] += (mine - theirs).powi(2);
        }
    }
    let (peak, worst) = (largest(&sizes).sqrt(), largest(&offs).sqrt());
    reached(&case, "change of the force at R1 by bending, of its peak", worst / peak, change);
}

#[test]
fn flexible_coupler_at_2_hz_agrees_with_exudyn() {
    compare("rssr/ffrf_2hz.csv", "rssr/rigid_2hz.csv", "2 Hz", 2.5, [1e-5, 0.10]);
}

#[test]
fn flexible_coupler_at_10_hz_agrees_with_exudyn() {
    compare("rssr/ffrf_10hz.csv", "rssr/rigid_10hz.csv", "10 Hz", 1.5, [5e-5, 0.02]);
}

#[test]
fn classic_beam_modes_bend_a_little_less() {
    let table = Table::reference("rssr/ffrf_2hz.csv");
    let ours = turn(&coupler("theory = \"euler_bernoulli\", "), "2 Hz", 2.5, 1e-9);
    let error = deflection_error(&ours, &table);
    assert!(error < 3e-3 && error > 1e-3, "{error:e} of the amplitude");
}

/// With foreshortening and geometric stiffness. The chord of the reference mostly stretches: without the axial
/// shape its swing would be 1.4e-6 m, a seventh of what it is.
#[test]
fn second_order_terms_agree_with_a_nonlinear_beam() {
    let table = Table::reference("rssr/ancf_10hz.csv");
    let source = coupler("theory = \"euler_bernoulli\", order = 2, axial = 1, ");
    let ours = turn(&source, "10 Hz", 1.5, 1e-8);
    let expected = largest(&norms(&table.column("def_y"), &table.column("def_z")));
    let amplitude = largest(&norms(&ours.column("coupler.uy"), &ours.column("coupler.uz")));
    assert!((amplitude / expected - 1.0).abs() < 3e-3, "{amplitude} not {expected}");
    let chord: Vec<f64> = (0..201)
        .map(|i| {
            let square = ["x", "y", "z"].map(|axis| {
                (ours.column(&format!("B.{axis}"))[i] - ours.column(&format!("A.{axis}"))[i]).powi(2)
            });
            square.iter().sum::<f64>().sqrt()
        })
        .collect();
    let theirs = table.column("chord_len");
    let swing = |list: &[f64]| {
        list.iter().copied().fold(f64::MIN, f64::max) - list.iter().copied().fold(f64::MAX, f64::min)
    };
    let error = largest_difference(&chord, &theirs) / swing(&theirs);
    assert!(error < 0.03, "chord: {error:e} of its swing");
}

#[test]
fn energy_of_the_undamped_linkage_stays() {
    for words in ["", "order = 2, "] {
        let source = coupler(words);
        let text = source.text.replace("friction = \"c_ball\"", "friction = \"0 N m s/rad\"");
        let source = SourceFile { name: source.name, text };
        let compiled = compile_source(&source, &[("zeta", "0"), ("c_rocker", "0 N m s/rad")], None);
        let run = run(&compiled, Span::Turns(10.0), Span::Time(0.0), 11, 1e-11);
        let numbers = &run.run.statistics;
        let drift = numbers.energy_error_J / numbers.energy_throughput_J;
        assert!(drift.abs() < 1e-8, "{words}: {drift:e} of the throughput");
    }
}

#[test]
fn no_modes_give_the_rigid_linkage_operation_for_operation() {
    let rigid = compile_source(&shipped("rssr_rigid"), &[], None);
    let frozen = compile_source(&shipped("rssr_flexible"), &[("modes", "0")], None);
    let body = |text: String| {
        let text = text.replace("rssr_flexible", "rssr_rigid");
        text.lines()
            .filter(|line| !line.contains("sha256") && !line.contains("SHA256"))
            .collect::<Vec<_>>()
            .join("\n")
    };
    assert_eq!(body(frozen.rust_source()), body(rigid.rust_source()));
}

#[test]
fn forward_dynamics_take_fewer_than_600_operations() {
    let compiled = compile_source(&shipped("rssr_flexible"), &[], None);
    let counts = compiled.operations();
    let forward = counts.iter().find(|count| count.name == "forward_dynamics").expect("it is there");
    assert!(forward.operations.total < 600, "{:?}", forward.operations);
}
