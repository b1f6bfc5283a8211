//! Wear integrals: their order, under a steady load, by located onsets, turn by turn.

use std::f64::consts::PI;

use linkwear_runtime::wear::Area;
use linkwear_runtime::{ContactInfo, Integrator, Settings, Span, Watch, simulate};

use crate::common::journal::{Journal, coulomb, smooth, wear};
use crate::journals::{CLEARANCE, TURN, column, dopri5, loaded, rk4, run, steady, swelling, swinging};

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
