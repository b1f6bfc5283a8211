//! What elimination takes at least, by pattern: so that what is much too long is not even tried.
//! In: the tree of links, which entries of rows are not zero. Out: whether it takes more than a number of operations. Never knows
//! expressions.

use super::linkage::Linkage;

/// Whether the elimination of these speeds from the leaves to the root, then of these rows, takes more operations than that: at least a
/// product for every entry that changes. `free`: speeds of the pattern's columns, among all.
pub fn elimination_takes_more(
    than: usize,
    linkage: &Linkage,
    free: &[usize],
    pattern: &[Vec<bool>],
    (speeds, rows): (&[usize], &[usize]),
) -> bool {
    let mut link_of = vec![0; linkage.speeds()];
    for (at, link) in linkage.links.iter().enumerate() {
        link.speeds().for_each(|speed| link_of[speed] = at);
    }
    let mut place = vec![None; linkage.speeds()];
    speeds.iter().for_each(|speed| place[free[*speed]] = Some(*speed));
    // What is in the way of a speed besides its own mass: speeds of links further inwards.
    let inwards = |speed: usize| -> Vec<usize> {
        let first = free[speed];
        let links = linkage.path(Some(link_of[first]));
        let all = links.flat_map(|link| linkage.links[link].speeds());
        all.filter(|other| *other < first).filter_map(|other| place[other]).collect()
    };
    let mut touched: Vec<Vec<bool>> = rows.iter().map(|row| pattern[*row].clone()).collect();
    let mut tied = vec![vec![false; rows.len()]; rows.len()];
    let mut operations = 0;
    for speed in speeds.iter().rev() {
        let inwards = inwards(*speed);
        let own: Vec<usize> = (0..rows.len()).filter(|row| touched[*row][*speed]).collect();
        operations += entries(inwards.len() + own.len());
        // Long machines end here.
        if operations > than {
            return true;
        }
        for row in &own {
            inwards.iter().for_each(|other| touched[*row][*other] = true);
            own.iter().for_each(|other| tied[*row][*other] = true);
        }
    }
    // In their order: another one saves part of it, which tree and fill-in by speeds leave little of.
    operations + tied.iter().map(|row| row.iter().filter(|tied| **tied).count()).sum::<usize>() > than
}

/// Of the upper half of a symmetric matrix.
fn entries(size: usize) -> usize {
    size * (size + 1) / 2
}
