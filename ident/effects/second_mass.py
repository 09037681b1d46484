"""A second mass behind a spring, from which effects are made: what it does to a drive is the same wherever one looks.

Of the moving mass m₀ a share μ hangs behind a spring with a damper, ω its frequency where the drive stands still:

    x₁'' = ω² (x − x₁) + 2 ζ ω (x' − x₁'),   (1 − μ) m₀ x'' = D − R − f − S − μ m₀ x₁''.

With ζ = 0.35 it overshoots by 31 % after a step of the drive, exp(−π ζ/√(1 − ζ²)). Couplings of steel have 0.01 to 0.05
and those of rubber up to 0.16 (DIN 740-2, relative damping ψ = 4 π ζ up to 2). What hardly swings is no mass behind a
spring but a slow part, as of two lags side by side.

Its own quantities are xj = x − x₁ and vj = x₁'.
"""

from ident.parameter import Parameter, Starts

SHARE = Parameter("share", "mu", "1", 0.0, 0.98, 0.0, "share of the moving mass that is behind the spring")
SHAPE = (
    Parameter(
        "frequency",
        "wj",
        "1/s",
        1.0,
        1e3,
        30.0,
        "frequency of the mass behind the spring, the drive at rest, rad/s",
        searched=True,
        start=Starts.RESONANCE,
    ),
    Parameter("damping", "zeta", "1", 0.01, 0.35, 0.1, "damping ratio of this motion"),
)
TEXTS = (
    "xj' = v - vj",
    "vj' = wj**2 * xj + 2 * zeta * wj * (v - vj) - aB",
    "G = mu * m0 * (wj**2 * xj + 2 * zeta * wj * (v - vj))",
    "a = where(mu > 0, (D - R - f - S - G) / ((1 - mu) * m0 + mL) - aB, a)",
    "M = M - mu * m0",
)
UNITS = {"a": "m/s^2", "M": "kg"}
