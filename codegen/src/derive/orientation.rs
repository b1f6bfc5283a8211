//! Orientations as unit quaternions, scalar first.
//! In: [`Linkage`], coordinates. Out: expressions. Never knows velocities.

use crate::expr::{Expr, Mat3, Scope, Vec3};

use super::attachment::NodePose;
use super::linkage::{Freedom, LinkIndex, Linkage};

/// A unit quaternion, scalar first.
pub type Quaternion<'g> = [Expr<'g>; 4];

/// Rotation matrix of a unit quaternion.
pub fn rotation_of_quaternion<'g>([w, x, y, z]: Quaternion<'g>) -> Mat3<'g> {
    let (one, two) = (w.scope().number(1.0), w.scope().number(2.0));
    let [x2, y2, z2] = [x, y, z].map(|c| two * c);
    let [xx, yy, zz] = [x * x2, y * y2, z * z2];
    let [xy, xz, yz] = [x * y2, x * z2, y * z2];
    let [wx, wy, wz] = [w * x2, w * y2, w * z2];
    let diagonal = [one - (yy + zz), one - (xx + zz), one - (xx + yy)];
    Mat3([
        Vec3([diagonal[0], xy - wz, xz + wy]),
        Vec3([xy + wz, diagonal[1], yz - wx]),
        Vec3([xz - wy, yz + wx, diagonal[2]]),
    ])
}

/// Quaternion of a rotation vector: angle times axis [rad].
pub fn quaternion_of_vector<'g>(vector: Vec3<'g>) -> Quaternion<'g> {
    let square = vector.dot(vector);
    if square.is_zero() {
        return unturned(vector.scope());
    }
    let angle = square.sqrt();
    let half_angle = 0.5 * angle;
    let (sine, cosine) = (half_angle.sin(), half_angle.cos());
    let Vec3([x, y, z]) = (sine / angle) * vector;
    [cosine, x, y, z]
}

/// Product of quaternions: first `b`, then `a`.
pub fn quaternion_product<'g>(a: Quaternion<'g>, b: Quaternion<'g>) -> Quaternion<'g> {
    let [_, x, y, z] = conjugate(a);
    [
        a[0] * b[0] + x * b[1] + y * b[2] + z * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] + z * b[2],
        a[0] * b[2] + x * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] + y * b[1] + a[3] * b[0],
    ]
}

/// Inverse of a unit quaternion.
pub fn conjugate<'g>([scalar, x, y, z]: Quaternion<'g>) -> Quaternion<'g> {
    [scalar, -x, -y, -z]
}

/// Rotation of a link's body from its reference pose, in W.
pub fn link_displacement<'g>(
    g: &'g Scope,
    linkage: &Linkage,
    q: &[Expr<'g>],
    link: LinkIndex,
) -> Quaternion<'g> {
    let Some(at) = link else { return unturned(g) };
    let orientation = orientation(g, linkage, q, link);
    let frame = linkage.links[at].frame.quaternion().map(|x| g.number(x));
    quaternion_product(orientation, conjugate(frame))
}

/// Orientation of a link's frame in W.
fn orientation<'g>(g: &'g Scope, linkage: &Linkage, q: &[Expr<'g>], link: LinkIndex) -> Quaternion<'g> {
    let Some(at) = link else { return unturned(g) };
    let link = &linkage.links[at];
    let first = link.first_coordinate;
    if matches!(link.freedom, Freedom::Ball | Freedom::Free) {
        return [q[first], q[first + 1], q[first + 2], q[first + 3]];
    }
    let outer = orientation(g, linkage, q, link.parent);
    let mounted = quaternion_product(outer, link.mount.quaternion().map(|x| g.number(x)));
    if let Some(shape) = &link.node {
        let section = NodePose::new(g, shape, &q[link.coordinates()]).quaternion();
        let turn = if link.freedom == Freedom::Node { section } else { conjugate(section) };
        return quaternion_product(mounted, turn);
    }
    let Freedom::Rotation { offset, .. } = link.freedom else { return mounted };
    let (half, offset) = (g.number(0.5), g.number(offset));
    let angle = half * (q[first] + offset);
    let (sine, cosine, zero) = (angle.sin(), angle.cos(), g.zero());
    quaternion_product(mounted, [cosine, zero, zero, sine])
}

/// The identity.
fn unturned(g: &Scope) -> Quaternion<'_> {
    [g.number(1.0), g.zero(), g.zero(), g.zero()]
}
