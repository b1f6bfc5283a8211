//! What is seen of a mechanism: bodies as rods between the places where others hold them, joints, points. In: a compiled
//! mechanism. Out: [`Scene`], numbers in SI at the reference pose. Never knows time.

use linkwear_codegen::Compiled;
use linkwear_codegen::id::{BodyId, PointId};
use linkwear_codegen::model::{
    Body, Carrier, Coupling, Flexible, Force, Formula, Inertia, Look, Mechanism, MeshSide, PitchCircle,
};
use serde::{Serialize, Serializer};

use super::links::Link;
use super::vector::{cross, dot, minus, norm, plus};
use super::wheels::{Belt, Circle};

/// A mechanism at its reference pose; the motion of its bodies takes it from there.
#[derive(Debug, Serialize)]
pub struct Scene {
    pub name: String,
    /// Against gravity, or z.
    pub up: [f64; 3],
    pub bodies: Vec<Shape>,
    pub joints: Vec<JointMark>,
    /// Pitch circles of wheels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub circles: Vec<Circle>,
    /// Pairs of circles that a belt goes round.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub belts: Vec<Belt>,
    /// Springs and cables.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<Link>,
    /// Points on moving bodies.
    pub traces: Vec<String>,
}

/// A body.
#[derive(Debug, Serialize)]
pub struct Shape {
    pub name: String,
    pub places: Vec<[f64; 3]>,
    /// Pairs of places.
    pub rods: Vec<[usize; 2]>,
    /// Of its rods [m]; nothing if the file does not say.
    pub radius: Option<f64>,
    /// A rod with corners.
    pub square: bool,
    /// Where it bends.
    pub line: Vec<LineNode>,
}

/// A node on the centre line of a flexible body.
#[derive(Debug, Serialize)]
pub struct LineNode {
    pub at: [f64; 3],
    /// Displacement by each modal coordinate.
    pub shape: Vec<[f64; 3]>,
    /// Its slope along the line.
    pub slope: Vec<[f64; 3]>,
}

/// A joint.
#[derive(Debug, Serialize)]
pub struct JointMark {
    pub name: String,
    /// What it looks like.
    #[serde(serialize_with = "named")]
    pub look: Look,
    /// Whether it leaves bodies in their planes.
    pub is_plane: bool,
    /// Parent and child: which body, nothing for the ground; where on it.
    pub sides: [(Option<usize>, [f64; 3]); 2],
    /// First axis, as the parent has it.
    pub axis: Option<[f64; 3]>,
    pub clearance: Option<Play>,
}

/// As the page's scripts know it.
fn named<S: Serializer>(look: &Look, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(look.name())
}

/// Clearance of a joint [m].
#[derive(Debug, Serialize)]
pub struct Play {
    pub radial: f64,
    pub journal_radius: f64,
    pub length: f64,
    pub ball: bool,
}

/// Places closer than this part of the largest distance are one.
const SAME: f64 = 1e-6;

impl Scene {
    pub fn new(compiled: &Compiled) -> Self {
        let mechanism = &compiled.mechanism;
        let values = mechanism.parameter_values();
        let see = Eye { mechanism, values: &values };
        let gravity = see.three(&mechanism.gravity);
        let length = norm(gravity);
        let moving = mechanism.points.iter().filter(|point| point.carrier != Carrier::Ground);
        Self {
            name: mechanism.name.clone(),
            up: if length > 0.0 { gravity.map(|part| -part / length) } else { [0.0, 0.0, 1.0] },
            bodies: (0..mechanism.bodies.len()).map(|index| see.shape(index)).collect(),
            joints: see.joints(),
            circles: see.circles(),
            belts: see.belts(),
            links: see.links(),
            traces: moving.map(|point| point.name.clone()).collect(),
        }
    }

    /// The direction of all axes, if they are parallel: such a mechanism is seen best along it.
    pub fn common_axis(&self) -> Option<[f64; 3]> {
        let turning = |joint: &&JointMark| joint.look == Look::Pin;
        let mut axes = self.joints.iter().filter(turning).filter_map(|joint| joint.axis);
        let first = axes.next()?;
        let is_plane = self.joints.iter().all(|joint| joint.is_plane);
        (is_plane && axes.all(|axis| norm(cross(axis, first)) < 1e-6)).then_some(first)
    }
}

struct Eye<'m> {
    mechanism: &'m Mechanism,
    values: &'m [f64],
}

impl Eye<'_> {
    fn value(&self, formula: &Formula) -> f64 {
        formula.value(self.values).unwrap_or_default()
    }

    fn three(&self, formulas: &[Formula; 3]) -> [f64; 3] {
        formulas.each_ref().map(|formula| self.value(formula))
    }

    fn place(&self, point: PointId, carrier: Carrier) -> [f64; 3] {
        self.three(self.mechanism.point(point).position_for(carrier))
    }

    fn shape(&self, index: usize) -> Shape {
        let body = &self.mechanism.bodies[index];
        let is_own = |carrier: Carrier| matches!(carrier, Carrier::Body(id) if id.index() == index);
        let own = self
            .mechanism
            .joints
            .iter()
            .flat_map(|joint| [joint.parent, joint.child].into_iter().zip(joint.points()));
        let mut places: Vec<[f64; 3]> = Vec::new();
        for (carrier, at) in own.filter(|(carrier, _)| is_own(*carrier)) {
            add(&mut places, self.place(at, carrier));
        }
        let of_points = self.mechanism.points.iter().filter(|point| is_own(point.carrier));
        let of_points: Vec<_> =
            of_points.map(|point| self.three(point.position_for(point.carrier))).collect();
        let mut shape = Shape {
            name: body.name.clone(),
            places,
            rods: Vec::new(),
            radius: None,
            square: false,
            line: body.flexible.as_deref().map_or_else(Vec::new, |flexible| self.line(index, flexible)),
        };
        self.fill(&mut shape, body, index, &of_points);
        shape
    }

    /// Rods between the places.
    fn fill(&self, shape: &mut Shape, body: &Body, index: usize, points: &[[f64; 3]]) {
        let carrier = Carrier::Body(BodyId::new(index));
        match &body.inertia {
            Inertia::Rod { ends, radius, .. } => {
                shape.radius = Some(self.value(radius));
                self.between(shape, ends.map(|end| self.place(end, carrier)));
            }
            Inertia::Box { ends, width, .. } => {
                shape.radius = Some(
                    0.5 * width.each_ref().map(|width| self.value(width)).iter().copied().fold(0.0, f64::max),
                );
                shape.square = true;
                self.between(shape, ends.map(|end| self.place(end, carrier)));
            }
            Inertia::Given { centre, .. } => {
                if shape.places.len() < 2 {
                    points.iter().for_each(|point| {
                        add(&mut shape.places, *point);
                    });
                }
                if shape.places.len() < 2 {
                    add(&mut shape.places, self.place(*centre, carrier));
                }
                match shape.places.len() {
                    0 | 1 => {}
                    2 => shape.rods.push([0, 1]),
                    count => {
                        let middle = [0, 1, 2]
                            .map(|i| shape.places.iter().map(|place| place[i]).sum::<f64>() / count as f64);
                        add(&mut shape.places, middle);
                        let middle = shape.places.len() - 1;
                        shape.rods.extend((0..count).filter(|at| *at != middle).map(|at| [at, middle]));
                    }
                }
            }
        }
    }

    /// A rod, and what lies off it held by its nearer end.
    fn between(&self, shape: &mut Shape, ends: [[f64; 3]; 2]) {
        let before = shape.places.clone();
        let at = ends.map(|end| add(&mut shape.places, end));
        shape.rods.push(at);
        for place in before {
            let along = minus(ends[1], ends[0]);
            let arm = minus(place, ends[0]);
            if norm(cross(along, arm)) > 1e-3 * norm(along).powi(2) {
                let near = usize::from(norm(minus(place, ends[1])) < norm(arm));
                let from = add(&mut shape.places, place);
                shape.rods.push([at[near], from]);
            }
        }
    }

    fn line(&self, index: usize, flexible: &Flexible) -> Vec<LineNode> {
        let carrier = Carrier::Body(BodyId::new(index));
        let origin = self.place(flexible.origin, carrier);
        let out =
            |v: [f64; 3]| [0, 1, 2].map(|i| (0..3).map(|axis| flexible.axes[axis][i] * v[axis]).sum::<f64>());
        let nodes = &flexible.data.nodes;
        let length = nodes.iter().map(|node| norm(node.position)).fold(0.0, f64::max);
        let is_line = nodes.iter().all(|node| node.position[1].hypot(node.position[2]) < 1e-3 * length);
        if !is_line || flexible.data.modes.is_empty() {
            return Vec::new();
        }
        let mut sorted: Vec<_> = nodes.iter().collect();
        sorted.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
        sorted.dedup_by(|a, b| (a.position[0] - b.position[0]).abs() < SAME * length);
        let nodes = sorted.iter().map(|node| LineNode {
            at: plus(origin, out(node.position)),
            shape: node.displacement.iter().map(|shape| out(*shape)).collect(),
            // A section stays across the line: the line leans as the section turns.
            slope: node.rotation.iter().map(|turn| out([0.0, turn[2], -turn[1]])).collect(),
        });
        nodes.collect()
    }

    fn circles(&self) -> Vec<Circle> {
        let couplings = self.mechanism.couplings.iter();
        couplings
            .flat_map(|coupling| pitch_circles(coupling).map(|side| self.circle(coupling, side)))
            .collect()
    }

    fn circle(&self, coupling: &Coupling, (side, circle): (&MeshSide, PitchCircle)) -> Circle {
        let within = |other: &PitchCircle| {
            let apart = norm(minus(other.centre, circle.centre));
            other.radius < circle.radius && apart + other.radius <= (1.0 + SAME) * circle.radius
        };
        Circle {
            body: side.body.index(),
            centre: circle.centre,
            axis: self.axis(side),
            radius: circle.radius,
            hollow: coupling.kind == "gears" && pitch_circles(coupling).any(|(_, other)| within(&other)),
        }
    }

    fn axis(&self, side: &MeshSide) -> [f64; 3] {
        self.mechanism.joint(side.joint).model.axes[0].parent
    }

    fn belts(&self) -> Vec<Belt> {
        let mut first = 0;
        let mut belts = Vec::new();
        for coupling in &self.mechanism.couplings {
            let count = pitch_circles(coupling).count();
            if coupling.kind == "belt" && count == 2 {
                // Pulleys of a crossed belt turn against each other: both paths have one sign then, if both axes have one direction.
                let paths: f64 = coupling.terms.iter().take(2).map(|term| self.value(&term.factor)).product();
                let [one, other] = [0, 1].map(|i| self.axis(&coupling.meshes[i]));
                let crossed = paths * dot(one, other) > 0.0;
                belts.push(Belt { circles: [first, first + 1], crossed });
            }
            first += count;
        }
        belts
    }

    fn links(&self) -> Vec<Link> {
        let between = self.mechanism.forces.iter().filter(|force| force.kind.points == 2);
        let link = |force: &Force| Link {
            coiled: force.kind.coiled,
            sides: [0, 1].map(|i| (body(force.bodies[i]), self.place(force.at[i], force.bodies[i]))),
        };
        between.map(link).collect()
    }

    fn joints(&self) -> Vec<JointMark> {
        let mark = |joint: &linkwear_codegen::model::Joint| JointMark {
            name: joint.name.clone(),
            look: joint.model.kind.look(),
            is_plane: joint.model.kind.is_plane(),
            sides: {
                let [on_parent, on_child] = joint.points();
                [(joint.parent, on_parent), (joint.child, on_child)]
                    .map(|(side, point)| (body(side), self.place(point, side)))
            },
            axis: joint.model.axes.first().map(|axis| axis.parent),
            clearance: joint.clearance.as_ref().map(|clearance| Play {
                radial: self.value(&clearance.radial),
                journal_radius: clearance.laws.journal_radius,
                length: clearance.laws.length,
                ball: clearance.laws.ball,
            }),
        };
        self.mechanism.joints.iter().map(mark).collect()
    }
}

/// Which body; nothing for the ground.
fn body(carrier: Carrier) -> Option<usize> {
    match carrier {
        Carrier::Ground => None,
        Carrier::Body(id) => Some(id.index()),
    }
}

fn pitch_circles(coupling: &Coupling) -> impl Iterator<Item = (&MeshSide, PitchCircle)> {
    coupling.meshes.iter().filter_map(|side| Some((side, side.pitch_circle?)))
}

/// Where a place is in the list; new ones are added.
fn add(places: &mut Vec<[f64; 3]>, place: [f64; 3]) -> usize {
    let size = places.iter().map(|known| norm(*known)).fold(norm(place), f64::max);
    let same = |known: &[f64; 3]| norm(minus(*known, place)) <= SAME * size;
    places.iter().position(same).unwrap_or_else(|| {
        places.push(place);
        places.len() - 1
    })
}
