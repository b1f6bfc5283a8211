"""The second half of each unit's wear from its first half and all other units: linkwear beside SurPyval.

    cargo test --release -p linkwear-gamma --test units_second_half -- --ignored --nocapture scores_of_every_unit > ours.txt
    python3 benches/peers/second_half.py ours.txt

SurPyval's ways: its Gamma and its Wiener process (units alike, parameters as estimated), and its general path models,
whose parameters differ between units by a normal law and are updated by the unit's first readings; `best` chooses
the path by AICc. The law of the last reading is the path's normal posterior with the noise of a reading.
"""

import csv
import math
import sys
import warnings
from collections import defaultdict
from pathlib import Path

import numpy as np
from scipy.stats import gamma as gamma_law
from scipy.stats import norm
from surpyval.degradation import DegradationAnalysis, GammaProcess, WienerProcess

DATA = Path(__file__).resolve().parents[2] / "gamma" / "tests" / "data"
# As in gamma/tests/units_second_half.rs: columns of unit, exposure, wear, covariate; scale; what is left out; zero added. Cracks by
# their length, which exponential paths need; their growth has the same scores.
SETS = {
    "GaAs lasers": ("gaas_lasers.csv", 0, 1, 2, None, 1e-3, (), False),
    "fatigue cracks": ("fatigue_cracks.csv", 0, 1, 2, None, 1.0, (), False),
    "sliding wear, load as covariate": ("sliding_wear.csv", 0, 2, 3, 1, 1.0, ("104", "105"), True),
    "sliding wear as read, load as covariate": ("sliding_wear.csv", 0, 2, 3, 1, 1.0, (), True),
}
PATHS = {"GaAs lasers": ["linear", "best"], "fatigue cracks": ["exponential", "best"]}
PATHS["sliding wear, load as covariate"] = ["power", "best"]
PATHS["sliding wear as read, load as covariate"] = ["power", "best"]
SAMPLES = 20000
# A place beyond every threshold would do: only the paths and their posteriors are asked for.
FAR = {"GaAs lasers": 50.0, "fatigue cracks": 5.0, "sliding wear, load as covariate": 500.0}
FAR["sliding wear as read, load as covariate"] = 500.0


def units_of(name):
    """Unit -> exposure, wear, covariate."""
    file, unit, x, y, z, scale, left_out, zero = SETS[name]
    rows = defaultdict(list)
    with open(DATA / file, encoding="utf-8") as lines:
        table = csv.reader(line for line in lines if not line.startswith("#"))
        next(table)
        for row in table:
            if row[unit] not in left_out:
                value = float(row[z]) if z is not None else math.nan
                rows[row[unit]].append((scale * float(row[x]), float(row[y]), value))
    units = {}
    for key, readings in rows.items():
        readings = ([(0.0, 0.0, readings[0][2])] if zero else []) + readings
        units[key] = np.array(readings)
    return units


def crps(samples, truth):
    """Of an ensemble, by its order statistics."""
    ordered = np.sort(samples)
    n = len(ordered)
    spread = np.sum((2.0 * np.arange(1, n + 1) - n - 1.0) * ordered) / (n * n)
    return np.mean(np.abs(ordered - truth)) - spread


def by_process(kind, name, known, first, later):
    """Growth over the second half by SurPyval's own process, parameters as estimated."""
    x = np.concatenate([unit[:, 0] for unit in known.values()])
    y = np.concatenate([unit[:, 1] for unit in known.values()])
    i = np.concatenate([[key] * len(unit) for key, unit in known.items()])
    extra = {}
    factor = 1.0
    if not math.isnan(first[0, 2]):
        extra["Z"] = np.log(np.concatenate([unit[:, 2] for unit in known.values()]))[:, None]
    model = kind.fit(x, y, i, FAR[name], **extra)
    if extra:
        factor = model.acceleration_factor(np.log(first[:1, 2]))
    span = factor * (later[-1, 0] - first[-1, 0])
    growth = later[-1, 1] - first[-1, 1]
    if kind is GammaProcess:
        law = gamma_law(model.alpha * span, scale=1.0 / model.beta)
    else:
        law = norm(model.mu * span, model.sigma * math.sqrt(span))
    samples = law.ppf((np.arange(SAMPLES) + 0.5) / SAMPLES)
    return law.cdf(growth), -law.logpdf(growth), crps(samples, growth)


def by_path(path, name, known, first, later):
    """The last reading by a general path, its parameters updated by the unit's first readings."""
    skip = 1 if path in ("power", "best") else 0
    cut = {key: unit[unit[:, 0] > 0.0] if skip else unit for key, unit in known.items()}
    cut = {key: unit for key, unit in cut.items() if len(unit) > 2}
    x = np.concatenate([unit[:, 0] for unit in cut.values()])
    y = np.concatenate([unit[:, 1] for unit in cut.values()])
    i = np.concatenate([[key] * len(unit) for key, unit in cut.items()])
    model = DegradationAnalysis.fit(x, y, i, FAR[name], path=path)
    own = first[first[:, 0] > 0.0] if skip else first
    told = model.predict_rul(own[:, 0], own[:, 1], n_samples=10, random_state=0)
    rng = np.random.default_rng(0)
    theta = rng.multivariate_normal(told.posterior_mean, told.posterior_cov, SAMPLES)
    paths = np.array([model.path_model.path(later[-1, 0], *row) for row in theta], dtype=float)
    sigma = math.sqrt(max(float(model.measurement_var), 1e-12))
    truth = later[-1, 1]
    below = float(np.mean(norm.cdf((truth - paths) / sigma)))
    density = float(np.mean(norm.pdf((truth - paths) / sigma))) / sigma
    return below, -math.log(max(density, 1e-300)), crps(paths + sigma * rng.standard_normal(SAMPLES), truth)


def theirs(name):
    """Model -> scores of every unit."""
    units = units_of(name)
    ways = {f"SurPyval path {path}": (by_path, path) for path in PATHS[name]}
    ways |= {"SurPyval Gamma": (by_process, GammaProcess), "SurPyval Wiener": (by_process, WienerProcess)}
    scores = {}
    for label, (way, kind) in ways.items():
        rows = []
        for key, unit in units.items():
            # So many increments are the first half.
            half = (len(unit) - 1) // 2
            first, later = unit[: half + 1], unit[half + 1 :]
            known = {other: first if other == key else whole for other, whole in units.items()}
            try:
                rows.append(way(kind, name, known, first, later))
            except Exception as error:  # noqa: BLE001: what a peer cannot do is told
                print(f"{name}, {label}, unit {key}: {type(error).__name__}: {str(error)[:150]}", file=sys.stderr)
                rows = None
                break
        if rows:
            scores[label] = np.array(rows)
    return scores


def main():
    """Both sides as a table."""
    warnings.filterwarnings("ignore")
    ours = defaultdict(lambda: defaultdict(list))
    with open(sys.argv[1], encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("score;"):
                _, name, model, _, *numbers = line.strip().split(";")
                ours[name][f"linkwear {model}"].append([float(number) for number in numbers])
    print("| data | model | in 50, 80, 95 % | log score | CRPS | behind the best |")
    print("|---|---|---|---|---|---|")
    for name in (name for name in SETS if name in ours):
        scores = {model: np.array(rows) for model, rows in ours[name].items()} | theirs(name)
        best = [min(scores.values(), key=lambda rows: rows[:, of].mean()) for of in (1, 2)]
        for model, rows in scores.items():
            held = [int(np.sum(np.abs(rows[:, 0] - 0.5) <= 0.5 * level)) for level in (0.5, 0.8, 0.95)]
            behind = []
            for of in (1, 2):
                gap = rows[:, of] - best[of - 1][:, of]
                error = gap.std(ddof=1) / math.sqrt(len(gap))
                behind.append("best" if not gap.any() else f"{gap.mean() / error:.1f}")
            print(
                f"| {name} | {model} | {held[0]}, {held[1]}, {held[2]} of {len(rows)} | {rows[:, 1].mean():.3f} | "
                f"{rows[:, 2].mean():.4f} | {', '.join(behind)} |"
            )


if __name__ == "__main__":
    main()
