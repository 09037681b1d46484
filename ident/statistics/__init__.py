"""Values of one quantity in, what they tell of a process out: spread, control, capability, drift."""

from ident.statistics.capability import FEWEST_SETS, Capability, capability, outside, withheld
from ident.statistics.control_chart import ControlChart, Signal, control_chart
from ident.statistics.drift import Drift, drift
from ident.statistics.outliers import Outlier, outliers
from ident.statistics.summary import Summary, summary

__all__ = [
    "FEWEST_SETS", "Capability", "ControlChart", "Drift", "Outlier", "Signal", "Summary", "capability", "control_chart",
    "drift", "outliers", "outside", "summary", "withheld",
]  # fmt: skip
