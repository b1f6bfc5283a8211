//! Elements in a row, in one family of motion, anchored to a floating frame.
//!
//! Unknowns are the strains of all elements (stiffness: the identity). What is left, a rigid motion, is what the anchor
//! takes away; so every motion is a row of numbers against the unknowns.

use nalgebra::{DMatrix, DVector};

use super::element::{Element, Field, Rigidity};
use super::legendre::gauss;

/// Elements in a row; element e lies between stations e and e + 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The elements, in order.
    pub elements: Vec<Element>,
    /// Added inertia at a station: against its value and against its rotation.
    lumps: Vec<(usize, [f64; 2])>,
    /// First unknown of every element.
    first: Vec<usize>,
    /// Number of unknowns.
    pub size: usize,
    /// Value and rotation at every station, as rows against the unknowns.
    stations: Vec<[DVector<f64>; 2]>,
}

/// What takes the rigid motion away.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// Value and rotation 0 at a station.
    Section(usize),
    /// Value 0 at a station; of bars.
    Point(usize),
    /// Value 0 at two stations; of bending.
    Chord(usize, usize),
    /// No momentum in any motion.
    Mean,
}

/// A motion of the line: unknowns, and value and rotation at every station.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The unknowns.
    pub unknowns: DVector<f64>,
    stations: Vec<[f64; 2]>,
}

impl Line {
    /// Joins elements that follow each other.
    pub fn new(elements: Vec<Element>, lumps: Vec<(usize, [f64; 2])>, anchor: Anchor) -> Self {
        let mut size = 0;
        let first = elements
            .iter()
            .map(|element| {
                let first = size;
                size += element.size();
                first
            })
            .collect();
        let mut line = Self { elements, lumps, first, size, stations: vec![] };
        line.stations.push([DVector::zeros(size), DVector::zeros(size)]);
        for element in 0..line.elements.len() {
            let end = line.row(element, 1.0);
            line.stations.push(end);
        }
        let rigid = line.rigid(anchor);
        for station in 0..line.stations.len() {
            let x = line.place(station);
            let [value, rotation] = &mut line.stations[station];
            *value += &rigid[0];
            value.axpy(x, &rigid[1], 1.0);
            *rotation += &rigid[1];
        }
        line
    }

    /// Value (0) or rotation (1) at a station, as a row against the unknowns.
    pub fn station(&self, station: usize, which: usize) -> &DVector<f64> {
        &self.stations[station][which]
    }

    fn place(&self, station: usize) -> f64 {
        match self.elements.get(station) {
            Some(element) => element.start,
            None => self.elements.last().map_or(0.0, |element| element.start + element.length),
        }
    }

    /// Value and rotation at s of an element, as rows against the unknowns.
    fn row(&self, element: usize, s: f64) -> [DVector<f64>; 2] {
        let (of, first) = (&self.elements[element], self.first[element]);
        let [mut value, mut rotation] = self.stations[element].clone();
        value.axpy(of.length * f64::midpoint(1.0, s), &rotation, 1.0);
        for (index, field) in of.fields(s).iter().enumerate() {
            value[first + index] += field.value;
            rotation[first + index] += field.rotation;
        }
        [value, rotation]
    }

    /// Translation and, for bending, rotation about x = 0 that the anchor adds, as rows against the unknowns.
    fn rigid(&self, anchor: Anchor) -> [DVector<f64>; 2] {
        let still = DVector::zeros(self.size);
        let value = |station: usize| self.station(station, 0);
        match anchor {
            Anchor::Section(station) => {
                let turn = -self.station(station, 1);
                [-value(station) - &turn * self.place(station), turn]
            }
            Anchor::Point(station) => [-value(station), still],
            Anchor::Chord(first, second) => {
                let (from, to) = (self.place(first), self.place(second));
                let turn = (value(first) - value(second)) / (to - from);
                [-value(first) - &turn * from, turn]
            }
            Anchor::Mean => {
                let Momentum { mass, first, second, linear, angular } = self.momentum();
                let bar = matches!(self.elements[0].rigidity, Rigidity::Bar(_));
                if bar {
                    return [-linear / mass, still];
                }
                let determinant = mass * second - first * first;
                let turn = (&linear * first - angular * mass) / determinant;
                [(-linear - &turn * first) / mass, turn]
            }
        }
    }

    /// Calls with weight, inertia and rotary inertia, place and rows of every quadrature point and lump.
    fn over_mass(&self, mut each: impl FnMut([f64; 2], f64, [DVector<f64>; 2])) {
        for (index, element) in self.elements.iter().enumerate() {
            // Exact for the square of the deflection.
            for (s, weight) in gauss(element.degree + 1) {
                let over = weight * element.length / 2.0;
                let x = element.start + element.length * f64::midpoint(1.0, *s);
                each([over * element.inertia, over * element.rotary], x, self.row(index, *s));
            }
        }
        for (station, inertia) in &self.lumps {
            each(*inertia, self.place(*station), self.stations[*station].clone());
        }
    }

    fn momentum(&self) -> Momentum {
        let still = DVector::zeros(self.size);
        let mut sum = Momentum { mass: 0.0, first: 0.0, second: 0.0, linear: still.clone(), angular: still };
        self.over_mass(|[inertia, rotary], x, [value, rotation]| {
            sum.mass += inertia;
            sum.first += inertia * x;
            sum.second += inertia * x * x + rotary;
            sum.linear.axpy(inertia, &value, 1.0);
            sum.angular.axpy(inertia * x, &value, 1.0);
            sum.angular.axpy(rotary, &rotation, 1.0);
        });
        sum
    }

    /// The mass matrix over the unknowns.
    pub fn mass(&self) -> DMatrix<f64> {
        let mut mass = DMatrix::zeros(self.size, self.size);
        self.over_mass(|[inertia, rotary], _, [value, rotation]| {
            // Most unknowns belong to other elements.
            for column in (0..self.size).filter(|column| value[*column] != 0.0 || rotation[*column] != 0.0) {
                let (factor, turn) = (inertia * value[column], rotary * rotation[column]);
                let below = [&value, &rotation].map(|rows| &rows.as_slice()[column..]);
                let entries = &mut mass.as_mut_slice()[column * self.size..][column..self.size];
                for (entry, (value, rotation)) in entries.iter_mut().zip(below[0].iter().zip(below[1])) {
                    *entry += factor * value + turn * rotation;
                }
            }
        });
        mass.fill_upper_triangle_with_lower_triangle();
        mass
    }

    /// The motion of unknowns.
    pub fn curve(&self, unknowns: DVector<f64>) -> Curve {
        let stations = self.stations.iter().map(|rows| [0, 1].map(|which| rows[which].dot(&unknowns)));
        Curve { stations: stations.collect(), unknowns }
    }

    /// A motion at s in [-1, 1] of an element.
    pub fn field(&self, element: usize, s: f64, curve: &Curve) -> Field {
        let (of, [value, rotation]) = (&self.elements[element], curve.stations[element]);
        let carried = value + rotation * of.length * f64::midpoint(1.0, s);
        let mut sum = Field { value: carried, rotation, ..Field::default() };
        for (index, field) in of.fields(s).iter().enumerate() {
            sum.add(curve.unknowns[self.first[element] + index], field);
        }
        sum
    }
}

/// Rigid inertia, and linear and angular momentum of the unknowns about x = 0.
struct Momentum {
    mass: f64,
    first: f64,
    second: f64,
    linear: DVector<f64>,
    angular: DVector<f64>,
}
