//! What the model of the contact area makes of the case study's wear: depth per turn, and how it goes with clearance.

#[path = "support/bearing.rs"]
mod bearing;
mod support;

use bearing::assert_near;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Integrator, Settings, Span};
use support::{compile_source, run_with, shipped};

/// Depth of one settled turn [m].
fn depth(area: &str, clearance: &str) -> f64 {
    let SourceFile { name, text } = shipped("rssr");
    let changed = text.replace("area = \"hertz\"", &format!("area = \"{area}\""));
    assert!(changed.contains(&format!("area = \"{area}\"")), "the area is written as this test expects");
    let compiled = compile_source(&SourceFile { name, text: changed }, &[("c0", clearance)], None);
    // Two turns settle S to 1e-6.
    let settings = Settings {
        settle: Span::Turns(2.0),
        ..Settings::new(Integrator::Rk4 { step: 2e-5 }, Span::Turns(1.0), 0)
    };
    run_with(&compiled, &settings).run.turns[0][0].depth
}

fn check(area: &str, at_10_um: f64, exponent: f64) {
    let (narrow, wide) = (depth(area, "10 um"), depth(area, "90 um"));
    let slope = (wide / narrow).ln() / 9_f64.ln();
    println!("{area} {narrow:e} {slope}");
    // The numbers have two or three digits.
    assert_near(narrow, at_10_um, 0.02, area);
    assert!((slope - exponent).abs() < 0.01, "{area}: depth goes with the clearance to the power of {slope}");
}

#[test]
fn wear_over_the_projected_area_hardly_feels_the_clearance() {
    check("projected", 1.43e-14, 0.005);
}

#[test]
fn wear_over_the_width_of_hertz_goes_with_the_root_of_the_clearance() {
    check("hertz", 3.25e-13, 0.50);
}

#[test]
fn wear_over_a_conformal_arc_goes_with_the_cube_root_of_the_clearance() {
    check("conformal", 7.7e-14, 0.335);
}
