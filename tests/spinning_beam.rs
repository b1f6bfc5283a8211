//! A beam clamped on a turning hub: centrifugal stiffening. The linear floating frame misses it and turns soft instead,
//! its known failure; second-order terms have it.

mod support;
mod truth;

use std::f64::consts::PI;

use linkwear_codegen::Compiled;
use linkwear_codegen::flexible::{Beam, BeamInput, Counts, Hold, Material, Section, Segment, Theory};
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{Dual, Entry, Integrator, RunError, Settings, Span, System, Watch, simulate};
use support::{compile_source, run_with};
use truth::reached;

/// Rod of 1 m, 4 mm radius, 7850 kg/m3, 210 GPa: rho A = 0.394584, E I = 42.2230.
fn file(order: usize) -> SourceFile {
    let text = format!(
        r#"
spec = 1
name = "spinning"
gravity = [0, 0, 0]

[parameters]
Omega = {{ value = "1 rad/s", tunable = true }}

[points]
O = ["0 m", "0 m", "0 m"]
T = ["1 m", "0 m", "0 m"]

[bodies]
beam = {{ rod = ["O", "T"], radius = "4 mm", density = "7850 kg/m^3", flexible = {{ modes = 24, young = "210 GPa", theory = "euler_bernoulli", held = "clamped", order = {order} }} }}

[joints]
hub = {{ revolute = ["ground", "beam"], at = "O", axis = [0, 0, 1], drive = "Omega*t" }}
"#
    );
    SourceFile { name: "spinning.toml".into(), text }
}

/// Lowest eigenvalue of a symmetric matrix, by Jacobi's rotations.
fn lowest(mut a: Vec<Vec<f64>>) -> f64 {
    let n = a.len();
    for _ in 0..60 {
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q] == 0.0 {
                    continue;
                }
                let angle = 0.5 * f64::atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
                let (s, c) = angle.sin_cos();
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                let (upper, lower) = (a[p].clone(), a[q].clone());
                a[p] = upper.iter().zip(&lower).map(|(x, y)| c * x - s * y).collect();
                a[q] = upper.iter().zip(&lower).map(|(x, y)| s * x + c * y).collect();
            }
        }
    }
    (0..n).map(|i| a[i][i]).fold(f64::INFINITY, f64::min)
}

/// Squares of the lowest frequency parameters in the plane of rotation and across it, for a speed parameter.
fn squares(order: usize, speed: f64) -> [f64; 2] {
    let section = PI * 0.004_f64.powi(2);
    let scale = (210e9 * section * 0.004_f64.powi(2) / 4.0 / (7850.0 * section)).sqrt();
    let omega = (speed * scale).to_string() + " rad/s";
    let compiled = compile_source(&file(order), &[("Omega", &omega)], None);
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    let n = sizes.speeds;
    let columns: Vec<Vec<f64>> = (0..n)
        .map(|k| {
            let mut input: Vec<Dual<f64>> =
                compiled.parameters().iter().chain(&[0.0]).map(|x| Dual::new(*x, 0.0)).collect();
            input.extend((0..n).map(|i| Dual::new(0.0, f64::from(u8::from(i == k)))));
            input.resize(sizes.input(Entry::ForwardDynamics), Dual::new(0.0, 0.0));
            let mut output = vec![Dual::new(0.0, 0.0); sizes.output(Entry::ForwardDynamics)];
            let mut workspace = vec![Dual::new(0.0, 0.0); sizes.workspace];
            system.evaluate(Entry::ForwardDynamics, &input, &mut output, &mut workspace);
            output[..n].iter().map(|x| -x.derivative / (scale * scale)).collect()
        })
        .collect();
    // Modes come in pairs: in the plane of rotation, then across it.
    [0, 1].map(|plane| {
        let own: Vec<usize> = (plane..n).step_by(2).collect();
        lowest(own.iter().map(|i| own.iter().map(|j| columns[*j][*i]).collect()).collect())
    })
}

/// Wave numbers times length of uniform beams, by how they are held: pi n; roots of cos x cosh x = -1; roots of cos x cosh x = 1.
const WAVES: [(&str, Hold, [f64; 3]); 3] = [
    ("pinned", Hold::Pinned(None), [PI, 2.0 * PI, 3.0 * PI]),
    ("clamped", Hold::CANTILEVER, [1.875_104_068_711_961, 4.694_091_132_974_174, 7.854_757_438_237_613]),
    ("free", Hold::Free, [4.730_040_744_862_704, 7.853_204_624_095_838, 10.995_607_838_001_67]),
];

#[test]
fn beams_at_rest_have_the_frequencies_of_the_closed_forms() {
    let (length, radius, young, density) = (0.42, 0.006, 210e9, 7850.0);
    let material = Material { youngs_modulus: young, poisson_ratio: 0.3, density };
    for (name, hold, waves) in WAVES {
        let input = BeamInput {
            segments: vec![Segment { length, section: Section::Round { radius }, material }],
            masses: vec![],
            theory: Theory::EulerBernoulli,
            hold,
            modes: Counts { bending: 6, ..Counts::default() },
            damping_ratio: 0.0,
            second_order: false,
        };
        let modes = Beam::new(&input).and_then(|beam| beam.modal_data(&[])).expect("a sound beam").modes;
        let found = modes.iter().filter(|mode| mode.name.starts_with('y')).map(|mode| mode.frequency);
        // sqrt(E I / (rho A)), I / A = radius² / 4.
        let ratio = (young / density).sqrt() * radius / 2.0;
        let known = waves.map(|wave| (wave / length) * (wave / length) * ratio / (2.0 * PI));
        let error = found.zip(known).map(|(found, known)| (found / known - 1.0).abs()).fold(0.0, f64::max);
        // Rounding of a dense eigenproblem of some 40 unknowns leaves 1e-12.
        reached("beam, Euler-Bernoulli", &format!("{name}, first three frequencies, relative"), error, 1e-11);
    }
}

/// First flapping frequencies of a uniform cantilever at these speeds, both in units of sqrt(E I / (rho A L^4)): A. D.
/// Wright, C. E. Smith, R. W. Thresher, J. L. C. Wang, Vibration Modes of Centrifugally Stiffened Beams, J. Appl. Mech. 49
/// (1982) 197-202; the same in D. H. Hodges, M. J. Rutkowski, AIAA J. 19 (1981) 1459-1466.
const FLAPPING: [(f64, f64); 8] = [
    (0.0, 3.5160),
    (1.0, 3.6816),
    (2.0, 4.1373),
    (3.0, 4.7973),
    (4.0, 5.5850),
    (5.0, 6.4495),
    (6.0, 7.3604),
    (12.0, 13.1702),
];

#[test]
fn second_order_terms_stiffen_a_spinning_beam_as_published() {
    let [mut out_of_plane, mut in_plane] = [0.0_f64; 2];
    for (speed, expected) in FLAPPING {
        let [chordwise, flapping] = squares(2, speed);
        let known = expected * expected - speed * speed;
        out_of_plane = out_of_plane.max((flapping.sqrt() - expected).abs());
        in_plane = in_plane.max((chordwise - known).abs());
        // Half a unit of the printed digits, and a little for twelve modes.
        assert!((flapping.sqrt() - expected).abs() < 2e-4, "at {speed}: {} not {expected}", flapping.sqrt());
        // In the plane of rotation the frame takes the square of its speed away.
        assert!((chordwise - known).abs() < 4e-3, "at {speed}: {chordwise} not {known}");
    }
    reached("spinning cantilever", "flapping frequency, of sqrt(E I / rho A) / L²", out_of_plane, 2e-4);
    reached("spinning cantilever", "square of the chordwise frequency, of E I / rho A / L⁴", in_plane, 4e-3);
}

#[test]
fn a_linear_beam_turns_soft_and_gives_way_above_its_first_frequency() {
    for speed in [1.0, 3.0, 4.0, 6.0] {
        let [chordwise, flapping] = squares(1, speed);
        let wrong = 3.516_015 * 3.516_015 - speed * speed;
        // Printed digits of the frequency at rest.
        assert!((flapping - 3.516_015 * 3.516_015).abs() < 1e-4);
        assert!((chordwise - wrong).abs() < 1e-4, "at {speed}: {chordwise}");
    }
    assert!(squares(1, 4.0)[0] < 0.0);
}

/// T. R. Kane, R. R. Ryan, A. K. Banerjee, Dynamics of a Cantilever Beam Attached to a Moving Base, J. Guidance 10 (1987)
/// 139-151: a smooth spin-up to a speed above the first frequency, with the data of later papers on it (10 m, 6 rad/s).
fn spin_up(order: usize) -> (Compiled, Settings) {
    let text = format!(
        r#"
spec = 1
name = "spin_up"
gravity = [0, 0, 0]

[parameters]
Omega = "6 rad/s"
T = "15 s"

[points]
O = ["0 m", "0 m", "0 m"]
E = ["10 m", "0 m", "0 m"]

[bodies]
beam = {{ rod = ["O", "E"], radius = "12 mm", density = "3000 kg/m^3", flexible = {{ modes = 4, young = "70 GPa", theory = "euler_bernoulli", held = "clamped", order = {order}, stations = [1], section = {{ area = "4e-4 m^2", Iy = "2e-7 m^4", Iz = "2e-7 m^4" }} }} }}

[joints]
hub = {{ revolute = ["ground", "beam"], at = "O", axis = [0, 0, 1], drive = "Omega/T*(t^2/2 + (T/(2*pi))^2*(cos(2*pi*t/T) - 1))" }}
"#
    );
    let compiled = compile_source(&SourceFile { name: "spin_up.toml".into(), text }, &[], None);
    let integrator = Integrator::Dopri5 { tolerance: 1e-8, max_step: None };
    (compiled, Settings::new(integrator, Span::Time(15.0), 301))
}

#[test]
fn spin_up_bends_a_beam_back_and_lets_it_return() {
    let (compiled, settings) = spin_up(2);
    let tip = run_with(&compiled, &settings).column("beam.uy_1");
    let (largest, last) = (tip.iter().fold(0.0, |m: f64, x| m.max(x.abs())), tip[300].abs());
    // The published curves lag by a little more than half a metre halfway, and end in a small vibration.
    assert!(largest > 0.45 && largest < 0.65, "{largest} m");
    assert!(last < 0.02, "{last} m");
    // The linear beam gives way: it comes to bend by its length of 10 m, which ends the run.
    let (compiled, settings) = spin_up(1);
    let (system, parameters) = (compiled.interpreter(), compiled.parameters());
    let run =
        simulate(&system, compiled.description(), &parameters, &settings, Watch::NONE).expect("it starts");
    let told = matches!(&run.stopped, Some(RunError::BentTooFar { body, deflection, length, .. }) if body == "beam" && deflection > length);
    assert!(told, "{:?}", run.stopped);
}
