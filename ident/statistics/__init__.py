"""Values of one quantity in, what they tell of a process out: spread, control, capability, drift, dependence."""

from ident.statistics.capability import FEWEST_SETS, Capability, capability, outside, withheld
from ident.statistics.condition_law import FEWEST_FOR_LAW, Change, ConditionLaw, Level, condition_laws
from ident.statistics.control_chart import ControlChart, Signal, control_chart
from ident.statistics.drift import Drift, drift
from ident.statistics.outliers import Outlier, outliers
from ident.statistics.summary import Summary, summary

__all__ = [
    "FEWEST_FOR_LAW", "FEWEST_SETS", "Capability", "Change", "ConditionLaw", "ControlChart", "Drift", "Level",
    "Outlier", "Signal", "Summary", "capability", "condition_laws", "control_chart", "drift", "outliers", "outside",
    "summary", "withheld",
]  # fmt: skip
