//! How beams are held: frames, order and signs of modes, Craig-Bampton.

use super::*;

fn names(data: &ModalData) -> Vec<&str> {
    data.modes.iter().map(|mode| mode.name.as_str()).collect()
}

#[test]
fn equal_planes_alternate_with_equal_bits() {
    for hold in [Hold::Pinned(None), Hold::CANTILEVER, Hold::Free] {
        let data = data(&rod(Theory::Timoshenko, hold, 6));
        assert_eq!(names(&data), ["y1", "z1", "y2", "z2", "y3", "z3"]);
        for pair in data.modes.chunks(2) {
            assert_eq!(pair[0].frequency.to_bits(), pair[1].frequency.to_bits());
        }
    }
}

#[test]
fn a_flat_section_bends_along_its_thin_side_first() {
    let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 4);
    input.segments = vec![segment(LENGTH, Section::Rectangle { y: 0.004, z: 0.020 })];
    let data = data(&input);
    // Frequencies of thin modes grow like n², five times lower than the wide ones: 1, 4, 5, 9.
    assert_eq!(names(&data), ["y1", "y2", "z1", "y3"]);
}

#[test]
fn no_modes_make_a_rigid_body() {
    let data = data(&rod(Theory::Timoshenko, Hold::Pinned(None), 0));
    assert!(data.modes.is_empty() && data.gamma.is_empty() && data.stiffness.is_empty());
    let mass = STEEL.density * std::f64::consts::PI * RADIUS * RADIUS * LENGTH;
    // A handful of products: rounding.
    assert_close(&[data.mass, data.first_moment[0]], &[mass, mass * LENGTH / 2.0], 1e-15);
    let second = [mass * LENGTH * LENGTH / 3.0, mass * RADIUS * RADIUS / 4.0];
    assert_close(&[data.second_moment[0][0], data.second_moment[2][2]], &second, 1e-14);
}

#[test]
fn two_runs_give_the_same_bits() {
    for hold in [Hold::Pinned(None), Hold::Free] {
        let mut input = rod(Theory::Timoshenko, hold, 6);
        input.second_order = true;
        let run = || Beam::new(&input).expect("a rod").modal_data(&[("middle", 0.21)]).expect("on the rod");
        let bits = |data: &ModalData| serde_json::to_string(data).expect("numbers");
        assert_eq!(bits(&run()), bits(&run()));
    }
}

#[test]
fn pinned_shapes_are_sines_that_rise_at_the_first_end() {
    let beam = Beam::new(&rod(Theory::Timoshenko, Hold::Pinned(None), 4)).expect("a rod");
    let node = |x: f64| beam.node("here", x).expect("on the rod");
    let start = node(0.0);
    for (k, axis, half_waves) in [(0, 1, 1.0), (1, 2, 1.0), (2, 1, 2.0), (3, 2, 2.0)] {
        assert_eq!(start.displacement[k], [0.0; 3]);
        assert_eq!(node(LENGTH).displacement[k], [0.0; 3]);
        let top = node(LENGTH / (2.0 * half_waves)).displacement[k][axis];
        assert!(top > 0.0);
        let wave = half_waves * std::f64::consts::PI / LENGTH;
        for x in [0.05, 0.13, 0.3] {
            // The shape is off by the square root of what the frequency is: 1e-8.
            let found = node(x).displacement[k][axis];
            assert!((found - top * (wave * x).sin()).abs() < 1e-8 * top, "{found}");
        }
    }
    // A slope along y turns about z, a slope along z about -y.
    assert!(start.rotation[0][2] > 0.0 && start.rotation[1][1] < 0.0);
    assert_eq!(start.rotation[0][2], -start.rotation[1][1]);
    // Half-way the second mode has a node of vibration, exactly.
    assert_eq!(node(LENGTH / 2.0).displacement[2], [0.0; 3]);
}

#[test]
fn static_deflection_follows_from_the_modes() {
    // A force at mid-span: F L³ / (48 E I) = sum of F φ² / omega².
    let mut input = rod(Theory::EulerBernoulli, Hold::Pinned(None), 40);
    input.modes.bending = 40;
    let beam = Beam::new(&input).expect("a rod");
    let data = beam.modal_data(&[("middle", LENGTH / 2.0)]).expect("on the rod");
    let node = &data.nodes[0];
    let sum: f64 = (0..40).map(|k| node.displacement[k][1].powi(2) / data.stiffness[k][k]).sum();
    let section = Section::Round { radius: RADIUS }.properties(0.3);
    let exact = LENGTH.powi(3) / (48.0 * STEEL.youngs_modulus * section.iz);
    // Odd modes fall like n⁻⁴; what lies beyond n = 20 is 96/π⁴ Σ n⁻⁴ = 2e-5.
    assert_close(&[sum], &[exact], 3e-5);
}

#[test]
fn bending_stress_is_moment_over_section_modulus() {
    // A cantilever with a tip force F: sum of φ_k(L)/omega² curvature gives M = F L at the root.
    let mut input = rod(Theory::EulerBernoulli, Hold::CANTILEVER, 40);
    input.damping_ratio = 0.0;
    let beam = Beam::new(&input).expect("a rod");
    let data = beam.modal_data(&[("root", 0.0), ("tip", LENGTH), ("middle", LENGTH / 2.0)]).expect("nodes");
    let tip = data.node("tip").expect("there");
    let q: Vec<f64> = (0..40).map(|k| tip.displacement[k][1] / data.stiffness[k][k]).collect();
    let section = Section::Round { radius: RADIUS }.properties(0.3);
    let middle = data.node("middle").expect("there").strain.as_ref().expect("a known section");
    let exact = LENGTH / 2.0 * RADIUS / section.iz;
    // The series of the moment converges slowly (n⁻²) and alternates: 20 modes leave a thousandth.
    assert_close(&[middle.largest_stress(&q)], &[exact], 2e-3);
}

#[test]
fn at_a_step_the_thinner_side_is_the_more_stressed() {
    let mut input = rod(Theory::Timoshenko, Hold::Pinned(None), 2);
    input.segments = [0.006, 0.004, 0.006].map(|radius| segment(0.14, Section::Round { radius })).to_vec();
    let beam = Beam::new(&input).expect("a stepped rod");
    for x in [0.14, 0.28] {
        let strain = beam.node("step", x).expect("on the rod").strain.expect("a known section");
        assert_eq!(strain.outline, Outline::Round { radius: 0.004 });
    }
}

#[test]
fn a_rod_clamped_at_its_second_end_is_the_other_way_round() {
    let of = |hold| {
        let mut input = rod(Theory::Timoshenko, hold, 4);
        (input.modes.axial, input.modes.torsion) = (1, 1);
        data(&input)
    };
    let [first, second] =
        [(0.0, LENGTH), (LENGTH, 0.0)].map(|(at, far)| of(Hold::Clamped { at, far: Some(far) }));
    let frequencies = |data: &ModalData| data.modes.iter().map(|mode| mode.frequency).collect::<Vec<_>>();
    // Rounding of a dense eigenproblem.
    assert_close(&frequencies(&first), &frequencies(&second), 1e-10);
    // Axial: the static stretch, sqrt(3 E / rho) / L in place of pi/2 of the free end.
    let stretch = (3.0 * STEEL.youngs_modulus / STEEL.density).sqrt() / LENGTH / (2.0 * std::f64::consts::PI);
    let axial = first.modes.iter().find(|mode| mode.name == "x1").expect("asked for");
    assert_close(&[axial.frequency], &[stretch], 1e-10);
}

fn craig_bampton(modes: usize, rotation: bool) -> BeamInput {
    let at = |x, rotation| Attachment { x, rotation: [rotation; 2] };
    let hold = Hold::CraigBampton(vec![at(0.0, false), at(0.15, rotation), at(LENGTH, false)]);
    rod(Theory::Timoshenko, hold, modes)
}

#[test]
fn craig_bampton_converges_to_the_full_modes() {
    let exact = frequencies(&rod(Theory::Timoshenko, Hold::Pinned(None), 6), 'y');
    for rotation in [false, true] {
        let errors = [4, 8, 16].map(|modes| {
            let found = frequencies(&craig_bampton(modes, rotation), 'y');
            assert_eq!(found.len(), modes / 2 + 1 + usize::from(rotation));
            // From above: the reduced space is part of the whole; 1e-12 is rounding.
            assert!(found.iter().zip(&exact).all(|(found, exact)| *found > exact * (1.0 - 1e-12)));
            found[0] / exact[0] - 1.0
        });
        // Shear jumps at the attachment in the fixed-interface modes and not in the full ones: n⁻⁴, with 9 shapes 1e-5.
        assert!(errors[1] < errors[0] / 8.0 && errors[2] < errors[1] / 8.0, "{errors:?}");
        assert!(errors[2] < 1e-5, "{errors:?}");
    }
}

#[test]
fn craig_bampton_takes_a_static_load_on_an_attachment_exactly() {
    let input = craig_bampton(2, false);
    let beam = Beam::new(&input).expect("a rod");
    let data = beam.modal_data(&[("attached", 0.15)]).expect("on the rod");
    let shape = &data.nodes[0].displacement;
    let sum: f64 = (0..data.mode_count()).map(|k| shape[k][1].powi(2) / data.stiffness[k][k]).sum();
    let section = Section::Round { radius: RADIUS }.properties(0.3);
    let (a, b) = (0.15, LENGTH - 0.15);
    let shear = section.shear.expect("round")[0] * STEEL.youngs_modulus / 2.6 * section.area;
    let exact = a * a * b * b / (3.0 * STEEL.youngs_modulus * section.iz * LENGTH) + a * b / (LENGTH * shear);
    // The static shape is in the basis: rounding of small dense systems.
    assert_close(&[sum], &[exact], 1e-11);
}

#[test]
fn wrong_beams_are_refused() {
    let sound = rod(Theory::Timoshenko, Hold::Pinned(None), 2);
    let wrong = |change: &dyn Fn(&mut BeamInput)| {
        let mut input = sound.clone();
        change(&mut input);
        Beam::new(&input).map(|_| ()).expect_err("refused")
    };
    assert_eq!(wrong(&|input| input.segments.clear()), BeamError::NoSegment);
    let negative = wrong(&|input| input.segments[0].length = -1.0);
    assert_eq!(negative, BeamError::NotPositive { what: "length", segment: 0, value: -1.0 });
    assert_eq!(wrong(&|input| input.hold = Hold::Pinned(Some([0.2, 0.2]))), BeamError::HeldTogether);
    assert_eq!(wrong(&|input| input.hold = Hold::CraigBampton(vec![])), BeamError::NoChord);
    assert_eq!(
        wrong(&|input| input.hold = Hold::Clamped { at: 0.2, far: Some(0.2) }),
        BeamError::HeldTogether
    );
    let outside = wrong(&|input| input.hold = Hold::Clamped { at: 0.5, far: None });
    assert_eq!(outside, BeamError::Outside { x: 0.5, length: LENGTH });
    let outside = wrong(&|input| input.hold = Hold::Pinned(Some([0.2, 0.5])));
    assert_eq!(outside, BeamError::Outside { x: 0.5, length: LENGTH });
    let heavy = |input: &mut BeamInput| {
        input.masses = vec![ConcentratedMass { x: 0.1, mass: 1.0, inertia: [1.0, 0.1, 0.1] }];
    };
    assert_eq!(wrong(&heavy), BeamError::ConcentratedMass { index: 0 });
    let bare = |input: &mut BeamInput| {
        let mut section = Section::Round { radius: RADIUS }.properties(0.3);
        section.shear = None;
        input.segments[0].section = Section::General(section);
    };
    assert_eq!(wrong(&bare), BeamError::NoShearCoefficient { segment: 0 });
    assert!(matches!(wrong(&|input| input.modes.bending = 41), BeamError::TooManyModes { .. }));
    assert!(matches!(wrong(&|input| input.damping_ratio = f64::NAN), BeamError::DampingRatio { .. }));
}
