//! What a contact force does to the coordinates, [CS (7), (8)]: generalised forces of the generated equations against
//! the velocities of the contact point on both bodies, differentiated from positions of points by dual numbers.

mod support;

use linkwear_codegen::backend::interp::Interpreted;
use linkwear_codegen::compile::Compiled;
use linkwear_codegen::source::SourceFile;
use linkwear_runtime::{CONTACT_MOTION, Dual, Entry, System};
use support::random::Random;
use support::{compile_source, evaluate};

/// Both sides are exact; a few hundred operations on numbers of order one round to this.
const ROUNDING: f64 = 1e-12;
/// Radius of the journal [m].
const RADIUS: f64 = 0.05;

type Vec3 = [f64; 3];

/// Two bars, `a` hung from the ground; `joint` connects them. Four points on each show its whole motion.
fn bars(joint: &str, further: &str) -> Compiled {
    let text = format!(
        r#"
spec = 1
name = "bars"
[points]
O = ["0 m", "0 m", "0 m"]
A = ["0.7 m", "0.2 m", "-0.1 m"]
C = ["0.9 m", "-0.5 m", "0.3 m"]
a0 = {{ at = ["0.7 m", "0.2 m", "-0.1 m"], on = "a" }}
a1 = {{ at = ["1.7 m", "0.2 m", "-0.1 m"], on = "a" }}
a2 = {{ at = ["0.7 m", "1.2 m", "-0.1 m"], on = "a" }}
a3 = {{ at = ["0.7 m", "0.2 m", "0.9 m"], on = "a" }}
b0 = {{ at = ["0.7 m", "0.2 m", "-0.1 m"], on = "b" }}
b1 = {{ at = ["1.7 m", "0.2 m", "-0.1 m"], on = "b" }}
b2 = {{ at = ["0.7 m", "1.2 m", "-0.1 m"], on = "b" }}
b3 = {{ at = ["0.7 m", "0.2 m", "0.9 m"], on = "b" }}
[bodies]
a = {{ rod = ["O", "A"], radius = "20 mm", density = "7850 kg/m^3" }}
b = {{ rod = ["A", "C"], radius = "20 mm", density = "7850 kg/m^3" }}
[joints]
G = {{ spherical = ["ground", "a"], at = "O" }}
J = {{ {joint} }}
{further}
[clearance.J]
radial = "10 mm"
journal_radius = "50 mm"
length = "20 mm"
modulus = "100 GPa"
restitution = 0.9
"#
    );
    compile_source(&SourceFile { name: "bars.toml".to_owned(), text }, &[], None)
}

/// Origin and axes (rows) of a body, `a0`..`a3` or `b0`..`b3`, and their rates along a motion.
struct Pose {
    origin: [Dual<f64>; 3],
    axes: [[Dual<f64>; 3]; 3],
}

impl Pose {
    fn new(compiled: &Compiled, body: char, values: &[Dual<f64>]) -> Self {
        let point = |index: usize| {
            ["x", "y", "z"].map(|axis| {
                let name = format!("{body}{index}.{axis}");
                let channels = &compiled.description().channels;
                values[channels.iter().position(|channel| channel.name == name).expect("a point")]
            })
        };
        let origin = point(0);
        Self { origin, axes: [1, 2, 3].map(|index| difference(point(index), origin)) }
    }

    /// Velocity of the body's point that is now at `place`.
    fn velocity(&self, place: Vec3) -> Vec3 {
        let from_origin: Vec3 = std::array::from_fn(|i| place[i] - self.origin[i].value);
        let local = self.axes.map(|axis| dot(axis.map(|x| x.value), from_origin));
        std::array::from_fn(|i| {
            self.origin[i].derivative + (0..3).map(|k| local[k] * self.axes[k][i].derivative).sum::<f64>()
        })
    }

    /// A vector in the body's axes as one in the ground's.
    fn out(&self, local: Vec3) -> Vec3 {
        std::array::from_fn(|i| (0..3).map(|k| local[k] * self.axes[k][i].value).sum())
    }
}

fn difference(a: [Dual<f64>; 3], b: [Dual<f64>; 3]) -> [Dual<f64>; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Generalised forces of a wrench: what it takes from h.
fn generalised(system: &Interpreted, q: &[f64], v: &[f64], wrench: [f64; 6]) -> Vec<f64> {
    let sizes = System::<f64>::sizes(system);
    let n = sizes.all_speeds;
    let h = |wrench: [f64; 6]| {
        let output = evaluate(system, Entry::EquationsOfMotion, &[&[0.0][..], q, v, &wrench].concat());
        output[n * (n + 1) / 2..][..n].to_vec()
    };
    h([0.0; 6]).iter().zip(h(wrench)).map(|(without, with)| without - with).collect()
}

/// Poses of both bodies, moving along speed `direction`.
fn poses(compiled: &Compiled, system: &Interpreted, q: &[f64], direction: usize) -> [Pose; 2] {
    let sizes = System::<f64>::sizes(system);
    let mut v = vec![0.0; sizes.speeds];
    v[direction] = 1.0;
    let state = [&[0.0][..], q, &v].concat();
    let q_dot = &evaluate(system, Entry::Rates, &state)[..sizes.coordinates];
    let mut input = vec![Dual::new(0.0, 0.0); sizes.input(Entry::Observe)];
    for (index, (value, rate)) in q.iter().zip(q_dot).enumerate() {
        input[1 + index] = Dual::new(*value, *rate);
    }
    let values = evaluate(system, Entry::Observe, &input);
    ['a', 'b'].map(|body| Pose::new(compiled, body, &values))
}

/// Random coordinates, and what contacts see of the offset there.
fn random_state(compiled: &Compiled, system: &Interpreted, random: &mut Random) -> (Vec<f64>, Vec3) {
    let sizes = System::<f64>::sizes(system);
    let mut q: Vec<f64> = (0..sizes.coordinates).map(|_| random.next()).collect();
    for first in compiled.description().quaternions.iter() {
        let norm = length(&q[*first..first + 4]);
        q[*first..first + 4].iter_mut().for_each(|x| *x /= norm);
    }
    let motion = evaluate(system, Entry::Contacts, &[&[0.0][..], &q, &vec![0.0; sizes.speeds]].concat());
    assert_eq!(motion.len(), CONTACT_MOTION + sizes.held);
    (q, [motion[0], motion[1], motion[2]])
}

/// Bearing and journal at coordinates, moving along one speed. `first`: body that the joint lists first.
fn sides(compiled: &Compiled, system: &Interpreted, first: char, q: &[f64], direction: usize) -> [Pose; 2] {
    let [a, b] = poses(compiled, system, q, direction);
    if first == 'a' { [a, b] } else { [b, a] }
}

/// From the bearing's centre to the journal's, in the bearing's axes.
fn distance([bearing, journal]: &[Pose; 2]) -> Vec3 {
    let distance = difference(journal.origin, bearing.origin).map(|x| x.value);
    bearing.axes.map(|axis| dot(axis.map(|x| x.value), distance))
}

/// Axes from two directions.
fn triad(first: Vec3, second: Vec3) -> [Vec3; 3] {
    let unit = |v: Vec3| v.map(|x| x / length(&v));
    let (x, z) = (unit(first), unit(cross(first, second)));
    [x, cross(z, x), z]
}

/// The frame in which contacts express their vectors, as axes in the bearing's. For a revolute joint about z the two
/// agree; a socket has no directions of its own, its frame is any that is fixed in the body: found from two states.
fn contact_frame(compiled: &Compiled, system: &Interpreted, first: char, ball: bool) -> [Vec3; 3] {
    if !ball {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut state = || {
        let (q, offset) = random_state(compiled, system, &mut random);
        (offset, distance(&sides(compiled, system, first, &q, 0)))
    };
    let ((seen, there), (seen_2, there_2)) = (state(), state());
    let (seen, there) = (triad(seen, seen_2), triad(there, there_2));
    std::array::from_fn(|axis| std::array::from_fn(|i| (0..3).map(|k| seen[k][axis] * there[k][i]).sum()))
}

/// `first`: body that the joint lists first, the bearing or socket.
fn check(compiled: &Compiled, first: char, ball: bool) {
    let system = compiled.interpreter();
    let sizes = System::<f64>::sizes(&system);
    assert_eq!((sizes.contacts, sizes.drivers, sizes.parameters), (1, 0, 0));
    let frame = contact_frame(compiled, &system, first, ball);
    let into_bearing =
        |v: Vec3| -> Vec3 { std::array::from_fn(|i| (0..3).map(|k| frame[k][i] * v[k]).sum()) };
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    for _ in 0..5 {
        let (q, offset) = random_state(compiled, &system, &mut random);
        let normal = offset.map(|x| x / length(&offset));
        // A journal slides along its axis in no contact.
        let along_axis = if ball { random.next() } else { 0.0 };
        let force = [random.next(), random.next(), along_axis];
        let moment = cross(normal, force).map(|x| RADIUS * x);
        let wrench = [force[0], force[1], force[2], moment[0], moment[1], moment[2]];
        // At rest, so that h holds no differences of large numbers.
        let ours = generalised(&system, &q, &vec![0.0; sizes.speeds], wrench);
        for (direction, ours) in ours.iter().enumerate() {
            let both = sides(compiled, &system, first, &q, direction);
            let (seen, there) = (into_bearing(offset), distance(&both));
            let shown = if ball { 3 } else { 2 };
            assert!((0..shown).all(|i| (seen[i] - there[i]).abs() < ROUNDING), "{seen:?} against {there:?}");
            let [bearing, journal] = both;
            let out = bearing.out(into_bearing(normal));
            let place = std::array::from_fn(|k| journal.origin[k].value + RADIUS * out[k]);
            let (on_journal, on_bearing) = (journal.velocity(place), bearing.velocity(place));
            let relative = std::array::from_fn(|k| on_journal[k] - on_bearing[k]);
            let power = dot(bearing.out(into_bearing(force)), relative);
            assert!((ours - power).abs() < ROUNDING, "speed {direction}: {ours} against {power}");
        }
    }
}

#[test]
fn a_journal_in_the_tree_feels_the_force_at_its_contact() {
    check(&bars("revolute = [\"a\", \"b\"], at = \"A\", axis = [0, 0, 1]", ""), 'a', false);
}

#[test]
fn a_journal_written_first_of_the_tree_feels_it_too() {
    check(&bars("revolute = [\"b\", \"a\"], at = \"A\", axis = [0, 0, 1]", ""), 'b', false);
}

#[test]
fn a_journal_whose_joint_is_cut_feels_it_too() {
    let ground = "K = { spherical = [\"ground\", \"b\"], at = \"C\" }";
    for (pair, bearing) in [("[\"a\", \"b\"]", 'a'), ("[\"b\", \"a\"]", 'b')] {
        let joint = format!("revolute = {pair}, at = \"A\", axis = [0, 0, 1], cut = true");
        check(&bars(&joint, ground), bearing, false);
    }
}

#[test]
fn a_ball_in_its_socket_feels_the_force_at_its_contact() {
    check(&bars("spherical = [\"a\", \"b\"], at = \"A\"", ""), 'a', true);
    check(&bars("spherical = [\"b\", \"a\"], at = \"A\"", ""), 'b', true);
}

#[test]
fn a_ball_whose_joint_is_cut_feels_it_too() {
    let ground = "K = { spherical = [\"ground\", \"b\"], at = \"C\" }";
    check(&bars("spherical = [\"a\", \"b\"], at = \"A\", cut = true", ground), 'a', true);
}
