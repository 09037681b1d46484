"""Values of one quantity in, what they tell of a process out: spread, control, capability, drift."""

from ident.statistics.capability import Capability, capability
from ident.statistics.control_chart import ControlChart, Signal, control_chart
from ident.statistics.drift import Drift, drift
from ident.statistics.outliers import Outlier, outliers
from ident.statistics.summary import Summary, summary

__all__ = [
    "Capability", "ControlChart", "Drift", "Outlier", "Signal", "Summary", "capability", "control_chart", "drift",
    "outliers", "summary",
]  # fmt: skip
