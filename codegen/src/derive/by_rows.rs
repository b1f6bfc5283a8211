//! Forward dynamics with rows first: what rows fix from the rows, the rest by [`solve`], then multipliers and drives from inverse
//! dynamics with all accelerations known.
//! In: [`Problem`], [`Plan`]. Out: [`Forward`]. Never knows whether that is shorter.

use std::rc::Rc;

use crate::expr::Expr;

use super::dynamics::{Asked, BodyFields};
use super::forward::{Forward, Problem, Way};
use super::kept_rows::closed_biases;
use super::mass_matrix::{Eliminated, reduced_mass_matrix};
use super::moving::Moving;
use super::own_speeds::OwnSpeeds;
use super::plan::{Plan, PlanBlock};
use super::rows::Block;
use super::solve::{Order, Saddle, Solution, solve};

impl<'g> Problem<'_, 'g> {
    /// Rows first, by a plan.
    pub(super) fn rows_first(&self, plan: &Plan, way: Way<'_, 'g>) -> Forward<'g> {
        let g = self.motion.poses.geometry.g;
        let (jacobian, mut target) = (self.jacobian(), self.target());
        for row in plan.own.iter().chain(&plan.blocks).flat_map(|block| &block.rows) {
            target[*row] = -self.rows[*row].row.bias.closed;
        }
        g.begin_section("accelerations that the loops fix");
        let owns: Vec<OwnSpeeds<'_, 'g>> =
            plan.own.iter().map(|own| OwnSpeeds::new(g, own, &jacobian)).collect();
        let own_of = |row: usize| owns.iter().find(|own| own.left() == row);
        let mut reduced = jacobian.clone();
        for own in &owns {
            let speeds = 0..self.partition.free.len();
            let is_own = |speed: usize| own.plan.speeds.contains(&speed);
            let entry = |speed: usize| own.combined(|row| jacobian[row][speed]);
            reduced[own.left()] =
                speeds.map(|speed| if is_own(speed) { g.zero() } else { entry(speed) }).collect();
        }
        let blocks: Vec<Block<'_, 'g>> =
            plan.blocks.iter().map(|block| Block::new(g, block, &reduced)).collect();
        let zero = g.zero();
        let mut accelerations = vec![zero; self.partition.free.len()];
        let right = |accelerations: &[Expr<'g>], moved: &[Expr<'g>], row: usize| {
            if let Some(bias) = moved.get(row) {
                return -*bias;
            }
            let known = jacobian[row].iter().zip(accelerations);
            known.fold(target[row], |sum, (entry, acceleration)| sum - *entry * *acceleration)
        };
        for block in &blocks {
            let moved = self.moved_biases(&accelerations, way);
            let of_row = |row: usize| right(&accelerations, &moved, row);
            let left = |row: &usize| own_of(*row).map_or_else(|| of_row(*row), |own| own.combined(of_row));
            let rights: Vec<Expr<'g>> = block.plan.rows.iter().map(left).collect();
            for (speed, acceleration) in block.plan.speeds.iter().zip(block.solve(&rights)) {
                accelerations[*speed] = acceleration;
            }
        }
        let moved = if owns.is_empty() { Vec::new() } else { self.moved_biases(&accelerations, way) };
        let mut own_accelerations = Vec::new();
        for own in &owns {
            let rights: Vec<Expr<'g>> =
                own.plan.rows.iter().map(|row| right(&accelerations, &moved, *row)).collect();
            own_accelerations.extend(own.plan.speeds.iter().copied().zip(own.solve(&rights)));
        }
        for (speed, acceleration) in own_accelerations {
            accelerations[speed] = acceleration;
        }
        let (mut multipliers, mut pivots) = (vec![zero; self.rows.len()], vec![zero; self.rows.len()]);
        let mut last = None;
        if !plan.rest.speeds.is_empty() {
            let moved = self.moved_biases(&accelerations, way);
            let rights: Vec<Expr<'g>> =
                plan.rest.rows.iter().map(|row| right(&accelerations, &moved, *row)).collect();
            let moving = self.with_local_modes(&mut accelerations, way);
            let before = accelerations.clone();
            let rest = self.rest(&plan.rest, &moving, way, &jacobian, &rights);
            for (speed, acceleration) in rest.speeds.iter().zip(&rest.solution.accelerations) {
                accelerations[*speed] = *acceleration;
            }
            let rows = plan.rest.rows.iter().zip(rest.solution.multipliers).zip(rest.solution.pivots);
            for ((row, multiplier), pivot) in rows {
                (multipliers[*row], pivots[*row]) = (multiplier, pivot);
            }
            if way.again {
                self.with_local_modes(&mut accelerations, way);
            } else {
                last = Some(self.followed(&mut accelerations, &before, &moving, way));
            }
        }
        // J^T lambda carries what inertia and loads leave over.
        let moving = last.unwrap_or_else(|| self.moving(&accelerations, way));
        if !owns.is_empty() {
            let felt = self.unheld(&moving, &multipliers, way);
            g.begin_section("multipliers");
            for own in &owns {
                let of_own: Vec<Expr<'g>> =
                    own.plan.speeds.iter().map(|speed| felt[self.partition.free[*speed]]).collect();
                for (row, multiplier) in own.plan.rows.iter().zip(own.push(&of_own)) {
                    (multipliers[*row], pivots[*row]) = (multiplier, own.pivot());
                }
            }
        }
        for block in blocks.iter().rev() {
            let felt = self.unheld(&moving, &multipliers, way);
            g.begin_section("multipliers");
            let rights: Vec<Expr<'g>> =
                block.plan.speeds.iter().map(|speed| felt[self.partition.free[*speed]]).collect();
            let of_rows = block.pivots();
            let solved = block.solve_transposed(&rights).into_iter().zip(of_rows);
            for (row, (multiplier, pivot)) in block.plan.rows.iter().zip(solved) {
                pivots[*row] = pivot;
                let Some(own) = own_of(*row) else {
                    multipliers[*row] = multiplier;
                    continue;
                };
                for (row, more) in own.plan.rows.iter().zip(own.along(multiplier)) {
                    multipliers[*row] += more;
                }
            }
        }
        let felt = self.unheld(&moving, &multipliers, way);
        g.begin_section("drive forces");
        let slides: Vec<_> =
            self.partition.driven.iter().map(|d| self.slid_drive(&moving, way, *d)).collect();
        let drive = self.partition.driven.iter().zip(&slides).map(|(d, slid)| slid.unwrap_or(felt[*d]));
        let drive = drive.collect();
        let slid = slides.iter().any(Option::is_some);
        let solution = Solution { accelerations, multipliers, pivots };
        Forward { solution, drive, closed: self.is_driven() || plan.rest.rows.is_empty(), slid }
    }

    /// Acceleration residuals of the rows of cuts in the motion that these accelerations make; none where the Jacobian does.
    fn moved_biases(&self, accelerations: &[Expr<'g>], way: Way<'_, 'g>) -> Vec<Expr<'g>> {
        if !way.rows_moved || accelerations.iter().all(|acceleration| acceleration.is_zero()) {
            return Vec::new();
        }
        let (sums, keep) = self.made;
        let make = || {
            let moving = self.moving(accelerations, Way { shapes: &[], asked: Asked::Nothing, ..way });
            closed_biases(&moving.motion, sums, keep)
        };
        self.known.biases(self.motion.poses.geometry.g, (accelerations, way.axes, sums), make)
    }

    /// Puts in the accelerations that local modes have while all others are as they stand.
    fn with_local_modes(&self, accelerations: &mut [Expr<'g>], way: Way<'_, 'g>) -> Rc<Moving<'g>> {
        let g = self.motion.poses.geometry.g;
        let local = way.local;
        for speed in local.iter().flat_map(|body| &body.speeds) {
            accelerations[*speed] = g.zero();
        }
        let asked = if way.asked == Asked::Moments { Asked::Loads } else { way.asked };
        let moving = self.moving(accelerations, Way { asked, ..way });
        if local.is_empty() {
            return moving;
        }
        let felt = self.felt(&moving);
        g.begin_section("accelerations of the modes");
        for body in local {
            let forces: Vec<Expr<'g>> =
                body.speeds.iter().map(|speed| felt[self.partition.free[*speed]]).collect();
            for (speed, row) in body.speeds.iter().zip(&body.reduced.inverse) {
                accelerations[*speed] = -g.weighted(row.iter().copied(), &forces);
            }
        }
        self.moving(accelerations, way)
    }

    /// What rows do not fix, local modes left out.
    fn rest(
        &self,
        plan: &PlanBlock,
        moving: &Moving<'g>,
        Way { local, order, axes, .. }: Way<'_, 'g>,
        jacobian: &[Vec<Expr<'g>>],
        rights: &[Expr<'g>],
    ) -> Rest<'g> {
        let g = self.motion.poses.geometry.g;
        let is_local = |speed: &usize| local.iter().any(|body| body.speeds.contains(speed));
        let speeds: Vec<usize> = plan.speeds.iter().copied().filter(|speed| !is_local(speed)).collect();
        let h = self.felt(moving);
        g.begin_section("mass matrix by composite bodies");
        let mass = self.known.mass(g, (!local.is_empty(), axes), || {
            let eliminated: Vec<Eliminated<'g>> =
                local.iter().map(|body| body.eliminated(g, &self.motion.modes[body.link].q)).collect();
            reduced_mass_matrix(&self.motion.poses, self.masses, &eliminated, axes)
        });
        let free = |speed: &usize| self.partition.free[*speed];
        let of_rest = |row: &[Expr<'g>]| speeds.iter().map(|speed| row[*speed]).collect();
        let block: Vec<Vec<Expr<'g>>> =
            speeds.iter().map(|speed| of_rest(&self.pick(&mass[free(speed)]))).collect();
        let entries: Vec<Vec<Expr<'g>>> = plan.rows.iter().map(|row| of_rest(&jacobian[*row])).collect();
        let force: Vec<Expr<'g>> = speeds.iter().map(|speed| -h[free(speed)]).collect();
        let of_plan = |list: &[Vec<bool>]| -> Vec<Vec<bool>> {
            plan.rows.iter().map(|row| speeds.iter().map(|speed| list[*row][*speed]).collect()).collect()
        };
        let constant;
        let order = match order {
            Order::Leaves => order,
            Order::Cheapest(all) => {
                constant = of_plan(all);
                Order::Cheapest(&constant)
            }
            Order::PairsFirst(all) => {
                constant = of_plan(all);
                Order::PairsFirst(&constant)
            }
        };
        let saddle = Saddle { mass: &block, jacobian: &entries, force: &force, target: rights };
        let solution = solve(g, &saddle, order);
        Rest { speeds, solution }
    }

    /// Local modes follow the change of their frames' accelerations since `before`, when the motion was `moving`.
    fn followed(
        &self,
        accelerations: &mut [Expr<'g>],
        before: &[Expr<'g>],
        moving: &Moving<'g>,
        way: Way<'_, 'g>,
    ) -> Rc<Moving<'g>> {
        let g = self.motion.poses.geometry.g;
        let mut change = vec![g.zero(); self.v.len()];
        for (at, speed) in self.partition.free.iter().enumerate() {
            change[*speed] = accelerations[at] - before[at];
        }
        let change = self.known.changed(self.motion, &change, way.axes);
        let mut followed = Vec::new();
        for body in way.local {
            g.begin_section("accelerations of the modes");
            let moved = &change[body.link];
            let columns = body.columns(&self.masses[body.link]);
            let felt: Vec<Expr<'g>> =
                columns.into_iter().map(|column| column.power(moved.alpha, moved.origin)).collect();
            let own: Vec<Expr<'g>> =
                body.reduced.inverse.iter().map(|row| -g.weighted(row.iter().copied(), &felt)).collect();
            for (speed, own) in body.speeds.iter().zip(&own) {
                accelerations[*speed] += *own;
            }
            if let Some(Some(by)) = moving.fields.get(body.link) {
                let fields = by.shapes.changed(&by.fields, moved.alpha, &own);
                let mut fields = BodyFields::new(&by.shapes, fields);
                fields.asked = way.asked;
                followed.push((body.link, fields));
            }
        }
        self.moving(accelerations, way).with_fields(followed)
    }
}

/// What is left to the equations of motion.
struct Rest<'g> {
    /// Speeds, by number among the free ones.
    speeds: Vec<usize>,
    solution: Solution<'g>,
}
