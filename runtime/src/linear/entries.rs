//! Vectors that are mostly zeros, as places and entries. In: entries, places ascending. Out: products and differences over these alone.
//! The order of summation is fixed.

/// Places of a vector that are not zero, ascending, with what stands there.
pub type Entries = Vec<(usize, f64)>;

/// Of a vector with its zeros.
pub fn entries_of(vector: &[f64]) -> Entries {
    vector.iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0).collect()
}

/// Euclidean length.
pub fn length(entries: &[(usize, f64)]) -> f64 {
    entries.iter().map(|(_, entry)| entry * entry).sum::<f64>().sqrt()
}

/// Largest magnitude.
pub fn largest_entry(entries: &[(usize, f64)]) -> f64 {
    entries.iter().map(|(_, entry)| entry.abs()).fold(0.0, f64::max)
}

/// `sum` and the products of entries at one place, added in their order.
pub fn add_products(mut sum: f64, a: &[(usize, f64)], b: &[(usize, f64)]) -> f64 {
    let mut rest = b.iter().peekable();
    for (place, entry) in a {
        while rest.next_if(|(other, _)| other < place).is_some() {}
        sum += rest.next_if(|(other, _)| other == place).map_or(0.0, |(_, other)| other * entry);
    }
    sum
}

/// Takes a multiple of other entries from a vector. `is_new` hears of every place that was zero. `work` is overwritten.
pub fn subtract(
    vector: &mut Entries,
    (factor, entries): (f64, &[(usize, f64)]),
    work: &mut Entries,
    mut is_new: impl FnMut(usize),
) {
    work.clear();
    let mut rest = entries.iter().peekable();
    let mut new = |work: &mut Entries, (place, entry): (usize, f64)| {
        if factor * entry != 0.0 {
            work.push((place, -(factor * entry)));
            is_new(place);
        }
    };
    for (place, entry) in vector.iter() {
        while let Some(before) = rest.next_if(|(other, _)| other < place) {
            new(work, *before);
        }
        let here = rest.next_if(|(other, _)| other == place);
        let left = here.map_or(*entry, |(_, other)| entry - factor * other);
        if left != 0.0 {
            work.push((*place, left));
        }
    }
    rest.for_each(|after| new(work, *after));
    std::mem::swap(vector, work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_subtracted_where_either_has_entries() {
        let (mut vector, mut new) = (vec![(1, 2.0), (3, 4.0), (4, 1.0)], Vec::new());
        assert_eq!(entries_of(&[0.0, 2.0, 0.0, 4.0, 1.0]), vector);
        assert_eq!((length(&vector), largest_entry(&vector)), (21.0_f64.sqrt(), 4.0));
        let other = [(0, 1.0), (3, 2.0), (4, 1.0), (6, -1.0)];
        assert_eq!(add_products(0.5, &vector, &other), 0.5 + 8.0 + 1.0);
        subtract(&mut vector, (2.0, &other), &mut Vec::new(), |place| new.push(place));
        // At 3 nothing is left.
        assert_eq!((vector, new), (vec![(0, -2.0), (1, 2.0), (4, -1.0), (6, 2.0)], vec![0, 6]));
    }
}
