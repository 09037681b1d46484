"""The simplified model of an aviation servo-actuator of Kononykhin (2019), section 4, Fig. 1."""

from ident.chain.chain import Chain
from ident.presets.preset import Display, Preset, RequiredData, SearchPlan
from ident.stages.bench import LAG, OPEN_LOOP, PLAY, RIGID_TRANSDUCER, SPEED_CHARACTERISTIC, UNLOADED_SPEED

KONONYKHIN = Preset(
    name="kononykhin",
    title="Aviation servo-actuator: lag, play, speed characteristic, load",
    citation=(
        "E. Kononykhin: Development of procedures for determining the parameters of an aircraft servo actuator. "
        "Eastern-European Journal of Enterprise Technologies (2019)."
    ),
    chain=Chain(
        stages=(OPEN_LOOP, LAG, PLAY, SPEED_CHARACTERISTIC, UNLOADED_SPEED, RIGID_TRANSDUCER),
        outputs={"displacement": "y", "load_pressure": "P"},
    ),
    listed=("T", "B", "I0", "kp", "dPfr"),
    kind="bench",
    notes=(
        "The second derivative in the printed formula of block a is a misprint: the text says an aperiodic link, "
        "T I' + I = Iin. Currents are in rated currents; Ps is the supply pressure of the actuator.",
        "Block d is not in the paper's text. Read here: the pressure difference available at the current behind the "
        "play is clip(kp (I − I0), −Ps, Ps), the load needs F/Sp + ΔPfr sgn V, and the speed is f times "
        "sqrt(max(0, 1 − needed/available)). f is the characteristic without load and friction.",
    ),
    search=SearchPlan(
        methods=("gradient",),
        options={"population": 80.0, "generations": 40.0, "elite": 8.0},
    ),
    data=RequiredData(
        driven_by="current",
    ),
    display=Display(
        figures=(
            "time",
            "evolution",
            "pressure-loop",
            "frequency-characteristics",
            "speed-characteristic",
            "acceptance-sheet",
        ),
    ),
)
