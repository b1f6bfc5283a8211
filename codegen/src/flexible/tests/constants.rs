//! The constants against independent quadrature of the displacement field, and what must hold for any beam.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

use super::*;

fn holds() -> Vec<Hold> {
    let at = |x, rotation| Attachment { x, rotation: [rotation; 2] };
    vec![
        Hold::Pinned(None),
        Hold::Pinned(Some([0.05, 0.33])),
        Hold::CANTILEVER,
        Hold::Clamped { at: 0.33, far: Some(0.05) },
        Hold::Free,
        Hold::CraigBampton(vec![at(0.0, true), at(0.2, true), at(0.4, false)]),
        Hold::CraigBampton(vec![Attachment { x: 0.0, rotation: [true, false] }, at(0.4, true)]),
    ]
}

/// A stepped beam with every kind of mode and two masses.
fn rich(theory: Theory, hold: Hold) -> BeamInput {
    BeamInput {
        segments: vec![
            segment(0.2, Section::Rectangle { y: 0.012, z: 0.02 }),
            segment(0.2, Section::Tube { outer: 0.009, inner: 0.005 }),
        ],
        masses: vec![
            ConcentratedMass { x: 0.1, mass: 0.3, inertia: [0.0; 3] },
            ConcentratedMass { x: 0.4, mass: 0.1, inertia: [3e-5, 2e-5, 4e-5] },
        ],
        theory,
        hold,
        modes: Counts { bending: 4, axial: 1, torsion: 1 },
        damping_ratio: 0.0,
        second_order: true,
    }
}

/// Points of mass of the whole body: place, mass, displacement per mode, χ_kl along x.
///
/// Sections are four points of a quarter of the mass at (±y, 0), (0, ±z) scaled to the second moments; along the axis the
/// midpoint rule. Concentrated masses likewise with six points.
struct Cloud {
    points: Vec<Point>,
}

struct Point {
    place: Vector3<f64>,
    mass: f64,
    displacement: Vec<Vector3<f64>>,
    shortening: Vec<Vec<f64>>,
}

fn cloud(input: &BeamInput, beam: &Beam, cuts: usize) -> Cloud {
    let mut points = vec![];
    let mut add = |x: f64, mass: f64, spread: [f64; 3], tilts: bool| {
        let node = beam.node("here", x).expect("on the beam");
        let count = spread.iter().filter(|each| **each > 0.0).count();
        if count == 0 {
            let displacement = node.displacement.iter().map(|u| Vector3::from(*u)).collect();
            let place = Vector3::new(x, 0.0, 0.0);
            points.push(Point { place, mass, displacement, shortening: along_x(&node) });
            return;
        }
        for (axis, spread) in spread.into_iter().enumerate().filter(|(_, each)| *each > 0.0) {
            let part = mass / (2 * count) as f64;
            let distance = (spread / (2.0 * part)).sqrt();
            for side in [-1.0, 1.0] {
                let mut arm = Vector3::zeros();
                arm[axis] = side * distance;
                let moved = |(u, turn): (&[f64; 3], &[f64; 3])| {
                    let turn = if tilts { Vector3::from(*turn) } else { Vector3::new(turn[0], 0.0, 0.0) };
                    Vector3::from(*u) + turn.cross(&arm)
                };
                let displacement = node.displacement.iter().zip(&node.rotation).map(moved).collect();
                let place = Vector3::new(x, 0.0, 0.0) + arm;
                points.push(Point { place, mass: part, displacement, shortening: along_x(&node) });
            }
        }
    };
    let mut start = 0.0;
    for segment in &input.segments {
        let section = segment.section.properties(segment.material.poisson_ratio);
        let step = segment.length / cuts as f64;
        let density = segment.material.density * step;
        for cut in 0..cuts {
            let spread = [0.0, density * section.iz, density * section.iy];
            let x = start + (cut as f64 + 0.5) * step;
            add(x, density * section.area, spread, input.theory != Theory::EulerBernoulli);
        }
        start += segment.length;
    }
    for lump in &input.masses {
        let [x, y, z] = lump.inertia;
        add(lump.x, lump.mass, [(y + z - x) / 2.0, (z + x - y) / 2.0, (x + y - z) / 2.0], true);
    }
    Cloud { points }
}

fn along_x(node: &Node) -> Vec<Vec<f64>> {
    let table = node
        .displacement2
        .as_ref()
        .map(|table| table.iter().map(|row| row.iter().map(|entry| entry[0]).collect()).collect());
    table.unwrap_or_default()
}

fn assert_near(found: [[f64; 3]; 3], expected: Matrix3<f64>, scale: f64, tolerance: f64, what: &str) {
    for i in 0..3 {
        for j in 0..3 {
            let (found, expected) = (found[i][j], expected[(i, j)]);
            assert!((found - expected).abs() <= tolerance * scale, "{what} {i}{j}: {found} {expected}");
        }
    }
}

#[test]
fn constants_are_the_integrals_of_the_displacement_field() {
    for theory in [Theory::EulerBernoulli, Theory::Rayleigh, Theory::Timoshenko] {
        for hold in holds() {
            let input = rich(theory, hold);
            let beam = Beam::new(&input).expect("a sound beam");
            let data = beam.modal_data(&[]).expect("no nodes");
            let cloud = cloud(&input, &beam, 400);
            // Midpoint rule: (k step)²/24 with k = 3π/0.4 and step = 0.5 mm gives 6e-6 at most.
            let tolerance = 1e-5;
            compare(&data, &cloud, tolerance);
        }
    }
}

fn compare(data: &ModalData, cloud: &Cloud, tolerance: f64) {
    let sum = |value: &dyn Fn(&Point) -> Matrix3<f64>| -> Matrix3<f64> {
        cloud.points.iter().map(|point| point.mass * value(point)).sum()
    };
    let (mass, extent) = (data.mass, data.second_moment[0][0]);
    assert_near(data.second_moment, sum(&|at| at.place * at.place.transpose()), extent, tolerance, "P0");
    let second = data.second_order.as_ref().expect("asked for");
    for k in 0..data.mode_count() {
        let gamma = sum(&|at| Matrix3::from_columns(&[at.displacement[k]; 3]));
        let found = data.gamma[k].map(|each| [each; 3]);
        assert_near(found, gamma, mass.sqrt(), tolerance, "Gamma");
        let moment = sum(&|at| at.place * at.displacement[k].transpose());
        assert_near(data.moment[k], moment, extent.sqrt(), tolerance, "C");
        for l in 0..data.mode_count() {
            let coupling = sum(&|at| at.displacement[k] * at.displacement[l].transpose());
            assert_near(data.coupling[k][l], coupling, 1.0, tolerance, "N");
            let size = second.gamma[k][k][0].abs().max(second.gamma[l][l][0].abs()).max(1.0);
            let chi = sum(&|at| Matrix3::from_diagonal_element(at.shortening[k][l]))[(0, 0)];
            assert!((second.gamma[k][l][0] - chi).abs() < 10.0 * tolerance * size, "{k} {l} {chi}");
            let chi = sum(&|at| Matrix3::from_diagonal_element(at.place.x * at.shortening[k][l]))[(0, 0)];
            assert!((second.moment[k][l][0][0] - chi).abs() < 10.0 * tolerance * size, "{k} {l} {chi}");
        }
    }
}

#[test]
fn traces_of_the_coupling_are_the_modal_mass_exactly() {
    for theory in [Theory::EulerBernoulli, Theory::Rayleigh, Theory::Timoshenko] {
        for hold in holds() {
            let data = data(&rich(theory, hold));
            for k in 0..data.mode_count() {
                for l in 0..data.mode_count() {
                    let block = data.coupling[k][l];
                    // Three terms of at most 1: their sum rounds at 1e-16.
                    let trace = block[0][0] + block[1][1] + block[2][2];
                    assert!((trace - data.mass_matrix[k][l]).abs() <= 2.3e-16, "{k} {l} {block:?}");
                    assert_eq!(data.mass_matrix[k][l], if k == l { 1.0 } else { 0.0 });
                    assert!(k == l || data.stiffness[k][l] == 0.0);
                }
            }
        }
    }
}

#[test]
fn symmetry_leaves_exact_zeros() {
    let data = data(&rod(Theory::Timoshenko, Hold::Pinned(None), 6));
    let zero = |value: f64| value.to_bits() == 0.0_f64.to_bits();
    // Modes y1 z1 y2 z2 y3 z3: even ones have no net displacement, y-modes none along z.
    assert!(data.gamma[2].into_iter().chain(data.gamma[3]).all(zero), "{:?}", data.gamma);
    assert!(zero(data.gamma[0][2]) && zero(data.gamma[1][1]) && zero(data.gamma[0][0]));
    // Products of modes with different numbers of half waves vanish, those of one plane and another keep yz alone.
    for (k, l) in [(0, 2), (0, 3), (0, 4), (2, 4), (2, 5)] {
        assert!(data.coupling[k][l].as_flattened().iter().copied().all(zero), "{:?}", data.coupling[k][l]);
    }
    let block = data.coupling[0][1];
    assert!(block[1][2] > 0.99 && zero(block[2][1]) && zero(block[1][1]) && block[0][0] == 0.0);
    let euler = super::data(&rod(Theory::EulerBernoulli, Hold::Pinned(None), 6));
    assert_eq!(euler.coupling[0][0], [[0.0; 3], [0.0, 1.0, 0.0], [0.0; 3]]);
    // -rho I ∫ θ dx, the section's part of C_k, is the deflection's difference between the ends but for shear: 0.
    assert!(data.moment.iter().all(|c| zero(c[0][0]) && zero(c[1][1]) && zero(c[2][2])), "{:?}", data.moment);
}

#[test]
fn free_modes_carry_no_momentum() {
    let data = data(&rich(Theory::Timoshenko, Hold::Free));
    for k in 0..data.mode_count() {
        assert_eq!(data.gamma[k], [0.0; 3]);
        let c = data.moment[k];
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            assert_eq!(c[i][j], c[j][i], "{k} {c:?}");
        }
    }
}

fn section() -> impl Strategy<Value = Section> {
    prop_oneof![
        (0.002..0.02).prop_map(|radius| Section::Round { radius }),
        (0.004..0.02, 0.2..0.9).prop_map(|(outer, part)| Section::Tube { outer, inner: outer * part }),
        (0.002..0.02, 0.002..0.02).prop_map(|(y, z)| Section::Rectangle { y, z }),
    ]
}

fn any_beam() -> impl Strategy<Value = BeamInput> {
    let segments = prop::collection::vec((0.05..0.4, section()), 1..4);
    let mass = (0.0..1.0, 0.01..2.0, 0.0..1e-4);
    let masses = prop::collection::vec(mass, 0..3);
    (segments, masses, 0..3_usize, 0..5_usize, 0..7_usize).prop_map(
        |(segments, masses, theory, hold, bending)| {
            let segments: Vec<Segment> =
                segments.into_iter().map(|(length, of)| segment(length, of)).collect();
            let length: f64 = segments.iter().map(|segment| segment.length).sum();
            let at = |part: f64| Attachment { x: part * length, rotation: [true; 2] };
            BeamInput {
                segments,
                masses: masses
                    .into_iter()
                    .map(|(part, mass, spin)| ConcentratedMass { x: part * length, mass, inertia: [spin; 3] })
                    .collect(),
                theory: [Theory::EulerBernoulli, Theory::Rayleigh, Theory::Timoshenko][theory],
                hold: [
                    Hold::Pinned(None),
                    Hold::CANTILEVER,
                    Hold::Free,
                    Hold::CraigBampton(vec![at(0.0), at(0.4), at(1.0)]),
                    Hold::Clamped { at: 0.7 * length, far: Some(0.0) },
                ][hold]
                    .clone(),
                modes: Counts { bending, ..Counts::default() },
                damping_ratio: 0.02,
                second_order: false,
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_full_mass_matrix_of_any_beam_is_positive_definite(input in any_beam()) {
        let data = data(&input);
        let second = Matrix3::from_fn(|i, j| data.second_moment[i][j]);
        prop_assert!(second.symmetric_eigenvalues().min() >= 0.0);
        prop_assert_eq!(data.check(), Ok(()));
        prop_assert!(data.full_mass_matrix().cholesky().is_some(), "{data:?}");
    }

    #[test]
    fn frequencies_of_any_beam_do_not_depend_on_the_mesh(input in any_beam()) {
        let coarse = data(&input);
        let mut finer = input.clone();
        // Cutting every segment in three changes the mesh and nothing else.
        finer.segments = input.segments.iter().flat_map(|segment| {
            [Segment { length: segment.length / 3.0, ..*segment }; 3]
        }).collect();
        let fine = data(&finer);
        for (coarse, fine) in coarse.modes.iter().zip(&fine.modes) {
            // Rounding of dense eigenproblems, worst where concentrated masses spread the spectrum.
            prop_assert!((coarse.frequency / fine.frequency - 1.0).abs() < 1e-9, "{coarse:?} {fine:?}");
        }
    }
}
