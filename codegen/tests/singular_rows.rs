//! Rows exactly on a singular position: forces that pass it smoothly are those of the motion, and those without bounds are
//! named.

mod bars;

use std::f64::consts::{FRAC_PI_2, TAU};

use bars::{foldable, four_bar};
use linkwear_codegen::compile::Compiled;
use linkwear_runtime::{Integrator, Run, RunWarning, Settings, Span, Watch, simulate};

/// Rows in which links may come in line.
const QUARTERS: [usize; 2] = [100, 300];

/// One turn in rows of 1/400, so that rows fall on the quarters.
const ROWS: usize = 401;
const SPEED: f64 = 10.0;
const STEP: f64 = TAU / SPEED / 4000.0;

const METHODS: [Integrator; 3] = [
    Integrator::Dopri5 { tolerance: 1e-10, max_step: None },
    Integrator::Rk4 { step: STEP },
    Integrator::GeneralizedAlpha { step: STEP, rho: 0.8 },
];

fn turn(compiled: &Compiled, integrator: Integrator) -> Run {
    let settings = Settings::new(integrator, Span::Time(TAU / SPEED), ROWS);
    let system = compiled.interpreter();
    simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
        .expect("it starts")
}

/// Columns that the run calls without bounds.
fn unbounded(run: &Run) -> Vec<&str> {
    let columns = run.warnings.iter().filter_map(|warning| match warning {
        RunWarning::ForcesUnbounded { columns, .. } => Some(columns),
        _ => None,
    });
    columns.flatten().map(String::as_str).collect()
}

/// A column at a row and at those that many rows beside it.
fn beside(run: &Run, column: usize, row: usize, rows: usize) -> [f64; 2] {
    [row - rows, row + rows].map(|row| run.rows[row][column])
}

#[test]
fn rows_on_a_singular_position_are_right_or_named() {
    let mut named = 0;
    for (name, corners) in foldable(FRAC_PI_2) {
        let compiled = four_bar(corners, ", drive = \"10 rad/s*t\"", "", "").expect("it is taken");
        for method in METHODS {
            let run = turn(&compiled, method);
            assert_eq!(run.stopped, None, "{name} {method:?}");
            let unbounded = unbounded(&run);
            let drive = run.index("R1.drive").expect("it is driven");
            assert!(!unbounded.contains(&"R1.drive"), "what a drive does is energy: {name} {method:?}");
            let columns = run.channels.iter().enumerate();
            let forces = columns.filter(|(_, channel)| matches!(&*channel.unit, "N" | "N m"));
            for ((column, channel), row) in forces.flat_map(|force| QUARTERS.map(|row| (force, row))) {
                let case = format!("{name} {method:?}: {} at row {row}", channel.name);
                let found = run.rows[row][column];
                let ([a, b], [c, d]) = (beside(&run, column, row, 1), beside(&run, column, row, 2));
                // The polynomial through four neighbours, off by the fourth power of 1/400 turn: 1e-7 of what forces may do.
                let expected = (4.0 * (a + b) - (c + d)) / 6.0;
                // A pole halves from one row to the next, and a slope doubles; poles are hundreds of newtons here.
                let pole = (b - a).abs() > 1.9 * (d - c).abs() + 1.0;
                named += usize::from(pole);
                assert!(!pole || unbounded.contains(&&*channel.name), "{case} is not named");
                // Without its pole a force is what neighbours have in common, to the last places of the pole.
                let allowed = 1e-5 * 50.0 + if pole { 1e-6 * b.abs() } else { 0.0 };
                assert!((found - expected).abs() < allowed, "{case}: {found}, not {expected}");
            }
            if name == "parallelogram" {
                // The weight of crank, coupler and rocker on a crank of 0.1 m.
                let torque = 9.81 * (0.5 * 1.0 + 2.0 + 0.5 * 1.5) * 0.1;
                // Row 100 is at half a turn from where the crank lies, row 300 at a whole one.
                for (row, sign) in QUARTERS.into_iter().zip([-1.0, 1.0]) {
                    let found = run.rows[row][drive];
                    assert!((found - sign * torque).abs() < 1e-6 * torque, "{method:?}: {found} N m");
                }
            }
        }
    }
    // Five columns in the forces of each: twice in parallelogram and rhombus, once in the others, by each method.
    assert_eq!(named, 3 * 5 * 6);
}

#[test]
fn at_rest_in_a_singular_position_forces_are_said_to_be_open() {
    // The links of the last lie in line at half a turn only.
    for (name, corners) in &foldable(1.0)[..3] {
        // The crank swings back where the links lie in line, and the run ends there.
        let compiled =
            four_bar(*corners, ", drive = \"-1 rad*sin(10 rad/s*t)\"", "", "").expect("it is taken");
        let settings = Settings::new(METHODS[0], Span::Time(FRAC_PI_2 / SPEED), 11);
        let system = compiled.interpreter();
        let run = simulate(&system, compiled.description(), &compiled.parameters(), &settings, Watch::NONE)
            .expect("it starts");
        assert_eq!(run.stopped, None, "{name}");
        let [RunWarning::ForcesUnknown { t, columns }] = &run.warnings[..] else {
            panic!("{name}: {:?}", run.warnings)
        };
        // Steps come as near as their tolerance lets them: 1e-5 rad from where the crank turns round, at a thousandth of a turn.
        assert!((t - FRAC_PI_2 / SPEED).abs() < 5e-3, "{name}: {t}");
        assert!(columns.iter().any(|column| column == "R1.Fx"), "{name}: {columns:?}");
        assert!(unbounded(&run).is_empty(), "{name}");
        let told = run.warnings[0].to_string();
        assert!(told.contains("at rest or at a dead point"), "{name}: {told}");
    }
}
