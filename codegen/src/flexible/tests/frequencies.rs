//! Frequencies against closed forms.

use std::f64::consts::PI;

use nalgebra::Matrix4;

use super::*;

fn rod_frequencies(theory: Theory, hold: Hold) -> Vec<f64> {
    frequencies(&rod(theory, hold, 6), 'y')
}

/// sqrt(E I / (rho A)) of the rod.
fn stiffness_ratio() -> f64 {
    (STEEL.youngs_modulus / STEEL.density).sqrt() * RADIUS / 2.0
}

#[test]
fn euler_bernoulli_rods_have_the_known_frequencies() {
    // Printed with seven digits: half a unit of the last is 3.6e-7 of the smallest.
    let printed = 1e-6;
    let pinned = rod_frequencies(Theory::EulerBernoulli, Hold::Pinned(None));
    assert_close(&pinned, &[138.1711, 552.6846, 1243.5403], printed);
    let clamped = rod_frequencies(Theory::EulerBernoulli, Hold::CANTILEVER);
    assert_close(&clamped, &[49.2230, 308.4755, 863.7403], printed);
    let free = rod_frequencies(Theory::EulerBernoulli, Hold::Free);
    assert_close(&free, &[313.2185, 863.3988, 1692.6069], printed);
}

#[test]
fn euler_bernoulli_rods_meet_the_closed_form_almost_to_rounding() {
    let hertz = |wave: f64| (wave / LENGTH) * (wave / LENGTH) * stiffness_ratio() / (2.0 * PI);
    // The degree is chosen for 1e-16; rounding of a dense eigenproblem of some 40 unknowns leaves 1e-12.
    let tolerance = 1e-11;
    let pinned: Vec<f64> = (1..=3).map(|n| hertz(f64::from(n) * PI)).collect();
    assert_close(&rod_frequencies(Theory::EulerBernoulli, Hold::Pinned(None)), &pinned, tolerance);
    let clamped = |wave: f64| wave.cos() + 1.0 / wave.cosh();
    let clamped: Vec<f64> =
        (0..3).map(|n| root(clamped, f64::from(n) * PI + 0.1, f64::from(n + 1) * PI)).collect();
    let clamped: Vec<f64> = clamped.into_iter().map(hertz).collect();
    assert_close(&rod_frequencies(Theory::EulerBernoulli, Hold::CANTILEVER), &clamped, tolerance);
    let free = |wave: f64| wave.cos() - 1.0 / wave.cosh();
    let free: Vec<f64> = (1..4).map(|n| root(free, f64::from(n) * PI + 0.1, f64::from(n + 1) * PI)).collect();
    let free: Vec<f64> = free.into_iter().map(hertz).collect();
    assert_close(&rod_frequencies(Theory::EulerBernoulli, Hold::Free), &free, tolerance);
}

/// Pinned-pinned frequencies of the rod by theory: sin(k x) solves both equations of motion.
///
/// (kappa G A k² - rho A w²)(E I k² + kappa G A - rho I w²) = (kappa G A k)²; without shear, w² = E I k⁴ / (rho A + rho I k²).
fn pinned_by_hand(theory: Theory) -> Vec<f64> {
    let section = Section::Round { radius: RADIUS }.properties(STEEL.poisson_ratio);
    let (area, second) = (section.area, section.iz);
    let Material { youngs_modulus: e, poisson_ratio: nu, density: rho } = STEEL;
    let shear = section.shear.expect("round sections shear")[0] * e / (2.0 * (1.0 + nu)) * area;
    let of = |n: i32| {
        let k = f64::from(n) * PI / LENGTH;
        let square = if theory == Theory::Timoshenko {
            let a = rho * area * rho * second;
            let b = -(rho * second * shear * k * k + rho * area * (e * second * k * k + shear));
            let c = shear * k * k * e * second * k * k;
            2.0 * c / (-b + (b * b - 4.0 * a * c).sqrt())
        } else {
            e * second * k * k * k * k / (rho * area + rho * second * k * k)
        };
        square.sqrt() / (2.0 * PI)
    };
    (1..=3).map(of).collect()
}

#[test]
fn rotary_inertia_and_shear_lower_the_frequencies_as_derived_by_hand() {
    for theory in [Theory::Rayleigh, Theory::Timoshenko] {
        let found = rod_frequencies(theory, Hold::Pinned(None));
        // As for Euler-Bernoulli: rounding of a dense eigenproblem.
        assert_close(&found, &pinned_by_hand(theory), 1e-11);
    }
    // Six printed digits each.
    let rayleigh = rod_frequencies(Theory::Rayleigh, Hold::Pinned(None));
    assert_close(&rayleigh, &[138.136, 552.13, 1240.73], 1e-5);
    let timoshenko = rod_frequencies(Theory::Timoshenko, Hold::Pinned(None));
    assert_close(&timoshenko, &[138.035, 550.511, 1232.639], 1e-5);
}

#[test]
fn few_elements_are_enough() {
    let beam = Beam::new(&rod(Theory::Timoshenko, Hold::Pinned(None), 6)).expect("a rod");
    let found = beam.resolution();
    assert_eq!(found, Resolution { elements: 4, degree: 14, unknowns: 108 });
}

/// A stepped cantilever: frequency equation of two beams joined with equal deflection, slope, moment and shear force.
#[test]
fn a_stepped_cantilever_meets_its_frequency_equation() {
    let (first, second) = (0.25, 0.17);
    let radii = [0.008, 0.005];
    let mut input = rod(Theory::EulerBernoulli, Hold::CANTILEVER, 6);
    input.segments = vec![
        segment(first, Section::Round { radius: radii[0] }),
        segment(second, Section::Round { radius: radii[1] }),
    ];
    let sections = radii.map(|radius| Section::Round { radius }.properties(0.3));
    let determinant = |hertz: f64| {
        let omega = 2.0 * PI * hertz;
        let wave = sections.map(|section| {
            (omega * omega * STEEL.density * section.area / (STEEL.youngs_modulus * section.iz)).powf(0.25)
        });
        // Left part: clamped at 0; right part: free at its far end, seen from there.
        let left = |x: f64| shapes_from(wave[0] * x, [1.0, -1.0]);
        let right = |x: f64| shapes_from(wave[1] * x, [1.0, 1.0]);
        let (left, right) = (left(first), right(second));
        let (a, b) = (wave[0], wave[1]);
        let rigidity = sections.map(|section| section.iz / sections[0].iz);
        let row = |order: i32| {
            let (stiff, mirrored) =
                (if order < 2 { [1.0; 2] } else { rigidity }, f64::from((-1_i32).pow(order as u32)));
            let l = left.map(|shape| stiff[0] * shape[order as usize]);
            let r = right.map(|shape| -mirrored * stiff[1] * (b / a).powi(order) * shape[order as usize]);
            [l[0], l[1], r[0], r[1]]
        };
        let rows = [row(0), row(1), row(2), row(3)];
        Matrix4::from_fn(|i, j| rows[i][j]).determinant() / ((a * first).cosh() * (b * second).cosh())
    };
    let mut expected = vec![];
    let mut hertz = 10.0;
    while expected.len() < 3 {
        if (determinant(hertz) > 0.0) != (determinant(hertz + 5.0) > 0.0) {
            expected.push(root(determinant, hertz, hertz + 5.0));
        }
        hertz += 5.0;
    }
    // The determinant cancels hyperbolic functions: 1e-9 is what it is good for.
    assert_close(&frequencies(&input, 'y'), &expected, 1e-9);
}

/// Two solutions of the beam equation from an end at 0 (`signs` [1, -1]: clamped; [1, 1]: free), with derivatives 0 to 3
/// per wave number: cosh ± cos and sinh ± sin.
fn shapes_from(x: f64, [hyperbolic, circular]: [f64; 2]) -> [[f64; 4]; 2] {
    let (sh, ch, s, c) =
        (hyperbolic * x.sinh(), hyperbolic * x.cosh(), circular * x.sin(), circular * x.cos());
    [[ch + c, sh - s, ch - c, sh + s], [sh + s, ch + c, sh - s, ch - c]]
}

/// A cantilever with a point mass at its tip: 1 + cos cosh + ratio x (cos sinh - sin cosh) = 0, x = k L.
#[test]
fn a_tip_mass_lowers_the_frequencies_as_its_equation_says() {
    let mut input = rod(Theory::EulerBernoulli, Hold::CANTILEVER, 6);
    let mass = STEEL.density * PI * RADIUS * RADIUS * LENGTH;
    let ratio = 0.7;
    input.masses = vec![ConcentratedMass { x: LENGTH, mass: ratio * mass, inertia: [0.0; 3] }];
    let equation = |x: f64| {
        (1.0 + x.cos() * x.cosh() + ratio * x * (x.cos() * x.sinh() - x.sin() * x.cosh())) / x.cosh()
    };
    let expected: Vec<f64> = [(0.5, 2.0), (3.3, 4.6), (6.4, 7.7)]
        .into_iter()
        .map(|(low, high)| root(equation, low, high) / LENGTH)
        .map(|wave| wave * wave * stiffness_ratio() / (2.0 * PI))
        .collect();
    // Rounding of a dense eigenproblem.
    assert_close(&frequencies(&input, 'y'), &expected, 1e-11);
}

#[test]
fn axial_and_torsional_families_are_those_of_a_bar() {
    let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 0);
    let beam = Beam::new(&input).expect("a rod");
    let axial = (STEEL.youngs_modulus / STEEL.density).sqrt();
    let twist = axial / 2.6_f64.sqrt();
    let truncated = beam.truncated();
    // Held at both ends: c / (2 L). Rounding of a dense eigenproblem.
    assert_close(&[truncated.axial, truncated.torsion], &[axial / 0.84, twist / 0.84], 1e-11);
    input.hold = Hold::CANTILEVER;
    input.modes = Counts { bending: 0, axial: 2, torsion: 1 };
    let quarter = 1.0 / (4.0 * LENGTH);
    assert_close(&frequencies(&input, 'x'), &[axial * quarter, 3.0 * axial * quarter], 1e-11);
    assert_close(&frequencies(&input, 't'), &[twist * quarter], 1e-11);
    input.hold = Hold::Free;
    assert_close(&frequencies(&input, 'x'), &[2.0 * axial * quarter, 4.0 * axial * quarter], 1e-11);
}

#[test]
fn the_first_frequency_left_out_is_named() {
    let beam = Beam::new(&rod(Theory::EulerBernoulli, Hold::Pinned(None), 3)).expect("a rod");
    let truncated = beam.truncated();
    // Kept: y1 z1 y2. Seven printed digits.
    assert_close(&[truncated.y, truncated.z], &[1243.5403, 552.6846], 1e-6);
}

#[test]
fn thin_and_stubby_rods_are_both_resolved() {
    for radius in [1e-5, 1e-3, 0.05] {
        let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 6);
        input.segments = vec![segment(LENGTH, Section::Round { radius })];
        let few = frequencies(&input, 'y');
        // Twice the modes takes another mesh.
        input.modes.bending = 12;
        let more = frequencies(&input, 'y');
        // The two meshes agree to what the degree promises, and thinness costs digits: shear 1e9 stiffer than bending.
        assert_close(&few, &more[..3], 1e-9);
    }
}

#[test]
fn a_sliver_beside_long_segments_costs_no_digits() {
    let whole = rod_frequencies(Theory::Timoshenko, Hold::Pinned(None));
    let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 6);
    let section = Section::Round { radius: RADIUS };
    // A fillet of a millionth of the length, of the same section: nothing may change.
    input.segments =
        [0.2, LENGTH * 1e-6, LENGTH * (1.0 - 1e-6) - 0.2].map(|length| segment(length, section)).to_vec();
    // Rounding of a dense eigenproblem.
    assert_close(&frequencies(&input, 'y'), &whole, 1e-11);
}
