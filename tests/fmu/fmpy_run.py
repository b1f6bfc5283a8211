"""fmpy_run.py UNIT STOP: validates a unit and prints rows of time and all outputs, a millisecond apart."""
import sys

from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

unit, stop = sys.argv[1], float(sys.argv[2])
problems = validate_fmu(unit)
if problems:
    sys.exit("\n".join(problems))
description = read_model_description(unit)
outputs = [variable.name for variable in description.modelVariables if variable.causality == "output"]
result = simulate_fmu(
    unit, fmi_type="CoSimulation", start_time=0.0, stop_time=stop, output_interval=1e-3, step_size=1e-3,
    relative_tolerance=float(description.defaultExperiment.tolerance), output=outputs,
)
for row in result:
    print(" ".join(repr(float(row[name])) for name in ["time", *outputs]))
