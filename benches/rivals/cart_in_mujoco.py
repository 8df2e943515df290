"""The end of `cart-double-pole` by MuJoCo: the model of the installed package `gymnasium`, RK4 with 64 000 steps to t = 4.

Out: coordinates and velocities.
"""

from importlib.util import find_spec
from pathlib import Path

import mujoco

END, STEPS = 4.0, 64_000

assets = Path(find_spec("gymnasium").origin).parent / "envs/mujoco/assets"
model = mujoco.MjModel.from_xml_path(str(assets / "inverted_double_pendulum.xml"))
model.opt.timestep = END / STEPS
data = mujoco.MjData(model)
data.qpos[:] = [0.0, 0.1, 0.1]
for _ in range(STEPS):
    mujoco.mj_step(model, data)
print(*(f"{x:.15g}" for x in [*data.qpos, *data.qvel]))
