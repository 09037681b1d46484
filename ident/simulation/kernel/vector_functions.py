"""Power, sine and cosine of eight lanes at once, in the language of LLVM: a library of functions takes them one by one.

**x^y** = 2^(y log2 x) with x = m 2^e, √½ ≤ m < √2: log2 m = 2/ln 2 · atanh((m − 1)/(m + 1)) by its series, and 2^r with
|r| ≤ ½ by that of the exponential function. The relative error is below 1e-14 where |y log2 x| < 10. What is not
positive follows C: 0 and what is not a number give what pow gives, and a negative x gives a number where y is whole.

**sin x** and **cos x** are those of r = x − k π/2 with |r| ≤ π/4, by their series, and k tells which of them and its
sign. The error is below 1e-15 where |x| < 1e9; beyond 1e15, where a number no longer tells an angle, they give none.

Each series goes on until a term is below the last bit.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

LOGARITHM_TERMS = 11
"""Terms of atanh s = s Σ s^2k/(2k + 1): with |s| ≤ 0.172 the first that is left out is 6e-19 of the first."""
EXPONENTIAL_TERMS = 14
"""Terms of 2^r = Σ (r ln 2)^k/k!: with |r| ≤ ½ the first that is left out is 4e-18 of the first."""
CIRCULAR_TERMS = 9
"""Terms of sin r and cos r: with |r| ≤ π/4 the first that is left out is 2e-18."""
_SHIFT = 52  # bits of a number behind its exponent
_BIAS = 1023  # what is added to an exponent
_ROUND = 1.5 * 2.0**52
"""Added to a number, it leaves the nearest whole one in the last bits: few processors round eight numbers otherwise."""
_WHOLE = 2.0**52
"""A number whose last bits are a whole one, after which it is the sum of both."""
_RANGE = 2200.0
"""Exponents from which on 2^n is 0 or infinite by far: larger ones would not be whole numbers of a few bits."""
_LARGEST = 1e15
"""rad; beyond it neighbouring numbers are an eighth apart."""
_QUARTER = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591833e-33)
"""π/2 as the sum of three numbers."""


@dataclass
class _Function:
    """Instructions on a vector of so many lanes, in turn."""

    lanes: int
    written: list[str] = field(default_factory=list)

    @property
    def real(self) -> str:
        return f"<{self.lanes} x double>"

    @property
    def whole(self) -> str:
        return f"<{self.lanes} x i64>"

    def new(self, operation: str) -> str:
        self.written.append(f"%r{len(self.written)} = {operation}")
        return f"%r{len(self.written) - 1}"

    def number(self, value: float) -> str:
        return everywhere(value, self.lanes)

    def integer(self, value: int) -> str:
        return f"<{', '.join([f'i64 {value}'] * self.lanes)}>"

    def do(self, name: str, a: str, b: str) -> str:
        """Of two vectors, a + b for ``fadd`` and so on; nothing is put into another order."""
        kind = self.real if name[0] == "f" else self.whole
        return self.new(f"{name} {kind} {a}, {b}")

    def fused(self, a: str, b: str, c: str) -> str:
        """a b + c, rounded once."""
        return self.call("fma", a, b, c)

    def call(self, name: str, *given: str) -> str:
        """What LLVM's own function of so many vectors gives."""
        arguments = ", ".join(f"{self.real} {vector}" for vector in given)
        return self.new(f"call {self.real} @llvm.{name}.v{self.lanes}f64({arguments})")

    def rounded(self, a: str) -> str:
        """The nearest whole number, and the bits of it that :meth:`bits_of` reads."""
        return self.do("fadd", a, self.number(_ROUND))

    def bits_of(self, a: str) -> str:
        return self.new(f"bitcast {self.real} {a} to {self.whole}")

    def real_of(self, a: str) -> str:
        return self.new(f"bitcast {self.whole} {a} to {self.real}")

    def holds(self, relation: str, a: str, b: str) -> str:
        return self.new(f"fcmp {relation} {self.real} {a}, {b}")

    def choice(self, holds: str, a: str, b: str) -> str:
        return self.new(f"select <{self.lanes} x i1> {holds}, {self.real} {a}, {self.real} {b}")

    def series(self, z: str, coefficients: list[float]) -> str:
        """Σ c_k z^k, the even and the odd terms side by side: half as long a chain."""
        square = self.do("fmul", z, z)
        even, odd = (self._horner(square, coefficients[first::2]) for first in (0, 1))
        return self.fused(odd, z, even)

    def _horner(self, z: str, coefficients: list[float]) -> str:
        *others, last = (self.number(c) for c in coefficients)
        for c in reversed(others):
            last = self.fused(last, z, c)
        return last


def function(name: str, lanes: int) -> str:
    """The function ``@lanes_NAME`` of vectors of so many lanes, for a name in :data:`FUNCTIONS`."""
    of, count = _Function(lanes), 2 if name == "pow" else 1
    value = FUNCTIONS[name](of)
    given = ", ".join(f"{of.real} {argument}" for argument in ("%x", "%y")[:count])
    lines = "\n  ".join([*of.written, f"ret {of.real} {value}"])
    return f"define internal {of.real} @lanes_{name}({given}) {{\n  {lines}\n}}"


def declared(lanes: int) -> str:
    """What the functions call."""
    real = f"<{lanes} x double>"
    calls = {"fabs": 1, "floor": 1, "fma": 3}
    return "\n".join(f"declare {real} @llvm.{name}.v{lanes}f64({', '.join([real] * n)})" for name, n in calls.items())


def _power(of: _Function) -> str:
    zero = of.number(0.0)
    size = of.call("fabs", "%x")
    logarithm, exponent = _logarithm(of, size)
    # n is the nearest whole number to y log2 x, and r the rest: y e − n is exact
    product = of.do("fmul", "%y", logarithm)
    whole = _clipped(of, of.fused("%y", exponent, product))
    shifted = of.rounded(whole)
    n = of.do("fsub", shifted, of.number(_ROUND))
    rest = of.do("fadd", of.fused("%y", exponent, of.do("fsub", zero, n)), product)
    ln2 = math.log(2.0)
    value = of.series(rest, [ln2**k / math.factorial(k) for k in range(EXPONENTIAL_TERMS)])
    value = _at_the_ends(of, _scaled(of, value, n), size)
    return of.choice(of.holds("oeq", "%y", zero), of.number(1.0), value)


def everywhere(value: float, lanes: int) -> str:
    """A number to its last bit, in every lane."""
    bits = f"double 0x{_bits(value) % 2**64:016X}"
    return f"<{', '.join([bits] * lanes)}>"


def _logarithm(of: _Function, size: str) -> tuple[str, str]:
    """log2 m and e of positive numbers m 2^e; those too small for all bits are taken 2^54 times as large."""
    is_small = of.holds("olt", size, of.number(2.0**-1022))
    bits = of.bits_of(of.choice(is_small, of.do("fmul", size, of.number(2.0**54)), size))
    lifted = of.do("add", bits, of.integer((_BIAS << _SHIFT) - _bits(math.sqrt(0.5))))
    biased = of.do("lshr", lifted, of.integer(_SHIFT))
    power_of_two = of.do("shl", biased, of.integer(_SHIFT))
    m = of.real_of(of.do("add", of.do("sub", bits, power_of_two), of.integer(_BIAS << _SHIFT)))
    read = of.real_of(of.do("or", biased, of.integer(_bits(_WHOLE))))
    exponent = of.do("fsub", read, of.number(_WHOLE + _BIAS))
    exponent = of.choice(is_small, of.do("fsub", exponent, of.number(54.0)), exponent)
    s = of.do("fdiv", of.do("fsub", m, of.number(1.0)), of.do("fadd", m, of.number(1.0)))
    scale = 2.0 / math.log(2.0)
    series = of.series(of.do("fmul", s, s), [scale / (2 * k + 1) for k in range(LOGARITHM_TERMS)])
    return of.do("fmul", s, series), exponent


def _clipped(of: _Function, value: str) -> str:
    low, high = of.number(-_RANGE), of.number(_RANGE)
    value = of.choice(of.holds("ogt", value, high), high, value)
    return of.choice(of.holds("olt", value, low), low, value)


def _scaled(of: _Function, value: str, n: str) -> str:
    """Value · 2^n in three factors, none of which is beyond the range of numbers."""
    third = of.do("fsub", of.rounded(of.do("fmul", n, of.number(1.0 / 3.0))), of.number(_ROUND))
    last = of.do("fsub", of.do("fsub", n, third), third)
    for part in (third, third, last):
        bits = of.do("sub", of.bits_of(of.rounded(part)), of.integer(_bits(_ROUND) - _BIAS))
        value = of.do("fmul", value, of.real_of(of.do("shl", bits, of.integer(_SHIFT))))
    return value


def _at_the_ends(of: _Function, value: str, size: str) -> str:
    """The power where x is zero, infinite, negative, or where x or y is not a number."""
    zero, infinite, none = of.number(0.0), of.number(math.inf), of.number(math.nan)
    grows = of.holds("ogt", "%y", zero)
    value = of.choice(of.holds("oeq", size, zero), of.choice(grows, zero, infinite), value)
    value = of.choice(of.holds("oeq", size, infinite), of.choice(grows, infinite, zero), value)
    half = of.do("fmul", "%y", of.number(0.5))
    is_even = of.holds("oeq", of.call("floor", half), half)
    is_whole = of.holds("oeq", of.call("floor", "%y"), "%y")
    turned = of.choice(is_even, value, of.do("fsub", zero, value))
    value = of.choice(of.holds("olt", "%x", zero), of.choice(is_whole, turned, none), value)
    return of.choice(of.holds("uno", "%x", "%y"), none, value)


def _circular(of: _Function, turned: int) -> str:
    """Sine of x, which is `turned` by so many right angles."""
    zero = of.number(0.0)
    shifted = of.rounded(of.do("fmul", "%x", of.number(2.0 / math.pi)))
    against = of.do("fsub", zero, of.do("fsub", shifted, of.number(_ROUND)))
    rest = "%x"
    for part in _QUARTER:
        rest = of.fused(against, of.number(part), rest)
    square = of.do("fmul", rest, rest)
    signs = [(-1.0) ** k for k in range(CIRCULAR_TERMS)]
    sines = of.series(square, [sign / math.factorial(2 * k + 1) for k, sign in enumerate(signs)])
    cosine = of.series(square, [sign / math.factorial(2 * k) for k, sign in enumerate(signs)])
    angle = of.do("add", of.bits_of(shifted), of.integer(turned))
    is_even = of.new(f"icmp eq {of.whole} {of.do('and', angle, of.integer(1))}, {of.integer(0)}")
    value = of.choice(is_even, of.do("fmul", rest, sines), cosine)
    sign = of.do("shl", of.do("lshr", angle, of.integer(1)), of.integer(63))
    value = of.real_of(of.do("xor", of.bits_of(value), sign))
    return of.choice(of.holds("olt", of.call("fabs", "%x"), of.number(_LARGEST)), value, of.number(math.nan))


FUNCTIONS: dict[str, Callable[[_Function], str]] = {
    "pow": _power,
    "sin": partial(_circular, turned=0),
    "cos": partial(_circular, turned=1),
}
"""By their names in the lines of a kernel."""


def _bits(value: float) -> int:
    return int(struct.unpack("<q", struct.pack("<d", value))[0])
