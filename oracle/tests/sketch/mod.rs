//! Mechanisms written in Rust, for tests that must not depend on the front end.
#![allow(dead_code, reason = "each test file uses a part")]

use linkwear_codegen::id::{BodyId, JointId, PointId};
use linkwear_codegen::model::{
    Axis, Body, Carrier, Closure, Drive, Force, Formula, Function, Inertia, Joint, JointModel, Mechanism,
    Passive, Point, Position, Term,
};
use linkwear_codegen::source::Span;
use linkwear_codegen::spec::Dimension;

pub fn number(x: f64) -> Formula {
    Formula::number(x, Dimension::default())
}

pub fn formula(term: Term) -> Formula {
    Formula { term, dimension: Dimension::default(), span: Span::default() }
}

pub fn axis(v: [f64; 3]) -> Axis {
    let n = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = v.map(|x| x / n);
    Axis { parent: unit, child: unit }
}

/// `offset + speed * t + amplitude * sin(t)`.
pub fn law(offset: f64, speed: f64, amplitude: f64) -> Formula {
    let n = |x| Box::new(Term::Number(x));
    let t = || Box::new(Term::Time);
    let line = Term::Add(n(offset), Box::new(Term::Mul(n(speed), t())));
    let sine = Term::Call(Function::Sin, vec![Term::Time]);
    let wave = Term::Mul(n(amplitude), Box::new(sine));
    formula(Term::Add(Box::new(line), Box::new(wave)))
}

/// A mechanism under construction.
pub struct Sketch(pub Mechanism);

impl Sketch {
    pub fn new(gravity: [f64; 3]) -> Self {
        Self(Mechanism {
            name: "sketch".to_owned(),
            parameters: Vec::new(),
            gravity: gravity.map(number),
            bodies: Vec::new(),
            points: Vec::new(),
            joints: Vec::new(),
            couplings: Vec::new(),
            stops: Vec::new(),
            forces: Vec::new(),
            states: Vec::new(),
            samplers: Vec::new(),
            sensors: Vec::new(),
            closure: Closure::Joint,
            allowed: Vec::new(),
            starts: Vec::new(),
            missions: Vec::new(),
            attached: Vec::new(),
            sources: linkwear_codegen::source::Sources::default(),
        })
    }

    pub fn point(&mut self, at: [f64; 3]) -> PointId {
        let id = PointId::new(self.0.points.len());
        self.0.points.push(Point {
            name: format!("P{}", id.index()),
            position: Position::Shared(at.map(number)),
            carrier: Carrier::Ground,
            assumed: false,
            span: Span::default(),
        });
        id
    }

    /// A body with principal inertia along W axes.
    pub fn body(&mut self, mass: f64, centre: [f64; 3], inertia: [f64; 3]) -> Carrier {
        let id = BodyId::new(self.0.bodies.len());
        let centre = self.point(centre);
        let [xx, yy, zz] = inertia;
        self.0.bodies.push(Body {
            name: format!("b{}", id.index()),
            inertia: Inertia::Given {
                mass: number(mass),
                centre,
                inertia: [xx, yy, zz, 0.0, 0.0, 0.0].map(number),
                axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            },
            flexible: None,
            span: Span::default(),
        });
        Carrier::Body(id)
    }

    pub fn joint(&mut self, model: JointModel, parent: Carrier, child: Carrier, at: [f64; 3]) -> JointId {
        let id = JointId::new(self.0.joints.len());
        let at = self.point(at);
        self.0.joints.push(Joint {
            name: format!("j{}", id.index()),
            model,
            parent,
            child,
            at,
            cut: false,
            drives: Vec::new(),
            passive: Vec::new(),
            clearance: None,
            surface: None,
            span: Span::default(),
        });
        id
    }

    pub fn drive(&mut self, joint: JointId, coordinate: usize, law: Formula) {
        self.0.joints[joint.index()].drives.push(Drive { coordinate, law });
    }

    pub fn passive(&mut self, joint: JointId, passive: Passive) {
        self.0.joints[joint.index()].passive.push(passive);
    }

    pub fn force(&mut self, force: Force) {
        let name = format!("f{}", self.0.forces.len());
        self.0.forces.push(Force { name, ..force });
    }
}
