//! Starts beside a singular position are refused or right by every method; a driver that meets its dead point is named.

mod bars;

use std::f64::consts::{FRAC_PI_3, PI};

use bars::{foldable, four_bar};
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::{Options, SourceFile, compile};
use linkwear_runtime::{Integrator, Run, RunError, Settings, Span, Watch, simulate};

fn run(compiled: &Compiled, integrator: Integrator, time: f64) -> Run {
    let settings = Settings::new(integrator, Span::Time(time), 2);
    let system = compiled.interpreter();
    simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("it starts")
}

const METHODS: [Integrator; 3] = [
    Integrator::Dopri5 { tolerance: 1e-9, max_step: None },
    Integrator::Rk4 { step: 1e-3 },
    Integrator::GeneralizedAlpha { step: 1e-3, rho: 0.8 },
];

#[test]
fn a_start_beside_a_singular_position_is_refused_or_right() {
    let mut taken = 0;
    for base in [0.0, PI] {
        for beside in [0.0, 1e-11, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
            for (name, corners) in foldable(base + beside) {
                for (crank, more) in
                    [(", drive = \"10 rad/s*t\"", ""), ("", "[initial]\nR1 = { v = \"10 rad/s\" }\n")]
                {
                    let case = format!("{name}{crank} from {base} + {beside:e} rad");
                    let compiled = match four_bar(corners, crank, "", more) {
                        Ok(compiled) => compiled,
                        Err(code) => {
                            assert!(code == "E0608" || beside == 0.0, "{case}: {code}");
                            continue;
                        }
                    };
                    // A fifth of a second: away from the start, and not yet at the next singular position.
                    let fine = run(&compiled, Integrator::Dopri5 { tolerance: 1e-11, max_step: None }, 0.2);
                    for method in METHODS {
                        let found = run(&compiled, method, 0.2);
                        if fine.stopped.is_some() || found.stopped.is_some() || !found.warnings.is_empty() {
                            continue;
                        }
                        taken += 1;
                        for column in ["R1.q", "R4.q"] {
                            let last = |run: &Run| run.column(column).expect("it is there")[1];
                            let error = (last(&found) - last(&fine)).abs() % (2.0 * PI);
                            // Generalised-alpha of steps of a hundredth of a radian is good to 1e-3 rad.
                            let error = error.min(2.0 * PI - error);
                            assert!(error < 5e-3, "{case}, {method:?}: {column} off by {error:e} rad");
                        }
                    }
                }
            }
        }
    }
    assert!(taken > 50, "only {taken} runs were taken");
}

#[test]
fn a_driver_at_its_dead_point_is_named_with_time_and_place() {
    // Crank 0.1 and coupler 0.25 in line are 0.35 long; the rocker is 0.2, the ground 0.3: the rocker turns no further
    // than where its end is 0.35 from the crank's pin.
    let (coupler, rocker, base) = (0.25_f64, 0.2_f64, 0.3_f64);
    let angle_at =
        |reach: f64| ((base * base + rocker * rocker - reach * reach) / (2.0 * base * rocker)).acos();
    let (outer, inner) = (angle_at(0.35), angle_at(0.15));
    // The rocker starts between them and is driven towards the outer end, where crank and coupler are in line.
    let start = FRAC_PI_3;
    let b = [base - rocker * start.cos(), rocker * start.sin()];
    let reach = b[0].hypot(b[1]);
    let crank = 0.1_f64;
    let along = (crank * crank - coupler * coupler + reach * reach) / (2.0 * reach);
    let across = (crank * crank - along * along).sqrt();
    let (ux, uy) = (b[0] / reach, b[1] / reach);
    let a = [ux * along - uy * across, uy * along + ux * across];
    assert!(inner < start && start < outer);
    // The rocker's angle from the ground line grows clockwise.
    let compiled = four_bar([a, b, [base, 0.0]], "", ", drive = \"-1 rad/s*t\"", "").expect("it starts");
    for method in METHODS {
        let run = run(&compiled, method, 2.0);
        let Some(RunError::DeadPoint { t, joint, position, angular: true }) = &run.stopped else {
            panic!("{method:?}: {:?}", run.stopped);
        };
        // At a double root loops close to the root of their tolerance, 1e-8: 1e-4 rad.
        assert!((t - (outer - start)).abs() < 2e-4, "{method:?}: {t} s, not {}", outer - start);
        assert!(
            (position + (outer - start)).abs() < 2e-4 && joint == "R4",
            "{method:?}: {joint} at {position}"
        );
        assert_eq!(run.rows.len(), 1, "the rows before it are kept");
    }
}

#[test]
fn a_crank_that_passes_a_singular_position_is_told_where() {
    let [(_, corners), ..] = foldable(1.0);
    let compiled = four_bar(corners, ", drive = \"10 rad/s*t\"", "", "").expect("it is taken");
    let messages: Vec<_> =
        compiled.warnings.iter().map(|warning| (warning.code.as_str(), warning.message.clone())).collect();
    // One radian is where it is drawn, and zero there: in line again after 180 deg less 57.3.
    let [("W0117", message)] = &messages[..] else { panic!("{messages:?}") };
    assert!(message.contains("at 122.7 deg"), "{message}");
}

/// With three or four cranks rows are redundant, and where all lie in line more than that: the loops close all the way round.
#[test]
fn cranks_beside_each_other_pass_the_line_that_all_lie_on() {
    for (cranks, start) in [(3, 90.0_f64), (3, 60.0), (3, 57.3), (4, 90.0), (4, 30.0)] {
        let (x, y) = (100.0 * start.to_radians().cos(), 100.0 * start.to_radians().sin());
        let places = [0.0, 200.0, 450.0, 510.0];
        let (mut points, mut bodies, mut joints) = (String::new(), String::new(), String::new());
        for (at, place) in places.into_iter().take(cranks).enumerate() {
            points += &format!("O{at} = [\"{place} mm\", \"0 m\", \"0 m\"]\n");
            points += &format!("A{at} = [\"{} mm\", \"{y} mm\", \"0 m\"]\n", place + x);
            bodies += &format!(
                "c{at} = {{ rod = [\"O{at}\", \"A{at}\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}\n"
            );
            let drive = if at == 0 { ", drive = \"10 rad/s*t\"" } else { "" };
            joints += &format!(
                "R{at} = {{ revolute = [\"ground\", \"c{at}\"], at = \"O{at}\", axis = [0, 0, 1]{drive} }}\n"
            );
            joints +=
                &format!("S{at} = {{ revolute = [\"c{at}\", \"bar\"], at = \"A{at}\", axis = [0, 0, 1] }}\n");
        }
        let last = cranks - 1;
        bodies += &format!(
            "bar = {{ rod = [\"A0\", \"A{last}\"], radius = \"5 mm\", density = \"7850 kg/m^3\" }}\n"
        );
        let text = format!(
            "spec = 1\nname = \"cranks\"\ngravity = [0, 0, 0]\n[points]\n{points}[bodies]\n{bodies}[joints]\n{joints}"
        );
        let source = SourceFile { name: "cranks.toml".to_owned(), text };
        let compiled = compile(&source, &Options::default()).expect("it is taken");
        let codes: Vec<_> = compiled.warnings.iter().map(|warning| warning.code.as_str()).collect();
        assert_eq!(codes, ["W0117"], "{cranks} cranks from {start} deg: {:?}", compiled.warnings);
        let message = &compiled.warnings[0].message;
        assert!(
            message.contains(&format!("at {:.1} deg", 180.0 - start).replace(".0 deg", " deg")),
            "{message}"
        );
    }
}

#[test]
fn a_run_that_fails_in_a_singular_position_names_it() {
    let mut named = 0;
    for (name, corners) in foldable(1.0) {
        let compiled = four_bar(corners, ", drive = \"10 rad/s*t\"", "", "").expect("it is taken");
        for step in [1e-3, 4e-3, 1e-2, 2e-2] {
            for method in [Integrator::Rk4 { step }, Integrator::GeneralizedAlpha { step, rho: 0.8 }] {
                let case = format!("{name} {method:?}");
                let Some(error) = run(&compiled, method, 2.0 * PI / 10.0).stopped else { continue };
                let RunError::InSingularPosition { t, is_adaptive: false, .. } = &error else {
                    panic!("{case}: {error}")
                };
                named += 1;
                // Links come in line where the crank lies on the ground: a step, or a tenth of a radian, beside it.
                let angle = (1.0 + 10.0 * t) % PI;
                let beside = angle.min(PI - angle);
                assert!(beside < (10.0 * step).max(0.1), "{case}: {error}, {beside} rad beside");
                assert!(error.to_string().contains("--integrator dopri5"), "{error}");
            }
        }
    }
    assert!(named > 0);
}
