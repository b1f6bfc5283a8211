//! The right-hand side of C, laws of contact included, beside the runtime's.

use linkwear_runtime::contact::ImpactMemory;
use linkwear_runtime::{Evaluator, assemble_static_contact};

use super::compiler::{Numbers, build};
use super::run::filled;
use super::shipped;

#[test]
fn rates_with_contact_friction_and_wear_are_the_runtime_s_in_every_bit() {
    for name in
        ["slider_crank_clearance", "four_bar_wear", "rssr_ball_wear", "rssr", "rssr_flexible", "cam_press"]
    {
        let compiled = shipped(name);
        let (system, sizes, mut numbers) = (compiled.interpreter(), compiled.sizes(), Numbers::default());
        let parameters = compiled.parameters();
        let mut evaluator = Evaluator::new(&system, compiled.description(), &parameters).unwrap();
        let start = assemble_static_contact(&mut evaluator, 0.0).unwrap();
        let (mut input, mut expected, mut touching) = (Vec::new(), Vec::new(), 0);
        for turn in 0..60 {
            // Journals move by parts of their clearance: some touch, some do not.
            let mut beside = |values: &[f64], size: f64| -> Vec<f64> {
                values.iter().map(|value| value + size * f64::from(turn) * numbers.next()).collect()
            };
            let (t, q, v) = (1e-3 * f64::from(turn), beside(&start.q, 1e-7), beside(&start.v, 1e-3));
            let memories: Vec<[f64; 3]> = (0..sizes.contacts)
                .map(|joint| [1e-6 * numbers.next().abs(), (turn % 2) as f64, 0.1 * joint as f64])
                .collect();
            for (state, memory) in evaluator.clearances_mut().states_mut().iter_mut().zip(&memories) {
                state.worn = memory[0];
                state.memory = ImpactMemory { touching: memory[1], closing_speed: memory[2] };
            }
            input.extend([&[t][..], &q, &v, &vec![0.0; sizes.flat_state() - q.len() - v.len()]].concat());
            input.extend(memories.concat());
            let accelerations = evaluator.forward(t, &q, &v).accelerations.to_vec();
            let rates = evaluator.rates(t, &q, &v);
            expected
                .extend([rates.coordinates, &accelerations, &[rates.supplied, rates.dissipated]].concat());
            for contact in evaluator.clearances().contacts() {
                expected.extend([contact.wear_power, contact.depth_rate, contact.normal_force, contact.loss]);
                touching += usize::from(contact.penetration() > 0.0);
            }
        }
        assert!(sizes.contacts == 0 || touching > 5, "{name}: {touching}");
        for built in
            build(&format!("rates_{name}"), &compiled, &filled(include_str!("rates.c"), &compiled), &["-O2"])
        {
            let found = built.run(&input);
            let pairs = found.iter().zip(&expected);
            let differs = pairs.clone().position(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(
                (found.len(), differs),
                (expected.len(), None),
                "{name} {:?}",
                differs.map(|at| (at % sizes.flat_state(), found[at], expected[at]))
            );
        }
    }
}
