//! The rows that each joint kind takes away, with residual, unit wrench and acceleration bias.
//! In: relative motion across the cut. Out: [`Row`]s. Never knows the tree.

use crate::expr::{Expr, Mat3, Scope, Vec3};
use crate::model::JointModel;

use super::frame::canonical_frame;
use super::geometry::Geometry;
use super::relative_motion::{RelativeMotion, Side};
use super::row::{Bias, Row};

/// Makes the rows of one cut.
pub struct RowMaker<'a, 'g> {
    g: &'g Scope,
    motion: &'a RelativeMotion<'g>,
    exact: bool,
    /// Of it, what the joint leaves free.
    free: FreePart<'g>,
    rows: Vec<Row<'g>>,
}

/// Relative velocity.
#[derive(Clone, Copy)]
struct FreePart<'g> {
    slide: Vec3<'g>,
    omega: Vec3<'g>,
}

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Axes of which the last is a number in W: those of W, put so that it is the last.
fn plane_axes<'g>(g: &'g Scope, last: Vec3<'g>) -> [Vec3<'g>; 3] {
    let numbers = last.0.map(|x| x.as_number().unwrap_or(0.0));
    let frame = canonical_frame(numbers, |_| None).0;
    [0, 1, 2].map(|j| g.vector(frame.axis(j)))
}

impl<'a, 'g> RowMaker<'a, 'g> {
    /// For the cut with this motion; with `exact` the moments hold off the closed positions too.
    pub fn new(motion: &'a RelativeMotion<'g>, exact: bool) -> Self {
        let free = FreePart { slide: motion.slide, omega: motion.omega };
        Self { g: motion.distance.scope(), motion, exact, free, rows: Vec::new() }
    }

    /// The rows of a joint: no translation along axes that nothing slides along; no rotation but about the axes
    /// that something turns about; a thread ties both.
    pub fn joint(mut self, geometry: &Geometry<'g>, joint: &JointModel) -> Vec<Row<'g>> {
        let own = self.own_axes();
        self.free = self.free_part(joint, own);
        let frame = match (joint.axes.is_empty(), self.motion.beside()) {
            (false, Some(_)) => "the joint",
            (false, None) if self.motion.side != Side::Ground => "the joint",
            (false, None) => "ground",
            (true, None) => "ground",
            (true, Some(at)) => &geometry.mechanism.body(geometry.linkage.links[at].body).name,
        };
        self.translations(&joint.held_axes(), own, frame);
        match joint.turns().len() {
            _ if joint.turns_freely() => {}
            0 => self.rotations(own),
            1 => self.tilts(own),
            3 => {}
            _ => self.cross(geometry, joint.axes[1].child),
        }
        if let Some(advance) = joint.thread() {
            self.thread(own[2], advance);
        }
        self.rows
    }

    /// Joint axes of the side that lends its frame, constants; in W, whose own axes serve as well.
    fn own_axes(&self) -> [Vec3<'g>; 3] {
        let side = match self.motion.side {
            Side::Parent => &self.motion.parent,
            Side::Child => &self.motion.child,
            Side::Ground => return plane_axes(self.g, self.motion.child_axis(2)),
        };
        [0, 1, 2].map(|j| self.g.vector(side.frame.axis(j)))
    }

    fn beside_omega(&self) -> Vec3<'g> {
        match self.motion.side {
            Side::Parent => self.motion.parent_omega,
            Side::Child => self.motion.child_omega,
            Side::Ground => self.g.zero_vector(),
        }
    }

    fn translations(&mut self, which: &[usize], axes: [Vec3<'g>; 3], frame: &str) {
        for &j in which {
            let u = axes[j];
            let residual = u.dot(self.motion.distance);
            let (bias, rate) =
                (self.both(|relative| self.translation_bias(u, relative)), u.dot(self.motion.slide));
            let (meaning, moment) =
                (format!("translation along {} of {frame}", NAMES[j]), self.g.zero_vector());
            self.rows.push(Row { meaning, angular: false, residual, moment, force: u, rate, bias });
        }
    }

    /// On closed states the rows' own velocity constraints hold, so that only what the joint leaves free is not zero.
    /// What numbers of one state show must not be used here: these facts hold in every assembly.
    fn free_part(&self, joint: &JointModel, own: [Vec3<'g>; 3]) -> FreePart<'g> {
        let along = |vector: Vec3<'g>, axes: &[usize]| {
            axes.iter().fold(self.g.zero_vector(), |sum, j| sum + own[*j].dot(vector) * own[*j])
        };
        let held = joint.held_axes();
        let slides: Vec<usize> = (0..3).filter(|axis| !held.contains(axis)).collect();
        let slide = along(self.motion.slide, &slides);
        let omega = match joint.turns().len() {
            _ if joint.turns_freely() => self.motion.omega,
            0 => self.g.zero_vector(),
            1 => along(self.motion.omega, &[2]),
            _ => self.motion.omega,
        };
        FreePart { slide, omega }
    }

    /// A bias with the whole relative velocity, and with what is free of it.
    fn both(&self, bias: impl Fn(&FreePart<'g>) -> Expr<'g>) -> Bias<'g> {
        let whole = FreePart { slide: self.motion.slide, omega: self.motion.omega };
        Bias { whole: bias(&whole), closed: bias(&self.free) }
    }

    /// u . (a_C - a_P) - u . ((omega_beside + omega_P) x slide).
    fn translation_bias(&self, u: Vec3<'g>, relative: &FreePart<'g>) -> Expr<'g> {
        if self.motion.side == Side::Ground {
            return u.dot(self.motion.acceleration);
        }
        let turning = self.beside_omega() + self.motion.parent_omega;
        u.dot(self.motion.acceleration - turning.cross(relative.slide))
    }

    /// u . (alpha_C - alpha_P) - u . (omega_beside x omega_rel).
    fn rotation_bias(&self, u: Vec3<'g>, relative: &FreePart<'g>) -> Expr<'g> {
        u.dot(self.motion.alpha - self.beside_omega().cross(relative.omega))
    }

    fn push_rotation(&mut self, meaning: &str, residual: Expr<'g>, moment: Vec3<'g>, bias: Bias<'g>) {
        let (meaning, force) = (meaning.to_owned(), self.g.zero_vector());
        let rate = moment.dot(self.motion.omega);
        self.rows.push(Row { meaning, angular: true, residual, moment, force, rate, bias });
    }

    /// The joint axis of the other side stays on that of this side: two rows.
    fn tilts(&mut self, own: [Vec3<'g>; 3]) {
        let in_child = self.motion.side != Side::Parent;
        let other = if in_child { self.motion.parent_axis(2) } else { self.motion.child_axis(2) };
        let (about_y, about_x) = (other.dot(own[0]), other.dot(own[1]));
        let [x, y] = if in_child { [about_x, -about_y] } else { [-about_x, about_y] };
        // On closed positions `other` is own[2] and the moments are own[0] and own[1].
        let moments = if self.exact { [own[1].cross(other), other.cross(own[0])] } else { [own[0], own[1]] };
        let bias = moments.map(|moment| self.both(|relative| self.rotation_bias(moment, relative)));
        self.push_rotation("tilt about x of the joint", x, moments[0], bias[0]);
        self.push_rotation("tilt about y of the joint", y, moments[1], bias[1]);
    }

    /// No relative rotation: three rows, the axial vector of the relative rotation matrix.
    fn rotations(&mut self, own: [Vec3<'g>; 3]) {
        let rotation = self.motion.rotation();
        for (j, axis) in own.into_iter().enumerate() {
            let (k, l) = ((j + 1) % 3, (j + 2) % 3);
            let residual = 0.5 * (rotation[l][k] - rotation[k][l]);
            let axis = if self.exact { self.turned_axis(rotation, j) } else { axis };
            let meaning = format!("rotation about {} of the joint", NAMES[j]);
            let bias = self.both(|relative| self.rotation_bias(axis, relative));
            self.push_rotation(&meaning, residual, axis, bias);
        }
    }

    /// Row `j` of (tr(E) 1 - E) / 2 in the common frame: how the axial part of the relative rotation E changes.
    fn turned_axis(&self, rotation: Mat3<'g>, j: usize) -> Vec3<'g> {
        let trace = rotation.trace();
        let mut sum = self.g.zero_vector();
        for (k, entry) in rotation[j].into_iter().enumerate() {
            let axis = self.motion.parent_axis(k);
            let minus = -entry;
            let weight = if k == j { trace + minus } else { minus };
            sum += 0.5 * weight * axis;
        }
        sum
    }

    /// The two axes a, b of a universal joint keep their angle: one row about their common normal u = a x b.
    fn cross(&mut self, geometry: &Geometry<'g>, second: [f64; 3]) {
        let motion = self.motion;
        let frame = geometry.linkage.frame(motion.child.link);
        let a = motion.parent_axis(2);
        let b_child = self.g.vector(frame.local(second));
        let b = motion.from_child * b_child;
        let a_child = self.g.vector(motion.child.frame.axis(2));
        let residual = a_child.dot(b_child) - a.dot(b);
        let u = a.cross(b);
        let (a_dot, b_dot) = (motion.parent_omega.cross(a), motion.child_omega.cross(b));
        let u_dot = a_dot.cross(b) + a.cross(b_dot);
        let bias = u_dot.dot(motion.omega) + u.dot(motion.alpha);
        let bias = Bias { whole: bias, closed: bias };
        self.push_rotation("twist about the common normal of both axes", residual, u, bias);
    }

    /// Advance h (per angle) and turn of a screw stay in proportion. The residual `-h (angle - stroke / h)`, but for whole turns, is
    /// smooth over many turns: of the angle its sine and cosine are known. The sine alone would vanish half a turn off as well.
    fn thread(&mut self, z: Vec3<'g>, h: f64) {
        let rotation = self.motion.rotation();
        let (scale, per_length) = (self.g.number(h), self.g.number(1.0 / h));
        let angle = per_length * z.dot(self.motion.distance);
        let (sine, cosine) = (angle.sin(), angle.cos());
        let turned = rotation[1][0] * cosine;
        let ahead = rotation[0][0] * sine - turned;
        let residual = scale * ahead.atan2(rotation[0][0] * cosine + rotation[1][0] * sine);
        let moment = -h * z;
        let bias =
            self.both(|relative| self.translation_bias(z, relative) + -h * self.rotation_bias(z, relative));
        let rate = z.dot(self.motion.slide) + -h * z.dot(self.motion.omega);
        let meaning = "advance against turn of the thread".to_owned();
        self.rows.push(Row { meaning, angular: false, residual, moment, force: z, rate, bias });
    }
}
