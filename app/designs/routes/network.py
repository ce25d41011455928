"""`/designs/{id}/network`: the dependencies in a design."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Response

from app.api.dependencies import TheDesigns
from app.api.responses import written
from app.designs.schemas.network import DesignNetwork
from app.http.strict_requests import StrictRoute
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64)]


@router.get("/{id}/network", response_model=DesignNetwork, responses=refusals(404))
def show_network(id: Id, designs: TheDesigns) -> Response:
    """Return the dependencies of a design: blocks in calculation order, relations, and usable names."""
    return written(designs.network(id))
