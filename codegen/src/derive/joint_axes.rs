//! The freedoms of a link's joint one by one.
//! In: a link. Out: constant motions in its frame, angular components first. Never knows expressions.

use super::linkage::{Freedom, Link};

/// Motion of a link per unit of each of its speeds, in the order of elimination; with the number of the speed.
pub fn axes(link: &Link) -> Vec<(usize, [f64; 6])> {
    let unit = |component: usize| std::array::from_fn(|i| f64::from(u8::from(i == component)));
    if let Some([turn, slide]) = link.freedom.screw() {
        return vec![(link.first_speed, [turn[0], turn[1], turn[2], slide[0], slide[1], slide[2]])];
    }
    // Mass alone is in the way of a translation: its pivot is a constant.
    let components: &[usize] = match link.freedom {
        Freedom::Ball => &[0, 1, 2],
        Freedom::Free => &[3, 4, 5, 0, 1, 2],
        _ => &[],
    };
    components.iter().map(|component| (link.first_speed + component, unit(*component))).collect()
}

/// The component that an axis moves alone, forwards or backwards.
pub fn single(along: &[f64; 6]) -> Option<(usize, f64)> {
    let mut moved = (0..6).filter(|i| along[*i] != 0.0);
    let first = moved.next()?;
    (moved.next().is_none() && along[first].abs() == 1.0).then(|| (first, along[first]))
}

/// Whether the motion of the parent link reaches a link's component: absolute speeds are its own.
pub fn passes(freedom: Freedom, component: usize) -> bool {
    match freedom {
        Freedom::Free => false,
        Freedom::Ball => component >= 3,
        _ => true,
    }
}
