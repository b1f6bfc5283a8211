//! What was derived for one mechanism: functions over graphs. In: graphs with their functions. Out: [`Equations`], which finds the
//! function of an entry. Never knows how it was derived.

use std::fmt;
use std::sync::{Arc, OnceLock};

use linkwear_runtime::Entry;

use super::Function;
use crate::expr::{ExprId, Graph};

/// Functions over one graph.
#[derive(Clone, Debug)]
pub struct Derivation {
    /// The graph that they share.
    pub graph: Graph,
    /// One per entry, in the order of [`Entry::ALL`]; entries that are derived apart are not among them.
    pub functions: Vec<Function>,
}

impl Derivation {
    fn function(&self, entry: Entry) -> Option<(&Graph, &Function)> {
        let found = self.functions.iter().find(|function| function.name == entry.name());
        found.map(|function| (&self.graph, function))
    }

    fn is_finite(&self) -> bool {
        let outputs = self.functions.iter().flat_map(|function| &function.outputs);
        let roots: Vec<ExprId> = outputs.flat_map(|block| block.entries.iter().copied()).collect();
        let needed = self.graph.live(&self.graph.uses(&roots));
        needed.iter().all(|id| self.graph.as_constant(*id).is_none_or(f64::is_finite))
    }
}

/// Derives a function by itself.
type Derive = dyn Fn() -> Derivation + Send + Sync;

/// Everything derived for one mechanism: one function per [`Entry`].
#[derive(Clone)]
pub struct Equations {
    shared: Derivation,
    apart: Option<(Arc<Derive>, OnceLock<Derivation>)>,
}

impl fmt::Debug for Equations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Equations").field("shared", &self.shared).finish_non_exhaustive()
    }
}

impl Equations {
    /// Of all functions over one graph.
    pub fn of(graph: Graph, functions: Vec<Function>) -> Self {
        Self { shared: Derivation { graph, functions }, apart: None }
    }

    /// With what derives the functions that are not there, when one of them is asked for first.
    pub fn and_apart(self, derive: impl Fn() -> Derivation + Send + Sync + 'static) -> Self {
        Self { apart: Some((Arc::new(derive), OnceLock::new())), ..self }
    }

    /// The function of an entry and its graph; none if there is none.
    pub fn function(&self, entry: Entry) -> Option<(&Graph, &Function)> {
        self.shared.function(entry).or_else(|| self.apart()?.function(entry))
    }

    fn apart(&self) -> Option<&Derivation> {
        self.apart.as_ref().map(|(derive, made)| made.get_or_init(|| derive()))
    }

    /// Whether the function of an entry goes on from the one before. None that is derived apart does.
    pub fn goes_on(&self, entry: Entry) -> bool {
        self.shared.function(entry).is_some_and(|(_, function)| function.goes_on)
    }

    /// The function that goes on from that of an entry, over the same graph.
    pub fn next(&self, entry: Entry) -> Option<&Function> {
        let functions = &self.shared.functions;
        let at = functions.iter().position(|function| function.name == entry.name())?;
        functions.get(at + 1).filter(|next| next.goes_on)
    }

    /// All functions, in the order of [`Entry::ALL`], each with its graph.
    pub fn functions(&self) -> impl Iterator<Item = (&Graph, &Function)> {
        Entry::ALL.into_iter().filter_map(|entry| self.function(entry))
    }

    /// Number of nodes asked for, but for functions derived apart. Beyond a limit the graph is cut off and means nothing.
    pub fn wanted(&self) -> usize {
        self.shared.graph.wanted()
    }

    /// The same of functions derived apart, which are derived now.
    pub fn wanted_apart(&self) -> usize {
        self.apart().map_or(0, |apart| apart.graph.wanted())
    }

    /// Whether zeros stand in the place of the mass matrix.
    pub fn mass_is_left_out(&self) -> bool {
        let equations = self.function(Entry::EquationsOfMotion);
        let mass = equations.and_then(|(graph, equations)| Some((graph, equations.outputs.first()?)));
        mass.is_some_and(|(graph, mass)| {
            let is_zero = |id: &ExprId| graph.as_constant(*id) == Some(0.0);
            !mass.entries.is_empty() && mass.entries.iter().all(is_zero)
        })
    }

    /// Whether every number that they need is finite.
    pub fn is_finite(&self) -> bool {
        [Some(&self.shared), self.apart()].into_iter().flatten().all(Derivation::is_finite)
    }
}
