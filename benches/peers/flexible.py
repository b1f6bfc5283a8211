"""Flexible rods in CasADi."""

import casadi as ca
import numpy as np

from matrices import skew, sparse

SX = ca.SX


class Section:
    """The section at an end: its rotation in the rod, by the Gibbs vector of the small angles that modes turn it by."""

    def __init__(self, rod, end):
        slopes = np.array([slope[end] for slope in rod.slopes])
        none = np.zeros_like(slopes)
        # Small angles by mode.
        self.tilt = sparse(np.block([[none, none], [none, -slopes], [slopes, none]]))
        self.v, gibbs = rod.v, self.tilt @ rod.q / 2
        self.scale = 2 / (1 + ca.dot(gibbs, gibbs))
        self.turn = sparse(np.eye(3)) + self.scale * (skew(gibbs) + skew(gibbs) @ skew(gibbs))
        # Angular velocity by modal speed.
        self.turns = self.scale * (self.tilt + skew(gibbs) @ self.tilt) / 2
        self.rate, self.gibbs = self.turns @ rod.v, gibbs

    def rate_of_rate(self, rates):
        """Seen from the rod."""
        return self.turns @ rates - self.scale * ca.dot(self.gibbs, self.tilt @ self.v / 2) * self.rate


class Pinned:
    """Bending modes of a round rod held by a ball at each end (sines), with the tilting of its sections, in a frame on the line
    through both ends, along x. Mass-normalised; the first half of the modes bends in y, the second in z. `at`: the first modal speed."""

    def __init__(self, given, origin):
        self.count = int(given["modes"])
        half = self.count // 2
        length, radius, mass = given["length"], given["radius"], given["mass"]
        rho = mass / given["area"] / length
        second = np.pi * radius**4 / 4
        shear = given["young"] / (2 * (1 + given["poisson"])) * given["area"]
        shear *= 6 * (1 + given["poisson"]) / (7 + 6 * given["poisson"])
        self.q, self.v = SX.sym("eta", self.count), SX.sym("eta_v", self.count)
        nodes, weights = np.polynomial.legendre.leggauss(60)
        s, weights = 0.5 * length * (nodes + 1), 0.5 * length * weights
        shapes, self.stiffness, self.slopes, self.length = [], [], [], length
        for k in range(1, half + 1):
            wave = k * np.pi / length
            stiff, line = given["young"] * second, rho * given["area"]
            # Deflection sin, tilt c wave cos: the lower root of Timoshenko's two.
            bend = np.array([[shear * wave**2, -shear * wave**2], [-shear * wave**2, stiff * wave**4 + shear * wave**2]])
            inertia = np.diag([line, rho * second * wave**2])
            values, vectors = np.linalg.eig(np.linalg.solve(inertia, bend))
            at = int(np.argmin(values))
            ratio = vectors[1, at] / vectors[0, at]
            amplitude = 1 / np.sqrt(length / 2 * (line + rho * second * wave**2 * ratio**2))
            shapes.append((amplitude * np.sin(wave * s), amplitude * ratio * wave * np.cos(wave * s)))
            self.slopes.append((amplitude * ratio * wave, amplitude * ratio * wave * (-1) ** k))
            self.stiffness.append(values[at])
        self.damping = [2 * given["damping"] * np.sqrt(value) for value in self.stiffness] * 2
        self.stiffness = self.stiffness * 2
        s = s - (origin - given["begin"])[0]
        self.ends = [s_end - (origin - given["begin"])[0] for s_end in (0, length)]
        # Functions over the body: where it is undeformed, then each mode; components x, y, z at (s, y, z) as factors of 1, y, z.
        none = np.zeros_like(s)
        one = np.ones_like(s)
        functions = [[(s, none, none), (none, one, none), (none, none, one)]]
        for plane in (1, 2):
            for deflection, tilt in shapes:
                components = [(none, none, none)] * 3
                components[0] = (none, -tilt if plane == 1 else none, -tilt if plane == 2 else none)
                components[plane] = (deflection, none, none)
                functions.append(components)
        scale = [rho * given["area"], rho * second, rho * second]
        self.first = [np.array([scale[0] * (weights @ component[0]) for component in f]) for f in functions]
        self.second = [
            [
                np.array([[sum(scale[m] * (weights @ (a[m] * b[m])) for m in range(3)) for b in g] for a in f])
                for g in functions
            ]
            for f in functions
        ]
        self.mass = mass

    def section(self, at):
        return Section(self, [abs(end - at[0]) < 1e-9 * self.length for end in self.ends].index(True))

    def inertial(self, link, spin, rates):
        """Wrench about the origin, and what each mode feels."""
        n = self.count + 1
        c = [1] + [self.q[k] for k in range(self.count)]
        d = [0] + [self.v[k] for k in range(self.count)]
        e = [0] + [rates[k] for k in range(self.count)]
        none = 1e-12 * np.sqrt(self.mass)
        first = [sparse(np.where(abs(f) < none, 0, f)) for f in self.first]
        size = [np.sqrt(abs(row[i]).max()) for i, row in enumerate(self.second)]
        second = [
            [sparse(np.where(abs(m) < 1e-12 * size[i] * size[j], 0, m)) for j, m in enumerate(row)]
            for i, row in enumerate(self.second)
        ]
        w = skew(link.w)
        s = sum((c[i] * first[i] for i in range(n)), SX(3, 1))
        # Acceleration of the material, beside that of the origin: field times each function.
        field = [spin * c[j] + 2 * w * d[j] + sparse(np.eye(3)) * e[j] for j in range(n)]
        force = self.mass * link.a + sum((field[j] @ first[j] for j in range(n)), SX(3, 1))
        moment = ca.cross(s, link.a)
        # Products of inertia with the present shape: sum over i of c_i times the integral of f_j f_i^T.
        for j in range(n):
            product = sum((c[i] * second[j][i] for i in range(n)), SX(3, 3))
            turned = field[j] @ product
            moment = moment + ca.vertcat(turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1])
        modes = []
        for k in range(1, n):
            # The modes are orthonormal in the mass.
            value = ca.dot(first[k], link.a) + e[k] + sum(ca.trace((spin * c[j] + 2 * w * d[j]) @ second[j][k]) for j in range(n))
            modes.append(value + self.stiffness[k - 1] * self.q[k - 1] + self.damping[k - 1] * self.v[k - 1])
        return moment, force, modes
