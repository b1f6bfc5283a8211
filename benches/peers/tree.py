"""Which joints of a linkage carry its bodies and which are cut; frames of the links."""

import numpy as np

from matrices import along_z

# Rows that a cut joint gives.
ROWS = {"revolute": 5, "prismatic": 5, "universal": 4, "spherical": 3}


class Link:
    """A body with its joint to the parent, or a cross of a universal joint with one of its hinges. `mount`: its frame at the reference
    pose, seen from the ground; `near`: the joint's place on the parent there; `sign`: -1 where the parent is the joint's child."""

    def __init__(self, body, joint, kind, number, axis, sign, parent, mount, near, origin):
        self.body, self.joint, self.kind, self.number, self.axis, self.sign = body, joint, kind, number, axis, sign
        self.parent, self.mount, self.near, self.origin = parent, mount, near, origin
        self.modal = self.section = None

    def local(self, point):
        return self.mount.T @ (point - self.origin)

    def held(self, at):
        """The section of a flexible rod at a point."""
        return self.modal.section(self.local(at)) if self.modal else None


class Tree:
    """`cut`: the last joints of the file, or those with few rows. `along`: the ground's axes, or what lies near a link."""

    def __init__(self, linkage, cut, along):
        self.linkage, self.along = linkage, along
        self.tree(self.chosen() if cut == "few rows" else [name for name, joint in linkage.joints.items() if not joint["cut"]])

    def chosen(self):
        """Joints of the tree: driven ones, then those with more rows, then those nearer to the ground."""
        joints, far = self.linkage.joints, {"ground": 0}
        for _ in joints:
            for joint in joints.values():
                for one, other in ((joint["parent"], joint["child"]), (joint["child"], joint["parent"])):
                    if one in far:
                        far[other] = min(far.get(other, len(joints)), far[one] + 1)

        def rank(name):
            joint = joints[name]
            return joint["cut"], joint["drive"] is None, -ROWS[joint["kind"]], min(far[joint["parent"]], far[joint["child"]])

        group, tree = {body: body for body in far}, []
        for name in sorted(joints, key=rank):
            ends = [group[joints[name][end]] for end in ("parent", "child")]
            if ends[0] != ends[1] and not joints[name]["cut"]:
                tree.append(name)
                group = {body: ends[0] if of == ends[1] else of for body, of in group.items()}
        return tree

    def tree(self, left):
        """Breadth first, in the order of the file."""
        joints = self.linkage.joints
        self.links, self.place, queue, taken = [], {"ground": None}, ["ground"], set()
        while queue:
            near = queue.pop(0)
            for name in (name for name in joints if name in left and name not in taken):
                joint = joints[name]
                ends = (joint["parent"], joint["child"])
                far = ends[1] if ends[0] == near else ends[0]
                if near not in ends or far in self.place:
                    continue
                taken.add(name)
                self.carry(name, near, far, 1 if far == ends[1] else -1)
                queue.append(far)
        self.cuts = [name for name in joints if name not in taken]
        if any(joints[name]["kind"] == "prismatic" for name in self.cuts):
            raise ValueError("a cut guide has no rows here")

    def carry(self, name, near, far, sign):
        joint, parent = self.linkage.joints[name], self.place[near]
        at = joint["at"][near], joint["at"][far]
        if parent is not None and self.links[parent].body.flexible and joint["kind"] != "spherical":
            raise ValueError(f"{name}: a flexible rod carries balls alone")
        hinges = [(joint["kind"], "", joint["axes"][0])]
        if joint["kind"] == "universal":
            hinges = [("revolute", str(k + 1), axis) for k, axis in enumerate(joint["axes"])][::sign]
            cross = self.mounted(None, None, parent, hinges[0][2], [hinges[1][2]])
            self.links.append(Link(None, name, *hinges[0], sign, parent, cross, at[0], at[1]))
            parent, at = len(self.links) - 1, (at[1], at[1])
        kind, number, axis = hinges[-1]
        body = self.linkage.bodies[far]
        mount = np.eye(3)
        if kind != "spherical" and not body.flexible:
            mount = self.mounted(far, at[1], parent, axis, [hinge[2] for hinge in hinges[:-1]])
        self.place[far] = len(self.links)
        self.links.append(Link(body, name, kind, number, axis, sign, parent, mount, *at))

    def mounted(self, body, origin, parent, axis, across):
        """A frame with z along the axis, and x where most of what the link has to do with lies."""
        if self.along == "ground":
            return along_z(axis)
        across = list(across)
        if body:
            ends = [joint["at"][body] - origin for joint in self.linkage.joints.values() if body in joint["at"]]
            across += [end for end in [*ends, self.linkage.bodies[body].centre - origin] if np.linalg.norm(end) > 1e-9]
        across += list((self.links[parent].mount if parent is not None else np.eye(3)).T)
        square = (first / np.linalg.norm(first) for first in across if abs(first @ axis) < 1e-5 * np.linalg.norm(first))
        return along_z(axis, next(square, None))
