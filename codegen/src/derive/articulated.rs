//! Forward dynamics link by link: operations grow as the number of links where loops are local.
//! In: [`Problem`]. Out: [`Forward`]. Never knows which way is shorter.
//!
//! The elimination of [CS (6)] in the order of the tree: from the leaves to the root every link sees what hangs on it as one
//! body, whose loops are still open as far as they close nearer to the root. The multipliers of these ride along:
//!   wrench through the inboard joint:  f = I a + b + C lambda
//!   rows of open loops:                0 = Cᵀ a + D lambda + d
//! A row leaves at the link where the two branches of its loop meet: it has no entries by speeds further inwards, so that
//! its pivot vanishes only where the rows lose rank. `a` is what free accelerations add to the motion of the [`Problem`].

use rustc_hash::{FxHashMap, FxHashSet};

use crate::expr::{Expr, Scope};

use super::articulated_body::{ArticulatedBody, Moves, Six, carried, carried_moves, dot, six};
use super::dynamics::inertial_wrench;
use super::forward::{Forward, Problem};
use super::joint_axes::{axes, passes, single};
use super::linkage::{Freedom, Link, LinkIndex};
use super::solve::Solution;
use super::wrench::Wrench;

/// A free joint axis that is eliminated.
struct Axis<'g> {
    /// Among all speeds.
    speed: usize,
    /// Motion of the link per unit of the speed.
    along: [f64; 6],
    /// Inertia along the axis: by each component, and inverse.
    momentum: Six<'g>,
    inverse: Expr<'g>,
    /// Force that is left for it.
    force: Expr<'g>,
    /// By open rows, per unit of their multiplier.
    loops: Vec<(usize, Expr<'g>)>,
}

/// A row that is eliminated.
struct Closed<'g> {
    row: usize,
    wrench: Six<'g>,
    /// Positive, its pivot.
    pivot: Expr<'g>,
    inverse: Expr<'g>,
    left: Expr<'g>,
    loops: Vec<(usize, Expr<'g>)>,
}

/// Rows of open loops.
struct Rows<'g> {
    g: &'g Scope,
    /// D, of every row by the rows that it is tied to; what is not there is zero.
    coupling: Vec<FxHashMap<usize, Expr<'g>>>,
    /// d.
    left: Vec<Expr<'g>>,
}

impl<'g> Rows<'g> {
    fn between(&self, a: usize, b: usize) -> Expr<'g> {
        self.coupling[a].get(&b).copied().unwrap_or_else(|| self.g.zero())
    }

    /// How many of the `open` rows a row is tied to.
    fn ties(&self, row: usize, open: &FxHashSet<usize>) -> usize {
        let others = self.coupling[row].iter().filter(|(other, tie)| **other != row && !tie.is_zero());
        others.filter(|(other, _)| open.contains(other)).count()
    }

    /// Adds `factor m mᵀ` to D, and `force m` to d.
    fn add(&mut self, loops: &[(usize, Expr<'g>)], factor: Expr<'g>, force: Expr<'g>) {
        let zero = self.g.zero();
        for (at, (row, m)) in loops.iter().enumerate() {
            let scaled = factor * *m;
            for (other, n) in &loops[at..] {
                let tie = self.coupling[*row].entry(*other).or_insert(zero);
                *tie += scaled * *n;
                let tie = *tie;
                self.coupling[*other].insert(*row, tie);
            }
            self.left[*row] += force * *m;
        }
    }
}

/// The solution, or nothing where the plan does not apply: it knows rigid links and rows of cuts.
pub fn articulated<'g>(problem: &Problem<'_, 'g>) -> Option<Forward<'g>> {
    let linkage = problem.motion.poses.geometry.linkage;
    let is_known = |link: &Link| !matches!(link.freedom, Freedom::Flexible { .. } | Freedom::Node);
    let applies = linkage.links.iter().all(is_known)
        && problem.masses.iter().all(|mass| mass.modal.is_none())
        && problem.rows.iter().all(|row| row.between.is_some());
    applies.then(|| Sweep::new(problem).solved()).flatten()
}

struct Sweep<'a, 'g> {
    g: &'g Scope,
    problem: &'a Problem<'a, 'g>,
    moves: Vec<Moves>,
    /// By link; what a link takes over from its children is added there.
    bodies: Vec<ArticulatedBody<'g>>,
    rows: Rows<'g>,
    /// Where the two branches of each row's loop meet.
    tops: Vec<LinkIndex>,
    axes: Vec<Vec<Axis<'g>>>,
    /// Rows by the link where they close; last those that close on the ground.
    closed: Vec<Vec<Closed<'g>>>,
}

impl<'a, 'g> Sweep<'a, 'g> {
    fn new(problem: &'a Problem<'a, 'g>) -> Self {
        let poses = &problem.motion.poses;
        let (g, linkage) = (poses.geometry.g, poses.geometry.linkage);
        g.begin_section("articulated bodies: links by themselves");
        let mut moves: Vec<Moves> = Vec::new();
        for (at, link) in linkage.links.iter().enumerate() {
            let outer =
                link.parent.map_or([false; 6], |parent| carried_moves(moves[parent], &poses.relative[at]));
            // Driven ones too, whose drives feel what acts along them.
            let own = axes(link);
            moves.push(std::array::from_fn(|i| {
                (outer[i] && passes(link.freedom, i)) || own.iter().any(|(_, along)| along[i] != 0.0)
            }));
        }
        let of_link = |at: usize| {
            let loads = problem.loads.external[at] + problem.loads.reactions[at];
            let felt = inertial_wrench(problem.motion, problem.masses, at) + -loads;
            ArticulatedBody::new(g, &problem.masses[at].rigid, felt, moves[at])
        };
        let bodies: Vec<ArticulatedBody<'g>> = (0..linkage.links.len()).map(of_link).collect();
        let coupling = vec![FxHashMap::default(); problem.rows.len()];
        let rows = Rows { g, coupling, left: problem.target() };
        let mut sweep = Self {
            g,
            problem,
            moves,
            tops: Vec::new(),
            axes: bodies.iter().map(|_| Vec::new()).collect(),
            closed: (0..=bodies.len()).map(|_| Vec::new()).collect(),
            bodies,
            rows,
        };
        for (number, row) in problem.rows.iter().enumerate() {
            let Some(between) = row.between else { continue };
            let ends = [between.parent.link, between.child.link];
            let wrenches = between.link_wrenches(row.row.moment, row.row.force);
            for (link, Wrench { moment, force }) in ends.into_iter().zip(wrenches) {
                if let Some(at) = link {
                    sweep.bodies[at].push(number, &six(-moment, -force));
                }
            }
            sweep.tops.push(linkage.common_ancestor(ends[0], ends[1]));
        }
        sweep
    }

    fn is_free(&self, speed: usize) -> bool {
        self.problem.partition.free.binary_search(&speed).is_ok()
    }

    fn solved(mut self) -> Option<Forward<'g>> {
        let g = self.g;
        g.begin_section("articulated bodies, from the leaves of the tree to its root");
        for at in (0..self.bodies.len()).rev() {
            self.close(Some(at))?;
            self.release(at)?;
            self.hand_inwards(at);
        }
        self.close(None)?;
        g.begin_section("accelerations and multipliers, from the root to the leaves");
        Some(self.substitute())
    }

    /// Takes out the rows whose loops close at a link, or on the ground: those first that the fewest others are tied to.
    fn close(&mut self, link: LinkIndex) -> Option<()> {
        let g = self.g;
        let mut rows: Vec<usize> = (0..self.tops.len()).filter(|row| self.tops[*row] == link).collect();
        while !rows.is_empty() {
            let open: Vec<usize> = match link {
                Some(at) => self.bodies[at].loops.iter().map(|(row, _)| *row).collect(),
                None => rows.clone(),
            };
            let known: FxHashSet<usize> = open.iter().copied().collect();
            let next = (0..rows.len()).min_by_key(|at| self.rows.ties(rows[*at], &known))?;
            let row = rows.remove(next);
            let others = open.iter().filter(|other| **other != row);
            let ties = others.map(|other| (*other, self.rows.between(row, *other)));
            let loops: Vec<(usize, Expr<'g>)> = ties.filter(|(_, tie)| !tie.is_zero()).collect();
            let pivot = -self.rows.between(row, row);
            if pivot.is_zero() {
                return None;
            }
            let (inverse, left) = (pivot.recip(), self.rows.left[row]);
            let mut wrench = [g.zero(); 6];
            if let Some(at) = link {
                let body = &mut self.bodies[at];
                let place = body.loops.iter().position(|(open, _)| *open == row)?;
                wrench = body.loops.remove(place).1;
                body.add_square(&wrench, inverse);
                let scaled = inverse * left;
                add_scaled(&mut body.bias, scaled, &wrench);
                for (other, tie) in &loops {
                    let scaled = inverse * *tie;
                    if let Some((_, open)) = body.loops.iter_mut().find(|(open, _)| open == other) {
                        add_scaled(open, scaled, &wrench);
                    }
                }
            }
            self.rows.add(&loops, inverse, inverse * left);
            let place = link.unwrap_or(self.bodies.len());
            self.closed[place].push(Closed { row, wrench, pivot, inverse, left, loops });
        }
        Some(())
    }

    /// Takes out the free axes of a link's joint.
    fn release(&mut self, at: usize) -> Option<()> {
        let g = self.g;
        let link = &self.problem.motion.poses.geometry.linkage.links[at];
        for (speed, along) in axes(link) {
            if !self.is_free(speed) {
                continue;
            }
            let body = &mut self.bodies[at];
            let mut momentum = body.momentum(g, &along);
            let inertia = g.weighted(along.iter().copied(), &momentum);
            if inertia.is_zero() {
                return None;
            }
            let inverse = inertia.recip();
            let applied = self.problem.loads.joint[speed];
            let force = applied - g.weighted(along.iter().copied(), &body.bias);
            let loops: Vec<(usize, Expr<'g>)> = body
                .loops
                .iter()
                .map(|(row, wrench)| (*row, g.weighted(along.iter().copied(), wrench)))
                .filter(|(_, felt)| !felt.is_zero())
                .collect();
            if let Some((component, _)) = single(&along) {
                momentum[component] = g.zero();
            }
            body.add_square(&momentum, -inverse);
            add_scaled(&mut body.bias, inverse * force, &momentum);
            for (row, felt) in &loops {
                if let Some((_, wrench)) = body.loops.iter_mut().find(|(open, _)| open == row) {
                    add_scaled(wrench, -(inverse * *felt), &momentum);
                }
            }
            if let Some((component, sign)) = single(&along) {
                body.release(g, component, sign * applied);
            }
            self.rows.add(&loops, -inverse, inverse * force);
            self.axes[at].push(Axis { speed, along, momentum, inverse, force, loops });
        }
        Some(())
    }

    /// What a link's parent takes over.
    fn hand_inwards(&mut self, at: usize) {
        let poses = &self.problem.motion.poses;
        let link = &poses.geometry.linkage.links[at];
        let Some(parent) = link.parent.filter(|_| link.freedom != Freedom::Free) else { return };
        let mut body = self.bodies[at].clone();
        if link.freedom == Freedom::Ball {
            // Its speeds are absolute: no moment reaches those of the parent.
            (0..3).for_each(|component| body.release(self.g, component, self.g.zero()));
        }
        let seen = body.on_parent(self.g, &poses.relative[at], self.moves[parent]);
        self.bodies[parent].add(seen);
    }

    /// Accelerations of links, multipliers of rows, rates of speeds, and what drives.
    fn substitute(self) -> Forward<'g> {
        let (g, problem) = (self.g, self.problem);
        let poses = &problem.motion.poses;
        let zero = g.zero();
        let mut multipliers = vec![zero; problem.rows.len()];
        let mut rates = vec![zero; problem.v.len()];
        let mut pivots = multipliers.clone();
        let mut motions: Vec<Six<'g>> = Vec::new();
        let close = |rows: &[Closed<'g>], motion: &Six<'g>, multipliers: &mut [Expr<'g>]| {
            for closed in rows.iter().rev() {
                let known = dot(g, &closed.wrench, motion) + closed.left;
                multipliers[closed.row] = closed.inverse * (known + of_loops(g, &closed.loops, multipliers));
            }
        };
        close(&self.closed[self.bodies.len()], &[zero; 6], &mut multipliers);
        let mut drive = vec![zero; problem.v.len()];
        for (at, link) in poses.geometry.linkage.links.iter().enumerate() {
            let mut motion = match link.parent {
                Some(parent) => carried(&motions[parent], &poses.relative[at]),
                None => [zero; 6],
            };
            for (component, motion) in motion.iter_mut().enumerate() {
                if !passes(link.freedom, component) {
                    *motion = zero;
                }
            }
            for axis in self.axes[at].iter().rev() {
                let left = axis.force - of_loops(g, &axis.loops, &multipliers);
                let whole = axis.inverse * (left - dot(g, &axis.momentum, &motion));
                if let Some((component, sign)) = single(&axis.along) {
                    // Whatever the parent does: its part was left out of the momentum.
                    rates[axis.speed] = whole - sign * motion[component];
                    motion[component] = sign * whole;
                } else {
                    let rate = whole;
                    rates[axis.speed] = rate;
                    for (motion, along) in motion.iter_mut().zip(axis.along) {
                        *motion += along * rate;
                    }
                }
            }
            close(&self.closed[at], &motion, &mut multipliers);
            for (speed, along) in axes(link).into_iter().filter(|(speed, _)| !self.is_free(*speed)) {
                let body = &self.bodies[at];
                let loops: Vec<(usize, Expr<'g>)> = body
                    .loops
                    .iter()
                    .map(|(row, wrench)| (*row, g.weighted(along.iter().copied(), wrench)))
                    .collect();
                let felt = dot(g, &body.momentum(g, &along), &motion)
                    + g.weighted(along.iter().copied(), &body.bias)
                    + of_loops(g, &loops, &multipliers);
                drive[speed] = felt - problem.loads.joint[speed];
            }
            motions.push(motion);
        }
        self.closed.iter().flatten().for_each(|closed| pivots[closed.row] = closed.pivot);
        let pick = |all: &[Expr<'g>], speeds: &[usize]| speeds.iter().map(|speed| all[*speed]).collect();
        let accelerations = pick(&rates, &problem.partition.free);
        let drive = pick(&drive, &problem.partition.driven);
        Forward {
            solution: Solution { accelerations, multipliers, pivots },
            drive,
            closed: problem.is_driven(),
            slid: false,
        }
    }
}

fn add_scaled<'g>(to: &mut Six<'g>, factor: Expr<'g>, vector: &Six<'g>) {
    for (to, component) in to.iter_mut().zip(vector).filter(|(_, component)| !component.is_zero()) {
        *to += factor * *component;
    }
}

fn of_loops<'g>(g: &'g Scope, loops: &[(usize, Expr<'g>)], multipliers: &[Expr<'g>]) -> Expr<'g> {
    g.sum(loops.iter().map(|(row, felt)| *felt * multipliers[*row]))
}
