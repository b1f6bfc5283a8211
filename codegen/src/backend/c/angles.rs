//! Which sines and cosines a function computes side by side: compilers then take one vector operation for two or four of them. In: a
//! tape and one of its parts. Out: [`Group`]s. The bits are those of one after the other.

use crate::tape::{Op, Operand, Part, Statement, Tape};

/// Most angles at once: what a register of 256 bits holds.
const WIDEST: usize = 4;

/// Angles of which sine and cosine are computed together, in the order of their statements.
pub struct Group {
    /// The values that begin at each statement, as in [`Statement::first`].
    pub firsts: Vec<u32>,
    pub angles: Vec<Operand>,
}

/// By statement of a part that computes a group, its first: all groups of two or more. At the first all angles are known.
pub fn groups(tape: &Tape, part: &Part) -> Vec<Group> {
    let angles = |statement: &Statement| match statement.op {
        Op::SinCos(angle) => Some((statement.first, angle)),
        _ => None,
    };
    let mut left: Vec<(u32, Operand)> =
        tape.statements[part.statements.clone()].iter().filter_map(angles).collect();
    let mut groups = Vec::new();
    while let Some((first, _)) = left.first().copied() {
        let known: Vec<(u32, Operand)> =
            left.iter().filter(|(_, angle)| is_known(*angle, first)).take(WIDEST).copied().collect();
        // Two or four: three would leave a part of a vector empty.
        let chosen = if known.len() == 3 { &known[..2] } else { &known[..] };
        left.retain(|(other, _)| *other != first && chosen.iter().all(|(taken, _)| taken != other));
        if chosen.len() > 1 {
            let (firsts, angles) = chosen.iter().copied().unzip();
            groups.push(Group { firsts, angles });
        }
    }
    groups
}

/// Whether an operand is known where the value `first` is computed.
fn is_known(angle: Operand, first: u32) -> bool {
    match angle {
        Operand::Input(_) => true,
        Operand::Value(value) => value < first,
        // Folded before it comes here; alone it costs nothing.
        Operand::Constant(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tape::split;

    /// Sines and cosines of angles in this order; values are numbered as they come, two for each.
    fn grouped(angles: &[Operand]) -> Vec<Vec<u32>> {
        let statement = |(at, angle): (u32, &Operand)| Statement {
            op: Op::SinCos(*angle),
            first: 2 * at,
            labels: [None, None],
            section: 0,
            stores: vec![(at, Operand::Value(2 * at))],
        };
        let tape = Tape {
            name: "angles".to_owned(),
            doc: String::new(),
            inputs: Vec::new(),
            input_names: (0..9).map(|at| format!("x{at}")).collect(),
            outputs: Vec::new(),
            direct: Vec::new(),
            statements: (0..).zip(angles).map(statement).collect(),
            sections: vec![String::new()],
            values: 2 * u32::try_from(angles.len()).unwrap(),
        };
        let parts = split(&tape, crate::tape::PART_LIMIT).parts;
        parts.iter().flat_map(|part| groups(&tape, part)).map(|group| group.firsts).collect()
    }

    #[test]
    fn angles_that_are_known_go_together_by_two_or_four() {
        let known = [0, 1, 2, 3, 4, 5, 6].map(Operand::Input);
        assert_eq!(grouped(&known[..1]), Vec::<Vec<u32>>::new());
        assert_eq!(grouped(&known[..2]), [[0, 2]]);
        assert_eq!(grouped(&known[..3]), [[0, 2]]);
        assert_eq!(grouped(&known), [vec![0, 2, 4, 6], vec![8, 10]]);
    }

    #[test]
    fn no_angle_goes_before_it_is_known() {
        // The second is of a sine that the first group computes; the third is known from the beginning.
        let angles = [Operand::Input(0), Operand::Value(1), Operand::Input(2), Operand::Value(3)];
        assert_eq!(grouped(&angles), [[0, 4]]);
        assert!(!is_known(Operand::Value(1), 1));
    }
}
