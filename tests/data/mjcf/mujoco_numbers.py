"""What MuJoCo says of arm.xml, of the press of examples/data and of the humanoid: writes mujoco.csv beside it.

    pip install mujoco==4.0.0 && python tests/data/mjcf/mujoco_numbers.py

Rows are `what, name, numbers`. States are drawn from a fixed seed and written too, with all digits.
- `arm inverse i, joint, q, v, a, force`: `mj_inverse` at state i of 5, less what the actuators do without a signal; q counts from the drawing.
- `humanoid forward i, joint, q, v, a`: `mj_forward` at state i of 3 without contacts, limits and signals; `root` has the rotation vector,
  the displacement, the angular velocity and the velocity, all in the axes of the world, and no accelerations.
- `press rest, joint, a`: accelerations at rest as drawn, from MuJoCo's mass matrix, bias, passive forces and constraint Jacobian with
  rigid constraints (its own are soft), by least squares: `mj_forward` gives the parts.
- `mass of body, m, centre, xx, yy, zz, xy, xz, yz` in the world as drawn, of arm and press.
"""

import pathlib

import mujoco
import numpy as np

here = pathlib.Path(__file__).parent
root = here.parents[2]
rng = np.random.default_rng(19)
lines = []
FLAGS = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT


def write(what, name, *numbers):
    lines.append(",".join([what, name, *(repr(float(x)) for x in numbers)]))


def load(path):
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.disableflags |= FLAGS
    return model, mujoco.MjData(model)


def masses(what, model, data):
    data.qpos[:] = model.qpos0
    mujoco.mj_forward(model, data)
    for body in range(1, model.nbody):
        turn = data.ximat[body].reshape(3, 3)
        i = turn @ np.diag(model.body_inertia[body]) @ turn.T
        entries = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
        write(f"{what} mass", model.body(body).name, model.body_mass[body], *data.xipos[body], *entries)


arm, data = load(here / "arm.xml")
masses("arm", arm, data)
for state in range(5):
    data.qpos[:] = arm.qpos0 + rng.uniform(-0.6, 0.6, arm.nq) * np.where(arm.jnt_type == 2, 0.1, 1.0)
    data.qvel[:] = rng.uniform(-3, 3, arm.nv) * np.where(arm.jnt_type == 2, 0.2, 1.0)
    data.qacc[:] = rng.uniform(-8, 8, arm.nv)
    data.ctrl[:] = 0
    wanted = data.qacc.copy()
    mujoco.mj_inverse(arm, data)
    inverse = data.qfrc_inverse.copy()
    mujoco.mj_forward(arm, data)
    for joint in range(arm.njnt):
        write(
            f"arm inverse {state}",
            arm.joint(joint).name,
            data.qpos[joint] - arm.qpos0[joint],
            data.qvel[joint],
            wanted[joint],
            inverse[joint] - data.qfrc_actuator[joint],
        )

human, data = load(root / "tests/data/humanoid/humanoid.xml")
for state in range(3):
    turn = rng.uniform(-0.8, 0.8, 3)
    way = rng.uniform(-0.5, 0.5, 3)
    omega, speed = rng.uniform(-2, 2, 3), rng.uniform(-2, 2, 3)
    angle = np.linalg.norm(turn)
    quaternion = np.zeros(4)
    mujoco.mju_axisAngle2Quat(quaternion, turn / angle, angle)
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, quaternion)
    data.qpos[:] = human.qpos0
    data.qpos[:3] += way
    data.qpos[3:7] = quaternion
    data.qpos[7:] += rng.uniform(-0.7, 0.7, human.nq - 7)
    data.qvel[:3] = speed
    data.qvel[3:6] = matrix.reshape(3, 3).T @ omega
    data.qvel[6:] = rng.uniform(-3, 3, human.nv - 6)
    data.ctrl[:] = 0
    mujoco.mj_forward(human, data)
    write(f"humanoid forward {state}", "root", *turn, *way, *omega, *speed)
    for joint in range(1, human.njnt):
        at, dof = human.jnt_qposadr[joint], human.jnt_dofadr[joint]
        q = data.qpos[at] - human.qpos0[at]
        write(f"humanoid forward {state}", human.joint(joint).name, q, data.qvel[dof], data.qacc[dof])

press, data = load(root / "examples/data/press/press.xml")
press.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
masses("press", press, data)
mass = np.zeros((press.nv, press.nv))
mujoco.mj_fullM(press, data, mass)
rows = data.efc_J.reshape(data.nefc, press.nv)
force = data.qfrc_passive - data.qfrc_bias
n, m = press.nv, data.nefc
system = np.block([[mass, rows.T], [rows, np.zeros((m, m))]])
found = np.linalg.lstsq(system, np.concatenate([force, np.zeros(m)]), rcond=1e-12)[0]
for joint in range(press.njnt):
    if press.jnt_type[joint] != mujoco.mjtJoint.mjJNT_BALL:
        write("press rest", press.joint(joint).name, found[press.jnt_dofadr[joint]])

(here / "mujoco.csv").write_text("\n".join(lines) + "\n")
