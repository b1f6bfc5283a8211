//! The rows that each joint kind takes away, with residual, unit wrench and acceleration bias.
//! In: relative motion across the cut. Out: [`Row`]s. Never knows the tree.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::model::JointModel;

use super::across::{Across, JointAxes, Sides};
use super::geometry::Geometry;
use super::row::Row;

/// Makes the rows of one cut.
pub struct RowMaker<'a, 'g> {
    g: &'g Scope,
    across: &'a Across<'g>,
    sides: Sides,
    axes: JointAxes,
    exact: bool,
    rows: Vec<Row<'g>>,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

impl<'a, 'g> RowMaker<'a, 'g> {
    /// For the cut between the given sides; with `exact` the moments hold off the closed positions too.
    pub fn new(g: &'g Scope, across: &'a Across<'g>, sides: Sides, axes: JointAxes, exact: bool) -> Self {
        Self { g, across, sides, axes, exact, rows: Vec::new() }
    }

    /// The rows of a joint: no translation along axes that nothing slides along; no rotation but about the axes
    /// that something turns about; a thread ties both.
    pub fn joint(mut self, geometry: &Geometry<'g>, joint: &JointModel) -> Vec<Row<'g>> {
        let own = self.own_axes();
        let frame = match (joint.axes.is_empty(), self.sides.beside()) {
            (false, _) => "the joint",
            (true, None) => "ground",
            (true, Some(at)) => &geometry.mechanism.body(geometry.linkage.links[at].body).name,
        };
        self.translations(&joint.held_axes(), own, frame);
        match joint.turns().len() {
            _ if joint.turns_freely() => {}
            0 => self.rotations(own),
            1 => self.tilts(own),
            _ => self.cross(geometry, joint.axes[1].child),
        }
        if let Some(advance) = joint.thread() {
            self.thread(own[2], advance);
        }
        self.rows
    }

    /// Joint axes of the side that lends its frame: constants.
    fn own_axes(&mut self) -> [Vec3<'g>; 3] {
        let frame = if self.sides.in_child { self.axes.child } else { self.axes.parent };
        [0, 1, 2].map(|j| self.g.vector(frame.axis(j)))
    }

    fn beside_omega(&self) -> Vec3<'g> {
        if self.sides.in_child { self.across.child_omega } else { self.across.parent_omega }
    }

    fn translations(&mut self, which: &[usize], axes: [Vec3<'g>; 3], frame: &str) {
        for &j in which {
            let u = axes[j];
            let residual = self.g.dot3(u, self.across.distance);
            let meaning = format!("translation along {} of {frame}", NAMES[j]);
            self.push_translation(meaning, residual, u);
        }
    }

    /// u . (a_C - a_P) - u . ((omega_beside + omega_P) x slide).
    fn translation_bias(&mut self, u: Vec3<'g>) -> Expr<'g> {
        let beside = self.beside_omega();
        let sum = self.g.add3(beside, self.across.parent_omega);
        let turned = self.g.cross3(sum, self.across.slide);
        let rate = self.g.sub3(self.across.acceleration, turned);
        self.g.dot3(u, rate)
    }

    /// u . (alpha_C - alpha_P) - u . (omega_beside x omega_rel).
    fn rotation_bias(&mut self, u: Vec3<'g>) -> Expr<'g> {
        let beside = self.beside_omega();
        let turned = self.g.cross3(beside, self.across.omega);
        let rate = self.g.sub3(self.across.alpha, turned);
        self.g.dot3(u, rate)
    }

    fn push_translation(&mut self, meaning: String, residual: Expr<'g>, u: Vec3<'g>) {
        let bias = self.translation_bias(u);
        let rate = self.g.dot3(u, self.across.slide);
        let moment = self.g.zero_vector();
        self.rows.push(Row { meaning, angular: false, residual, moment, force: u, rate, bias });
    }

    fn push_rotation(&mut self, meaning: String, residual: Expr<'g>, u: Vec3<'g>) {
        let bias = self.rotation_bias(u);
        let rate = self.g.dot3(u, self.across.omega);
        let force = self.g.zero_vector();
        self.rows.push(Row { meaning, angular: true, residual, moment: u, force, rate, bias });
    }

    /// The joint axis of the other side stays on that of this side: two rows.
    fn tilts(&mut self, own: [Vec3<'g>; 3]) {
        let other = if self.sides.in_child {
            self.across.parent_axis(self.g, &self.axes, 2)
        } else {
            self.across.child_axis(self.g, &self.axes, 2)
        };
        let (about_y, about_x) = (self.g.dot3(other, own[0]), self.g.dot3(other, own[1]));
        let [x, y] =
            if self.sides.in_child { [about_x, self.g.neg(about_y)] } else { [self.g.neg(about_x), about_y] };
        // On closed positions `other` is own[2] and the moments are own[0] and own[1].
        let moments = if self.exact {
            [self.g.cross3(own[1], other), self.g.cross3(other, own[0])]
        } else {
            [own[0], own[1]]
        };
        self.push_rotation("tilt about x of the joint".to_owned(), x, moments[0]);
        self.push_rotation("tilt about y of the joint".to_owned(), y, moments[1]);
    }

    /// No relative rotation: three rows, the axial vector of the relative rotation matrix.
    fn rotations(&mut self, own: [Vec3<'g>; 3]) {
        let rotation: Mat3<'g> = self.across.rotation(self.g, &self.axes);
        let half = self.g.constant(0.5);
        for (j, axis) in own.into_iter().enumerate() {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            let difference = self.g.sub(rotation[l][k], rotation[k][l]);
            let residual = self.g.mul(half, difference);
            let axis = if self.exact { self.turned_axis(&rotation, j) } else { axis };
            self.push_rotation(format!("rotation about {} of the joint", NAMES[j]), residual, axis);
        }
    }

    /// Row `j` of (tr(E) 1 - E) / 2 in the common frame: how the axial part of the relative rotation E changes.
    fn turned_axis(&mut self, rotation: &Mat3<'g>, j: usize) -> Vec3<'g> {
        let half = self.g.constant(0.5);
        let partial = self.g.add(rotation[0][0], rotation[1][1]);
        let trace = self.g.add(partial, rotation[2][2]);
        let mut sum = self.g.zero_vector();
        for (k, entry) in rotation[j].into_iter().enumerate() {
            let axis = self.across.parent_axis(self.g, &self.axes, k);
            let minus = self.g.neg(entry);
            let weight = if k == j { self.g.add(trace, minus) } else { minus };
            let weight = self.g.mul(half, weight);
            let part = self.g.scale3(weight, axis);
            sum = self.g.add3(sum, part);
        }
        sum
    }

    /// The two axes of a universal joint keep their angle: one row about their common normal.
    fn cross(&mut self, geometry: &Geometry<'g>, second: [f64; 3]) {
        let g = self.g;
        let across = self.across;
        let frame = match self.sides.child {
            None => super::frame::Frame::IDENTITY,
            Some(at) => geometry.linkage.links[at].frame,
        };
        let a = across.parent_axis(g, &self.axes, 2);
        let b_child = g.vector(frame.local(second));
        let b = g.mul_vec3(across.from_child, b_child);
        let first_in_child = g.vector(self.axes.child.axis(2));
        let angle = g.dot3(first_in_child, b_child);
        let product = g.dot3(a, b);
        let residual = g.sub(angle, product);
        let u = g.cross3(a, b);
        // du/dt = (omega_P x a) x b + a x (omega_C x b)
        let (turned_a, turned_b) = (g.cross3(across.parent_omega, a), g.cross3(across.child_omega, b));
        let (first, second) = (g.cross3(turned_a, b), g.cross3(a, turned_b));
        let u_dot = g.add3(first, second);
        let (moving, steady) = (g.dot3(u_dot, across.omega), g.dot3(u, across.alpha));
        let bias = g.add(moving, steady);
        let rate = g.dot3(u, across.omega);
        let force = g.zero_vector();
        let meaning = "twist about the common normal of both axes".to_owned();
        self.rows.push(Row { meaning, angular: true, residual, moment: u, force, rate, bias });
    }

    /// Advance and turn of a screw stay in proportion. The residual `-h sin(angle - stroke / h)` is smooth
    /// over many turns.
    fn thread(&mut self, z: Vec3<'g>, advance: f64) {
        let rotation = self.across.rotation(self.g, &self.axes);
        let g = self.g;
        let (h, reciprocal) = (g.constant(advance), g.constant(1.0 / advance));
        let stroke = g.dot3(z, self.across.distance);
        let angle = g.mul(reciprocal, stroke);
        let (sine, cosine) = (g.sin(angle), g.cos(angle));
        let (turned, level) = (g.mul(rotation[1][0], cosine), g.mul(rotation[0][0], sine));
        let difference = g.sub(level, turned);
        let residual = g.mul(h, difference);
        let minus_h = g.constant(-advance);
        let moment = g.scale3(minus_h, z);
        let (slid, spun) = (self.translation_bias(z), self.rotation_bias(z));
        let g = self.g;
        let part = g.mul(minus_h, spun);
        let bias = g.add(slid, part);
        let (along, about) = (g.dot3(z, self.across.slide), g.dot3(z, self.across.omega));
        let part = g.mul(minus_h, about);
        let rate = g.add(along, part);
        let meaning = "advance against turn of the thread".to_owned();
        self.rows.push(Row { meaning, angular: false, residual, moment, force: z, rate, bias });
    }
}
