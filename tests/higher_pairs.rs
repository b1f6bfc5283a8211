//! Slots, planes, surfaces and rods without mass against closed forms and published figures.

mod support;

use std::f64::consts::{FRAC_PI_4, TAU};

use linkwear_codegen::source::SourceFile;
use linkwear_runtime::Span;
use support::{Recorded, compile_source, run, shipped};

/// Of the largest value of a column: the integrator's tolerance, added up over a second or a turn.
const CLOSED_FORM: f64 = 1e-9;

fn motion(text: &str, seconds: f64, samples: usize) -> Recorded {
    let source = SourceFile { name: "test.toml".to_owned(), text: text.to_owned() };
    let compiled = compile_source(&source, &[], None);
    run(&compiled, Span::Time(seconds), Span::Time(0.0), samples, 1e-12)
}

fn assert_column(run: &Recorded, column: &str, expected: impl Fn(usize) -> f64) {
    let values = run.column(column);
    let expected: Vec<f64> = (0..values.len()).map(expected).collect();
    let size = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    for (k, (found, right)) in values.iter().zip(&expected).enumerate() {
        assert!((found - right).abs() < CLOSED_FORM * size, "{column}, row {k}: {found} instead of {right}");
    }
}

#[test]
fn a_geneva_wheel_turns_and_peaks_as_published() {
    let compiled = compile_source(&shipped("geneva"), &[], None);
    let run = run(&compiled, Span::Time(0.25), Span::Time(0.0), 2001, 1e-12);
    // Angle of the wheel from the line of centres: tan b = m sin a/(1 - m cos a) with m = crank over centres.
    let m = 0.5_f64.sqrt();
    let crank = |k: usize| TAU * run.run.times[k] - FRAC_PI_4;
    let wheel = |a: f64| (m * a.sin()).atan2(1.0 - m * a.cos());
    assert_column(&run, "R2.q", |k| -FRAC_PI_4 - wheel(crank(k)));
    assert_column(&run, "R2.v", |k| {
        let c = crank(k).cos();
        -TAU * m * (c - m) / (1.0 - 2.0 * m * c + m * m)
    });
    assert_column(&run, "R2.a", |k| {
        let (s, c) = crank(k).sin_cos();
        TAU * TAU * m * (1.0 - m * m) * s / (1.0 - 2.0 * m * c + m * m).powi(2)
    });
    // As tables of external Geneva wheels print it for four slots and a crank speed of 1 rad/s: speed 2.41 rad/s on the line
    // of centres, acceleration at most 5.41 rad/s^2.
    let peak = |column: &str| {
        run.column(column)
            .iter()
            .enumerate()
            .fold((0, 0.0), |most: (usize, f64), (k, x)| if x.abs() > most.1 { (k, x.abs()) } else { most })
    };
    let (_, speed) = peak("R2.v");
    let (at, acceleration) = peak("R2.a");
    assert_eq!(format!("{:.2}", speed / TAU), "2.41");
    assert_eq!(format!("{:.2}", acceleration / (TAU * TAU)), "5.41");
    let k = (1.0 + m * m) / (4.0 * m);
    let place = ((k * k + 2.0).sqrt() - k).acos();
    // Rows are 0.045 deg apart.
    assert!((crank(at).abs() - place).to_degrees().abs() < 0.05);
}

const TETHER: &str = r#"
spec = 1
name = "tether"
gravity = [0, "-9.81 m/s^2", 0]
[points]
O = [0, 0, 0]
A = ["0.8 m", 0, 0]
[bodies]
ball = { mass = "2 kg", centre = "A", inertia = ["0.01 kg m^2", "0.01 kg m^2", "0.01 kg m^2"] }
[joints]
F = { free = ["ground", "ball"], at = "A" }
rod = { distance = ["ground", "ball"], at = "A", origin = "O" }
"#;

#[test]
fn a_rod_without_mass_carries_three_times_the_fallen_weight() {
    let run = motion(TETHER, 1.0, 21);
    let [x, y] = ["A.x", "A.y"].map(|column| run.column(column));
    // From rest at its height, m v^2/L + m g y/L: 3 m g times the fall over the length.
    let force = |k: usize| -3.0 * 2.0 * 9.81 * y[k] / 0.8;
    assert_column(&run, "rod.Fx", |k| -force(k) * x[k] / 0.8);
    assert_column(&run, "rod.Fy", |k| -force(k) * y[k] / 0.8);
    for (x, y) in x.iter().zip(&y) {
        // Kept by projection onto the rows.
        assert!((x.hypot(*y) - 0.8).abs() < 1e-10);
    }
}

const ECCENTRIC: &str = r#"
spec = 1
name = "eccentric"
gravity = [0, 0, 0]
[parameters]
e = "10 mm"
r = "30 mm"
[points]
O = [0, 0, 0]
top = [0, "sqrt(r^2 - e^2)", 0]
[bodies]
cam = { mass = "0.5 kg", centre = "O", inertia = ["1e-4 kg m^2", "1e-4 kg m^2", "2e-4 kg m^2"] }
follower = { mass = "0.2 kg", centre = "top" }
[joints]
R = { revolute = ["ground", "cam"], at = "O", axis = [0, 0, 1], drive = "2*pi*1 Hz*t" }
P = { prismatic = ["ground", "follower"], at = "top", axis = [0, 1, 0], force = "-20 N" }
S = { on_surface = ["cam", "follower"], at = "top", origin = "O", equation = "sqrt((x - e)^2 + y^2) - r" }
"#;

#[test]
fn an_eccentric_lifts_and_pushes_at_its_pressure_angle() {
    let run = motion(ECCENTRIC, 1.0, 41);
    let (e, r) = (0.01_f64, 0.03_f64);
    let angle = |k: usize| TAU * run.run.times[k];
    let along = |k: usize| (r * r - (e * angle(k).cos()).powi(2)).sqrt();
    assert_column(&run, "top.y", |k| e * angle(k).sin() + along(k));
    // The pressure angle: tan = (ds/dangle)/s of a centred follower (Norton, Design of Machinery, cams).
    let lift = |k: usize| {
        let (sine, cosine) = angle(k).sin_cos();
        e * cosine + e * e * sine * cosine / along(k)
    };
    let push = run.column("S.Fy");
    assert_column(&run, "S.Fx", |k| -push[k] * lift(k) / (e * angle(k).sin() + along(k)));
    // The drive does the work of the follower.
    let side = run.column("R.drive");
    for k in 0..41 {
        assert!((side[k] - push[k] * lift(k)).abs() < CLOSED_FORM);
    }
}

#[test]
fn a_point_in_an_inclined_plane_slides_and_presses() {
    let run = motion(
        r#"
spec = 1
name = "slope"
gravity = [0, 0, "-9.81 m/s^2"]
[points]
A = ["0.1 m", "-0.2 m", "0.3 m"]
[bodies]
block = { mass = "3 kg", centre = "A", inertia = ["0.01 kg m^2", "0.02 kg m^2", "0.02 kg m^2"] }
[joints]
slope = { inplane = ["ground", "block"], at = "A", axis = [3, 0, 4], first = [4, 0, -3] }
"#,
        0.5,
        11,
    );
    let t = run.run.times.clone();
    // tan of the slope is 3/4.
    assert_column(&run, "slope.q1", |k| 0.5 * 9.81 * 0.6 * t[k] * t[k]);
    assert_column(&run, "slope.Fx", |_| 3.0 * 9.81 * 0.8 * 0.6);
    assert_column(&run, "slope.Fz", |_| 3.0 * 9.81 * 0.8 * 0.8);
}

const HOOP: &str = r#"
spec = 1
name = "hoop"
gravity = [0, 0, "-9.8 m/s^2"]
[parameters]
R = "0.4 m"
[points]
O = [0, 0, 0]
A = ["R*sqrt(3)/2", 0, "-R/2"]
[bodies]
hoop = { mass = "1 kg", centre = "O", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.2 kg m^2"] }
bead = { mass = "0.3 kg", centre = "A", inertia = ["1e-5 kg m^2", "1e-5 kg m^2", "1e-5 kg m^2"] }
[joints]
J = { revolute = ["ground", "hoop"], at = "O", axis = [0, 0, 1], drive = "7 rad/s*t" }
F = { free = ["ground", "bead"], at = "A" }
ring = { on_surface = ["hoop", "bead"], at = "A", origin = "O", equation = "sqrt(x^2 + y^2 + z^2) - R" }
side = { SIDE }
"#;

#[test]
fn a_bead_on_a_turning_hoop_rests_where_gravity_and_turning_balance() {
    for side in [
        "on_surface = [\"hoop\", \"bead\"], at = \"A\", origin = \"O\", equation = \"y\"",
        "inplane = [\"hoop\", \"bead\"], at = \"A\", axis = [0, 1, 0], first = [1, 0, 0], cut = true",
    ] {
        let run = motion(&HOOP.replace("SIDE", side), 1.0, 21);
        // cos(angle) = g/(w^2 R): w = 7 rad/s and R = 0.4 m give 60.0 deg at g = 9.8 m/s^2.
        let t = run.run.times.clone();
        let radius = 0.4 * 0.75_f64.sqrt();
        // An unstable direction there is none, so rounding does not grow.
        assert_column(&run, "A.x", |k| radius * (7.0 * t[k]).cos());
        assert_column(&run, "A.y", |k| radius * (7.0 * t[k]).sin());
        assert_column(&run, "A.z", |_| -0.2);
        // The hoop carries the weight and the centripetal force, both along the radius.
        assert_column(&run, "ring.Fz", |_| 0.3 * 9.8);
        assert_column(&run, "ring.Fx", |k| -0.3 * 49.0 * radius * (7.0 * t[k]).cos());
    }
}

#[test]
fn a_rod_without_mass_is_the_limit_of_a_light_one() {
    let file = shipped("five_link");
    let mut heavy = file.clone();
    let given = "rod5 = { distance = [\"ground\", \"carrier\"], origin = \"body_tie\", at = \"tie\" }";
    assert!(heavy.text.contains(given));
    let joints = "rod5 = { spherical = [\"link\", \"carrier\"], at = \"tie\" }\n\
                  foot = { universal = [\"ground\", \"link\"], at = \"body_tie\", axes = [[1, 0, 0], [0, 0, 1]] }";
    let body =
        "[bodies]\nlink = { rod = [\"body_tie\", \"tie\"], radius = \"5 mm\", density = \"1 kg/m^3\" }";
    heavy.text = heavy.text.replace(given, joints).replacen("[bodies]", body, 1);
    let [light, heavy] = [file, heavy]
        .map(|source| run(&compile_source(&source, &[], None), Span::Time(0.5), Span::Time(0.0), 11, 1e-11));
    for column in ["hub.x", "hub.y", "hub.z", "hub.vz", "rod1.Fy", "rod5.Fy"] {
        let (a, b) = (light.column(column), heavy.column(column));
        let size = a.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for (a, b) in a.iter().zip(&b) {
            // A rod of 3e-5 kg against 38 kg.
            assert!((a - b).abs() < 3e-6 * size, "{column}: {a} and {b}");
        }
    }
}

/// A profile by rows, met at a lowest point that is a row: its lever arm there is rounding.
#[test]
fn a_cam_by_a_table_is_the_cam_of_its_formula() {
    let by_formula = shipped("cam");
    let mut by_table = by_formula.clone();
    let formula = "mean - lift*(x^2 - y^2)/(x^2 + y^2)";
    assert!(by_table.text.contains(formula));
    by_table.text = by_table.text.replace(formula, "profile(atan2(y, x))");
    let rows = (0..25).map(|k| f64::from(15 * k - 180));
    let arguments: Vec<String> = rows.clone().map(|angle| format!("\"{angle} deg\"")).collect();
    let values = rows.map(|angle| 30.0 + 4.0 * (2.0 * angle.to_radians()).cos());
    let values: Vec<String> = values.map(|radius| format!("\"{radius:.9} mm\"")).collect();
    by_table.text += &format!(
        "\n[tables.profile]\nargument = [{}]\nvalue = [{}]\ninterpolation = \"spline\"\noutside = \"periodic\"\n",
        arguments.join(", "),
        values.join(", ")
    );
    let [table, formula] = [by_table, by_formula].map(|source| {
        run(&compile_source(&source, &[], None), Span::Time(0.2), Span::Time(0.0), 21, 1e-10)
            .column("roller.y")
    });
    for (a, b) in table.iter().zip(&formula) {
        // A cubic spline through rows h apart: h^4/384 times the fourth derivative, 16 times 4 mm.
        assert!((a - b).abs() < 0.9e-6, "{a} and {b}");
    }
}
