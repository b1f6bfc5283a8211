//! What the model of the contact area makes of the case study's wear: depth per turn, and how it goes with clearance.

#[path = "support/bearing.rs"]
mod bearing;
mod support;

use bearing::assert_near;
use linkwear::backend::Backend;
use linkwear::mechanism::Mechanism;
use linkwear_codegen::Options;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::life::WearSource;
use linkwear_runtime::{DynamicsSource, Integrator, RevolutionSettings, Settings, Span};
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

/// A rotor of 50 kg under its weight, in a bearing of 10 mm with a play of 20 um.
fn rotor((parent, child): (&str, &str), friction: f64, gravity: &str) -> String {
    format!(
        r#"
spec = 1
name = "rotor"
gravity = {gravity}
[parameters]
speed = "600 rpm"
[points]
O = [0, 0, 0]
[bodies]
rotor = {{ mass = "50 kg", centre = "O", inertia = ["1 kg m^2", "1 kg m^2", "1 kg m^2"] }}
[joints]
B = {{ revolute = ["{parent}", "{child}"], at = "O", axis = [0, 0, 1], drive = "2*pi*speed*t" }}
[clearance.B]
radial = "20 um"
journal_radius = "10 mm"
length = "20 mm"
modulus = "110 GPa"
restitution = 0.9
friction = {friction}
[wear.B]
coefficient = 1e-8
hardness = "2 GPa"
threshold = "100 um"
area = "projected"
"#
    )
}

#[test]
fn a_steadily_loaded_bearing_wears_as_archards_law_has_it_by_hand() {
    // Nothing damps a journal that begins beside the place where friction holds it, or slower than its load turns in the bearing: it
    // swings, and its loads by 0.3 to 3 % of wear.
    let (weight, radius, play) = (50.0 * 9.81, 10e-3, 20e-6);
    let area = 2.0 * radius * 20e-3;
    let below = r#"[0, "-9.81 m/s^2", 0]"#;
    let aside = r#"["-5.886 m/s^2", "-7.848 m/s^2", 0]"#;
    for (bodies, friction, gravity) in [
        (("ground", "rotor"), 0.0, below),
        (("ground", "rotor"), 0.1, below),
        (("ground", "rotor"), 0.5, aside),
        (("rotor", "ground"), 0.0, aside),
        // From a friction of 0.1 on, a swing of a bush that turns grows (`unsteady_bearings.rs`).
        (("rotor", "ground"), 0.05, below),
    ] {
        let source = SourceFile { name: "rotor.toml".to_owned(), text: rotor(bodies, friction, gravity) };
        let mechanism = Mechanism::compile(&source, &Options::default(), Backend::Auto).expect("it compiles");
        let (system, settings) = (mechanism.system(), RevolutionSettings::default());
        let source = DynamicsSource::new(&*system, &mechanism.description, &mechanism.parameters, settings);
        let mut source = source.expect("a start");
        let unworn = source.unworn();
        source.measure(&unworn, &mut None).expect("it turns");
        let steady = source.steadiness()[0];
        let force = weight / (1.0_f64 + friction * friction).sqrt();
        // A turning bush slides at its own radius.
        let slides = if bodies.0 == "ground" { radius } else { radius + play };
        let depth = 1e-8 * force * core::f64::consts::TAU * slides / (2e9 * area);
        let error = steady.wear / depth - 1.0;
        // The penetration is 1.3e-4 of the radius.
        assert!(error.abs() < 2e-4, "{bodies:?}, friction {friction}: {error:e}");
        assert!(
            steady.drift.is_none_or(|drift| drift.abs() < 1e-4),
            "{bodies:?}, friction {friction}: {steady:?}"
        );
    }
}
