"""Values of a planar arm of three links by Pinocchio, for `tests/control.rs`.

    pip install pin mujoco
    python tests/reference/planar_arm.py > tests/reference/planar_arm.json

MuJoCo computes mass matrix and bias a second time; the program ends with an error if both differ by more than 1e-12.
"""

import json

import mujoco
import numpy as np
import pinocchio as pin

LENGTHS = [0.7, 0.55, 0.4]
CENTERS = [0.31, 0.29, 0.17]
MASSES = [2.3, 1.7, 0.6]
INERTIAS = [0.11, 0.06, 0.013]
DAMPING = [0.4, 0.25, 0.09]
GRAVITY = 9.81
STATES = [
    ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
    ([0.3, -0.7, 1.1], [1.2, -0.4, 2.1], [0.5, -1.5, 0.25], [1.0, -2.0, 0.5]),
    ([-1.9, 2.4, 0.6], [-0.8, 3.1, -1.3], [-2.0, 0.75, 4.0], [-3.0, 0.125, 2.0]),
    ([2.9, -0.05, -2.2], [4.0, 5.0, -6.0], [10.0, -20.0, 30.0], [0.0, 7.0, -0.25]),
]


def pinocchio_model():
    model = pin.Model()
    model.gravity.linear = np.array([0.0, -GRAVITY, 0.0])
    parent, offset = 0, 0.0
    for k in range(3):
        place = pin.SE3(np.eye(3), np.array([offset, 0.0, 0.0]))
        parent = model.addJoint(parent, pin.JointModelRZ(), place, f"joint{k}")
        body = pin.Inertia(MASSES[k], np.array([CENTERS[k], 0.0, 0.0]), np.diag([INERTIAS[k]] * 3))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
        offset = LENGTHS[k]
    return model


def mujoco_model():
    body = ""
    for k in reversed(range(3)):
        offset = LENGTHS[k - 1] if k else 0.0
        inertia = " ".join([str(INERTIAS[k])] * 3)
        body = f"""<body pos="{offset} 0 0"><joint type="hinge" axis="0 0 1"/>
            <inertial pos="{CENTERS[k]} 0 0" mass="{MASSES[k]}" diaginertia="{inertia}"/>{body}</body>"""
    text = f"""<mujoco><option gravity="0 {-GRAVITY} 0"/><compiler angle="radian"/>
        <worldbody>{body}</worldbody></mujoco>"""
    return mujoco.MjModel.from_xml_string(text)


def main():
    model, other = pinocchio_model(), mujoco_model()
    data, other_data = model.createData(), mujoco.MjData(other)
    cases = []
    for q, v, a, u in (tuple(map(np.array, state)) for state in STATES):
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pin.nonLinearEffects(model, data, q, v)
        other_data.qpos[:], other_data.qvel[:] = q, v
        mujoco.mj_forward(other, other_data)
        full = np.zeros((3, 3))
        mujoco.mj_fullM(other, other_data, full)
        assert np.abs(full - mass).max() < 1e-12
        assert np.abs(other_data.qfrc_bias - bias).max() < 1e-12 * max(1.0, np.abs(bias).max())
        # The force of the joints is u − d v.
        force = u - DAMPING * v
        inverse = pin.rnea(model, data, q, v, a) - force
        pin.computeABADerivatives(model, data, q, v, force)
        inverse_mass = np.triu(data.Minv) + np.triu(data.Minv, 1).T
        zero, one = np.zeros((3, 3)), np.eye(3)
        by_v = data.ddq_dv - inverse_mass @ np.diag(DAMPING)
        cases.append(
            {
                "q": q.tolist(),
                "v": v.tolist(),
                "a": a.tolist(),
                "u": u.tolist(),
                "mass": mass.tolist(),
                "bias": (bias - force).tolist(),
                "inverse": inverse.tolist(),
                "acceleration": data.ddq.tolist(),
                "A": np.block([[zero, one], [data.ddq_dq, by_v]]).tolist(),
                "B": np.vstack([zero, inverse_mass]).tolist(),
            }
        )
    parameters = {"l": LENGTHS, "c": CENTERS, "m": MASSES, "J": INERTIAS, "d": DAMPING, "g": GRAVITY}
    versions = f"Pinocchio {pin.__version__}, MuJoCo {mujoco.__version__}"
    lines = ",\n".join(json.dumps(case) for case in cases)
    print(f'{{"source": "planar_arm.py, {versions}",\n"parameters": {json.dumps(parameters)},\n"cases": [\n{lines}\n]}}')


main()
