//! End stops against closed forms: what comes back of an impact by every law, on every kind of coordinate, and the balance of energy.

mod simulated;

use std::f64::consts::PI;

use linkwear_runtime::{Integrator, Run, Settings, Span};
use simulated::{at_end, run_with};

/// Without gravity.
fn run_by(text: &str, end: f64, samples: usize, integrator: Integrator) -> Run {
    let settings = Settings { span: Span::Time(end), samples, integrator, ..Settings::default() };
    run_with(&format!("gravity = [0, 0, 0]\n{text}"), &settings)
}

const FINE: Integrator = Integrator::Dopri5 { tolerance: 1e-11, max_step: None };

fn run(text: &str, end: f64) -> Run {
    run_by(text, end, 201, FINE)
}

fn largest(run: &Run, column: &str) -> f64 {
    run.column(column).expect(column).iter().fold(0.0, |most, x| x.abs().max(most))
}

#[track_caller]
fn near(found: f64, expected: f64, part: f64) {
    assert!((found - expected).abs() <= part * expected.abs(), "{found}, not {expected}");
}

const POINTS: &str = "[points]\nO = [0, 0, 0]\nA = [\"0.1 m\", 0, 0]\n";

/// A block of 2 kg on a rail along x, 0.1 m before a stop with these keys, at a speed [m/s].
fn block(stop: &str, speed: f64) -> String {
    format!(
        "{POINTS}[bodies]\nbody = {{ rod = [\"O\", \"A\"], radius = \"10 mm\", mass = \"2 kg\" }}\n[joints]\n\
         rail = {{ prismatic = [\"ground\", \"body\"], at = \"O\", axis = [1, 0, 0] }}\n\
         [stops]\nbump = {{ joint = \"rail\", {stop} }}\n[initial]\nrail = {{ q = \"0 m\", v = \"{speed} m/s\" }}\n"
    )
}

/// Speed after the impact over that before.
fn rebound(stop: &str, speed: f64) -> f64 {
    let run = run(&block(stop, speed), 0.3 / speed.abs());
    assert!(at_end(&run, "bump.F") == 0.0 && at_end(&run, "bump.depth") == 0.0, "it is still in contact");
    // The tolerance of the run, on an energy of the order of 1 J.
    let error = run.statistics.energy_error_J;
    assert!(error < 1e-8 * speed * speed, "{error} J");
    -at_end(&run, "rail.v") / speed
}

/// What a run's tolerance of 1e-11 leaves after some hundred steps through a contact.
const EXACT: f64 = 1e-7;

#[test]
fn an_elastic_stop_gives_all_back_from_both_sides() {
    for stop in [
        "upper = \"0.1 m\", stiffness = \"1e6 N/m\"",
        "lower = \"-1 m\", upper = \"0.1 m\", stiffness = \"1e6 N/m\"",
        "upper = \"0.1 m\", stiffness = \"1e6 N/m\", exponent = 1.5, depth = \"1 mm\"",
        "upper = \"0.1 m\", stiffness = \"1e6 N/m\", exponent = 2, depth = \"1 mm\"",
        "upper = \"0.1 m\", stiffness = \"1e6 N/m\", exponent = 1.7, depth = \"1 mm\"",
    ] {
        near(rebound(stop, 1.0), 1.0, EXACT);
    }
    for stop in [
        "lower = \"-0.1 m\", stiffness = \"1e6 N/m\"",
        "lower = \"-0.1 m\", upper = \"1 m\", stiffness = \"1e6 N/m\", restitution = 1",
    ] {
        near(rebound(stop, -1.0), 1.0, EXACT);
    }
}

/// Half a period of the spring, and the depth v/omega.
#[test]
fn a_linear_stop_is_a_spring_while_it_touches() {
    let run = run_by(&block("upper = \"0.1 m\", stiffness = \"20 kN/m\"", 1.0), 0.15, 1501, FINE);
    let omega = (20e3_f64 / 2.0).sqrt();
    let (q, depth, force) =
        (run.column("rail.q").unwrap(), run.column("bump.depth").unwrap(), run.column("bump.F").unwrap());
    for (k, t) in run.times.iter().enumerate() {
        let phase = omega * (t - 0.1);
        let exact = if phase > 0.0 && phase < PI { phase.sin() / omega } else { 0.0 };
        // The tolerance of the run in some ten steps.
        assert!((depth[k] - exact).abs() < 1e-9, "{t}: {} {exact}", depth[k]);
        assert!((force[k] + 20e3 * depth[k]).abs() < 1e-9 && (q[k] - 0.1 - exact < 1e-9), "{t}");
    }
}

/// Rebound by Stronge's law with the smooth sign at low speed: the work of both halves of an impact, each by the midpoint rule in the
/// speed: `m v dv = -F dx`, so that `dv v/(1 +- r v/sqrt(v² + w²))` is the same potential energy for both.
fn stronge(e: f64, speed: f64, floor: f64) -> f64 {
    let (mean, half) = (0.5 * (1.0 + e * e), 0.5 * (1.0 - e * e));
    let steps = 400_000;
    let work = |v: f64, sign: f64| v / (mean + sign * half * v / v.hypot(floor));
    let width = speed / f64::from(steps);
    let middle = |k: i32| (f64::from(k) + 0.5) * width;
    let taken: f64 = (0..steps).map(|k| work(middle(k), 1.0) * width).sum();
    let (mut given, mut k) = (0.0, 0);
    loop {
        let next = work(middle(k), -1.0) * width;
        if given + next > taken {
            return (f64::from(k) * width + (taken - given) / next * width) / speed;
        }
        (given, k) = (given + next, k + 1);
    }
}

#[test]
fn the_default_law_has_its_restitution_at_any_speed_mass_and_exponent() {
    for (e, speed) in [(0.8, 1.0), (0.6, 1.0), (0.3, 2.0), (0.6, 0.1)] {
        for power in ["", ", exponent = 1.5, depth = \"1 mm\""] {
            let stop = format!("upper = \"0.1 m\", stiffness = \"1e6 N/m\", restitution = {e}{power}");
            let found = rebound(&stop, speed);
            // The midpoint rule with 2e-6 of the speed as its step, and the run.
            near(found, stronge(e, speed, 1e-3), 1e-6);
            // What the smooth sign changes is (v_f/(e² v))², but for a logarithm.
            near(found, e, 5.0 * (1e-3 / (e * e * speed)).powi(2));
        }
    }
    // At the floor itself it is a damper: much more comes back.
    let slow =
        "upper = \"0.1 m\", stiffness = \"1e6 N/m\", restitution = 0.3, impact_speed_floor = \"1 m/s\"";
    near(rebound(slow, 1.0), stronge(0.3, 1.0, 1.0), 1e-6);
    assert!(rebound(slow, 1.0) > 0.4);
}

/// On the way out there is only what the smooth sign leaves, half of it times (v_f/2v)²: v⁴ = v_f² v_0² / 2.
#[test]
fn a_plastic_stop_keeps_what_it_takes_but_for_its_floor() {
    let found = rebound("upper = \"0.1 m\", stiffness = \"1e6 N/m\", restitution = 0", 1.0);
    near(found, stronge(0.0, 1.0, 1e-3), 1e-6);
    near(found, (1e-3_f64 / 2.0_f64.sqrt()).sqrt(), 1e-2);
}

/// `e` from the damping factor: G(1) = G(-e), G(u) = u/chi - ln(1 + chi u)/chi², by halving.
fn of_factor(chi: f64) -> f64 {
    let g = |u: f64| u / chi - (chi * u).ln_1p() / (chi * chi);
    let (mut low, mut high) = (0.0, (1.0_f64).min(1.0 / chi));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if g(-middle) < g(1.0) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn laws_by_speed_return_what_their_equation_says() {
    let e = 0.7_f64;
    for (law, chi) in [
        ("hunt_crossley", 1.5 * (1.0 - e)),
        ("lankarani_nikravesh", 0.75 * (1.0 - e * e)),
        ("flores", 8.0 * (1.0 - e) / (5.0 * e)),
        ("lee_wang", 0.75 * (1.0 - e)),
    ] {
        for (speed, power) in [(0.5, ""), (1.0, ""), (2.0, ", exponent = 1.5, depth = \"1 mm\"")] {
            let stop = format!(
                "upper = \"0.1 m\", stiffness = \"1e6 N/m\", restitution = {e}, law = \"{law}\", impact_speed = \"1 m/s\"{power}"
            );
            near(rebound(&stop, speed), of_factor(chi * speed), EXACT);
        }
    }
    let exact = "upper = \"0.1 m\", stiffness = \"1e6 N/m\", restitution = 0.7, law = \"exact\", impact_speed = \"1 m/s\"";
    near(rebound(exact, 1.0), 0.7, EXACT);
}

/// A spring with a damper, cut off where it would pull [Schwager & Pöschel, Granular Matter 9 (2007) 465-469]: with
/// b = c/2m and w0² = k/m, e = exp(-b/w (pi - atan(2 b w/(w² - b²)))) while b is less than w0/sqrt 2.
#[test]
fn a_viscous_stop_returns_what_its_damping_ratio_leaves() {
    let (m, k) = (2.0_f64, 1e6_f64);
    for ratio in [0.05, 0.2, 0.5] {
        let c = 2.0 * ratio * (k * m).sqrt();
        let (b, w0) = (c / (2.0 * m), (k / m).sqrt());
        let w = (w0 * w0 - b * b).sqrt();
        let e = (-b / w * (PI - (2.0 * b * w / (w * w - b * b)).atan())).exp();
        for speed in [0.2, 2.0] {
            let stop = format!("upper = \"0.1 m\", stiffness = \"{k} N/m\", damping = \"{c} N s/m\"");
            near(rebound(&stop, speed), e, EXACT);
        }
    }
}

/// Joints with a body of 1 kg, 0.01 kg m² about every axis, which meet a stop of one coordinate; speeds before and after.
#[test]
fn every_kind_of_coordinate_is_stopped() {
    let body = "[bodies]\nbody = { mass = \"1 kg\", centre = \"O\", inertia = [\"0.01 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"] }\n";
    let angle = "upper = \"30 deg\", stiffness = \"1e4 N m/rad\", restitution = 0.5";
    let length = "lower = \"-50 mm\", upper = \"50 mm\", stiffness = \"1e6 N/m\", restitution = 0.5";
    for (joint, stopped, column, stop, speed) in [
        ("revolute = [\"ground\", \"body\"], axis = [0, 0, 1]", "J", "v", angle, 2.0),
        // The body is the parent: the tree takes the joint the other way round.
        ("revolute = [\"body\", \"ground\"], axis = [0, 0, 1]", "J", "v", angle, 2.0),
        ("prismatic = [\"ground\", \"body\"], axis = [0, 1, 1]", "J", "v", length, 0.5),
        ("cylindrical = [\"ground\", \"body\"], axis = [0, 0, 1]", "J.q1", "v1", angle, 2.0),
        ("cylindrical = [\"ground\", \"body\"], axis = [0, 0, 1]", "J.q2", "v2", length, -0.5),
        ("slot = [\"ground\", \"body\"], axis = [0, 0, 1], first = [1, 0, 0]", "J.q1", "v1", length, 0.5),
        ("slot = [\"ground\", \"body\"], axis = [0, 0, 1], first = [1, 0, 0]", "J.q2", "v2", angle, 2.0),
        ("planar = [\"ground\", \"body\"], axis = [0, 0, 1]", "J.q2", "v2", length, -0.5),
        ("universal = [\"ground\", \"body\"], axes = [[1, 0, 0], [0, 1, 0]]", "J.q2", "v2", angle, 2.0),
        ("inline = [\"ground\", \"body\"], axis = [0, 0, 1]", "J.q1", "v1", length, 0.5),
        ("screw = [\"ground\", \"body\"], axis = [0, 0, 1], lead = \"5 mm\"", "J", "v", angle, 2.0),
    ] {
        let unit = if stop == angle { "rad/s" } else { "m/s" };
        let text = format!(
            "[points]\nO = [0, 0, 0]\n{body}[joints]\nJ = {{ {joint}, at = \"O\" }}\n[stops]\nbump = {{ joint = \"{stopped}\", {stop} }}\n\
             [initial]\nJ = {{ {column} = \"{speed} {unit}\" }}\n"
        );
        let run = run(&text, 0.35);
        // Floors of 1 mm/s and 0.01 rad/s beside speeds of 0.5 m/s and 2 rad/s, squared, but for a logarithm.
        // An inline joint has one coordinate, and a rotation that starts by numbers too.
        let column = if joint.starts_with("inline") { "v" } else { column };
        near(at_end(&run, &format!("J.{column}")), -0.5 * speed, 1e-3);
        assert!(run.statistics.energy_error_J < 1e-9, "{joint}: {}", run.statistics.energy_error_J);
    }
}

/// Weight that lies on a stop: the depth m g/k, and the force in the column and in the joint.
#[test]
fn a_weight_comes_to_rest_on_a_stop() {
    let stop = "lower = \"-5 mm\", stiffness = \"1e5 N/m\", damping = \"400 N s/m\"";
    let text = block(stop, 0.0).replace("axis = [1, 0, 0]", "axis = [0, 0, 1]");
    let text = format!("gravity = [0, 0, \"-9.81 m/s^2\"]\n{text}");
    let settings = Settings { span: Span::Time(1.0), samples: 11, integrator: FINE, ..Settings::default() };
    let run = run_with(&text, &settings);
    // What an oscillation of 100 /s leaves of itself in the second: exp(-100).
    near(at_end(&run, "bump.depth"), 2.0 * 9.81 / 1e5, EXACT);
    near(at_end(&run, "bump.F"), 2.0 * 9.81, EXACT);
    near(at_end(&run, "rail.Fz"), 2.0 * 9.81, EXACT);
    assert!(largest(&run, "rail.Fx") < 1e-12);
}

/// A bounce on a stop under a load: heights fall by e² each, times by e [Goldsmith, Impact, ch. 1].
#[test]
fn a_ball_bounces_as_often_as_its_restitution_says() {
    let e = 0.8_f64;
    let text = block(&format!("lower = \"0 m\", stiffness = \"1e8 N/m\", restitution = {e}"), 0.0)
        .replace("axis = [1, 0, 0]", "axis = [1, 0, 0], force = \"-20 N\"")
        .replace("q = \"0 m\"", "q = \"0.2 m\"");
    let fall = (2.0 * 0.2 / 10.0_f64).sqrt();
    // In the middle of the flight after the third contact.
    let end = fall * (1.0 + 2.0 * e + 2.0 * e * e + e.powi(3));
    let run = run(&text, end);
    // The load works within the contact too: of d = v sqrt(m/k) = 0.3 mm it takes (1 - e²) F d/(e² E) of the energy, 0.1 % and more
    // each time.
    near(at_end(&run, "rail.q"), 0.2 * e.powi(6), 5e-3);
    assert!(at_end(&run, "rail.v").abs() < 0.05);
    assert!(run.statistics.energy_error_J < 1e-7, "{}", run.statistics.energy_error_J);
}

/// A slider-crank without drives or weight: at every place its energy is the same, so after the slider has struck a stop it comes back past every
/// place with e times its speed, whatever its inertia is there (Newton's restitution; of one contact without friction it is Stronge's).
#[test]
fn a_slider_crank_comes_back_from_its_stop_with_its_restitution() {
    for (stop, e) in [
        ("restitution = 0.7", 0.7),
        ("restitution = 0.4, exponent = 1.5, depth = \"0.1 mm\"", 0.4),
        ("", 1.0),
    ] {
        let text = format!(
            "[points]\nO = [0, 0, 0]\nA = [\"40 mm\", 0, 0]\nB = [\"160 mm\", 0, 0]\n[bodies]\n\
             crank = {{ rod = [\"O\", \"A\"], radius = \"8 mm\", mass = \"0.4 kg\" }}\nrod = {{ rod = [\"A\", \"B\"], radius = \"6 mm\", mass = \"0.5 kg\" }}\n\
             ram = {{ mass = \"1 kg\", centre = \"B\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}\n[joints]\n\
             R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1] }}\n\
             pin = {{ revolute = [\"crank\", \"rod\"], at = \"A\", axis = [0, 0, 1] }}\nwrist = {{ revolute = [\"rod\", \"ram\"], at = \"B\", axis = [0, 0, 1] }}\n\
             guide = {{ prismatic = [\"ground\", \"ram\"], at = \"B\", axis = [1, 0, 0] }}\n\
             [stops]\nend = {{ joint = \"guide\", lower = \"-45 mm\", stiffness = \"2e7 N/m\", {stop} }}\n\
             [initial]\nR1 = {{ q = \"60 deg\", v = \"20 rad/s\" }}\n[assembly]\npin = \"-80 deg\"\n"
        );
        let run = run_by(&text, 0.12, 4001, FINE);
        let (q, v) = (run.column("R1.q").unwrap(), run.column("R1.v").unwrap());
        assert!(largest(&run, "end.F") > 1e3);
        let back = (1..q.len()).find(|k| v[*k] < 0.0 && q[*k] < 60_f64.to_radians()).expect("it comes back");
        // Between the last two rows.
        let part = (q[back - 1] - 60_f64.to_radians()) / (q[back - 1] - q[back]);
        let speed = v[back - 1] + part * (v[back] - v[back - 1]);
        // The floor of 1 mm/s beside an impact at some 0.7 m/s: 1e-3/(0.16 0.7) squared, and a speed that is linear between rows of 30 us.
        near(-speed, e * 20.0, 2e-4);
        assert!(run.statistics.energy_error_J < 1e-7, "{}", run.statistics.energy_error_J);
    }
}

/// A slider-crank of which crank and rod have a millionth of the mass, whose slider a constant load drives against its stop again and again: the slider flies as
/// a stone does, so the speeds of its impacts are a geometric series, and so are the times between them, which add up to t (1 + e)/(1 - e).
#[test]
fn a_loaded_slider_crank_hammers_its_stop_in_a_geometric_series() {
    let (e, load, way, stiffness) = (0.5_f64, 20.0_f64, 0.1_f64, 1e10_f64);
    let text = format!(
        "[points]\nO = [0, 0, 0]\nA = [\"50 mm\", \"0.1 m*sin(60 deg)\", 0]\nB = [\"50 mm + sqrt(0.09 m^2 - (0.1 m*sin(60 deg))^2)\", 0, 0]\n[bodies]\n\
         crank = {{ rod = [\"O\", \"A\"], radius = \"1 mm\", mass = \"1 mg\" }}\nrod = {{ rod = [\"A\", \"B\"], radius = \"1 mm\", mass = \"1 mg\" }}\n\
         ram = {{ mass = \"1 kg\", centre = \"B\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}\n[joints]\n\
         R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1] }}\n\
         pin = {{ revolute = [\"crank\", \"rod\"], at = \"A\", axis = [0, 0, 1] }}\nwrist = {{ revolute = [\"rod\", \"ram\"], at = \"B\", axis = [0, 0, 1] }}\n\
         guide = {{ prismatic = [\"ground\", \"ram\"], at = \"B\", axis = [1, 0, 0], force = \"-{load} N\" }}\n\
         [stops]\nend = {{ joint = \"guide\", lower = \"-{way} m\", stiffness = \"{stiffness:e} N/m\", restitution = {e}, impact_speed_floor = \"0.05 mm/s\" }}\n"
    );
    let run = run_by(&text, 0.32, 320_001, FINE);
    let (force, speed) = (run.column("end.F").unwrap(), run.column("guide.v").unwrap());
    let begins = (1..force.len()).filter(|row| force[*row] > 0.0 && force[*row - 1] == 0.0);
    let impacts: Vec<(f64, f64)> = begins.map(|row| (run.times[row], -speed[row - 1])).collect();
    let (first, fastest) = ((2.0 * way / load).sqrt(), (2.0 * way * load).sqrt());
    let (mut time, mut left) = (first, fastest);
    for (at, before) in &impacts[..5] {
        // A row is up to a microsecond before the contact: 2e-5 m/s, of 0.12 m/s at the slowest of these.
        near(*at, time, 2e-5);
        near(*before, left, 2e-4);
        // Within the contact, v/w deep with w = sqrt(k/m), the load works too; and on the way out it is as stiff as e² k.
        let (w, depth) = (stiffness.sqrt(), left / stiffness.sqrt());
        left = (e * e * left * left - 2.0 * (1.0 - e * e) * load * depth).sqrt();
        time += 0.5 * PI / w * (1.0 + 1.0 / e) + 2.0 * left / load;
    }
    // A contact lasts 47 us.
    let all = first * (1.0 + e) / (1.0 - e) + 5e-5 * impacts.len() as f64;
    assert!(impacts.last().expect("impacts").0 < all, "{impacts:?}");
    // It lies on the stop: (2) of docs/stops-and-compliance.md at rest.
    near(at_end(&run, "end.depth"), load / (stiffness * 0.5 * (1.0 + e * e)), 1e-2);
    assert!(at_end(&run, "guide.v").abs() < 1e-4);
    assert!(run.statistics.energy_error_J < 1e-7, "{}", run.statistics.energy_error_J);
}
