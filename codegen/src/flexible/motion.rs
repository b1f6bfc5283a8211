//! Motion of sections in all modes: at quadrature points over the whole mass, and anywhere.
//! In: mesh and shapes. Out: displacement, rotation, slope, strain per mode; the foreshortening of the axis.

use nalgebra::DMatrix;

use super::beam::{BeamInput, Hold, Theory};
use super::legendre::gauss;
use super::mesh::{Family, Mesh};
use super::section::Properties;
use super::shapes::Shape;

/// What one mode does to one section.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    /// Displacement of the axis [m/q].
    pub displacement: [f64; 3],
    /// Rotation of the section [rad/q].
    pub rotation: [f64; 3],
    /// Slope of the axis along y and z [1/q].
    pub slope: [f64; 2],
    /// Strain of the axis [1/q].
    pub extension: f64,
    /// Derivative of the rotation about y and z [1/(m q)].
    pub curvature: [f64; 2],
}

/// A thin slice of mass, or a concentrated one: a rigid body on one section.
#[derive(Clone, Debug)]
pub struct Slice {
    /// Its place [m].
    pub x: f64,
    /// Its mass [kg].
    pub mass: f64,
    /// ∫ (component)² dm about its centre, along x, y, z [kg m²], as far as it takes part in the modes.
    pub spread: [f64; 3],
    /// Displacement per mode [m/q].
    pub displacement: Vec<[f64; 3]>,
    /// Rotation per mode, as far as it has inertia [rad/q].
    pub rotation: Vec<[f64; 3]>,
    /// χ_kl along x [m/q²]; empty without second order.
    pub shortening: DMatrix<f64>,
}

/// All modes of a beam on its mesh.
#[derive(Clone, Debug)]
pub struct Motions {
    /// Its mesh.
    pub mesh: Mesh,
    /// The shapes, in the order of the modal coordinates.
    pub shapes: Vec<Shape>,
    /// ∫ slope_k . slope_l dx from x = 0 to each station [m/q²], and what to subtract from it; second order only.
    shortening: Option<Shortening>,
}

#[derive(Clone, Debug)]
struct Shortening {
    stations: Vec<DMatrix<f64>>,
    origin: DMatrix<f64>,
}

impl Motions {
    /// Without the second-order field.
    pub fn new(mesh: Mesh, shapes: Vec<Shape>) -> Self {
        Self { mesh, shapes, shortening: None }
    }

    /// Motion per mode at s of an element.
    pub fn at(&self, element: usize, s: f64) -> Vec<Motion> {
        let motion = |shape: &Shape| {
            let field = self.mesh.line(shape.family).field(element, s, &shape.curve);
            let mut motion = Motion::default();
            match shape.family {
                Family::Y => {
                    motion.displacement[1] = field.value;
                    motion.rotation[2] = field.rotation;
                    motion.slope[0] = field.slope();
                    motion.curvature[1] = field.strain;
                }
                // A positive slope along z is a negative rotation about y.
                Family::Z => {
                    motion.displacement[2] = field.value;
                    motion.rotation[1] = -field.rotation;
                    motion.slope[1] = field.slope();
                    motion.curvature[0] = -field.strain;
                }
                Family::Axial => {
                    motion.displacement[0] = field.value;
                    motion.extension = field.strain;
                }
                Family::Torsion => motion.rotation[0] = field.value,
            }
            motion
        };
        self.shapes.iter().map(motion).collect()
    }

    /// χ_kl along x at s of an element [m/q²]; `None` without second order.
    pub fn shortening(&self, element: usize, s: f64) -> Option<DMatrix<f64>> {
        let Shortening { stations, origin } = self.shortening.as_ref()?;
        Some(origin - &stations[element] - self.shortening_inside(element, s))
    }

    /// ∫ slope_k . slope_l dx from the start of an element to s.
    fn shortening_inside(&self, element: usize, s: f64) -> DMatrix<f64> {
        let of = &self.mesh.lines[0].elements[element];
        let n = self.shapes.len();
        let mut sum = DMatrix::zeros(n, n);
        // Slopes are one degree below the deflection.
        for (t, weight) in gauss(of.degree).iter().copied() {
            let motions = self.at(element, f64::midpoint(s - 1.0, (s + 1.0) * t));
            let over = weight * (s + 1.0) / 2.0 * of.length / 2.0;
            sum += DMatrix::from_fn(n, n, |k, l| {
                let ([ky, kz], [ly, lz]) = (motions[k].slope, motions[l].slope);
                over * (ky * ly + kz * lz)
            });
        }
        sum
    }

    /// With the second-order field: the axis keeps its length.
    ///
    /// Chord frames: no displacement along x where the chord begins. Clamped: at the section. Free: none in the mean over the
    /// mass, as with the modes themselves.
    pub fn with_shortening(mut self, input: &BeamInput, sections: &[Properties]) -> Self {
        let n = self.shapes.len();
        let mut stations = vec![DMatrix::zeros(n, n)];
        for element in 0..self.mesh.segments.len() {
            stations.push(&stations[element] + self.shortening_inside(element, 1.0));
        }
        let begin = input.origin().map_or(0, |x| self.mesh.station(x));
        let origin = stations[begin].clone();
        self.shortening = Some(Shortening { stations, origin });
        if input.hold == Hold::Free {
            let slices = self.slices(input, sections);
            let mass: f64 = slices.iter().map(|slice| slice.mass).sum();
            let moved = slices.iter().map(|slice| &slice.shortening * slice.mass);
            let sum = moved.fold(DMatrix::zeros(n, n), |sum, each| sum + each);
            if let Some(Shortening { origin, .. }) = &mut self.shortening {
                *origin -= sum / mass;
            }
        }
        self
    }

    /// The mass as slices that integrate every product of shapes exactly, concentrated masses last.
    pub fn slices(&self, input: &BeamInput, sections: &[Properties]) -> Vec<Slice> {
        let mut slices = vec![];
        for (element, segment) in self.mesh.segments.iter().enumerate() {
            let (start, end) = (self.mesh.stations[element], self.mesh.stations[element + 1]);
            let section = &sections[*segment];
            let density = input.segments[*segment].material.density;
            // Twice the degree of the deflection, or of the slope plus two for x and the inner integral.
            for (s, weight) in gauss(self.mesh.lines[0].elements[element].degree + 2).iter().copied() {
                let over = weight * (end - start) / 2.0 * density;
                let mut slice = self.slice(element, s, over * section.area);
                slice.spread = [0.0, over * section.iz, over * section.iy];
                if input.theory == Theory::EulerBernoulli {
                    // No rotary inertia: sections twist, but do not tilt.
                    slice.rotation.iter_mut().for_each(|rotation| *rotation = [rotation[0], 0.0, 0.0]);
                }
                slices.push(slice);
            }
        }
        for lump in &input.masses {
            let (element, s) = self.mesh.locate(lump.x, false);
            let mut slice = self.slice(element, s, lump.mass);
            slice.spread = lump.spread();
            slices.push(slice);
        }
        slices
    }

    fn slice(&self, element: usize, s: f64, mass: f64) -> Slice {
        let (start, end) = (self.mesh.stations[element], self.mesh.stations[element + 1]);
        let motions = self.at(element, s);
        Slice {
            x: start + (end - start) * f64::midpoint(1.0, s),
            mass,
            spread: [0.0; 3],
            displacement: motions.iter().map(|motion| motion.displacement).collect(),
            rotation: motions.iter().map(|motion| motion.rotation).collect(),
            shortening: self.shortening(element, s).unwrap_or_else(|| DMatrix::zeros(0, 0)),
        }
    }
}

/// An n by n table.
pub fn square<T>(n: usize, entry: impl Fn(usize, usize) -> T) -> Vec<Vec<T>> {
    (0..n).map(|k| (0..n).map(|l| entry(k, l)).collect()).collect()
}
