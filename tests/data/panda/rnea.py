"""Inverse dynamics of the Panda robot by Pinocchio, for `tests/cli_import.rs`.

    pip install pin==4.1.0
    python rnea.py > rnea.csv
"""
import os
import numpy as np
import pinocchio as pin

here = os.path.dirname(os.path.abspath(__file__))
model = pin.buildModelFromUrdf(os.path.join(here, "panda.urdf"))
data = model.createData()
# Joint i at mean[i] + swing[i] * sin(rate[i] * t), within its limits; the second finger is as the first (the file's mimic).
mean = [0.3, -0.4, 0.2, -1.5, 0.6, 1.8, -0.5, 0.02]
swing = [0.9, 0.7, -0.8, 0.9, 1.1, -1.2, 1.3, 0.015]
rate = [2.1, 1.7, 2.9, 2.3, 3.7, 3.1, 4.3, 5.0]
mean, swing, rate = map(np.array, (mean, swing, rate))
every = np.vstack([np.eye(8), np.eye(8)[7]])  # 9 coordinates of 8


def torques(q, v, a):
    q, v, a = every @ q, every @ v, every @ a
    return every.T @ (pin.rnea(model, data, q, v, a) + model.damping * v)


names = list(model.names)[1:9]
print(f"# By Pinocchio {pin.__version__} (PyPI `pin`), rnea.py in this folder.")
print("what,t [s]," + ",".join(names))
for k in range(11):
    t = k / 10
    phase = rate * t
    q, v, a = mean + swing * np.sin(phase), swing * rate * np.cos(phase), -swing * rate**2 * np.sin(phase)
    for what, tau in (("moving", torques(q, v, a)), ("gravity", torques(q, 0 * q, 0 * q))):
        print(f"{what},{t!r}," + ",".join(repr(float(x)) for x in tau))
