//! How many rows of a table its argument has passed, kept beside the value that the table gives there. In: counts of rows, roots. Out:
//! those of the tables that the roots read. Never knows tables: a row belongs to what is chosen by the same conditions.

use rustc_hash::FxHashSet;

use super::expression::Expr;
use super::{ExprId, Node, Scope};

impl Scope {
    /// Keeps how many rows a table's argument has passed, chosen by the conditions that choose the table's pieces.
    pub fn note_row(&self, row: Expr<'_>) {
        self.make(|g| {
            if !g.rows.contains(&row.id()) {
                g.rows.push(row.id());
            }
        });
    }

    /// Of the tables that roots read, how many rows have been passed, each once; those of arguments that are made of `constant`
    /// symbols alone are left out.
    pub fn rows<'g>(&'g self, roots: &[ExprId], constant: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let chosen_by: FxHashSet<ExprId> = self.conditions(roots).collect();
        let changes = |row: ExprId| {
            let symbols = self.nodes(&[row]).into_iter().filter(|(_, node)| matches!(node, Node::Symbol(_)));
            symbols.into_iter().any(|(id, _)| !constant.iter().any(|symbol| symbol.id() == id))
        };
        let all = self.make(|g| g.rows.clone());
        let read = all.into_iter().filter(|row| {
            self.conditions(&[*row]).any(|condition| chosen_by.contains(&condition)) && changes(*row)
        });
        read.map(|row| self.at(row)).collect()
    }

    /// Conditions by which the pieces that roots need are chosen.
    fn conditions(&self, roots: &[ExprId]) -> impl Iterator<Item = ExprId> {
        self.nodes(roots).into_iter().filter_map(|(_, node)| match node {
            Node::Select(by, ..) => Some(by),
            _ => None,
        })
    }
}
