//! Laws of contact and wear do not branch on values: two trajectories in two lanes of one scalar give the
//! bits that each gives alone, whatever the other one does. A branch could not even be written: the mask of
//! these lanes is no `bool`.

use std::array::from_fn;
use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Neg, Sub};

use linkwear_runtime::Scalar;
use linkwear_runtime::contact::{
    Friction, ImpactMemory, Laws, Normal, Onset, Restitution, RevoluteContact, RevoluteMotion,
    SphericalContact, SphericalMotion, Stiffness, Strength, Support, bearing_angle, crossing_speed,
};
use linkwear_runtime::wear::{Archard, Area, Load, Pair, ScalarFeedback};
use proptest::prelude::*;

/// Two numbers side by side.
#[derive(Clone, Copy, Debug)]
struct Two([f64; 2]);

macro_rules! operator {
    ($trait:ident, $name:ident) => {
        impl $trait for Two {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i].$name(other.0[i])))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Two {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(f64::neg))
    }
}

impl Scalar for Two {
    type Mask = [bool; 2];
    fn constant(value: f64) -> Self {
        Self([value; 2])
    }
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(from_fn(|i| Scalar::mul_add(self.0[i], factor.0[i], summand.0[i])))
    }
    fn sqrt(self) -> Self {
        Self(self.0.map(Scalar::sqrt))
    }
    fn sin_cos(self) -> (Self, Self) {
        let pairs = self.0.map(Scalar::sin_cos);
        (Self(pairs.map(|pair| pair.0)), Self(pairs.map(|pair| pair.1)))
    }
    fn exp(self) -> Self {
        Self(self.0.map(Scalar::exp))
    }
    fn ln(self) -> Self {
        Self(self.0.map(Scalar::ln))
    }
    fn atan2(self, x: Self) -> Self {
        Self(from_fn(|i| Scalar::atan2(self.0[i], x.0[i])))
    }
    fn abs(self) -> Self {
        Self(self.0.map(Scalar::abs))
    }
    fn max(self, other: Self) -> Self {
        Self(from_fn(|i| Scalar::max(self.0[i], other.0[i])))
    }
    fn lt(self, other: Self) -> [bool; 2] {
        from_fn(|i| self.0[i] < other.0[i])
    }
    fn select(mask: [bool; 2], yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask[i] { yes.0[i] } else { no.0[i] }))
    }
}

fn laws() -> Vec<Laws> {
    let strengths = [
        Strength::Coulomb { coefficient: 0.05 },
        Strength::Stribeck {
            static_coefficient: 0.2,
            kinetic_coefficient: 0.1,
            stribeck_speed: 0.02,
            exponent: 0.7,
        },
    ];
    let onsets = [Onset::Smoothed { speed: 1e-3 }, Onset::Ambrosio { lower: 1e-4, upper: 1e-3 }];
    let mut laws = Vec::new();
    for strength in strengths {
        for onset in onsets {
            for exponent in [1.5, 1.0, 2.2] {
                let friction = Friction::new(strength, onset, -0.1).unwrap();
                let normal = Normal::new(Restitution::Exact, 0.4, exponent, 1e-3).unwrap();
                laws.push(Laws { normal, friction });
            }
        }
    }
    laws
}

/// Everything the laws compute, from eleven numbers.
fn everything<T: Scalar>(x: [T; 11]) -> Vec<T> {
    let [ox, oy, oz, vx, vy, vz, omega, clearance, impact, touching, slope] = x;
    let c = T::constant;
    let radius = c(0.01);
    let stiffness = Stiffness::Hertz { modulus: 115e9 }.value(radius, clearance);
    let memory = ImpactMemory { touching, closing_speed: impact };
    let motion = RevoluteMotion { offset: [ox, oy], offset_rate: [vx, vy], joint_speed: omega };
    // A worn bearing: the gradient leans.
    let Support { penetration, gradient: [nx, ny], turning, .. } = Support::round(motion.offset, clearance);
    let lean = slope / clearance;
    let support = Support {
        penetration: penetration - slope,
        gradient: [nx - lean * ny, ny + lean * nx],
        length: None,
        turning,
    };
    let flat = RevoluteContact::new(&motion, radius, &support);
    let motion = SphericalMotion {
        offset: [ox, oy, oz],
        offset_rate: [vx, vy, vz],
        angular_velocity: [omega, vy, -omega],
    };
    let ball = SphericalContact::new(&motion, radius, clearance);
    let mut out = vec![bearing_angle([ox, oy]), flat.penetration, flat.penetration_rate, flat.sliding_speed];
    out.push(crossing_speed((-clearance, vx), (flat.penetration, vy)));
    let next = memory.updated(flat.penetration, vx);
    out.extend([next.touching, next.closing_speed]);
    for laws in laws() {
        let f = flat.force(&laws, stiffness, &memory);
        out.extend([f.force[0], f.force[1], f.moment[2]]);
        out.extend([f.normal.elastic_energy, f.normal.damping_loss, f.friction_loss]);
        let g = ball.force(&laws, stiffness, &memory);
        out.extend(g.force.into_iter().chain(g.moment).chain([g.friction_loss]));
        out.push(laws.normal.resting_penetration(stiffness, f.force[0]));
        for area in [Area::Projected, Area::Hertz, Area::Conformal] {
            let pair = Pair { journal_radius: radius, length: c(0.02), clearance, modulus: c(115e9) };
            let load = Load {
                normal_force: f.normal.force,
                penetration: flat.penetration,
                sliding_speed: flat.sliding_speed,
            };
            let archard = Archard::new(1e-8, 3.5e9, area).unwrap();
            let rates = archard.rates(&load, &pair);
            out.extend([rates.wear_integral, rates.depth, archard.profile_rate(&load, &pair)]);
            out.push(area.half_angle(&load, &pair));
            out.push(ScalarFeedback::new(0.1).unwrap().next_clearance(clearance, rates.depth));
        }
    }
    out
}

/// In contact, apart, centred, at rest, at the smoothing speed: every side of every choice.
fn states() -> impl Strategy<Value = [f64; 11]> {
    let offset = prop_oneof![
        1 => Just([0.0; 3]),
        8 => (0.0..2.0 * PI, -2e-6..2e-6_f64, -1e-6..1e-6_f64)
            .prop_map(|(angle, p, z)| [(1e-5 + p) * angle.cos(), (1e-5 + p) * angle.sin(), z]),
    ];
    let speeds = prop_oneof![
        1 => Just([0.0; 4]),
        8 => [-0.5..0.5_f64, -0.5..0.5_f64, -0.5..0.5_f64, -20.0..20.0_f64],
        4 => [-1e-3..1e-3_f64, -1e-3..1e-3_f64, -1e-3..1e-3_f64, -0.1..0.1_f64],
    ];
    (offset, speeds, 0.0..0.01_f64, any::<bool>(), -1e-6..1e-6_f64).prop_map(
        |([ox, oy, oz], [vx, vy, vz, omega], impact, touching, slope)| {
            [ox, oy, oz, vx, vy, vz, omega, 1e-5, impact, f64::from(u8::from(touching)), slope]
        },
    )
}

proptest! {
    #[test]
    fn two_lanes_give_the_bits_of_two_trajectories(left in states(), right in states()) {
        let both = everything::<Two>(from_fn(|i| Two([left[i], right[i]])));
        let alone = [everything(left), everything(right)];
        for (i, lanes) in both.iter().enumerate() {
            for (lane, alone) in alone.iter().enumerate() {
                prop_assert!(alone[i].is_finite(), "output {} is {}", i, alone[i]);
                prop_assert_eq!(lanes.0[lane].to_bits(), alone[i].to_bits(), "output {}, lane {}", i, lane);
            }
        }
    }
}
