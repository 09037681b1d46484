"""A hybrid simulation as the work of a job: in one piece, which a kill makes run again from its beginning."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from sqlalchemy.orm import Session

from app.hybrid import repository
from app.hybrid.controller_lookup import controller_of
from app.hybrid.coupled_simulation import simulated
from app.hybrid.earlier_loop import earlier_case
from app.hybrid.records import packed, packed_parts
from app.hybrid.request_parsing import AskedCase
from app.hybrid.service import KIND
from app.hybrid.spread import kept
from app.jobs.work import InOnePiece, Kind, State, Task
from app.tables import JobRow
from ident.fit.result import FitResult
from ident.hybrid.controller import SampledController
from ident.hybrid.controller_lookup import FEEDFORWARD
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.drawn_simulations import drawn_simulations
from ident.hybrid.feedforward_tracking import followed_in
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.share_map import share_map
from ident.hybrid.specimen_effects import wanted_in
from ident.plain import read
from ident.run import Specimen

WITHOUT = "no controller"


class HybridWork(InOnePiece):
    """A simulation, the same without a controller, the map where it is asked for, a feedforward's worth."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
        """What `servoident hybrid` writes, and the displacements for its figures."""
        asked, report, fit = self.task.settings["asked"], self.task.report, self.task.fit
        case = AskedCase(asked["case"], asked["ground"], self._blob(asked["text"])).system()
        assert fit is not None
        if isinstance(case, CoupledCase):
            return self._parts(asked, fit, case)
        moved = asked.get("moved")
        fit = self._fit(moved["fit"]) if moved else fit
        given: Any = json.loads(self._blob(asked["controller"])) if asked["inline"] else asked["controller"]
        effects, isolator = asked["effects"], read(Specimen, asked["isolator"]) if asked.get("isolator") else None
        known, case = case, case if isolator is None else case.with_isolator(isolator)
        chosen = controller_of(given, fit, known, wanted_in(fit, case, effects) if given == FEEDFORWARD else None)
        before = earlier_case(asked.get("before"), fit, case, self._fit)
        main = simulate_hybrid(fit, case, chosen, effects, report, before)
        main = replace(main, notes=(*moved["notes"], *main.notes)) if moved else main
        alone = None if given == "none" else simulate_hybrid(fit, case, None, effects, report)
        mapped = None
        if asked["map"] and isinstance(chosen, SampledController):
            mapped = share_map(fit, case, chosen, effects, report=report)
        spread, drawn = kept(asked.get("spread")), None
        ahead = given == FEEDFORWARD and known.table is None
        worth = followed_in(fit, known, spread=spread, isolator=isolator) if ahead else None
        if spread is not None and isinstance(chosen, SampledController):
            drawn = drawn_simulations(fit, case, chosen, effects, spread, report=report)
        runs = {main.controller: main} | ({WITHOUT: alone} if alone else {})
        return {
            "result": main.to_json(),
            "without": alone.to_json() if alone else None,
            "map": mapped.to_json() if mapped else None,
            "feedforward": worth.to_json() if worth else None,
            "spread": drawn.to_json() if drawn else None,
            "records": base64.b85encode(packed(runs)).decode(),
        }

    def _parts(self, asked: Mapping[str, Any], fit: FitResult, case: CoupledCase) -> State:
        """The same of several actuators."""
        main, alone, drawn = simulated(asked, fit, case, self._blob, self.task.report)
        return {
            "result": main.to_json(),
            "without": alone.to_json() if alone else None,
            "map": None,
            "spread": drawn.to_json() if drawn else None,
            "records": base64.b85encode(packed_parts(main.parts, alone.parts if alone else None)).decode(),
        }

    def _fit(self, name: str) -> FitResult:
        return FitResult.from_json(json.loads(self._blob(name)))

    def _blob(self, name: str) -> str:
        return self.task.storage.path(name).read_text(encoding="utf-8") if name else ""


_KEPT = ("result", "without", "map", "feedforward", "spread")


def _keep(session: Session, job: JobRow, serial: str, made: State) -> None:
    if repository.simulation(session, job.id) is None:
        result: State = {name: made[name] for name in _KEPT if name in made}
        repository.add_simulation(session, job, serial, result, base64.b85decode(made["records"]))


HYBRID = Kind(KIND, HybridWork, _keep)
