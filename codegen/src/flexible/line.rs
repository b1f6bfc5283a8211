//! Elements in a row, in one family of motion: stiffness and mass matrices, and the motion anywhere.
//! Unknowns: the nodal ones of every station in order, then the inner ones of every element in order.

use nalgebra::{DMatrix, DVector};

use super::element::{Element, Field};
use super::legendre::gauss;

/// Elements in a row; element e lies between stations e and e + 1.
#[derive(Clone, Debug)]
pub struct Line {
    elements: Vec<Element>,
    /// Added inertia at a station: against its value and against its rotation.
    lumps: Vec<(usize, [f64; 2])>,
    /// First inner unknown of every element.
    inner: Vec<usize>,
    size: usize,
}

/// Stiffness and mass over the unknowns of a line.
pub struct Matrices {
    /// K, symmetric.
    pub stiffness: DMatrix<f64>,
    /// M, symmetric.
    pub mass: DMatrix<f64>,
}

impl Line {
    /// Joins elements that follow each other.
    pub fn new(elements: Vec<Element>, lumps: Vec<(usize, [f64; 2])>) -> Self {
        let per_node = elements.first().map_or(1, Element::per_node);
        let mut size = per_node * (elements.len() + 1);
        let inner = elements
            .iter()
            .map(|element| {
                let first = size;
                size += element.inner();
                first
            })
            .collect();
        Self { elements, lumps, inner, size }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Unknown of component `which` (0 value, 1 rotation) at a station.
    pub fn nodal(&self, station: usize, which: usize) -> usize {
        station * self.per_node() + which
    }

    /// The elements, in order.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    fn per_node(&self) -> usize {
        self.elements.first().map_or(1, Element::per_node)
    }

    /// Unknowns of an element, in the order of [`Element::fields`].
    fn unknowns(&self, element: usize) -> Vec<usize> {
        let per_node = self.per_node();
        let nodal = element * per_node..(element + 2) * per_node;
        let first = self.inner[element];
        nodal.chain(first..first + self.elements[element].inner()).collect()
    }

    /// Stiffness, exact; mass, by Gauss quadrature exact for these polynomials.
    pub fn matrices(&self) -> Matrices {
        let mut stiffness = DMatrix::zeros(self.size, self.size);
        let mut mass = DMatrix::zeros(self.size, self.size);
        for (index, element) in self.elements.iter().enumerate() {
            let unknowns = self.unknowns(index);
            let nodal = element.nodal_stiffness();
            for (i, row) in unknowns.iter().enumerate() {
                for (j, column) in unknowns.iter().enumerate() {
                    stiffness[(*row, *column)] += match nodal.get((i, j)) {
                        Some(entry) => *entry,
                        None if i == j => 1.0,
                        None => 0.0,
                    };
                }
            }
            for (s, weight) in gauss(element.degree + 1) {
                let fields = element.fields(s);
                let (inertia, rotary) = (element.inertia, element.rotary);
                let over = weight * element.length / 2.0;
                for (i, row) in unknowns.iter().enumerate() {
                    for (j, column) in unknowns.iter().enumerate().take(i + 1) {
                        let entry = over
                            * (inertia * fields[i].value * fields[j].value
                                + rotary * fields[i].rotation * fields[j].rotation);
                        mass[(*row, *column)] += entry;
                        if row != column {
                            mass[(*column, *row)] += entry;
                        }
                    }
                }
            }
        }
        for (station, inertia) in &self.lumps {
            for (which, added) in inertia.iter().enumerate().take(self.per_node()) {
                let unknown = self.nodal(*station, which);
                mass[(unknown, unknown)] += added;
            }
        }
        Matrices { stiffness, mass }
    }

    /// The motion at s in [-1, 1] of an element.
    pub fn field(&self, element: usize, s: f64, coefficients: &DVector<f64>) -> Field {
        let mut sum = Field::default();
        for (unknown, field) in self.unknowns(element).into_iter().zip(self.elements[element].fields(s)) {
            sum.add(coefficients[unknown], &field);
        }
        sum
    }

    /// Rigid motions as unknowns: translation and, for bending, rotation about x = 0.
    pub fn rigid(&self) -> Vec<DVector<f64>> {
        let mut motions = vec![DVector::zeros(self.size); self.per_node()];
        let ends = self.elements.last().map(|element| element.start + element.length);
        let places = self.elements.iter().map(|element| element.start).chain(ends);
        for (station, x) in places.enumerate() {
            motions[0][self.nodal(station, 0)] = 1.0;
            if let Some(rotation) = motions.get_mut(1) {
                rotation[self.nodal(station, 0)] = x;
                rotation[self.nodal(station, 1)] = 1.0;
            }
        }
        motions
    }
}
