"""linkwear's C99 beside CasADi's C of the same equations: nanoseconds of a call, compiled by the same command, in turn.

    python3 benches/peers/c99.py                        # accelerations of the flexible RSSR
    python3 benches/peers/c99.py mechanisms/rssr_rigid.toml --rounds 15
"""

import argparse
import statistics
import subprocess
import tempfile
from pathlib import Path

from run import HERE, ROOT, Casadi, table

ENTRIES = ["accelerations", "forward_dynamics"]


def compiled(linkwear, path, entry, folder):
    """The program that times an entry point of linkwear's C99."""
    name = Path(path).stem
    subprocess.run([linkwear, "generate", path, "--target", "c", "-o", folder / "mechanism"], check=True, stdout=subprocess.DEVNULL)
    own, upper, places = name, name.upper(), entry.upper()
    defines = {
        "FUNCTION": f"{own}_{entry}", "IN": f"{upper}_{places}_IN", "OUT": f"{upper}_{places}_OUT", "WORKSPACE": f"{upper}_WORKSPACE",
        "PARAMETERS": f"{upper}_PARAMETERS", "STATES": f"({upper}_COORDINATES + {upper}_SPEEDS)", "START": f"{own}_start_state",
        "TABLE": f"{own}_parameter_table",
    }
    binary = folder / f"linkwear_{entry}"
    flags = [f"-D{key}={value}" for key, value in defines.items()]
    command = ["gcc", "-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-I", folder, *flags, HERE / "c99_timing.c",
               folder / "mechanism.c", "-lm", "-o", binary]
    subprocess.run(command, check=True)
    return binary


def nanoseconds(program, text=""):
    return float(subprocess.run([program], input=text, capture_output=True, text=True, check=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default=str(ROOT / "mechanisms" / "rssr_flexible.toml"))
    parser.add_argument("--linkwear", default=str(ROOT / "target/release/linkwear"))
    parser.add_argument("--rounds", type=int, default=15)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        rows = table(arguments.linkwear, arguments.file, folder)
        peer = Casadi(arguments.file, rows)
        peer.check(arguments.linkwear, arguments.file, rows, folder)
        for entry in ENTRIES:
            program = peer.programs[entry]
            binaries = compiled(arguments.linkwear, arguments.file, entry, folder), program.compile(folder)
            pairs = [(nanoseconds(binaries[0]), nanoseconds(binaries[1], program.text())) for _ in range(arguments.rounds)]
            ratios = sorted(mine / theirs for mine, theirs in pairs)
            mine, theirs = (statistics.median(side) for side in zip(*pairs))
            print(f"{Path(arguments.file).stem} {entry}: {mine:.1f} ns, CasADi {theirs:.1f} ns ({program.operations} operations), "
                  f"ratio {statistics.median(ratios):.3f} ({ratios[0]:.3f}, {ratios[-1]:.3f})")


if __name__ == "__main__":
    main()
