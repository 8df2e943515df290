"""A chain of N rods in MuJoCo and in Pinocchio: the time of a step, and its error.

In: numbers of rods. Out: a table, one line for each method and step. The chain is that of `links/src/main.rs`: rods of length 1
without mass, a mass of 1 at each end, gravity 9.81, released at rest with every rod 0.5 rad from the vertical. Errors are those of the
last mass at t = 1, against the accelerations of Pinocchio integrated by scipy's DOP853 with a tolerance of 1e-13.
The times of MuJoCo are of C code, `mj_step` with all steps in one call. Those of Pinocchio are of one call of `aba`, which
gives the accelerations once; a step of RK4 needs four of them.
"""

import sys
import time

import mujoco
import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

GRAVITY, ANGLE, END = 9.81, 0.5, 1.0
REPETITIONS = 7


def mujoco_model(n, h, integrator):
    """Joints about y, links along −z. MuJoCo wants an inertia: 1e-9 of a mass at a distance of 1."""
    body = ""
    for index in range(n):
        place = "0 0 0" if index == 0 else "0 0 -1"
        body += f'<body pos="{place}"><joint type="hinge" axis="0 1 0"/><inertial pos="0 0 -1" mass="1" diaginertia="1e-9 1e-9 1e-9"/>'
    text = f"""<mujoco><option timestep="{h!r}" gravity="0 0 -{GRAVITY}" integrator="{integrator}">
        <flag contact="disable" constraint="disable"/></option>
        <compiler boundinertia="0"/><worldbody>{body}{"</body>" * n}</worldbody></mujoco>"""
    return mujoco.MjModel.from_xml_string(text)


def pinocchio_model(n):
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    parent = 0
    for index in range(n):
        place = pin.SE3(np.eye(3), np.array([0.0, 0.0, 0.0 if index == 0 else -1.0]))
        parent = model.addJoint(parent, pin.JointModelRY(), place, f"joint{index}")
        inertia = pin.Inertia(1.0, np.array([0.0, 0.0, -1.0]), np.zeros((3, 3)))
        model.appendBodyToJoint(parent, inertia, pin.SE3.Identity())
    return model


def last_mass(angles):
    """Place of the last mass from relative angles."""
    absolute = np.cumsum(angles)
    return np.array([-np.sin(absolute).sum(), -np.cos(absolute).sum()])


def start(n):
    angles = np.zeros(n)
    angles[0] = ANGLE
    return angles


def reference(n):
    model = pinocchio_model(n)
    data = model.createData()
    zero = np.zeros(n)

    def rates(_, y):
        return np.concatenate([y[n:], pin.aba(model, data, y[:n], y[n:], zero)])

    found = solve_ivp(rates, (0.0, END), np.concatenate([start(n), zero]), method="DOP853", rtol=1e-13, atol=1e-13)
    return last_mass(found.y[:n, -1])


def of_mujoco(n, h, integrator, exact):
    model = mujoco_model(n, h, integrator)
    data = mujoco.MjData(model)
    steps = round(END / h)
    best = np.inf
    for _ in range(REPETITIONS):
        mujoco.mj_resetData(model, data)
        data.qpos[:] = start(n)
        begin = time.perf_counter()
        mujoco.mj_step(model, data, nstep=steps)
        best = min(best, (time.perf_counter() - begin) / steps)
    return best, np.abs(last_mass(data.qpos) - exact).max()


def of_pinocchio(n):
    model = pinocchio_model(n)
    data = model.createData()
    q, zero = start(n), np.zeros(n)
    best = np.inf
    for _ in range(REPETITIONS):
        begin = time.perf_counter()
        for _ in range(1000):
            pin.aba(model, data, q, zero, zero)
        best = min(best, (time.perf_counter() - begin) / 1000)
    return best


def main():
    print("rods,method,h,microseconds,error")
    for n in [int(word) for word in sys.argv[1:]] or [7, 30, 100]:
        exact = reference(n)
        print(f"# {n} rods: the last mass is at {exact[0]:.16g}, {exact[1]:.16g} at t = {END}")
        for integrator in ["Euler", "implicitfast", "RK4"]:
            for h in [5e-2, 2e-2, 1e-2, 1e-3]:
                seconds, error = of_mujoco(n, h, integrator, exact)
                print(f"{n},MuJoCo {integrator},{h:g},{1e6 * seconds:.3g},{error:.2e}", flush=True)
        print(f"{n},Pinocchio aba,,{1e6 * of_pinocchio(n):.3g},", flush=True)


if __name__ == "__main__":
    main()
