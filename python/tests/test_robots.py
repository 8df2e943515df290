"""Robots against MuJoCo, and what their texts leave out."""

import pickle
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import variational as vi

MODELS = Path(__file__).with_name("models")

# Bounds of the difference of accelerations in five random states, relative to the largest acceleration.
ERRORS = {
    "pendulum": 1e-15,  # 3.6e-16
    "acrobot": 2e-15,  # 1.3e-15
    "cartpole": 2e-15,  # 8.1e-16
    "reacher": 2e-15,  # 1.1e-15
    "cheetah": 3e-15,  # 1.5e-15
    "hopper": 5e-15,  # 3.4e-15
    "walker": 8e-15,  # 5.7e-15
    # A single body, whose accelerations are as small as 1e-3.
    "swimmer": 1e-11,  # 6.2e-12
    "finger": 6e-15,  # 4.0e-15
    "fish": 3e-14,  # 1.6e-14
    "ball_in_cup": 1e-15,  # 4.7e-16
    "pusher": 2e-15,  # 1.0e-15
    "ant": 2e-15,  # 5.9e-16
}


def quietly(read, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read(*arguments, **options)


def model(inner, rest=""):
    return f"<mujoco>{rest}<worldbody>{inner}</worldbody></mujoco>"


def product(a, b):
    """The product of quaternions."""
    vector = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *vector])


class Reference:
    """A model in MuJoCo, without what the text leaves out."""

    def __init__(self, source):
        self.mujoco = pytest.importorskip("mujoco")
        load = self.mujoco.MjModel
        is_text = isinstance(source, str) and source.lstrip().startswith("<")
        self.model = load.from_xml_string(source) if is_text else load.from_xml_path(str(source))
        flags = ("CONTACT", "LIMIT", "FRICTIONLOSS", "CLAMPCTRL", "EQUALITY")
        for flag in flags:
            self.model.opt.disableflags |= int(getattr(self.mujoco.mjtDisableBit, f"mjDSBL_{flag}"))
        self.model.opt.density = self.model.opt.viscosity = 0.0
        self.model.tendon_stiffness[:] = self.model.tendon_damping[:] = 0.0
        self.is_of_joint = self.model.actuator_trntype == int(self.mujoco.mjtTrn.mjTRN_JOINT)
        self.model.actuator_gainprm[~self.is_of_joint] = self.model.actuator_biasprm[~self.is_of_joint] = 0.0
        self.data = self.mujoco.MjData(self.model)

    def joints(self):
        """Type and first places in qpos and qvel of each joint."""
        return zip(self.model.jnt_type, self.model.jnt_qposadr, self.model.jnt_dofadr, strict=True)

    def draw(self, random):
        """A random state and random controls."""
        data, model = self.data, self.model
        data.qpos[:] = random.normal(size=model.nq)
        data.qvel[:] = random.normal(size=model.nv)
        data.ctrl[:] = random.normal(size=model.nu)
        for kind, q, _ in self.joints():
            if kind < 2:
                turn = data.qpos[q + 3 - 3 * kind :][:4]
                turn /= np.linalg.norm(turn)
        self.mujoco.mj_forward(model, data)

    def coordinates(self, acceleration):
        """q, its velocity, and its acceleration: of an orientation those of its quaternion."""
        rows = []
        for kind, q, v in self.joints():
            at, rate, change = self.data.qpos[q:], self.data.qvel[v:], acceleration[v:]
            if kind > 1:
                rows.append(([at[0]], [rate[0]], [change[0]]))
                continue
            if kind == 0:
                rows.append((at[:3], rate[:3], change[:3]))
                at, rate, change = at[3:], rate[3:], change[3:]
            turn = at[:4]
            first = product(turn, np.array([0.0, *rate[:3]])) / 2.0
            second = product(turn, np.array([0.0, *change[:3]])) + product(first, np.array([0.0, *rate[:3]]))
            rows.append((turn, first, second / 2.0))
        return [np.concatenate(column) for column in zip(*rows, strict=True)]

    def error(self, robot, states=5):
        """The largest difference of accelerations in random states, relative to the largest acceleration."""
        system = vi.System(robot)()
        random = np.random.default_rng(0)
        errors = []
        for _ in range(states):
            self.draw(random)
            system.set(**self.inputs(system))
            q, v, expected = self.coordinates(self.data.qacc_smooth)
            found = system.acceleration(0.0, q, v)
            errors.append(np.abs(found - expected).max() / np.abs(expected).max())
        return max(errors)

    def inputs(self, system):
        """The controls of the motors of joints, in their order."""
        return dict(zip(system.inputs, self.data.ctrl[self.is_of_joint], strict=True))

    def set(self, q, v):
        """The state of these coordinates and their velocities."""
        place = 0
        for kind, at, rate in self.joints():
            count = (3, 0, 1, 1)[kind]
            self.data.qpos[at : at + count], self.data.qvel[rate : rate + count] = (
                part[place : place + count] for part in (q, v)
            )
            place += count
            if kind < 2:
                turn, change = (part[place : place + 4] for part in (q, v))
                self.data.qpos[at + count : at + count + 4] = turn
                inverse = turn * [1.0, -1.0, -1.0, -1.0]
                self.data.qvel[rate + count : rate + count + 3] = 2.0 * product(inverse, change)[1:]
                place += 4
        self.mujoco.mj_forward(self.model, self.data)

    def held(self, rows):
        """The accelerations with hard constraints: J a + J' v = 0, from the equations of motion with multipliers."""
        mujoco, model, data = self.mujoco, self.model, self.data
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        applied = data.qfrc_passive + data.qfrc_actuator - data.qfrc_bias
        J, rest = rows(self)
        matrix = np.block([[mass, J.T], [J, np.zeros((len(J), len(J)))]])
        # A planar loop has rows of zeros.
        return np.linalg.lstsq(matrix, np.concatenate([applied, -rest]), rcond=1e-12)[0][: model.nv]

    def relative(self, first, second, point, with_axes=False):
        """Rows of the velocity of one body in another one at a point of space, and J' v."""
        mujoco, model, data = self.mujoco, self.model, self.data
        found = []
        for of in (mujoco.mj_jac, mujoco.mj_jacDot):
            sides = []
            for name in (first, second):
                linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))
                of(model, data, linear, angular, point, model.body(name).id)
                sides.append(np.vstack([linear, angular] if with_axes else [linear]))
            found.append(sides[0] - sides[1])
        return found[0], found[1] @ data.qvel

    def coupled(self, polynomial, first, second):
        """Rows of joint first - polynomial(joint second) = 0, and J' v."""
        of = np.polynomial.Polynomial(polynomial)
        one, two = (self.model.joint(name) for name in (first, second))
        x = self.data.qpos[two.qposadr[0]] - self.model.qpos0[two.qposadr[0]]
        row = np.zeros((1, self.model.nv))
        row[0, one.dofadr[0]], row[0, two.dofadr[0]] = 1.0, -of.deriv()(x)
        return row, np.array([-of.deriv(2)(x) * self.data.qvel[two.dofadr[0]] ** 2])

    def at(self, name, point):
        """A point of a body in space."""
        return self.data.body(name).xpos + self.data.body(name).xmat.reshape(3, 3) @ point


@pytest.mark.parametrize("name", ERRORS)
def test_accelerations_of_public_models(name):
    path = MODELS / f"{name}.xml"
    reference = Reference(path)
    robot = quietly(vi.from_mjcf, path)
    assert np.array_equal(robot.start, reference.model.qpos0)
    assert reference.error(robot) < ERRORS[name]


SINGLE = {
    # Orientations in every notation, one inside the other.
    "orientations": model(
        """<body pos="0.1 0.2 0.3" quat="1 2 3 4"><joint axis="1 2 3" pos="0.1 -0.2 0.3"/>
        <geom type="box" size=".1 .2 .3"/>
        <body pos="0.3 0.1 0" axisangle="1 1 0 40"><joint type="slide" axis="1 0 1" ref="0.2"/><joint ref="30"/>
        <geom type="capsule" size=".05" fromto="0 0 0 .3 .1 .2"/>
        <body pos="0 0.4 0" xyaxes="1 1 0 0 1 1"><joint axis="0 1 0"/>
        <geom type="ellipsoid" size=".1 .2 .3" zaxis="1 2 3"/>
        <body pos="0 0 .2" euler="20 30 40"><joint/><geom type="cylinder" size=".1 .2" euler="10 20 30"/></body>
        </body></body></body>"""
    ),
    "eulerseq": model(
        """<body euler="0.1 0.2 0.3"><joint axis="1 1 0"/><geom type="box" size=".1 .2 .3" pos=".1 .2 0" euler="1 2 3"/>
        </body>""",
        "<compiler angle='radian' eulerseq='XZy'/>",
    ),
    "springs": model(
        """<body><joint name="a" stiffness="3" springref="20" damping="0.5" armature="0.1" ref="10" axis="0 1 0"/>
        <geom type="sphere" size="0.1" pos="0.3 0 0" mass="2"/>
        <body pos="0.6 0 0"><joint name="b" type="slide" stiffness="7" springref="0.1" damping="0.2" axis="1 0 0"/>
        <geom size="0.1" density="500"/></body></body>"""
    ),
    "inertias": model(
        """<body><joint axis="1 0 0"/><inertial pos=".1 0 .2" mass="2" fullinertia="2 3 4 .1 .2 .3"/><geom size="1"/>
        <body gravcomp="0.25" pos="0 1 0"><joint type="ball" damping="0.3" armature="0.2" pos="0 .1 0"/>
        <inertial pos="0 .2 0" quat="1 2 3 4" mass="1" diaginertia="1 2 2.5"/>
        <body pos="0 0 1" euler="10 20 30"><inertial pos="1 0 0" mass="0.5" diaginertia=".1 .2 .25"/>
        <body euler="0 50 0"><joint type="ball"/><geom type="box" size=".1 .2 .3" pos=".3 0 0"/></body></body></body>
        </body>"""
    ),
    "free": model(
        """<body pos="1 2 3" euler="10 20 30"><freejoint name="base"/><geom type="box" size=".1 .2 .3" pos=".1 0 0"/>
        <body pos="0 .3 0"><joint axis="0 0 1"/><geom type="sphere" size=".1" pos=".3 0 0"/></body></body>"""
    ),
    "gravity": model(
        """<body><joint axis="0 1 0"/><geom size="0.1" pos=".3 .1 0"/></body>""",
        "<option gravity='1 2 -3'/>",
    ),
    "motors": model(
        """<body><joint name="a" axis="0 1 0" ref="30"/><geom size="0.1" pos=".3 0 0"/>
        <body pos=".6 0 0"><joint name="b" axis="0 1 0"/><geom size="0.1" pos=".3 0 0"/>
        <body pos=".6 0 0"><joint name="c" type="ball"/><geom size="0.1" pos=".3 0 0"/></body></body></body>""",
        """<actuator><motor joint="a" gear="3"/><position name="p" joint="a" kp="5" kv="0.3" gear="2"/>
        <velocity name="v" joint="b" kv="0.7" gear="2"/><motor name="m" joint="c" gear="1 2 3"/>
        <general name="g" joint="b" gainprm="2 3 4" gaintype="affine" biastype="affine" biasprm="0.1 -2 -3"
        gear="-1.5"/>
        </actuator>""",
    ),
    "classes": model(
        """<frame pos="0 .1 0" euler="0 0 30"><body childclass="arm"><joint name="a"/><geom/>
        <body pos=".3 0 0"><joint name="b" class="stiff"/><geom class="main" size=".1"/></body></body></frame>""",
        """<default><geom density="300"/><default class="arm"><joint axis="0 1 0" damping="0.1"/>
        <geom type="capsule" fromto="0 0 0 .3 0 0" size=".03"/><default class="stiff"><joint stiffness="2"/></default>
        </default></default>""",
    ),
    # Shorter lists keep the last numbers of their default; an orientation replaces the one of its default.
    "overlays": model(
        """<body><joint axis="0 1 0"/><geom size=".1" pos=".3 0 0" quat="1 0 0.3 0"/><body><joint axis="1 0 0"/>
        <geom class="a" zaxis="1 2 3" pos="0 .2 0"/></body></body>""",
        """<default><geom type="capsule" size=".3 .4" euler="0 20 0"/><default class="a">
        <geom type="box" size=".1 .2 .3"/></default></default>""",
    ),
    # A servo inherits from its own kind or from general, also of an outer class; general from the last one.
    "servos": model(
        """<body><joint name="a" axis="0 1 0"/><geom size="0.1" pos=".3 0 0"/></body>""",
        """<default><position kp="5" kv=".2"/><default class="b"><velocity kv="3"/></default><default class="c">
        <general gaintype="affine" gainprm="5 6 7" biastype="affine" biasprm="3 4 6"/></default></default>
        <actuator><general name="1" joint="a"/><position name="2" joint="a"/><velocity name="3" joint="a"/>
        <motor name="4" joint="a"/><general name="5" joint="a" class="b" gainprm="2"/><position name="6" joint="a"
        class="b"/><position name="7" joint="a" kp="2"/><general name="8" joint="a" class="c" gainprm="1 2"/>
        <position name="9" joint="a" class="c"/></actuator>""",
    ),
    "a name that is taken": model(
        """<body name="body2"><joint axis="0 1 0"/><geom size="1" pos="1 0 0"/><body pos="1 0 0"><joint axis="0 1 0"/>
        <geom size="1" pos="1 0 0"/><body pos="1 0 0"><joint name="body2_joint" axis="1 0 0"/>
        <geom size="1" pos="0 1 0"/></body></body></body>"""
    ),
}


@pytest.mark.parametrize("name", SINGLE)
def test_accelerations_of_each_feature(name):
    robot = quietly(vi.from_mjcf, SINGLE[name])
    reference = Reference(SINGLE[name])
    assert np.allclose(robot.start, reference.model.qpos0, rtol=0.0, atol=1e-15)
    assert reference.error(robot) < 2e-14, robot  # 1.2e-14


ARM = """<body name="one"><joint name="a" axis="0 1 0" damping="0.1"/>
<geom type="capsule" size=".03" fromto="0 0 0 0 0 1"/>
    <body name="two" pos="0 0 1"><joint name="b" axis="{}" stiffness="2"/>
    <geom type="capsule" size=".03" fromto="0 0 0 1.5 0 .5"/></body></body>
    <body name="three" pos="1.2 0 0">{}<geom type="capsule" size=".03" fromto="0 0 0 .3 0 1.5"/></body>"""

LOOPS = {
    # A planar loop: two of three entries.
    "connect": (
        model(
            ARM.format("0 1 0", '<joint name="c" axis="0 1 0"/>'),
            '<equality><connect body1="two" body2="three" anchor="1.5 0 .5"/></equality>',
        ),
        lambda on: on.relative("two", "three", on.at("two", [1.5, 0.0, 0.5])),
    ),
    "sites": (
        model(
            ARM.format("0 1 0", '<joint name="c" type="ball"/><site name="t" pos=".3 0 1.5"/>').replace(
                "</body></body>", '<site name="s" pos="1.5 0 .5"/></body></body>'
            ),
            '<equality><connect site1="s" site2="t"/></equality>',
        ),
        lambda on: on.relative("two", "three", on.at("two", [1.5, 0.0, 0.5])),
    ),
    "weld": (
        model(
            ARM.format("1 0 1", "<freejoint/>"),
            '<equality><weld body1="two" body2="three" anchor=".1 .2 .3"/></equality>',
        ),
        lambda on: on.relative("two", "three", on.at("three", [0.1, 0.2, 0.3]), True),
    ),
    "joint": (
        model(
            ARM.format("0 1 0", '<joint name="c" axis="0 1 0" ref="10"/>'),
            '<equality><joint joint1="b" joint2="c" polycoef="0.1 0.5 0.3 0 0.2"/></equality>',
        ),
        lambda on: on.coupled([0.1, 0.5, 0.3, 0.0, 0.2], "b", "c"),
    ),
    # The other coefficients keep their default: 1 for the linear one.
    "offset": (
        model(
            ARM.format("0 1 0", '<joint name="c" axis="0 1 0"/>'),
            '<equality><joint joint1="b" joint2="c" polycoef="0.1"/></equality>',
        ),
        lambda on: on.coupled([0.1, 1.0], "b", "c"),
    ),
}


@pytest.mark.parametrize("name", LOOPS)
def test_constraints_are_hard(name):
    text, rows = LOOPS[name]
    robot = quietly(vi.from_mjcf, text)
    system, reference = vi.System(robot)(), Reference(text)
    random = np.random.default_rng(3)
    n = len(robot.coordinates)
    for _ in range(4):
        start = system.project(robot.start + 0.1 * random.normal(size=n), random.normal(size=n))
        assert np.abs(start.v).max() > 0.1
        reference.set(start.q, start.v)
        _, _, expected = reference.coordinates(reference.held(rows))
        found = system.acceleration(0.0, start.q, start.v)
        assert np.abs(found - expected).max() < 1e-11 * np.abs(expected).max(), robot


URDF = """<robot name="six">
<link name="base"><inertial><mass value="4"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>
{links}{joints}
<joint name="flange" type="fixed"><parent link="l6"/><child link="tool"/><origin xyz="0 0 .1" rpy="0.1 0.2 0.3"/>
</joint>
<link name="tool"><inertial><origin xyz=".01 0 .05" rpy="1 0 0"/><mass value="0.4"/>
<inertia ixx=".001" iyy=".002" izz=".0015" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius=".1"/></geometry></collision></link></robot>"""
LINK = """<link name="l{0}"><inertial><origin xyz="0 .02 .1" rpy=".1 0 .2"/><mass value="{0}"/>
<inertia ixx=".02" iyy=".03" izz=".025" ixy=".001" ixz=".002" iyz="-.001"/></inertial></link>"""
JOINT = """<joint name="j{0}" type="{3}"><parent link="{1}"/><child link="l{0}"/><origin xyz="{2} .05 .3" rpy="{4}"/>
<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="3"/><dynamics damping="0.{0}" friction="{5}"/>
</joint>"""
KINDS = ("continuous", "revolute", "prismatic", "revolute", "continuous", "revolute")
TURNS = ("0 0 0", "1.5707963267948966 0 0", "0 0 0.4", "0 0 0", "-1.5707963267948966 0 0", "1.5707963267948966 0.3 0")
SIX = URDF.format(
    links="".join(LINK.format(k) for k in range(1, 7)),
    joints="".join(
        JOINT.format(k + 1, f"l{k}" if k else "base", k / 50, KINDS[k], TURNS[k], int(k == 2)) for k in range(6)
    ),
)


def test_an_arm_of_six_joints_from_urdf():
    with pytest.warns(UserWarning, match="limits of j2, j3, j4, j6; friction of j3; contact"):
        robot = vi.from_urdf(SIX)
    assert robot.coordinates == ("j1", "j2", "j3", "j4", "j5", "j6")
    assert robot.left_out == ("limits of j2, j3, j4, j6", "friction of j3", "contact")
    assert Reference(SIX).error(robot) < 1e-13, robot
    # A run keeps the energy without dampers.
    system = vi.System(robot)(**{f"c_j{k}": 0.0 for k in range(1, 7)})
    sol = system.integrate(np.linspace(0.1, 0.6, 6), h=0.01).until(1.0)
    assert np.abs(sol.energy - sol.energy[0]).max() < 5e-8  # 3.0e-8, of 172


def test_a_floating_root_and_its_joints():
    text = """<robot name="r"><link name="trunk"><inertial><origin xyz=".1 0 0"/><mass value="2"/>
    <inertia ixx=".1" iyy=".2" izz=".25"/></inertial></link>
    <link name="leg"><inertial><origin xyz="0 0 -.3"/><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".02"/>
    </inertial></link>
    <link name="foot"><inertial><origin xyz="0 0 -.1"/><mass value=".5"/><inertia ixx=".1" iyy=".1" izz=".02"/>
    </inertial></link>
    <joint name="hip" type="continuous"><parent link="trunk"/><child link="leg"/><origin xyz="0 .2 0"/>
    <axis xyz="0 1 0"/></joint>
    <joint name="ankle" type="revolute"><parent link="leg"/><child link="foot"/><origin xyz="0 0 -.6"/>
    <axis xyz="0 1 0"/>
    {}</joint></robot>"""
    same = model(
        """<body name="trunk"><freejoint name="trunk_pose"/><inertial pos=".1 0 0" mass="2" diaginertia=".1 .2 .25"/>
        <body pos="0 .2 0"><joint name="hip" axis="0 1 0"/><inertial pos="0 0 -.3" mass="1" diaginertia=".1 .1 .02"/>
        <body pos="0 0 -.6"><joint name="ankle" axis="0 1 0"/>
        <inertial pos="0 0 -.1" mass=".5" diaginertia=".1 .1 .02"/>
        </body></body></body>"""
    )
    robot = quietly(vi.from_urdf, text.format(""), floating=True)
    assert robot.coordinates[:3] == ("trunk_pose[0]", "trunk_pose[1]", "trunk_pose[2]")
    assert Reference(same).error(robot) < 1e-13
    mimicking = vi.System(quietly(vi.from_urdf, text.format('<mimic joint="hip" multiplier="-2" offset=".1"/>')))
    assert mimicking.constraints == ("ankle_mimic",)
    state = mimicking().project([0.3, 0.0])
    assert state.q[1] == pytest.approx(0.1 - 2.0 * state.q[0], abs=1e-14)


def test_a_floating_joint_of_a_urdf_with_damping():
    text = """<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz=".1 .2 0"/><mass value="2"/>
    <inertia ixx=".1" iyy=".2" izz=".25" ixy=".01" ixz="0" iyz="0"/></inertial></link>
    <joint name="j" type="floating"><parent link="a"/><child link="b"/><dynamics damping=".3"/></joint></robot>"""
    assert Reference(text).error(quietly(vi.from_urdf, text)) < 1e-14  # 4.5e-16


def test_the_text_is_read_by_people():
    robot = quietly(vi.from_mjcf, MODELS / "acrobot.xml")
    for line in (
        "struct Acrobot {",
        "    param g = 9.81;",
        "    angle shoulder;",
        "    angle elbow;",
        "    let a_lower_arm = shoulder + elbow;",
        "        - m_lower_arm * g * x_lower_arm[2];",
        "    force elbow = 2 * u_elbow;",
    ):
        assert line in robot.splitlines(), robot
    again = pickle.loads(pickle.dumps(robot))
    assert again == robot and again.coordinates == robot.coordinates and again.left_out == robot.left_out
    assert np.array_equal(again.start, robot.start) and type(robot.text) is str
    assert vi.System(robot) is vi.System(robot.text)


def test_names_become_names_of_the_language():
    robot = quietly(
        vi.from_mjcf,
        model(
            """<body name="1 arm"><joint name="L"/><geom size="1" pos="1 0 0"/><body name="match"><joint name="a-b"/>
            <geom size="1" pos="1 0 0"/><body><joint name="a b"/><joint axis="0 1 0" name="g"/>
            <geom size="1" pos="1 0 0"/>
            </body></body></body>"""
        ),
    )
    assert robot.coordinates == ("L_2", "a_b", "a_b_2", "g_2")
    assert vi.System(robot).coordinates == robot.coordinates


@pytest.mark.parametrize(
    ("name", "coordinate"),
    [("_", "q__"), ("a\u00b2", "a2"), ("e\u0301", "\u00e9"), ("\ufb01", "fi"), ("i", "i_2"), ("\u03c9", "\u03c9"),
     ("x&#10;param z = 1;", "x_param_z___1_"), ("a" * 300, "a" * 100)],
)  # fmt: skip
def test_any_name_is_written(name, coordinate):
    inner = f'<body name="{name}"><joint name="{name}"/><geom size="1" pos="1 0 0"/></body>'
    robot = quietly(vi.from_mjcf, f'<mujoco model="{name}"><worldbody>{inner}</worldbody></mujoco>')
    assert robot.coordinates == vi.System(robot).coordinates == (coordinate,)


def test_parameters_beyond_the_limit_are_constants():
    inner = ""
    for k in range(14):
        joint = f'<joint name="s{k}" type="slide" stiffness="{k + 1}" damping="1"/>'
        inner = f'<body name="b{k}">{joint}<geom size="1"/>{inner}</body>'
    robot = quietly(vi.from_mjcf, model(inner))
    system = vi.System(robot)
    assert len(system.parameters) == 32 and "m_b13" in system.parameters and "    const k_s0 = 1;" in robot.splitlines()
    assert Reference(model(inner)).error(robot) < 1e-13


def test_includes_are_relative(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "main.xml").write_text('<mujoco><include file="parts/all.xml"/></mujoco>')
    (tmp_path / "parts/all.xml").write_text('<mujoco><worldbody><include file="arm.xml"/></worldbody></mujoco>')
    (tmp_path / "parts/arm.xml").write_text('<mujoco><body><joint name="q"/><geom size="1"/></body></mujoco>')
    assert quietly(vi.from_mjcf, tmp_path / "main.xml").coordinates == ("q",)
    (tmp_path / "parts/arm.xml").write_text('<mujoco><include file="all.xml"/></mujoco>')
    with pytest.raises(ValueError, match="is included twice: remove one"):
        vi.from_mjcf(tmp_path / "main.xml")
    (tmp_path / "twice.xml").write_text('<mujoco><include file="parts/no.xml"/><include file="parts/no.xml"/></mujoco>')
    (tmp_path / "parts/no.xml").write_text("<mujoco/>")
    with pytest.raises(ValueError, match=r"the file parts/no\.xml is included twice"):
        vi.from_mjcf(tmp_path / "twice.xml")
    (tmp_path / "parts/arm.xml").unlink()
    with pytest.raises(FileNotFoundError, match=r"included file arm\.xml is not in"):
        vi.from_mjcf(tmp_path / "main.xml")


def test_what_is_left_out_is_listed():
    text = model(
        """<body name="b"><joint name="q" range="0 9" frictionloss="1"/><geom name="hull" type="mesh" mesh="m"/>
        <geom size="1"/><site name="s"/><body name="c"><joint name="r" type="ball" stiffness="2"/><geom size="1"/>
        </body></body>""",
        """<actuator><muscle name="m" joint="q"/><motor name="n" site="s"/>
        <position name="p" joint="q" timeconst="1"/></actuator>
        <tendon><fixed name="t"><joint joint="q" coef="1"/></fixed></tendon>
        <equality><tendon name="e" tendon1="t"/><connect name="f" body1="b" anchor="0 0 0" active="false"/>
        </equality>""",
    )
    expected = (
        "the stiffness of the joint 'r', which is of the type ball",
        "the actuator 'm' (muscle)",
        "the actuator 'n' (it moves a site)",
        "the actuator 'p' (timeconst)",
        "the equality 'e' (tendon)",
        "the connect 'f', which is not active",
        "the tendon 't'",
        "the inertia of the geom 'hull' of the body 'b'",
        "limits of q",
        "friction of q",
        "contact",
    )
    with pytest.warns(UserWarning, match=re.escape("; ".join(expected))):
        robot = vi.from_mjcf(text)
    assert robot.left_out == expected


def test_what_is_unknown_or_off_is_listed():
    robot = quietly(
        vi.from_mjcf,
        model(
            """<body><joint name="q" axis="0 1 0" dampng="1" actuatorfrcrange="-1 1"/><gemo/>
            <geom size="1" pos="1 0 0" contype="0" conaffinity="0"/></body>""",
            """<option actuatorgroupdisable="1 2"/><actuators/><default><equality active="false"/></default>
            <actuator><motor name="m" joint="q" group="2"/><motor name="n" joint="q" gear="0"/>
            <position name="p" joint="q" dampratio="1"/></actuator>
            <equality><joint name="e" joint1="q"/></equality>""",
        ),
    )
    assert robot.left_out == (
        "the element <gemo>, which is unknown",
        "dampng of the joint 'q', which is unknown",
        "the limits of the forces of motors on the joint 'q'",
        "the actuator 'm' (disabled)",
        "the actuator 'n' (its force is zero)",
        "the actuator 'p' (dampratio)",
        "the joint 'e', which is not active",
        "the element <actuators>, which is unknown",
    )


def test_a_gap_that_no_joint_closes_is_listed():
    text = model(
        ARM.format("0 1 0", '<joint name="c" axis="0 1 0"/><site name="t" pos=".3 .2 1.5"/>').replace(
            "</body></body>", '<site name="s" pos="1.5 0 .5"/></body></body>'
        ),
        '<equality><connect name="k" site1="s" site2="t"/></equality>',
    )
    robot = quietly(vi.from_mjcf, text)
    assert "a part of the constraint 'k', a gap of 0.2 that no joint closes" in robot.left_out
    assert "a part of the constraint 'k'" not in " ".join(quietly(vi.from_mjcf, LOOPS["connect"][0]).left_out)
    # A hinge about y cannot turn a body about x and z.
    turned = model(
        '<body name="b"><joint axis="0 1 0"/><geom size=".1" pos=".3 0 0"/><body><joint axis="0 1 0"/><geom size=".1" '
        'pos=".3 0 .1"/></body></body>',
        '<equality><weld name="w" body1="b" relpose="0 0 0 1 .2 .3 .4"/></equality>',
    )
    notes = [note for note in quietly(vi.from_mjcf, turned).left_out if "constraint 'w'" in note]
    assert len(notes) == 2, notes


def test_a_robot_with_many_joints_is_announced():
    inner = '<body><joint type="slide"/><geom size="1"/></body>' * 33
    with pytest.warns(UserWarning, match="33 coordinates, and vi.System takes at most 32: use vi.compile"):
        robot = vi.from_mjcf(model(inner))
    with pytest.raises(vi.CompileError, match="33 coordinates; a text has 32 at most"):
        vi.System(robot)


MISTAKES = [
    ("none.xml", FileNotFoundError, r"there is no file none\.xml in"),
    ("<robot/>", ValueError, "root element <robot>, not <mujoco>: from_urdf reads"),
    ("<mujoco>", ValueError, "is not XML"),
    ("<mujoco/>", ValueError, "no body moves"),
    (
        model('<body><joint name="q" type="screw"/><geom size="1"/></body>'),
        ValueError,
        'type "screw": write hinge',
    ),
    (
        model('<body name="b"><joint name="q"/></body>'),
        ValueError,
        r"'q' moves the body 'b', which has no mass\. Write",
    ),
    (
        model('<body name="b"><joint name="q"/><geom name="g" type="mesh" mesh="m"/></body>'),
        ValueError,
        r"the inertia of the geom 'g' is not in the file\. Write an inertial .* saveinertial",
    ),
    (model('<body><joint class="k"/><geom size="1"/></body>'), ValueError, "class 'k', which no default declares"),
    (model('<body pos="0 1"><joint/><geom size="1"/></body>'), ValueError, 'pos="0 1": write 3 finite numbers'),
    (model('<body pos="0 1 x"><joint/><geom size="1"/></body>'), ValueError, "which are not numbers"),
    (model('<body quat="0 0 0 0"><joint/><geom size="1"/></body>'), ValueError, "quaternion of .* has the length 0"),
    (
        model('<body quat="1 0 0 0" euler="0 0 1"><joint/><geom size="1"/></body>'),
        ValueError,
        "quat and euler: write one",
    ),
    (model('<body><joint/><geom type="cone" size="1"/></body>'), ValueError, 'type "cone": known are sphere, capsule'),
    (model('<body><joint/><geom type="box" size="1"/></body>'), ValueError, "has no volume: write its size"),
    (model('<body><joint/><freejoint/><geom size="1"/></body>'), ValueError, "a free joint, which must be alone"),
    (model("<replicate/>"), ValueError, "has to be written out"),
    (
        model('<body><joint/><geom size="1"/></body>', '<compiler coordinate="global"/>'),
        ValueError,
        "local coordinates",
    ),
    (
        model('<body><joint/><geom size="1"/></body>', '<actuator><motor name="m" joint="z"/></actuator>'),
        ValueError,
        "'m' moves the joint 'z', which is not there",
    ),
    (
        model('<body><joint/><geom size="1"/></body>', '<equality><weld name="w" body1="z"/></equality>'),
        ValueError,
        "the weld 'w' names the body 'z', which is not there",
    ),
    (
        model('<body><joint name="q"/><joint name="q"/><geom size="1"/></body>'),
        ValueError,
        "two joints have the name 'q'",
    ),
    (model('<joint name="q"/>'), ValueError, "the world has the joint 'q'"),
    (
        model("", '<default><default class="a"/><default class="a"/></default>'),
        ValueError,
        "two defaults have the class",
    ),
    (model("", '<compiler eulerseq="xy"/>'), ValueError, 'eulerseq="xy": write three of the letters'),
    (model("", '<compiler angle="deg"/>'), ValueError, 'the angle "deg": write degree or radian'),
    (model('<body><joint/><geom size="1" contype="x"/></body>'), ValueError, 'contype="x", which are not numbers'),
    (model('<body><joint/><geom size="1" group="1.5"/></body>'), ValueError, 'group="1.5": write a whole number'),
    (model('<body><joint/><geom size="1" density="-1"/></body>'), ValueError, "has a negative mass"),
    (model('<body><joint/><geom type="box" size="-1 -1 1"/></body>'), ValueError, "has no volume"),
    (model('<body><joint/><geom size="1" fromto="0 0 0 1 0 0"/></body>'), ValueError, "fromto, and is a sphere"),
    (model('<body><joint/><geom size="1e200"/></body>'), ValueError, "too large: write"),
    (model('<body><joint/><geom size="1" mass="1e308" pos="1e200 0 0"/></body>'), ValueError, "too large: write"),
    (model('<body><joint armature="-1"/><geom size="1"/></body>'), ValueError, "a negative armature"),
    (
        model('<body name="b"><joint/><inertial pos="0 0 0" mass="-1"/></body>'),
        ValueError,
        "'b' has a negative mass",
    ),
    (
        model('<body name="b"><joint/><inertial pos="0 0 0" mass="1" fullinertia="1 1 1 2 0 0"/></body>'),
        ValueError,
        "'b' has the mass 1 and the principal moments of inertia -1, 1, 3: they must not be negative",
    ),
    (
        model('<body><joint/><inertial pos="0 0 0" mass="1" euler="1 2 3" fullinertia="1 1 1 0 0 0"/></body>'),
        ValueError,
        "write no other inertia or axes",
    ),
    (
        model('<body><joint axis="1 0 0"/><inertial pos="1 0 0" mass="1"/></body>'),
        ValueError,
        "turn masses on their axes: write moments of inertia",
    ),
    (
        model("", '<compiler settotalmass="3"/>').replace("<worldbody>", "<worldbody><body><joint/></body>"),
        ValueError,
        "which has no mass",
    ),
    (model("<body>" * 3000 + "</body>" * 3000), ValueError, "inside each other too often"),
    ('<?xml version="1.0"?><robot/>', ValueError, "root element <robot>"),
    ("\ufeff<mujoco/>", ValueError, "no body moves"),
]


@pytest.mark.parametrize("index", range(len(MISTAKES)))
def test_mistakes_in_mjcf(index, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text, error, message = MISTAKES[index]
    with pytest.raises(error, match=message):
        quietly(vi.from_mjcf, text)


LINKS = '<link name="a"/><link name="b"/>'
ENDS = '<parent link="a"/><child link="b"/>'

URDF_MISTAKES = [
    ("<mujoco/>", "root element <mujoco>, not <robot>: from_mjcf reads"),
    ("<robot/>", "the robot has no link"),
    (f'<robot>{LINKS}<joint name="j" type="screw">{ENDS}</joint></robot>', 'type "screw": the types are revolute'),
    (
        f'<robot>{LINKS}<joint name="j" type="revolute">{ENDS}</joint></robot>',
        "'j' moves the body 'b', which has no mass",
    ),
    (
        f'<robot>{LINKS}<joint name="j" type="fixed"><parent link="z"/></joint></robot>',
        "the link 'z', which is not there",
    ),
    ('<robot><link name="a"/><link name="a"/></robot>', "two links have the name 'a'"),
    (
        f"""<robot>{LINKS}<link name="c"/><joint name="j" type="continuous">{ENDS}</joint>
        <joint name="j" type="continuous"><parent link="b"/><child link="c"/></joint></robot>""",
        "two joints have the name 'j'",
    ),
    ('<robot xmlns:xacro="http://x/xacro"><xacro:macro/></robot>', "has macros: write it out by `xacro FILE"),
    (f"<robot>{LINKS}</robot>", "one link without a parent, not a, b"),
    (f'<robot>{LINKS}<joint name="j" type="fixed">{ENDS}</joint></robot>', "no body moves"),
]


@pytest.mark.parametrize("index", range(len(URDF_MISTAKES)))
def test_mistakes_in_urdf(index):
    text, message = URDF_MISTAKES[index]
    with pytest.raises(ValueError, match=message):
        quietly(vi.from_urdf, text)
