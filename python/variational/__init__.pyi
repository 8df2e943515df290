"""Variational integrators of mechanical systems, generated from a Lagrangian."""

from typing import Any

from numpy.typing import ArrayLike, NDArray
from numpy import float64

from ._cell import load_ipython_extension as load_ipython_extension
from ._compare import Comparison as Comparison, compare as compare
from ._compile import CompileError as CompileError, compile as compile, warm as warm
from ._constraints import Projected as Projected
from ._control import Equilibrium as Equilibrium, Linearization as Linearization
from ._ensemble import Ensemble as Ensemble
from ._events import Event as Event, Period as Period
from ._explanation import Explanation as Explanation
from ._fit import Fit as Fit, Unidentifiable as Unidentifiable, fit as fit
from ._optimise import EnergyBalance as EnergyBalance, Optimum as Optimum, optimise as optimise
from ._robots import Robot as Robot, from_mjcf as from_mjcf, from_urdf as from_urdf
from ._rotations import quaternion_rate as quaternion_rate, rotation_matrix as rotation_matrix
from ._run import LocalError as LocalError, Run as Run
from ._solution import Events as Events, Solution as Solution
from ._stubs import stubs as stubs
from ._system import System as System

__version__: str
systems: list[str]

class StepError(ArithmeticError):
    """A step failed. The numbers of the failure are attributes."""

    reason: str
    fields: dict[str, Any]
    solution: Solution | None

class NoForwardStep(StepError):
    """No energy-preserving step exists past this point."""

    t: float
    h: float
    excess: float
    density: float

class NoForwardGaussStep(StepError):
    """No energy-preserving step with stages exists past this point."""

    t: float
    h: float
    stages: int
    excess: float
    density: float
    shift: float
    largest: float

class ShiftTooLarge(StepError):
    """The shift of the step density outweighs the energy."""

    t: float
    h: float
    shift: float
    part: float
    size: float
    shorter: float

class DegenerateStep(StepError):
    """The step density vanishes, so that the step length is not determined."""

    t: float
    h: float
    density: float

class StepRatio(StepError):
    """The length of the only forward step differs too much from that of the last step."""

    t: float
    previous: float
    found: float

class LengthsLost(StepError):
    """No length of an adaptive step fits the forces: they change too fast."""

    t: float
    h: float

class StepBounds(StepError):
    """The step that solves the equations is shorter or longer than allowed."""

    t: float
    found: float
    h_min: float
    h_max: float

class NotConverged(StepError):
    """The Newton iteration ended above the rounding floor."""

    t: float
    h: float
    iterations: int
    residual: float
    residuals: list[float]
    turn: float

class TooLong(StepError):
    """The step has no solution that continues those of short steps."""

    t: float
    h: float
    longest: float

class StagesNotConverged(StepError):
    """The stages of a Gauss step did not converge."""

    t: float
    h: float
    iterations: int
    change: float
    contraction: float
    stiffness: float

class TimeScale(StepError):
    """The time scale g of dt = g dτ is not positive, not finite, or too small."""

    t: float
    g: float

class NoTimeScale(StepError):
    """The method steps in transformed time, but the system has no time scale."""

    system: str

class NotSeparable(StepError):
    """The motion of the system does not split into kicks and drifts."""

    system: str

class NoStepDensity(StepError):
    """The method preserves the energy, but L contains a monotone table."""

    table: str

class NoRule(StepError):
    """The method needs a quadrature rule, but the system declares none."""

    system: str

class RuleTooLarge(StepError):
    """The equations of a step by the rule have too many terms, in a system of a text."""

    system: str

class HasConstraints(StepError):
    """The system has constraints, which the method does not keep."""

    system: str

class FirstOrder(StepError):
    """L is linear in the velocities: the system has no mass matrix, which the method needs."""

    system: str

class Ambiguous(StepError):
    """Two velocities have the same momenta."""

    t: float

class Singular(StepError):
    """A matrix to invert is singular."""

    t: float
    matrix: str

class NonFinite(StepError):
    """A quantity is infinite or not a number."""

    t: float
    quantity: str
    expression: str | None

class Undefined(StepError):
    """A table or a Rust function has no value at an argument."""

    t: float
    function: str
    argument: float
    range: list[float] | None

class InconsistentStart(StepError):
    """A state does not satisfy a constraint."""

    constraint: str
    residual: float
    rate: float

class DroppedConstraint(StepError):
    """A dropped constraint does not hold at the end of a step."""

    t: float
    constraint: str
    residual: float

class NotAssembled(StepError):
    """No state on the constraints was found from a guess."""

    t: float
    constraint: str
    residual: float
    gap: float
    passed: float

class InconsistentTangent(StepError):
    """A tangent vector does not satisfy the derivatives of a constraint and of its rate."""

    t: float
    constraint: str
    residual: float
    impulse: float

class Redundant(StepError):
    """The constraints depend on each other at the start."""

    constraint: str
    of: int
    rank: int

class NoEquilibrium(StepError):
    """No equilibrium was found near the guess."""

    t: float
    coordinate: str
    force: float

class FreeMotion(StepError):
    """The stiffness is singular: a motion has no restoring force."""

    t: float
    coordinate: str

class CannotLeave(StepError):
    """The trajectory cannot leave the zero of an event."""

    t: float
    event: int
    value: float
    within: float

class NoDerivative(StepError):
    """The step has no derivative."""

    t: float
    because: str

class UnknownParameter(StepError):
    """The system has no parameter of the given name."""

    system: str
    parameters: list[str]

class OtherSystem(StepError):
    """The checkpoint belongs to another system, or to other parameters."""

    system: str
    parameter: str | None
    stored: float
    given: float

class Tolerance(StepError):
    """The error of a step exceeds the tolerance."""

    t: float
    estimate: float
    tolerance: float

class InvalidInput(StepError, ValueError):
    """An input is outside of its allowed range."""

    input: str
    allowed: str
    value: float

class AndrewsSqueezer(System):
    """Andrews' squeezer: seven plane bodies in three closed loops, driven by a constant torque against a spring.

    The angles and the parameters are those of the benchmark, in SI units: lengths d, e, f, r, s, t, u, z, masses m,
    moments of inertia I about the centres of mass, the fixed points A, B, and C of the spring. The motor turns the
    crank of 7 mm by `beta`. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, section VII.7; IVP test
    set, problem `andrews`.
    """

    @property
    def m1(self) -> float: ...
    @m1.setter
    def m1(self, value: float) -> None: ...
    @property
    def m2(self) -> float: ...
    @m2.setter
    def m2(self, value: float) -> None: ...
    @property
    def m3(self) -> float: ...
    @m3.setter
    def m3(self, value: float) -> None: ...
    @property
    def m4(self) -> float: ...
    @m4.setter
    def m4(self, value: float) -> None: ...
    @property
    def m5(self) -> float: ...
    @m5.setter
    def m5(self, value: float) -> None: ...
    @property
    def m6(self) -> float: ...
    @m6.setter
    def m6(self, value: float) -> None: ...
    @property
    def m7(self) -> float: ...
    @m7.setter
    def m7(self, value: float) -> None: ...
    @property
    def I1(self) -> float: ...
    @I1.setter
    def I1(self, value: float) -> None: ...
    @property
    def I2(self) -> float: ...
    @I2.setter
    def I2(self, value: float) -> None: ...
    @property
    def I3(self) -> float: ...
    @I3.setter
    def I3(self, value: float) -> None: ...
    @property
    def I4(self) -> float: ...
    @I4.setter
    def I4(self, value: float) -> None: ...
    @property
    def I5(self) -> float: ...
    @I5.setter
    def I5(self, value: float) -> None: ...
    @property
    def I6(self) -> float: ...
    @I6.setter
    def I6(self, value: float) -> None: ...
    @property
    def I7(self) -> float: ...
    @I7.setter
    def I7(self, value: float) -> None: ...
    @property
    def xa(self) -> float: ...
    @xa.setter
    def xa(self, value: float) -> None: ...
    @property
    def ya(self) -> float: ...
    @ya.setter
    def ya(self, value: float) -> None: ...
    @property
    def xb(self) -> float: ...
    @xb.setter
    def xb(self, value: float) -> None: ...
    @property
    def yb(self) -> float: ...
    @yb.setter
    def yb(self, value: float) -> None: ...
    @property
    def xc(self) -> float: ...
    @xc.setter
    def xc(self, value: float) -> None: ...
    @property
    def yc(self) -> float: ...
    @yc.setter
    def yc(self, value: float) -> None: ...
    @property
    def rr(self) -> float: ...
    @rr.setter
    def rr(self, value: float) -> None: ...
    @property
    def ra(self) -> float: ...
    @ra.setter
    def ra(self, value: float) -> None: ...
    @property
    def d(self) -> float: ...
    @d.setter
    def d(self, value: float) -> None: ...
    @property
    def da(self) -> float: ...
    @da.setter
    def da(self, value: float) -> None: ...
    @property
    def ss(self) -> float: ...
    @ss.setter
    def ss(self, value: float) -> None: ...
    @property
    def sa(self) -> float: ...
    @sa.setter
    def sa(self, value: float) -> None: ...
    @property
    def sb(self) -> float: ...
    @sb.setter
    def sb(self, value: float) -> None: ...
    @property
    def sc(self) -> float: ...
    @sc.setter
    def sc(self, value: float) -> None: ...
    @property
    def sd(self) -> float: ...
    @sd.setter
    def sd(self, value: float) -> None: ...
    @property
    def e(self) -> float: ...
    @e.setter
    def e(self, value: float) -> None: ...
    @property
    def ea(self) -> float: ...
    @ea.setter
    def ea(self, value: float) -> None: ...
    @property
    def zt(self) -> float: ...
    @zt.setter
    def zt(self, value: float) -> None: ...
    @property
    def ta(self) -> float: ...
    @ta.setter
    def ta(self, value: float) -> None: ...
    @property
    def tb(self) -> float: ...
    @tb.setter
    def tb(self, value: float) -> None: ...
    @property
    def zf(self) -> float: ...
    @zf.setter
    def zf(self, value: float) -> None: ...
    @property
    def fa(self) -> float: ...
    @fa.setter
    def fa(self, value: float) -> None: ...
    @property
    def u(self) -> float: ...
    @u.setter
    def u(self, value: float) -> None: ...
    @property
    def ua(self) -> float: ...
    @ua.setter
    def ua(self, value: float) -> None: ...
    @property
    def ub(self) -> float: ...
    @ub.setter
    def ub(self, value: float) -> None: ...
    @property
    def torque(self) -> float: ...
    @torque.setter
    def torque(self, value: float) -> None: ...
    @property
    def c0(self) -> float: ...
    @c0.setter
    def c0(self, value: float) -> None: ...
    @property
    def l0(self) -> float: ...
    @l0.setter
    def l0(self, value: float) -> None: ...
    def __init__(self, *, m1: float = ..., m2: float = ..., m3: float = ..., m4: float = ..., m5: float = ..., m6: float = ..., m7: float = ..., I1: float = ..., I2: float = ..., I3: float = ..., I4: float = ..., I5: float = ..., I6: float = ..., I7: float = ..., xa: float = ..., ya: float = ..., xb: float = ..., yb: float = ..., xc: float = ..., yc: float = ..., rr: float = ..., ra: float = ..., d: float = ..., da: float = ..., ss: float = ..., sa: float = ..., sb: float = ..., sc: float = ..., sd: float = ..., e: float = ..., ea: float = ..., zt: float = ..., ta: float = ..., tb: float = ..., zf: float = ..., fa: float = ..., u: float = ..., ua: float = ..., ub: float = ..., torque: float = ..., c0: float = ..., l0: float = ...) -> None: ...

class ChaplyginSleigh(System):
    """Chaplygin sleigh on a horizontal plane: a blade at (x, y) in the direction θ does not move sideways.

    The centre of mass is at the distance a in front of the blade. Turning drives the sleigh forwards, u' = a ω² with the
    speed u and the rate ω = θ', and dies out. The energy is constant. Source: Neimark and Fufaev, Dynamics of
    Nonholonomic Systems, chapter II, section 6.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def a(self) -> float: ...
    @a.setter
    def a(self, value: float) -> None: ...
    @property
    def J(self) -> float: ...
    @J.setter
    def J(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., a: float = ..., J: float = ...) -> None: ...

class ChargedParticle(System):
    """Charged particle in the field B = (0, 0, b + s x), with the vector potential A = (0, b x + s x²/2, 0) and an
    electric potential κ z²/2 that confines it to the plane.

    L depends on the velocity beyond the kinetic energy: `L_qv` is not zero. y is cyclic: p_y = m ẏ + e A_y is
    conserved bit for bit. For s = 0 the projection is a circle of radius m v/(e b) with angular velocity e b/m.
    Source: Jackson, Classical Electrodynamics, section 12.1.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def e(self) -> float: ...
    @e.setter
    def e(self, value: float) -> None: ...
    @property
    def b(self) -> float: ...
    @b.setter
    def b(self, value: float) -> None: ...
    @property
    def s(self) -> float: ...
    @s.setter
    def s(self, value: float) -> None: ...
    @property
    def kappa(self) -> float: ...
    @kappa.setter
    def kappa(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., e: float = ..., b: float = ..., s: float = ..., kappa: float = ...) -> None: ...

class DampedOscillator(System):
    """Damped harmonic oscillator, m a + c v + k x = 0.

    With ω = √(k/m) and ζ = c/(2 √(k m)), the energy-preserving step grows as h ≈ h0 e^{ζ ω t} and ends after about
    1/(ζ ω h0) steps. Source: Sharma, Patil, Woolsey, section 5.2.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def k(self) -> float: ...
    @k.setter
    def k(self, value: float) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., k: float = ..., c: float = ...) -> None: ...

class DoublePendulum(System):
    """Double pendulum in absolute angles; θ1 = θ2 = 0 hangs down.

    The mass matrix depends on the configuration. Released from (2, 2) rad, the energy-preserving step ends at
    t = 4.025. Source: Landau and Lifshitz, Mechanics, section 5.
    """

    @property
    def m1(self) -> float: ...
    @m1.setter
    def m1(self, value: float) -> None: ...
    @property
    def m2(self) -> float: ...
    @m2.setter
    def m2(self, value: float) -> None: ...
    @property
    def l1(self) -> float: ...
    @l1.setter
    def l1(self, value: float) -> None: ...
    @property
    def l2(self) -> float: ...
    @l2.setter
    def l2(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m1: float = ..., m2: float = ..., l1: float = ..., l2: float = ..., g: float = ...) -> None: ...

class DoubleRodPendulum(System):
    """Double pendulum in Cartesian coordinates, y upwards; each rod is a constraint.

    The same motion in angles is `DoublePendulum`. Here the mass matrix is constant. Source: Landau and Lifshitz,
    Mechanics, section 5.
    """

    @property
    def m1(self) -> float: ...
    @m1.setter
    def m1(self, value: float) -> None: ...
    @property
    def m2(self) -> float: ...
    @m2.setter
    def m2(self, value: float) -> None: ...
    @property
    def l1(self) -> float: ...
    @l1.setter
    def l1(self, value: float) -> None: ...
    @property
    def l2(self) -> float: ...
    @l2.setter
    def l2(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m1: float = ..., m2: float = ..., l1: float = ..., l2: float = ..., g: float = ...) -> None: ...

class DoubleWell(System):
    """Particle in the double well V = (q⁴ − q²)/2.

    Minima at q = ±1/√2 with V = −1/8, a barrier of height 0 at q = 0. Librations about one minimum have E < 0.
    Above the barrier the step density vanishes along the motion, and the energy-preserving step ends there. Source:
    Sharma, Patil, Woolsey, section 5.1.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    def __init__(self, *, m: float = ...) -> None: ...

class DoubleWellDuffing(System):
    """Double-well Duffing oscillator, a + c v − x + x³ = A cos ω t.

    With these parameters the motion is chaotic, and the energy-preserving step ends at t ≈ 7.98 for every h0.
    Source: Guckenheimer and Holmes, Nonlinear Oscillations, section 2.2.
    """

    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, value: float) -> None: ...
    @property
    def amplitude(self) -> float: ...
    @amplitude.setter
    def amplitude(self, value: float) -> None: ...
    @property
    def omega(self) -> float: ...
    @omega.setter
    def omega(self, value: float) -> None: ...
    def __init__(self, *, c: float = ..., amplitude: float = ..., omega: float = ...) -> None: ...

class FourBar(System):
    """Four-bar linkage: crank, coupler and rocker between two pivots at the distance d; y upwards.

    The coordinates are those of the joints: (x1, y1) between crank and coupler, (x2, y2) between coupler and
    rocker. The pivots are (0, 0) and (d, 0). A uniform bar of mass m between points with velocities u and w has the
    kinetic energy m (u·u + u·w + w·w)/6. The crank turns fully if the shortest and the longest bar, d included, are
    together no longer than the other two (Grashof). Source: García de Jalón and Bayo, Kinematic and Dynamic
    Simulation of Multibody Systems, section 2.
    """

    @property
    def a(self) -> float: ...
    @a.setter
    def a(self, value: float) -> None: ...
    @property
    def b(self) -> float: ...
    @b.setter
    def b(self, value: float) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, value: float) -> None: ...
    @property
    def d(self) -> float: ...
    @d.setter
    def d(self, value: float) -> None: ...
    @property
    def density(self) -> float: ...
    @density.setter
    def density(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, a: float = ..., b: float = ..., c: float = ..., d: float = ..., density: float = ..., g: float = ...) -> None: ...

class FpuChain(System):
    """Chain of Fermi, Pasta, Ulam and Tsingou: 16 masses between two walls; q[i] is the displacement from rest.

    Each of the 17 springs, including those at the walls, has the force k r + α r² + β r³ at the elongation r. For α
    = β = 0 the frequencies are 2 √(k/m) sin(π j/34), j = 1 … 16. Started in the lowest mode, the chain does not
    reach thermal equilibrium: the energy returns to that mode. The Jacobian of a step is tridiagonal. Source:
    Fermi, Pasta, Ulam, Studies of nonlinear problems I, Los Alamos report LA-1940 (1955), with α = 1/4.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def k(self) -> float: ...
    @k.setter
    def k(self, value: float) -> None: ...
    @property
    def alpha(self) -> float: ...
    @alpha.setter
    def alpha(self, value: float) -> None: ...
    @property
    def beta(self) -> float: ...
    @beta.setter
    def beta(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., k: float = ..., alpha: float = ..., beta: float = ...) -> None: ...

class GuidingCentre(System):
    """Guiding centre of a charge in the field of a tokamak with circular surfaces, without its gyration.

    Coordinates are the poloidal angle θ, the toroidal angle φ, the distance r from the axis of the tube, and the
    velocity u along the field; mass and charge are one. L = (A + u b)·(θ', φ') − H is linear in the velocities.
    H = u²/2 + μ B, B is the curl of A, and b has no component along r. The momentum of φ is conserved. From
    θ = φ = 0, r = 0.25, u = 0.005 the centre is trapped on a banana orbit of period 2840; with u = 0.03 it goes
    around.
    Sources: Littlejohn, Journal of Plasma Physics 29 (1983) 111; Ellison, Finn, Burby, Kraus, Qin, Tang, Physics of
    Plasmas 25 (2018) 052502.
    """

    @property
    def B0(self) -> float: ...
    @B0.setter
    def B0(self, value: float) -> None: ...
    @property
    def R0(self) -> float: ...
    @R0.setter
    def R0(self, value: float) -> None: ...
    @property
    def safety(self) -> float: ...
    @safety.setter
    def safety(self, value: float) -> None: ...
    @property
    def mu(self) -> float: ...
    @mu.setter
    def mu(self, value: float) -> None: ...
    def __init__(self, *, B0: float = ..., R0: float = ..., safety: float = ..., mu: float = ...) -> None: ...

class HardDuffing(System):
    """Hard Duffing oscillator, a + c v + α x + β x³ = A cos ω t.

    The drive is in the force, not in L: the two choices have different step densities (`docs/mathematics.md`).
    Source: Guckenheimer and Holmes, Nonlinear Oscillations, section 2.2.
    """

    @property
    def alpha(self) -> float: ...
    @alpha.setter
    def alpha(self, value: float) -> None: ...
    @property
    def beta(self) -> float: ...
    @beta.setter
    def beta(self, value: float) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, value: float) -> None: ...
    @property
    def amplitude(self) -> float: ...
    @amplitude.setter
    def amplitude(self, value: float) -> None: ...
    @property
    def omega(self) -> float: ...
    @omega.setter
    def omega(self, value: float) -> None: ...
    def __init__(self, *, alpha: float = ..., beta: float = ..., c: float = ..., amplitude: float = ..., omega: float = ...) -> None: ...

class HarmonicOscillator(System):
    """Harmonic oscillator, m a + k x = 0.

    The exact motion is x(t) = x(0) cos ω t + (v(0)/ω) sin ω t with ω = √(k/m). The frequency ω̃ of the midpoint
    rule satisfies tan(ω̃ h/2) = ω h/2. Source: Goldstein, Classical Mechanics, chapter 6.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def k(self) -> float: ...
    @k.setter
    def k(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., k: float = ...) -> None: ...

class HeavyTop(System):
    """Symmetric heavy top on a fixed point; the unit quaternion R turns the body into space, z upwards.

    The body's third axis is the axis of the top. Its components of the angular momentum about the vertical and about the
    axis are constant. A fast top with J3 ω3 above 2 √(J1 m g l) stands upright. Source: Goldstein, Classical Mechanics,
    section 5.7.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def J1(self) -> float: ...
    @J1.setter
    def J1(self, value: float) -> None: ...
    @property
    def J3(self) -> float: ...
    @J3.setter
    def J3(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., J1: float = ..., J3: float = ..., g: float = ...) -> None: ...

class HenonHeiles(System):
    """Hénon–Heiles system, V = (x² + y²)/2 + λ (x² y − y³/3).

    Bounded below E = 1/6 for λ = 1; regular at small energies, chaotic near the bound.
    Source: Hénon and Heiles, Astronomical Journal 69 (1964) 73.
    """

    @property
    def lambda_(self) -> float: ...
    @lambda_.setter
    def lambda_(self, value: float) -> None: ...
    def __init__(self, *, lambda_: float = ...) -> None: ...

class Kepler(System):
    """Plane Kepler problem, a = −μ r/|r|³.

    Conserved: energy, angular momentum x v_y − y v_x. Started at the pericentre of an orbit of eccentricity e, the
    energy-preserving integrator runs for e ≤ 0.785 and cannot run for e ≥ √(5/8).
    Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section I.2.
    """

    @property
    def mu(self) -> float: ...
    @mu.setter
    def mu(self, value: float) -> None: ...
    def __init__(self, *, mu: float = ...) -> None: ...

class LotkaVolterra(System):
    """Lotka–Volterra equations: prey' = prey (a − b predators), predators' = predators (c prey − d).

    L is linear in the velocities: the state is the numbers of both. The energy is the conserved quantity
    b predators − a ln(predators) + c prey − d ln(prey); every motion is periodic.
    Source: Kraus, Projected variational integrators for degenerate Lagrangian systems (2017), arXiv:1708.07356.
    """

    @property
    def a(self) -> float: ...
    @a.setter
    def a(self, value: float) -> None: ...
    @property
    def b(self) -> float: ...
    @b.setter
    def b(self, value: float) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, value: float) -> None: ...
    @property
    def d(self) -> float: ...
    @d.setter
    def d(self, value: float) -> None: ...
    def __init__(self, *, a: float = ..., b: float = ..., c: float = ..., d: float = ...) -> None: ...

class MasslessParticle(System):
    """Charge without mass in the plane, in the field B (1 + k (x² + y²)) and the potential E (cos x + sin w y).

    This is the limit of a strong field. L is linear in the velocities: the state is the position, and the momentum
    of y is the vector potential. The charge drifts along lines of equal potential with the velocity |∇φ|/B.
    Source: Kraus, Projected variational integrators for degenerate Lagrangian systems (2017), arXiv:1708.07356.
    """

    @property
    def B(self) -> float: ...
    @B.setter
    def B(self, value: float) -> None: ...
    @property
    def k(self) -> float: ...
    @k.setter
    def k(self, value: float) -> None: ...
    @property
    def E(self) -> float: ...
    @E.setter
    def E(self, value: float) -> None: ...
    @property
    def w(self) -> float: ...
    @w.setter
    def w(self, value: float) -> None: ...
    def __init__(self, *, B: float = ..., k: float = ..., E: float = ..., w: float = ...) -> None: ...

class NPendulum(System):
    """Four equal pendula, each hanging from the one above, in absolute angles; θ = 0 hangs down.

    Link i carries all masses from i on. So its square has the weight N − i, and the pair (i, j) with j < i has the
    weight N − i times the cosine of the angle between the links. The mass matrix is full and depends on the
    configuration; the motion is chaotic at large angles. For N = 2 it is the double pendulum with equal masses and
    rods. Source: Landau and Lifshitz, Mechanics, section 5, continued.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., g: float = ...) -> None: ...

class OuterSolarSystem(System):
    """Sun, Jupiter, Saturn, Uranus, Neptune and Pluto, in this order, with mutual attraction.

    Lengths in astronomical units, times in days, masses relative to the Sun's; the mass of the Sun includes the
    inner planets. Conserved: energy, momentum, angular momentum. Jupiter has a period of 4333 days, Pluto of 90
    600. Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section I.2.3 and table 2.2.
    """

    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    @property
    def m0(self) -> float: ...
    @m0.setter
    def m0(self, value: float) -> None: ...
    @property
    def m1(self) -> float: ...
    @m1.setter
    def m1(self, value: float) -> None: ...
    @property
    def m2(self) -> float: ...
    @m2.setter
    def m2(self, value: float) -> None: ...
    @property
    def m3(self) -> float: ...
    @m3.setter
    def m3(self, value: float) -> None: ...
    @property
    def m4(self) -> float: ...
    @m4.setter
    def m4(self, value: float) -> None: ...
    @property
    def m5(self) -> float: ...
    @m5.setter
    def m5(self, value: float) -> None: ...
    def __init__(self, *, g: float = ..., m0: float = ..., m1: float = ..., m2: float = ..., m3: float = ..., m4: float = ..., m5: float = ...) -> None: ...

class ParametricPendulum(System):
    """Parametric pendulum, a = −(1 + ε cos ω t) sin θ.

    L depends on time, and no force can replace this dependence without changing the energy. With ε = 0.5, ω = 2 the
    energy-preserving step ends at t = 0.870. Source: Landau and Lifshitz, Mechanics, section 27.
    """

    @property
    def epsilon(self) -> float: ...
    @epsilon.setter
    def epsilon(self, value: float) -> None: ...
    @property
    def omega(self) -> float: ...
    @omega.setter
    def omega(self, value: float) -> None: ...
    def __init__(self, *, epsilon: float = ..., omega: float = ...) -> None: ...

class Pendulum(System):
    """Plane pendulum, m l² a = −m g l sin θ; θ = 0 hangs down.

    Librations run with the energy-preserving integrator; rotations end when the step density vanishes. Source:
    Goldstein, Classical Mechanics, chapter 1.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., g: float = ...) -> None: ...

class PointVortices(System):
    """Four point vortices of an ideal fluid in the plane: each moves with the velocity that the others cause.

    L is linear in the velocities: the state is the positions, and the momentum of x is Γ y. A vortex of strength
    Γ > 0 turns the others counterclockwise, with the velocity Γ/(2π r). Steps preserve Σ Γ x, Σ Γ y and
    Σ Γ (x² + y²), so that motions are bounded if all strengths have the same sign. Four vortices move chaotically.
    Source: Aref, Annual Review of Fluid Mechanics 15 (1983) 345.
    """

    @property
    def strength(self) -> NDArray[float64]: ...
    @strength.setter
    def strength(self, value: ArrayLike) -> None: ...
    def __init__(self, *, strength: ArrayLike = ...) -> None: ...

class RodChain(System):
    """Ten equal masses on a chain of ten massless rods, in Cartesian coordinates; r[i] = (x, y) of mass i, y upwards.

    The mass matrix is constant, and each rod shares a mass with its two neighbours only. In angles the mass matrix is full:
    `NPendulum`. Source: Landau and Lifshitz, Mechanics, section 5, continued.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., g: float = ...) -> None: ...

class RodPendulum(System):
    """Plane pendulum in Cartesian coordinates, y upwards; the rod is a constraint.

    The reaction −2 Λ l is the tension of the rod. The same motion in its angle is `Pendulum`. Source: Hairer,
    Lubich, Wanner, Geometric Numerical Integration, section VII.1.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., g: float = ...) -> None: ...

class RollingBall(System):
    """Homogeneous ball that rolls without slip on a horizontal table, which turns with the rate Ω; Ω = 0 is a plane.

    (x, y) is the centre of the ball, and the unit quaternion R its orientation. The centre runs in a circle with the
    rate 2 Ω/7; on a plane that rests it runs straight. Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems,
    chapter III, section 2; J. A. Burns, Ball rolling on a turntable, Am. J. Phys. 49 (1981).
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def r(self) -> float: ...
    @r.setter
    def r(self, value: float) -> None: ...
    @property
    def Ω(self) -> float: ...
    @Ω.setter
    def Ω(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., r: float = ..., Ω: float = ...) -> None: ...

class RollingDisk(System):
    """Thin disk that rolls on a horizontal plane without slip, as a coin.

    (x, y) is the point of contact, φ the heading, θ the inclination of the disk from the plane (π/2 stands upright),
    ψ the rolling angle. The energy and two further quantities are constant. Source: Neimark and Fufaev, Dynamics of
    Nonholonomic Systems, chapter II, section 2.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def r(self) -> float: ...
    @r.setter
    def r(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., r: float = ..., g: float = ...) -> None: ...

class RotatingHoop(System):
    """Bead on a hoop of radius r that turns with the angular velocity Ω; θ = 0 is the bottom.

    The conserved quantity is the Jacobi integral v·L_v − L, not kinetic plus potential energy. Above Ω² = g/r the
    bottom is unstable and the bead rests at cos θ = g/(r Ω²). Source: Goldstein, Classical Mechanics, chapter 2.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def r(self) -> float: ...
    @r.setter
    def r(self, value: float) -> None: ...
    @property
    def Ω(self) -> float: ...
    @Ω.setter
    def Ω(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., r: float = ..., Ω: float = ..., g: float = ...) -> None: ...

class SliderCrank(System):
    """Slider-crank: a flywheel with its crank, a connecting rod, and a slider on a line through the axis.

    θ is the angle of the crank and φ that of the rod, both from this line; x is the position of the slider. The rod is
    uniform. The loop from the axis over the crank and the rod to the slider closes in two directions. There is no
    gravity; k is a spring between the slider and its outer end position. Source: Haug, Computer Aided Kinematics and
    Dynamics of Mechanical Systems, section 5.
    """

    @property
    def r(self) -> float: ...
    @r.setter
    def r(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def J(self) -> float: ...
    @J.setter
    def J(self, value: float) -> None: ...
    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def M(self) -> float: ...
    @M.setter
    def M(self, value: float) -> None: ...
    @property
    def k(self) -> float: ...
    @k.setter
    def k(self, value: float) -> None: ...
    def __init__(self, *, r: float = ..., l: float = ..., J: float = ..., m: float = ..., M: float = ..., k: float = ...) -> None: ...

class SphericalPendulum(System):
    """Spherical pendulum; θ from the vertical down, φ about it.

    φ is cyclic: its momentum m l² sin²θ φ̇ is conserved bit for bit. The coordinates are singular at θ = 0 and π.
    Source: Goldstein, Classical Mechanics, chapter 1.
    """

    @property
    def m(self) -> float: ...
    @m.setter
    def m(self, value: float) -> None: ...
    @property
    def l(self) -> float: ...
    @l.setter
    def l(self, value: float) -> None: ...
    @property
    def g(self) -> float: ...
    @g.setter
    def g(self, value: float) -> None: ...
    def __init__(self, *, m: float = ..., l: float = ..., g: float = ...) -> None: ...

class ThreeBody(System):
    """Three bodies in a plane with mutual attraction; the constant of gravitation is 1.

    Conserved: energy, momentum, angular momentum. Equal masses can follow one another on a stable figure-eight
    orbit. Source: Chenciner and Montgomery, Annals of Mathematics 152 (2000) 881; initial state computed by C.
    Simó.
    """

    @property
    def m0(self) -> float: ...
    @m0.setter
    def m0(self, value: float) -> None: ...
    @property
    def m1(self) -> float: ...
    @m1.setter
    def m1(self, value: float) -> None: ...
    @property
    def m2(self) -> float: ...
    @m2.setter
    def m2(self, value: float) -> None: ...
    def __init__(self, *, m0: float = ..., m1: float = ..., m2: float = ...) -> None: ...
