//! Runs of joints with clearance: impacts, balance of energy, wear integrals and their order, located onsets,
//! turns, default start.

mod common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::Dense;
use common::bars::{At, Bar, Bars};
use common::journal::{Journal, coulomb, smooth, wear};
use linkwear_runtime::contact::{Restitution, Stiffness};
use linkwear_runtime::wear::{Area, Profile, Step};
use linkwear_runtime::{
    AssemblyError, ContactInfo, Integrator, Run, RunError, RunWarning, SINGULAR_PIVOT, Settings, SetupError,
    Simulation, Span, TurnRunner, Watch, simulate,
};

const CLEARANCE: f64 = 1e-5;

fn run(system: &Journal, gravity: f64, integrator: Integrator, span: Span, samples: usize) -> Run {
    let settings = Settings::new(integrator, span, samples);
    let result = simulate(system, &system.description, &[gravity, CLEARANCE], &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

fn dopri5(tolerance: f64) -> Integrator {
    Integrator::Dopri5 { tolerance, max_step: None }
}

fn rk4(step: f64) -> Integrator {
    Integrator::Rk4 { step }
}

/// Column of a quantity of the contact: x is generated, y and the rest follow.
fn column(run: &Run, name: &str) -> Vec<f64> {
    let names: Vec<&str> = run.channels.iter().map(|channel| channel.name.as_ref()).collect();
    assert_eq!(names, ["R.x", "R.y", "R.gap", "R.Fn", "R.vt", "R.contact_angle"]);
    run.column(name).expect("a column")
}

/// A journal of 1 kg that flies across its bearing at 0.1 m/s, no gravity.
fn flyer(contact: ContactInfo) -> Journal {
    Journal::new(contact).held([0.0, 0.0], [0.1, 0.0])
}

#[test]
fn bounces_return_their_restitution() {
    for (law, e) in
        [(Restitution::Exact, 0.9), (Restitution::Exact, 0.4), (Restitution::LankaraniNikravesh, 0.9)]
    {
        let contact = ContactInfo { law, restitution: e, ..smooth() };
        let system = flyer(contact);
        // Across 10 µm takes 0.1 ms, the impact about as long: 0.35 ms see one bounce.
        let after = run(&system, 0.0, dopri5(1e-10), Span::Time(3.5e-4), 36);
        let x = column(&after, "R.x");
        // Flying back freely: the last two samples, 1e-5 s apart.
        let speed = (x[34] - x[35]) / 1e-5 / 0.1;
        // Exact returns e; Lankarani-Nikravesh 0.9132 for 0.9 (known to 4 digits).
        let (expected, accuracy) = if law == Restitution::Exact { (e, 1e-6) } else { (0.9132, 5e-5) };
        assert!((speed - expected).abs() < accuracy, "{law:?} {e}: {speed}");
    }
}

#[test]
fn energy_is_balanced_with_and_without_losses() {
    let friction = coulomb(0.2);
    let lossless = smooth();
    let rough = ContactInfo { restitution: 0.7, friction, ..smooth() };
    let printed = ContactInfo { law: Restitution::LankaraniNikravesh, restitution: 1.0, ..smooth() };
    for (contact, gives_losses) in [(lossless, false), (rough, true), (printed, false)] {
        let mut system = Journal::new(contact).held([3e-6, -2e-6], [0.1, 0.07]);
        system.turning = 5.0;
        // Steps of 0.1 µs: a hundredth of a radian of a contact of 10 kHz; kinks at each onset.
        for method in [dopri5(1e-11), rk4(1e-7)] {
            let result = run(&system, 9.81, method, Span::Time(0.01), 101);
            let statistics = result.statistics;
            assert!(
                statistics.energy_error_J < 1e-8 * statistics.energy_throughput_J,
                "{method:?} {statistics:?}"
            );
            let forces = column(&result, "R.Fn");
            assert!(forces.iter().any(|force| *force > 1.0), "it bounced");
            let energy = 0.5 * (0.01 + 0.0049) + 0.5 * 1e-3 * 25.0;
            let expected_losses = if gives_losses { 1e-3 * energy } else { 0.0 };
            assert!(statistics.energy_throughput_J > expected_losses);
        }
    }
}

#[test]
fn a_dropped_journal_comes_to_rest_at_its_resting_penetration() {
    let contact = ContactInfo { restitution: 0.3, ..smooth() };
    let mut system = Journal::new(contact).held([0.0, 0.0], [0.0, 0.0]);
    system.damping = 200.0;
    let result = run(&system, 9.81, dopri5(1e-9), Span::Time(0.3), 31);
    let gap = column(&result, "R.gap");
    // K = 4/3 E* sqrt(R_eff), R_eff = (r + c) r / c.
    let stiffness = 4.0 / 3.0 * 115e9 * ((0.01 + CLEARANCE) * 0.01 / CLEARANCE).sqrt();
    let expected = (9.81 / stiffness).powf(2.0 / 3.0);
    // Step control holds offsets to 1e-9 of the clearance.
    assert!((-gap[30] - expected).abs() < 1e-6 * expected, "{} {expected}", -gap[30]);
    let angle = column(&result, "R.contact_angle");
    assert!((angle[30] + 0.5 * PI).abs() < 1e-6);
}

#[test]
fn a_start_without_offsets_rests_where_the_load_presses() {
    let mut system = Journal::new(smooth()).driven(4.0 * PI);
    system.load = |_| [30.0, 40.0 + 9.81];
    let result = run(&system, 9.81, dopri5(1e-10), Span::Time(1e-3), 11);
    for force in column(&result, "R.Fn") {
        // It rests: rounding of the penetration, 1e-21 m of 2e-7, and the tolerance.
        assert!((force - 50.0).abs() < 1e-6, "{force}");
    }
    for angle in column(&result, "R.contact_angle") {
        assert!((angle - (40.0_f64 / 30.0).atan()).abs() < 1e-9, "{angle}");
    }
}

/// A driven journal under a load that turns with 3/10 of its speed.
fn loaded(contact: ContactInfo, load: common::journal::Load) -> Journal {
    let mut system = Journal::new(contact).driven(SPEED);
    system.load = load;
    // Against the free oscillation of the start.
    system.damping = 200.0;
    system
}

const SPEED: f64 = 200.0;
const TURN: f64 = 2.0 * PI / SPEED;

fn swelling(t: f64) -> [f64; 2] {
    let size = 40.0 + 10.0 * (3000.0 * t).sin();
    [size * (60.0 * t).cos(), size * (60.0 * t).sin()]
}

/// Swells and ebbs along one direction.
fn breathing(t: f64) -> [f64; 2] {
    let size = 1.0 + 0.3 * (SPEED * t).sin();
    [30.0 * size, 40.0 * size]
}

/// Once around per turn of the driver.
fn circling(t: f64) -> [f64; 2] {
    [40.0 * (SPEED * t).cos(), 40.0 * (SPEED * t).sin()]
}

/// Presses to +x and to -x in every turn.
fn swinging(t: f64) -> [f64; 2] {
    [40.0 * (SPEED * t).cos(), 0.0]
}

fn steady(_: f64) -> [f64; 2] {
    [30.0, 40.0]
}

#[test]
fn wear_integral_has_order_four_under_runge_kutta() {
    let integral = |system: &Journal, method| {
        let result = run(system, 0.0, method, Span::Turns(1.0), 0);
        assert_eq!((result.turns.len(), result.turns[0][0].losses), (1, 0.0));
        result.turns[0][0].wear_integral
    };
    let system = loaded(smooth(), swelling);
    let [coarse, middle, fine] = [3200.0, 6400.0, 12_800.0].map(|steps| integral(&system, rk4(TURN / steps)));
    let ratio = (coarse - middle) / (middle - fine);
    // 16 in the limit; order 3 would give 8, order 5 32.
    assert!((14.0..19.0).contains(&ratio), "{ratio}: {coarse} {middle} {fine}");
    // The finer half of an error that falls by 16: 2e-9/15; adaptive steps by their tolerance.
    assert!((integral(&system, dopri5(1e-10)) - fine).abs() < 3e-10 * fine);
    // Order 2: four times less per halving.
    let implicit = |steps: f64| Integrator::GeneralizedAlpha { step: TURN / steps, rho: 1.0 };
    let [coarse, middle] = [6400.0, 12_800.0].map(|steps| integral(&system, implicit(steps)) - fine);
    assert!((3.5..4.5).contains(&(coarse / middle)), "{coarse} {middle}");
}

#[test]
fn a_steady_load_wears_by_force_times_way() {
    for ball in [false, true] {
        let system = loaded(ContactInfo { ball, wear: wear(Area::Hertz, false), ..smooth() }, steady);
        let implicit = Integrator::GeneralizedAlpha { step: TURN / 2000.0, rho: 1.0 };
        for method in [rk4(TURN / 1000.0), dopri5(1e-9), implicit] {
            let result = run(&system, 0.0, method, Span::Turns(2.0), 0);
            assert_eq!((result.turns.len(), &result.warnings[..]), (2, &[][..]));
            for turn in result.turns.iter().flatten() {
                assert_eq!(turn.losses, 0.0);
                // 50 N over a way of 2 pi r. The journal rests but for the rounding of its place: 1e-21 m
                // of 2e-7, which rings undamped by the contact.
                let expected = 50.0 * 2.0 * PI * 0.01;
                assert!((turn.wear_integral - expected).abs() < 1e-9 * expected, "{turn:?}");
                // Adaptive steps let it ring: offsets to 1e-10 of the clearance are 1e-15 m of 2e-7, over and over.
                // The force is that of a power 3/2: its mean sees the square of that.
                assert!((turn.peak_force - 50.0).abs() < 5e-5, "{turn:?}");
                assert!((turn.mean_force - 50.0).abs() < 5e-8, "{turn:?}");
                assert!((turn.touching - 1.0).abs() < 1e-12, "{turn:?}");
                // k/(H 2 b L) S with b = sqrt(4 F R_eff/(pi E* L)).
                let radius: f64 = (0.01 + CLEARANCE) * 0.01 / CLEARANCE;
                let half_width = (4.0 * 50.0 * radius / (PI * 115e9 * 0.02)).sqrt();
                let depth = 1e-8 / 3.5e9 * expected / (2.0 * half_width * 0.02);
                assert!((turn.depth - depth).abs() < 1e-8 * depth, "{turn:?} {depth}");
            }
        }
    }
}

#[test]
fn located_onsets_agree_with_fine_fixed_steps() {
    let contact = ContactInfo { restitution: 0.7, friction: coulomb(0.1), ..smooth() };
    let system = Journal::new(contact).held([3e-6, -2e-6], [0.1, 0.07]);
    let end = |method| {
        let result = run(&system, 9.81, method, Span::Time(1e-3), 2);
        (column(&result, "R.x")[1], column(&result, "R.y")[1], result.statistics.steps)
    };
    let (x, y, steps) = end(dopri5(1e-11));
    let (fine_x, fine_y, fine_steps) = end(rk4(2e-9));
    // Fixed steps take the closing speed from a straight line over the step: some 1e-9 of it per impact,
    // and impacts on a curve multiply what came before.
    let off = (x - fine_x).hypot(y - fine_y) / CLEARANCE;
    assert!(off < 1e-6, "{off:e}");
    assert!(10 * steps < fine_steps, "{steps}");
}

#[test]
fn turns_are_counted_after_settling_with_their_contact_losses() {
    let contact = ContactInfo { restitution: 0.3, ..smooth() };
    let system = loaded(contact, swinging);
    let mut settings = Settings::new(dopri5(1e-8), Span::Turns(2.5), 51);
    settings.settle = Span::Turns(1.3);
    let result =
        simulate(&system, &system.description, &[0.0, CLEARANCE], &settings, Watch::NONE).expect("it starts");
    assert_eq!(result.stopped, None);
    assert_eq!(result.turns.len(), 2, "half a turn is no turn");
    for turn in result.turns.iter().flatten() {
        // It crosses the bearing twice, and bounces where it arrives.
        assert!(turn.losses >= 2.0, "{turn:?}");
        assert!(turn.touching > 0.5 && turn.touching < 1.0, "{turn:?}");
        assert!(turn.peak_force > 40.0 && turn.mean_force < 40.0);
    }
}

#[test]
fn long_steps_and_lost_contact_draw_warnings() {
    let system = loaded(smooth(), steady);
    let coarse = run(&system, 0.0, rk4(TURN / 300.0), Span::Turns(1.0), 0);
    let [RunWarning::StepTooCoarse { joint, step, frequency, accurate, stable }] = &coarse.warnings[..]
    else {
        panic!("{:?}", coarse.warnings)
    };
    // sqrt(3/2 F/(p m)): the journal alone moves.
    let stiffness = 4.0 / 3.0 * 115e9 * ((0.01 + CLEARANCE) * 0.01 / CLEARANCE).sqrt();
    let expected = (1.5 * 50.0 / (50.0 / stiffness).powf(2.0 / 3.0)).sqrt();
    assert!((frequency - expected).abs() < 1e-6 * expected, "{frequency} {expected}");
    assert_eq!(joint, "R");
    assert!(step * frequency > *accurate && step * frequency < *stable);
    assert!(coarse.warnings[0].to_string().contains("inaccurate"), "{}", coarse.warnings[0]);

    // Nothing presses: after a push the journal is mostly in flight.
    let mut system = Journal::new(smooth()).driven(SPEED).held([0.0, 0.0], [0.01, 0.0]);
    system.damping = 0.0;
    let lost = run(&system, 0.0, dopri5(1e-9), Span::Turns(1.0), 0);
    let [RunWarning::ContactLost { turn: 1, touching_part, .. }] = &lost.warnings[..] else {
        panic!("{:?}", lost.warnings)
    };
    assert!(*touching_part < 0.5);
}

#[test]
fn wear_by_angle_adds_up_and_goes_where_the_contact_is() {
    let system = loaded(ContactInfo { wear: wear(Area::Hertz, true), ..smooth() }, circling);
    let mut runner = runner(&system);
    runner.turns(2, Watch::NONE).expect("it turns");
    let turn = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    let deposit = turn.deposit.expect("it keeps a profile");
    let amount: f64 = deposit.depths().iter().sum::<f64>() * deposit.bin_angle();
    let expected = 1e-8 / 3.5e9 * turn.wear_integral / ((0.01 + CLEARANCE) * 0.02);
    // Shares of every step add up to it; a thousand steps round.
    assert!((amount - expected).abs() < 1e-12 * expected);
    for depth in deposit.depths() {
        // The same everywhere: one step, a 3600th of a turn, may fall to either side of a bin of a 72nd: 2 %;
        // in it the arc of contact, which is wider, evens out.
        assert!((depth / deposit.mean() - 1.0).abs() < 0.02, "{depth} {}", deposit.mean());
    }
    let system = loaded(ContactInfo { wear: wear(Area::Hertz, true), ..smooth() }, steady);
    let turn = self::runner(&system).measure(Watch::NONE).expect("it turns").joints.remove(0);
    let deposit = turn.deposit.expect("it keeps a profile");
    let angle = (40.0_f64 / 30.0).atan();
    for (bin, depth) in deposit.depths().iter().enumerate() {
        // Hertz arc of some 0.17 mm on 10 mm: less than a bin to either side.
        let near = (deposit.middle(bin) - angle).abs() < 1.5 * deposit.bin_angle();
        assert!((*depth > 0.0) <= near, "{bin} {depth}");
    }
}

#[test]
fn a_bush_wears_in_one_place_and_its_journal_evenly_round() {
    // Archard by hand: 50 N at a standing angle over a way of 2 pi r a turn; the journal is four times as hard.
    let (way, ratio) = (2.0 * PI * 0.01, 0.25);
    let volume = 1e-8 / 3.5e9 * 50.0 * way;
    let contact = || ContactInfo { wear: wear(Area::Hertz, true), ..smooth() };
    let integral = |depths: &Profile| depths.depths().iter().sum::<f64>() * depths.bin_angle();
    let system = loaded(contact(), steady).wearing(ratio);
    let turn = runner(&system).measure(Watch::NONE).expect("it turns").joints.remove(0);
    let (bush, journal) =
        (turn.deposit.as_ref().expect("a profile"), turn.journal.as_ref().expect("a profile"));
    // Volumes k F s/H of both, k/H of the journal a quarter; the load rings by 1e-8 of itself, as above.
    let (worn, of_journal) = (integral(bush) * (0.01 + CLEARANCE) * 0.02, integral(journal) * 0.01 * 0.02);
    assert!((worn / volume - 1.0).abs() < 1e-8, "{worn:e} {volume:e}");
    assert!((of_journal / (ratio * volume) - 1.0).abs() < 1e-8, "{of_journal:e}");
    // The bush in one place, less than a bin to either side (see below); the journal evenly: a step may fall to either side of
    // a bin of fifty steps.
    assert!(bush.depths().iter().filter(|depth| **depth > 0.0).count() <= 3);
    for depth in journal.depths() {
        assert!((depth / journal.mean() - 1.0).abs() < 0.02, "{depth:e} {:e}", journal.mean());
    }
    // A load that turns with the journal: the other way round.
    let system = loaded(contact(), circling).wearing(ratio);
    let mut runner = runner(&system);
    runner.turns(2, Watch::NONE).expect("it turns");
    let turn = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    let (bush, journal) = (turn.deposit.expect("a profile"), turn.journal.expect("a profile"));
    let expected = 1e-8 / 3.5e9 * turn.wear_integral;
    // A thousand steps round.
    assert!((integral(&journal) * 0.01 * 0.02 / (ratio * expected) - 1.0).abs() < 1e-12);
    assert!(journal.maximum() > 10.0 * journal.mean(), "{journal:?}");
    assert!(bush.maximum() < 1.02 * bush.mean(), "{bush:?}");
}

/// (1 + (pressure/1e5)^2) sqrt(sliding speed) (1 + the parameter), as steps.
fn by_pressure_and_speed() -> Vec<Step> {
    vec![
        Step::Given(0),
        Step::Number(1e5),
        Step::Div(0, 1),
        Step::Mul(2, 2),
        Step::Number(1.0),
        Step::Add(4, 3),
        Step::Given(1),
        Step::Sqrt(6),
        Step::Mul(5, 7),
        Step::Given(2),
        Step::Add(4, 9),
        Step::Mul(8, 10),
    ]
}

#[test]
fn a_coefficient_by_pressure_speed_and_a_parameter_wears_as_quadrature_says() {
    let contact = || ContactInfo { wear: wear(Area::Projected, true), ..smooth() };
    let by_hand = |force: f64, parameter: f64| {
        let (pressure, speed) = (force / (2.0 * 0.01 * 0.02), SPEED * 0.01);
        let factor = (1.0 + (pressure / 1e5).powi(2)) * speed.sqrt() * (1.0 + parameter);
        factor * 1e-8 / 3.5e9 * pressure * speed
    };
    let turn = |load, parameter: f64| {
        let mut system = loaded(contact(), load).wearing_by(by_pressure_and_speed()).wearing(0.5);
        // The parameter is gravity too: it shall not press.
        system.mass = 1.0;
        let method = rk4(TURN / 3600.0);
        let parameters = [parameter, CLEARANCE];
        let mut runner = TurnRunner::new(&system, &system.description, &parameters, method, SINGULAR_PIVOT)
            .expect("it starts");
        runner.turns(2, Watch::NONE).expect("it turns");
        runner.measure(Watch::NONE).expect("it turns").joints.remove(0)
    };
    let integral = |depths: &Profile| depths.depths().iter().sum::<f64>() * depths.bin_angle();
    for parameter in [0.0, 0.5] {
        // 30 N and 40 N less the weight, which the parameter gives.
        let force = 30.0_f64.hypot(40.0 - parameter);
        let turn = turn(steady, parameter);
        let depth = TURN * by_hand(force, parameter);
        // It rings by 1e-8 of itself, as above.
        assert!((turn.depth / depth - 1.0).abs() < 1e-7, "{:e} {depth:e}", turn.depth);
        // Volume over 2 r L is the depth of the projected area: bush and journal have that of the depth.
        let volume = turn.depth * 2.0 * 0.01 * 0.02;
        let (bush, journal) = (turn.deposit.expect("a profile"), turn.journal.expect("a profile"));
        assert!((integral(&bush) * (0.01 + CLEARANCE) * 0.02 / volume - 1.0).abs() < 1e-7);
        assert!((integral(&journal) * 0.01 * 0.02 / (0.5 * volume) - 1.0).abs() < 1e-7);
    }
    // A force that swells and ebbs along one direction, by Simpson's rule.
    let turn = turn(breathing, 0.0);
    let force = |t: f64| breathing(t)[0].hypot(breathing(t)[1]);
    let parts = 2000;
    let simpson: f64 = (0..=parts)
        .map(|at| {
            let weight = if at == 0 || at == parts { 1.0 } else { f64::from(2 + 2 * (at % 2)) };
            weight * by_hand(force(TURN * f64::from(at) / f64::from(parts)), 0.0)
        })
        .sum();
    let depth = simpson * TURN / f64::from(3 * parts);
    // The journal's own acceleration is (200/3e4)^2 = 4e-5 of what moves it, and cubes of the force count.
    assert!((turn.depth / depth - 1.0).abs() < 3e-4, "{:e} {depth:e}", turn.depth);
    // What is spread is taken between the ends of steps: second order, 3600 a turn.
    let spread = integral(&turn.deposit.expect("a profile")) * (0.01 + CLEARANCE) * 0.02;
    assert!((spread / (turn.depth * 2.0 * 0.01 * 0.02) - 1.0).abs() < 1e-5, "{spread:e}");
}

#[test]
fn a_coefficient_below_zero_stops_the_run() {
    let contact = ContactInfo { wear: wear(Area::Projected, false), ..smooth() };
    let steps = vec![Step::Number(-1.0)];
    let system = loaded(contact, steady).wearing_by(steps);
    let error = runner(&system).measure(Watch::NONE).expect_err("no wear backwards");
    assert!(matches!(&error, RunError::NonFinite { .. }), "{error}");
}

#[test]
fn a_journal_worn_by_angle_keeps_its_energy() {
    let contact = ContactInfo { wear: wear(Area::Hertz, true), ..smooth() };
    let mut system = Journal::new(contact).held([3e-6, -2e-6], [0.1, 0.07]).wearing(1.0);
    system.turning = 50.0;
    let settings = Settings::new(dopri5(1e-11), Span::Time(0.01), 2);
    let mut start =
        Simulation::start(&system, &system.description, &[9.81, CLEARANCE], &settings).expect("it starts");
    let waves = |high: f64, count: f64| {
        let depth = |bin: usize| high * (1.0 + (count * 2.0 * PI * (bin as f64 + 0.5) / 72.0).cos());
        Profile::try_from((0..72).map(depth).collect::<Vec<_>>()).expect("a profile")
    };
    start.set_worn_pair(0, 0.0, [Some(waves(1e-6, 3.0)), Some(waves(1e-6, 2.0))]).expect("it fits");
    let energy = |simulation: &mut Simulation<'_>| {
        let touch = simulation.contacts()[0];
        let (y, v) = (simulation.coordinates()[1], simulation.speeds());
        0.5 * (v[0] * v[0] + v[1] * v[1] + 1e-3 * v[2] * v[2]) + 9.81 * y + touch.elastic_energy
    };
    let before = energy(&mut start);
    let turning = start.speeds()[2];
    start.advance(0.01, Watch::NONE).expect("it runs");
    let after = energy(&mut start);
    // As in a round bearing: 1e-11 of a step, over some hundred bounces of it.
    assert!((after - before).abs() < 1e-8 * before, "{before:e} {after:e}");
    // The waves turn it: friction there is none.
    let turned = start.speeds()[2] - turning;
    assert!(turned.abs() > 1e-6, "{turned:e}");
}

fn runner(system: &Journal) -> TurnRunner<'_> {
    let method = rk4(TURN / 3600.0);
    TurnRunner::new(system, &system.description, &[0.0, CLEARANCE], method, SINGULAR_PIVOT)
        .expect("it starts")
}

#[test]
fn turn_by_turn_is_the_same_run_and_goes_on_from_a_kept_state() {
    let contact = ContactInfo { restitution: 0.5, friction: coulomb(0.05), ..smooth() };
    let system = loaded(contact, swelling);
    let whole = run(&system, 0.0, rk4(TURN / 3600.0), Span::Turns(3.0), 0);
    let mut runner = runner(&system);
    runner.turns(1, Watch::NONE).expect("it turns");
    let kept = runner.state();
    let second = runner.measure(Watch::NONE).expect("it turns");
    let expected = &whole.turns[1][0];
    // Ends of turns are found from different begins: some last places of the time.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * b.abs();
    assert!(close(second.joints[0].wear_integral, expected.wear_integral), "{second:?} {expected:?}");
    assert!(close(second.joints[0].mean_force, expected.mean_force));
    assert!(second.statistics.energy_error_J < 1e-8 * second.statistics.energy_throughput_J);
    assert_eq!(second.statistics.evaluations, 3600 * 4 + 1);
    let after = runner.state();
    runner.restore(&kept).expect("it is its own");
    let again = runner.measure(Watch::NONE).expect("it turns");
    assert_eq!((again, runner.state()), (second, after), "to the last bit");
}

#[test]
fn a_stopped_turn_leaves_the_runner_where_it_was() {
    let system = loaded(ContactInfo { restitution: 0.5, ..smooth() }, swinging);
    let mut runner = runner(&system);
    let before = runner.state();
    let hear = |part: f64| if part > 0.3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let error = runner.measure(Watch::new(&hear)).expect_err("it was stopped");
    assert!(matches!(error, RunError::Interrupted { .. }));
    assert_eq!(runner.state(), before);
}

#[test]
fn wear_is_set_between_turns_and_the_journal_follows() {
    let system = loaded(ContactInfo { wear: wear(Area::Projected, true), ..smooth() }, steady);
    let mut runner = runner(&system);
    runner.set_worn(0, 5e-6, None).expect("it fits");
    assert_eq!(runner.clearances(), [CLEARANCE + 5e-6]);
    let scalar = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    // It follows the surface, only a softer contact goes a little deeper: no crossing, no separation.
    assert_eq!(scalar.losses, 0.0);
    let even = Profile::try_from(vec![5e-6; 72]).expect("a profile");
    runner.set_worn(0, 0.0, Some(even)).expect("it fits");
    let profile = runner.measure(Watch::NONE).expect("it turns").joints.remove(0);
    // An even profile is the same clearance; forces ring a little from the change before.
    assert!((profile.wear_integral - scalar.wear_integral).abs() < 1e-3 * scalar.wear_integral);
    let error = runner.set_worn(0, -2e-5, None).expect_err("less than nothing");
    assert!(matches!(&error, SetupError::Clearance { joint, .. } if joint == "R"), "{error}");
    // The mean of 72 equal depths rounds 72 times.
    assert!((runner.clearances()[0] - CLEARANCE - 5e-6).abs() < 1e-19, "nothing has changed");
}

#[test]
fn an_uneven_profile_keeps_the_balance_of_energy() {
    let depths = (0..72).map(|i| 1e-6 * (1.0 + (f64::from(i) * PI / 18.0).sin())).collect::<Vec<_>>();
    let contact = ContactInfo { wear: wear(Area::Hertz, true), friction: coulomb(0.1), ..smooth() };
    let system = loaded(contact, swelling);
    let mut runner = runner(&system);
    runner.set_worn(0, 0.0, Some(Profile::try_from(depths).expect("a profile"))).expect("it fits");
    let statistics = runner.measure(Watch::NONE).expect("it turns").statistics;
    // The slope of the profile has kinks at the middles of bins: errors of order h³ there.
    assert!(statistics.energy_error_J < 1e-7 * statistics.energy_throughput_J, "{statistics:?}");
}

#[test]
fn constants_and_clearances_out_of_range_are_told_apart() {
    let refused = |contact: ContactInfo, clearance: f64| {
        let system = Journal::new(contact);
        let settings = Settings::default();
        simulate(&system, &system.description, &[9.81, clearance], &settings, Watch::NONE)
            .expect_err("it cannot start")
    };
    let error = refused(ContactInfo { restitution: 1.2, ..smooth() }, CLEARANCE);
    assert!(matches!(&error, RunError::Setup(SetupError::Contact { joint, .. }) if joint == "R"), "{error}");
    assert_eq!(
        error.to_string(),
        "joint `R`: coefficient of restitution is 1.2; it must be above 0 and at most 1 in this law"
    );
    for clearance in [0.02, 0.0, -1e-6] {
        let error = refused(smooth(), clearance);
        let RunError::Assembly(AssemblyError::Setup(SetupError::Clearance { journal_radius, .. })) = &error
        else {
            panic!("{error}")
        };
        assert_eq!(*journal_radius, 0.01);
    }
}

#[test]
fn a_journal_that_is_demanded_outside_its_bearing_is_refused() {
    let start = |offset: f64| {
        let system = Journal::new(smooth()).held([offset, 0.0], [0.0, 0.0]);
        let settings = Settings { span: Span::Time(1e-5), ..Settings::default() };
        simulate(&system, &system.description, &[9.81, CLEARANCE], &settings, Watch::NONE)
    };
    // Pressed in by half a clearance is a start, by a hundred is none.
    assert!(start(1.5 * CLEARANCE).is_ok());
    let expected =
        AssemblyError::OutsideClearance { joint: "R".into(), distance: 1e-3, clearance: CLEARANCE };
    assert_eq!(start(1e-3), Err(RunError::Assembly(expected)));
}

/// A driven journal under 50 N, on a spring of contact of this stiffness [N/m^1.5].
fn on_a_spring(stiffness: f64) -> Journal {
    let mut system =
        Journal::new(ContactInfo { stiffness: Stiffness::Given(stiffness), ..smooth() }).driven(4.0 * PI);
    system.load = |_| [0.0, -50.0];
    system
}

fn every_method(step: f64) -> [Integrator; 3] {
    [dopri5(1e-9), rk4(step), Integrator::GeneralizedAlpha { step, rho: 0.8 }]
}

fn unfinished(system: &Journal, integrator: Integrator, span: Span) -> Run {
    simulate(system, &system.description, &[0.0, CLEARANCE], &Settings::new(integrator, span, 2), Watch::NONE)
        .expect("it starts")
}

#[test]
fn a_contact_deeper_than_its_clearance_is_doubtful_and_one_near_its_radius_ends_the_run() {
    // K p^1.5 = 50 N: two clearances, and a fifth of the radius.
    for integrator in every_method(1e-5) {
        let run = unfinished(&on_a_spring(50.0 / 2e-5_f64.powf(1.5)), integrator, Span::Time(1e-3));
        assert_eq!(run.stopped, None);
        let [RunWarning::DeepContact { joint, penetration, clearance, .. }] = &run.warnings[..] else {
            panic!("{:?}", run.warnings)
        };
        // It rests there.
        assert!(joint == "R" && *clearance == CLEARANCE && (penetration / 2e-5 - 1.0).abs() < 1e-6);
        let run = unfinished(&on_a_spring(50.0 / 2e-3_f64.powf(1.5)), integrator, Span::Time(1e-3));
        let Some(RunError::Penetration { penetration, journal_radius, .. }) = run.stopped else {
            panic!("{:?}", run.stopped)
        };
        assert!(journal_radius == 0.01 && (penetration / 2e-3 - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_run_that_does_not_get_on_says_so_and_ends() {
    // Pressed in by half a clearance on a spring of 1e22: a thousand million oscillations a second.
    let mut system = on_a_spring(1e22).held([0.0, -1.5 * CLEARANCE], [0.0, 0.0]);
    for integrator in every_method(1e-16) {
        let run = unfinished(&system, integrator, Span::Turns(1.0));
        let Some(RunError::NoProgress { tried, gained, joint, .. }) = &run.stopped else {
            panic!("{integrator:?} {:?}", run.stopped)
        };
        assert!(*tried >= 20_000 && *gained < 1e-4 * 0.5 && joint.as_deref() == Some("R"));
    }
    // A turn of a life as well, and nothing that turns.
    let parameters = [0.0, CLEARANCE];
    let mut runner = TurnRunner::new(&system, &system.description, &parameters, dopri5(1e-9), SINGULAR_PIVOT)
        .expect("it starts");
    assert!(matches!(runner.measure(Watch::NONE), Err(RunError::NoProgress { .. })));
    system = Journal::new(ContactInfo { stiffness: Stiffness::Given(1e22), ..smooth() })
        .held([0.0, -1.5 * CLEARANCE], [0.0, 0.0]);
    let run = unfinished(&system, dopri5(1e-4), Span::Time(1e4));
    assert!(matches!(run.stopped, Some(RunError::NoProgress { .. })), "{:?}", run.stopped);
}

#[test]
fn an_energy_balance_that_is_off_is_doubtful_then_an_error() {
    let (mut good, mut doubtful, mut wrong) = (0, 0, 0);
    // An impact takes about 0.1 ms.
    for step in [1e-6, 3e-6, 1e-5, 1.5e-5, 2e-5, 2.5e-5, 3e-5, 3.5e-5, 4e-5, 5e-5, 6e-5] {
        let run = unfinished(&flyer(smooth()), rk4(step), Span::Time(0.02));
        let statistics = run.statistics;
        let off = statistics.energy_error_J / statistics.energy_throughput_J;
        let warned = run.warnings.iter().any(|warning| matches!(warning, RunWarning::EnergyOff { .. }));
        match &run.stopped {
            None => assert!(off <= 0.1 && warned == (off > 0.01), "{step} {off} {:?}", run.warnings),
            Some(RunError::EnergyLost { error, throughput, .. }) => assert!(*error > 0.1 * throughput),
            Some(other) => assert!(matches!(other, RunError::Penetration { .. }), "{step} {other}"),
        }
        let stopped = run.stopped.is_some();
        good += usize::from(!stopped && !warned);
        doubtful += usize::from(!stopped && warned);
        wrong += usize::from(stopped);
    }
    assert!(good > 0 && doubtful > 0 && wrong > 0, "{good} {doubtful} {wrong}");
}

#[test]
fn a_mechanism_at_rest_balances_whatever_rounding_says() {
    // The load carries the journal in the middle of its bearing, free of any force that is left.
    let mut system = Journal::new(smooth()).held([0.0, 0.0], [0.0, 0.0]);
    system.load = |_| [0.0, 9.81];
    for integrator in every_method(1e-3) {
        let settings = Settings::new(integrator, Span::Time(1.0), 2);
        let run = simulate(&system, &system.description, &[9.81, CLEARANCE], &settings, Watch::NONE)
            .expect("it starts");
        assert!(run.stopped.is_none(), "{:?}", run.stopped);
        assert!(!run.warnings.iter().any(|warning| matches!(warning, RunWarning::EnergyOff { .. })));
    }
}

/// Crank, coupler, rocker; the crank turns four times a second in a bearing with clearance, the rocker is damped.
fn four_bar(contact: ContactInfo) -> Dense<Bars> {
    let bar = |from, length, angle, damping| Bar { length, damping, ..Bar::unit(from, angle, 0.0) };
    let crank = Bar {
        law: Some(|t| [8.0 * PI * t + 0.3, 8.0 * PI, 0.0]),
        mass: 0.5,
        ..bar(At::Ground(0.0, 0.0), 0.12, 0.3, 0.0)
    };
    let coupler = bar(At::End(0), 0.4, 0.5, 0.0);
    let rocker = bar(At::Ground(0.4, 0.0), 0.3, 1.6, 0.5);
    let bars = Bars {
        bars: vec![crank, coupler, rocker],
        loops: vec![(1, At::End(2))],
        bearing: Some(contact),
        ..Bars::default()
    };
    Dense::new(bars, &[("gravity", 9.81), ("clearance", CLEARANCE)])
}

fn turn_of(system: &Dense<Bars>, integrator: Integrator, span: Span, samples: usize) -> Run {
    let settings = Settings::new(integrator, span, samples);
    let result = simulate(system, &system.description, &system.parameters(), &settings, Watch::NONE)
        .expect("it starts");
    assert_eq!(result.stopped, None);
    result
}

#[test]
fn a_loop_starts_with_its_journal_at_rest_in_contact() {
    let system = four_bar(smooth());
    let result = turn_of(&system, rk4(5e-6), Span::Time(1e-3), 201);
    let force = result.rows[0].len() - 3;
    let first = result.rows[0][force];
    assert!(first > 1.0, "{first}");
    for (t, row) in result.times.iter().zip(&result.rows) {
        // Without the right side and depth it would ring between zero and twice the force. What is left is the
        // turn of the load, about 6 rad/s, over a millisecond, and the swing that this begins.
        assert!((row[force] - first).abs() < 0.05 * first, "{t} {} {first}", row[force]);
    }
}

#[test]
fn a_loop_with_clearance_balances_its_energy_and_wears_the_same_by_every_method() {
    let contact = ContactInfo { restitution: 0.9, friction: coulomb(0.05), ..smooth() };
    let system = four_bar(contact);
    let turn = |method, balanced: f64| {
        let result = turn_of(&system, method, Span::Turns(1.0), 0);
        let statistics = result.statistics;
        // Rounding of the loop, a few places of coordinates of a metre.
        assert!(statistics.max_loop_error_m < 1e-13, "{statistics:?}");
        assert!(statistics.energy_error_J < balanced * statistics.energy_throughput_J, "{statistics:?}");
        assert_eq!((result.turns.len(), &result.warnings[..]), (1, &[][..]));
        assert_eq!(result.turns[0][0].losses, 0.0);
        result.turns[0][0].wear_integral
    };
    let fixed = turn(rk4(1e-5), 1e-8);
    let adaptive = turn(dopri5(1e-9), 1e-8);
    // Half the step changes the first by 3e-10, a tenth of the tolerance the second by 5e-11.
    assert!((fixed - adaptive).abs() < 1e-9 * adaptive, "{fixed} {adaptive}");
    // Order 2: 1.6e-7 at 10 µs, four times that here.
    let implicit = turn(Integrator::GeneralizedAlpha { step: 2e-5, rho: 0.9 }, 1e-7);
    assert!((implicit - adaptive).abs() < 2e-6 * adaptive, "{implicit} {adaptive}");
}
