"""A specimen that is moved, without a loop and without a command: speed in, force out."""

from ident.chain.chain import Chain
from ident.presets.preset import Combined, Preset, RequiredData, SearchPlan
from ident.stages.specimen import MOVED_SPECIMEN

SPECIMEN = Preset(
    name="specimen",
    title="Specimen: prescribed motion to force",
    citation="Spring, damper and mass in parallel; dry friction and hysteresis as effects.",
    chain=Chain(stages=(MOVED_SPECIMEN,), outputs={"force": "F"}),
    combinations=(
        Combined("kS / cS", "1/s", "corner from which the damper outweighs the spring"),
        Combined("cS / mS", "1/s", "corner from which the mass outweighs the damper"),
    ),
    search=SearchPlan(
        force_scale="4*X",
        relative_ways=True,
    ),
    data=RequiredData(
        driven_by="velocity",
    ),
)
