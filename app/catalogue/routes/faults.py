"""`/catalogue/faults`: the faults of the files of a team's templates and models."""

from __future__ import annotations

from dataclasses import asdict

from fastapi import APIRouter

from app.api.dependencies import TheCatalogues
from app.catalogue.schemas.faults import FaultList, FaultyFile, FileFault
from app.catalogue.team import TeamFile
from app.http.pages import Cursor, Limit, page_of
from app.http.strict_requests import StrictRoute

router = APIRouter(prefix="/api/v1/catalogue", tags=["templates"], route_class=StrictRoute)


@router.get("/faults")
def list_catalogue_faults(catalogues: TheCatalogues, limit: Limit = 100, cursor: Cursor = None) -> FaultList:
    """Return every file with faults in a team's folders; quarantined files are not used."""
    faulty = [file for file in catalogues.snapshot.files if file.faults]
    return page_of(FaultList, faulty, limit, cursor, _shown)


def _shown(file: TeamFile) -> FaultyFile:
    id, version = file.key or (None, None)
    return FaultyFile(
        file=file.name,
        id=id,
        version=version,
        quarantined=file.is_quarantined,
        digest=file.digest,
        faults=[FileFault(**asdict(fault)) for fault in file.faults],
    )
