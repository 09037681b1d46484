"""Every kind of job that there is."""

from __future__ import annotations

from app.diagnoses.work import DIAGNOSIS
from app.fits.work import FIT
from app.hybrid.work import HYBRID
from app.plans.work import PLAN
from app.profiles.work import PROFILE
from app.regress.work import RECHECK

KINDS = (FIT, DIAGNOSIS, HYBRID, RECHECK, PROFILE, PLAN)
