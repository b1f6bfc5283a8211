"""Small matrices: numbers and expressions."""

import casadi as ca
import numpy as np

SX = ca.SX


def skew(a):
    return ca.vertcat(ca.horzcat(0, -a[2], a[1]), ca.horzcat(a[2], 0, -a[0]), ca.horzcat(-a[1], a[0], 0))


def turn_z(c, s):
    return ca.vertcat(ca.horzcat(c, -s, 0), ca.horzcat(s, c, 0), ca.horzcat(0, 0, 1))


def of_quaternion(q):
    w, x, y, z = (q[i] for i in range(4))
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        ca.horzcat(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        ca.horzcat(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def along_z(axis, first=None):
    """A rotation whose third column is the axis; its first as given, else a permutation for an axis of the frame."""
    if first is None:
        first = np.eye(3)[(int(np.argmax(abs(axis))) + 1) % 3]
    first = first - axis * (axis @ first)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])


def sparse(matrix, zero=1e-14):
    """Plain numbers, with exact zeros and ones where rounding has left something."""
    matrix = np.asarray(matrix, float)
    matrix = np.where(abs(matrix) < zero * max(1e-300, abs(matrix).max()), 0, matrix)
    return SX(ca.sparsify(ca.DM(np.where(abs(abs(matrix) - 1) < zero, np.sign(matrix), matrix))))
