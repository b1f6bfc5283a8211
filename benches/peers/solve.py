"""Ways to accelerations and multipliers of `m a - j' l = force`, `j a = target`, all as expressions."""

import casadi as ca
import numpy as np

SX = ca.SX
# Of the largest entry of its row, at every state: what a pivot may be.
PIVOT = 0.05


def cholesky(matrix, right):
    return ca.ldl_solve(right, *ca.ldl(matrix))


class Elimination:
    """Rows by sparse elimination with fixed pivots: of the entries that are large and of one sign at all states the one that fills
    least. Columns without a pivot stay `open`."""

    def __init__(self, rows, numbers):
        self.steps = []
        count, width = rows.shape
        a = {(i, k): rows[i, k] for i in range(count) for k in range(width) if not rows[i, k].is_zero()}
        numbers, left, columns = np.array(numbers), set(range(count)), set(range(width))
        while left:
            sizes = np.abs(numbers)
            size = {i: sizes[:, i, sorted(columns)].max(axis=1) for i in left}
            share = {(i, k): (sizes[:, i, k] / np.maximum(size[i], 1e-300)).min() for i, k in a if i in left and k in columns}
            turns = {(i, k) for i, k in share if numbers[:, i, k].min() < 0 < numbers[:, i, k].max()}
            high = [at for at in share if share[at] >= PIVOT and at not in turns]
            high = high or [max(share, key=lambda at: (at not in turns, share[at]))]
            in_row = {i: sum(at[0] == i for at in share) for i in left}
            in_column = {k: sum(at[1] == k for at in share) for k in columns}
            i, k = min(high, key=lambda at: ((in_row[at[0]] - 1) * (in_column[at[1]] - 1), -share[at]))
            left.remove(i)
            columns.remove(k)
            inverse, factors = 1 / a[i, k], []
            for other in sorted(row for row in left if (row, k) in a):
                factor = a.pop((other, k)) * inverse
                factors.append((other, factor))
                numbers[:, other] -= (numbers[:, other, k] / numbers[:, i, k])[:, None] * numbers[:, i]
                for column in sorted(columns):
                    if (i, column) in a:
                        a[other, column] = a.get((other, column), SX(0)) - factor * a[i, column]
            self.steps.append((i, k, inverse, factors))
        self.table, self.width, self.open = a, width, sorted(columns)

    def solve(self, right, given):
        """Accelerations for the right side and those of open columns."""
        right, a = [right[i] for i in range(right.shape[0])], [SX(0)] * self.width
        for k, value in zip(self.open, given):
            a[k] = value
        for i, _, _, factors in self.steps:
            for other, factor in factors:
                right[other] = right[other] - factor * right[i]
        for i, k, inverse, _ in reversed(self.steps):
            others = (c for c in range(self.width) if c != k and (i, c) in self.table and not a[c].is_zero())
            rest = sum((self.table[i, c] * a[c] for c in others), SX(0))
            a[k] = (right[i] - rest) * inverse
        return ca.vertcat(*a)

    def transposed(self, right):
        """Multipliers, from the columns with pivots."""
        multipliers, before = [SX(0)] * len(self.steps), []
        for i, k, inverse, _ in self.steps:
            rest = sum((self.table[p, k] * multipliers[p] for p in before if (p, k) in self.table), SX(0))
            multipliers[i] = (right[k] - rest) * inverse
            before.append(i)
        for i, _, _, factors in reversed(self.steps):
            for other, factor in factors:
                multipliers[i] = multipliers[i] - factor * multipliers[other]
        return ca.vertcat(*multipliers)


def by_schur(m, j, force, target, _):
    """Sparse Cholesky (L D L') of the mass matrix, then of the rows on it."""
    if j.shape[0] == 0:
        return cholesky(m, force), lambda needed: SX(0, 1)
    both = cholesky(m, ca.horzcat(force, j.T))
    free, lifted = both[:, 0], both[:, 1:]
    multipliers = cholesky(j @ lifted, target - j @ free)
    return free + lifted @ multipliers, lambda needed: multipliers


def by_rows(m, j, force, target, _):
    """Accelerations from the rows alone, where they are as many as the speeds, by CasADi's own solver."""
    if j.shape[0] != j.shape[1]:
        return None
    return ca.solve(j, target), lambda needed: ca.solve(j.T, needed)


def by_projection(m, j, force, target, numbers):
    """Rows tell some accelerations by the others, for which the projected mass is solved."""
    if j.shape[0] == 0 or j.shape[0] > j.shape[1]:
        return None
    rows = Elimination(j, numbers)
    given = [SX(0)] * len(rows.open)
    if given:
        still, none = rows.solve(target, given), SX(j.shape[0], 1)
        units = [rows.solve(none, [SX(float(k == other)) for other in rows.open]) for k in rows.open]
        motions = ca.horzcat(*[ca.sparsify(ca.densify(unit)) for unit in units])
        lifted = m @ motions
        mass = motions.T @ lifted
        mass = ca.triu2symm(ca.triu(mass))
        needed = motions.T @ (force - m @ still)
        free = cholesky(mass, needed)
        given = [free[k] for k in range(len(given))]
        a = still + motions @ free
    else:
        a = rows.solve(target, given)
    return a, rows.transposed


def modes_first(way):
    """The same when modes, whose mass is 1 and which no row knows, have been taken out."""

    def solve(m, j, force, target, numbers):
        n = m.shape[0]
        alone = [k for k in range(n) if ca.is_equal(ca.simplify(m[k, k]), SX(1)) and (j.shape[0] == 0 or j[:, k].is_zero())]
        alone = [k for k in alone if all(m[k, other].is_zero() for other in alone if other != k)]
        if not alone:
            return None
        rest = [k for k in range(n) if k not in alone]
        across = m[rest, alone]
        mass = ca.triu2symm(ca.triu(m[rest, rest] - across @ across.T))
        found = way(mass, j[:, rest], force[rest] - across @ force[alone], target, [number[:, rest] for number in numbers])
        if found is None:
            return None
        of_rest, multipliers = found
        of_alone = force[alone] - across.T @ of_rest
        a = SX(n, 1)
        a[rest], a[alone] = of_rest, of_alone
        return a, lambda needed: multipliers(needed[rest])

    return solve


# Good in every position that is not singular.
WAYS = [by_schur, by_rows, modes_first(by_schur)]
# Good along the run that their pivots were chosen by.
OF_A_RUN = [by_projection, modes_first(by_projection)]
