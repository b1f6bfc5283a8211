"""Equations of motion of a linkage in CasADi, as a user of CasADi would write them with care.

Relative coordinates of a spanning tree, recursive Newton-Euler in the frames of the links, composite bodies for the mass matrix,
velocities of cut joints as rows, scalar expressions with common ones shared. Of several forms of the same the one with the fewest
operations counts. A ball in the tree has the orientation of its link against the ground, as quaternion; a universal joint there is two
hinges with a cross that has no mass.
"""

import casadi as ca
import numpy as np

from flexible import Pinned
from matrices import along_z, of_quaternion, skew, sparse, turn_z
from tree import Tree

SX = ca.SX
# Which joints are cut, along what the links' axes lie, along which axes the rows of a cut ball are: those of either body, of the ground.
FORMS = [(cut, along, frame) for cut in ("last", "few rows") for along in ("ground", "neighbours") for frame in (0, 1, 2)]


class Model(Tree):
    def __init__(self, linkage, cut, along, frame):
        super().__init__(linkage, cut, along)
        self.frame = frame
        self.symbols()
        # What makes this form another than others.
        balls = any(linkage.joints[name]["kind"] == "spherical" for name in self.cuts)
        self.form = tuple(self.cuts), tuple((link.joint, link.mount.tobytes()) for link in self.links), balls and frame

    def symbols(self):
        q, v = [], []
        for link in self.links:
            count = (4, 3) if link.kind == "spherical" else (1, 1)
            name = link.joint + link.number
            link.q, link.v = SX.sym(name + "_q", count[0]), SX.sym(name + "_v", count[1])
            link.at = sum(item.numel() for item in v)
            q.append(link.q)
            v.append(link.v)
            if link.body and link.body.flexible:
                link.modal = Pinned(link.body.flexible, link.origin)
                link.modal.at = link.at + count[1]
                q.append(link.modal.q)
                v.append(link.modal.v)
                if link.kind != "spherical":
                    link.section = link.held(link.origin)
        self.q, self.v = ca.vertcat(*q), ca.vertcat(*v)
        self.rates = SX.sym("a", self.v.numel())
        drivers = [link for link in self.links if self.linkage.joints[link.joint]["drive"]]
        self.driven = [link.at for link in drivers]
        self.free = [i for i in range(self.v.numel()) if i not in self.driven]
        self.prescribe(drivers)

    def prescribe(self, drivers):
        """What drives give at a time, and what is left to give besides: time, parameters, coordinates and speeds."""
        names = self.linkage.names
        time, tunable = SX.sym("t"), {name: SX.sym(name) for name in names.tunable}
        formulas = [self.linkage.joints[link.joint]["drive"] for link in drivers]
        angles = [SX(names.formula(text, {"t": time, "sin": ca.sin, "cos": ca.cos} | tunable)) for text in formulas]
        speeds = [ca.densify(ca.jacobian(angle, time)) for angle in angles]
        self.driven_a = ca.vertcat(*[ca.jacobian(speed, time) for speed in speeds])
        self.replaced = [link.q for link in drivers] + [link.v for link in drivers], angles + speeds
        used = [symbol for name, symbol in tunable.items() if any(ca.depends_on(angle, symbol) for angle in angles)]
        values = [names[name] for name, symbol in tunable.items() if any(symbol is other for other in used)]
        at = [i for i in range(self.q.numel()) if not any(ca.is_equal(self.q[i], link.q) for link in drivers)]
        given = [time, *used] if drivers else []
        self.given = ca.vertcat(*given, self.q[at], self.v[self.free])
        self.numbers = lambda t, q, v: np.concatenate([[t, *values] if drivers else [], np.array(q)[at], np.array(v)[self.free]])

    def in_time(self, expression):
        """With what drives give in the place of driven coordinates and speeds."""
        return ca.substitute([expression], *self.replaced)[0] if self.driven else expression

    def kinematics(self):
        """Rotation and offset from parent, angular velocity, velocity of the origin, rotation to the ground."""
        for link in self.links:
            up = self.links[link.parent] if link.parent is not None else None
            mount = up.mount if up else np.eye(3)
            link.offset = sparse(up.local(link.near) if up else link.near)
            up_w, up_v = (up.w, up.u) if up else (SX(3, 1), SX(3, 1))
            if link.kind == "spherical":
                link.world = of_quaternion(link.q)
                link.turn = up.world.T @ link.world if up else link.world
                link.w = link.v
            else:
                link.along = link.sign * sparse(link.mount.T @ link.axis)
                link.turn = sparse(mount.T @ link.mount)
                if link.kind == "prismatic":
                    link.offset = link.offset + link.turn @ link.along * link.q
                    link.w = link.turn.T @ up_w
                else:
                    about, angle = link.mount if link.mount[:, 2] @ link.axis > 1 - 1e-14 else along_z(link.axis), link.sign * link.q
                    link.turn = sparse(mount.T @ about) @ turn_z(ca.cos(angle), ca.sin(angle)) @ sparse(about.T @ link.mount)
                    if link.section:
                        # The hinge holds the section; the link is the line through both ends.
                        link.turn, link.along = link.turn @ link.section.turn.T, link.section.turn @ link.along
                    link.w = link.turn.T @ up_w + link.along * link.v
                    if link.section:
                        link.w = link.w - link.section.rate
                link.world = up.world @ link.turn if up else sparse(mount) @ link.turn
            link.u = link.turn.T @ (up_v + ca.cross(up_w, link.offset))
            if link.kind == "prismatic":
                link.u = link.u + link.along * link.v
            # Sparse products of numbers and symbols leave exact zeros.
            link.position = (up.position + up.world @ link.offset) if up else link.offset

    def accelerate(self, rates, gravity):
        for link in self.links:
            up = self.links[link.parent] if link.parent is not None else None
            own = rates[link.at:link.at + link.v.numel()]
            base = sparse(-self.linkage.gravity) if gravity else SX(3, 1)
            up_a, up_alpha, up_w = (up.a, up.alpha, up.w) if up else (base, SX(3, 1), SX(3, 1))
            link.a = link.turn.T @ (up_a + ca.cross(up_alpha, link.offset) + ca.cross(up_w, ca.cross(up_w, link.offset)))
            if link.kind == "spherical":
                link.alpha = own
                continue
            link.alpha = link.turn.T @ up_alpha
            moved = link.along * link.v
            if link.kind == "prismatic":
                link.a = link.a + 2 * ca.cross(link.w, moved) + link.along * own
                continue
            w, bend = link.w, SX(3, 1)
            if link.section:
                bend = ca.cross(w, link.section.rate) + link.section.rate_of_rate(rates[link.modal.at:link.modal.at + link.modal.count])
                w = w + link.section.rate
            link.alpha = link.alpha + ca.cross(w, moved) + link.along * own - bend

    def forces(self, rates, gravity=True, applied=True):
        """Inverse dynamics: what every speed needs for these rates."""
        self.accelerate(rates, gravity)
        moments, pushes = [SX(3, 1) for _ in self.links], [SX(3, 1) for _ in self.links]
        felt = [SX(0) for _ in range(self.v.numel())]
        if applied:
            self.apply(moments, pushes, felt)
        for i, link in enumerate(self.links):
            moment, force, modes = self.inertial(link, rates)
            moments[i] = moment - moments[i]
            pushes[i] = force - pushes[i]
            for k, value in enumerate(modes):
                felt[link.modal.at + k] += value
        for i, link in reversed(list(enumerate(self.links))):
            wrench = {"revolute": moments[i], "prismatic": pushes[i]}.get(link.kind)
            own = [moments[i][j] for j in range(3)] if wrench is None else [ca.dot(link.along, wrench)]
            for k, value in enumerate(own):
                felt[link.at + k] += value
            if link.section:
                for k in range(link.modal.count):
                    felt[link.modal.at + k] -= ca.dot(link.section.turns[:, k], moments[i])
            if link.parent is not None:
                push = link.turn @ pushes[i]
                passed = SX(3, 1) if link.kind == "spherical" else link.turn @ moments[i]
                moments[link.parent] += passed + ca.cross(link.offset, push)
                pushes[link.parent] += push
        if applied:
            for link in self.links:
                joint = self.linkage.joints[link.joint]
                if joint["kind"] in ("revolute", "prismatic"):
                    felt[link.at] += joint["damping"] * link.v
                    if joint["force"]:
                        felt[link.at] -= self.linkage.names.formula(joint["force"], {"tanh": ca.tanh, "v": link.v})
        return ca.vertcat(*felt)

    def inertial(self, link, rates):
        body = link.body
        if body is None:
            return SX(3, 1), SX(3, 1), []
        spin = skew(link.alpha) + skew(link.w) @ skew(link.w)
        centre = sparse(link.local(body.centre))
        if link.modal:
            return link.modal.inertial(link, spin, rates[link.modal.at:link.modal.at + link.modal.count])
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
            tilts = [self.links[i].modal and self.links[i].held(joint["at"][self.links[i].body.name]).tilt for i in (one, other)]
            w_one, w_other = (
                self.links[i].w + (tilt @ self.links[i].modal.v if tilt is not None else 0) for i, tilt in zip((one, other), tilts)
            )
            forward = self.links[other].world.T @ self.links[one].world
            torque = joint["damping"] * (w_other - forward @ w_one)
            for i, tilt, own in ((other, tilts[1], torque), (one, tilts[0], -(forward.T @ torque))):
                moments[i] -= own
                if tilt is not None:
                    for k in range(self.links[i].modal.count):
                        felt[self.links[i].modal.at + k] += ca.dot(tilt[:, k], own)
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

    def end(self, body, at):
        """What a joint holds of a body: rotation to the ground, place, velocity, acceleration, angular ones, frame at the reference pose,
        rotation of the section in the body."""
        i = self.place[body]
        none = SX(3, 1)
        if i is None:
            return sparse(np.eye(3)), sparse(at), none, none, none, none, np.eye(3), sparse(np.eye(3))
        link = self.links[i]
        local = sparse(link.local(at))
        velocity = link.u + ca.cross(link.w, local)
        acceleration = link.a + ca.cross(link.alpha, local) + ca.cross(link.w, ca.cross(link.w, local))
        w, alpha, turn, held = link.w, link.alpha, sparse(np.eye(3)), link.held(at)
        if held:
            w, turn = w + held.rate, held.turn
            alpha = alpha + ca.cross(link.w, held.rate) + held.rate_of_rate(SX(link.modal.count, 1))
        return link.world, link.position + link.world @ local, velocity, acceleration, w, alpha, link.mount, turn

    def rows(self, name):
        """Positions, velocities and accelerations that a cut joint makes zero, along the axes of one of its bodies or of the ground."""
        joint = self.linkage.joints[name]
        ends = [self.end(body, joint["at"][body]) for body in (joint["parent"], joint["child"])]
        is_ball = joint["kind"] == "spherical"
        if is_ball and self.frame == 1:
            ends.reverse()
        (ra, pa, va, aa, wa, la, ma, sa), (rb, pb, vb, ab, wb, lb, mb, sb) = ends
        if is_ball and self.frame == 2:
            return [[part[k] for k in range(3)] for part in (pb - pa, rb @ vb - ra @ va, rb @ ab - ra @ aa)]
        # In the frame of the first body: its joint's axes are numbers there, but where it bends.
        into = ra.T @ rb
        gap, slip, drift = ra.T @ (pb - pa), into @ vb - va, into @ ab - aa
        if is_ball:
            return [[part[k] for k in range(3)] for part in (gap, slip, drift)]
        axes = [sa @ sparse(ma.T @ axis) for axis in joint["axes"]]
        basis = sparse(ma.T @ along_z(joint["axes"][0]))
        positions, speeds, biases = ([ca.dot(basis[:, k], part) for k in range(3)] for part in (gap, slip, drift))
        wr, spin = into @ wb - wa, into @ lb - la
        spin = spin - ca.cross(wa, wr)
        if joint["kind"] == "revolute":
            axis = into @ sb @ sparse(mb.T @ joint["axes"][0])
            for k in range(2):
                across = sa @ basis[:, k]
                positions.append(ca.dot(across, axis))
                speeds.append(ca.dot(across, wr))
                biases.append(ca.dot(across, spin))
        if joint["kind"] == "universal":
            # The first axis is the first body's, the second the other's.
            second = into @ sb @ sparse(mb.T @ joint["axes"][1])
            normal = ca.cross(axes[0], second)
            positions.append(ca.dot(axes[0], second))
            speeds.append(ca.dot(normal, wr))
            biases.append(ca.dot(normal, spin) + ca.dot(ca.cross(axes[0], ca.cross(wr, second)), wr))
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
        self.needed = self.forces(self.rates)
        full = self.forces(self.rates, gravity=False, applied=False)
        self.mass = ca.jacobian(full, self.rates)
        return self
