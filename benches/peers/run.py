"""linkwear beside CasADi: operations and nanoseconds of the same equations, ratios with their spread.

    python3 -m pip install -r benches/peers/requirements.txt
    cargo build --release
    python3 benches/peers/run.py                        # all mechanisms
    python3 benches/peers/run.py mechanisms/bennett.toml --rounds 15 --record benches/peers/record

Both sides run in turn on one processor, so that a slow moment hits both. Before anything is timed, accelerations and drives of both
sides are compared along a run of linkwear: a peer that answers something else is no peer.
"""

import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from equations import Model, of_quaternion  # noqa: E402
from linkage import Linkage  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MECHANISMS = [
    "four_bar", "six_bar", "slider_crank", "spatial_slider_crank", "bennett", "bricard", "andrews", "n_four_bar_2", "rssr_rigid",
    "rssr_flexible",
]
# Of the largest acceleration or drive: twelve digits are printed, and redundant rows and stiff modes cost some.
SAME = 1e-6


def operations(function):
    """Of the program that CasADi runs: no inputs, outputs, constants; sine and cosine of one angle count once, as linkwear's do."""
    codes = [function.instruction_id(k) for k in range(function.n_instructions())]
    idle = {ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_CONST, ca.OP_PARAMETER}
    sines = sum(code == ca.OP_SIN for code in codes)
    cosines = sum(code == ca.OP_COS for code in codes)
    return sum(code not in idle for code in codes) - min(sines, cosines)


def smallest(functions):
    return min(functions, key=operations)


def cholesky(matrix, right):
    return ca.ldl_solve(right, *ca.ldl(matrix))


class Casadi:
    """The equations of a file; rows that say nothing new are left out, by rank at the given states."""

    def __init__(self, path, states):
        self.model = model = Model(Linkage(path)).build()
        self.states = [state(model, row) for row in states]
        rows = self.independent()
        free, driven = model.free, model.driven
        jacobian, bias = model.jacobian[rows, :], model.bias[rows]
        inputs = [ca.vertcat(model.q, model.v)]
        mass = model.mass
        upper = ca.vertcat(*[mass[i, j] for i in range(mass.shape[0]) for j in range(i, mass.shape[0])])
        all_rows = [upper, model.h, model.positions, ca.vec(model.jacobian), model.bias]
        self.equations = self.made("equations_of_motion", inputs, [ca.vertcat(*all_rows)])
        j, m = jacobian[:, free], mass[free, free]
        force, target = -model.h[free], -bias
        candidates = []
        for solve in (self.by_schur, self.by_rows) if len(rows) else (self.by_schur,):
            found = solve(m, j, force, target)
            if found is None:
                continue
            a, multipliers = found
            drive = mass[driven, free] @ a + model.h[driven] - jacobian[:, driven].T @ multipliers
            candidates.append((a, multipliers, drive))
        self.forward = smallest([self.made("forward_dynamics", inputs, [ca.vertcat(*parts)]) for parts in candidates])
        self.accelerations = smallest([self.made("accelerations", inputs, [parts[0]]) for parts in candidates])

    @staticmethod
    def made(name, inputs, outputs):
        return ca.Function(name, inputs, ca.cse([ca.simplify(ca.sparsify(ca.densify(out))) for out in outputs]))

    def independent(self):
        model = self.model
        jacobian = ca.Function("j", [model.q, model.v], [model.jacobian])
        numbers = [np.array(jacobian(*state)) for state in self.states[1:]]
        kept = []
        for row in range(model.jacobian.shape[0]):
            tried = kept + [row]
            ranks = [np.linalg.matrix_rank(number[tried][:, model.free], tol=1e-9) for number in numbers]
            if max(ranks) == len(tried):
                kept.append(row)
        return kept

    @staticmethod
    def by_schur(m, j, force, target):
        """Sparse Cholesky (L D L') of the mass matrix, then of the rows on it."""
        if j.shape[0] == 0:
            return cholesky(m, force), ca.SX(0, 1)
        both = cholesky(m, ca.horzcat(force, j.T))
        free, lifted = both[:, 0], both[:, 1:]
        multipliers = cholesky(j @ lifted, target - j @ free)
        return free + lifted @ multipliers, multipliers

    @staticmethod
    def by_rows(m, j, force, target):
        """Accelerations from the rows alone, where they are as many as the speeds."""
        if j.shape[0] != j.shape[1]:
            return None
        a = ca.solve(j, target)
        return a, ca.solve(j.T, m @ a - force)

    def check(self, path, rows):
        """Against linkwear's rows."""
        model = self.model
        free, driven = model.free, model.driven
        parts = ca.Function("p", [model.q, model.v], [model.mass, model.h, model.jacobian, model.bias])
        worst, scale = 0.0, 0.0
        for row, (q, v) in zip(rows, self.states):
            if any(link.modal for link in model.links) and row is not rows[0]:
                # Speeds of modes are in no column; at the start they are zero.
                continue
            mass, h, jacobian, bias = (np.array(part) for part in parts(q, v))
            n, j = len(free), jacobian[:, free]
            matrix = np.block([[mass[np.ix_(free, free)], -j.T], [j, np.zeros((len(j), len(j)))]])
            solution = np.linalg.lstsq(matrix, np.concatenate([-h[free, 0], -bias[:, 0]]), rcond=1e-11)[0]
            drive = mass[np.ix_(driven, free)] @ solution[:n] + h[driven, 0] - jacobian[:, driven].T @ solution[n:]
            pairs = []
            for link in model.links:
                if model.linkage.joints[link.joint]["kind"] == "spherical":
                    continue
                if link.at in driven:
                    pairs.append((drive[driven.index(link.at)], row[link.joint + ".drive"]))
                else:
                    pairs.append((solution[free.index(link.at)], row[link.joint + ".a"]))
            scale = max([scale] + [abs(theirs) for _, theirs in pairs])
            worst = max([worst] + [abs(ours - theirs) for ours, theirs in pairs])
        if not worst < SAME * scale:
            sys.exit(f"{path}: the models differ by {worst / scale:.1e} of the largest acceleration or drive")

    def compile(self, function, folder):
        """The function as C, with what calls it."""
        source = folder / f"{function.name()}.c"
        cwd = os.getcwd()
        os.chdir(folder)
        function.generate(source.name, {"with_header": False})
        os.chdir(cwd)
        sizes = [f"-DSIZE_{name}={size}" for name, size in zip(("ARG", "RES", "IW", "W"), (
            function.sz_arg(), function.sz_res(), function.sz_iw(), function.sz_w()))]
        binary = folder / function.name()
        flags = [f"-DFUNCTION={function.name()}", f"-DIN={function.nnz_in(0)}", f"-DOUT={function.nnz_out(0)}", *sizes]
        command = ["gcc", "-O3", "-march=native", "-ffp-contract=off", *flags, str(source), str(HERE / "timing.c"), "-lm", "-o", str(binary)]
        subprocess.run(command, check=True)
        return binary

    def inputs(self):
        states = [list(q) + list(v) for q, v in self.states]
        return "\n".join(" ".join(map(repr, map(float, states[k % len(states)]))) for k in range(64))


def state(model, row):
    """Coordinates and speeds of a row of linkwear's table; angular velocities there are in the frame of the ground."""
    q, v, worlds = [], [], {}
    for link in model.links:
        joint = model.linkage.joints[link.joint]
        if joint["kind"] == "spherical":
            parent = model.place[joint["parent"]]
            turn = worlds[parent] if parent is not None else np.eye(3)
            own = turn @ np.array(ca.DM(of_quaternion(ca.DM([row[f"{link.joint}.q{k}"] for k in range(4)]))))
            q += quaternion(own)
            v += list(own.T @ np.array([row[f"{link.body.name}.w{axis}"] for axis in "xyz"]))
        else:
            q.append(row[link.joint + ".q"])
            v.append(row[link.joint + ".v"])
        if link.modal:
            modes = [row[f"{link.body.name}.eta{k + 1}"] for k in range(link.modal.count)]
            # By plane, where linkwear goes by frequency.
            q += modes[0::2] + modes[1::2]
            v += [0.0] * link.modal.count
        known = ca.vertcat(*[item for other in model.links[: len(worlds) + 1] for item in ([other.q, other.modal.q] if other.modal else [other.q])])
        worlds[len(worlds)] = np.array(ca.Function("w", [known], [link.world])(q))
    return q, v


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


def table(linkwear, path, folder):
    """Rows of a short run of linkwear, by column without units."""
    out = folder / "run.csv"
    time = [] if "drive" in Path(path).read_text() else ["--time", "0.02"]
    subprocess.run([linkwear, "simulate", path, *time, "--samples", "23", "--out", out], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(out) as file:
        return [{key.split(" ")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def cost(linkwear, path):
    answer = subprocess.run([linkwear, "cost", path, "--format", "json"], check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return json.loads(answer.stdout)["entry_points"]


def compare(linkwear, path, rounds):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        rows = table(linkwear, path, folder)
        peer = Casadi(path, rows)
        peer.check(path, rows)
        functions = {"forward_dynamics": peer.forward, "accelerations": peer.accelerations, "equations_of_motion": peer.equations}
        programs = {name: peer.compile(function, folder) for name, function in functions.items()}
        times = {name: ([], []) for name in functions}
        for _ in range(rounds):
            ours = cost(linkwear, path)
            for name, program in programs.items():
                theirs = float(subprocess.run([program], input=peer.inputs(), capture_output=True, text=True, check=True).stdout)
                if name in ours:
                    ns = ours[name]["ns"]
                    times[name][0].append(min(ns[key] for key in ("native", "compiled") if ns.get(key)))
                    times[name][1].append(theirs)
        result = {}
        for name, function in functions.items():
            if name not in ours:
                continue
            mine, theirs = times[name]
            ratios = sorted(a / b for a, b in zip(mine, theirs))
            result[name] = {
                "operations": [ours[name]["operations"]["total"], operations(function)],
                "ns": [statistics.median(mine), statistics.median(theirs)],
                "ratio": [statistics.median(ratios), ratios[0], ratios[-1]],
            }
        return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", default=[str(ROOT / "mechanisms" / f"{name}.toml") for name in MECHANISMS])
    parser.add_argument("--linkwear", default=str(ROOT / "target/release/linkwear"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--record", type=Path, help="folder that keeps a file of results per release")
    arguments = parser.parse_args()
    results = {}
    print(f"linkwear beside CasADi {ca.__version__} (gcc -O3 -march=native), medians of {arguments.rounds} rounds\n")
    print(f"{'mechanism':22} {'entry':20} {'operations':>16} {'ns':>15}  ratio of times (least, most)")
    for path in arguments.files:
        name = Path(path).stem
        results[name] = compare(arguments.linkwear, path, arguments.rounds)
        for entry, found in results[name].items():
            (a, b), (x, y), (median, least, most) = found["operations"], found["ns"], found["ratio"]
            print(f"{name:22} {entry:20} {a:7} {b:8} {x:7.1f} {y:7.1f}  {median:.2f} ({least:.2f}, {most:.2f})", flush=True)
    if arguments.record:
        version = subprocess.run([arguments.linkwear, "--version"], capture_output=True, text=True).stdout.split()[-1]
        arguments.record.mkdir(parents=True, exist_ok=True)
        file = arguments.record / f"casadi-{version}.json"
        file.write_text(json.dumps({"linkwear": version, "casadi": ca.__version__, "results": results}, indent=1) + "\n")
        print(f"\nkept in {file}")


if __name__ == "__main__":
    main()
