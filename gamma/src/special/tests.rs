//! Against mpmath 1.3.0 at 400 digits (`gammainc` regularised, `loggamma`, `psi`, `erfc`).

use super::*;

/// shape, x, ln P, ln Q.
const INCOMPLETE: &[(f64, f64, f64, f64)] = &[
    (1e-08, 1e-300, -6.9019831224153686e-06, -11.883705229598998),
    (1e-08, 1e-10, -2.2448635273363596e-07, -15.309451033460224),
    (1e-08, 0.001, -6.331539372350826e-08, -16.57513738223381),
    (1e-08, 0.5, -5.597735992766911e-09, -19.000903610756108),
    (1e-08, 1.0, -2.1938393688091724e-09, -19.937612692722347),
    (1e-08, 1.5, -1.0001958379031708e-09, -20.723070018717078),
    (1e-08, 5.0, -1.1482956181173793e-11, -25.190157251121235),
    (1e-08, 50.0, -3.78326420011854e-32, -72.35213579381353),
    (0.0001, 1e-200, -0.045993988517660435, -3.102153427620159),
    (0.0001, 1e-05, -0.001093580204174056, -6.818845114513912),
    (0.0001, 0.3, -9.057338634192033e-05, -9.309395423404808),
    (0.0001, 1.2, -1.584280821942925e-05, -11.052802822104924),
    (0.0001, 20.0, -9.839084997677456e-15, -32.25241367621109),
    (0.1, 1e-30, -6.857882837722298, -0.0010516898380499452),
    (0.1, 0.0001, -0.8711706866501, -0.542077886594674),
    (0.1, 0.7, -0.0408794998917488, -3.217496687081864),
    (0.1, 3.0, -0.0015664980647828375, -6.459695829735097),
    (0.1, 30.0, -4.476766580012693e-16, -35.34246044759442),
    (0.9, 1e-12, -24.828934728413085, -1.647899249373663e-11),
    (0.9, 0.2, -1.502531014132466, -0.2517566914677098),
    (0.9, 0.99, -0.39759977892773374, -1.1145310060773437),
    (0.9, 2.0, -0.12105511425932311, -2.1714263814923984),
    (0.9, 40.0, -2.7423903075955928e-18, -40.4377017587559),
    (1.0, 1e-09, -20.723265837446412, -1e-09),
    (1.0, 1.0, -0.4586751453870819, -1.0),
    (1.0, 2.5, -0.08565048374203818, -2.5),
    (1.0, 600.0, -2.6503965530043108e-261, -600.0),
    (3.7, 1e-05, -45.33423723904437, -2.0492310410118457e-20),
    (3.7, 1.0, -3.5080904128835706, -0.030411847517716865),
    (3.7, 3.0, -0.8776105552429592, -0.5374694345535418),
    (3.7, 5.0, -0.24566908357247197, -1.524090921922249),
    (3.7, 60.0, -1.3892727683633588e-22, -50.32809162386492),
    (12.0, 0.5, -28.765873007035612, -3.214697303345701e-13),
    (12.0, 8.0, -2.18993520034932, -0.11869795521350085),
    (12.0, 12.0, -0.619148547215927, -0.7730623413967526),
    (12.0, 20.0, -0.021618833619872543, -3.844980360323948),
    (12.0, 100.0, -1.0457262607030485e-29, -66.730256066483),
    (50.0, 1.0, -149.45797200505862, -1.2337508979097351e-65),
    (50.0, 30.0, -7.563815824707173, -0.0005190261333113415),
    (50.0, 50.0, -0.6562207983875686, -0.7314895757292705),
    (50.0, 52.0, -0.4654535192328988, -0.9884590820739793),
    (50.0, 90.0, -1.6494998621419743e-06, -13.31503925460324),
    (50.0, 300.0, -2.418828583346486e-72, -164.90284332906424),
    (1092.0, 700.0, -96.99380392982935, -7.518412928262267e-43),
    (1092.0, 1000.0, -6.145065284731622, -0.002146337650127184),
    (1092.0, 1092.0, -0.6851309936140213, -0.7012281463883423),
    (1092.0, 1150.0, -0.0422451953988706, -3.1853128881316826),
    (1092.0, 1500.0, -7.343031974070397e-29, -64.78121586400667),
    (100000.0, 98000.0, -23.057255413113108, -9.690835158630048e-11),
    (100000.0, 99900.0, -0.9774353049631034, -0.4720455409361591),
    (100000.0, 100000.0, -0.6923064898187249, -0.6939885786567972),
    (100000.0, 100050.0, -0.5740825876072163, -0.8283287067028379),
    (100000.0, 101000.0, -0.0008087484618170922, -7.12042696105511),
    (100000.0, 103000.0, -2.8706236917814667e-21, -47.29975763250317),
];

/// x, ln Gamma(x), psi(x), psi'(x).
const PLAIN: &[(f64, f64, f64, f64)] = &[
    (1e-08, 18.42068073818021, -100000000.57721566, 1e+16),
    (0.0001, 9.210282658633963, -10000.577051183514, 100000001.64469367),
    (0.1, 2.252712651734206, -10.423754940411076, 101.43329915079275),
    (0.5, 0.5723649429247001, -1.9635100260214235, 4.934802200544679),
    (1.5, -0.12078223763524522, 0.03648997397857652, 0.9348022005446793),
    (3.7, 1.428072326665388, 1.1671535393615113, 0.3100378576700383),
    (100.0, 359.1342053695754, 4.600161852738087, 0.010050166663333571),
    (100000.0, 1051287.7089736569, 11.512920464961894, 1.0000050000166667e-05),
    (1000000.0, 12815504.569147613, 13.815510057964191, 1.0000005000001667e-06),
];

/// x, ln Gamma(1 + x).
const GAMMA_1P: &[(f64, f64)] = &[
    (1e-12, -5.772156649007103e-13),
    (1e-08, -5.772156566768626e-09),
    (0.001, -0.0005763935982833696),
    (0.05, -0.02685307250226017),
    (0.2, -0.08537409000331585),
    (0.9, -0.038984275923083324),
];

/// z, normal cdf.
const NORMAL: &[(f64, f64)] = &[
    (-38.0, 2.88542835e-316),
    (-20.0, 2.7536241186062337e-89),
    (-8.0, 6.220960574271784e-16),
    (-3.0, 0.0013498980316300946),
    (-1.0, 0.15865525393145705),
    (-0.1, 0.460172162722971),
    (0.0, 0.5),
    (0.5, 0.6914624612740131),
    (2.0, 0.9772498680518208),
    (6.0, 0.9999999990134123),
];

fn relative(found: f64, expected: f64) -> f64 {
    if expected == 0.0 { found.abs() } else { (found / expected - 1.0).abs() }
}

#[test]
fn both_tails_are_right_to_their_last_digits() {
    for &(shape, x, ln_p, ln_q) in INCOMPLETE {
        // Below 0.5 the logarithm is compared, in ulp of itself; above, it tells the other tail, and that tail is good
        // to its own logarithm's ulp. Sums of 1e4 terms at shape 1e5 give three times the rounding.
        let tolerance = if shape > 1e4 { 1.2e-14 } else { 4e-15 };
        let tail = ln_p.min(ln_q).abs().max(1.0);
        for (found, expected) in [(ln_gamma_p(shape, x), ln_p), (ln_gamma_q(shape, x), ln_q)] {
            let scale = if expected < -0.7 { expected.abs().max(1.0) } else { expected.abs() * tail };
            let miss = (found - expected).abs();
            assert!(miss <= tolerance * scale, "shape {shape}, x {x}: {found} for {expected}");
        }
    }
}

#[test]
fn plain_functions_agree_with_mpmath() {
    for &(x, gamma, psi, psi_1) in PLAIN {
        // 1e-14: relative, for psi next to its root and for ln Gamma next to 1 and 2 absolute.
        for (found, expected) in [(ln_gamma(x), gamma), (digamma(x), psi), (trigamma(x), psi_1)] {
            let miss = (found - expected).abs();
            assert!(
                found == expected || miss <= 1e-14 * expected.abs().max(1.0),
                "{x}: {found} for {expected}"
            );
        }
        assert!(relative(trigamma(x), psi_1) < 1e-14 || psi_1.is_infinite());
    }
    for &(x, expected) in GAMMA_1P {
        assert!(relative(ln_gamma_1p(x), expected) < 4e-15, "{x}: {}", ln_gamma_1p(x));
    }
}

#[test]
fn the_normal_law_agrees_with_mpmath_and_inverts() {
    for &(z, expected) in NORMAL {
        // erfc amplifies the rounding of z by z^2; the last one is denormal.
        let tolerance = if expected < 1e-307 { 1e-6 } else { 4e-16 * (z * z).max(4.0) };
        assert!(relative(normal_cdf(z), expected) < tolerance, "{z}: {}", normal_cdf(z));
        if z < 0.6 && expected > 1e-300 {
            assert!((normal_quantile(expected) - z).abs() < 1e-14 * z.abs().max(1.0), "{z}");
        }
    }
    assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
    assert!(normal_quantile(1.5).is_nan());
}

#[test]
fn quantiles_invert_the_law_at_every_shape_and_tail() {
    for shape in [1e-8, 1e-4, 0.01, 0.3, 1.0, 4.5, 50.0, 1092.0, 1e5] {
        for p in [1e-200, 1e-12, 1e-3, 0.2, 0.5, 0.9, 1.0 - 1e-9] {
            let y = ln_gamma_quantile(shape, p);
            let (ln_p, ln_q) = incomplete::ln_both(shape, libm::exp(y), y);
            let (found, expected) = if p <= 0.5 { (ln_p, libm::log(p)) } else { (ln_q, libm::log1p(-p)) };
            // One ulp of y is shape |y| ulp of P and, at large shapes, sqrt(shape) |y| z of it.
            let tolerance =
                1e-15 * (10.0 + expected.abs() * 30.0 + (1.0 + shape.sqrt()) * y.abs().min(500.0) * 30.0);
            assert!((found - expected).abs() < tolerance, "shape {shape}, p {p}: {found} for {expected}");
        }
    }
    assert!(ln_gamma_quantile(2.0, -0.1).is_nan());
    assert_eq!(ln_gamma_quantile(2.0, 1.0), f64::INFINITY);
}

#[test]
fn the_law_of_the_logarithm_lives_where_x_underflows() {
    // P(1e-8, exp(-1e8)) = exp(-1) exp(gamma 1e-8) to first order in the shape.
    let found = ln_gamma_p_of_ln(1e-8, -1e8);
    assert!((found - (-1.0 + EULER * 1e-8)).abs() < 1e-15, "{found}");
    assert_eq!(ln_gamma_p(3.0, 0.0), f64::NEG_INFINITY);
    assert_eq!(gamma_q(3.0, -1.0), 1.0);
    assert_eq!(gamma_q(3.0, f64::INFINITY), 0.0);
    assert!(gamma_p(f64::NAN, 1.0).is_nan());
}

#[test]
fn large_shapes_have_all_digits_by_the_uniform_expansion() {
    // mpmath 1.3.0 at 40 digits: z, smaller of P and Q at shape 1e6, x = shape + z sqrt(shape).
    let known = [
        (-20.0, 1.837_185_732_907_132_6e-90),
        (-3.0, 0.001_338_104_167_313_599_7),
        (0.0, 0.500_132_980_760_872_6),
        (1.0, 0.158_655_213_631_659_7),
        (5.0, 2.987_490_140_114_635e-7),
        (30.0, 3.262_430_144_876_734e-194),
    ];
    for (z, expected) in known {
        let x = 1e6 + z * 1e3;
        // At z = 0 it is P that is given.
        let found = if z > 0.0 { gamma_q(1e6, x) } else { gamma_p(1e6, x) };
        // exp of a logarithm of up to 445: 445 times 1e-16.
        assert!((found / expected - 1.0).abs() < 2e-13, "{z}: {found:e}");
    }
    // Continuous where series and fraction take over: neighbours one rounding apart.
    for (shape, x) in [(1e6, 1e6), (1e6, 0.99e6), (1e6, 1.002e6), (2e6, 0.71 * 2e6), (2e6, 1.29 * 2e6)] {
        let (inside, outside) = (f64::next_up(shape), f64::next_down(shape));
        let step = if shape > 1e6 { x * 1e-12 } else { 0.0 };
        for side in [ln_gamma_p, ln_gamma_q] {
            let (a, b) = (side(inside, x + step), side(outside, x - step));
            // Two steps at a slope of up to 0.41; rounding of series of 1e4 terms.
            assert!((a - b).abs() < 1e-11 + 1e-13 * a.abs() + step, "{shape} {x}: {a} {b}");
        }
    }
}

#[test]
fn shapes_beyond_all_numbers_end_every_search() {
    // The expansion for large shapes looked for the last place of what is no number.
    assert_eq!((gamma_p(f64::INFINITY, 3.0), gamma_q(f64::INFINITY, 3.0)), (0.0, 1.0));
    assert!(gamma_p(f64::INFINITY, f64::INFINITY).is_nan());
    assert_eq!(gamma_p(f64::MAX, 3.0), 0.0);
}
