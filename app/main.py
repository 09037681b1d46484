"""The service put together."""

from __future__ import annotations

import gc
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from importlib.metadata import version
from typing import Any

import uvicorn
from fastapi import APIRouter, Depends, FastAPI
from fastapi.concurrency import run_in_threadpool
from starlette.routing import BaseRoute
from uvicorn.middleware.proxy_headers import ProxyHeadersMiddleware

from app import errors, openapi
from app.access.audit import Audited
from app.access.audited_changes import carry
from app.access.gate import Gate
from app.access.roles import refuse_undeclared
from app.access.token_attempts import TokenAttempts
from app.blobs import open_storage
from app.context import Context
from app.database import connect, migrate, sessions
from app.display import Display
from app.jobs.engine import Jobs
from app.jobs.service import resume
from app.jobs.steps import Runs
from app.kinds import KINDS
from app.lru import LRU
from app.operation.logs import in_json
from app.operation.metrics import Requests
from app.operation.observed import Observed
from app.pages import router as pages
from app.pages.problems import sign_in
from app.processes import Here, WorkerProcesses
from app.request_id import RequestId
from app.security import Guard
from app.settings import Settings
from app.stream.service import LARGEST_MESSAGE
from app.webhooks.courier import Courier
from app.webhooks.hosts import origins
from app.webhooks.openapi_webhooks import told
from app.workers.pulse import Pulse
from ident.parallel import one_thread

API = "/api/v1"
FEATURES = (
    "access",
    "matrices",
    "drafts",
    "limits",
    "verdicts",
    "actuators",
    "search",
    "refits",
    "fits",
    "approvals",
    "annotations",
    "deletions",
    "figures",
    "profiles",
    "diagnoses",
    "jobs",
    "report",
    "parameters",
    "statistics",
    "regress",
    "webhooks",
    "retention",
    "backup",
    "catalogue",
    "own_effects",
    "hybrid",
    "plans",
    "live",
    "stream",
    "workers",
    "operation",
)
"""Folders whose endpoints.py has a `router` of the API."""
_PATIENCE = 5  # s in which what is being answered ends, before the service does
_KEPT = 75  # s that a connection waits for its next request: clients let go after 5, proxies after 60, and first
_TURN = 1e-3  # s after which a figure that is drawn lets an answer take its turn: the interpreter's own are 5
READERS = 2  # uploads that are read at once
WORK = ("app.kinds", "ident.simulation.numba_preload")  # what processes apart have imported when they begin
_OF_EACH: dict[str, Any] = {
    "generate_unique_id_function": openapi.named,
    "dependencies": [Depends(refuse_undeclared)],
}
"""Of each call."""
_documents: LRU[dict[str, Any]] = LRU(1)  # all applications of a process have the same calls, and it takes 2 s to write


def create_app(settings: Settings, apart: bool = False) -> FastAPI:
    """The application; its database is migrated and its queue runs while it is served.

    `apart` has jobs and uploads worked out in processes beside it.
    """
    origins(settings.webhook_hosts)  # before anything is opened: what cannot be a host is refused
    app = routed()
    app.state.context = make_context(settings, apart)
    app.state.tries = TokenAttempts(settings.failures)
    app.state.requests = Requests()
    errors.install(app)
    _surround(app, settings)
    return app


@cache
def _calls() -> tuple[BaseRoute, ...]:
    """The calls and the pages, once a process: what each takes and answers is worked out in 0.1 s."""
    app, api = FastAPI(openapi_url=None, **_OF_EACH), APIRouter(prefix=API)
    for feature in FEATURES:
        api.include_router(import_module(f"app.{feature}.endpoints").router)
    api.include_router(openapi.router)
    app.include_router(api)
    app.include_router(pages)
    return tuple(app.router.routes)


def routed() -> FastAPI:
    """The calls and the pages, of no service yet: enough for their document."""
    app = FastAPI(
        title="servoident",
        version=version("servoident"),
        lifespan=_lifespan,
        openapi_url=None,
        webhooks=told,
        **_OF_EACH,
    )
    app.openapi = partial(_documents.get, app.version, partial(openapi.write, app))  # type: ignore[method-assign]
    app.router.routes.extend(_calls())
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    context: Context = app.state.context
    with one_thread():  # for its life: a job's answer hangs on no page that is drawn meanwhile
        threads = await run_in_threadpool(start, context)
        yield
        await run_in_threadpool(stop, context, threads)


def _surround(app: FastAPI, settings: Settings) -> None:
    """What each request passes on its way in; the last one added is the first that it meets."""
    context = app.state.context
    app.add_middleware(Display)
    app.add_middleware(Audited, context=context)
    app.add_middleware(Gate, context=context, tries=app.state.tries, sign_in=sign_in)
    app.add_middleware(Guard, settings=settings)
    app.add_middleware(Observed, requests=app.state.requests)
    app.add_middleware(RequestId)
    if settings.proxies:
        app.add_middleware(ProxyHeadersMiddleware, trusted_hosts=list(settings.proxies))


@dataclass(frozen=True)
class Threads:
    """What goes on beside requests and jobs: the pulse, and the courier of webhooks."""

    pulse: Pulse
    courier: Courier


def start(context: Context) -> Threads:
    """Begin to work on jobs."""
    context.storage.tidy()
    pulse = Pulse(context.sessions, context.settings.executor, context.jobs)
    pulse.start()
    context.jobs.launch()
    resume(context)
    courier = Courier(context.sessions, context.settings)
    courier.start()
    return Threads(pulse, courier)


def stop(context: Context, threads: Threads) -> None:
    """Let go of what runs, and end."""
    context.worker.stop()
    context.jobs.stop()
    context.readers.stop()
    threads.courier.stop()
    threads.pulse.stop()
    context.engine.dispose()


def make_context(settings: Settings, apart: bool = False) -> Context:
    """Folders, database and queue of a service that is not serving yet.

    Where others wait for answers, jobs and the reading of uploads go to processes `apart`.
    """
    settings.make_folders()
    migrate(settings.database)
    engine = connect(settings.database)
    makers, storage = sessions(engine), open_storage(settings)
    carry(makers)
    worker, readers = (WorkerProcesses(1, *WORK), WorkerProcesses(READERS, *WORK)) if apart else (Here(), Here())
    runs = Runs(makers, storage, settings.executor, *KINDS, place=worker)
    return Context(settings, engine, makers, storage, Jobs(settings, runs), readers, worker)


def run(settings: Settings) -> None:
    """Serve until interrupted."""
    sys.setswitchinterval(_TURN)
    if settings.log == "json":
        in_json()
    app = create_app(settings, apart=True)
    gc.freeze()  # 300,000 objects that stay: every look through them held all answers up for 0.15 s
    uvicorn.run(
        app,
        host=settings.host,
        port=settings.port,
        log_level="warning",
        timeout_graceful_shutdown=_PATIENCE,
        timeout_keep_alive=_KEPT,
        log_config=None if settings.log == "json" else uvicorn.config.LOGGING_CONFIG,
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        proxy_headers=False,
    )
