//! Inertia of a flexible body by the accelerations of its shape functions, [CS (4)-(6)].
//! In: [`Basis`], motion of the floating frame, modal coordinates. Out: wrench and modal forces. Never knows loads.
//!
//! A point is `r = rbar + sum w_j U_j` with `U_j = sum e_kj q_k`, its acceleration `a_O + spin rbar + sum w_j A_j` with
//! `A_j = spin U_j + 2 omega x U'_j + U''_j`. With `g_j = ∫ w_j dm`, `p_j = ∫ rbar w_j dm`, `G_ij = ∫ w_i w_j dm`:
//!   force       = m a_O + spin s0 + sum g_j A_j
//!   moment      = s0 x a_O + axial(spin P0) + sum_j [ U_j x (g_j a_O + spin p_j) + p_j x A_j + U_j x sum_i G_ij A_i ]
//!   modal force = sum_j e_kj . (g_j a_O + spin p_j + sum_i G_ij A_i)
//! No mass property of the deformed body is needed. Where `g_j` is not zero, `g_j a_O + spin p_j` is `g_j` times the
//! acceleration of the place `p_j / g_j`, which several functions have in common.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::flexible::{Basis, ModalData};

use super::kinematics::Acceleration;
use super::modal_moments::{ByModes, Turning};
use super::motion::ModalState;
use super::wrench::Wrench;

/// Shares of the same place differ by rounding only.
const SAME: f64 = 1e-12;

/// Functions that move points along one axis only, and have no product with others: of `U_i x A_j` only what turns is
/// left, which two sums have.
#[derive(Clone, Debug)]
struct Line {
    axis: usize,
    functions: Vec<usize>,
}

/// Functions with one place `p_j / g_j`.
#[derive(Clone, Debug)]
struct Centre {
    place: [f64; 3],
    functions: Vec<usize>,
}

/// What is constant.
#[derive(Clone, Debug)]
pub struct Shapes<'g> {
    pub basis: Basis,
    data: &'g ModalData,
    lines: Vec<Line>,
    centres: Vec<Centre>,
    turnings: Vec<Turning>,
}

/// Accelerations of the shape functions of one body at an instant, in its frame.
#[derive(Clone, Debug)]
pub struct Fields<'g> {
    place: Vec<Vec3<'g>>,
    rate: Vec<Vec3<'g>>,
    omega: Vec3<'g>,
    /// A_j but for what the modes' own accelerations give.
    still: Vec<Vec3<'g>>,
    /// A_j.
    acceleration: Vec<Vec3<'g>>,
}

fn unit<'g>(g: &'g Scope, axis: usize) -> Vec3<'g> {
    let mut unit = [0.0; 3];
    unit[axis] = 1.0;
    g.vector(unit)
}

impl<'g> Shapes<'g> {
    /// Nothing if the body has no basis.
    pub fn new(data: &'g ModalData) -> Option<Self> {
        let basis = data.basis()?;
        let axis = |j: usize| {
            let along = |i: usize| basis.directions.iter().any(|row| row[j][i] != 0.0);
            let axes: Vec<usize> = (0..3).filter(|i| along(*i)).collect();
            if let [axis] = axes[..] { Some(axis) } else { None }
        };
        let lines = (0..3).map(|along| {
            let mut functions: Vec<usize> =
                (0..basis.functions.len()).filter(|j| axis(*j) == Some(along)).collect();
            // A function that leaves takes those along that it has a product with.
            loop {
                let kept: Vec<usize> = functions
                    .iter()
                    .copied()
                    .filter(|j| {
                        basis.gram[*j]
                            .iter()
                            .enumerate()
                            .all(|(i, gram)| *gram == 0.0 || functions.contains(&i))
                    })
                    .collect();
                if kept.len() == functions.len() {
                    return Line { axis: along, functions };
                }
                functions = kept;
            }
        });
        let mut centres: Vec<Centre> = Vec::new();
        for (j, function) in basis.functions.iter().enumerate().filter(|(_, w)| w.integral != 0.0) {
            let place = function.first.map(|p| p / function.integral);
            let size = place.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            let same = |centre: &&mut Centre| {
                centre.place.iter().zip(&place).all(|(a, b)| (a - b).abs() <= SAME * size)
            };
            match centres.iter_mut().find(same) {
                Some(centre) => centre.functions.push(j),
                None => centres.push(Centre { place, functions: vec![j] }),
            }
        }
        let lines: Vec<Line> = lines.filter(|line| !line.functions.is_empty()).collect();
        let along = [0, 1, 2]
            .map(|axis| lines.iter().find(|line| line.axis == axis).map_or(&[][..], |line| &line.functions));
        let turnings = Turning::all(&basis, along, data);
        Some(Self { lines, centres, turnings, data, basis })
    }

    /// `sum_k e_kj x_k` by function.
    fn combined(&self, g: &'g Scope, x: &[Expr<'g>]) -> Vec<Vec3<'g>> {
        (0..self.basis.functions.len())
            .map(|j| {
                let by_mode: Vec<[f64; 3]> = self.basis.directions.iter().map(|row| row[j]).collect();
                g.weighted_vectors(&by_mode, x)
            })
            .collect()
    }

    /// Accelerations by their definition.
    pub fn fields(&self, spin: Mat3<'g>, omega: Vec3<'g>, modes: &ModalState<'g>) -> Fields<'g> {
        let g = omega.scope();
        let two = 2.0 * omega;
        let [place, rate, second] = [&modes.q, &modes.v, &modes.v_dot].map(|x| self.combined(g, x));
        let still: Vec<Vec3<'g>> =
            place.iter().zip(&rate).map(|(place, rate)| spin * *place + two.cross(*rate)).collect();
        let acceleration = still.iter().zip(second).map(|(still, second)| *still + second).collect();
        Fields { place, rate, omega, still, acceleration }
    }

    /// For other accelerations of the frame and of the modes, by what they differ.
    pub fn changed(&self, fields: &Fields<'g>, alpha: Vec3<'g>, v_dot: &[Expr<'g>]) -> Fields<'g> {
        let second = self.combined(alpha.scope(), v_dot);
        let mut changed = fields.clone();
        for (j, second) in second.into_iter().enumerate() {
            let turned = alpha.cross(fields.place[j]);
            changed.still[j] += turned;
            changed.acceleration[j] += turned + second;
        }
        changed
    }

    fn on_line(&self, function: usize) -> bool {
        self.lines.iter().any(|line| line.functions.contains(&function))
    }

    /// `sum_i G_ji x_i`.
    fn momentum(&self, function: usize, x: &[Vec3<'g>]) -> Vec3<'g> {
        let row = &self.basis.gram[function];
        Vec3::from_fn(|i| {
            let scope = x[0].scope();
            scope.sum(
                row.iter().zip(x).filter(|(weight, _)| **weight != 0.0).map(|(weight, x)| *weight * x[i]),
            )
        })
    }

    /// `sum weight_j x_j`.
    fn weighted(&self, g: &'g Scope, list: impl Iterator<Item = (f64, usize)>, x: &[Vec3<'g>]) -> Vec3<'g> {
        list.filter(|(weight, _)| *weight != 0.0)
            .fold(g.zero_vector(), |sum, (weight, j)| sum + weight * x[j])
    }

    /// Inertial wrench about the origin of the floating frame; what `known` has of `sum U_j x ..` along the axes comes from there.
    pub fn wrench(&self, fields: &Fields<'g>, frame: &Acceleration<'g>, known: &ByModes<'g>) -> Wrench<'g> {
        let g = frame.origin.scope();
        let Fields { place, rate, omega, acceleration, .. } = fields;
        let other =
            |turned: Vec3<'g>| Vec3::from_fn(|i| if known[i].is_some() { g.zero() } else { turned[i] });
        let first = g.vector(self.data.first_moment);
        let product = frame.spin * g.matrix(self.data.second_moment);
        let mut force = self.data.mass * frame.origin + frame.spin * first;
        let mut moment = first.cross(frame.origin) + product.axial();
        for centre in &self.centres {
            let weights = || centre.functions.iter().map(|j| (self.basis.functions[*j].integral, *j));
            let moved = self.weighted(g, weights(), acceleration);
            force += moved;
            let at = g.vector(centre.place);
            moment += at.cross(moved) + other(self.weighted(g, weights(), place).cross(frame.at(at)));
        }
        for axis in 0..3 {
            let weights = || {
                let functions = self.basis.functions.iter().enumerate();
                functions.filter(|(_, w)| w.integral == 0.0).map(|(j, w)| (w.first[axis], j))
            };
            let along = unit(g, axis);
            moment += along.cross(self.weighted(g, weights(), acceleration));
            moment += other(self.weighted(g, weights(), place).cross(frame.spin * along));
        }
        for line in &self.lines {
            let along = unit(g, line.axis);
            let (mut square, mut mixed) = (g.zero(), g.zero());
            for i in &line.functions {
                for j in &line.functions {
                    let gram = self.basis.gram[*i][*j];
                    if gram != 0.0 {
                        square += gram * (place[*i][line.axis] * place[*j][line.axis]);
                        mixed += gram * (place[*i][line.axis] * rate[*j][line.axis]);
                    }
                }
            }
            moment += other(square * along.cross(frame.spin * along));
            moment += other((2.0 * mixed) * along.cross(omega.cross(along)));
        }
        for j in (0..place.len()).filter(|j| !self.on_line(*j)) {
            let row = &self.basis.gram[j];
            // One product less where the function is like itself only.
            let alone = (0..row.len()).all(|i| i == j || row[i] == 0.0);
            moment += other(if alone {
                row[j] * place[j].cross(acceleration[j])
            } else {
                place[j].cross(self.momentum(j, acceleration))
            });
        }
        for (i, known) in known.iter().enumerate() {
            moment[i] += known.unwrap_or(g.zero());
        }
        Wrench { moment, force }
    }

    /// Inertial force of every mode.
    pub fn forces(&self, fields: &Fields<'g>, frame: &Acceleration<'g>, v_dot: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let g = frame.origin.scope();
        // Of the frame's motion and of the shape's: what the mode has by its own acceleration is M q''.
        let held: Vec<Vec3<'g>> = (0..self.basis.functions.len()).map(|j| self.held(j, frame)).collect();
        self.basis
            .directions
            .iter()
            .enumerate()
            .map(|(k, row)| {
                let mut sum = g.zero();
                for (j, direction) in row.iter().enumerate().filter(|(_, e)| **e != [0.0; 3]) {
                    let direction = g.vector(*direction);
                    sum += direction.dot(held[j]) + direction.dot(self.felt(j, fields, frame));
                }
                sum + g.weighted(self.data.mass_matrix[k].iter().copied(), v_dot)
            })
            .collect()
    }

    /// `g_j a_O + spin p_j`.
    fn held(&self, j: usize, frame: &Acceleration<'g>) -> Vec3<'g> {
        let g = frame.origin.scope();
        let function = &self.basis.functions[j];
        match self.centres.iter().find(|centre| centre.functions.contains(&j)) {
            Some(centre) => function.integral * frame.at(g.vector(centre.place)),
            None => frame.spin * g.vector(function.first),
        }
    }

    /// Whether [`Self::by_modes`] knows anything.
    pub fn turns(&self) -> bool {
        !self.turnings.is_empty()
    }

    /// Where modes move by what they feel: `besides` what inertia and stiffness do to each.
    pub fn by_modes(
        &self,
        frame: &Acceleration<'g>,
        modes: &ModalState<'g>,
        besides: &[Expr<'g>],
    ) -> ByModes<'g> {
        let mut known = ByModes::default();
        for turning in &self.turnings {
            let held = |j: usize| self.held(j, frame);
            turning.add_to(&mut known, (&self.basis, held), (frame.origin.scope(), modes), besides);
        }
        known
    }

    /// `sum_i G_ji A_i` but for the modes' own accelerations; of functions on a line only along it.
    fn felt(&self, j: usize, fields: &Fields<'g>, frame: &Acceleration<'g>) -> Vec3<'g> {
        let g = frame.origin.scope();
        let Some(line) = self.lines.iter().find(|line| line.functions.contains(&j)) else {
            return self.momentum(j, &fields.still);
        };
        let mut felt = g.zero_vector();
        // The factor of the frame's motion is common to all planes.
        felt[line.axis] = g.sum(line.functions.iter().map(|i| {
            (self.basis.gram[j][*i] * frame.spin[line.axis][line.axis]) * fields.place[*i][line.axis]
        }));
        felt
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derive::turned::Turned;
    use crate::flexible::cloud::{Cloud, numbers};

    type V = [f64; 3];

    fn cross(a: V, b: V) -> V {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    fn plus(a: V, b: V) -> V {
        [0, 1, 2].map(|i| a[i] + b[i])
    }

    /// Force, moment and modal forces of mass points that move as told: alpha, omega, a_O, q, v, v_dot.
    fn by_points(cloud: &Cloud, [alpha, omega, origin]: [V; 3], [q, v, v_dot]: [&[f64]; 3]) -> Vec<f64> {
        let mut felt = vec![0.0; 6 + q.len()];
        for point in &cloud.points {
            let at = plus(point.place, cloud.moved(q, point));
            let carried = plus(cross(alpha, at), cross(omega, cross(omega, at)));
            let coriolis = cross(omega, cloud.moved(v, point)).map(|x| 2.0 * x);
            let total = plus(plus(origin, carried), plus(coriolis, cloud.moved(v_dot, point)));
            let force = total.map(|x| point.mass * x);
            let moment = cross(at, force);
            for i in 0..3 {
                felt[i] += force[i];
                felt[3 + i] += moment[i];
                (0..q.len()).for_each(|k| felt[6 + k] += cloud.shape(k, point)[i] * force[i]);
            }
        }
        felt
    }

    /// Two functions along one axis with a product, of which one alone has a product with a third along another.
    fn crossed() -> Cloud {
        let mut cloud = Cloud::rod(1, 5);
        for point in &mut cloud.points {
            let [deflection, tilt] = [point.shapes[0], point.shapes[1]];
            point.shapes = vec![deflection, tilt, deflection + tilt];
        }
        let along = |function: usize, axis: usize| {
            let mut row = vec![[0.0; 3]; 3];
            row[function][axis] = 1.0;
            row
        };
        cloud.directions = vec![along(0, 2), along(1, 1), along(2, 1)];
        cloud
    }

    #[test]
    fn wrench_and_modal_forces_are_those_of_mass_points() {
        // Tilts on lines, deflections with and without products among them, and functions in several components.
        for cloud in [Cloud::rod(1, 3), Cloud::rod(3, 8), Cloud::any(2, 4), Cloud::any(4, 6), crossed()] {
            let data = cloud.data();
            let (n, g) = (data.mode_count(), Scope::new());
            let shapes = Shapes::new(&data).expect("a basis");
            let mut next = numbers(17);
            let [alpha, omega, origin, turned] = [(); 4].map(|()| [next(), next(), next()]);
            let mut list = || -> Vec<f64> { (0..n).map(|_| next()).collect() };
            let [q, v, before, v_dot] = [(); 4].map(|()| list());
            let spin = |alpha: V| {
                let (turn, square) = (g.vector(alpha).skew(), g.vector(omega).skew());
                turn + square * square
            };
            let frame = |alpha: V| Acceleration {
                spin: spin(alpha),
                alpha: g.vector(alpha),
                origin: g.vector(origin),
                turned: Turned::own(g.vector(origin)),
            };
            let all = |x: &[f64]| -> Vec<Expr<'_>> { x.iter().map(|x| g.number(*x)).collect() };
            let modes = |v_dot: &[f64]| ModalState { q: all(&q), v: all(&v), v_dot: all(v_dot) };
            let fields = shapes.fields(spin(alpha), g.vector(omega), &modes(&v_dot));
            // The same by what the frame and the modes change from other accelerations.
            let change: Vec<f64> = v_dot.iter().zip(&before).map(|(now, before)| now - before).collect();
            let first = [0, 1, 2].map(|i| alpha[i] - turned[i]);
            let earlier = shapes.fields(spin(first), g.vector(omega), &modes(&before));
            let changed = shapes.changed(&earlier, g.vector(turned), &all(&change));
            let expected = by_points(&cloud, [alpha, omega, origin], [&q, &v, &v_dot]);
            let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            // What the modes feel tells the same of the moment.
            let felt = all(&expected[6..]);
            let by_modes = shapes.by_modes(&frame(alpha), &modes(&v_dot), &felt);
            let known = [ByModes::default(), by_modes];
            for (fields, known) in
                [fields, changed].iter().flat_map(|fields| known.map(|known| (fields, known)))
            {
                let wrench = shapes.wrench(fields, &frame(alpha), &known);
                let forces = shapes.forces(fields, &frame(alpha), &all(&v_dot));
                let found = wrench.force.into_iter().chain(wrench.moment).chain(forces);
                for (found, expected) in found.zip(&expected) {
                    let found = found.as_number().expect("numbers make a number");
                    // Shares of functions are known to 1e-12.
                    assert!((found - expected).abs() < 1e-11 * size, "{found} is not {expected}");
                }
            }
        }
    }

    #[test]
    fn tilts_of_a_rod_lie_on_a_line() {
        let data = Cloud::rod(2, 3).data();
        let shapes = Shapes::new(&data).expect("a basis");
        assert_eq!(shapes.lines.iter().map(|line| line.functions.len()).collect::<Vec<_>>(), [4]);
        assert!(shapes.turns());
    }
}
