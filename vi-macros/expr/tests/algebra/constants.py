"""Writes `constants.txt`: constant expressions and their values to 50 digits, by mpmath.

    pip install mpmath && python constants.py > constants.txt

Each value is computed with more and more digits until two results agree. Expressions of the second part are random, of a fixed seed.
"""

import random
import re

from mpmath import mp, mpf, nstr
import mpmath

CHOSEN = """
sin(10^20*pi/3)
exp(-800)*1e300
1 - cos(1e-8)
acos(1 - 1e-20)
ln(1 + 1e-15)
(sqrt(2) - 1)^20
2*sqrt(3)*pi
sin(10^1000)
cos(10^300*sqrt(2))
tan(pi/2 - 1e-30)
tan(pi + 1e-200)
sin(pi*(1 + 1e-40))
cos(355/226)
sin(22)
tan(11)
exp(pi*sqrt(163)) - 262537412640768744
ln(1 - 1e-250)
ln(exp(1e-100))
exp(1e-30) - 1 - 1e-30
sinh(1e-100)
sinh(1e-5) - 1e-5
sinh(600)
cosh(1e-60) - 1
cosh(600)
tanh(1e-50)
1 - tanh(100)
1e300*(1 - tanh(370))
tanh(1e30)
asin(1 - 1e-40) - pi/2
asin(1e-200)
acos(-1 + 1e-60) - pi
acos(1e-30) - pi/2
atan(1e200) - pi/2
atan(1e-200)
atan2(1e-30, -1)
atan2(1e-30, -1) - pi
atan2(-1e-200, -1)
atan2(-3, 1e-20)
hypot(1e200, 1e-200)
hypot(1e-200, 1e-201)
pow(sqrt(2), sqrt(3))
pow(2, sqrt(1e-30))
pow(pi, -100*sqrt(2))
exp(exp(6))
exp(exp(10))/exp(exp(10) - 1)
(cos(exp(-400)) - 1)*1e300*1e100
((sqrt(5) + 1)/2)^200 - 627376215338105766356982006981782561278127
(7/3)^(1/1000000)
(3/7)^(1234/7)
10^(10^-9) - 1
2^(1/3) + 3^(1/3) - (2 + 3*18^(1/3) + 3*12^(1/3) + 3)^(1/3) + 1e-50*pi
abs(sqrt(2)*sqrt(3) - sqrt(6)*(1 + 1e-90))
sign(exp(pi) - pi - 20)
sign(1e-20 - acos(1 - 1e-40))
1 + 1/2^53 - exp(-90)
1 + 1/2^53 + exp(-90)
1 + 3/2^53 - exp(-90)
"""

UNARY = ["exp", "ln", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "abs", "sqrt"]
RENAMED = {"ln": "log", "abs": "fabs"}
NUMBERS = ["1", "2", "3", "7", "10", "1/3", "5/7", "0.1", "1e-8", "1e-20", "12345.678", "1e15", "pi", "sqrt(2)", "0.5", "2.75"]


def tree(rng, depth):
    if depth == 0 or rng.random() < 0.1:
        return rng.choice(NUMBERS)
    kind = rng.random()
    if kind < 0.45:
        return f"{rng.choice(UNARY)}({tree(rng, depth - 1)})"
    left, right = tree(rng, depth - 1), tree(rng, depth - 1)
    if kind < 0.9:
        return f"({left}) {rng.choice('+-*/')} ({right})"
    if kind < 0.94:
        return f"({left})^{rng.choice(['2', '3', '(-2)', '(1/2)', '(-3/2)', '(1/3)', '7'])}"
    return f"{rng.choice(['hypot', 'atan2', 'pow'])}({left}, {right})"


class Real:
    """A number that refuses to become complex, or too large for a function to end soon."""

    def __init__(self, value):
        self.value = exact(value)
        if abs(self.value) > mpf("1e20000"):
            raise ValueError

    def __neg__(self):
        return Real(-self.value)

    def __add__(self, other):
        return Real(self.value + other.value)

    def __sub__(self, other):
        return Real(self.value - other.value)

    def __mul__(self, other):
        return Real(self.value * other.value)

    def __truediv__(self, other):
        # Zero but for rounding, as tan(pi).
        if abs(other.value) < mpf(10) ** (-mp.dps // 2):
            raise ValueError
        return Real(self.value / other.value)

    def __pow__(self, other):
        if self.value > 0 and abs(mpmath.log(self.value) * other.value) > 40000:
            raise ValueError
        return Real(self.value**other.value)


def real(function):
    def call(*arguments):
        if function in GROWING and arguments[0].value > 40000:
            raise ValueError
        return Real(function(*(argument.value for argument in arguments)))

    return call


GROWING = [mpmath.exp, mpmath.sinh, mpmath.cosh]


def at(text, digits):
    mp.dps = digits
    scope = {name: real(getattr(mpmath, RENAMED.get(name, name))) for name in UNARY + ["hypot", "atan2", "sign"]}
    scope |= {"pow": lambda a, b: a**b, "pi": Real(mp.pi), "exact": Real}
    python = re.sub(r"(?<![A-Za-z_0-9.])(\d+\.?\d*(?:e-?\d+)?)", r"exact('\1')", text)
    return eval(python.replace("^", "**"), scope)


def exact(value):
    if isinstance(value, mpmath.mpc):
        raise ValueError
    return mpf(value)


def value(text):
    found = None
    for digits in [100, 200, 400, 800, 1600]:
        try:
            next_found = at(text, digits).value
        except (ValueError, ZeroDivisionError, OverflowError, MemoryError):
            return None
        if not mpmath.isfinite(next_found):
            return None
        mp.dps = 60
        if found is not None and next_found != 0 and abs(found - next_found) < abs(next_found) * mpf(10) ** -55:
            return next_found
        found = next_found
    return None


def line(text):
    found = value(text)
    mp.dps = 60
    if found is None or not mpf("1e-300") < abs(found) < mpf("1e300"):
        return None
    return f"{text} = {nstr(found, 50, min_fixed=0, max_fixed=0)}"


rng = random.Random(33)
chosen = [line(text) for text in CHOSEN.strip().splitlines()]
assert None not in chosen, [text for text, found in zip(CHOSEN.strip().splitlines(), chosen) if found is None]
lines = []
while len(lines) < 600:
    found = line(tree(rng, rng.randint(2, 5)))
    if found and found not in lines and any(name in found for name in UNARY):
        lines.append(found)
print("# Constant expressions and their values to 50 digits, written by `constants.py`.")
print("\n".join(chosen + lines))
