"""Add the pages to the app: routes, files, errors, compression."""

from __future__ import annotations

import os
from pathlib import Path

from fastapi import FastAPI
from fastapi.staticfiles import StaticFiles
from starlette.responses import Response
from starlette.types import Scope

from app.api.responses import Compression
from app.http import openapi
from app.web.approval import routes as approval
from app.web.audit import routes as audit
from app.web.compare import routes as compare
from app.web.design import actions
from app.web.design import routes as design
from app.web.designs import routes as designs
from app.web.engine_bearings import routes as engine_bearings
from app.web.explanation import routes as explanation
from app.web.faults import routes as faults
from app.web.find_bearing import routes as find_bearing
from app.web.home import routes as home
from app.web.impact import routes as impact
from app.web.lists import columns
from app.web.model import routes as model
from app.web.model_import import routes as model_import
from app.web.new_step import routes as new_step
from app.web.plots import routes as plots
from app.web.report import routes as report
from app.web.revision import routes as revision
from app.web.second_part import routes as second_part
from app.web.shared import problems
from app.web.sign_in import provider
from app.web.sign_in import routes as sign_in
from app.web.solve import routes as solve
from app.web.study import routes as study
from app.web.template import routes as template
from app.web.tolerances import routes as tolerances
from app.web.upgrade import routes as upgrade
from app.web.variants import routes as variants
from app.web.verdict import routes as verdict
from app.web.worksheet import routes as worksheet
from app.web.worksheet_import import routes as worksheet_import

ROUTERS = (
    home.router,
    designs.router,
    model_import.router,  # before the models: `import` is not the id of one
    model_import.forms,
    second_part.router,
    second_part.forms,
    faults.router,  # before the templates: `faults` is not the id of one
    template.router,
    solve.router,
    model.router,
    engine_bearings.router,
    engine_bearings.forms,
    find_bearing.router,
    find_bearing.forms,
    new_step.router,  # before the designs: `new` is not the id of one
    design.router,
    actions.router,
    revision.router,
    compare.router,
    tolerances.router,
    explanation.router,
    report.router,
    approval.router,
    variants.router,
    columns.router,
    verdict.router,
    study.router,
    study.forms,
    worksheet_import.router,  # before the worksheets: `import` is not the id of one
    worksheet_import.forms,
    worksheet.router,
    worksheet.forms,
    sign_in.router,
    sign_in.forms,
    provider.router,
    audit.router,
    impact.router,
    impact.forms,
    upgrade.router,
    upgrade.forms,
    plots.router,  # before the files: Plotly's is in its package
)
FOLDER = Path(__file__).parent
SENT = {".css", ".js", ".svg"}  # suffixes of files that a browser may load


class Files(StaticFiles):
    """Files that a browser caches and revalidates before use, so that it has new ones after an update."""

    def lookup_path(self, path: str) -> tuple[str, os.stat_result | None]:
        """Return the file for a path.

        From a page's folder only style sheets, scripts and pictures are served. A null byte in the path is
        refused, because system calls raise an error for it.
        """
        is_sent = "\0" not in path and Path(path).suffix in SENT
        return super().lookup_path(path) if is_sent else ("", None)

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Return the file, or 304 if the browser already has it."""
        response = super().file_response(full_path, stat_result, scope, status_code)
        response.headers["Cache-Control"] = "no-cache"
        response.headers["X-Content-Type-Options"] = "nosniff"
        return response


def install(app: FastAPI) -> None:
    """Add the pages to the app; call this after the interface is complete."""
    for router in ROUTERS:
        openapi.include(app, router)
    app.mount("/static", Files(directory=FOLDER), name="static")
    problems.install(app)
    app.add_middleware(Compression)
