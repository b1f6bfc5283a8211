//! Loops with more joints than their motion needs: what `check` takes runs, and what cannot run `check` refuses.

use linkwear_codegen::compile::{Options, compile};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{CLOSED, Integrator, Settings, Span, Watch, simulate};

type Vector = [f64; 3];

/// Four bars, a revolute joint at each corner; the third corner may lie elsewhere on the rocker.
struct FourBar {
    points: [Vector; 4],
    rocker_end: Vector,
    axes: [Vector; 4],
}

impl FourBar {
    /// A crank-rocker whose axes are parallel, its crank of 1 m anywhere.
    fn planar(crank: Vector) -> Self {
        let (dx, dy) = (2.0 - crank[0], 0.0 - crank[1]);
        let distance = f64::hypot(dx, dy);
        let along = (2.5 * 2.5 - 2.0 * 2.0 + distance * distance) / (2.0 * distance);
        let across = (2.5 * 2.5 - along * along).sqrt();
        let end = [
            crank[0] + (dx * along - dy * across) / distance,
            crank[1] + (dy * along + dx * across) / distance,
            0.0,
        ];
        Self { points: [[0.0; 3], crank, end, [2.0, 0.0, 0.0]], rocker_end: end, axes: [[0.0, 0.0, 1.0]; 4] }
    }

    /// The shipped one.
    fn bennett() -> Self {
        let points = [[0.3, 0.0, -0.1], [0.1, 0.25, 0.1], [-0.3, 0.0, -0.1], [-0.1, -0.25, 0.1]];
        let axes = [[10.0, -4.0, 15.0], [0.0, -12.0, 15.0], [-10.0, 4.0, 15.0], [0.0, 12.0, 15.0]];
        Self { points, rocker_end: points[2], axes }
    }

    fn text(&self, size: f64) -> String {
        let place = |p: Vector| {
            let [x, y, z] = p.map(|x| x * size);
            format!("[\"{x:?} m\", \"{y:?} m\", \"{z:?} m\"]")
        };
        let [p1, p2, p3, p4] = self.points.map(place);
        let [a1, a2, a3, a4] = self.axes.map(|axis| format!("{axis:?}"));
        let rod = |a: &str, b: &str| {
            format!("{{ rod = [\"{a}\", \"{b}\"], radius = \"{:?} m\", mass = \"1 kg\" }}", 0.01 * size)
        };
        format!(
            "spec = 1\nname = \"loop\"\ngravity = [0, \"-9.81 m/s^2\", 0]\n[points]\nP1 = {p1}\nP2 = {p2}\nP3 = {{ coupler = {p3}, rocker = {} }}\nP4 = {p4}\n\
             [bodies]\ncrank = {}\ncoupler = {}\nrocker = {}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"crank\"], at = \"P1\", axis = {a1}, drive = \"2*pi*t*0.5 Hz\" }}\n\
             R2 = {{ revolute = [\"crank\", \"coupler\"], at = \"P2\", axis = {a2} }}\n\
             R3 = {{ revolute = [\"coupler\", \"rocker\"], at = \"P3\", axis = {a3} }}\n\
             R4 = {{ revolute = [\"ground\", \"rocker\"], at = \"P4\", axis = {a4} }}\n",
            place(self.rocker_end),
            rod("P1", "P2"),
            rod("P2", "P3"),
            rod("P4", "P3"),
        )
    }
}

/// Linkages that an error makes inexact: of axes, of lengths, of both sides of a joint.
fn inexact(error: f64) -> [(&'static str, FourBar); 6] {
    let crank = [0.6, -0.8, 0.0];
    let mut crooked_second = FourBar::planar(crank);
    crooked_second.axes[1] = [error, 0.3 * error, 1.0];
    let mut crooked_third = FourBar::planar(crank);
    crooked_third.axes[2] = [0.5 * error, error, 1.0];
    // Here the third joint rests for a moment: to first order nothing tells that its axis is crooked.
    let mut crooked_at_rest = FourBar::planar([1.0, 0.0, 0.0]);
    crooked_at_rest.axes[2] = [0.5 * error, error, 1.0];
    let mut beside = FourBar::planar(crank);
    beside.rocker_end[2] += error;
    let mut crooked_bennett = FourBar::bennett();
    crooked_bennett.axes[2][1] += 15.0 * error;
    let mut long_bennett = FourBar::bennett();
    long_bennett.points[1][0] += 0.3 * error;
    [
        ("second axis", crooked_second),
        ("third axis", crooked_third),
        ("third axis at rest", crooked_at_rest),
        ("offset", beside),
        ("Bennett's axis", crooked_bennett),
        ("Bennett's bar", long_bennett),
    ]
}

/// The code of the first error, or nothing after one turn by every method.
fn checked_and_run(text: String, case: &str) -> Option<&'static str> {
    let source = SourceFile { name: "loop.toml".to_owned(), text };
    let compiled = match compile(&source, &Options::default()) {
        Ok(compiled) => compiled,
        Err(errors) => {
            let (code, told) = (errors.list()[0].code.as_str(), errors.to_string());
            let says_how_far = ["it opens by", "stays open by", "misses that motion by"];
            let is_told = says_how_far.iter().any(|words| told.contains(words));
            assert!(is_told || !["E0601", "E0603"].contains(&code), "{case}: {told}");
            return Some(code);
        }
    };
    assert!(compiled.warnings.is_empty(), "{case}: {:?}", compiled.warnings);
    let system = compiled.interpreter();
    for integrator in [
        Integrator::Dopri5 { tolerance: 1e-8, max_step: None },
        Integrator::Rk4 { step: 4e-3 },
        Integrator::GeneralizedAlpha { step: 4e-3, rho: 0.8 },
    ] {
        let settings = Settings::new(integrator, Span::Turns(1.0), 0);
        let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
            .unwrap_or_else(|error| panic!("{case}, {integrator:?}: {error}"));
        assert_eq!(run.stopped, None, "{case}, {integrator:?}");
        assert_eq!(run.warnings, [], "{case}, {integrator:?}");
        assert!(run.statistics.max_loop_error_rad <= CLOSED, "{case}, {integrator:?}");
    }
    None
}

#[test]
fn what_check_takes_runs_and_what_cannot_run_is_refused() {
    for size in [1e-6, 1.0, 1e3] {
        for digits in 3..=12 {
            // Between the powers of ten too, where it turns.
            for error in [1.0, 3.0].iter().take(if size == 1.0 && (7..10).contains(&digits) { 2 } else { 1 })
            {
                let error = error * 10.0_f64.powi(-digits);
                for (name, linkage) in inexact(error) {
                    let case = format!("{name} off by {error:e} at {size:e} m");
                    let refused = checked_and_run(linkage.text(size), &case);
                    // Ten digits are more than a drawing has; with six a loop opens by more than a run takes.
                    match digits {
                        10.. => assert_eq!(refused, None, "{case}"),
                        3..=6 => assert!(matches!(refused, Some("E0601" | "E0603")), "{case}: {refused:?}"),
                        _ => {}
                    }
                }
            }
        }
    }
}

#[test]
fn a_refusal_says_how_far_the_loop_misses() {
    let message = |error: f64| {
        let [(_, linkage), ..] = inexact(error);
        let source = SourceFile { name: "loop.toml".to_owned(), text: linkage.text(1.0) };
        compile(&source, &Options::default()).unwrap_err().list()[0].message.clone()
    };
    let tenfold = |text: String| text.replace("e-4 m", "e-5 m");
    assert!(message(1e-3).contains("along its motion it opens by"), "{}", message(1e-3));
    assert_eq!(tenfold(message(1e-3)), message(1e-4));
}
