"""The fifth-order servo-hydraulic actuator of the hybrid-simulation paper (Strano, Terzo et al.), eqs. (1) to (4)."""

from dataclasses import replace

from ident.chain.chain import Chain
from ident.presets.convention import Convention
from ident.presets.preset import Combined, Display, Preset, RequiredData, SearchPlan
from ident.stages import (
    DRIVEN_VALVE,
    IDEAL_SENSOR,
    OPENED_BY_COMMAND,
    OVERLAP,
    PROPORTIONAL,
    TABLE_ON_GUIDES,
    TIGHT_CYLINDER,
    TWO_SIDED_FLOW,
    Scale,
)

AREA = 9.05e-3
"""m², assumed: 190 kN at a supply of 210 bar."""
_BEHIND = (DRIVEN_VALVE, OVERLAP, TWO_SIDED_FLOW, TIGHT_CYLINDER, TABLE_ON_GUIDES, IDEAL_SENSOR)
_OUTPUTS = {"displacement": "y", "load_pressure": "P", "spool": "q", "velocity": "v", "force": "F"}
_OPEN = (("q1", "vep - ve0 + 0.1 * (vep - ven)"), ("u", "1"))
"""Where small signals are taken: the valve open to the positive side by a tenth of its overlap."""

_IN_LOOP = Preset(
    name="strano",
    title="Servo-hydraulic actuator of fifth order: overlap, square-root flow, dry friction",
    citation=(
        "S. Strano, M. Terzo et al.: servo-hydraulic hybrid simulation with an extended Kalman filter; fifth-order "
        "model, eqs. (1) to (4)."
    ),
    chain=Chain((PROPORTIONAL, *_BEHIND), _OUTPUTS, about=_OPEN),
    listed=("ve0", "kep", "ken", "wn", "xi", "ven", "vep", "kqn", "kqp", "C", "m", "sigma", "Fc", "mu"),
    steps=8,
    absolute=("spool",),
    crossing=("ve0", "ven", "vep"),
    combinations=(
        Combined("kep*kqp", "m^3/(s*V*Pa^0.5)", "flow for each volt of a positive command"),
        Combined("ken*kqn", "m^3/(s*V*Pa^0.5)", "flow for each volt of a negative command"),
        Combined("(vep - ve0) / kep", "V", "positive command at which the flow begins"),
        Combined("(ve0 - ven) / ken", "V", "negative command at which the flow begins"),
        Combined("Fc + mu*Nv", "N", "dry friction under the mean vertical load"),
        Combined("A**2 / (C*m)", "1/s^2", "ωh², the oil column against the moving mass"),
        Combined("sigma / m", "1/s", "damping of the moving mass"),
    ),
    notes=(
        "The paper prints no parameter values. The defaults are assumed from its ratings (190 kN, 2.2 m/s, ±0.2 m): "
        "piston area 9.05e-3 m² at 210 bar, 2.2 m/s at 10 V, oil of V0 = 2e-3 m³ and β = 1e9 Pa on each side.",
        "Of the driver the paper's print keeps only its bias ve0 and its gains. Read here: vc = ve0 + kep u for "
        "u ≥ 0, ve0 + ken u for u < 0.",
        "The command is a position in m (gain in V/m) or, in open loop, a voltage. The supply pressure is that of the "
        "channel supply_pressure, sample by sample, or the one stated of the actuator; the vertical load that of the "
        "channel vertical_load, none where there is no such channel.",
    ),
    search=SearchPlan(
        order=("kep", "ken", "wn", "xi", "kqp", "kqn", "vep", "ven", "ve0", "m", "C", "sigma", "Fc", "mu"),
        bounds_hold_for=AREA,
        options={"population": 64.0, "generations": 8.0, "elite": 6.0},
        force_scale="A * Ps",
    ),
    data=RequiredData(
        alone=True,
        needs=("piston_area", "supply_pressure"),
        conventions=(
            Convention(
                "spool",
                "not shown",
                {"kep": 0.5, "ve0": 0.0},
                "without the spool as an output a common scale of kep, ken, ve0, ven, vep against kqp, kqn and a "
                "common shift of ve0, ven, vep change nothing",
                ("ken", "kqp", "kqn", "ven", "vep"),
            ),
            Convention(
                "vertical_load", "not measured", {"mu": 0.0}, "no vertical load was measured: Fc is all dry friction"
            ),
            Convention(
                "vertical_load",
                "steady",
                {"mu": 0.0},
                "the vertical load does not vary: Fc + mu*Nv is one quantity, and all of it is given as Fc",
                ("Fc",),
            ),
        ),
    ),
    display=Display(
        of_drive=("ve0", "ven", "vep"),
        drive_unit="V",
        shown=("kqp", "C"),
    ),
)

OPEN_LOOP = replace(
    _IN_LOOP,
    chain=Chain((OPENED_BY_COMMAND, *_BEHIND), _OUTPUTS, about=_OPEN),
    search=replace(
        _IN_LOOP.search,
        rescaled=(
            *(Scale(name, "0.5 * kep * U", -1.0, 1.0, logarithmic=False) for name in ("ve0", "ven", "vep")),
            Scale("kqp", "A * V / (kep * U * sqrt(Ps))", 1e-2, 1e2),
        ),
        drive_scale="U",
    ),
)

STRANO = replace(_IN_LOOP, opened=OPEN_LOOP)
