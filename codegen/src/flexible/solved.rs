//! A beam with its modes. In: [`BeamInput`]. Out: [`ModalData`], nodes anywhere, what was left out.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::beam::BeamInput;
use super::data::{ModalData, Mode, Node, Strain};
use super::error::BeamError;
use super::integrals::{integrals, second_order, snap};
use super::mesh::Mesh;
use super::motion::{Motion, Motions, square};
use super::section::Properties;
use super::shapes::{Shape, Truncated, shapes};

/// A beam with its modes.
#[derive(Clone, Debug)]
pub struct Beam {
    input: BeamInput,
    sections: Vec<Properties>,
    motions: Motions,
    truncated: Truncated,
    /// Largest displacement and rotation of each mode: what its rounding is small against.
    amplitudes: Vec<[f64; 2]>,
}

/// How finely a beam was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// Number of elements.
    pub elements: usize,
    /// Highest polynomial degree of an element.
    pub degree: usize,
    /// Unknowns in one bending plane.
    pub unknowns: usize,
}

impl Beam {
    /// Computes the modes.
    ///
    /// # Errors
    /// What does not make sense in the input, or proportions beyond double precision.
    pub fn new(input: &BeamInput) -> Result<Self, BeamError> {
        let sections = input.checked()?;
        let mesh = Mesh::new(input, &sections);
        let (shapes, truncated) = shapes(input, &mesh)?;
        let mut motions = Motions::new(mesh, shapes);
        if input.second_order {
            motions = motions.with_shortening(input, &sections);
        }
        let mut beam = Self { input: input.clone(), sections, motions, truncated, amplitudes: vec![] };
        beam.amplitudes = beam.measure();
        Ok(beam)
    }

    /// First frequencies left out, per family.
    pub fn truncated(&self) -> Truncated {
        self.truncated
    }

    /// How finely the beam was cut.
    pub fn resolution(&self) -> Resolution {
        let line = &self.motions.mesh.lines[0];
        Resolution {
            elements: line.elements.len(),
            degree: line.elements.iter().map(|element| element.degree).max().unwrap_or(0),
            unknowns: line.size,
        }
    }

    /// All constants, with nodes at named places (name, x in m).
    ///
    /// # Errors
    /// A node outside the beam.
    pub fn modal_data(&self, nodes: &[(&str, f64)]) -> Result<ModalData, BeamError> {
        let shapes = &self.motions.shapes;
        let n = shapes.len();
        let slices = self.motions.slices(&self.input, &self.sections);
        let (mass, first, second) = self.rigid();
        let all = integrals(&slices, n, mass, second);
        let nodes = nodes.iter().map(|(name, x)| self.node(name, *x)).collect::<Result<_, _>>()?;
        let diagonal =
            |entry: &dyn Fn(&Shape) -> f64| square(n, |k, l| if k == l { entry(&shapes[k]) } else { 0.0 });
        let zeta = self.input.damping_ratio;
        Ok(ModalData {
            mass,
            first_moment: [first, 0.0, 0.0],
            second_moment: [[second[0], 0.0, 0.0], [0.0, second[1], 0.0], [0.0, 0.0, second[2]]],
            modes: shapes.iter().map(mode).collect(),
            gamma: all.gamma,
            moment: all.moment,
            coupling: all.coupling,
            mass_matrix: diagonal(&|_| 1.0),
            stiffness: diagonal(&|shape| shape.square),
            damping: diagonal(&|shape| 2.0 * zeta * shape.square.sqrt()),
            second_order: self.input.second_order.then(|| second_order(&slices, n, mass, second[0])),
            nodes,
        })
    }

    /// The section at x [m] as a node.
    ///
    /// Where two sections meet, the strain is that of the more stressed side.
    ///
    /// # Errors
    /// x outside the beam.
    pub fn node(&self, name: &str, x: f64) -> Result<Node, BeamError> {
        let x = self.input.place(x)?;
        let mesh = &self.motions.mesh;
        let (element, s) = mesh.locate(x, false);
        let motions = self.motions.at(element, s);
        let clean = |which: usize, of: fn(&Motion) -> [f64; 3]| -> Vec<[f64; 3]> {
            let pairs = motions.iter().zip(&self.amplitudes);
            pairs.map(|(motion, amplitude)| of(motion).map(|each| snap(each, amplitude[which]))).collect()
        };
        let sides = [(element, s), mesh.locate(x, true)].map(|(element, s)| self.strain(element, s));
        let worse = |after, before| if severity(&before) > severity(&after) { before } else { after };
        let strain = sides.into_iter().flatten().reduce(worse);
        Ok(Node {
            name: name.to_owned(),
            position: [x, 0.0, 0.0],
            displacement: clean(0, |motion| motion.displacement),
            rotation: clean(1, |motion| motion.rotation),
            displacement2: self.motions.shortening(element, s).map(|table| self.clean_shortening(&table)),
            strain,
        })
    }

    fn clean_shortening(&self, shortening: &DMatrix<f64>) -> Vec<Vec<[f64; 3]>> {
        let length = self.motions.mesh.length();
        // Slopes and rotations are of one size, but for shear.
        let scale = |k: usize, l: usize| self.amplitudes[k][1] * self.amplitudes[l][1] * length;
        square(shortening.nrows(), |k, l| [snap(shortening[(k, l)], scale(k, l)), 0.0, 0.0])
    }

    fn strain(&self, element: usize, s: f64) -> Option<Strain> {
        let segment = self.motions.mesh.segments[element];
        let outline = self.sections[segment].outline?;
        let motions = self.motions.at(element, s);
        let list = |of: &dyn Fn(&Motion) -> f64| -> Vec<f64> {
            // Adding 0 turns -0 into 0.
            motions.iter().map(|motion| of(motion) + 0.0).collect()
        };
        Some(Strain {
            extension: list(&|motion| motion.extension),
            curvature_y: list(&|motion| motion.curvature[0]),
            curvature_z: list(&|motion| motion.curvature[1]),
            youngs_modulus: self.input.segments[segment].material.youngs_modulus,
            outline,
        })
    }

    /// Mass, first moment along x, diagonal of the second moment: exact sums over segments and masses.
    fn rigid(&self) -> (f64, f64, [f64; 3]) {
        let (mut mass, mut first, mut second) = (0.0, 0.0, [0.0; 3]);
        let mut start = 0.0;
        for (segment, section) in self.input.segments.iter().zip(&self.sections) {
            let (h, density) = (segment.length, segment.material.density);
            let part = density * section.area * h;
            mass += part;
            first += part * (start + h / 2.0);
            second[0] += part * (start * start + start * h + h * h / 3.0);
            second[1] += density * section.iz * h;
            second[2] += density * section.iy * h;
            start += h;
        }
        for lump in &self.input.masses {
            let spread = lump.spread();
            mass += lump.mass;
            first += lump.mass * lump.x;
            second[0] += lump.mass * lump.x * lump.x;
            (0..3).for_each(|axis| second[axis] += spread[axis]);
        }
        (mass, first, second)
    }

    fn measure(&self) -> Vec<[f64; 2]> {
        let mut largest = vec![[0.0_f64; 2]; self.motions.shapes.len()];
        for element in 0..self.motions.mesh.segments.len() {
            for s in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                for (largest, motion) in largest.iter_mut().zip(self.motions.at(element, s)) {
                    for (largest, vector) in largest.iter_mut().zip([motion.displacement, motion.rotation]) {
                        *largest = vector.into_iter().fold(*largest, |most, each| most.max(each.abs()));
                    }
                }
            }
        }
        largest
    }
}

fn mode(shape: &Shape) -> Mode {
    Mode {
        name: format!("{}{}", shape.family.letter(), shape.number),
        frequency: shape.square.sqrt() / (2.0 * PI),
    }
}

/// Sum of the largest stresses of all modes: compares the two sides of a step, which share the bending moment.
fn severity(strain: &Strain) -> f64 {
    let n = strain.extension.len();
    let unit = |k: usize| -> Vec<f64> { (0..n).map(|l| if k == l { 1.0 } else { 0.0 }).collect() };
    (0..n).map(|k| strain.largest_stress(&unit(k))).sum()
}
