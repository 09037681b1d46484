"""The service put together."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib import import_module
from importlib.metadata import version

import uvicorn
from fastapi import APIRouter, FastAPI
from fastapi.concurrency import run_in_threadpool

from app import errors
from app.context import Context
from app.database import connect, migrate, sessions
from app.diagnoses.work import DIAGNOSIS
from app.fits.work import FIT
from app.hybrid.work import HYBRID
from app.jobs.engine import Jobs
from app.jobs.service import resume
from app.jobs.steps import GuardedSteps
from app.pages import router as pages
from app.security import Guard
from app.settings import Settings
from app.storage import Storage
from app.stream.service import LARGEST_MESSAGE
from ident.parallel import one_thread

API = "/api/v1"
FEATURES = (
    "matrices",
    "actuators",
    "fits",
    "diagnoses",
    "jobs",
    "report",
    "parameters",
    "catalogue",
    "own_effects",
    "hybrid",
    "stream",
    "operation",
)
"""Folders whose endpoints.py has a `router` of the API."""


def create_app(settings: Settings) -> FastAPI:
    """The application; its database is migrated and its queue runs while it is served."""

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        context: Context = app.state.context
        with one_thread():  # for its life: a job's answer hangs on no page that is drawn meanwhile
            await run_in_threadpool(_start, context)
            yield
            await run_in_threadpool(_stop, context)

    app = FastAPI(
        title="servoident", version=version("servoident"), lifespan=lifespan, docs_url=None, redoc_url=None,
        openapi_url=f"{API}/openapi.json",
    )  # fmt: skip
    app.state.context = make_context(settings)
    errors.install(app)
    api = APIRouter(prefix=API)
    for feature in FEATURES:
        api.include_router(import_module(f"app.{feature}.endpoints").router)
    app.include_router(api)
    app.include_router(pages)
    app.add_middleware(Guard, settings=settings)
    return app


def _start(context: Context) -> None:
    context.storage.tidy()
    context.jobs.launch()
    resume(context)


def _stop(context: Context) -> None:
    context.jobs.stop()
    context.engine.dispose()


def make_context(settings: Settings) -> Context:
    """Folders, database and queue of a service that is not serving yet."""
    settings.make_folders()
    migrate(settings.database)
    engine = connect(settings.database)
    makers, storage = sessions(engine), Storage(settings.data / "blobs")
    steps = GuardedSteps(makers, storage, FIT, DIAGNOSIS, HYBRID)
    return Context(settings, engine, makers, storage, Jobs(settings, steps))


def run(settings: Settings) -> None:
    """Serve until interrupted."""
    app = create_app(settings)
    uvicorn.run(
        app, host=settings.host, port=settings.port, log_level="warning", timeout_graceful_shutdown=2,
        ws_max_size=LARGEST_MESSAGE, ws_per_message_deflate=False,
    )  # fmt: skip
