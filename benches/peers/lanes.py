"""linkwear's machine code on eight lanes beside CasADi's C on eight lanes (AVX-512): nanoseconds per state, and their ratio.

    python3 benches/peers/lanes.py [FILE] [--rounds N] [--linkwear PROGRAM]

CasADi's C is compiled as C++ with a number type of eight doubles (`lanes.hpp`), sines by glibc's vector library. Both sides run in turn
on one processor, each with the least of its batches.
"""

import argparse
import statistics
import subprocess
import tempfile
from pathlib import Path

from programs import Casadi
from run import ROOT, cost
from solve import WAYS
from states import table

HERE = Path(__file__).resolve().parent


def compiled(program, folder):
    """The program on eight lanes."""
    function = program.function
    program.compile(folder)
    sizes = {"ARG": function.sz_arg(), "RES": function.sz_res(), "IW": function.sz_iw(), "W": function.sz_w()}
    flags = [f"-DSIZE_{name}={size}" for name, size in sizes.items()]
    flags += [f"-DFUNCTION={function.name()}", f"-DIN={function.nnz_in(0)}", f"-DOUT={function.nnz_out(0)}"]
    source, binary = folder / f"{function.name()}.c", folder / f"{function.name()}_lanes"
    flags += [f'-DSOURCE="{source}"', f"-I{HERE}", "-O3", "-march=native", "-ffp-contract=off", "-fpermissive", "-w"]
    subprocess.run(["g++", *flags, str(HERE / "lanes_timing.cpp"), "-lmvec", "-lm", "-o", str(binary)], check=True)
    return binary


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default=str(ROOT / "mechanisms/rssr_flexible.toml"))
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--linkwear", default=str(ROOT / "target/release/linkwear"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        rows = table(arguments.linkwear, arguments.file, folder)
        peer = Casadi(arguments.file, rows, WAYS)
        peer.check(arguments.linkwear, arguments.file, rows, folder)
        binaries = {name: compiled(program, folder) for name, program in peer.programs.items()}
        times = {name: ([], []) for name in binaries}
        for _ in range(arguments.rounds):
            ours = cost(arguments.linkwear, arguments.file)
            for name, binary in binaries.items():
                text = peer.programs[name].text()
                theirs = subprocess.run([binary], input=text, capture_output=True, text=True, check=True).stdout
                if name in ours:
                    times[name][0].append(ours[name]["ns"]["lanes8"])
                    times[name][1].append(float(theirs))
        for name, (mine, theirs) in times.items():
            if mine:
                x, y = statistics.median(mine), statistics.median(theirs)
                print(f"{name:20} {x:6.1f} {y:6.1f} ns a state  {x / y:.2f}")


if __name__ == "__main__":
    main()
