"""Equations of motion of a linkage in CasADi, as a user of CasADi would write them with care.

Relative coordinates of a spanning tree, recursive Newton-Euler in the frames of the links, composite bodies for the mass matrix,
velocities of cut joints as rows, scalar expressions with common ones shared. Of several forms of the same the one with the fewest
operations counts. A ball in the tree has the orientation of its link against the ground, as quaternion.
"""

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


def along_z(axis):
    """A rotation whose third column is the axis; a permutation for an axis of the frame."""
    at = int(np.argmax(abs(axis)))
    first = np.eye(3)[(at + 1) % 3]
    first = first - axis * (axis @ first)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])


def sparse(matrix, zero=1e-14):
    """Plain numbers with exact zeros."""
    matrix = np.asarray(matrix, float)
    return SX(ca.sparsify(ca.DM(np.where(abs(matrix) < zero * max(1e-300, abs(matrix).max()), 0, matrix))))


class Link:
    """A body with its joint to the parent. `mount`: its frame at the reference pose, seen from the ground."""

    def __init__(self, body, joint, parent, mount, origin):
        self.body, self.joint, self.parent, self.mount, self.origin = body, joint, parent, mount, origin
        self.modal = None

    def local(self, point):
        return self.mount.T @ (point - self.origin)


class Model:
    def __init__(self, linkage):
        self.linkage = linkage
        self.tree()
        self.symbols()

    def tree(self):
        """Breadth first, in the order of the file."""
        joints = self.linkage.joints
        self.links, place, left = [], {"ground": None}, [name for name, joint in joints.items() if not joint["cut"]]
        queue, self.cuts = ["ground"], [name for name, joint in joints.items() if joint["cut"]]
        taken = set()
        while queue:
            near = queue.pop(0)
            for name in left:
                joint = joints[name]
                ends = (joint["parent"], joint["child"])
                if name in taken or near not in ends:
                    continue
                far = ends[1] if ends[0] == near else ends[0]
                if far in place:
                    continue
                taken.add(name)
                body = self.linkage.bodies[far]
                is_ball = joint["kind"] == "spherical"
                mount = np.eye(3) if is_ball else along_z(joint["axes"][0])
                sign = 1 if far == ends[1] else -1
                link = Link(body, name, place[near], mount, joint["at"][far])
                link.sign = sign
                place[far] = len(self.links)
                self.links.append(link)
                queue.append(far)
        self.cuts += [name for name in left if name not in taken]
        self.place = place

    def symbols(self):
        q, v, self.coordinates, self.speeds = [], [], [], []
        for link in self.links:
            kind = self.linkage.joints[link.joint]["kind"]
            count = (4, 3) if kind == "spherical" else (1, 1)
            link.q, link.v = SX.sym(link.joint + "_q", count[0]), SX.sym(link.joint + "_v", count[1])
            self.coordinates.append((link.joint, len(q), count[0]))
            link.at = sum(item.numel() for item in v)
            flexible = link.body.flexible
            if flexible:
                link.modal = Pinned(link, flexible)
            q.append(link.q)
            v.append(link.v)
            if link.modal:
                q.append(link.modal.q)
                v.append(link.modal.v)
        self.q, self.v = ca.vertcat(*q), ca.vertcat(*v)
        self.rates = SX.sym("a", self.v.numel())
        self.driven = [link.at for link in self.links if self.linkage.joints[link.joint]["driven"]]
        self.free = [i for i in range(self.v.numel()) if i not in self.driven]

    def kinematics(self):
        """Rotation and offset from parent, angular velocity, velocity of the origin, rotation to the ground."""
        for link in self.links:
            joint, up = self.linkage.joints[link.joint], self.links[link.parent] if link.parent is not None else None
            mount = up.mount if up else np.eye(3)
            near = joint["parent"] if link.sign > 0 else joint["child"]
            at = joint["at"][near]
            link.offset = sparse(up.local(at) if up else at)
            into = sparse(mount.T @ link.mount)
            up_w, up_v = (up.w, up.u) if up else (SX(3, 1), SX(3, 1))
            if joint["kind"] == "revolute":
                angle = link.sign * link.q
                link.turn = into @ turn_z(ca.cos(angle), ca.sin(angle))
                link.world = up.world @ link.turn if up else sparse(mount) @ link.turn
                link.w = link.turn.T @ up_w + ca.vertcat(0, 0, link.sign * link.v)
                link.u = link.turn.T @ (up_v + ca.cross(up_w, link.offset))
            elif joint["kind"] == "prismatic":
                link.turn = into
                link.world = up.world @ into if up else sparse(mount) @ into
                link.offset = link.offset + into @ ca.vertcat(0, 0, link.sign * link.q)
                link.w = into.T @ up_w
                link.u = into.T @ (up_v + ca.cross(up_w, link.offset)) + ca.vertcat(0, 0, link.sign * link.v)
            else:
                link.world = of_quaternion(link.q)
                link.turn = up.world.T @ link.world if up else link.world
                link.w = link.v
                link.u = link.turn.T @ (up_v + ca.cross(up_w, link.offset))
            # Sparse products of numbers and symbols leave exact zeros.
            link.position = (up.position + up.world @ link.offset) if up else link.offset

    def accelerate(self, rates, gravity):
        for link in self.links:
            joint, up = self.linkage.joints[link.joint], self.links[link.parent] if link.parent is not None else None
            own = rates[link.at:link.at + link.v.numel()]
            base = sparse(-self.linkage.gravity) if gravity else SX(3, 1)
            up_a, up_alpha, up_w = (up.a, up.alpha, up.w) if up else (base, SX(3, 1), SX(3, 1))
            a = up_a + ca.cross(up_alpha, link.offset) + ca.cross(up_w, ca.cross(up_w, link.offset))
            if joint["kind"] == "revolute":
                spin = ca.vertcat(0, 0, link.sign * link.v)
                link.alpha = link.turn.T @ up_alpha + ca.cross(link.w, spin) + ca.vertcat(0, 0, link.sign * own)
            elif joint["kind"] == "prismatic":
                slide = ca.vertcat(0, 0, link.sign * link.v)
                link.alpha = link.turn.T @ up_alpha
            else:
                link.alpha = own
            link.a = link.turn.T @ a
            if joint["kind"] == "prismatic":
                link.a = link.a + 2 * ca.cross(link.w, slide) + ca.vertcat(0, 0, link.sign * own)

    def forces(self, rates, gravity=True, applied=True):
        """Inverse dynamics: what every speed needs for these rates."""
        self.accelerate(rates, gravity)
        moments, pushes = [SX(3, 1) for _ in self.links], [SX(3, 1) for _ in self.links]
        felt = [SX(0) for _ in range(self.v.numel())]
        if applied:
            self.apply(moments, pushes, felt)
        for i, link in reversed(list(enumerate(self.links))):
            moment, force, modes = self.inertial(link, rates)
            moments[i] = moment - moments[i]
            pushes[i] = force - pushes[i]
        for i, link in reversed(list(enumerate(self.links))):
            kind = self.linkage.joints[link.joint]["kind"]
            own = {"revolute": [link.sign * moments[i][2]], "prismatic": [link.sign * pushes[i][2]]}
            for k, value in enumerate(own.get(kind) or [moments[i][j] for j in range(3)]):
                felt[link.at + k] = felt[link.at + k] + value
            if link.modal:
                for k, value in enumerate(self.inertial(link, rates)[2]):
                    felt[link.at + 3 + k] = felt[link.at + 3 + k] + value
            if link.parent is not None:
                push = link.turn @ pushes[i]
                passed = SX(3, 1) if kind == "spherical" else link.turn @ moments[i]
                moments[link.parent] += passed + ca.cross(link.offset, push)
                pushes[link.parent] += push
        if applied:
            for link in self.links:
                joint = self.linkage.joints[link.joint]
                if joint["kind"] in ("revolute", "prismatic"):
                    felt[link.at] = felt[link.at] + joint["damping"] * link.v
                    if joint["force"]:
                        names = {name: self.linkage.names[name] for name in self.linkage.names.given} | {"tanh": ca.tanh, "v": link.v}
                        felt[link.at] = felt[link.at] - eval(joint["force"], {"__builtins__": {}}, names)
        return ca.vertcat(*felt)

    def inertial(self, link, rates):
        body = link.body
        spin = skew(link.alpha) + skew(link.w) @ skew(link.w)
        centre = sparse(link.local(body.centre))
        if link.modal:
            return link.modal.inertial(link, spin, rates[link.at + 3:link.at + 3 + link.modal.count])
        force = body.mass * (link.a + spin @ centre)
        off = body.centre - link.origin
        about = body.inertia + body.mass * (np.eye(3) * (off @ off) - np.outer(off, off))
        inertia = sparse(link.mount.T @ about @ link.mount)
        moment = inertia @ link.alpha + ca.cross(link.w, inertia @ link.w) + body.mass * ca.cross(centre, link.a)
        return moment, force, []

    def apply(self, moments, pushes, felt):
        """Friction in balls, springs."""
        for name, joint in self.linkage.joints.items():
            if joint["kind"] not in ("spherical", "universal") or not joint["damping"]:
                continue
            one, other = self.place[joint["parent"]], self.place[joint["child"]]
            # Ends of a flexible rod tilt, too.
            tilts = [self.links[i].modal and self.links[i].modal.tilt(joint["at"][self.links[i].body.name] - self.links[i].origin) for i in (one, other)]
            w_one, w_other = (
                self.links[i].w + (tilt @ self.links[i].modal.v if tilt is not None else 0) for i, tilt in zip((one, other), tilts)
            )
            forward = self.links[other].world.T @ self.links[one].world
            torque = joint["damping"] * (w_other - forward @ w_one)
            for i, tilt, own in ((other, tilts[1], torque), (one, tilts[0], -(forward.T @ torque))):
                moments[i] -= own
                if tilt is not None:
                    for k in range(self.links[i].modal.count):
                        felt[self.links[i].at + 3 + k] += ca.dot(tilt[:, k], own)
        for spring in self.linkage.springs:
            ends = []
            for body, at in zip(spring["ends"], spring["at"]):
                i = self.place[body]
                if i is None:
                    ends.append((None, sparse(at), sparse(at)))
                else:
                    link = self.links[i]
                    local = sparse(link.local(at))
                    ends.append((i, local, link.position + link.world @ local))
            apart = ends[1][2] - ends[0][2]
            length = ca.sqrt(ca.dot(apart, apart))
            pull = spring["stiffness"] * (1 - spring["length"] / length) * apart
            for (i, local, _), push in zip(ends, (pull, -pull)):
                if i is not None:
                    push = self.links[i].world.T @ push
                    pushes[i] += push
                    moments[i] += ca.cross(local, push)

    def rows(self, name):
        """Positions, velocities and accelerations that a cut joint makes zero, in the frame of its second body."""
        joint = self.linkage.joints[name]
        one, other = joint["parent"], joint["child"]
        ends = []
        for body in (one, other):
            i = self.place[body]
            at = joint["at"][body]
            if i is None:
                ends.append((sparse(np.eye(3)), sparse(at), SX(3, 1), SX(3, 1), SX(3, 1), SX(3, 1), np.eye(3)))
                continue
            link = self.links[i]
            local = sparse(link.local(at))
            velocity = link.u + ca.cross(link.w, local)
            acceleration = link.a + ca.cross(link.alpha, local) + ca.cross(link.w, ca.cross(link.w, local))
            ends.append((link.world, link.position + link.world @ local, velocity, acceleration, link.w, link.alpha, link.mount))
        (ra, pa, va, aa, wa, la, ma), (rb, pb, vb, ab, wb, lb, mb) = ends
        # In the frame of the first body: its joint's axes are numbers there.
        into = ra.T @ rb
        axes = [sparse(ma.T @ axis) for axis in joint["axes"]]
        basis = sparse(ma.T @ along_z(joint["axes"][0]))
        gap, slip, drift = ra.T @ (pb - pa), into @ vb - va, into @ ab - aa
        wr = into @ wb - wa
        spin, turn = into @ lb - la, wr
        positions, speeds, biases = [], [], []
        for k in range(3):
            positions.append(ca.dot(basis[:, k], gap))
            speeds.append(ca.dot(basis[:, k], slip))
            biases.append(ca.dot(basis[:, k], drift))
        if joint["kind"] == "revolute":
            axis = into @ sparse(mb.T @ joint["axes"][0])
            for k in range(2):
                positions.append(ca.dot(basis[:, k], axis))
                speeds.append(ca.dot(basis[:, k], wr))
                biases.append(ca.dot(basis[:, k], spin - ca.cross(wa, wr)))
        if joint["kind"] == "universal":
            # The first axis is the first body's, the second the other's.
            second = into @ sparse(mb.T @ joint["axes"][1])
            normal = ca.cross(axes[0], second)
            positions.append(ca.dot(axes[0], second))
            speeds.append(ca.dot(normal, wr))
            biases.append(ca.dot(normal, spin - ca.cross(wa, wr)) + ca.dot(ca.cross(axes[0], ca.cross(wr, second)), wr))
        return positions, speeds, biases

    def build(self):
        self.kinematics()
        zero = SX(self.v.numel(), 1)
        self.accelerate(zero, False)
        made = [self.rows(name) for name in self.cuts]
        positions, speeds, biases = (sum((part[k] for part in made), []) for k in range(3))
        self.positions, self.bias = ca.vertcat(*positions), ca.vertcat(*biases)
        self.jacobian = ca.jacobian(ca.vertcat(*speeds), self.v)
        self.h = self.forces(zero)
        full = self.forces(self.rates, gravity=False, applied=False)
        self.mass = ca.jacobian(full, self.rates)
        return self


class Pinned:
    """Bending modes of a round rod held by a ball at each end (sines), with the tilting of its sections, in a frame on the line
    through both ends. Mass-normalised; the first half of the modes bends in y, the second in z."""

    def __init__(self, link, given):
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

    def tilt(self, at):
        """Turn of the section at an end, by mode."""
        end = int(np.linalg.norm(at) > 0.5 * self.length)
        slopes = np.array([slope[end] for slope in self.slopes])
        none = np.zeros_like(slopes)
        return sparse(np.block([[none, none], [none, -slopes], [slopes, none]]))

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
            value = ca.dot(first[k], link.a) + sum(ca.trace(field[j] @ second[j][k]) for j in range(n))
            modes.append(value + self.stiffness[k - 1] * self.q[k - 1] + self.damping[k - 1] * self.v[k - 1])
        return moment, force, modes
