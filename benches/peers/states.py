"""Runs of linkwear, and the coordinates and speeds of a model at their rows."""

import csv
import re
import subprocess
from pathlib import Path

import casadi as ca
import numpy as np

from matrices import of_quaternion

# A drive that turns on and on.
TURNING = r'drive = "2\*pi\*speed\*t"'
# What a run takes of the motion where nothing turns on and on [s].
SPANS = {"andrews": "0.05", "bricard": "10", "n_four_bar_2": "2"}


def state(model, row):
    """Coordinates and speeds of a row of linkwear's table; angular velocities there are in the frame of the ground."""
    q, v = [], []
    for link in model.links:
        eta = [row[f"{link.body.name}.eta{k + 1}"] for k in range(link.modal.count)] if link.modal else []
        rates = row.get(link.body.name + ".rates", [0.0] * len(eta)) if link.modal else []
        if link.modal:
            eta, rates = (by_plane(item, model.linkage.across(link.body.name)) for item in (eta, rates))
        if link.kind == "spherical":
            relative = np.array(ca.DM(of_quaternion(ca.DM([row[f"{link.joint}.q{k}"] for k in range(4)]))))
            own = relative if link.sign > 0 else relative.T
            if link.parent is not None:
                up = model.links[link.parent]
                own = number(model, up.world, q) @ up.mount.T @ own
            q += [*quaternion(own), *eta]
            v += [*(own.T @ np.array([row[f"{link.body.name}.w{axis}"] for axis in "xyz"])), *rates]
        else:
            q += [row[f"{link.joint}.q{link.number}"], *eta]
            v += [row[f"{link.joint}.v{link.number}"], *rates]
    return q, v


def number(model, expression, q):
    """Its value where the first coordinates are known."""
    return np.array(ca.Function("n", [model.q[:len(q)]], [expression])(q))


def by_plane(modes, z):
    """Modes that bend in y, then in z; linkwear has them by frequency, in planes of its own."""
    first, second = np.array(modes[0::2]), np.array(modes[1::2])
    y = np.cross(z, [1, 0, 0])
    return [*(y[1] * first + z[1] * second), *(y[2] * first + z[2] * second)]


def quaternion(turn):
    w = 0.5 * np.sqrt(max(0.0, 1 + np.trace(turn)))
    if w > 0.1:
        return [w] + [(turn[k - 1, k - 2] - turn[k - 2, k - 1]) / (4 * w) for k in range(3)]
    # A half turn or nearly: by the largest component.
    values, vectors = np.linalg.eigh(
        np.array([
            [turn[0, 0] - turn[1, 1] - turn[2, 2], turn[0, 1] + turn[1, 0], turn[0, 2] + turn[2, 0], turn[2, 1] - turn[1, 2]],
            [0, turn[1, 1] - turn[0, 0] - turn[2, 2], turn[1, 2] + turn[2, 1], turn[0, 2] - turn[2, 0]],
            [0, 0, turn[2, 2] - turn[0, 0] - turn[1, 1], turn[1, 0] - turn[0, 1]],
            [0, 0, 0, np.trace(turn)],
        ]), UPLO="U")
    x, y, z, w = vectors[:, -1]
    return [w, x, y, z]


def table(linkwear, path, folder, *span):
    """Rows of a run of linkwear, by column without units."""
    out = folder / "run.csv"
    if not span and not re.search(TURNING, Path(path).read_text()):
        span = ["--time", SPANS.get(Path(path).stem, "1")]
    command = [linkwear, "simulate", path, *span, "--samples", "101", "--out", out]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(out) as file:
        return [{key.split(" ")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def rounded(path, folder):
    """A copy with six digits behind the point: directions that leave no zero where they meet."""
    file = folder / f"{Path(path).stem}_rounded.toml"
    file.write_text(re.sub(r"\d[\d.]{9,}", lambda found: f"{float(found[0]):.6f}", Path(path).read_text()))
    return file


def deflected(linkwear, path, linkage, folder):
    """Starts with modes that are displaced and move."""
    random, file, rows = np.random.default_rng(1), folder / Path(path).name, []
    for _ in range(3):
        text, rates = Path(path).read_text() + "\n[initial]\n", {}
        for name, body in linkage.bodies.items():
            if body.flexible:
                count, size = int(body.flexible["modes"]), np.sqrt(body.flexible["mass"])
                eta = list(1e-3 * size * random.standard_normal(count))
                rates[name + ".rates"] = list(0.1 * size * random.standard_normal(count))
                text += f"{name} = {{ eta = {list(map(float, eta))}, eta_v = {list(map(float, rates[name + '.rates']))} }}\n"
        file.write_text(text)
        rows.append(table(linkwear, file, folder, "--time", "1e-6")[0] | rates)
    return rows
