//! Gears, belts, planetary sets and relations: ratios, forces and bearing loads against textbooks and closed forms.

mod simulated;

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use linkwear_runtime::{Integrator, Run, Settings, Span};
use simulated::{at_end, refused, run_with};

/// Without gravity.
fn text_of(text: &str) -> String {
    format!("gravity = [0, 0, 0]\n{text}")
}

fn run(text: &str, end: f64) -> Run {
    let method = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };
    run_with(&text_of(text), &Settings::new(method, Span::Time(end), 11))
}

/// Within a part of the expected size.
#[track_caller]
fn near(found: f64, expected: f64, part: f64) {
    assert!((found - expected).abs() <= part * expected.abs().max(1e-9), "{found}, not {expected}");
}

/// Rounding of some hundred operations and a run's tolerance of 1e-10.
const EXACT: f64 = 1e-8;

/// A body that turns about an axis through a point, with so much inertia about it [kg m²].
fn wheel(name: &str, at: &str, inertia: f64) -> String {
    format!(
        "{name} = {{ mass = \"1 kg\", centre = \"{at}\", inertia = [\"{inertia} kg m^2\", \"{inertia} kg m^2\", \"{inertia} kg m^2\"] }}\n"
    )
}

/// Wheels at points of the ground: name, point, position [mm], axis, what the joint `R_<name>` has besides.
fn train(wheels: &[(&str, [f64; 3], [f64; 3], &str)], couplings: &str) -> String {
    let (mut points, mut bodies, mut joints) =
        ("[points]\n".to_owned(), "[bodies]\n".to_owned(), "[joints]\n".to_owned());
    for (name, [x, y, z], axis, more) in wheels {
        let _ =
            writeln!(points, "C_{name} = {{ at = [\"{x} mm\", \"{y} mm\", \"{z} mm\"], on = \"ground\" }}");
        bodies.push_str(&wheel(name, &format!("C_{name}"), 1e-3));
        let _ = writeln!(
            joints,
            "R_{name} = {{ revolute = [\"ground\", \"{name}\"], at = \"C_{name}\", axis = {axis:?}{more} }}"
        );
    }
    format!("{points}{bodies}{joints}[couplings]\n{couplings}")
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn planets(couplings: &str) -> String {
    let wheels = ["sun", "arm", "ring"].map(|name| wheel(name, "O", 1e-3)).concat();
    format!(
        "[points]\nO = [0, 0, 0]\nP = {{ at = [\"40 mm\", 0, 0], on = \"arm\" }}\n[bodies]\n{wheels}{}\
         [joints]\n\
         Rs = {{ revolute = [\"ground\", \"sun\"], at = \"O\", axis = [0, 0, 1], drive = \"12 rad/s*t\" }}\n\
         Ra = {{ revolute = [\"ground\", \"arm\"], at = \"O\", axis = [0, 0, 1], force = \"-2 N m\" }}\n\
         Rr = {{ revolute = [\"ground\", \"ring\"], at = \"O\", axis = [0, 0, -1], drive = 0 }}\n\
         Rp = {{ revolute = [\"arm\", \"planet\"], at = \"P\", axis = [0, 0, 1] }}\n[couplings]\n{couplings}",
        wheel("planet", "P", 1e-5)
    )
}

const MESHES: &str = "sp = { gears = [\"sun\", \"planet\"], teeth = [20, 20] }\n\
                      pr = { gears = [\"planet\", \"ring\"], teeth = [20, 60], internal = true }\n";

/// Willis: with a fixed ring the sun turns 1 + Zr/Zs times as fast as the carrier, and the torques of sun, ring and carrier are
/// as Zs, Zr, -(Zs + Zr) [Shigley, ch. 13-13; Norton, Design of Machinery, ch. 9.9].
#[test]
fn a_planetary_set_has_the_speeds_and_torques_of_willis() {
    let run = run(&planets(MESHES), 1.0);
    near(at_end(&run, "Ra.v"), 12.0 / 4.0, EXACT);
    // The planet turns at (w_s - w_c) Zs/Zp backwards on the carrier.
    near(at_end(&run, "Rp.v"), -9.0, EXACT);
    near(at_end(&run, "Rs.drive"), 0.5, EXACT);
    // About the axis of its joint, which is the opposite one.
    near(at_end(&run, "Rr.drive"), -1.5, EXACT);
    // Teeth at 20 mm; both meshes push the planet alike, and their radial parts cancel there. The planet has no mass at the
    // reference but circles: m w² r inwards.
    near(at_end(&run, "sp.Ft").abs(), 0.5 / 0.02, EXACT);
    near(at_end(&run, "pr.Ft").abs(), 0.5 / 0.02, EXACT);
    near(at_end(&run, "sp.Fr"), 0.5 / 0.02 * (PI / 9.0).tan(), EXACT);
    let force = ["x", "y", "z"].map(|axis| at_end(&run, &format!("Rp.F{axis}")));
    near(force.iter().map(|x| x * x).sum::<f64>().sqrt(), 50.0_f64.hypot(1.0 * 9.0 * 0.04), EXACT);
    // The bearing of the sun holds the whole tooth force.
    let force = ["x", "y", "z"].map(|axis| at_end(&run, &format!("Rs.F{axis}")));
    near(force.iter().map(|x| x * x).sum::<f64>().sqrt(), 25.0 / (PI / 9.0).cos(), EXACT);
    // Of the 6 J that go from the sun to the carrier.
    let error = run.statistics.energy_error_J;
    assert!(error < 6.0 * EXACT, "{error} J");
}

#[test]
fn a_planetary_set_without_its_planets_does_the_same() {
    let run = run(&planets("set = { planetary = [\"sun\", \"ring\", \"arm\"], teeth = [20, 60] }\n"), 1.0);
    near(at_end(&run, "Ra.v"), 3.0, EXACT);
    near(at_end(&run, "Rs.drive"), 0.5, EXACT);
    near(at_end(&run, "Rr.drive"), -1.5, EXACT);
    for (column, torque) in [("set.T1", -0.5), ("set.T2", -1.5), ("set.T3", 2.0)] {
        near(at_end(&run, column), torque, EXACT);
    }
    assert!(at_end(&run, "Rs.Fx").abs() < 1e-12, "planets around the sun hold each other");
}

/// The cage of a differential turns at the mean of its side shafts, which share its torque evenly [Norton, ch. 9.11].
#[test]
fn a_differential_has_the_mean_speed_and_equal_torques() {
    let side = |name: &str, more: &str| (name.to_owned(), more.to_owned());
    let shafts = [
        side("left", ", drive = \"3 rad/s*t\""),
        side("right", ", drive = \"7 rad/s*t\""),
        side("cage", ", force = \"8 N m\""),
    ];
    let wheels: Vec<_> =
        shafts.iter().map(|(name, more)| (name.as_str(), [0.0; 3], Z, more.as_str())).collect();
    let run = run(&train(&wheels, "d = { differential = [\"left\", \"right\", \"cage\"] }"), 0.5);
    near(at_end(&run, "R_cage.v"), 5.0, EXACT);
    near(at_end(&run, "R_left.drive"), -4.0, EXACT);
    near(at_end(&run, "R_right.drive"), -4.0, EXACT);
    near(at_end(&run, "d.T1"), 4.0, EXACT);
}

/// Shigley's Mechanical Engineering Design, example 13-7: 2.5 kW at 1750 rev/min from 20 teeth of module 2.5 mm over an idler
/// of 50 to 30 teeth. Transmitted load 0.546 kN, radial 0.199 kN, reaction of the idler's shaft 0.347 kN along either axis.
#[test]
fn an_idler_loads_its_shaft_as_in_shigley() {
    let torque = 2500.0 / (1750.0 / 60.0 * TAU);
    // Into one corner or into the other, as the shaft turns.
    for (sign, expected) in [(1.0, 347.0), (-1.0, 745.0)] {
        let load = format!(", force = \"{} N m\"", -sign * torque * 1.5);
        let speed = format!(", drive = \"{} rad/s*t\"", sign * 1750.0 / 60.0 * TAU);
        let text = train(
            &[
                ("p", [-87.5, 0.0, 0.0], Z, speed.as_str()),
                ("idler", [0.0, 0.0, 0.0], Z, ""),
                ("g", [0.0, 100.0, 0.0], Z, load.as_str()),
            ],
            "a = { gears = [\"p\", \"idler\"], teeth = [20, 50], module = \"2.5 mm\" }\n\
             b = { gears = [\"idler\", \"g\"], teeth = [50, 30], module = \"2.5 mm\" }\n",
        );
        let run = run(&text, 0.1);
        // Three printed digits.
        near(at_end(&run, "a.Ft").abs(), 546.0, 1e-3);
        near(at_end(&run, "a.Fr"), 199.0, 2e-3);
        near(at_end(&run, "R_idler.Fx").abs(), expected, 2e-3);
        near(at_end(&run, "R_idler.Fy").abs(), expected, 2e-3);
    }
}

/// Shigley, example 13-9: 1 hp at 1800 rev/min on a helical pinion of 18 teeth, normal pitch 12 per inch, normal pressure angle
/// 20 degrees, helix angle 30 degrees: 40.4 lbf, 17.0 lbf and 23.3 lbf.
#[test]
fn a_helical_pinion_has_the_forces_of_shigley() {
    const LBF: f64 = 4.448_221_615;
    let (module, speed) = (25.4 / 12.0, 1800.0 / 60.0 * TAU);
    let torque = 745.7 / speed;
    let distance = module * (18.0 + 36.0) / 2.0 / (PI / 6.0).cos();
    let drive = format!(", drive = \"{speed} rad/s*t\"");
    let load = format!(", force = \"{} N m\"", 2.0 * torque);
    let text = train(
        &[("p", [0.0; 3], Z, drive.as_str()), ("g", [0.0, distance, 0.0], Z, load.as_str())],
        &format!(
            "m = {{ gears = [\"p\", \"g\"], teeth = [18, 36], module = \"{module} mm\", helix_angle = \"30 deg\" }}"
        ),
    );
    let run = run(&text, 0.1);
    near(at_end(&run, "m.Ft") / LBF, 40.4, 2e-3);
    near(at_end(&run, "m.Fr") / LBF, 17.0, 3e-3);
    near(at_end(&run, "m.Fa").abs() / LBF, 23.3, 3e-3);
    // A right-hand pinion that turns in the sense of its axis pushes the wheel against that axis, and is pushed along it; its
    // bearing holds it.
    near(at_end(&run, "m.Fa"), -at_end(&run, "R_g.Fz"), EXACT);
    assert!(at_end(&run, "R_g.Fz") > 0.0);
    near(at_end(&run, "R_p.Fz"), -at_end(&run, "R_g.Fz"), EXACT);
    // The axial force tilts the pinion about its own radius, towards the line of centres.
    let radius = distance / 3.0 * 1e-3;
    near(at_end(&run, "R_p.Mx").abs(), at_end(&run, "R_p.Fz").abs() * radius, EXACT);
}

/// Shigley, example 13-8: 5 hp at 600 rev/min on a bevel pinion of 15 teeth with a gear of 45, pitch 5 per inch, mean pitch
/// radius of the pinion 1.293 in. On the gear 406 lbf, 46.6 lbf and 140 lbf.
#[test]
fn a_bevel_gear_has_the_forces_of_shigley() {
    const LBF: f64 = 4.448_221_615;
    let speed = 600.0 / 60.0 * TAU;
    let torque = 5.0 * 745.7 / speed;
    let radius = 1.293 * 25.4;
    let drive = format!(", drive = \"{speed} rad/s*t\"");
    let load = format!(", force = \"{} N m\"", 3.0 * torque);
    // The apex at the origin: pinion on +x, gear on +y; there the wheels turn against each other.
    let text = train(
        &[
            ("p", [120.0, 0.0, 0.0], [1.0, 0.0, 0.0], drive.as_str()),
            ("g", [0.0, 60.0, 0.0], [0.0, 1.0, 0.0], load.as_str()),
        ],
        "m = { bevel = [\"p\", \"g\"], teeth = [15, 45], at = \"P\" }",
    )
    .replace("[points]\n", &format!("[points]\nP = [\"{} mm\", \"{radius} mm\", 0]\n", 3.0 * radius));
    let run = run(&text, 0.1);
    near(at_end(&run, "R_g.v"), -speed / 3.0, EXACT);
    near(at_end(&run, "m.Ft").abs() / LBF, 406.0, 2e-3);
    near(at_end(&run, "m.Fr") / LBF, 46.6, 4e-3);
    near(at_end(&run, "m.Fa").abs() / LBF, 140.0, 4e-3);
    // The bearing of the gear holds the axial force, that of the pinion the gear's radial one.
    near(at_end(&run, "R_g.Fy").abs(), at_end(&run, "m.Fa").abs(), EXACT);
    near(at_end(&run, "R_p.Fx").abs(), at_end(&run, "m.Fr"), EXACT);
}

/// A worm of module m, z starts and radius r on a wheel of n teeth, without friction: lead angle tan g = m z / (2 r), forces on
/// the worm T/r around, T/(r tan g) along its axis, the normal one over the line of centres.
#[test]
fn a_worm_has_the_forces_of_its_lead() {
    let torque = 3.0;
    let (module, starts, teeth, radius) = (4.0e-3, 2.0, 40.0, 0.02);
    for (hand, sense) in [("right", 1.0), ("left", -1.0)] {
        let load = format!(", force = \"{} N m\"", torque * teeth / starts);
        let text = train(
            &[
                ("w", [0.0; 3], [1.0, 0.0, 0.0], ", drive = \"30 rad/s*t\""),
                ("g", [0.0, (module * teeth / 2.0 + radius) * 1e3, 0.0], Z, load.as_str()),
            ],
            &format!(
                "m = {{ worm = [\"w\", \"g\"], teeth = [2, 40], module = \"4 mm\", hand = \"{hand}\" }}"
            ),
        );
        let run = run(&text, 0.1);
        // A right-hand worm turning about +x draws a nut, here the lower side of the wheel, to -x: about -z.
        near(at_end(&run, "R_g.v"), -sense * 30.0 * starts / teeth, EXACT);
        let lead = module * starts / 2.0 / radius;
        near(at_end(&run, "R_w.drive").abs(), torque, EXACT);
        near(at_end(&run, "m.Ft").abs(), torque / radius / lead, EXACT);
        near(at_end(&run, "m.Fa").abs(), torque / radius, EXACT);
        let normal = torque / radius / lead * lead.hypot(1.0) * (PI / 9.0).tan();
        near(at_end(&run, "m.Fr"), normal, EXACT);
        near(at_end(&run, "R_w.Fy").abs(), normal, EXACT);
        near(at_end(&run, "R_w.Fx").abs(), torque / radius / lead, EXACT);
        near(at_end(&run, "R_w.Fz").abs(), torque / radius, EXACT);
    }
}

#[test]
fn a_rack_moves_by_the_arc_of_its_pinion() {
    let text = "[points]\nO = [0, 0, 0]\nP = [0, \"-25 mm\", 0]\n[bodies]\n".to_owned()
        + &wheel("pinion", "O", 1e-3)
        + &wheel("bar", "P", 1e-3)
        + "[joints]\n\
           R = { revolute = [\"ground\", \"pinion\"], at = \"O\", axis = [0, 0, 1], force = \"2 N m\" }\n\
           S = { prismatic = [\"ground\", \"bar\"], at = \"P\", axis = [-1, 0, 0] }\n\
           [couplings]\nm = { rack = [\"pinion\", \"bar\"], at = \"P\", teeth = [25], module = \"2 mm\" }";
    let run = run(&text, 0.2);
    // T = (J + m r²) alpha; the lowest point of the pinion goes to +x.
    let alpha = 2.0 / (1e-3 + 1.0 * 0.025 * 0.025);
    near(at_end(&run, "R.a"), alpha, EXACT);
    near(at_end(&run, "S.a"), -0.025 * alpha, EXACT);
    near(at_end(&run, "m.Ft"), 0.025 * alpha, EXACT);
    near(at_end(&run, "R.Fy"), -0.025 * alpha * (PI / 9.0).tan(), EXACT);
    let pressed = 0.025 * alpha * (PI / 9.0).tan();
    near(at_end(&run, "S.Fy"), pressed, EXACT);
    // Teeth meet where the pinion is, however far the rack has gone.
    let gone = 0.5 * 0.025 * alpha * 0.2 * 0.2;
    near(at_end(&run, "S.q"), -gone, EXACT);
    near(at_end(&run, "S.Mz"), -pressed * gone, EXACT);
}

/// A rack and its pinion on a frame that flies keep the energy, whether teeth are rigid or give way, whichever way the rack's joint is written, and
/// with another slide between rack and frame.
#[test]
fn racks_on_a_body_that_turns_keep_its_energy() {
    let slides = [
        "S = { prismatic = [\"frame\", \"bar\"], at = \"B\", axis = [1, 0, 0] }",
        "S = { prismatic = [\"bar\", \"frame\"], at = \"B\", axis = [1, 0, 0] }",
        "T = { prismatic = [\"frame\", \"sledge\"], at = \"B\", axis = [-1, 0, 0], spring = { stiffness = \"40 N/m\" } }\n\
         S = { prismatic = [\"sledge\", \"bar\"], at = \"B\", axis = [1, 0, 0] }",
    ];
    for (slide, teeth) in slides.iter().flat_map(|slide| [(slide, ""), (slide, ", stiffness = \"1e4 N/m\"")])
    {
        let sledge = if slide.contains("sledge") { wheel("sledge", "B", 2e-3) } else { String::new() };
        let text = "[points]\nO = { at = [0, 0, 0], on = \"frame\" }\n\
             P = { at = [0, \"-20 mm\", 0], on = \"frame\" }\n\
             B = { at = [\"-50 mm\", \"-20 mm\", 0], on = \"bar\" }\n[bodies]\n"
            .to_owned()
            + &wheel("frame", "O", 1e-3)
            + &wheel("pinion", "O", 4e-4)
            + &wheel("bar", "B", 3e-3)
            + &sledge
            + "[joints]\nF = { free = [\"ground\", \"frame\"], at = \"O\" }\n\
               R = { revolute = [\"frame\", \"pinion\"], at = \"O\", axis = [0, 0, 1], force = \"0.05 N m\" }\n"
            + slide
            + "\n[couplings]\nm = { rack = [\"pinion\", \"bar\"], at = \"P\""
            + teeth
            + " }\n[initial]\nF = { v1 = \"1 rad/s\", v2 = \"0.5 rad/s\", v4 = \"0.1 m/s\" }";
        let statistics = run(&text, 1.0).statistics;
        let (error, throughput) = (statistics.energy_error_J, statistics.energy_throughput_J);
        // A run's tolerance; with teeth that travelled with the rack a hundredth of it was missing.
        assert!(
            throughput > 0.1 && error.abs() < 1e-7 * throughput,
            "{slide} {teeth}: {error} of {throughput} J"
        );
    }
}

/// What a motor feels of a gear train behind a ratio n: J1 + n² J2.
#[test]
fn inertia_is_reflected_by_the_square_of_the_ratio() {
    let text = train(
        &[("p", [0.0; 3], Z, ", force = \"0.5 N m\""), ("g", [80.0, 0.0, 0.0], [0.0, 0.0, -1.0], "")],
        "m = { gears = [\"p\", \"g\"], teeth = [20, 60] }",
    );
    let run = run(&text, 1.0);
    let n = 1.0 / 3.0;
    near(at_end(&run, "R_p.a"), 0.5 / (1e-3 + n * n * 1e-3), EXACT);
    // Both axes point against each other, so that outer wheels turn alike about them.
    near(at_end(&run, "R_g.v"), n * at_end(&run, "R_p.v"), EXACT);
    assert!(run.statistics.energy_error_J < 1e-9 * run.statistics.energy_throughput_J);
}

#[test]
fn a_belt_pulls_its_pulleys_together() {
    let drive = ", drive = \"10 rad/s*t\"";
    let wheels = [("a", [0.0; 3], Z, drive), ("b", [300.0, 0.0, 0.0], Z, ", force = \"-6 N m\"")];
    let (cosine, load) = ((0.04 - 0.08) / 0.3, 6.0 / 0.08);
    let sine = f64::sqrt(1.0 - cosine * cosine);
    for (crossed, tension) in [(false, 0.0), (false, 500.0), (true, 500.0)] {
        let text = train(
            &wheels,
            &format!(
                "b_ = {{ belt = [\"a\", \"b\"], radii = [\"40 mm\", \"80 mm\"], crossed = {crossed}, tension = \"{tension} N\" }}"
            ),
        );
        let text = if crossed { text.replace("-6 N m", "6 N m") } else { text };
        let run = run(&text, 0.1);
        near(at_end(&run, "R_b.v"), if crossed { -5.0 } else { 5.0 }, EXACT);
        near(at_end(&run, "b_.Ft").abs(), load, EXACT);
        let [tight, slack] = ["F1", "F2"].map(|strand| at_end(&run, &format!("b_.{strand}")));
        near((tight - slack).abs(), load, EXACT);
        near(tight.min(slack), if tension > 0.0 { tension - load / 2.0 } else { 0.0 }, EXACT);
        // Both strands along the line of centres.
        let sine = if crossed { f64::sqrt(1.0 - 0.4 * 0.4) } else { sine };
        near(at_end(&run, "R_b.Fx"), (tight + slack) * sine, EXACT);
        near(at_end(&run, "R_a.Fx"), -(tight + slack) * sine, EXACT);
        near(at_end(&run, "R_a.drive"), load * 0.04, EXACT);
    }
}

#[test]
fn a_relation_couples_angles_and_lengths() {
    let text = "[points]\nO = [0, 0, 0]\n[bodies]\n".to_owned()
        + &wheel("a", "O", 1e-3)
        + &wheel("b", "O", 1e-3)
        + "[joints]\n\
           R = { revolute = [\"ground\", \"a\"], at = \"O\", axis = [0, 0, 1], drive = \"3 rad/s*t\" }\n\
           S = { prismatic = [\"ground\", \"b\"], at = \"O\", axis = [0, 0, 1], force = \"-5 N\" }\n\
           [couplings]\nc = { relation = { R = 1, S = \"-40 1/m\" }, offset = \"0.2 rad\" }";
    let run = run(&text, 1.0);
    near(at_end(&run, "S.q"), (3.0 - 0.2) / 40.0, EXACT);
    near(at_end(&run, "R.drive"), 5.0 / 40.0, EXACT);
    near(at_end(&run, "c.T"), -5.0 / 40.0, EXACT);
    // What the relation does is no force of its joints; that of the file is.
    assert!(at_end(&run, "R.Mz").abs() < 1e-12);
    near(at_end(&run, "S.Fz"), -5.0, EXACT);
}

#[test]
fn couplings_stand_in_loops_and_the_other_closure_does_the_same() {
    // A crank drives a rocker that is geared to a second crank.
    let text = "[points]\nA = [0, 0, 0]\nB = [\"50 mm\", 0, 0]\nC = [\"150 mm\", \"120 mm\", 0]\nD = [\"200 mm\", 0, 0]\nE = [\"290 mm\", 0, 0]\n\
        [bodies]\ncrank = { rod = [\"A\", \"B\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }\n\
        coupler = { rod = [\"B\", \"C\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }\n\
        rocker = { rod = [\"C\", \"D\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }\n".to_owned()
        + &wheel("out", "E", 1e-3)
        + "[joints]\n\
        R1 = { revolute = [\"ground\", \"crank\"], at = \"A\", axis = [0, 0, 1], drive = \"10 rad/s*t\" }\n\
        R2 = { revolute = [\"crank\", \"coupler\"], at = \"B\", axis = [0, 0, 1] }\n\
        R3 = { revolute = [\"coupler\", \"rocker\"], at = \"C\", axis = [0, 0, 1] }\n\
        R4 = { revolute = [\"ground\", \"rocker\"], at = \"D\", axis = [0, 0, 1] }\n\
        R5 = { revolute = [\"out\", \"ground\"], at = \"E\", axis = [0, 0, 1] }\n\
        [couplings]\nm = { gears = [\"rocker\", \"out\"], teeth = [40, 20] }";
    let joint = run(text.as_str(), 0.4);
    let log = run(&format!("closure = \"log\"\n{text}"), 0.4);
    // The joint's child is the ground: it turns backwards on the wheel.
    near(at_end(&joint, "R5.q"), 2.0 * at_end(&joint, "R4.q"), EXACT);
    for column in ["R4.q", "R1.drive", "m.Ft", "R4.Fx", "R5.Fy"] {
        // Two runs of a tolerance of 1e-10 each, in other coordinates.
        near(at_end(&log, column), at_end(&joint, column), 1e-6);
    }
}

/// Two discs on a mesh of stiffness k swing against each other at `w² = k (r1²/J1 + r2²/J2)`.
#[test]
fn teeth_that_give_way_swing_at_the_frequency_of_their_wheels() {
    let (k, r1, r2, inertia): (f64, f64, f64, f64) = (1e6, 0.02, 0.06, 1e-3);
    let text = train(
        &[("p", [0.0; 3], Z, ""), ("g", [80.0, 0.0, 0.0], Z, "")],
        "m = { gears = [\"p\", \"g\"], teeth = [20, 60], stiffness = \"1e6 N/m\" }\n[initial]\nR_p = { v = \"1 rad/s\" }",
    );
    let omega = (k * (r1 * r1 + r2 * r2) / inertia).sqrt();
    let end = 0.3 * TAU / omega;
    let run = run(&text, end);
    let force = k * r1 / omega * (0.3 * TAU).sin();
    // The pinion runs ahead and pushes the wheel.
    near(at_end(&run, "m.Ft"), force, 1e-7);
    near(at_end(&run, "m.Fr"), force * (PI / 9.0).tan(), 1e-7);
    let bearing = at_end(&run, "R_g.Fx").hypot(at_end(&run, "R_g.Fy"));
    near(bearing, force / (PI / 9.0).cos(), 1e-7);
    assert!(run.statistics.energy_error_J < 1e-9 * run.statistics.energy_throughput_J);
}

/// A disc between two flanks of a wheel that stands: free flight through the backlash, half a swing in the flank, and back.
#[test]
fn backlash_is_flown_through_and_flanks_do_not_pull() {
    let (k, r, inertia, backlash): (f64, f64, f64, f64) = (1e6, 0.02, 1e-3, 1e-3);
    let text = |damping: &str| {
        train(
            &[("p", [0.0; 3], Z, ""), ("g", [80.0, 0.0, 0.0], Z, ", drive = 0")],
            &format!(
                "m = {{ gears = [\"p\", \"g\"], teeth = [20, 60], stiffness = \"1e6 N/m\", backlash = \"1 mm\"{damping} }}\n\
                 [initial]\nR_p = {{ v = \"1 rad/s\" }}"
            ),
        )
    };
    let flight = backlash / r;
    let contact = PI / (k * r * r / inertia).sqrt();
    let back = run(&text(""), flight + contact);
    // The tolerance of the run over a flight and a bounce.
    near(at_end(&back, "R_p.v"), -1.0, 1e-7);
    assert!(at_end(&back, "R_p.q").abs() < 1e-7);
    // In the gap only the rounding of half a millimetre is left, times 1e6 N/m.
    assert!(["m.Ft", "m.Fr"].iter().all(|column| at_end(&back, column).abs() < 1e-12));
    let damped = run(&text(", damping = \"500 N s/m\""), flight + contact);
    let speed = at_end(&damped, "R_p.v");
    assert!(-0.9 < speed && speed < -0.5, "{speed} rad/s");
    let forces = damped.range("m.Ft").expect("a column");
    // But for the rounding of the gap.
    assert!(
        forces.low.value > -1e-12,
        "the pinion pushes the wheel ahead of it, and never pulls: {} N",
        forces.low.value
    );
    assert!(damped.statistics.energy_error_J < 1e-9);
}

#[test]
fn what_cannot_be_is_refused_with_its_reason() {
    let pair = |axis: [f64; 3], coupling: &str| {
        train(&[("p", [0.0; 3], Z, ""), ("g", [80.0, 0.0, 0.0], axis, "")], coupling)
    };
    let gears = |more: &str| format!("m = {{ gears = [\"p\", \"g\"], {more} }}");
    for (axis, coupling, code, words) in [
        (
            Z,
            gears("teeth = [20, 60], module = \"2.1 mm\""),
            "E0417",
            "80 mm apart, where module and tooth numbers need 84 mm",
        ),
        (Z, gears("teeth = [20.5, 60]"), "E0417", "teeth are counted"),
        (Z, gears("teeth = [0, 60]"), "E0403", "is 0"),
        (Z, gears("teeth = [-20, 60]"), "E0403", "is -20"),
        (Z, gears("teeth = [20]"), "E0106", "1 entry"),
        (Z, gears("module = \"2 mm\""), "E0103", "no `teeth`"),
        (Z, gears("teeth = [20, 20], internal = true"), "E0417", "needs more teeth"),
        (Z, gears("teeth = [20, 60], pressure_angle = \"50 deg\""), "E0417", "is 0.87"),
        (Z, gears("teeth = [20, 60], helix_angle = \"-15 deg\""), "E0417", "`hand = \"left\"`"),
        (Z, gears("teeth = [20, 60], carrier = \"p\""), "E0417", "no body carries"),
        (Z, gears("teeth = [20, 60], backlash = \"0.1 mm\""), "E0103", "no `stiffness`"),
        (Z, gears("teeth = [20, 60], stiffness = 0"), "E0403", "`stiffness`"),
        (Z, gears("teeth = [20, 60], stiffness = \"5 N m\""), "E0303", "`stiffness`"),
        (Z, gears("teeth = [20, 60], stiffness = \"1e6 N/m\", backlash = \"-1 mm\""), "E0403", "`backlash`"),
        (Z, gears("teeth = [20, 60], tension = \"5 N\""), "E0107", "`tension` means nothing"),
        ([1.0, 0.0, 0.0], gears("teeth = [20, 60]"), "E0417", "not parallel"),
        (
            [1.0, 0.0, 0.0],
            "m = { worm = [\"g\", \"p\"], teeth = [2, 40], module = \"4 mm\" }".into(),
            "E0417",
            "0 mm apart",
        ),
        (
            Z,
            "m = { worm = [\"p\", \"g\"], teeth = [2, 40], module = \"4 mm\" }".into(),
            "E0417",
            "not at right angles",
        ),
        (Z, "m = { belt = [\"p\", \"g\"], radii = [\"40 mm\", \"41 mm\"] }".into(), "E0417", "would overlap"),
        (
            Z,
            "m = { planetary = [\"p\", \"g\", \"ground\"], teeth = [20, 60] }".into(),
            "E0407",
            "does not turn",
        ),
        (Z, "m = { differential = [\"p\", \"g\"] }".into(), "E0106", "3 bodies"),
        (Z, "m = { relation = { R_p = 1 } }".into(), "E0106", "2 coordinates"),
        (Z, "m = { relation = { R_p = 1, R_g = 0 } }".into(), "E0417", "factor of zero"),
        (Z, "m = { relation = { R_p = 1, R_g = \"3 mm\" } }".into(), "E0303", "does not add up"),
        (Z, "m = { relation = { R_p = 1, R_q = 2 } }".into(), "E0204", "R_q"),
        (Z, "m = { }".into(), "E0108", "nothing says"),
        (
            Z,
            "m = { gears = [\"p\", \"g\"], belt = [\"p\", \"g\"], teeth = [20, 60] }".into(),
            "E0107",
            "several kinds",
        ),
    ] {
        let told = refused(&text_of(&pair(axis, &coupling)));
        assert!(told.contains(code) && told.contains(words), "{coupling}: {told}");
    }
}
