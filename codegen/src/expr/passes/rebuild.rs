//! Copies a function to a graph of its own, node by node, through the constructors that fold and order.
//! Names and sections come along.

use std::sync::Arc;

use super::program::{Program, Whole};
use crate::expr::{Expr, ExprId, Graph, Node, Scope};

/// A copy under construction.
pub struct Rebuild<'a, 'g> {
    pub old: &'a Graph,
    pub scope: &'g Scope,
    /// By old node.
    made: Vec<Option<Expr<'g>>>,
}

/// Copies what the roots need in the old order; `each` makes every node.
pub fn copy(whole: &Whole<'_>, each: impl for<'g> FnMut(&mut Rebuild<'_, 'g>, ExprId)) -> Program {
    copy_of(whole, &whole.graph.uses(whole.roots), each)
}

/// The same, of which nodes are needed is known.
fn copy_of(
    whole: &Whole<'_>,
    uses: &[u32],
    mut each: impl for<'g> FnMut(&mut Rebuild<'_, 'g>, ExprId),
) -> Program {
    let scope = Scope::new();
    let (inputs, roots) = {
        let mut rebuild = Rebuild { old: whole.graph, scope: &scope, made: vec![None; uses.len()] };
        scope.make(|g| {
            g.sections = Arc::clone(&whole.graph.sections);
            g.section_by_title = Arc::clone(&whole.graph.section_by_title);
        });
        for id in whole.inputs {
            if let Some(symbol) = whole.graph.as_symbol(*id) {
                rebuild.set(*id, scope.symbol(whole.graph.symbol_name(symbol)));
            }
        }
        for id in whole.graph.live(uses) {
            let index = id.index();
            if rebuild.made[index].is_none() {
                scope.make(|g| g.current_section = whole.graph.section_of[index]);
                each(&mut rebuild, id);
                if let (Some(new), Some(name)) = (rebuild.made[index], whole.graph.labels.get(&id)) {
                    new.label(Arc::clone(name));
                }
            }
        }
        let new = |ids: &[ExprId]| ids.iter().map(|id| rebuild.get(*id).id()).collect();
        (new(whole.inputs), new(whole.roots))
    };
    Program::new(scope.into_graph(), inputs, roots)
}

impl Program {
    /// A copy of what is needed, with `each` in charge of every node.
    pub fn rebuilt(&self, each: impl for<'g> FnMut(&mut Rebuild<'_, 'g>, ExprId)) -> Self {
        let whole = Whole { graph: &self.graph, inputs: &self.inputs, roots: &self.roots };
        copy_of(&whole, self.uses(), each)
    }
}

impl<'g> Rebuild<'_, 'g> {
    /// What has become of an old node; zero for one that was left out, which nothing needs.
    pub fn get(&self, id: ExprId) -> Expr<'g> {
        let made = self.made[id.index()];
        debug_assert!(made.is_some(), "{id:?} was left out");
        made.unwrap_or_else(|| self.scope.zero())
    }

    /// Says what becomes of an old node.
    pub fn set(&mut self, id: ExprId, new: Expr<'g>) {
        self.made[id.index()] = Some(new);
    }

    /// Makes the same operation on what has become of the operands.
    pub fn again(&mut self, id: ExprId) {
        let new = match self.old.node(id) {
            Node::Constant(bits) => self.scope.number(f64::from_bits(bits)),
            // All symbols are inputs, which are there.
            Node::Symbol(symbol) => self.scope.symbol(self.old.symbol_name(symbol)),
            Node::Unary(operation, a) => self.get(a).through(operation),
            Node::Select(a, yes, no) => self.get(a).below_zero(self.get(yes), self.get(no)),
            Node::Binary(operation, a, b) => self.get(a).joined(operation, self.get(b)),
        };
        self.set(id, new);
    }
}
