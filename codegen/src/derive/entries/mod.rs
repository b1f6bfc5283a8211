//! What each entry point of the runtime's contract returns, as blocks of expressions.
//! In: mechanism, topology, which constraint rows to keep. Out: [`Derived`].
//! Never knows tapes. The only place that knows all parts of the derivation.

mod deriver;
mod description;
mod element_columns;
mod equations_of_motion;
mod functions;
mod joint_forces;
mod names;
mod observe;
mod own_states;
mod response_solution;
mod row_axes;

use linkwear_runtime::{Description, Entry, Sizes};

use crate::expr::{Expr, ExprId, Scope};
use crate::model::{Mechanism, Topology};

use super::geometry::Geometry;
use super::linkage::Linkage;
use super::linkage_build::linkage;
use super::plan::Guide;
use super::{Derivation, Equations, Function};
use deriver::{Deriver, inputs};
use functions::function;
pub(crate) use names::number_among;
pub use row_axes::{clearly_shorter, shorter_in_ground, shorter_off_balls, splits_plane_rows};

/// The result: equations, their layout, and what they are called.
#[derive(Clone, Debug)]
pub struct Derived {
    /// What was asked for; see [`Purpose`].
    pub equations: Equations,
    /// Layout (`workspace` is still zero: back ends know it).
    pub sizes: Sizes,
    /// Names, units, rows, channels.
    pub description: Description,
    /// The tree of links it was derived on.
    pub linkage: Linkage,
    /// Whether the forward dynamics takes all rows with their biases of closed states.
    pub closed: bool,
}

/// How much is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// What runs ask for: all entry points but [`Entry::EquationsOfMotion`], which [`equations_of_motion`] derives when somebody asks.
    /// It is among the others where forces depend on their solution.
    Run,
    /// The same with columns of where every body is, for pictures.
    Picture,
    /// Positions, equations of motion and columns, while redundant rows are still in: no elimination.
    Analysis,
}

/// Derives entry points; without a guide all constraint rows are kept.
pub fn derive(
    mechanism: &Mechanism,
    topology: &Topology,
    guide: Option<&Guide>,
    purpose: Purpose,
) -> Derived {
    let linkage = linkage(mechanism, topology, &mechanism.parameter_values());
    let scope = Scope::new();
    let with_own = purpose != Purpose::Analysis;
    let results = |deriver: &Deriver<'_>| results(deriver, purpose);
    let (functions, closed, sizes, description) =
        by_deriver(&scope, (mechanism, &linkage), guide, with_own, results);
    Derived { equations: Equations::of(scope.into_graph(), functions), sizes, description, linkage, closed }
}

/// Derives [`Entry::EquationsOfMotion`] by itself, where it is not among what runs ask for. `closed`: see [`Derived::closed`].
pub fn equations_of_motion(
    mechanism: &Mechanism,
    topology: &Topology,
    guide: &Guide,
    closed: bool,
) -> Derivation {
    let linkage = linkage(mechanism, topology, &mechanism.parameter_values());
    let scope = Scope::new();
    let function = by_deriver(&scope, (mechanism, &linkage), Some(guide), true, |deriver| {
        let masses = deriver.masses();
        let dynamic = deriver.instant(deriver.driven_state(&[]));
        deriver.equations_of_motion((&dynamic, &masses), closed)
    });
    Derivation { graph: scope.into_graph(), functions: vec![function] }
}

fn by_deriver<T>(
    scope: &Scope,
    (mechanism, linkage): (&Mechanism, &Linkage),
    guide: Option<&Guide>,
    with_own: bool,
    by: impl FnOnce(&Deriver<'_>) -> T,
) -> T {
    scope.begin_section("prescribed motion");
    let (inputs, given) = inputs(scope, mechanism);
    let geometry = Geometry { g: scope, mechanism, linkage, inputs: &inputs };
    by(&Deriver::new(geometry, given, guide, with_own))
}

/// Puts into the outputs of all functions what stands for symbols.
fn insert<'g>(g: &'g Scope, functions: &mut [Function], values: &[(Expr<'g>, Expr<'g>)]) {
    let blocks = || functions.iter().flat_map(|function| &function.outputs);
    let roots: Vec<ExprId> = blocks().flat_map(|block| block.entries.iter().copied()).collect();
    let mut made = g.with_ids(&roots, values).into_iter();
    let entries = functions.iter_mut().flat_map(|function| &mut function.outputs);
    for (entry, made) in entries.flat_map(|block| &mut block.entries).zip(&mut made) {
        *entry = made;
    }
}

/// Functions, in the order of [`Entry::ALL`], and [`Derived::closed`], with layout and names.
fn results(deriver: &Deriver<'_>, purpose: Purpose) -> (Vec<Function>, bool, Sizes, Description) {
    let masses = deriver.masses();
    let dynamic = deriver.instant(deriver.driven_state(&[]));
    let prescribed = deriver.prescribed();
    let (start, start_values) = deriver.start();
    let nothing = |entry| function(entry, "", Vec::new(), Vec::new());
    let solved = match purpose {
        Purpose::Run | Purpose::Picture => Some(deriver.solution(&dynamic, &masses)),
        Purpose::Analysis => None,
    };
    let (solved, alone) =
        (solved.as_ref().map(|solved| &solved.whole), solved.as_ref().map(|solved| &solved.alone));
    let responses = deriver.response_values(&masses, solved, &dynamic.laws);
    let own = &dynamic.own_rates;
    let forward_dynamics = solved
        .map_or_else(|| nothing(Entry::ForwardDynamics), |solved| deriver.forward_dynamics(solved, own));
    let accelerations =
        alone.map_or_else(|| nothing(Entry::Accelerations), |alone| deriver.accelerations(alone, own));
    let state_rates = deriver.state_rates(&dynamic);
    let rates = deriver.rates(&state_rates);
    let (closure, rows) = deriver.closure(&dynamic);
    let energy = deriver.energy(&dynamic, &masses);
    let g = deriver.geometry.g;
    let roots = [&forward_dynamics, &rates].into_iter().flat_map(|function| &function.outputs);
    let roots: Vec<ExprId> = roots.flat_map(|block| block.entries.iter().copied()).collect();
    let inserted = g.with_ids(&roots, &responses);
    let switches = g.switches(&inserted);
    let passed = g.rows(&[roots, inserted].concat(), &deriver.given.tunable);
    let pieces = (&*switches, &*passed);
    let (observe, channels) = deriver.observe((&dynamic, &masses), purpose == Purpose::Picture, pieces);
    let contacts = deriver.contacts(&dynamic);
    let derivative =
        solved.map_or_else(|| nothing(Entry::Derivative), |solved| deriver.derivative(solved, &state_rates));
    // Forces that ask for the solution stand in them, too, and it is here.
    let with_equations = purpose == Purpose::Analysis || !responses.is_empty();
    let closed = solved.is_some_and(|solved| solved.closed);
    let equations_of_motion =
        with_equations.then(|| deriver.equations_of_motion((&dynamic, &masses), closed));
    let mut functions =
        vec![prescribed, start, forward_dynamics, accelerations, rates, closure, energy, observe];
    functions.extend(equations_of_motion);
    functions.extend([contacts, derivative]);
    let is_here = |entry: &Entry| with_equations || *entry != Entry::EquationsOfMotion;
    let names = Entry::ALL.into_iter().filter(is_here).map(Entry::name);
    debug_assert!(functions.iter().map(|function| &*function.name).eq(names));
    insert(g, &mut functions, &responses);
    let sizes = deriver.sizes(channels.len());
    (functions, closed, sizes, deriver.description(&start_values, rows, channels))
}
