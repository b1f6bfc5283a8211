//! A mass hits a half-space with every normal law: what it returns is known, and depends on nothing else.
//!
//! Restitutions: roots of G(1) = G(-e), G(u) = u/chi - ln(1 + chi u)/chi², to eight digits, for
//! F = K p^n (1 + chi p_dot/v0); confirmed by direct integration for n = 1 and 1.5. The Hunt-Crossley
//! column agrees with the bounce heights of Exudyn's contactSphereSphereTest (0.9 -> 9.0903 of 10, ...).

mod truth;

use linkwear_runtime::contact::{ImpactMemory, Normal, Restitution};
use proptest::prelude::*;
use truth::reached;

/// The goal of the project; the integration is a hundred times better.
const BOUND: f64 = 1e-6;

const LAWS: [Restitution; 4] =
    [Restitution::LankaraniNikravesh, Restitution::HuntCrossley, Restitution::Flores, Restitution::LeeWang];

/// Given restitution, then what the four laws return.
const RETURNED: [(f64, [f64; 4]); 6] = [
    (0.1, [0.665_265_41, 0.515_832_62, 0.069_444_23, 0.686_663_44]),
    (0.3, [0.684_224_61, 0.581_288_04, 0.256_207_91, 0.738_995_32]),
    (0.5, [0.725_241_11, 0.662_962_20, 0.470_444_78, 0.799_198_78]),
    (0.7, [0.795_972_60, 0.767_999_79, 0.683_184_20, 0.869_343_11]),
    (0.9, [0.913_176_68, 0.909_015_74, 0.893_920_69, 0.952_370_15]),
    (0.95, [0.953_506_05, 0.952_370_15, 0.946_828_83, 0.975_608_31]),
];

/// Mass [kg], stiffness [N/m^n] and speed of the impact [m/s].
#[derive(Clone, Copy, Debug)]
struct Impact {
    mass: f64,
    stiffness: f64,
    speed: f64,
}

const STEEL: Impact = Impact { mass: 0.8, stiffness: 6.6e10, speed: 0.4 };

/// Speed of the rebound over that of the impact. Explicit steps of order 8 by Richardson
/// extrapolation of the midpoint rule (Gragg, Bulirsch, Stoer), step by the difference of the last two columns.
fn restitution(law: &Normal, impact: Impact) -> f64 {
    let memory = ImpactMemory::in_contact(impact.speed);
    let rate = |y: [f64; 2]| {
        let speed = memory.impact_speed(law, y[1]);
        [y[1], -law.evaluate(impact.stiffness, y[0], y[1], speed).force / impact.mass]
    };
    // Times are measured by the length of an elastic impact.
    let depth =
        (impact.mass * impact.speed * impact.speed / impact.stiffness).powf(1.0 / (law.exponent() + 1.0));
    let scale = [depth, impact.speed];
    let (mut y, mut step) = ([0.0, impact.speed], 1e-3 * depth / impact.speed);
    for _ in 0..100_000 {
        let (next, error) = extrapolated(&rate, y, step, scale);
        let factor = (0.9 * (1e-12 / error.max(1e-16)).powf(1.0 / 8.0)).clamp(0.2, 3.0);
        step *= factor;
        if error > 1e-12 {
            continue;
        }
        y = next;
        // Apart there is no force: the speed stays what it is.
        if y[0] <= 0.0 && y[1] <= 0.0 {
            return -y[1] / impact.speed;
        }
        // Nearly apart a spring of a high exponent pushes no more, and steps may grow without bound.
        step = step.min(depth / impact.speed);
    }
    panic!("no rebound: {law:?} {impact:?}");
}

fn extrapolated(
    rate: &impl Fn([f64; 2]) -> [f64; 2],
    y: [f64; 2],
    step: f64,
    scale: [f64; 2],
) -> ([f64; 2], f64) {
    let counts = [2.0, 4.0, 6.0, 8.0];
    let mut row: Vec<[f64; 2]> = Vec::new();
    let mut error = f64::INFINITY;
    for (k, count) in counts.into_iter().enumerate() {
        let h = step / count;
        let start = rate(y);
        let (mut before, mut now) = (y, [y[0] + h * start[0], y[1] + h * start[1]]);
        for _ in 1..count as usize {
            let f = rate(now);
            (before, now) = (now, [before[0] + 2.0 * h * f[0], before[1] + 2.0 * h * f[1]]);
        }
        // Gragg's smoothing step.
        let f = rate(now);
        let mut value: [f64; 2] = std::array::from_fn(|i| 0.5 * (now[i] + before[i] + h * f[i]));
        let mut next = vec![value];
        for j in 0..k {
            let ratio = (count / counts[k - 1 - j]).powi(2) - 1.0;
            let last = row[j];
            value = std::array::from_fn(|i| value[i] + (value[i] - last[i]) / ratio);
            next.push(value);
        }
        if k == counts.len() - 1 {
            let coarse = next[k - 1];
            error = (0..2).map(|i| (value[i] - coarse[i]).abs() / scale[i]).fold(0.0, f64::max);
        }
        row = next;
    }
    (*row.last().unwrap(), error)
}

fn law(law: Restitution, e: f64, exponent: f64) -> Normal {
    Normal::new(law, e, exponent, 1e-3).unwrap()
}

#[test]
fn every_law_returns_what_is_known_of_it() {
    for (place, kind) in LAWS.into_iter().enumerate() {
        let error = |(e, returned): (f64, [f64; 4]), exponent: f64| {
            (restitution(&law(kind, e, exponent), STEEL) - returned[place]).abs()
        };
        let errors = RETURNED.into_iter().flat_map(|row| [error(row, 1.0), error(row, 1.5)]);
        let what = format!("{kind:?}, restitution");
        reached("free impact", &what, errors.fold(0.0, f64::max), BOUND);
    }
}

#[test]
fn the_exact_law_returns_what_it_is_given() {
    let errors = RETURNED.map(|(e, _)| (restitution(&law(Restitution::Exact, e, 1.5), STEEL) - e).abs());
    reached("free impact", "Exact, restitution", errors.into_iter().fold(0.0, f64::max), BOUND);
    // Without damping all of it.
    let elastic = restitution(&law(Restitution::Exact, 1.0, 1.5), STEEL);
    assert!((elastic - 1.0).abs() < 1e-9, "{elastic}");
}

#[test]
fn below_the_floor_of_the_impact_speed_contacts_are_more_elastic() {
    let slow = Impact { speed: 1e-4, ..STEEL };
    let found = restitution(&law(Restitution::LankaraniNikravesh, 0.5, 1.5), slow);
    // At a tenth of the floor chi acts like a tenth of its 9/16, and e = 1 - 2/3 chi + 4/9 chi² to that order.
    let chi = 0.1 * 9.0 / 16.0;
    assert!((found - (1.0 - 2.0 / 3.0 * chi + 4.0 / 9.0 * chi * chi)).abs() < chi * chi * chi, "{found}");
}

#[test]
fn losses_add_up_to_the_kinetic_energy_lost() {
    // Fixed small steps: the loss is integrated with the motion.
    let law = law(Restitution::LankaraniNikravesh, 0.7, 1.5);
    let memory = ImpactMemory::in_contact(STEEL.speed);
    let rate = |y: [f64; 3]| {
        let n = law.evaluate(STEEL.stiffness, y[0], y[1], memory.impact_speed(&law, y[1]));
        [y[1], -n.force / STEEL.mass, n.damping_loss]
    };
    let (mut y, h) = ([0.0, STEEL.speed, 0.0], 1e-8);
    while y[0] >= 0.0 {
        let at = |k: [f64; 3], part: f64| std::array::from_fn(|i| y[i] + part * h * k[i]);
        let a = rate(y);
        let b = rate(at(a, 0.5));
        let c = rate(at(b, 0.5));
        let d = rate(at(c, 1.0));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    let lost = 0.5 * STEEL.mass * (STEEL.speed.powi(2) - y[1].powi(2));
    // Steps of a 10,000th of the impact; the root at both ends of it costs h^2.5.
    assert!((y[2] / lost - 1.0).abs() < 1e-8, "{} {lost}", y[2]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn restitution_depends_on_nothing_but_the_given_one(
        mass in 1e-3..1e3_f64, stiffness in 6.0..12.0_f64, speed in 2e-3..5.0_f64, exponent in 1.0..2.5_f64, e in 0.2..1.0_f64,
    ) {
        let impact = Impact { mass, stiffness: 10.0_f64.powf(stiffness), speed };
        let found = restitution(&law(Restitution::Exact, e, exponent), impact);
        prop_assert!((found - e).abs() < BOUND, "{} {}", found, e);
    }
}
