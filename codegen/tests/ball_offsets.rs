//! Where a ball lies in its socket is told along the socket's own axes, which are the ground's at the reference pose, whichever way the
//! joint is written and the loop is cut.

mod simulated;

use linkwear_runtime::{Integrator, Settings, Span};
use simulated::{compiled, run_with};

/// A weight that hangs on an arm; the arm turns about an axis that has nothing to do with the ball.
fn hanging(joint: &str, bodies: [&str; 2], axis: [i8; 3], cut: bool) -> String {
    let (cut, own) =
        if cut { (", cut = true", "F = { free = [\"ground\", \"weight\"], at = \"C\" }") } else { ("", "") };
    let axes = if joint == "universal" { ", axes = [[1, 0, 0], [0, 1, 0]]" } else { "" };
    format!(
        "gravity = [\"1 m/s^2\", \"-2 m/s^2\", \"-7 m/s^2\"]
[points]
O = [0, 0, 0]
A = [\"100 mm\", 0, 0]
C = [\"120 mm\", \"-40 mm\", \"-140 mm\"]
[bodies]
arm = {{ mass = \"1 kg\", centre = \"O\", inertia = [\"1e-2 kg m^2\", \"1e-2 kg m^2\", \"1e-2 kg m^2\"] }}
weight = {{ mass = \"1 kg\", centre = \"C\", inertia = [\"1e-3 kg m^2\", \"2e-3 kg m^2\", \"3e-3 kg m^2\"] }}
[joints]
R = {{ revolute = [\"ground\", \"arm\"], at = \"O\", axis = {axis:?}, drive = \"1e-3 rad/s*t\" }}
S = {{ {joint} = {bodies:?}, at = \"A\"{axes}{cut} }}
{own}
[clearance.S]
radial = \"100 um\"
journal_radius = \"8 mm\"
modulus = \"115 GPa\"
"
    )
}

#[test]
fn a_ball_lies_where_its_socket_is_pressed() {
    for joint in ["spherical", "universal"] {
        for bodies in [["arm", "weight"], ["weight", "arm"]] {
            for axis in [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 0, -1], [1, -1, 2]] {
                for cut in [false, true] {
                    let text = hanging(joint, bodies, axis, cut);
                    let case = format!("{joint} of {bodies:?}, arm about {axis:?}, cut: {cut}");
                    let integrator = Integrator::adaptive(compiled(&text).description(), None);
                    let run = run_with(&text, &Settings::new(integrator, Span::Time(1e-5), 2));
                    let vector = |quantity: &str| {
                        ["x", "y", "z"]
                            .map(|axis| run.column(&format!("S.{quantity}{axis}")).expect(&case)[0])
                    };
                    let (offset, force) = (vector(""), vector("F"));
                    let length = |vector: [f64; 3]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
                    // The socket, the first body, pushes the ball back along its offset.
                    for (offset_part, force_part) in offset.iter().zip(force) {
                        let [offset, force] = [offset_part / length(offset), force_part / length(force)];
                        // What moves in 1e-5 s; offsets are 1e-4 of the places that they are the difference of.
                        assert!((offset + force).abs() < 1e-6, "{case}: {offset}, {force}");
                    }
                }
            }
        }
    }
}
