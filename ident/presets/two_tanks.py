"""Two tanks in series: a pump's command → the level of the lower one."""

from ident.chain.chain import Chain
from ident.presets.preset import Preset, RequiredData, SearchPlan
from ident.stages import IDEAL_SENSOR, INSTANT_VALVE, LOWER_LEVEL, OPENED_BY_COMMAND, RIGID_SPOOL, UPPER_LEVEL

TWO_TANKS = Preset(
    name="two_tanks",
    title="Two tanks in series",
    citation=(
        "M. Schoukens, J.-P. Noël: Three benchmarks addressing open challenges in nonlinear system identification. "
        "IFAC-PapersOnLine 50 (2017) 446-451."
    ),
    chain=Chain(
        stages=(OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, UPPER_LEVEL, LOWER_LEVEL, IDEAL_SENSOR),
        outputs={"displacement": "y"},
    ),
    static_gains=("gain",),
    search=SearchPlan(drive_scale="U", relative_ways=True),
    data=RequiredData(one_sided=True),
)
