"""/fits/…/annotation: name, tags and note of a fit."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.caller import Me
from app.access.roles import LAB, READERS
from app.annotations import service
from app.context import Here
from app.errors import COMMON
from schemas.annotation import AnnotationRequest, AnnotationView

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.get("/{fit}/annotation", dependencies=[READERS])
def get_annotation(here: Here, fit: str) -> AnnotationView:
    """The name, the tags and the note that people wrote on a fit; empty if there are none."""
    return service.get(here, fit)


@router.put("/{fit}/annotation", dependencies=[LAB])
def put_annotation(here: Here, me: Me, fit: str, annotation: AnnotationRequest) -> AnnotationView:
    """Write a name, tags and a note on a fit; they replace those before. Results and approvals do not change."""
    return service.put(here, fit, annotation, me.name)
