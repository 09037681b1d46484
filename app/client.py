"""The service from Python, for a notebook or a line's script: upload, fit, wait, diagnose, draw, approve, query.

    from app.client import Client

    lab = Client("http://bench-pc:8000", token="…")
    matrix = lab.upload("bench/SW-117")
    fit = lab.fit(matrix.id, report=lambda job: print(job.progress.stage, job.progress.done))
    found = lab.diagnose(fit=fit.id)
    lab.approve(fit.id)

It needs httpx and the contract's models and nothing else of the service or the library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any
from urllib.parse import quote, urlsplit
from uuid import uuid4

import httpx

from schemas.annotation import AnnotationView
from schemas.deletion import DeletionView
from schemas.diagnosis import DiagnosisRequest, DiagnosisView
from schemas.draft import DraftView
from schemas.fit import ComparisonView, FitRequest, FitView, JobView
from schemas.limits import LimitsView, LineVerdictView
from schemas.matrix import MatrixView
from schemas.parameters import ActuatorDetail, ApprovalView, ParameterSetPage, ParameterSetView
from schemas.problem import Problem
from schemas.search import SearchView
from schemas.statistics import StatisticsView

Watch = Callable[[JobView], None]
PATIENCE = 60.0  # s without an answer
_ENDED = ("succeeded", "failed", "cancelled")
_LOST = 5  # times that a stream of events may break off without having told anything new


def without_number(error: Exception) -> str:
    """What a system says of a failure: "[Errno 111] Connection refused" without its number."""
    return str(error).rpartition("] ")[2]


def start_command(server: str) -> str:
    """The command that starts a service at an address, and the machine to type it on."""
    try:
        at = urlsplit(server)
        host, port = at.hostname, at.port
    except ValueError:
        host, port = None, None
    command = f"`servoident serve --port {port}`" if port else "`servoident serve`"
    if host is None:
        return command
    return f"{command} on this machine" if host in _HERE else f"{command} on {host}"


_HERE = ("127.0.0.1", "localhost", "::1")


@dataclass
class Refused(Exception):
    """What the service refuses, or why a job failed: what is wrong, where, and the remedy."""

    code: str
    what: str
    where: str = ""
    remedy: str = ""

    def __str__(self) -> str:
        return "; ".join(part for part in (": ".join(p for p in (self.where, self.what) if p), self.remedy) if part)


class Client:
    """A service at an address. Raises Refused for what it refuses and where there is no answer.

    Every POST carries an idempotency key of its own. `http` is a client of one's own, with its proxies or certificates.
    """

    def __init__(
        self, server: str = "http://127.0.0.1:8000", token: str = "", http: httpx.Client | None = None
    ) -> None:
        self.server = server.rstrip("/")
        self.http = http or httpx.Client(timeout=PATIENCE)
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.http.close()

    def upload(self, matrix: Path | str) -> MatrixView:
        """Send a .zip, or a folder: its matrix.yaml with the files below it. The same bytes again: the same matrix."""
        path = Path(matrix)
        described = path.is_dir() or path.name == "matrix.yaml"
        files = _below(path if path.is_dir() else path.parent) if described else {path.name: path}
        with ExitStack() as stack:
            parts = [("files", (name, stack.enter_context(file.open("rb")))) for name, file in files.items()]
            return MatrixView.model_validate_json(self.request("POST", "/matrices", files=parts).content)

    def matrix(self, matrix: str) -> MatrixView:
        """A matrix by its id, with what the check found."""
        return MatrixView.model_validate_json(self.request("GET", f"/matrices/{matrix}").content)

    def fit(self, matrix: str, report: Watch | None = None, **chosen: Any) -> FitView:
        """Fit a matrix and wait for it; `chosen` as the fields of :class:`schemas.fit.FitRequest`."""
        asked = FitRequest(matrix=matrix, **chosen).model_dump(exclude_unset=True)
        return self.fit_called(self._done("/fits", asked, report).fit)

    def add_effects(self, fit: str, *effects: str, report: Watch | None = None) -> FitView:
        """Add effects to a fit and fit again: a new fit whose parent is this one."""
        return self.fit_called(self._done(f"/fits/{fit}/effects", {"effects": list(effects)}, report).fit)

    def fit_called(self, fit: str | None) -> FitView:
        """A fit by its id."""
        return FitView.model_validate_json(self.request("GET", f"/fits/{fit}").content)

    def compare(self, fit: str) -> ComparisonView:
        """A fit against every run of its matrix."""
        return ComparisonView.model_validate_json(self.request("GET", f"/fits/{fit}/compare").content)

    def diagnose(self, report: Watch | None = None, **chosen: Any) -> DiagnosisView:
        """Find what a fit lacks and wait for it: `fit` or `matrix`, as :class:`schemas.diagnosis.DiagnosisRequest`."""
        job = self._done("/diagnoses", DiagnosisRequest(**chosen).model_dump(exclude_unset=True), report)
        return DiagnosisView.model_validate_json(self.request("GET", f"/diagnoses/{job.diagnosis}").content)

    def next_run(self, diagnosis: str) -> bytes:
        """The experiment that a diagnosis proposes, as a .zip of its command signals."""
        return self.request("GET", f"/diagnoses/{diagnosis}/next-experiment").content

    def figure(self, fit: str, name: str, kind: str = "svg", **options: Any) -> bytes:
        """A figure of a fit as json (Vega-Lite), svg, png or pdf."""
        return self.request("GET", f"/fits/{fit}/figures/{name}.{kind}", params=options).content

    def approve(self, fit: str, why: str = "") -> FitView:
        """Make a fit the current parameter set of its serial number."""
        return FitView.model_validate_json(self.request("POST", f"/fits/{fit}/approve", json={"why": why}).content)

    def annotate(self, fit: str, name: str = "", tags: Sequence[str] = (), note: str = "") -> AnnotationView:
        """Write a name, tags and a note on a fit, in the place of those before."""
        written = {"name": name, "tags": list(tags), "note": note}
        return AnnotationView.model_validate_json(self.request("PUT", f"/fits/{fit}/annotation", json=written).content)

    def delete_fit(self, fit: str) -> DeletionView:
        """Delete a fit and all that was made of it; what something else uses is refused."""
        return DeletionView.model_validate_json(self.request("DELETE", f"/fits/{fit}").content)

    def withdraw(self, fit: str, why: str = "") -> FitView:
        """Take a fit out of force: its serial number has no current set until one is approved."""
        return FitView.model_validate_json(self.request("POST", f"/fits/{fit}/withdraw", json={"why": why}).content)

    def search(self, text: str) -> SearchView:
        """Actuators, data sets and fits that hold a text."""
        return SearchView.model_validate_json(self.request("GET", "/search", params={"q": text}).content)

    def actuator(self, serial: str) -> ActuatorDetail:
        """An actuator with its set in force, and every approval and withdrawal, the newest first."""
        return ActuatorDetail.model_validate_json(self.request("GET", f"/actuators/{_segment(serial)}").content)

    def approvals(self, serial: str) -> list[ApprovalView]:
        """Every approval and withdrawal of a serial number, the newest first: fit, since, until, who, why."""
        return self.actuator(serial).approvals

    def verdict(self, serial: str) -> LineVerdictView:
        """Pass, fail or unknown, with the reasons: the approved set against the limits of its model and batch."""
        answer = self.request("GET", f"/actuators/{_segment(serial)}/verdict")
        return LineVerdictView.model_validate_json(answer.content)

    def limits(self, model: str) -> LimitsView:
        """The limits of a model, of all batches and of each that has its own."""
        return LimitsView.model_validate_json(self.request("GET", f"/limits/{_segment(model)}").content)

    def set_limits(self, model: str, limits: Mapping[str, Mapping[str, Any]], batch: str = "") -> LimitsView:
        """Set all limits of a model for a batch, or for all: `{"tau": {"upper": 4, "unit": "ms"}}`."""
        asked = {"batch": batch, "limits": {name: dict(limit) for name, limit in limits.items()}}
        return LimitsView.model_validate_json(self.request("PUT", f"/limits/{_segment(model)}", json=asked).content)

    def statistics(self, parameter: str, **wanted: str) -> StatisticsView:
        """Mean, control chart, capability, outliers and drift of a parameter: of a `batch`, a `serial`, a `model`."""
        answer = self.request("GET", "/statistics", params={"parameter": parameter, **wanted})
        return StatisticsView.model_validate_json(answer.content)

    def draft(self, *files: Path | str) -> DraftView:
        """Send raw files, a run each: their columns, what they state, and what has still to be said."""
        with ExitStack() as stack:
            paths = [Path(file) for file in files]
            parts = [("files", (path.name, stack.enter_context(path.open("rb")))) for path in paths]
            return DraftView.model_validate_json(self.request("POST", "/drafts", files=parts).content)

    def answer_draft(self, draft: str, **answers: Any) -> DraftView:
        """What is missing with these answers, as :class:`schemas.draft.AnswersRequest`; nothing of them is kept."""
        answer = self.request("POST", f"/drafts/{_segment(draft)}", json=answers)
        return DraftView.model_validate_json(answer.content)

    def matrix_of_draft(self, draft: str, **answers: Any) -> MatrixView:
        """Create the data set of a draft with these answers. The draft is deleted."""
        answer = self.request("POST", f"/drafts/{_segment(draft)}/matrix", json=answers)
        return MatrixView.model_validate_json(answer.content)

    def backup(self, file: Path | str) -> int:
        """Write all records and raw uploads of the service to a file, as its admin; its size in bytes."""
        patience = httpx.Timeout(PATIENCE, read=None)  # it is made before its first byte comes
        to = f"{self.server}/api/v1/backups"
        with self.http.stream("POST", to, headers=self._headers, timeout=patience) as answer:
            if answer.is_error:
                answer.read()
                raise _refusal(answer)
            return received(answer, Path(file))

    def query(self, **wanted: Any) -> Iterator[ParameterSetView]:
        """Parameter sets, newest first: serial, batch, model, current, and {"Z0.min": 2e-6} bounds of parameters."""
        cursor: dict[str, str] = {}
        while True:
            page = ParameterSetPage.model_validate_json(
                self.request("GET", "/parameter-sets", params={**wanted, **cursor}).content
            )
            yield from page.items
            if page.next is None:
                return
            cursor = {"cursor": page.next}

    def wait(self, job: str, report: Watch | None = None) -> JobView:
        """Follow a job to its end; `report` hears of it as it goes on. A stream that breaks off is taken up again.

        Raises Refused where the job failed or was cancelled.
        """
        seen, lost = "", 0
        while lost < _LOST:
            before = seen
            try:
                for sequence, now in self._events(job, before):
                    seen = sequence
                    if report is not None:
                        report(now)
                    if now.state in _ENDED:
                        return _succeeded(now)
            except httpx.TransportError:
                pass
            lost = lost + 1 if seen == before else 0
        return _succeeded(JobView.model_validate_json(self.request("GET", f"/jobs/{job}").content))

    def request(self, method: str, path: str, **content: Any) -> httpx.Response:
        """The answer to one request, of which `path` stands below /api/v1. Raises Refused."""
        headers = self._headers | ({"Idempotency-Key": str(uuid4())} if method == "POST" else {})
        try:
            answer = self.http.request(method, f"{self.server}/api/v1{path}", headers=headers, **content)
        except (httpx.HTTPError, httpx.InvalidURL) as error:
            reason, command = without_number(error), start_command(self.server)
            remedy = f"start it with {command}, or give its address"
            raise Refused("no-service", f"no answer from the service ({reason})", self.server, remedy) from None
        if answer.is_error:
            raise _refusal(answer)
        return answer

    def _done(self, path: str, body: dict[str, Any], report: Watch | None) -> JobView:
        """The job of a request, once it has ended."""
        return self.wait(JobView.model_validate_json(self.request("POST", path, json=body).content).id, report)

    def _events(self, job: str, seen: str) -> Iterator[tuple[str, JobView]]:
        headers = self._headers | ({"Last-Event-ID": seen} if seen else {})
        with self.http.stream("GET", f"{self.server}/api/v1/jobs/{job}/events", headers=headers) as answer:
            if answer.is_error:
                answer.read()
                raise _refusal(answer)
            for line in answer.iter_lines():
                name, _, text = line.partition(": ")
                if name == "id":
                    seen = text
                elif name == "data":
                    yield seen, JobView.model_validate_json(text)


def _segment(name: str) -> str:
    """A name as one part of a path, whatever signs it holds."""
    return quote(name, safe="")


def _below(folder: Path) -> Mapping[str, Path]:
    """The files of a matrix folder by their names inside it; hidden ones and links stay."""
    found = {path.relative_to(folder): path for path in sorted(folder.rglob("*")) if path.is_file()}
    if Path("matrix.yaml") not in found:
        raise Refused("missing-file", "there is no matrix.yaml", str(folder), "name a matrix folder, or a .zip of one")
    kept = {name: path for name, path in found.items() if not path.is_symlink()}
    return {name.as_posix(): path for name, path in kept.items() if not any(part[0] == "." for part in name.parts)}


def _succeeded(job: JobView) -> JobView:
    """A job that has ended. Raises Refused with why it failed."""
    if job.state == "succeeded":
        return job
    problem = job.problem
    if problem is None:
        raise Refused(job.state, f"the {job.kind} is {job.state}", f"job {job.id}")
    raise Refused(problem.code, problem.detail, problem.where, problem.remedy)


def received(answer: httpx.Response, file: Path) -> int:
    """Write the body of an answer to a file as it comes, whole or not at all; its size in bytes."""
    part = file.with_name(f".{file.name}.part")
    try:
        with part.open("wb") as content:
            for chunk in answer.iter_bytes():
                content.write(chunk)
        return part.replace(file).stat().st_size
    finally:
        part.unlink(missing_ok=True)


def _refusal(answer: httpx.Response) -> Refused:
    """The problem document of an answer as the error it is."""
    try:
        problem = Problem.model_validate_json(answer.content)
    except ValueError:
        what = f"it answered {answer.status_code} {answer.reason_phrase}"
        return Refused("no-service", what, str(answer.request.url), "give the address of a servoident service")
    return Refused(problem.code, problem.detail, problem.where, problem.remedy)
