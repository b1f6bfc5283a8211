//! Mode shapes of a beam under its hold, each family and each bending plane on its own.
//! In: mesh and hold. Out: mass-normalised shapes with fixed signs in a fixed order, and what was left out.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::beam::{Attachment, BeamInput, Hold};
use super::eigen::{Eigenmode, lowest, orthonormal, product};
use super::element::Rigidity;
use super::error::BeamError;
use super::line::{Line, Matrices};
use super::mesh::{Family, Mesh};

/// One mode of a beam.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The motion it belongs to.
    pub family: Family,
    /// Number in its family, from 1.
    pub number: usize,
    /// omega² [rad²/s²].
    pub square: f64,
    /// Unknowns of the family's line; mass-normalised.
    pub unknowns: DVector<f64>,
}

/// First frequencies that were left out [Hz]; what a warning about truncation needs.
///
/// Chord frames without axial or torsional modes: of the beam held at both ends of the chord, because the frame alone
/// does not say how the neighbours hold it (a beam free at both ends has the same).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truncated {
    /// Bending along y; with Craig-Bampton, the first fixed-interface frequency left out.
    pub y: f64,
    /// Bending along z; likewise.
    pub z: f64,
    /// Axial.
    pub axial: f64,
    /// Torsional.
    pub torsion: f64,
}

/// Shapes in the order of the modal coordinates, and what was left out.
pub fn shapes(input: &BeamInput, mesh: &Mesh) -> Result<(Vec<Shape>, Truncated), BeamError> {
    let bending = input.modes.bending;
    let planes = [Plane::new(input, mesh, Family::Y)?, Plane::new(input, mesh, Family::Z)?];
    let (y, z) = share(bending, &planes[0].modes, &planes[1].modes);
    let first = planes[0].keep(input, y)?;
    let second = planes[1].keep(input, z)?;
    let truncated_y = planes[0].modes[y].square;
    let truncated_z = planes[1].modes[z].square;
    let mut kept = merge(first, second);
    let (axial, truncated_axial) = bar_modes(input, mesh, Family::Axial, input.modes.axial)?;
    let (torsion, truncated_torsion) = bar_modes(input, mesh, Family::Torsion, input.modes.torsion)?;
    kept.extend(axial);
    kept.extend(torsion);
    let hertz = |square: f64| square.sqrt() / (2.0 * PI);
    let truncated = Truncated {
        y: hertz(truncated_y),
        z: hertz(truncated_z),
        axial: hertz(truncated_axial),
        torsion: hertz(truncated_torsion),
    };
    Ok((kept, truncated))
}

/// Frequencies this close count as equal: those of equal planes have equal bits, those of sections equal but for how
/// they were written differ by rounding.
const EQUAL: f64 = 1e-9;

/// How many of the `count` lowest modes lie in each plane; of equal ones, y comes first.
fn share(count: usize, along_y: &[Eigenmode], along_z: &[Eigenmode]) -> (usize, usize) {
    let (mut y, mut z) = (0, 0);
    while y + z < count {
        if comes_first(along_y[y].square, along_z[z].square) { y += 1 } else { z += 1 }
    }
    (y, z)
}

fn comes_first(y: f64, z: f64) -> bool {
    y <= z * (1.0 + EQUAL)
}

/// Both planes, lowest first.
fn merge(along_y: Vec<Shape>, along_z: Vec<Shape>) -> Vec<Shape> {
    let (mut y, mut z) = (along_y.into_iter().peekable(), along_z.into_iter().peekable());
    let mut all = vec![];
    loop {
        let from_y = match (y.peek(), z.peek()) {
            (Some(y), Some(z)) => comes_first(y.square, z.square),
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return all,
        };
        all.extend(if from_y { y.next() } else { z.next() });
    }
}

/// One bending plane with its eigenmodes (with Craig-Bampton: of fixed interfaces).
struct Plane<'a> {
    family: Family,
    mesh: &'a Mesh,
    matrices: Matrices,
    /// Unknowns of the chord or the clamp.
    held: Vec<usize>,
    /// Unknowns that get a static shape.
    interface: Vec<usize>,
    modes: Vec<Eigenmode>,
}

impl<'a> Plane<'a> {
    fn new(input: &BeamInput, mesh: &'a Mesh, family: Family) -> Result<Self, BeamError> {
        let line = mesh.line(family);
        let attachments = input.attachments();
        let (mut held, mut interface) = (vec![], vec![]);
        if input.hold == Hold::Clamped {
            held = vec![line.nodal(0, 0), line.nodal(0, 1)];
        }
        for (index, Attachment { x, rotation }) in attachments.iter().enumerate() {
            let station = mesh.station(*x);
            let chord = index == 0 || index + 1 == attachments.len();
            if chord { &mut held } else { &mut interface }.push(line.nodal(station, 0));
            if *rotation {
                interface.push(line.nodal(station, 1));
            }
        }
        let matrices = line.matrices();
        let rigid = if input.hold == Hold::Free { line.rigid() } else { vec![] };
        let shift = if rigid.is_empty() { 0.0 } else { estimate(line) };
        let still: Vec<usize> = held.iter().chain(&interface).copied().collect();
        // One more than can be kept is left out and named.
        let count = input.modes.bending + 1;
        let modes = lowest(&matrices, &still, shift, &rigid, count).ok_or(BeamError::Extreme)?;
        if modes.len() < count {
            return Err(BeamError::Extreme);
        }
        Ok(Self { family, mesh, matrices, held, interface, modes })
    }

    /// The first `count` modes; with interfaces, the eigenmodes of what they and the static shapes span.
    fn keep(&self, input: &BeamInput, count: usize) -> Result<Vec<Shape>, BeamError> {
        let mut modes = self.modes[..count].to_vec();
        if !self.interface.is_empty() {
            modes = self.craig_bampton(&modes).ok_or(BeamError::Extreme)?;
        }
        let line = self.mesh.line(self.family);
        let named = modes.into_iter().enumerate().map(|(index, mode)| {
            let unknowns = upright(line, self.mesh.length(), mode.shape);
            Shape { family: self.family, number: index + 1, square: mode.square, unknowns }
        });
        debug_assert!(input.modes.bending >= count);
        Ok(named.collect())
    }

    fn craig_bampton(&self, fixed: &[Eigenmode]) -> Option<Vec<Eigenmode>> {
        let mut basis = self.static_shapes()?;
        basis.extend(fixed.iter().map(|mode| mode.shape.clone()));
        let n = basis.len();
        let of = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(n, n, |i, j| {
                let (i, j) = (i.max(j), i.min(j));
                product(&basis[i], matrix, &basis[j])
            })
        };
        let reduced = Matrices { stiffness: of(&self.matrices.stiffness), mass: of(&self.matrices.mass) };
        let mut done: Vec<DVector<f64>> = vec![];
        let mut modes = vec![];
        for mode in lowest(&reduced, &[], 0.0, &[], n)? {
            let mut shape = DVector::zeros(self.matrices.mass.nrows());
            for (factor, each) in mode.shape.iter().zip(&basis) {
                shape.axpy(*factor, each, 1.0);
            }
            let shape = orthonormal(shape, &self.matrices.mass, &done)?;
            done.push(shape.clone());
            modes.push(Eigenmode { square: product(&shape, &self.matrices.stiffness, &shape), shape });
        }
        Some(modes)
    }

    /// Static shape of each interface unknown at 1, the others and the chord at 0.
    fn static_shapes(&self) -> Option<Vec<DVector<f64>>> {
        let stiffness = &self.matrices.stiffness;
        let size = stiffness.nrows();
        let still = |unknown: &usize| self.held.contains(unknown) || self.interface.contains(unknown);
        let free: Vec<usize> = (0..size).filter(|unknown| !still(unknown)).collect();
        let inner = DMatrix::from_fn(free.len(), free.len(), |i, j| stiffness[(free[i], free[j])]);
        let solver = inner.cholesky()?;
        let shape = |unknown: &usize| {
            let load = DVector::from_fn(free.len(), |i, _| -stiffness[(free[i], *unknown)]);
            let answer = solver.solve(&load);
            let mut shape = DVector::zeros(size);
            shape[*unknown] = 1.0;
            for (unknown, value) in free.iter().zip(answer.iter()) {
                shape[*unknown] = *value;
            }
            shape
        };
        Some(self.interface.iter().map(shape).collect())
    }
}

/// Kept modes of a bar family, and the square of the first frequency left out.
fn bar_modes(
    input: &BeamInput,
    mesh: &Mesh,
    family: Family,
    count: usize,
) -> Result<(Vec<Shape>, f64), BeamError> {
    let line = mesh.line(family);
    let matrices = line.matrices();
    let attachments = input.attachments();
    let chord = [attachments.first(), attachments.last()].map(|end| end.map(|each| mesh.station(each.x)));
    let held: Vec<usize> = match (&input.hold, chord) {
        (Hold::Free, _) => vec![],
        (_, [Some(first), Some(last)]) if count == 0 => vec![line.nodal(first, 0), line.nodal(last, 0)],
        (_, [Some(first), _]) => vec![line.nodal(first, 0)],
        _ => vec![line.nodal(0, 0)],
    };
    let rigid = if held.is_empty() { line.rigid() } else { vec![] };
    let shift = if rigid.is_empty() { 0.0 } else { estimate(line) };
    let modes = lowest(&matrices, &held, shift, &rigid, count + 1).ok_or(BeamError::Extreme)?;
    let truncated = modes.get(count).ok_or(BeamError::Extreme)?.square;
    let named = modes.into_iter().take(count).enumerate().map(|(index, mode)| Shape {
        family,
        number: index + 1,
        square: mode.square,
        unknowns: upright(line, mesh.length(), mode.shape),
    });
    Ok((named.collect(), truncated))
}

/// omega² of the first elastic mode, roughly: lifts rigid motions off 0 without burying the modes above.
fn estimate(line: &Line) -> f64 {
    let phase = |power: fn(f64) -> f64| -> f64 {
        let waves = line.elements().iter().map(|element| {
            let rigidity = match element.rigidity {
                Rigidity::Bending { bending, .. } => bending,
                Rigidity::Bar(rigidity) => rigidity,
            };
            power(element.inertia / rigidity) * element.length
        });
        PI / waves.sum::<f64>()
    };
    match line.elements().first().map(|element| element.rigidity) {
        Some(Rigidity::Bar(_)) => {
            let wave = phase(f64::sqrt);
            wave * wave
        }
        _ => {
            let wave = phase(|ratio| ratio.sqrt().sqrt());
            wave * wave * wave * wave
        }
    }
}

/// The shape with the sign fixed: the first of deflection at x = 0, slope there, deflection at the far end that is not
/// small is positive.
fn upright(line: &Line, length: f64, shape: DVector<f64>) -> DVector<f64> {
    let last = line.elements().len() - 1;
    let (near, far) = (line.field(0, -1.0, &shape), line.field(last, 1.0, &shape));
    let slope = match line.elements()[0].rigidity {
        Rigidity::Bending { .. } => near.slope(),
        Rigidity::Bar(_) => near.strain,
    };
    let signs = [near.value, slope * length, far.value];
    let stations = (0..=last).map(|element| line.field(element, 0.0, &shape).value.abs());
    let size = stations.fold(near.value.abs().max(far.value.abs()), f64::max);
    // Far above rounding and far below what any mode has at one of these.
    let first = signs.into_iter().find(|each| each.abs() > 1e-3 * size);
    if first.is_some_and(|each| each < 0.0) { -shape } else { shape }
}
