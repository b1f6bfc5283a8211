//! The rigid RSSR four-bar against closed-form kinematics and an independent Newton-Euler solution
//! (tests/reference/README.md): every angle, tip, joint force, moment and the drive torque.

mod support;
mod truth;

use linkwear_runtime::Span;
use support::{Table, compiled, largest_difference, relative_error, run};
use truth::reached;

/// Of the range of each kinematic column: the reference carries 12 to 13 digits.
const KINEMATIC: f64 = 1e-9;
/// Of the peak of each force column.
const FORCE: f64 = 1e-8;

fn compare(reference: &str, speed: &str) {
    let table = Table::reference(reference);
    let compiled = compiled("rssr_rigid", &[("speed", speed)], None);
    // Two seconds settle the coupler's spin, which starts at rest and has only friction to follow.
    let run = run(&compiled, Span::Turns(1.0), Span::Time(2.0), table.len(), 1e-12);
    let kinematic = [
        ("R4.q", "phi"),
        ("R4.v", "phi_dot"),
        ("R4.a", "phi_ddot"),
        ("A.x", "Ax"),
        ("A.y", "Ay"),
        ("B.x", "Bx"),
        ("B.y", "By"),
        ("B.z", "Bz"),
        ("coupler.wx", "om2x"),
        ("coupler.wy", "om2y"),
        ("coupler.wz", "om2z"),
    ];
    let case = format!("rigid RSSR at {speed}");
    let mut motion = 0.0_f64;
    for (ours, theirs) in kinematic {
        let (values, expected) = (run.column(ours), table.column(theirs));
        let (low, high) =
            expected.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        // By is constant: its size stands in for its range.
        let range = if high - low > 1e-9 { high - low } else { high.abs() };
        motion = motion.max(largest_difference(&values, &expected) / range);
    }
    reached(&case, "motion, of its range", motion, KINEMATIC);
    let signs = [
        ("R1.F", "R1_F", 1.0, "xyz"),
        ("S2.F", "S2_F", 1.0, "xyz"),
        // Ours is by the coupler on the rocker, theirs by the rocker on the coupler.
        ("S3.F", "S3_F", -1.0, "xyz"),
        ("R4.F", "R4_F", 1.0, "xyz"),
        ("R1.M", "R1_M", 1.0, "xy"),
        ("R4.M", "R4_M", 1.0, "xz"),
    ];
    let mut loads = 0.0_f64;
    for (ours, theirs, sign, axes) in signs {
        for axis in axes.chars() {
            let values: Vec<f64> = run.column(&format!("{ours}{axis}")).iter().map(|x| sign * x).collect();
            loads = loads.max(relative_error(&values, &table.column(&format!("{theirs}{axis}"))));
        }
    }
    reached(&case, "joint forces and moments, of their peak", loads, FORCE);
    let drive = relative_error(&run.column("R1.drive"), &table.column("T_drive"));
    reached(&case, "drive torque, of its peak", drive, FORCE);
    reached(&case, "loop error [m]", run.run.statistics.max_loop_error_m, 1e-10);
}

#[test]
fn rssr_at_2_hz_agrees_with_the_independent_solution() {
    compare("rssr/rigid_2hz.csv", "2 Hz");
}

#[test]
fn rssr_at_10_hz_agrees_with_the_independent_solution() {
    compare("rssr/rigid_10hz.csv", "10 Hz");
}
