"""What CasADi runs for a file: forms of its equations, ways to solve them, and the programs with the fewest operations."""

import os
import subprocess
import sys
from pathlib import Path

import casadi as ca
import numpy as np

from equations import FORMS, SX, Model
from linkage import Linkage
from solve import WAYS
from states import deflected, state

# Of the largest acceleration or drive: twelve digits are printed, and redundant rows and stiff modes cost some.
SAME = 1e-6


def operations(function):
    """Of the program that CasADi runs: no inputs, outputs, constants; sine and cosine of one angle count once, as linkwear's do."""
    codes = [function.instruction_id(k) for k in range(function.n_instructions())]
    idle = {ca.OP_INPUT, ca.OP_OUTPUT, ca.OP_CONST, ca.OP_PARAMETER}
    sines = sum(code == ca.OP_SIN for code in codes)
    cosines = sum(code == ca.OP_COS for code in codes)
    return sum(code not in idle for code in codes) - min(sines, cosines)


class Program:
    """A function of one vector, with what goes in at the states of a run."""

    def __init__(self, name, given, outputs, inputs):
        outputs = [ca.sparsify(ca.densify(out)) for out in outputs]
        shared = ca.cse(outputs), ca.cse([ca.simplify(out) for out in outputs])
        self.function = min((ca.Function(name, [given], out) for out in shared), key=operations)
        self.inputs, self.operations = inputs, operations(self.function)

    def compile(self, folder):
        """As C, with what calls it."""
        function = self.function
        source = folder / f"{function.name()}.c"
        cwd = os.getcwd()
        os.chdir(folder)
        function.generate(source.name, {"with_header": False})
        os.chdir(cwd)
        sizes = [f"-DSIZE_{name}={size}" for name, size in zip(("ARG", "RES", "IW", "W"), (
            function.sz_arg(), function.sz_res(), function.sz_iw(), function.sz_w()))]
        binary = folder / function.name()
        flags = [f"-DFUNCTION={function.name()}", f"-DIN={function.nnz_in(0)}", f"-DOUT={function.nnz_out(0)}", *sizes]
        sources = [str(source), str(Path(__file__).with_name("timing.c"))]
        subprocess.run(["gcc", "-O3", "-march=native", "-ffp-contract=off", *flags, *sources, "-lm", "-o", str(binary)], check=True)
        return binary

    def text(self):
        return "\n".join(" ".join(map(repr, map(float, self.inputs[k % len(self.inputs)]))) for k in range(64))


class Form:
    """The equations of a file in one form; rows that say nothing new are left out, by rank at the given states."""

    def __init__(self, model, rows, ways):
        self.model, self.ways = model, ways
        self.states = [state(model, row) for row in rows]
        self.kept = self.independent()
        inputs = [np.concatenate([q, v]) for q, v in self.states]
        mass = model.mass
        upper = ca.vertcat(*[mass[i, j] for i in range(mass.shape[0]) for j in range(i, mass.shape[0])])
        all_rows = [upper, model.h, model.positions, ca.vec(model.jacobian), model.bias]
        self.equations = Program("equations_of_motion", ca.vertcat(model.q, model.v), [ca.vertcat(*all_rows)], inputs)
        inputs = [model.numbers(row["t"], q, v) for row, (q, v) in zip(rows, self.states)]
        self.forward, self.accelerations = [], []
        for a, multipliers, drive in self.solved():
            self.accelerations.append(Program("accelerations", model.given, [model.in_time(a)], inputs))
            parts = model.in_time(ca.vertcat(a, multipliers, drive))
            self.forward.append(Program("forward_dynamics", model.given, [parts], inputs))

    def independent(self):
        model = self.model
        jacobian = ca.Function("j", [model.q, model.v], [model.jacobian])
        self.jacobians = [np.array(jacobian(*state)) for state in self.states[1:]]
        kept = []
        for row in range(model.jacobian.shape[0]):
            tried = kept + [row]
            ranks = [np.linalg.matrix_rank(number[tried][:, model.free], tol=1e-9) for number in self.jacobians]
            if max(ranks) == len(tried):
                kept.append(row)
        return kept

    def solved(self):
        """Accelerations, multipliers and drives, in every way."""
        model, kept = self.model, self.kept
        free, driven = model.free, model.driven
        jacobian, bias, mass = model.jacobian[kept, :], model.bias[kept], model.mass
        m, j, given = mass[free, free], ca.sparsify(jacobian[:, free]), model.driven_a
        force, target = -model.h[free], -bias
        if driven:
            force, target = force - mass[free, driven] @ given, target - jacobian[:, driven] @ given
        numbers = [number[kept][:, free] for number in self.jacobians]
        for way in self.ways:
            found = way(m, j, force, target, numbers)
            if found is None:
                continue
            a, multipliers = found
            every = SX(model.v.numel(), 1)
            every[free], every[driven] = a, given
            # What has to come from rows and drives: by the mass matrix, or by inverse dynamics without it.
            for needed in (mass @ every + model.h, ca.substitute([model.needed], [model.rates], [ca.densify(every)])[0]):
                of_rows = multipliers(needed[free])
                yield a, of_rows, needed[driven] - jacobian[:, driven].T @ of_rows

    def apart(self, rows):
        """How far linkwear's rows are from these equations, of the largest acceleration or drive, and how far loops are open there."""
        model = self.model
        free, driven = model.free, model.driven
        parts = ca.Function("p", [model.q, model.v], [model.mass, model.h, model.jacobian, model.bias, model.positions])
        prescribed = ca.Function("d", [model.given], [model.driven_a])
        pairs, opened = [], 0.0
        for row in rows:
            q, v = state(model, row)
            mass, h, jacobian, bias, positions = (np.array(part) for part in parts(q, v))
            opened = abs(positions).max(initial=opened)
            if driven:
                given = np.array(prescribed(model.numbers(row["t"], q, v)))
                h, bias = h + mass[:, driven] @ given, bias + jacobian[:, driven] @ given
            n, j = len(free), jacobian[:, free]
            matrix = np.block([[mass[np.ix_(free, free)], -j.T], [j, np.zeros((len(j), len(j)))]])
            solution = np.linalg.lstsq(matrix, np.concatenate([-h[free, 0], -bias[:, 0]]), rcond=1e-11)[0]
            drive = mass[np.ix_(driven, free)] @ solution[:n] + h[driven, 0] - jacobian[:, driven].T @ solution[n:]
            pairs += self.pairs(row, solution[:n], drive)
        return max(apart(pairs), opened)

    def program_apart(self, program, rows):
        """How far they are from what a program gives."""
        pairs, drives = [], len(self.model.driven)
        for row in rows:
            out = np.array(ca.densify(program.function(self.model.numbers(row["t"], *state(self.model, row))))).ravel()
            has_drives = program in self.forward
            pairs += self.pairs(row, out[:len(self.model.free)], out[len(out) - drives:] if has_drives else None)
        return apart(pairs)

    def pairs(self, row, a, drive):
        """Values here and in a row of linkwear."""
        model = self.model
        for link in model.links:
            if link.kind == "spherical":
                continue
            if link.at not in model.driven:
                yield a[model.free.index(link.at)], row[f"{link.joint}.a{link.number}"]
            elif drive is not None:
                yield drive[model.driven.index(link.at)], row[link.joint + ".drive"]


def apart(pairs):
    ours, theirs = np.array(pairs).T
    return abs(ours - theirs).max() / abs(theirs).max()


class Casadi:
    """Of all forms of a file's equations, for each entry point the program with the fewest operations."""

    def __init__(self, path, rows, ways=WAYS):
        self.linkage = Linkage(path)
        models = {model.form: model for model in (Model(self.linkage, *form) for form in FORMS)}
        self.forms = [Form(model.build(), rows, ways) for model in models.values()]
        entries = {
            "forward_dynamics": [(program, form) for form in self.forms for program in form.forward],
            "accelerations": [(program, form) for form in self.forms for program in form.accelerations],
            "equations_of_motion": [(form.equations, form) for form in self.forms],
        }
        self.chosen = {name: min(found, key=lambda pair: pair[0].operations) for name, found in entries.items()}
        self.programs = {name: program for name, (program, _) in self.chosen.items()}

    def check(self, linkwear, path, rows, folder):
        """Against linkwear's rows: all forms, and what the programs give where the start is not singular."""
        if any(body.flexible for body in self.linkage.bodies.values()):
            # Speeds of modes are in no column: what they are is known where the file says it.
            rows = [rows[0], *deflected(linkwear, path, self.linkage, folder)]
        differences = [form.apart(rows) for form in self.forms]
        solved = (self.chosen[name] for name in ("forward_dynamics", "accelerations"))
        differences += [form.program_apart(program, rows[1:]) for program, form in solved]
        if not max(differences) < SAME:
            sys.exit(f"{path}: the models differ by {max(differences):.1e} of the largest acceleration or drive")
