"""One turn of the flexible RSSR linkage: linkwear beside Exudyn, milliseconds, ratio with its spread.

    python3 -m pip install -r benches/peers/requirements.txt
    python3 benches/peers/exudyn_turn.py

Exudyn: crank and rocker as rotors, the coupler as 8 cable elements of absolute nodal coordinates, generalised-alpha with steps of
1 ms, its compiled core alone timed. linkwear: six modes, no option but `--tol 5e-5`, the accuracy of the forces; of a hundred turns after
the first ten, in which the modes ring, as printed by itself. The rocker's angle and the force in the ball S2 have to agree before anything
is timed: in the first turn, of which linkwear damps the ringing by the same method with steps of 5 ms.
"""

import argparse
import csv
import json
import math
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    Cable, CoordinateConstraint, CoordinateSpringDamper, Force, Gravity, MarkerBodyMass, MarkerBodyRigid, MarkerNodeCoordinate, MarkerNodePosition, Node1D,
    NodePointGround, NodePointSlope1, Rotor1D, SensorObject, SphericalJoint,
)

# Old names of settings serve all versions from 1.9 on.
warnings.filterwarnings("ignore", category=DeprecationWarning)
sys.path.insert(0, str(Path(__file__).parent))
from linkage import Linkage  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent.parent
ELEMENTS = 8
STEP, STEPS = 1e-3, 500


def turn_about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    if axis == "z":
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


# Carries z to y, x to x: the rocker turns about y.
ABOUT_Y = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def model(linkage, start, step, steps, sensed):
    names = linkage.names
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    speed = 2 * math.pi * names["speed"]
    ground = mbs.AddNode(NodePointGround())
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    crank, rocker, rod = (linkage.bodies[name] for name in ("crank", "rocker", "coupler"))

    def rotor(body, pivot, rotation, angle, rate):
        off = body.centre - pivot
        axis = rotation[:, 2]
        inertia = axis @ (body.inertia + body.mass * (off @ off * np.eye(3) - np.outer(off, off))) @ axis
        node = mbs.AddNode(Node1D(referenceCoordinates=[0], initialCoordinates=[angle], initialVelocities=[rate]))
        made = mbs.AddObject(Rotor1D(
            inertia=inertia, nodeNumber=node, referencePosition=list(pivot), referenceRotation=rotation.tolist()))
        weight = mbs.AddMarker(MarkerBodyRigid(bodyNumber=made, localPosition=list(rotation.T @ off)))
        mbs.AddLoad(Force(markerNumber=weight, loadVector=list(body.mass * linkage.gravity)))
        return node, made

    joints = linkage.joints
    o, p4 = joints["R1"]["at"]["crank"], joints["R4"]["at"]["rocker"]
    crank_node, crank_body = rotor(crank, o, np.eye(3), 0.0, speed)
    mbs.AddObject(CoordinateConstraint(
        markerNumbers=[fixed, mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=crank_node, coordinate=0))], offset=speed, velocityLevel=True))
    rocker_node, rocker_body = rotor(rocker, p4, ABOUT_Y, start["R4.q"], start["R4.v"])
    mbs.AddObject(CoordinateSpringDamper(
        markerNumbers=[fixed, mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=rocker_node, coordinate=0))], damping=joints["R4"]["damping"]))
    a = joints["S2"]["at"]["crank"]
    b_arm = joints["S3"]["at"]["rocker"] - p4
    b = p4 + turn_about("y", start["R4.q"]) @ b_arm
    va = np.cross([0, 0, speed], a - o)
    vb = np.cross([0, start["R4.v"], 0], b - p4)
    length = rod.flexible["length"]
    along, drift = (b - a) / length, (vb - va) / length
    nodes = []
    for k in range(ELEMENTS + 1):
        part = k / ELEMENTS
        nodes.append(mbs.AddNode(NodePointSlope1(
            referenceCoordinates=list(a + part * (b - a)) + list(along), initialVelocities=list(va + part * (vb - va)) + list(drift))))
    second = math.pi * rod.flexible["radius"] ** 4 / 4
    young = rod.flexible["young"]
    wave = math.pi / length
    lowest = wave**2 * math.sqrt(young * second / (rod.mass / length))
    for k in range(ELEMENTS):
        cable = mbs.AddObject(Cable(
            length=length / ELEMENTS, massPerLength=rod.mass / length, bendingStiffness=young * second,
            axialStiffness=young * rod.flexible["area"],
            # The damping ratio of the first mode.
            bendingDamping=2 * rod.flexible["damping"] / lowest * young * second, nodeNumbers=nodes[k:k + 2]))
        mbs.AddLoad(Gravity(markerNumber=mbs.AddMarker(MarkerBodyMass(bodyNumber=cable)), loadVector=list(linkage.gravity)))

    def ball(body, arm, node):
        markers = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=list(arm))), mbs.AddMarker(MarkerNodePosition(nodeNumber=node))]
        return mbs.AddObject(SphericalJoint(markerNumbers=markers))

    first = ball(crank_body, a - o, nodes[0])
    ball(rocker_body, ABOUT_Y.T @ b_arm, nodes[-1])
    force = mbs.AddSensor(SensorObject(objectNumber=first, outputVariableType=exu.OutputVariableType.Force, storeInternal=True, writeToFile=False))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = step * steps
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = step if sensed else step * steps
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    return mbs, settings, rocker_node, force


def ours(linkwear, *options):
    """A run of linkwear: its JSON."""
    command = [linkwear, "simulate", ROOT / "mechanisms/rssr_flexible.toml", "--format", "json", *options]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def turn(linkwear):
    """Milliseconds of a turn after the first ten."""
    seconds = [ours(linkwear, "--tol", "5e-5", "--samples", "2", "--turns", turns)["wall_seconds"] for turns in ("10", "110")]
    return 1e3 * (seconds[1] - seconds[0]) / 100


def compare(linkwear, linkage, folder):
    """Ends where the models differ; the first row of linkwear's table."""
    out = Path(folder) / "turn.csv"
    ours(linkwear, "--integrator", "generalized-alpha", "--step", "5e-3", "--samples", "101", "--out", out)
    with open(out) as file:
        rows = [{key.split(" ")[0]: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    mbs, settings, rocker, force = model(linkage, rows[0], STEP, STEPS, True)
    mbs.SolveDynamic(settings)
    angle = float(np.ravel(mbs.GetNodeOutput(rocker, exu.OutputVariableType.Coordinates))[0])
    theirs = np.array(mbs.GetSensorStoredData(force))
    norms = np.interp([row["t"] for row in rows], theirs[:, 0], np.linalg.norm(theirs[:, 1:4], axis=1))
    mine = np.array([math.sqrt(sum(row[f"S2.F{axis}"] ** 2 for axis in "xyz")) for row in rows])
    # The start differs: modes at rest here, a straight cable there.
    late = len(rows) // 4
    off = np.sqrt(np.mean((norms - mine)[late:] ** 2)) / mine.max()
    print(f"rocker after a turn: {rows[-1]['R4.q']:.6f} and {angle:.6f} rad")
    print(f"force in S2: {100 * off:.2f} % of its peak apart (root mean square)")
    # A micrometre at the rocker's end; six modes against eight elements, steps of 1 and 5 ms.
    if abs(angle - rows[-1]["R4.q"]) > 1e-5 or off > 0.005:
        sys.exit("the models differ")
    return rows[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--linkwear", default=str(ROOT / "target/release/linkwear"))
    parser.add_argument("--rounds", type=int, default=7)
    arguments = parser.parse_args()
    linkage = Linkage(ROOT / "mechanisms/rssr_flexible.toml")
    with tempfile.TemporaryDirectory() as folder:
        start = compare(arguments.linkwear, linkage, folder)
    mine, theirs = [], []
    for _ in range(arguments.rounds):
        mine.append(turn(arguments.linkwear))
        mbs, settings, _, _ = model(linkage, start, STEP, STEPS, False)
        begin = time.perf_counter()
        mbs.SolveDynamic(settings)
        theirs.append(1e3 * (time.perf_counter() - begin))
    ratios = sorted(b / a for a, b in zip(mine, theirs))
    print(f"\na turn: linkwear {statistics.median(mine):.2f} ms, Exudyn {exu.__version__} {statistics.median(theirs):.1f} ms,")
    print(f"Exudyn takes {statistics.median(ratios):.0f} times as long ({ratios[0]:.0f} to {ratios[-1]:.0f} in {arguments.rounds} rounds)")


if __name__ == "__main__":
    main()
