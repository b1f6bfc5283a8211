//! Controllers, continuous and at sampled times, against transfer functions, recursions in closed form and integrations written here.

mod simulated;

use linkwear_runtime::{Integrator, Run, Settings, Simulation, Span, Watch};
use simulated::{compiled, run_with};

const ADAPTIVE: Integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };

fn run_by(text: &str, end: f64, samples: usize, method: Integrator) -> Run {
    run_with(text, &Settings::new(method, Span::Time(end), samples))
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs().max(1.0), "{found}, not {expected}");
}

#[track_caller]
fn energy_is_kept(run: &Run, part: f64) {
    let (error, throughput) = (run.statistics.energy_error_J, run.statistics.energy_throughput_J);
    assert!(error.abs() <= part * throughput, "{error} J of {throughput} J");
}

/// Rounding of some hundred operations and a run's tolerance of 1e-10.
const EXACT: f64 = 1e-8;
/// Between samples a torque is constant: all methods are exact there, and leave the rounding of a thousand steps.
const RECURSION: f64 = 1e-9;

/// A rotor of 0.5 kg m² on an axis through its centre.
fn rotor(joint: &str, rest: &str) -> String {
    format!(
        r#"gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
[bodies]
rotor = {{ mass = "2 kg", centre = "O", inertia = ["0.5 kg m^2", "0.5 kg m^2", "0.5 kg m^2"] }}
[joints]
shaft = {{ revolute = ["ground", "rotor"], at = "O", axis = [0, 0, 1], force = "motor", {joint} }}
{rest}"#
    )
}

const INERTIA: f64 = 0.5;

const DAMPING: f64 = 0.3;

/// Angle, speed and torque of the rotor with viscous damping at a time, under torques that are held from sample to sample: by the
/// exponential of its matrix.
fn held_rotor(t: f64, period: f64, mut law: impl FnMut(f64, f64) -> f64) -> [f64; 3] {
    let (mut q, mut v, mut torque) = (0.0, 0.0, 0.0);
    let last = (t / period + 1e-9).floor() as usize;
    for k in 0..=last {
        torque = law(q, v);
        let h = if k < last { period } else { (t - period * last as f64).max(0.0) };
        let fades = (-DAMPING / INERTIA * h).exp();
        let end = torque / DAMPING;
        q += end * h + (v - end) * INERTIA / DAMPING * (1.0 - fades);
        v = end + (v - end) * fades;
    }
    [q, v, torque]
}

const METHODS: [Integrator; 4] = [
    ADAPTIVE,
    Integrator::Rk43 { tolerance: 1e-10, max_step: None },
    Integrator::Rk4 { step: 0.007 },
    Integrator::GeneralizedAlpha { step: 0.0002, rho: 0.8 },
];

/// Of a method on the damped rotor: generalised-alpha has an error of the square of its step.
fn bound(method: Integrator) -> f64 {
    if matches!(method, Integrator::GeneralizedAlpha { .. }) { 1e-6 } else { RECURSION }
}

#[test]
fn sampled_p_control_of_a_damped_rotor_is_its_recursion() {
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[controllers]
motor = { measured = "shaft.v", setpoint = "3 rad/s", proportional = "4 N m s", sample_time = "30 ms" }"#,
    );
    for method in METHODS {
        // Rows divide neither samples nor steps.
        let run = run_by(&text, 1.0, 38, method);
        let columns = ["shaft.q", "shaft.v", "motor.value"].map(|name| run.column(name).unwrap());
        for (at, t) in run.times.iter().enumerate() {
            let expected = held_rotor(*t, 0.03, |_, v| 4.0 * (3.0 - v));
            for (column, expected) in columns.iter().zip(expected) {
                near(column[at], expected, bound(method));
            }
        }
        energy_is_kept(&run, 10.0 * bound(method));
    }
}

#[test]
fn samples_are_met_whatever_rows_and_steps_divide() {
    // One sample time that divides the rows, one that rounding puts beside them, one that divides nothing.
    for (period, rows) in [(0.1, 11), (0.03, 101), (1.0 / 7.0, 38), (0.25, 2)] {
        let text = rotor(
            r#"damping = "0.3 N m s/rad""#,
            &format!(
                r#"[controllers]
motor = {{ measured = "shaft.q", setpoint = "1 rad", proportional = "2 N m", sample_time = "{period} s" }}"#
            ),
        );
        for method in [ADAPTIVE, Integrator::Rk4 { step: 0.011 }] {
            let run = run_by(&text, 1.0, rows, method);
            let torques = run.column("motor.value").unwrap();
            let angles = run.column("shaft.q").unwrap();
            for (at, t) in run.times.iter().enumerate() {
                let [q, _, torque] = held_rotor(*t, period, |q, _| 2.0 * (1.0 - q));
                near(angles[at], q, RECURSION);
                near(torques[at], torque, RECURSION);
            }
        }
    }
}

#[test]
fn a_sampled_pid_with_limits_filter_and_delay_is_its_recursion() {
    let pid = |rest: &str| {
        rotor(
            r#"damping = "0.3 N m s/rad""#,
            &format!(
                r#"[controllers.motor]
measured = "shaft.q"
setpoint = "2 rad"
proportional = "20 N m"
integral = "15 N m/s"
derivative = "4 N m s"
derivative_filter = "5 ms"
setpoint_weight = 0.7
derivative_weight = 0.1
feedforward = "0.5 N m"
initial = "0.2 N m"
lower = "0.1 N m"
upper = "5 N m"
tracking = "80 ms"
sample_time = "20 ms"
{rest}"#
            ),
        )
    };
    for delay in [false, true] {
        let run = run_by(&pid(&format!("delay = {delay}")), 3.0, 62, ADAPTIVE);
        let columns = ["shaft.q", "shaft.v", "motor.value"].map(|name| run.column(name).unwrap());
        let mut limited = [false; 2];
        for (at, t) in run.times.iter().enumerate() {
            // From its equations: backward difference of the filter, forward of the integral.
            let (mut integral, mut filtered, mut pending) = (0.2, 0.0, 0.0);
            let (h, lag) = (0.02, 0.005);
            let expected = held_rotor(*t, h, |q, _| {
                let slope = (0.1 * 2.0 - q - filtered) / (lag + h);
                let wish: f64 = 20.0 * (0.7 * 2.0 - q) + integral + 4.0 * slope + 0.5;
                let output = wish.clamp(0.1, 5.0);
                integral += h * (15.0 * (2.0 - q) + (output - wish) / 0.08);
                filtered += h * slope;
                limited[0] |= wish < 0.1;
                limited[1] |= wish > 5.0;
                std::mem::replace(&mut pending, output) * f64::from(u8::from(delay))
                    + output * f64::from(u8::from(!delay))
            });
            for (column, expected) in columns.iter().zip(expected) {
                near(column[at], expected, RECURSION);
            }
        }
        assert_eq!(limited, [true, true], "both limits are met");
        energy_is_kept(&run, 1e-9);
    }
}

#[test]
fn a_law_of_its_own_acts_by_its_states_all_at_once() {
    // A lead compensator with two states that ask for each other as they were.
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[controllers.motor]
sample_time = "40 ms"
output = "(3 N m)*(1 - shaft.q) + (0.5 N m)*motor.a - (0.25 N m)*motor.b"
[controllers.motor.states]
a = { initial = "0.1 rad", next = "0.5*motor.b + shaft.q" }
b = { next = "motor.a" }"#,
    );
    let run = run_by(&text, 2.0, 23, ADAPTIVE);
    let (angles, kept) = (run.column("shaft.q").unwrap(), run.column("motor.a.value").unwrap());
    for (at, t) in run.times.iter().enumerate() {
        let (mut a, mut b) = (0.1, 0.0);
        let [q, ..] = held_rotor(*t, 0.04, |q, _| {
            let torque = 3.0 * (1.0 - q) + 0.5 * a - 0.25 * b;
            (a, b) = (0.5 * b + q, a);
            torque
        });
        near(angles[at], q, RECURSION);
        near(kept[at], a, RECURSION);
    }
}

#[test]
fn a_cascade_acts_in_the_order_of_the_file() {
    // The outer loop at every third sample of the inner one, which sees at once what it asks for.
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[sensors]
place = "shaft.q"
[controllers]
outer = { measured = "place", setpoint = "1 rad", proportional = "3 rad/s", sample_time = "60 ms" }
motor = { measured = "shaft.v", setpoint = "outer", proportional = "5 N m s", sample_time = "20 ms" }"#,
    );
    let run = run_by(&text, 1.0, 29, ADAPTIVE);
    let angles = run.column("shaft.q").unwrap();
    for (at, t) in run.times.iter().enumerate() {
        let (mut wanted, mut k) = (0.0, 0);
        let [q, ..] = held_rotor(*t, 0.02, |q, v| {
            if k % 3 == 0 {
                wanted = 3.0 * (1.0 - q);
            }
            k += 1;
            5.0 * (wanted - v)
        });
        near(angles[at], q, RECURSION);
    }
}

#[test]
fn continuous_pi_of_speed_has_the_poles_of_its_transfer_function() {
    // J v' = -d v + K (r - v) + I, I' = K_i (r - v): a step response of the second order with a zero.
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[controllers]
motor = { measured = "shaft.v", setpoint = "3 rad/s", proportional = "1 N m s", integral = "8 N m" }"#,
    );
    let run = run_by(&text, 2.0, 21, ADAPTIVE);
    let (rate, square) = ((DAMPING + 1.0) / (2.0 * INERTIA), 8.0 / INERTIA);
    let w = (square - rate * rate).sqrt();
    let speeds = run.column("shaft.v").unwrap();
    for (at, t) in run.times.iter().enumerate() {
        // v = r (1 - exp(-rate t) (cos w t + c sin w t)), v'(0) = K r/J.
        let c = (rate - 1.0 / INERTIA) / w;
        let expected = 3.0 * (1.0 - (-rate * t).exp() * ((w * t).cos() + c * (w * t).sin()));
        near(speeds[at], expected, EXACT);
    }
    energy_is_kept(&run, 1e-8);
}

#[test]
fn a_continuous_pid_with_filter_has_the_step_response_of_its_transfer_function() {
    // Angle of the undamped rotor with PID and filter: four poles, of J s^3 (T s + 1) + (K (T s + 1) + K_d s) s + K_i (T s + 1); the
    // response by the exponential of the companion matrix of that polynomial.
    let (k, k_i, k_d, lag) = (30.0, 20.0, 6.0, 0.02);
    let text = rotor(
        r#"damping = "0 N m s/rad""#,
        r#"[controllers]
motor = { measured = "shaft.q", setpoint = "1 rad", proportional = "30 N m", integral = "20 N m/s", derivative = "6 N m s", derivative_filter = "20 ms", derivative_weight = 1 }"#,
    );
    let run = run_by(&text, 1.5, 16, ADAPTIVE);
    // Denominator, from the highest power; numerator is all but its first two coefficients.
    let monic = INERTIA * lag;
    let den = [INERTIA / monic, (k * lag + k_d) / monic, (k + k_i * lag) / monic, k_i / monic];
    let angles = run.column("shaft.q").unwrap();
    for (at, t) in run.times.iter().enumerate() {
        let expected = companion_step(den, [0.0, den[1], den[2], den[3]], *t);
        near(angles[at], expected, EXACT);
    }
}

type Matrix = [[f64; 5]; 5];

fn matrix(entry: impl Fn(usize, usize) -> f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn product(x: &Matrix, y: &Matrix) -> Matrix {
    matrix(|i, j| (0..5).map(|m| x[i][m] * y[m][j]).sum())
}

/// Step response of (n_0 s^3 + n_1 s^2 + ..)/(s^4 + d_0 s^3 + ..) at a time: the exponential of its companion matrix with the input
/// as one more state, by its series over a short time, squared again and again.
fn companion_step(den: [f64; 4], num: [f64; 4], t: f64) -> f64 {
    let a = matrix(|i, j| match (i, j) {
        (0..3, _) => f64::from(u8::from(j == i + 1)),
        (3, 4) => 1.0,
        (3, _) => -den[3 - j],
        _ => 0.0,
    });
    let halvings = 12;
    let h = t / f64::from(1 << halvings);
    let mut term = matrix(|i, j| f64::from(u8::from(i == j)));
    let mut sum = term;
    for n in 1..12 {
        let next = product(&term, &a);
        term = matrix(|i, j| next[i][j] * h / f64::from(n));
        sum = matrix(|i, j| sum[i][j] + term[i][j]);
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    (0..4).map(|i| num[3 - i] * sum[i][4]).sum()
}

#[test]
fn a_continuous_integral_gives_way_at_a_limit() {
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[controllers]
motor = { measured = "shaft.v", setpoint = "10 rad/s", proportional = "1 N m s", integral = "8 N m", lower = "-2 N m", upper = "4 N m", tracking = "70 ms" }"#,
    );
    let run = run_by(&text, 3.0, 31, ADAPTIVE);
    let columns = ["shaft.v", "motor.integral.value", "motor.value"].map(|name| run.column(name).unwrap());
    assert_eq!(columns[2][1], 4.0, "it is at its limit");
    let rate = |[v, sum]: [f64; 2]| {
        let wish: f64 = 10.0 - v + sum;
        let output = wish.clamp(-2.0, 4.0);
        [(output - DAMPING * v) / INERTIA, 8.0 * (10.0 - v) + (output - wish) / 0.07]
    };
    // Classical Runge-Kutta steps of 10 us: of what a kink within a step leaves, below 1e-9.
    let (mut y, per_row) = ([0.0; 2], 10_000);
    let h = 0.1 / f64::from(per_row);
    for (speed, integral) in columns[0].iter().zip(&columns[1]) {
        near(*speed, y[0], EXACT);
        near(*integral, y[1], EXACT);
        for _ in 0..per_row {
            let shifted = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
            let a = rate(y);
            let b = rate(shifted(a, 0.5 * h));
            let c = rate(shifted(b, 0.5 * h));
            let d = rate(shifted(c, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
    }
    energy_is_kept(&run, 1e-8);
}

const CASCADE: &str = r#"[controllers.motor]
measured = "shaft.q"
setpoint = "2 rad"
proportional = "20 N m"
integral = "15 N m/s"
derivative = "4 N m s"
upper = "5 N m"
sample_time = "20 ms"
delay = true"#;

#[test]
fn a_kept_state_goes_on_with_the_same_bits() {
    let compiled = compiled(&rotor(r#"damping = "0.3 N m s/rad""#, CASCADE));
    let system = compiled.interpreter();
    for method in
        [ADAPTIVE, Integrator::Rk43 { tolerance: 1e-8, max_step: None }, Integrator::Rk4 { step: 0.007 }]
    {
        let settings = Settings::new(method, Span::Time(1.0), 0);
        let start = || {
            Simulation::start(&system, compiled.description(), &compiled.parameters(), &settings)
                .expect("it starts")
        };
        // In the middle between samples, at one, and a last place beside one.
        for pause in [0.333, 0.34, (17.0_f64 * 0.02).next_down(), (17.0_f64 * 0.02).next_up()] {
            let mut whole = start();
            whole.advance(pause, Watch::NONE).expect("it goes on");
            let kept = whole.state();
            let ends = [0.341, 0.36, 0.9].map(|t| {
                whole.advance(t, Watch::NONE).expect("it goes on");
                whole.values().to_vec()
            });
            let mut other = start();
            other.advance(0.777, Watch::NONE).expect("it goes on");
            other.restore(&kept).expect("its own state");
            for (t, end) in [0.341, 0.36, 0.9].into_iter().zip(ends) {
                other.advance(t, Watch::NONE).expect("it goes on");
                assert_eq!(other.values(), end, "{method:?} from {pause} at {t}");
            }
        }
    }
}

#[test]
fn somebody_elses_integrator_is_refused_with_the_cure() {
    let compiled = compiled(&rotor("", CASCADE));
    let system = compiled.interpreter();
    let settings = Settings::new(ADAPTIVE, Span::Time(1.0), 0);
    let refused = linkwear_runtime::StateSpace::start_at(
        0.0,
        &system,
        compiled.description(),
        &compiled.parameters(),
        &settings,
    );
    let text = refused.err().expect("it is refused").to_string();
    assert!(text.contains("sampled times") && text.contains("co-simulation"), "{text}");
}

#[test]
fn turns_of_a_life_go_on_between_samples() {
    // Turns end at samples, up to rounding: none is met twice, none is left out.
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[controllers]
motor = { measured = "shaft.q", setpoint = "1 rad", proportional = "2 N m", sample_time = "0.1 s" }"#,
    );
    let text = text
        .replace("[joints]", "crank = { mass = \"1 kg\", centre = \"O\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"1 kg m^2\"] }\n[joints]\nturn = { revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*t/(0.3 s)\" }");
    let compiled = compiled(&text);
    let system = compiled.interpreter();
    let (description, parameters) = (compiled.description(), compiled.parameters());
    let method = Integrator::Rk43 { tolerance: 1e-10, max_step: None };
    let mut runner = linkwear_runtime::TurnRunner::new(&system, description, &parameters, method, 1e-6)
        .expect("it starts");
    for turn in 1..=4 {
        runner.measure(Watch::NONE).expect("a turn");
        let state = runner.state();
        let place = |name: &str| description.speeds.iter().position(|speed| speed.name == name).expect(name);
        let [_, v, torque] = held_rotor(0.3 * f64::from(turn), 0.1, |q, _| 2.0 * (1.0 - q));
        near(state.v[place("shaft.v")], v, RECURSION);
        near(state.v[place("motor.value")], torque, RECURSION);
    }
}

#[test]
fn a_setpoint_may_be_a_table_and_an_input() {
    let text = rotor(
        r#"damping = "0.3 N m s/rad""#,
        r#"[inputs]
shift = "0.2 rad"
[tables]
way = { argument = ["0 s", "0.4 s", "2 s"], value = ["0 rad", "1 rad", "-0.6 rad"], interpolation = "linear" }
[controllers]
motor = { measured = "shaft.q", setpoint = "way(t) + shift", proportional = "6 N m", sample_time = "30 ms" }"#,
    );
    let run = run_by(&text, 1.5, 17, ADAPTIVE);
    let angles = run.column("shaft.q").unwrap();
    for (at, t) in run.times.iter().enumerate() {
        let mut k = 0.0;
        let [q, ..] = held_rotor(*t, 0.03, |q, _| {
            let now: f64 = 0.03 * k;
            k += 1.0;
            let way = if now < 0.4 { now / 0.4 } else { 1.0 - (now - 0.4) };
            6.0 * (way + 0.2 - q)
        });
        near(angles[at], q, RECURSION);
    }
}
