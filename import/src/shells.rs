//! The closed surfaces of a mesh that share no corner: which of them are holes, and whether these are within what they are holes of.
//! In: triangles. Out: a place at which a hole is in nothing. Never weighs.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::place::{cross, dot};
use super::stl::Triangle;

/// How often the other surfaces go round a point of a hole at least: once, and half as often where it lies on an edge of them.
const WITHIN: f64 = 0.5;
/// Points of a hole that are looked at. Most of them decide: a hole may touch what it is in, and then some of its points lie on that.
const POINTS: usize = 64;

/// The middle of a triangle of a surface that faces the other way than the whole, where no other surface goes round it: such a hole would
/// have a mass below zero.
pub fn hole_in_nothing(triangles: &[Triangle]) -> Option<[f64; 3]> {
    let shells = shells(triangles);
    if shells.len() < 2 {
        return None;
    }
    let volumes: Vec<f64> = shells.iter().map(|shell| volume(shell)).collect();
    let whole = volumes.iter().sum::<f64>().signum();
    let boxes: Vec<_> = shells.iter().map(|shell| bounds(shell)).collect();
    let is_within = |hole: usize, point: [f64; 3]| {
        // Outside of its box a surface does not go round a point.
        let around = (0..shells.len()).filter(|at| {
            let (low, high) = boxes[*at];
            *at != hole && (0..3).all(|i| low[i] <= point[i] && point[i] <= high[i])
        });
        whole * around.map(|at| turns_round(&shells[at], point)).sum::<f64>() > WITHIN
    };
    let in_nothing = |hole: usize| {
        let shell = &shells[hole];
        let points = shell.iter().step_by(shell.len().div_ceil(POINTS)).map(middle);
        let (within, outside): (Vec<_>, Vec<_>) = points.partition(|point| is_within(hole, *point));
        outside.first().copied().filter(|_| outside.len() > within.len())
    };
    (0..shells.len()).filter(|at| volumes[*at] * whole < 0.0).find_map(in_nothing)
}

fn middle([a, b, c]: &Triangle) -> [f64; 3] {
    std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0)
}

/// Least and greatest coordinates.
pub fn bounds(triangles: &[Triangle]) -> ([f64; 3], [f64; 3]) {
    let mut bounds = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in triangles.iter().flatten() {
        for (i, x) in corner.iter().enumerate() {
            bounds.0[i] = bounds.0[i].min(*x);
            bounds.1[i] = bounds.1[i].max(*x);
        }
    }
    bounds
}

/// What two corners in the same place have in common.
pub fn key(corner: [f64; 3]) -> [u64; 3] {
    // The sum makes -0 to 0.
    corner.map(|x| (x + 0.0).to_bits())
}

/// Triangles that hang together by corners.
fn shells(triangles: &[Triangle]) -> Vec<Vec<Triangle>> {
    let mut numbers = HashMap::new();
    let mut above: Vec<usize> = Vec::new();
    let mut corner = |corner: [f64; 3], above: &mut Vec<usize>| {
        *numbers.entry(key(corner)).or_insert_with(|| {
            above.push(above.len());
            above.len() - 1
        })
    };
    let mut firsts = Vec::with_capacity(triangles.len());
    for triangle in triangles {
        let [a, b, c] = triangle.map(|place| corner(place, &mut above));
        firsts.push(a);
        for other in [b, c] {
            let [one, other] = [a, other].map(|at| top(&mut above, at));
            above[one] = other;
        }
    }
    let mut places = HashMap::new();
    let mut shells: Vec<Vec<Triangle>> = Vec::new();
    for (triangle, first) in triangles.iter().zip(firsts) {
        let place = *places.entry(top(&mut above, first)).or_insert_with(|| {
            shells.push(Vec::new());
            shells.len() - 1
        });
        shells[place].push(*triangle);
    }
    shells
}

/// The corner that stands for all that hang together with this one.
fn top(above: &mut [usize], mut at: usize) -> usize {
    while above[at] != at {
        above[at] = above[above[at]];
        at = above[at];
    }
    at
}

/// Six times the volume, below zero of one that faces inwards.
fn volume(shell: &[Triangle]) -> f64 {
    let middle = shell[0][0];
    let volumes = shell.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|corner| from(middle, corner));
        dot(a, cross(b, c))
    });
    volumes.sum()
}

/// How often a surface goes round a point, by the solid angles of its triangles (Van Oosterom and Strackee 1983).
fn turns_round(shell: &[Triangle], point: [f64; 3]) -> f64 {
    let halves = shell.iter().map(|triangle| {
        let corners = triangle.map(|corner| from(point, corner));
        let [a, b, c] = corners;
        let [x, y, z] = corners.map(|corner| dot(corner, corner).sqrt());
        dot(a, cross(b, c)).atan2(x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y)
    });
    halves.sum::<f64>() / TAU
}

fn from(origin: [f64; 3], place: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| place[i] - origin[i])
}
