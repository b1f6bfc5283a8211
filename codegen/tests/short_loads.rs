//! Loads and motions much shorter than the steps around them, in mechanisms that are quiet before and after: each is met, and has its
//! momentum.

mod simulated;

use linkwear_codegen::model::DataTable;
use linkwear_codegen::spec::{Interpolation, Outside};
use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{at_end, compiled, run_with};

const TOLERANCE: f64 = 1e-9;
/// Every adaptive method; the last is what `simulate` takes where nothing has clearance.
const ADAPTIVE: [Integrator; 4] = [
    Integrator::Dopri5 { tolerance: TOLERANCE, max_step: None },
    Integrator::Rodas5P { tolerance: TOLERANCE, max_step: None },
    Integrator::Rk43 { tolerance: TOLERANCE, max_step: None },
    Integrator::Switching { tolerance: TOLERANCE, max_step: None },
];

/// How far off a motion may be: `bound`, but of Rk43, whose estimate compares slopes at one time and sees a load over time only by the
/// place that it moves.
fn bound(integrator: Integrator, bound: f64, of_rk43: f64) -> f64 {
    if matches!(integrator, Integrator::Rk43 { .. }) { of_rk43 } else { bound }
}

fn settings(span: f64, integrator: Integrator) -> Settings {
    Settings { span: Span::Time(span), samples: 41, integrator, ..Settings::default() }
}

/// A block of 1 kg on a rail, pushed by a force; what stands before it and beside it.
fn block(force: &str, beside: &str) -> String {
    format!(
        r#"gravity = [0, 0, 0]
{beside}
[points]
O = [0, 0, 0]
[bodies]
a = {{ mass = "1 kg", centre = "O" }}
[joints]
X = {{ prismatic = ["ground", "a"], at = "O", axis = [1, 0, 0] }}
[forces]
push = {{ force = "a", at = "O", components = ["{force}", 0, 0] }}
"#
    )
}

#[test]
fn a_pulse_by_conditions_or_laws_leaves_its_momentum() {
    let by_if = |shape: &str| format!("if(t < 0.3 s, 0 N, if(t < 0.31 s, 1000 N*{shape}, 0 N))");
    let by_law = |law: &str| format!("1000 N*({law}((t - 0.3 s)/(5 ms)) - {law}((t - 0.31 s)/(5 ms)))");
    let phase = "pi*(t - 0.3 s)/(10 ms)";
    let pi = std::f64::consts::PI;
    // Momentum [N s]: mean of the shape times 10 N s; a law rises by one, and the same one takes it back 10 ms later. Middle of the
    // pulse [s].
    let pulses = [
        (by_if(&format!("sin({phase})")), 20.0 / pi, 0.305),
        (by_if(&format!("sin({phase})^2")), 5.0, 0.305),
        (by_if(&format!("sin({phase})^4")), 3.75, 0.305),
        (by_if(&format!("(1 - cos(8*{phase}))")), 10.0, 0.305),
        (by_law("cycloidal"), 10.0, 0.3075),
        (by_law("modified_sine"), 10.0, 0.3075),
        (by_law("poly345"), 10.0, 0.3075),
        (by_law("poly4567"), 10.0, 0.3075),
        (by_law("trapezoid"), 10.0, 0.3075),
    ];
    for (force, momentum, middle) in pulses {
        for integrator in ADAPTIVE {
            let run = run_with(&block(&force, ""), &settings(2.0, integrator));
            let exact = [momentum, momentum * (2.0 - middle)];
            for (column, exact) in ["X.v", "X.q"].into_iter().zip(exact) {
                let off = (at_end(&run, column) / exact - 1.0).abs();
                // Ten times the tolerance: the pulse takes some ten steps.
                assert!(
                    off < bound(integrator, 1e-8, 1e-6),
                    "{force} {integrator:?}: {column} off by {off:e}"
                );
            }
        }
    }
}

/// Rows of a table, in its file and as a function.
fn table(rows: &[(f64, f64)], [unit, of]: [&str; 2], how: &str, outside: &str) -> (String, DataTable) {
    let list = |of: &dyn Fn(&(f64, f64)) -> String| rows.iter().map(of).collect::<Vec<_>>().join(", ");
    let argument = list(&|(x, _)| format!("\"{x} {unit}\""));
    let value = list(&|(_, y)| format!("\"{y} {of}\""));
    let text = format!(
        "[tables.load]\nargument = [{argument}]\nvalue = [{value}]\ninterpolation = \"{how}\"\noutside = \"{outside}\"\n"
    );
    let (interpolation, outside) = (
        match how {
            "linear" => Interpolation::Linear,
            "monotone" => Interpolation::Monotone,
            _ => Interpolation::Spline,
        },
        match outside {
            "periodic" => Outside::Periodic,
            "hold" => Outside::Hold,
            _ => Outside::Refuse,
        },
    );
    let (knots, values): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    (text, DataTable::new("load", (knots, &values), interpolation, outside))
}

/// Integral over all rows: by Simpson's rule, which is exact for cubics.
fn integral(table: &DataTable) -> f64 {
    let piece = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        // Just before a row, where a periodic table does not begin again.
        let ends = table.of(from) + table.of(to - 1e-15 * to.abs());
        (to - from) / 6.0 * (ends + 4.0 * table.of(0.5 * (from + to)))
    };
    table.knots.windows(2).map(piece).sum()
}

/// A blow of 10 ms, with rows at rest about it.
const BLOW: [(f64, f64); 9] = [
    (0.0, 0.0),
    (0.3, 0.0),
    (0.45, 0.0),
    (0.49, 0.0),
    (0.5, 0.0),
    (0.505, 4000.0),
    (0.51, 0.0),
    (0.55, 0.0),
    (2.0, 0.0),
];

#[test]
fn a_blow_by_a_table_over_time_leaves_its_momentum() {
    for how in ["linear", "monotone", "spline"] {
        let (text, load) = table(&BLOW, ["s", "N"], how, "hold");
        let momentum = integral(&load);
        if how != "spline" {
            // The area of a triangle, and of two cubics with level ends.
            assert!((momentum - 20.0).abs() < 1e-12);
        }
        for integrator in ADAPTIVE {
            let run = run_with(&block("load(t)", &text), &settings(2.0, integrator));
            let off = (at_end(&run, "X.v") / momentum - 1.0).abs();
            // The tolerance: a polynomial between rows is met exactly but by a method of fourth order and less.
            assert!(off < 1e-9, "{how} {integrator:?}: off by {off:e}");
        }
    }
}

#[test]
fn a_periodic_table_over_time_strikes_in_every_period() {
    let (text, load) = table(&BLOW, ["s", "N"], "monotone", "periodic");
    for integrator in ADAPTIVE {
        let run = run_with(&block("load(t)", &text), &settings(20.0, integrator));
        let off = (at_end(&run, "X.v") / (10.0 * integral(&load)) - 1.0).abs();
        assert!(off < 1e-9, "{integrator:?}: off by {off:e}");
    }
}

#[test]
fn a_table_of_a_driven_angle_strikes_in_every_turn() {
    let rows = [(0.0, 0.0), (90.0, 0.0), (91.0, 3000.0), (92.0, 0.0), (360.0, 0.0)];
    let (text, load) = table(&rows, ["deg", "N"], "linear", "periodic");
    let crank = r#"[joints]
R = { revolute = ["ground", "c"], at = "O", axis = [0, 0, 1], drive = "(100 deg/s)*t" }
"#;
    let file = block("load(R.q)", &text).replace("[joints]\n", crank);
    let file = file.replace("[bodies]\n", "[bodies]\nc = { mass = \"1 kg\", centre = \"O\", inertia = [\"1 kg m^2\", \"1 kg m^2\", \"1 kg m^2\"] }\n");
    for integrator in ADAPTIVE {
        let run = run_with(&file, &settings(10.8, integrator));
        // Three turns of 100 deg/s.
        let off = (at_end(&run, "X.v") / (3.0 * integral(&load) / 100.0) - 1.0).abs();
        assert!(off < 1e-9, "{integrator:?}: off by {off:e}");
    }
}

#[test]
fn a_table_over_a_place_is_met_by_what_flies_past_it() {
    let rows = [(-1.0, 0.0), (0.5, 0.0), (0.501, 800.0), (0.502, 0.0), (9.0, 0.0)];
    let (text, load) = table(&rows, ["m", "N"], "monotone", "hold");
    let file = block("load(X.q)", &text) + "[initial]\nX = { q = \"0 m\", v = \"1 m/s\" }\n";
    for integrator in ADAPTIVE {
        let run = run_with(&file, &settings(2.0, integrator));
        // Half the square of the speed grows by the work.
        let exact = (1.0 + 2.0 * integral(&load)).sqrt();
        let off = (at_end(&run, "X.v") / exact - 1.0).abs();
        // Ten times the tolerance: each half of the bump takes a few steps.
        assert!(off < 1e-8, "{integrator:?}: off by {off:e}");
    }
}

/// Angle and speed at the end of the rows of a pendulum of 1 kg, 1 m and 0.1 kg m^2 about its middle, hung on what a table moves: by
/// small steps from row to row, from the cubics of the table.
fn hung_on(rise: &DataTable) -> [f64; 2] {
    let mut state = [0.0; 2];
    for ([_, _, c2, c3], ends) in rise.pieces.iter().zip(rise.knots.windows(2)) {
        let count = ((ends[1] - ends[0]) / 1e-4).ceil();
        let h = (ends[1] - ends[0]) / count;
        let rate = |u: f64, [angle, speed]: [f64; 2]| {
            let pulled = 2.0 * c2 + 6.0 * c3 * u;
            [speed, (pulled * angle.cos() - 9.81 * angle.sin()) / 1.1]
        };
        for step in 0..count as u32 {
            let u = h * f64::from(step);
            let moved =
                |state: [f64; 2], by: f64, rate: [f64; 2]| [state[0] + by * rate[0], state[1] + by * rate[1]];
            let first = rate(u, state);
            let second = rate(u + 0.5 * h, moved(state, 0.5 * h, first));
            let third = rate(u + 0.5 * h, moved(state, 0.5 * h, second));
            let fourth = rate(u + h, moved(state, h, third));
            for (by, slope) in [(1.0, first), (2.0, second), (2.0, third), (1.0, fourth)] {
                state = moved(state, by * h / 6.0, slope);
            }
        }
    }
    state
}

#[test]
fn a_drive_by_a_table_after_a_dwell_moves_what_hangs_on_it() {
    let rows = [
        (0.0, 0.0),
        (0.1, 0.0),
        (0.2, 0.0),
        (0.3, 0.0),
        (0.302, 0.0009),
        (0.306, 0.016),
        (0.31, 0.05),
        (0.314, 0.084),
        (0.319, 0.0991),
        (0.32, 0.1),
        (0.6, 0.1),
        (1.0, 0.1),
        (2.0, 0.1),
    ];
    for how in ["monotone", "spline"] {
        let (text, rise) = table(&rows, ["s", "m"], how, "refuse");
        let file = format!(
            r#"gravity = [0, 0, "-9.81 m/s^2"]
{text}
[points]
O = [0, 0, 0]
P = [0, 0, "-1 m"]
[bodies]
a = {{ mass = "1 kg", centre = "O" }}
b = {{ mass = "1 kg", centre = "P", inertia = ["0.1 kg m^2", "0.1 kg m^2", "0.1 kg m^2"] }}
[joints]
X = {{ prismatic = ["ground", "a"], at = "O", axis = [1, 0, 0], drive = "load(t)" }}
R = {{ revolute = ["a", "b"], at = "O", axis = [0, 1, 0] }}
"#
        );
        let exact = hung_on(&rise);
        assert!(exact[0].abs() > 1e-3, "{exact:?}");
        for integrator in ADAPTIVE {
            let run = run_with(&file, &settings(2.0, integrator));
            for (column, exact) in ["R.q", "R.v"].into_iter().zip(exact) {
                let off = (at_end(&run, column) - exact).abs();
                // A hundred times the tolerance, beside speeds of up to 9 rad/s in a blow of some hundred steps.
                assert!(
                    off < bound(integrator, 1e-7 * 9.0, 1e-3),
                    "{how} {integrator:?}: {column} off by {off:e}"
                );
            }
        }
    }
}

#[test]
fn rows_are_columns_where_their_argument_changes() {
    let (text, _) = table(&BLOW, ["s", "N"], "monotone", "periodic");
    let run = run_with(&block("load(t)", &text), &settings(4.0, ADAPTIVE[0]));
    let rows = run.column("t.row1").expect("one table");
    let passed = |t: f64| {
        let (periods, within) = ((t / 2.0).floor(), t % 2.0);
        let at = BLOW[1..].iter().filter(|(row, _)| *row <= within).count();
        8.0 * periods + at as f64 + (within - BLOW[at].0) / (BLOW[at + 1].0 - BLOW[at].0)
    };
    for (t, row) in run.times.iter().zip(rows) {
        // Roundings of a time of up to four over rows of 5 ms.
        assert!((row - passed(*t)).abs() < 1e-12, "{t}: {row}");
    }
    let constant = "[parameters]\np = { value = \"0.2 s\", tunable = true }\n".to_owned() + &text;
    let columns = |text: &str| compiled(text).description().channels.len();
    assert_eq!(columns(&block("load(p)", &constant)) + 1, columns(&block("load(t)", &text)));
}
