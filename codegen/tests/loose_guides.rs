//! Clearance in guides and in bearings whose journal tilts, against closed forms: forces at both ends, wear by hand, energy, limits.

mod simulated;

use std::f64::consts::PI;

use linkwear_runtime::{Integrator, Run, Settings, Span};
use simulated::{at_end, run_with};

const FINE: Integrator = Integrator::Dopri5 { tolerance: 1e-10, max_step: None };

fn run(text: &str, end: f64) -> Run {
    run_with(text, &Settings::new(FINE, Span::Time(end), 11))
}

#[track_caller]
fn near(found: f64, expected: f64, part: f64) {
    assert!((found - expected).abs() <= part * expected.abs(), "{found}, not {expected}");
}

/// Weight of the carriage [N].
const WEIGHT: f64 = 2.0 * 9.81;
/// From end to end [m], and radius of the rod.
const LENGTH: f64 = 0.2;
const RADIUS: f64 = 0.01;
const FRICTION: f64 = 0.1;

const LAWS: &str = "radial = \"20 um\", journal_radius = \"10 mm\", length = \"0.2 m\", modulus = \"1 GPa\", restitution = 0.2";

/// A carriage on a guide along x that is pulled at 0.5 m/s, its centre of mass `arm` [m] before the middle of its two ends;
/// beside it a crank that counts turns. `joint`: the two bodies and the sign of the drive; `more`: keys of the clearance.
fn carriage(arm: f64, (bodies, sign): (&str, &str), more: &str) -> String {
    format!(
        "gravity = [0, \"-9.81 m/s^2\", 0]
[points]
O = [0, 0, 0]
C = {{ at = [\"{arm} m\", 0, 0], on = \"carriage\" }}
[bodies]
carriage = {{ mass = \"2 kg\", centre = \"C\", inertia = [\"0.01 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"] }}
crank = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"0.01 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"] }}
[joints]
R = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = [0, 0, 1], drive = \"2*pi*4 Hz*t\" }}
G = {{ prismatic = {bodies}, at = \"O\", axis = [1, 0, 0], drive = \"{sign}0.5 m/s*t\" }}
[clearance]
G = {{ {LAWS}, {more} }}
[wear.G]
coefficient = 1e-6
hardness = \"1 GPa\"
threshold = \"1 mm\"
area = \"projected\"
feedback = 0
"
    )
}

const PISTON: (&str, &str) = ("[\"ground\", \"carriage\"]", "");
const BUSH: (&str, &str) = ("[\"carriage\", \"ground\"]", "-");

/// Both normal forces, that against the axis first.
fn ends(run: &Run) -> [f64; 2] {
    ["G.end1.Fn", "G.end2.Fn"].map(|column| at_end(run, column))
}

/// What is left of the settling after an eighth of a second: the contact rings at a few hundred hertz with e = 0.2.
const SETTLED: f64 = 1e-5;

#[test]
fn an_eccentric_load_presses_both_ends_by_the_lever_law() {
    for (arm, joint, ends_of) in [
        (0.03, PISTON, "journal"),
        (0.03, BUSH, "bearing"),
        (-0.07, PISTON, "journal"),
        (0.0, BUSH, "bearing"),
    ] {
        let run = run(&carriage(arm, joint, &format!("ends = \"{ends_of}\"")), 0.5);
        let [first, second] = ends(&run);
        // The axis of a carriage that carries the bush points as the guide's does.
        near(first, WEIGHT * (0.5 - arm / LENGTH), SETTLED);
        near(second, WEIGHT * (0.5 + arm / LENGTH), SETTLED);
    }
}

#[test]
fn friction_at_the_surface_of_the_rod_tilts_the_carriage() {
    let friction = format!("friction = {FRICTION}");
    // A piston rests on the lower side of its bore, a bush on the upper side of its rod: friction mu W has the lever r, one way or the
    // other. A load beyond the end presses the other end to the opposite side, and the sum of both grows: a drawer.
    for (arm, joint, ends_of) in [
        (0.03, PISTON, "journal"),
        (0.03, BUSH, "bearing"),
        (0.25, PISTON, "journal"),
        (0.25, BUSH, "bearing"),
        (-0.25, PISTON, "journal"),
    ] {
        let run = run(&carriage(arm, joint, &format!("ends = \"{ends_of}\", {friction}")), 0.5);
        let [first, second] = ends(&run);
        let sign = if joint == PISTON { 1.0 } else { -1.0 };
        // Where the ends are on opposite sides they lie there by the clearance besides.
        let radius = RADIUS + if arm.abs() > 0.5 * LENGTH { 20e-6 } else { 0.0 };
        let lever = 2.0 * (arm + sign * FRICTION * radius) / LENGTH;
        let (sum, difference) = if lever.abs() < 1.0 {
            (WEIGHT, WEIGHT * lever)
        } else {
            (WEIGHT * lever.abs(), WEIGHT * lever.signum())
        };
        near(first, 0.5 * (sum - difference), SETTLED);
        near(second, 0.5 * (sum + difference), SETTLED);
        // The drive pulls against friction at both ends; it acts on the child, which is the guide where that is the rod.
        near(at_end(&run, "G.drive"), sign * FRICTION * sum, SETTLED);
        near(at_end(&run, "G.Fy"), sign * WEIGHT, SETTLED);
    }
}

/// Wear of every contact in the last turn of the crank: integral [J] and depth [m].
fn worn(text: &str) -> Vec<[f64; 2]> {
    let run = run_with(text, &Settings::new(FINE, Span::Turns(2.0), 11));
    run.turns[1].iter().map(|turn| [turn.wear_integral, turn.depth]).collect()
}

#[test]
fn each_end_wears_by_its_own_force_and_way() {
    let (arm, way) = (0.03, 0.5 * 0.25);
    for (joint, ends_of) in [(PISTON, "journal"), (BUSH, "bearing")] {
        let found = worn(&carriage(arm, joint, &format!("ends = \"{ends_of}\"")));
        for (found, side) in found.iter().zip([-1.0, 1.0]) {
            let force = WEIGHT * (0.5 + side * arm / LENGTH);
            // Archard by hand: k F s/(H A), over the projection of half of the length.
            let depth = 1e-6 / 1e9 * force * way / (2.0 * RADIUS * 0.5 * LENGTH);
            near(found[0], force * way, SETTLED);
            near(found[1], depth, SETTLED);
        }
        assert_eq!(found.len(), 2);
    }
}

#[test]
fn a_load_in_the_middle_wears_both_ends_as_one_contact_of_the_whole_length() {
    let [two, one] = [r#"ends = "journal""#, "tilt = false"].map(|how| worn(&carriage(0.0, PISTON, how)));
    assert_eq!((two.len(), one.len()), (2, 1));
    near(two[0][0] + two[1][0], one[0][0], SETTLED);
    near(two[0][1], one[0][1], SETTLED);
    near(two[1][1], one[0][1], SETTLED);
}

/// A rod that slides through a short bush: the lever grows with the way.
#[test]
fn a_rod_through_a_bush_carries_its_weight_over_the_nearer_end() {
    let run = run(&carriage(-0.05, PISTON, "ends = \"bearing\""), 0.15);
    let [first, second] = ends(&run);
    let arm = -0.05 + 0.5 * 0.15;
    // The contact follows the moving load with its own time of some milliseconds; damping is weak.
    near(first, WEIGHT * (0.5 - arm / LENGTH), 1e-3);
    near(second, WEIGHT * (0.5 + arm / LENGTH), 1e-3);
}

/// A shaft along x in a bearing of 40 mm, turned at 2 Hz, with a load of 50 N in its middle and a couple; `more`: keys of the clearance.
fn shaft(couple: f64, more: &str) -> String {
    format!(
        "gravity = [0, 0, 0]
[points]
O = [0, 0, 0]
[bodies]
shaft = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}
[joints]
R = {{ revolute = [\"ground\", \"shaft\"], at = \"O\", axis = [1, 0, 0], drive = \"2*pi*2 Hz*t\" }}
[forces]
load = {{ force = \"shaft\", at = \"O\", components = [0, \"-50 N\", 0] }}
couple = {{ torque = \"shaft\", components = [0, 0, \"{couple} N m\"] }}
[clearance]
R = {{ radial = \"20 um\", journal_radius = \"10 mm\", length = \"40 mm\", modulus = \"1 GPa\", restitution = 0.2, {more} }}
[wear.R]
coefficient = 1e-6
hardness = \"1 GPa\"
threshold = \"1 mm\"
area = \"projected\"
feedback = 0
"
    )
}

#[test]
fn a_couple_tilts_a_journal_and_wears_its_ends_differently() {
    // Both ends below; one end above.
    for couple in [0.4, -0.4, 1.6] {
        let run = run_with(&shaft(couple, "tilt = true"), &Settings::new(FINE, Span::Turns(2.0), 11));
        let parts = [25.0 + couple / 0.04, 25.0 - couple / 0.04];
        for (end, part) in [1, 2].into_iter().zip(parts) {
            near(at_end(&run, &format!("R.end{end}.Fn")), part.abs(), SETTLED);
            let turn = &run.turns[1][end - 1];
            let way = 2.0 * PI * RADIUS;
            near(turn.wear_integral, part.abs() * way, SETTLED);
            near(turn.depth, 1e-15 * part.abs() * way / (2.0 * RADIUS * 0.02), SETTLED);
        }
    }
}

/// Closed form of the balance: what dampers, friction and contacts lose is what the motion loses.
#[test]
fn energy_is_balanced_while_rods_bounce_turn_and_slide() {
    let laws = "radial = \"0.2 mm\", journal_radius = \"10 mm\", length = \"60 mm\", modulus = \"1 GPa\"";
    for (kind, start) in [
        ("prismatic", "v = \"0.3 m/s\""),
        ("cylindrical", "v1 = \"20 rad/s\", v2 = \"0.3 m/s\""),
        ("revolute", "v = \"20 rad/s\""),
    ] {
        let sides: &[&str] =
            if kind == "revolute" { &["tilt = true"] } else { &["ends = \"journal\"", "ends = \"bearing\""] };
        for more in sides {
            for bodies in ["[\"ground\", \"rod\"]", "[\"rod\", \"ground\"]"] {
                for (loss, friction) in
                    [("restitution = 1, law = \"exact\"", ""), ("restitution = 0.7, ", "friction = 0.2")]
                {
                    let text = format!(
                        "gravity = [\"1 m/s^2\", \"-9.81 m/s^2\", \"3 m/s^2\"]
[points]
O = [0, 0, 0]
C = {{ at = [\"20 mm\", \"5 mm\", \"-8 mm\"], on = \"rod\" }}
[bodies]
rod = {{ mass = \"0.5 kg\", centre = \"C\", inertia = [\"4e-4 kg m^2\", \"6e-4 kg m^2\", \"7e-4 kg m^2\"] }}
[joints]
G = {{ {kind} = {bodies}, at = \"O\", axis = [1, 1, 0] }}
[initial]
G = {{ {start} }}
[clearance]
G = {{ {laws}, {more}, {loss} {friction} }}
"
                    );
                    let run = run_with(&text, &Settings::new(FINE, Span::Time(0.03), 61));
                    let statistics = &run.statistics;
                    // The tolerance of the run over some hundred impacts.
                    assert!(
                        statistics.energy_error_J < 1e-7 * statistics.energy_throughput_J,
                        "{kind} {more} {bodies} {friction}: {:e} J of {:e} J",
                        statistics.energy_error_J,
                        statistics.energy_throughput_J
                    );
                    let tilted = ["G.end1", "G.end2"].map(|end| {
                        run.column(&format!("{end}.y"))
                            .expect("a column")
                            .iter()
                            .fold(0.0_f64, |a, y| a.max(y.abs()))
                    });
                    assert!(tilted.iter().all(|most| *most > 1e-5), "{tilted:?}: the ends move");
                }
            }
        }
    }
}

/// A pendulum on a bearing so long that it cannot tilt noticeably swings as one that does not tilt; with a narrow clearance as the
/// ideal one.
#[test]
fn long_bearings_and_narrow_clearances_are_ideal_ones() {
    let pendulum = |clearance: &str| {
        let text = format!(
            "gravity = [0, \"-9.81 m/s^2\", 0]
[points]
O = [0, 0, 0]
C = [\"0.1 m\", 0, \"0.02 m\"]
[bodies]
rod = {{ mass = \"1 kg\", centre = \"C\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}
[joints]
R = {{ revolute = [\"ground\", \"rod\"], at = \"O\", axis = [0, 0, 1], damping = \"0.01 N m s/rad\" }}
{clearance}"
        );
        let run = run_with(&text, &Settings::new(FINE, Span::Time(0.2), 11));
        (at_end(&run, "R.q"), at_end(&run, "R.Fx"))
    };
    let with = |radial: &str, length: &str| {
        pendulum(&format!(
            "[clearance]\nR = {{ radial = \"{radial}\", journal_radius = \"10 mm\", length = \"{length}\", modulus = \"100 GPa\", restitution = 0.3, tilt = true }}\n"
        ))
    };
    let ideal = pendulum("");
    // The centre lowers and shortens the pendulum by the clearance beside 100 mm; tilting adds as much again at a short bearing.
    for (radial, size) in [("10 um", 1e-5), ("1 um", 1e-6)] {
        let found = with(radial, "40 mm");
        assert!((found.0 - ideal.0).abs() < 30.0 * size / 0.1, "{found:?} {ideal:?}");
    }
    let (long, short) = (with("10 um", "10 m"), with("10 um", "40 mm"));
    assert!((long.0 - ideal.0).abs() < (short.0 - ideal.0).abs(), "{long:?} {short:?} {ideal:?}");
}

/// The centre of a cross hangs in its socket: the weight below a universal joint, with its friction.
#[test]
fn the_cross_of_a_universal_joint_hangs_in_its_clearance() {
    let text = |more: &str, bodies: &str| {
        format!(
            "gravity = [0, 0, \"-9.81 m/s^2\"]
[points]
O = [0, 0, 0]
C = {{ at = [0, 0, \"-0.2 m\"], on = \"bob\" }}
[bodies]
bob = {{ mass = \"2 kg\", centre = \"C\", inertia = [\"0.01 kg m^2\", \"0.01 kg m^2\", \"0.01 kg m^2\"] }}
[joints]
U = {{ universal = {bodies}, at = \"O\", axes = [[1, 0, 0], [0, 1, 0]] }}
{more}"
        )
    };
    let laws = "[clearance]\nU = { radial = \"20 um\", journal_radius = \"10 mm\", modulus = \"1 GPa\", restitution = 0.3, friction = 0.1 }\n";
    for bodies in ["[\"ground\", \"bob\"]", "[\"bob\", \"ground\"]"] {
        let still = run(&text(laws, bodies), 0.1);
        near(at_end(&still, "U.Fn"), 2.0 * 9.81, SETTLED);
        let swinging =
            text(&format!("[initial]\nU = {{ v1 = \"2 rad/s\", v2 = \"-1 rad/s\" }}\n{laws}"), bodies);
        let run = run_with(&swinging, &Settings::new(FINE, Span::Time(0.2), 11));
        let statistics = &run.statistics;
        assert!(
            statistics.energy_error_J < 1e-7 * statistics.energy_throughput_J,
            "{bodies}: {:e} J of {:e} J",
            statistics.energy_error_J,
            statistics.energy_throughput_J
        );
        assert!(at_end(&run, "U.vt") > 1e-3, "it slides in its socket");
    }
}
