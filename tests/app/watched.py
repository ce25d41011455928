"""A server that only runs jobs, in a separate process that tests can stop; tests run it in a fork."""

import sys
from contextlib import asynccontextmanager
from types import SimpleNamespace

import uvicorn
from fastapi import FastAPI

from app.catalogue.catalogues import Catalogues
from app.http.server import on_stop_signal
from app.http.streams import Streams
from app.jobs.routes import router
from app.jobs.service import Jobs
from app.settings import Settings
from app.storage.database import Database
from app.workers.inline import Inline
from cad.catalogue import models
from templates.door import built_in


def serve_jobs(url: str, listener: int) -> None:
    """Serve the jobs of a database on a socket that listens, and say in the end that it stopped in order."""

    @asynccontextmanager
    async def lifespan(app):
        database = Database(url)
        jobs = Jobs(database, Inline(), Settings(), lambda error: {})
        app.state.services = SimpleNamespace(
            jobs=jobs, streams=Streams(most=5, most_of_client=5), catalogues=Catalogues(built_in(), models())
        )
        with on_stop_signal(jobs.drain):
            yield
        jobs.stop()
        database.close()
        sys.stderr.write("stopped in order\n")

    app = FastAPI(lifespan=lifespan)
    app.include_router(router)
    uvicorn.run(app, fd=listener, log_level="warning")
