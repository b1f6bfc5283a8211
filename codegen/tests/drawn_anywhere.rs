//! A drawing that is turned as a whole, or that holds a pin where its bush turns, is the same machine.

mod simulated;

use std::f64::consts::PI;

use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{compiled, run_with};

/// Turns a vector about an axis by an angle [rad], by Rodrigues.
fn turned(vector: [f64; 3], (axis, angle): ([f64; 3], f64)) -> [f64; 3] {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [a, b, c] = axis.map(|x| x / length);
    let [x, y, z] = vector;
    let along = a * x + b * y + c * z;
    let (sin, cos) = angle.sin_cos();
    let cross = [b * z - c * y, c * x - a * z, a * y - b * x];
    std::array::from_fn(|i| cos * vector[i] + sin * cross[i] + (1.0 - cos) * along * [a, b, c][i])
}

/// A slider-crank in the plane whose piston has play in its bore, turned in space with its gravity and its load.
fn slider_crank(turn: ([f64; 3], f64)) -> String {
    let triple = |vector: [f64; 3], unit: &str| {
        let [x, y, z] = turned(vector, turn);
        format!("[\"{x} {unit}\", \"{y} {unit}\", \"{z} {unit}\"]")
    };
    let direction = |vector: [f64; 3]| {
        let [x, y, z] = turned(vector, turn);
        format!("[{x}, {y}, {z}]")
    };
    let (crank, rod) = (0.06, 0.2_f64);
    let angle = 50.0_f64.to_radians();
    let pin = [crank * angle.cos(), crank * angle.sin(), 0.0];
    let end = pin[0] + (rod * rod - pin[1] * pin[1]).sqrt();
    format!(
        "gravity = {gravity}
[points]
O = [0, 0, 0]
A = {a}
B = {b}
[bodies]
crank = {{ rod = [\"O\", \"A\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }}
rod = {{ rod = [\"A\", \"B\"], radius = \"7 mm\", density = \"7850 kg/m^3\" }}
piston = {{ mass = \"1.2 kg\", centre = \"B\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}
wheel = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"1e-3 kg m^2\", \"1e-3 kg m^2\", \"1e-3 kg m^2\"] }}
[joints]
J0 = {{ revolute = [\"ground\", \"wheel\"], at = \"O\", axis = {slanted} }}
J1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = {z}, drive = \"2*pi*3 Hz*t\" }}
J2 = {{ revolute = [\"crank\", \"rod\"], at = \"A\", axis = {z} }}
J3 = {{ revolute = [\"rod\", \"piston\"], at = \"B\", axis = {z} }}
J4 = {{ prismatic = [\"ground\", \"piston\"], at = \"B\", axis = {x}, damping = \"20 N s/m\" }}
[forces]
gas = {{ force = \"piston\", at = \"B\", components = {load} }}
[clearance.J4]
radial = \"25 um\"
journal_radius = \"20 mm\"
length = \"50 mm\"
ends = \"journal\"
modulus = \"60 GPa\"
restitution = 0.5
friction = 0.05
[wear.J4]
coefficient = 1e-7
hardness = \"1 GPa\"
threshold = \"40 um\"
",
        gravity = triple([0.0, -9.81, 0.0], "m/s^2"),
        a = triple(pin, "m"),
        b = triple([end, 0.0, 0.0], "m"),
        z = direction([0.0, 0.0, 1.0]),
        x = direction([1.0, 0.0, 0.0]),
        // A hinge across the guide that has nothing to do with it.
        slanted = direction([0.0, 0.6, 0.8]),
        load = triple([-300.0, 0.0, 0.0], "N"),
    )
}

/// Wear integral of every contact in the second turn [J].
fn worn(text: &str, tolerance: f64) -> Vec<f64> {
    let integrator = Integrator::adaptive(compiled(text).description(), Some(tolerance));
    let run = run_with(text, &Settings::new(integrator, Span::Turns(2.0), 11));
    run.turns[1].iter().map(|turn| turn.wear_integral).collect()
}

#[test]
fn a_planar_mechanism_with_a_loose_guide_may_be_drawn_in_any_direction() {
    let straight = worn(&slider_crank(([0.0, 0.0, 1.0], 0.0)), 1e-9);
    assert_eq!(straight.len(), 2);
    for turn in [
        ([1.0, 0.0, 0.0], 30.0_f64.to_radians()),
        ([0.0, 0.0, 1.0], 0.01),
        ([1.0, -2.0, 0.5], 2.3),
        ([0.3, 0.4, -1.0], -1.1),
    ] {
        for (found, expected) in worn(&slider_crank(turn), 1e-9).iter().zip(&straight) {
            // Steps of 1e-9 through impacts, which multiply what rounding tells apart.
            assert!((found - expected).abs() < 1e-5 * expected, "{turn:?}: {found}, not {expected}");
        }
    }
}

/// Vectors with a unit and directions of a drawing that is turned in space.
struct Turned(([f64; 3], f64));

impl Turned {
    fn vector(&self, vector: [f64; 3], unit: &str) -> String {
        let [x, y, z] = turned(vector, self.0);
        format!("[\"{x} {unit}\", \"{y} {unit}\", \"{z} {unit}\"]")
    }

    fn direction(&self, vector: [f64; 3]) -> String {
        let [x, y, z] = turned(vector, self.0);
        format!("[{x}, {y}, {z}]")
    }
}

const ANYWHERE: [([f64; 3], f64); 3] =
    [([1.0, -2.0, 0.5], 2.3), ([0.3, 0.4, -1.0], -1.1), ([0.2, 0.9, 0.1], 0.4)];

/// A plane four-bar with play in both pins of its coupler, so that no row of its loop lies in its plane.
fn loose_four_bar(turn: ([f64; 3], f64)) -> String {
    let turn = Turned(turn);
    let [a, b, d] =
        [[0.06, 0.08, 0.0], [0.31, 0.21, 0.0], [0.3, 0.0, 0.0]].map(|place| turn.vector(place, "m"));
    let play = "radial = \"20 um\"\njournal_radius = \"8 mm\"\nlength = \"20 mm\"\nmodulus = \"80 GPa\"\nrestitution = 0.8";
    format!(
        "gravity = {gravity}
[points]
O = [0, 0, 0]
A = {a}
B = {b}
D = {d}
[bodies]
crank = {{ rod = [\"O\", \"A\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }}
coupler = {{ rod = [\"A\", \"B\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }}
rocker = {{ rod = [\"D\", \"B\"], radius = \"8 mm\", density = \"7850 kg/m^3\" }}
[joints]
R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = {z}, drive = \"2*pi*2 Hz*t\" }}
R2 = {{ revolute = [\"crank\", \"coupler\"], at = \"A\", axis = {z} }}
R3 = {{ revolute = [\"coupler\", \"rocker\"], at = \"B\", axis = {z}, cut = true }}
R4 = {{ revolute = [\"ground\", \"rocker\"], at = \"D\", axis = {z}, damping = \"0.05 N m s\" }}
[clearance.R2]
{play}
[clearance.R3]
{play}
",
        gravity = turn.vector([0.0, -9.81, 0.0], "m/s^2"),
        z = turn.direction([0.0, 0.0, 1.0]),
    )
}

#[test]
fn rows_that_nothing_moves_are_none_wherever_a_plane_loop_is_drawn() {
    let forces = |text: &str| {
        let integrator = Integrator::adaptive(compiled(text).description(), Some(1e-9));
        let run = run_with(text, &Settings::new(integrator, Span::Time(0.02), 21));
        ["R2.Fn", "R3.Fn"].map(|name| run.column(name).expect(name))
    };
    let straight = forces(&loose_four_bar(([0.0, 0.0, 1.0], 0.0)));
    let largest = straight.iter().flatten().copied().fold(0.0, f64::max);
    for turn in ANYWHERE {
        let text = loose_four_bar(turn);
        let analysis = compiled(&text).analysis;
        assert_eq!((analysis.independent_rows, analysis.mobility), (0, 5), "{turn:?}");
        for (found, expected) in forces(&text).iter().flatten().zip(straight.iter().flatten()) {
            // Stiff contacts of 1e-6 of their force, by steps of 1e-9.
            assert!((found - expected).abs() < 1e-5 * largest, "{turn:?}: {found}, not {expected}");
        }
    }
}

#[test]
fn a_linkage_closes_beside_a_joint_that_is_far_away() {
    for turn in ANYWHERE {
        let turned = Turned(turn);
        let [a, p, q] = [0.04, 0.2, 9.0].map(|along| turned.vector([along, 0.0, 0.0], "m"));
        let (x, z) = (turned.direction([1.0, 0.0, 0.0]), turned.direction([0.0, 0.0, 1.0]));
        let text = format!(
            "gravity = {gravity}
[points]
O = [0, 0, 0]
A = {a}
P = {p}
Q = {q}
[bodies]
arm = {{ rod = [\"O\", \"A\"], radius = \"12 mm\", density = \"7850 kg/m^3\" }}
rod = {{ rod = [\"A\", \"P\"], radius = \"10 mm\", density = \"7850 kg/m^3\" }}
piston = {{ mass = \"1.2 kg\", centre = \"P\" }}
wheel = {{ mass = \"1 kg\", centre = \"Q\", inertia = [\"1e-2 kg m^2\", \"1e-2 kg m^2\", \"1e-2 kg m^2\"] }}
[joints]
R1 = {{ revolute = [\"ground\", \"arm\"], at = \"O\", axis = {z}, drive = \"2*pi*5 Hz*t\" }}
R2 = {{ revolute = [\"arm\", \"rod\"], at = \"A\", axis = {z} }}
R3 = {{ revolute = [\"rod\", \"piston\"], at = \"P\", axis = {z} }}
P4 = {{ prismatic = [\"ground\", \"piston\"], at = \"P\", axis = {x} }}
R5 = {{ revolute = [\"ground\", \"wheel\"], at = \"Q\", axis = {z}, damping = \"0.1 N m s\" }}
",
            gravity = turned.vector([0.0, -9.81, 0.0], "m/s^2"),
        );
        assert_eq!(compiled(&text).analysis.mobility, 2, "{turn:?}");
    }
}

/// A Geneva drive whose plane is level: nothing turns it, so that forces on its joints are rounding.
fn geneva(turn: ([f64; 3], f64)) -> String {
    let turn = Turned(turn);
    let reach = 0.04 * 0.5_f64.sqrt();
    format!(
        "gravity = {gravity}
[points]
O = [0, 0, 0]
C = {c}
P = {p}
[bodies]
crank = {{ rod = [\"O\", \"P\"], radius = \"4 mm\", density = \"7850 kg/m^3\" }}
wheel = {{ mass = \"0.4 kg\", centre = \"C\", inertia = [\"1e-4 kg m^2\", \"1e-4 kg m^2\", \"1e-4 kg m^2\"] }}
[joints]
R1 = {{ revolute = [\"ground\", \"crank\"], at = \"O\", axis = {z}, drive = \"2*pi*1 Hz*t\" }}
R2 = {{ revolute = [\"ground\", \"wheel\"], at = \"C\", axis = {z} }}
pin = {{ slot = [\"wheel\", \"crank\"], at = \"P\", axis = {z}, first = {first} }}
",
        gravity = turn.vector([0.0, 0.0, -9.81], "m/s^2"),
        c = turn.vector([2.0 * reach, 0.0, 0.0], "m"),
        p = turn.vector([reach, -reach, 0.0], "m"),
        z = turn.direction([0.0, 0.0, 1.0]),
        first = turn.direction([1.0, 1.0, 0.0]),
    )
}

#[test]
fn rounding_of_forces_is_no_jump_where_an_angle_passes_half_a_turn() {
    for turn in ANYWHERE {
        let text = geneva(turn);
        assert_eq!(compiled(&text).warnings, [], "{turn:?}");
        let integrator = Integrator::Dopri5 { tolerance: 1e-9, max_step: None };
        // The angle of the pin in its slot passes half a turn after a quarter of a second.
        let run = run_with(&text, &Settings::new(integrator, Span::Time(0.3), 11));
        assert!(run.column("pin.q2").expect("pin.q2").iter().any(|angle| *angle > PI), "{turn:?}");
    }
}

/// A socket that turns about a horizontal axis, on a ball or a pin of a weight that only a vertical guide lets move.
fn guided(joint: &str, more: &str) -> String {
    format!(
        "gravity = [0, 0, \"-9.81 m/s^2\"]
[points]
O = [0, 0, 0]
[bodies]
weight = {{ mass = \"50 kg\", centre = \"O\", inertia = [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }}
socket = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"0.02 kg m^2\", \"0.02 kg m^2\", \"0.02 kg m^2\"] }}
[joints]
D = {{ revolute = [\"ground\", \"socket\"], at = \"O\", axis = [0, 1, 0], drive = \"2*pi*2 Hz*t\" }}
C = {{ {joint} = [\"socket\", \"weight\"], at = \"O\"{more} }}
K = {{ prismatic = [\"ground\", \"weight\"], axis = [0, 0, 1], at = \"O\" }}
[clearance.C]
radial = \"20 um\"
journal_radius = \"10 mm\"
length = \"20 mm\"
modulus = \"100 GPa\"
restitution = 0.5
friction = 0.0001
[wear.C]
coefficient = 1e-7
hardness = \"1 GPa\"
threshold = \"50 um\"
"
    )
}

#[test]
fn a_bush_turns_about_a_pin_that_a_guide_holds() {
    for (joint, more) in [("spherical", ""), ("revolute", ", axis = [0, 1, 0]")] {
        let found = worn(&guided(joint, more), 1e-6);
        // The weight, along the inside of the socket.
        let expected = 50.0 * 9.81 * 2.0 * PI * (10e-3 + 20e-6);
        // The weight bounces on the stiff contact for a while: parts of 1e-4 in the second turn.
        assert!((found[0] - expected).abs() < 3e-4 * expected, "{joint}: {found:?}, not {expected}");
    }
}

/// Directions across an axis that is drawn askew are at right angles but for rounding. What is left of their product times a mass is zero or
/// is not by the digits of that mass.
#[test]
fn equations_of_a_loose_joint_that_is_drawn_askew_have_one_form_whatever_the_mass() {
    for axis in ["1, 2, 3", "0.36, 0.48, 0.8", "0.2, 0.7, 0.1"] {
        let operations = |mass: f64| {
            let rotor = compiled(&format!(
                "gravity = [0, \"-9.81 m/s^2\", 0]
[points]
O = [0, 0, 0]
Q = [\"60 mm\", \"20 mm\", \"10 mm\"]
[bodies]
rotor = {{ mass = \"{mass} kg\", centre = \"Q\", inertia = [\"5e-3 kg m^2\", \"5e-3 kg m^2\", \"9e-3 kg m^2\"] }}
[joints]
R1 = {{ revolute = [\"ground\", \"rotor\"], at = \"O\", axis = [{axis}], drive = \"12 rad/s*t\" }}
[clearance.R1]
radial = \"50 um\"
journal_radius = \"10 mm\"
length = \"20 mm\"
modulus = \"50 GPa\"
"
            ));
            rotor.operations().iter().map(|count| count.operations.total).collect::<Vec<_>>()
        };
        let first = operations(2.9);
        for step in 1..12 {
            let mass = 2.9 + 0.037 * f64::from(step);
            assert_eq!(operations(mass), first, "{mass} kg about [{axis}]");
        }
    }
}
