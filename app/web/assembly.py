"""The pages as a part of the app: routes, files, errors, compression."""

from __future__ import annotations

import os
import re
from pathlib import Path

from fastapi import FastAPI
from fastapi.staticfiles import StaticFiles
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web import (
    actions,
    approval_page,
    assembly_page,
    impact_page,
    import_page,
    model_import_page,
    problems,
    provider_page,
    routes,
    sign_in,
    study_routes,
    table_columns,
    upgrade_page,
    variant_forms,
    worksheet_routes,
)

STATIC = Path(__file__).with_name("static")
SMALLEST, LEVEL = 1000, 6  # of what is compressed [bytes], and how hard
PLAIN = ("/events", "/evaluate", ".png", ".step")
"""Ends of paths that are sent as they are: streams, short answers, what is compressed already."""
CALCULATED = re.compile("/api/v1/(evaluations/.*|templates/.*/worksheet)")
"""Paths of answers that may be large: to compress 256 kB holds the event loop for some 10 ms."""


class Files(StaticFiles):
    """Files that a browser keeps, and asks about before it uses them: after an update it has the new ones."""

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        """Return the file of a path; the system's calls raise on a null byte instead of finding nothing."""
        return ("", None) if "\0" in path else super().lookup_path(path)

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Return the file, or that it is still the same."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = "no-cache"
        response.headers["X-Content-Type-Options"] = "nosniff"
        return response


class Compression:
    """ASGI middleware that compresses pages and answers, but no stream."""

    def __init__(self, app: ASGIApp) -> None:
        self.app, self.compressed = app, GZipMiddleware(app, minimum_size=SMALLEST, compresslevel=LEVEL)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, compressed or not."""
        is_plain = scope["type"] != "http" or _is_plain(scope["path"])
        await (self.app if is_plain else self.compressed)(scope, receive, send)


def _is_plain(path: str) -> bool:
    return path.endswith(PLAIN) or CALCULATED.fullmatch(path) is not None


def install(app: FastAPI) -> None:
    """Add the pages; call it after the interface is complete."""
    app.include_router(model_import_page.router)  # before the models: `import` is not one
    app.include_router(model_import_page.forms)
    app.include_router(assembly_page.router)
    app.include_router(assembly_page.forms)
    app.include_router(routes.router)
    app.include_router(actions.router)
    app.include_router(approval_page.router)
    app.include_router(variant_forms.router)
    app.include_router(table_columns.router)
    app.include_router(study_routes.router)
    app.include_router(study_routes.forms)
    app.include_router(import_page.router)  # before the worksheets: `import` is not an id of one
    app.include_router(import_page.forms)
    app.include_router(worksheet_routes.router)
    app.include_router(worksheet_routes.forms)
    app.include_router(sign_in.router)
    app.include_router(sign_in.forms)
    app.include_router(provider_page.router)
    for pages in (impact_page, upgrade_page):
        app.include_router(pages.router)
        app.include_router(pages.forms)
    app.mount("/static", Files(directory=STATIC), name="static")
    problems.install(app)
    app.add_middleware(Compression)
