//! Mechanisms that move only thanks to special geometry, and redundant ones: found, driven, kept on their constraints.

mod support;

use linkwear_codegen::compile::Compiled;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::Span;
use support::{compile_source, run, shipped};

type Vector = [f64; 3];

/// A mechanism with full turns of a driver, or left alone with a push.
#[derive(Clone, Copy)]
enum Motion {
    Driven,
    Free,
}

fn source(name: &str, text: String) -> SourceFile {
    SourceFile { name: name.to_owned(), text }
}

fn lengths(v: Vector) -> String {
    format!("[\"{:?} m\", \"{:?} m\", \"{:?} m\"]", v[0], v[1], v[2])
}

fn times(a: &[Vector; 3], v: Vector) -> Vector {
    a.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

/// A rotation without any zero entry: exp of a general vector, by Rodrigues' formula.
fn tilt() -> [Vector; 3] {
    let [x, y, z] = [0.48, 0.6, 0.64];
    let (s, c) = 0.9_f64.sin_cos();
    let d = 1.0 - c;
    [
        [c + d * x * x, d * x * y - s * z, d * x * z + s * y],
        [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
        [d * x * z - s * y, d * y * z + s * x, c + d * z * z],
    ]
}

const HEAD: &str =
    "spec = 1\nname = \"linkage\"\ngravity = [\"0.4 m/s^2\", \"-0.7 m/s^2\", \"-1.1 m/s^2\"]\n";

/// How the first joint moves: driven round, or pushed.
fn first(motion: Motion) -> (&'static str, &'static str) {
    match motion {
        Motion::Driven => (", drive = \"2*pi*t*0.5 Hz\"", ""),
        Motion::Free => ("", "[initial]\nR1 = { v = \"9 rad/s\" }\n"),
    }
}

/// Ground, crank, coupler, rocker with an axis at each corner.
fn four_bar(points: [Vector; 4], axes: [Vector; 4], motion: Motion) -> SourceFile {
    let (drive, initial) = first(motion);
    let [p1, p2, p3, p4] = points.map(lengths);
    let [a1, a2, a3, a4] = axes.map(|axis| format!("{axis:?}"));
    source(
        "four_bar",
        format!(
            "{HEAD}[points]\nP1 = {p1}\nP2 = {p2}\nP3 = {p3}\nP4 = {p4}\n[bodies]\n\
             crank = {{ rod = [\"P1\", \"P2\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
             coupler = {{ rod = [\"P2\", \"P3\"], radius = \"8 mm\", mass = \"2 kg\" }}\n\
             rocker = {{ rod = [\"P4\", \"P3\"], radius = \"8 mm\", mass = \"1.5 kg\" }}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"crank\"], at = \"P1\", axis = {a1}{drive} }}\n\
             R2 = {{ revolute = [\"crank\", \"coupler\"], at = \"P2\", axis = {a2} }}\n\
             R3 = {{ revolute = [\"coupler\", \"rocker\"], at = \"P3\", axis = {a3} }}\n\
             R4 = {{ revolute = [\"ground\", \"rocker\"], at = \"P4\", axis = {a4} }}\n{initial}"
        ),
    )
}

/// A planar crank-rocker in a plane that is parallel to no coordinate plane, its axes with opposite signs.
fn tilted(motion: Motion) -> SourceFile {
    let a = tilt();
    // Lengths 1, 2.5, 2, 2: 1 + 2.5 < 2 + 2, so the crank turns round.
    let (x, y) = closing([1.0, 0.0], 2.5, [2.0, 0.0], 2.0);
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [x, y, 0.0], [2.0, 0.0, 0.0]];
    let axis = times(&a, [0.0, 0.0, 1.0]);
    four_bar(points.map(|p| times(&a, p)), [axis, axis.map(|x| -2.0 * x), axis, axis], motion)
}

/// The point at given distances from two others, on the left of the line from the first.
fn closing(p: [f64; 2], r: f64, q: [f64; 2], s: f64) -> (f64, f64) {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let d = dx.hypot(dy);
    let along = (r * r - s * s + d * d) / (2.0 * d);
    let across = (r * r - along * along).sqrt();
    (p[0] + (dx * along - dy * across) / d, p[1] + (dy * along + dx * across) / d)
}

/// Four axes that meet in the origin: arcs 30, 80, 70 and 90 degrees, 30 + 90 < 80 + 70.
fn spherical(motion: Motion) -> SourceFile {
    let degrees = |angle: f64| angle.to_radians();
    let second = [0.0, degrees(30.0).sin(), degrees(30.0).cos()];
    // Third axis: cos 70 from x, cos 80 from the second.
    let x = degrees(70.0).cos();
    let (want, size) = (degrees(80.0).cos(), (1.0 - x * x).sqrt());
    let angle = degrees(30.0) + (want / size).acos();
    let third = [x, size * angle.sin(), size * angle.cos()];
    let axes = [[0.0, 0.0, 1.0], second, third, [1.0, 0.0, 0.0]].map(|axis| times(&tilt(), axis));
    four_bar(axes, axes, motion)
}

/// Two chains of three parallel hinges in planes at right angles hold a plate that can only move straight up.
fn sarrus(motion: Motion) -> SourceFile {
    let (drive, spring) = match motion {
        Motion::Driven => (", drive = \"0.5*sin(2*pi*t*0.5 Hz)\"", ""),
        // Soft enough to swing widely, stiff enough to stay away from the stretched position.
        Motion::Free => ("", ", spring = { stiffness = \"60 N m\", rest = \"0.2 rad\" }"),
    };
    let text = format!(
        "{HEAD}[points]\nA0 = [\"1 m\", 0, 0]\nA1 = [\"1.5 m\", 0, \"0.6 m\"]\nA2 = [\"1 m\", 0, \"1.2 m\"]\n\
         B0 = [0, \"1 m\", 0]\nB1 = [0, \"1.7 m\", \"0.6 m\"]\nB2 = [0, \"1 m\", \"1.2 m\"]\n\
         Z = {{ at = [0, 0, \"1.2 m\"], on = \"plate\" }}\n[bodies]\n\
         lower_a = {{ rod = [\"A0\", \"A1\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
         upper_a = {{ rod = [\"A1\", \"A2\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
         lower_b = {{ rod = [\"B0\", \"B1\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
         upper_b = {{ rod = [\"B1\", \"B2\"], radius = \"8 mm\", mass = \"1 kg\" }}\n\
         plate = {{ mass = \"3 kg\", centre = \"Z\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"2 kg m^2\"] }}\n[joints]\n\
         R1 = {{ revolute = [\"ground\", \"lower_a\"], at = \"A0\", axis = [0, 1, 0]{drive}{spring} }}\n\
         R2 = {{ revolute = [\"lower_a\", \"upper_a\"], at = \"A1\", axis = [0, 1, 0] }}\n\
         R3 = {{ revolute = [\"upper_a\", \"plate\"], at = \"A2\", axis = [0, 1, 0] }}\n\
         R4 = {{ revolute = [\"ground\", \"lower_b\"], at = \"B0\", axis = [1, 0, 0] }}\n\
         R5 = {{ revolute = [\"lower_b\", \"upper_b\"], at = \"B1\", axis = [1, 0, 0] }}\n\
         R6 = {{ revolute = [\"upper_b\", \"plate\"], at = \"B2\", axis = [1, 0, 0] }}\n"
    );
    source("sarrus", text)
}

/// A plate on three equal parallel cranks: it moves without turning. Any two cranks alone pass change points; the
/// third takes the plate through.
fn three_cranks(motion: Motion, third: Vector) -> SourceFile {
    let (drive, initial) = first(motion);
    let arm = [0.3, 0.4, 0.0];
    let ground = [[0.0; 3], [1.0, 0.0, 0.0], third];
    let plate = ground.map(|p| [p[0] + arm[0], p[1] + arm[1], p[2] + arm[2]]);
    let mut text = format!("{HEAD}[points]\n");
    for (i, (a, b)) in ground.into_iter().zip(plate).enumerate() {
        text += &format!("A{i} = {}\nB{i} = {{ at = {}, on = \"crank{i}\" }}\n", lengths(a), lengths(b));
    }
    text += "C = { at = [\"0.8 m\", \"0.6 m\", 0], on = \"plate\" }\n[bodies]\n";
    for i in 0..3 {
        text += &format!("crank{i} = {{ rod = [\"A{i}\", \"B{i}\"], radius = \"8 mm\", mass = \"1 kg\" }}\n");
    }
    text += "plate = { mass = \"2 kg\", centre = \"C\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"2 kg m^2\"] }\n[joints]\n";
    for i in 0..3 {
        let drive = if i == 0 { drive } else { "" };
        text += &format!(
            "R{} = {{ revolute = [\"ground\", \"crank{i}\"], at = \"A{i}\", axis = [0, 0, 1]{drive} }}\n\
             T{i} = {{ revolute = [\"crank{i}\", \"plate\"], at = \"B{i}\", axis = [0, 0, 1] }}\n",
            i + 1
        );
    }
    source("three_cranks", text + initial)
}

/// A shipped mechanism as it is, or without driver and damper but with a push.
fn shipped_in(name: &str, motion: Motion, drive: &str, damping: &str) -> SourceFile {
    let mut source = shipped(name);
    if let Motion::Free = motion {
        assert!(source.text.contains(drive) && source.text.contains(damping));
        source.text = source.text.replace(drive, "").replace(damping, "") + first(motion).1;
    }
    source
}

fn bennett(motion: Motion) -> SourceFile {
    shipped_in("bennett", motion, ", drive = \"2*pi*speed*t\"", ", damping = \"c\"")
}

/// Runs 10 s (5 turns where driven) and checks counts, loops and energy.
fn assert_keeps(source: &SourceFile, redundant: usize) -> Compiled {
    let compiled = compile_source(source, &[], None);
    let analysis = &compiled.analysis;
    assert_eq!((analysis.mobility, analysis.redundant.len()), (1, redundant));
    let run = run(&compiled, Span::Time(10.0), Span::Time(0.0), 101, 1e-10);
    let statistics = &run.run.statistics;
    eprintln!("{statistics:?}");
    // Projection ends near 1e-14 m; dropped rows follow with the conditioning of the position.
    assert!(statistics.max_loop_error_m < 1e-10, "loops open by {:e} m", statistics.max_loop_error_m);
    assert!(statistics.max_loop_error_rad < 1e-10, "loops open by {:e} rad", statistics.max_loop_error_rad);
    // A hundred steps per second with an error of 1e-10 each: 1e-8 is the bound that users are promised.
    assert!(
        statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
        "energy drifts by {:e} J of {:e} J",
        statistics.energy_error_J,
        statistics.energy_throughput_J
    );
    compiled
}

#[test]
fn bennett_turns_round_driven() {
    assert_keeps(&bennett(Motion::Driven), 3);
}

#[test]
fn bennett_turns_round_alone() {
    assert_keeps(&bennett(Motion::Free), 3);
}

#[test]
fn bricard_swings_alone() {
    assert_keeps(&shipped("bricard"), 1);
}

#[test]
fn a_planar_four_bar_turns_in_any_plane_driven() {
    assert_keeps(&tilted(Motion::Driven), 3);
}

#[test]
fn a_planar_four_bar_turns_in_any_plane_alone() {
    assert_keeps(&tilted(Motion::Free), 3);
}

#[test]
fn a_spherical_four_bar_turns_round_driven() {
    assert_keeps(&spherical(Motion::Driven), 3);
}

#[test]
fn a_spherical_four_bar_turns_round_alone() {
    assert_keeps(&spherical(Motion::Free), 3);
}

#[test]
fn a_sarrus_linkage_moves_straight_up_driven_and_alone() {
    for motion in [Motion::Driven, Motion::Free] {
        let compiled = assert_keeps(&sarrus(motion), 1);
        let run = run(&compiled, Span::Time(2.0), Span::Time(0.0), 21, 1e-10);
        let sideways =
            run.column("Z.x").into_iter().chain(run.column("Z.y")).fold(0.0, |m: f64, x| m.max(x.abs()));
        // The loops close to 1e-10 m, and so does what follows from them.
        assert!(sideways < 1e-10, "{sideways:e}");
    }
}

#[test]
fn a_plate_on_three_cranks_turns_round_driven() {
    assert_keeps(&three_cranks(Motion::Driven, [0.4, 0.9, 0.0]), 7);
}

#[test]
fn a_plate_on_three_cranks_turns_round_alone() {
    assert_keeps(&three_cranks(Motion::Free, [0.4, 0.9, 0.0]), 7);
}
