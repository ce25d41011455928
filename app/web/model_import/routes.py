"""The page for importing a model, which also lists the available drawing programs."""

from __future__ import annotations

import re

from fastapi import APIRouter, Depends, Request, Response

from app.http.uploads import UploadRoute
from app.imported_models.routes import FileName, NewId, list_programs
from app.web.shared.file_form import FileForm, Upload
from app.web.shared.multipart import forms_with_files
from app.web.shared.paths import Text
from app.web.shared.services import PageServices, ThePageServices

_VERSION = re.compile(r"/api/v1/models/([a-z0-9_]+)/versions/([0-9]+)")


class NewModel(Upload):
    """The id of a model to import, and the name of its file."""

    id: NewId
    file: FileName = "model"


def imported_version(result: str) -> tuple[str, int] | None:
    """Return the id and version of the imported model from the result of its job."""
    version = _VERSION.fullmatch(result)
    return version and (version[1], int(version[2]))


def _address(result: str) -> str | None:
    version = imported_version(result)
    return version and f"/models/{version[0]}/{version[1]}"


async def _programs(services: PageServices) -> dict[str, object]:
    return {"programs": (await services.run(list_programs, services.model_imports)).items}


FORM = FileForm(
    "/models/import",
    "model_import/model_import.html",
    "a .FCStd of FreeCAD, or a STEP file",
    NewModel,
    lambda services: services.model_imports.begin,
    _address,
    _programs,
)
router = APIRouter(include_in_schema=False)
forms = APIRouter(include_in_schema=False, route_class=UploadRoute, dependencies=[Depends(forms_with_files)])


@router.get(FORM.path)
async def model_import_form(
    request: Request, services: ThePageServices, job: Text = "", id: Text = ""
) -> Response:
    """Return the form for a file, the progress of its job, or the resulting model or refusal."""
    return await FORM.show(request, services, job, id)


@forms.post(FORM.path)
async def import_model_file(request: Request, services: ThePageServices) -> Response:
    """Import the chosen file; if it is refused at once, return the form with the reason."""
    return await FORM.send(request, services)
