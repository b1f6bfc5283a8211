//! Numbers of a beam that symmetry makes equal become equal bits: both planes of a round section, both ends of a
//! uniform beam. Then what the equations make of them is one expression.

use super::data::ModalData;

/// Shapes are good to some 1e-14 of their size; what differs by less than this is the same number.
const SAME: f64 = 1e-12;

/// Beside the largest of its table, what is below this is rounding: it is left alone.
const DUST: f64 = 1e-13;

impl ModalData {
    /// With one magnitude in the place of all that are equal but for rounding, table by table; signs stay.
    pub fn with_equal_numbers(mut self) -> Self {
        share_magnitudes(self.gamma.iter_mut().flatten());
        share_magnitudes(self.moment.iter_mut().flatten().flatten());
        share_magnitudes(self.coupling.iter_mut().flatten().flatten().flatten());
        for table in [&mut self.mass_matrix, &mut self.stiffness, &mut self.damping] {
            share_magnitudes(table.iter_mut().flatten());
        }
        if let Some(second) = &mut self.second_order {
            share_magnitudes(second.gamma.iter_mut().flatten().flatten());
            share_magnitudes(second.moment.iter_mut().flatten().flatten().flatten());
        }
        share_magnitudes(self.nodes.iter_mut().flat_map(|node| node.displacement.iter_mut().flatten()));
        share_magnitudes(self.nodes.iter_mut().flat_map(|node| node.rotation.iter_mut().flatten()));
        let seconds = self.nodes.iter_mut().filter_map(|node| node.displacement2.as_mut());
        share_magnitudes(seconds.flatten().flatten().flatten());
        self
    }
}

/// Replaces each magnitude by that of the first entry of the table in its group. A group is measured from its smallest,
/// so that a chain of neighbours does not grow.
pub(super) fn share_magnitudes<'a>(table: impl Iterator<Item = &'a mut f64>) {
    share(table.enumerate().collect());
}

fn share(mut entries: Vec<(usize, &mut f64)>) {
    let largest = entries.iter().fold(0.0, |largest: f64, (_, entry)| largest.max(entry.abs()));
    entries.retain(|(_, entry)| entry.abs() > DUST * largest);
    entries.sort_by(|(i, a), (j, b)| a.abs().total_cmp(&b.abs()).then(i.cmp(j)));
    let mut rest = entries.as_mut_slice();
    while let Some((_, smallest)) = rest.first() {
        let smallest = smallest.abs();
        let end = rest.partition_point(|(_, entry)| entry.abs() - smallest <= SAME * smallest);
        let (group, left) = rest.split_at_mut(end.max(1));
        let first = group.iter().min_by_key(|(place, _)| *place).map_or(smallest, |(_, entry)| entry.abs());
        for (_, entry) in group {
            **entry = first.copysign(**entry);
        }
        rest = left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnitudes_that_differ_by_rounding_become_that_of_the_first() {
        let mut table = [0.3, -0.1 - 0.2, 0.3 + 1e-9, 0.0, 1e-15];
        share_magnitudes(table.iter_mut());
        assert_eq!(table, [0.3, -0.3, 0.3 + 1e-9, 0.0, 1e-15]);
    }

    #[test]
    fn a_chain_of_neighbours_is_cut() {
        // Steps of 0.6e-12: neighbours are the same number, the ends are not.
        let mut table = [1.0, 1.0 + 0.6e-12, 1.0 + 1.2e-12, 1.0 + 1.8e-12];
        let last = table[2];
        share_magnitudes(table.iter_mut());
        assert_eq!(table, [1.0, 1.0, last, last]);
    }
}
