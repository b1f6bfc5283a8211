"""A linkage file as plain numbers, read without linkwear: what a peer's model is made of.

Taken are rigid bodies of round rods, tubes, boxes and given masses; revolute, prismatic, spherical and universal joints; springs
between points; drives by formulas over time and parameters; viscous friction; pinned flexible rods. Anything else is refused.
"""

import math
import re
import tomllib

import numpy as np

UNITS = {
    "m": 1, "mm": 1e-3, "um": 1e-6, "kg": 1, "s": 1, "N": 1, "rad": 1, "deg": math.pi / 180, "Hz": 1, "Pa": 1, "MPa": 1e6, "GPa": 1e9,
    "W": 1, "J": 1,
}
NUMBER_AND_UNIT = re.compile(
    r"(\d+\.?\d*(?:[eE][-+]?\d+)?)\s+((?:[A-Za-z]+(?:\^\d+)?)(?:[ /*]+[A-Za-z]+(?:\^\d+)?)*)"
)


def unit(text):
    """Factor to SI of a unit such as `kg m^2` or `N m s/rad`."""
    factor, sign = 1.0, 1
    for sign_text, name, power in re.findall(r"([ /*]*)([A-Za-z]+)(?:\^(\d+))?", text):
        sign = -1 if "/" in sign_text else sign
        factor *= UNITS[name] ** (sign * int(power or 1))
    return factor


def plain(text):
    """Without units, in SI."""
    return NUMBER_AND_UNIT.sub(lambda found: repr(float(found[1]) * unit(found[2])), text).replace("^", "**")


class Names(dict):
    """Values of parameters by name, each evaluated when it is asked for."""

    def __init__(self, given):
        super().__init__(pi=math.pi, sin=math.sin, cos=math.cos, tanh=math.tanh, sqrt=math.sqrt)
        self.given = {name: item["value"] if isinstance(item, dict) else item for name, item in given.items()}
        self.tunable = [name for name, item in given.items() if isinstance(item, dict) and item.get("tunable")]

    def __missing__(self, name):
        if name not in self.given:
            raise KeyError(name)
        self[name] = self.number(self.given[name])
        return self[name]

    def number(self, text):
        if isinstance(text, (int, float)):
            return float(text)
        return float(eval(plain(text), {"__builtins__": {}}, self))

    def formula(self, text, symbols):
        """A formula over parameters and symbols, which go before parameters and functions of the same name."""
        return eval(plain(text), {"__builtins__": {}}, {name: self[name] for name in [*self.given, "pi"]} | symbols)


class Body:
    def __init__(self, name, mass, centre, inertia, flexible=None):
        self.name, self.mass, self.centre, self.inertia, self.flexible = name, mass, centre, inertia, flexible


class Linkage:
    """Bodies with mass, centre and inertia about it (ground frame, reference pose); joints; springs; gravity."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = tomllib.load(file)
        repeat(data)
        self.names = Names(data.get("parameters", {}))
        self.gravity = self.vector(data.get("gravity", [0, 0, 0]))
        self.points = data.get("points", {})
        self.bodies = {name: self.body(name, item) for name, item in data["bodies"].items()}
        self.joints = {name: self.joint(item) for name, item in data["joints"].items()}
        self.springs = [self.spring(item) for item in data.get("forces", {}).values()]

    def number(self, text):
        return self.names.number(text)

    def vector(self, items):
        return np.array([self.number(item) for item in items])

    def point(self, name, body=None):
        given = self.points[name]
        if isinstance(given, dict):
            given = given["at"] if "at" in given else given[body]
        return self.vector(given)

    def body(self, name, item):
        flexible = item.get("flexible")
        kind = next((kind for kind in ("rod", "tube", "box") if kind in item), None)
        if kind is None:
            inertia = self.vector(item["inertia"])
            centre = item["centre"]
            centre = self.point(centre, name) if isinstance(centre, str) else self.vector(centre)
            return Body(name, self.number(item["mass"]), centre, np.diag(inertia))
        begin, end = (self.point(point, name) for point in item[kind])
        length = np.linalg.norm(end - begin)
        along = (end - begin) / length
        if kind == "box":
            widths = item["width"] if isinstance(item["width"], list) else [item["width"]] * 2
            first, second = (self.number(width) for width in widths)
            area, across = first * second, np.array(item["width_axis"], float)
            # The first edge lies along the axis given.
            moments = [(first**2 + second**2) / 12, (second**2 + length**2) / 12, (first**2 + length**2) / 12]
            axes = [along, across, np.cross(along, across)]
        else:
            outer, inner = self.number(item["radius"]), self.number(item.get("inner_radius", 0))
            area = math.pi * (outer**2 - inner**2)
            moments = [(outer**2 + inner**2) / 2] + [(3 * (outer**2 + inner**2) + length**2) / 12] * 2
            other = np.eye(3)[int(np.argmin(abs(along)))]
            second = np.cross(along, other) / np.linalg.norm(np.cross(along, other))
            axes = [along, second, np.cross(along, second)]
        mass = self.number(item["mass"]) if "mass" in item else self.number(item["density"]) * area * length
        inertia = sum(mass * moment * np.outer(axis, axis) for moment, axis in zip(moments, axes))
        if flexible:
            given = {key: self.number(flexible[key]) for key in ("modes", "young", "poisson", "damping")}
            if kind != "rod" or flexible.get("held", "pinned") != "pinned" or along[0] < 1 - 1e-12:
                raise ValueError(f"{name}: flexible are pinned round rods along x")
            flexible = given | {"radius": self.number(item["radius"]), "begin": begin, "length": length, "mass": mass, "area": area}
        return Body(name, mass, (begin + end) / 2, inertia, flexible)

    def joint(self, item):
        kind = next(kind for kind in ("revolute", "prismatic", "spherical", "universal") if kind in item)
        parent, child = item[kind]
        axes = [np.array(axis, float) for axis in item.get("axes", [item.get("axis", [0, 0, 1])])]
        force = item.get("force")
        if force is not None:
            force = re.sub(r"\w+\.v", "v", force)
        return {
            "kind": kind, "parent": parent, "child": child, "cut": item.get("cut", False), "drive": item.get("drive"), "force": force,
            "axes": [axis / np.linalg.norm(axis) for axis in axes],
            "at": {body: self.point(item["at"], body) for body in (parent, child)},
            "damping": self.number(item.get("damping", item.get("friction", 0))),
        }

    def across(self, body):
        """The direction z of a flexible rod along x: the axis of a hinge across it, else y."""
        hinges = [joint for joint in self.joints.values() if joint["kind"] in ("revolute", "universal") and body in joint["at"]]
        axes = [axis for joint in hinges for axis in joint["axes"]]
        return next((axis for axis in axes if abs(axis[0]) < 1e-9), np.array([0.0, 1, 0]))

    def spring(self, item):
        ends = item["spring"]
        at = [self.point(point, body) for point, body in zip(item["at"], ends)]
        return {"ends": ends, "at": at, "stiffness": self.number(item["stiffness"]), "length": self.number(item["length"])}


def repeat(data):
    """Writes repeated cells out."""

    def written(value, i):
        if isinstance(value, str):
            value = re.sub(r"\{i-1\}", str(i - 1), value).replace("{i}", str(i))
            return value
        if isinstance(value, list):
            return [written(item, i) for item in value]
        if isinstance(value, dict):
            return {written(key, i): written(item, i) for key, item in value.items()}
        return value

    for cell in data.pop("repeat", {}).values():
        for i in range(1, cell["count"] + 1):
            for table in ("points", "bodies", "joints"):
                data.setdefault(table, {}).update(written(cell.get(table, {}), i))
