"""linkwear beside CasADi: operations and nanoseconds of the same equations, ratios with their spread.

    python3 -m pip install -r benches/peers/requirements.txt
    cargo build --release
    python3 benches/peers/run.py                        # all mechanisms
    python3 benches/peers/run.py mechanisms/bennett.toml --rounds 15 --record benches/peers/record

Both sides run in turn on one processor, so that a slow moment hits both. Before anything is timed, accelerations and drives of both
sides are compared along a run of linkwear: a peer that answers something else is no peer.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import casadi as ca

sys.path.insert(0, str(Path(__file__).parent))
from programs import Casadi  # noqa: E402
from solve import OF_A_RUN, WAYS  # noqa: E402
from states import rounded, table  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MECHANISMS = [
    *(f"mechanisms/{name}.toml" for name in (
        "four_bar", "six_bar", "slider_crank", "spatial_slider_crank", "bennett", "bricard", "andrews", "n_four_bar_2", "rssr_rigid",
        "rssr_flexible")),
    "benches/peers/two_flexible.toml", "tests/data/delta.toml", "tests/data/stewart.toml", "tests/data/stewart.toml:rounded",
]
# Behind a file whose numbers are to be rounded.
ROUNDED = ":rounded"


def cost(linkwear, path):
    answer = subprocess.run([linkwear, "cost", path, "--format", "json"], check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return json.loads(answer.stdout)["entry_points"]


def compare(linkwear, path, rounds, ways):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        if path.endswith(ROUNDED):
            path = rounded(path.removesuffix(ROUNDED), folder)
        rows = table(linkwear, path, folder)
        peer = Casadi(path, rows, ways)
        peer.check(linkwear, path, rows, folder)
        binaries = {name: program.compile(folder) for name, program in peer.programs.items()}
        times = {name: ([], []) for name in binaries}
        for _ in range(rounds):
            ours = cost(linkwear, path)
            for name, binary in binaries.items():
                text = peer.programs[name].text()
                theirs = float(subprocess.run([binary], input=text, capture_output=True, text=True, check=True).stdout)
                if name in ours:
                    ns = ours[name]["ns"]
                    times[name][0].append(min(ns[key] for key in ("native", "compiled") if ns.get(key)))
                    times[name][1].append(theirs)
        result = {}
        for name, program in peer.programs.items():
            if name not in ours:
                continue
            mine, theirs = times[name]
            ratios = sorted(a / b for a, b in zip(mine, theirs))
            result[name] = {
                "operations": [ours[name]["operations"]["total"], program.operations],
                "ns": [statistics.median(mine), statistics.median(theirs)],
                "ratio": [statistics.median(ratios), ratios[0], ratios[-1]],
            }
        return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", default=[str(ROOT / name) for name in MECHANISMS])
    parser.add_argument("--linkwear", default=str(ROOT / "target/release/linkwear"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--fixed-pivots", action="store_true", help="CasADi may divide by what the run, and it alone, shows to be large")
    parser.add_argument("--record", type=Path, help="folder that keeps a file of results per release")
    arguments = parser.parse_args()
    ways = WAYS + OF_A_RUN if arguments.fixed_pivots else WAYS
    results = {}
    print(f"linkwear beside CasADi {ca.__version__} (gcc -O3 -march=native), medians of {arguments.rounds} rounds\n")
    print(f"{'mechanism':22} {'entry':20} {'operations':>16} {'ns':>15}  ratio of times (least, most)")
    for path in arguments.files:
        name = Path(path).name.replace(".toml", "").replace(":", "_")
        results[name] = compare(arguments.linkwear, path, arguments.rounds, ways)
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
