//! Loop Jacobians and velocity residuals against dual numbers carried through the position residuals, at states that do
//! not close the loops; the mass matrix against the kinetic energy. Every shipped mechanism, both closures.

mod support;

use linkwear_codegen::backend::interp::Interpreted;
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::model::Closure;
use linkwear_runtime::{Dual, Entry, System, assemble};
use support::random::Random;
use support::{compiled, evaluate};

/// Both sides are exact; residuals of a few hundred operations round to this.
const ROUNDING: f64 = 1e-11;

/// A state near the assembled start but off the constraints, quaternions kept unit.
fn open_state(compiled: &Compiled, system: &Interpreted, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let start = assemble(system, compiled.description(), &compiled.parameters(), 0.0).expect("it closes");
    let mut q: Vec<f64> = start.q.iter().map(|x| x + 0.1 * random.next()).collect();
    for first in compiled.description().quaternions.iter() {
        let part = &mut q[*first..first + 4];
        let norm = part.iter().map(|x| x * x).sum::<f64>().sqrt();
        part.iter_mut().for_each(|x| *x /= norm);
    }
    let v = start.v.iter().map(|x| x + random.next()).collect();
    (q, v)
}

fn lifted(values: &[f64], rates: &[f64]) -> Vec<Dual<f64>> {
    values.iter().zip(rates).map(|(value, rate)| Dual::new(*value, *rate)).collect()
}

fn check(name: &str, closure: Closure) {
    let compiled = compiled(name, &[], Some(closure));
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let sizes = System::<f64>::sizes(&system);
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    let kept: Vec<usize> =
        (0..sizes.all_rows).filter(|i| compiled.description().rows[*i].kept.is_some()).collect();
    for _ in 0..5 {
        let (q, v) = open_state(&compiled, &system, &mut random);
        let t = 0.0;
        let input = [&parameters, &[t][..], &q, &v].concat();
        let output = evaluate(&system, Entry::Closure, &input);
        let (speeds, jacobian) = output[sizes.all_rows..].split_at(sizes.rows);
        // Directions: every free speed on its own, then the whole motion with time running.
        for direction in 0..=sizes.speeds {
            let whole = direction == sizes.speeds;
            let speed: Vec<f64> = (0..sizes.speeds)
                .map(|j| if whole { v[j] } else { f64::from(u8::from(j == direction)) })
                .collect();
            let state = [&parameters, &[t][..], &q, &speed, &vec![0.0; sizes.drivers]].concat();
            let q_dot = &evaluate(&system, Entry::Rates, &state)[..sizes.coordinates];
            let rates =
                [&vec![0.0; parameters.len()], &[f64::from(u8::from(whole))][..], q_dot, &vec![0.0; v.len()]];
            let phi = evaluate(&system, Entry::Closure, &lifted(&input, &rates.concat()));
            for (row, at) in kept.iter().enumerate() {
                let ours = if whole { speeds[row] } else { jacobian[row * sizes.speeds + direction] };
                let exact = phi[*at].derivative;
                assert!(
                    (ours - exact).abs() < ROUNDING * (1.0 + exact.abs()),
                    "{name} {closure:?}: row {row}, direction {direction}: {ours} against {exact}"
                );
            }
        }
    }
}

#[test]
fn jacobians_are_exact_off_the_closed_positions() {
    for name in ["four_bar", "slider_crank", "rssr_rigid", "andrews", "bricard", "bennett", "six_bar"] {
        for closure in [Closure::Joint, Closure::Log] {
            check(name, closure);
        }
    }
}

#[test]
fn kinetic_energy_is_half_v_m_v() {
    for name in
        ["pendulum", "four_bar", "rssr_rigid", "andrews", "flyball", "n_four_bar_2", "spatial_slider_crank"]
    {
        let compiled = compiled(name, &[], None);
        let (system, parameters) = (compiled.interpreter(), compiled.parameters());
        let sizes = System::<f64>::sizes(&system);
        if sizes.drivers > 0 {
            // The energy knows the drivers' speeds, the mass matrix here has them free: tested by the undriven ones.
            continue;
        }
        let mut random = Random(77);
        let (q, v) = open_state(&compiled, &system, &mut random);
        let input = [&parameters, &[0.0][..], &q, &v].concat();
        let energy = evaluate(&system, Entry::Energy, &input)[0];
        let equations = evaluate(&system, Entry::EquationsOfMotion, &input);
        let (mut sum, mut at) = (0.0, 0);
        for i in 0..v.len() {
            for j in i..v.len() {
                sum += if i == j { 0.5 } else { 1.0 } * v[i] * v[j] * equations[at];
                at += 1;
            }
        }
        assert!((sum - energy).abs() < ROUNDING * energy, "{name}: {sum} against {energy}");
    }
}
