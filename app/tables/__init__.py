"""The tables: records, jobs, parameter sets, the line's limits, findings, access, webhooks."""

from app.tables.access import AnswerRow, AuditRow, DisplayUnitsRow, SessionRow, TokenRow
from app.tables.base import Base, before, now
from app.tables.findings import AnnotationRow, ControllerRow, DiagnosisRow, HybridRow, OwnEffectRow, PlanRow, ProfileRow
from app.tables.jobs import JobRow, TallyRow, WorkerRow
from app.tables.line import LimitRow, RecheckRow, RegressionRow
from app.tables.records import ActuatorRow, MatrixRow
from app.tables.sets import ApprovalRow, EvolutionRow, FitRow, SetRow, ValueRow
from app.tables.webhooks import DeliveryRow, WebhookRow

__all__ = [
    "ActuatorRow", "AnnotationRow", "AnswerRow", "ApprovalRow", "AuditRow", "Base", "ControllerRow", "DeliveryRow",
    "DiagnosisRow", "DisplayUnitsRow", "EvolutionRow", "FitRow", "HybridRow", "JobRow", "LimitRow", "MatrixRow",
    "OwnEffectRow", "PlanRow", "ProfileRow", "RecheckRow", "RegressionRow", "SessionRow", "SetRow", "TallyRow",
    "TokenRow", "ValueRow", "WebhookRow", "WorkerRow", "before", "now",
]  # fmt: skip
