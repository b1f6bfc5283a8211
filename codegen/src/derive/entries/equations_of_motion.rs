//! The equations of motion with the drivers kept free, in their shortest form. In: link motion, masses, rows. Out: the [`Function`] of
//! [`Entry::EquationsOfMotion`]. Never knows how they are solved.

use std::cell::OnceCell;

use linkwear_runtime::Entry;
use rustc_hash::FxHashSet;

use super::deriver::{Deriver, Instant};
use super::functions::function;
use crate::derive::closure::CutRows;
use crate::derive::dynamics::all_bias_forces;
use crate::derive::kept_rows::kept_rows;
use crate::derive::link_mass::LinkMass;
use crate::derive::mass_matrix::mass_matrix;
use crate::derive::turned::Axes;
use crate::derive::{Block, Function};
use crate::expr::{Expr, ExprId};

/// Entries of M that are not zero by structure: an open chain of a hundred hinges has as many.
const MOST_OF_MASS: usize = 5_000;

/// What stands in the place of M.
const MASS_LEFT_OUT: &str =
    "No masses: of mechanisms as long as this one M is left out, and zeros stand in its place.";

/// M, and those of its entries that are not zero.
type Masses<'g> = (Vec<Vec<Expr<'g>>>, Vec<Expr<'g>>);

/// A row's residual, its Jacobian by all speeds and its right-hand side.
type Row<'g> = (Expr<'g>, Vec<Expr<'g>>, Expr<'g>);

impl<'g> Deriver<'g> {
    /// `closed`: whether rows are taken with their biases of closed states, as the forward dynamics takes them.
    pub(super) fn equations_of_motion(
        &self,
        (dynamic, masses): (&Instant<'g>, &[LinkMass<'g>]),
        closed: bool,
    ) -> Function {
        let g = self.geometry.g;
        let released = if self.drivers.is_empty() {
            None
        } else {
            let rates = vec![g.zero(); self.v_all.len()];
            Some(self.instant([self.q_all.clone(), self.v_all.clone(), rates]))
        };
        let instant = released.as_ref().unwrap_or(dynamic);
        let left_out = self.mass_is_left_out();
        g.begin_section("mass matrix by composite bodies");
        let matrices = if left_out { vec![self.no_masses()] } else { self.masses_by_axes(instant, masses) };
        g.begin_section("loop Jacobian");
        let forces = OnceCell::new();
        let by = |cuts: &[CutRows<'g>], counts: bool| {
            let rows = self.rows_of_all(instant, cuts, closed);
            // The same for all rows, which alone decide which of them are shortest.
            let forces = forces.get_or_init(|| self.bias_forces(instant, masses));
            let (operations, mass, h) = self.shortest(&rows, &matrices, forces, counts);
            (operations, (rows, mass, h))
        };
        let (rows, mass, h) =
            instant.by_shorter_rows(&instant.cuts, (false, self.is_short()), self.compares, by);
        let mut outputs = self.equation_blocks(&rows, &mass, h, &instant.own_rates);
        if left_out {
            MASS_LEFT_OUT.clone_into(&mut outputs[0].doc);
        }
        let (q, v) = (instant.state.q.iter().copied(), instant.state.v.iter().copied());
        let (q, v) = (q.chain(self.own_integrals()), v.chain(self.own_values()));
        let mut inputs = self.base_inputs();
        inputs.push(Block::vector("q", q).doc("All coordinates, driven ones included."));
        inputs.push(Block::vector("v", v).doc("All speeds, driven ones included."));
        inputs.push(self.contact_input());
        let doc = "M v̇ + h = Q_drive + phi_qᵀ lambda, phi_q v̇ = gamma, with the drivers kept free.";
        function(Entry::EquationsOfMotion, doc, inputs, outputs.into())
    }

    /// Whether M is left out: the size of most long mechanisms would be that of a matrix that no run asks for, but near singular
    /// positions.
    fn mass_is_left_out(&self) -> bool {
        let linkage = self.geometry.linkage;
        let held =
            |at| linkage.path(Some(at)).map(|link| linkage.links[link].freedom.speeds()).sum::<usize>();
        let links = linkage.links.iter().enumerate();
        let entries: usize = links.map(|(at, link)| link.freedom.speeds() * held(at)).sum();
        entries > MOST_OF_MASS && !self.whole_equations
    }

    fn no_masses(&self) -> Masses<'g> {
        let n = self.v_all.len();
        (vec![vec![self.geometry.g.zero(); n]; n], Vec::new())
    }

    /// M along each of the axes that may make it short.
    fn masses_by_axes(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Vec<Masses<'g>> {
        let [links, ground] = [Axes::ALL[0], Axes::ALL[2]];
        let axes = if self.is_short() { vec![links, ground, Axes::BY_SCREWS] } else { vec![links] };
        let by = |axes| {
            let matrix = mass_matrix(&instant.state.motion.poses, masses, axes);
            let entries = matrix.iter().flatten().copied().filter(|entry| !entry.is_zero()).collect();
            (matrix, entries)
        };
        axes.into_iter().map(by).collect()
    }

    /// h in every way that may make it short, each once.
    fn bias_forces(&self, instant: &Instant<'g>, masses: &[LinkMass<'g>]) -> Vec<Vec<Expr<'g>>> {
        let axes = if self.compares { Axes::choices(self.is_short()) } else { &Axes::ALL[..1] };
        let screws: &[Axes] = if self.is_short() { &[Axes::BY_SCREWS] } else { &[] };
        let all = all_bias_forces(&instant.state.motion, masses, &instant.loads, &[axes, screws].concat());
        each_once(all)
    }

    /// All rows, dropped ones too: they stand in where the kept ones happen to lose rank.
    fn rows_of_all(&self, instant: &Instant<'g>, cuts: &[CutRows<'g>], closed: bool) -> Vec<Row<'g>> {
        let all = vec![true; self.keep.len()];
        kept_rows(&instant.state.motion, (cuts, &instant.couplings), &all)
            .into_iter()
            .map(|kept| (kept.row.residual, kept.jacobian, -kept.row.bias.of(closed)))
            .collect()
    }

    /// M and h that take the fewest operations together with these rows, and how many; uncounted where there is one of each and nobody
    /// `counts`.
    fn shortest(
        &self,
        rows: &[Row<'g>],
        matrices: &[Masses<'g>],
        forces: &[Vec<Expr<'g>>],
        counts: bool,
    ) -> (usize, Vec<Vec<Expr<'g>>>, Vec<Expr<'g>>) {
        let of_rows =
            rows.iter().flat_map(|(phi, jacobian, gamma)| jacobian.iter().copied().chain([*phi, *gamma]));
        // Zeros, of which there are as many as speeds times rows, take no operations.
        let of_rows: Vec<Expr<'g>> = of_rows.filter(|entry| !entry.is_zero()).collect();
        let counts = counts || matrices.len() * forces.len() > 1;
        let both = matrices.iter().flat_map(|mass| forces.iter().map(move |h| (mass, h)));
        let counted = both.map(|((mass, entries), h)| {
            let all = entries.iter().chain(&of_rows).chain(h).copied();
            (if counts { self.geometry.g.operations(all) } else { 0 }, mass, h)
        });
        let shortest = counted.min_by_key(|(operations, ..)| *operations);
        shortest.map(|(operations, mass, h)| (operations, mass.clone(), h.clone())).unwrap_or_default()
    }

    /// What the entry point answers. Each state of the file's own stands by itself: one times its rate is its rate.
    fn equation_blocks(
        &self,
        rows: &[Row<'g>],
        mass: &[Vec<Expr<'g>>],
        h: Vec<Expr<'g>>,
        own_rates: &[Expr<'g>],
    ) -> [Block; 5] {
        let g = self.geometry.g;
        let (n, own) = (self.v_all.len(), self.own.len());
        let beside = || vec![g.zero(); own];
        let jacobian = rows.iter().flat_map(|(_, jacobian, _)| jacobian.iter().copied().chain(beside()));
        let mass_of_own = (0..own).flat_map(|i| (i..own).map(move |j| g.number(f64::from(u8::from(i == j)))));
        let upper = (0..n).flat_map(|i| mass[i][i..].iter().copied().chain(beside()).collect::<Vec<_>>());
        let own_rates = own_rates.iter().map(|rate| -*rate);
        [
            Block::vector("mass", upper.chain(mass_of_own))
                .doc("Upper triangle of M, row by row [kg m², kg m, kg].")
                .cites("[CS (6)]"),
            Block::vector("h", h.into_iter().chain(own_rates))
                .doc("Left side besides M v̇: inertia, weight, springs, damping.")
                .cites("[CS (6)]"),
            Block::vector("phi", rows.iter().map(|(phi, ..)| *phi))
                .doc("Position residuals of all rows [rad, m].")
                .cites("[CS (3)]"),
            Block::matrix("phi_q", (rows.len(), n + own), jacobian)
                .doc("Jacobian of all rows by all speeds.")
                .cites("[CS (3)]"),
            Block::vector("gamma", rows.iter().map(|(.., gamma)| *gamma))
                .doc("Right side of phi_q v̇ = gamma; of closed states where something drives.")
                .cites("[CS (6)]"),
        ]
    }
}

/// Without lists that are there before.
fn each_once<'g>(lists: Vec<Vec<Expr<'g>>>) -> Vec<Vec<Expr<'g>>> {
    let mut known = FxHashSet::default();
    let ids = |list: &Vec<Expr<'g>>| -> Vec<ExprId> { list.iter().map(|entry| entry.id()).collect() };
    lists.into_iter().filter(|list| known.insert(ids(list))).collect()
}
