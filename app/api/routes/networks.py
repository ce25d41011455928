"""`/designs/{id}/network`: what drives what in a design."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.api.dependencies import TheDesigns
from app.api.reading import StrictRoute
from app.designs import repository
from app.designs.drives import network_of
from app.designs.graph import build_graph
from app.designs.reading import read_document, resolved
from app.schemas.networks import DesignNetwork
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1/designs", tags=["designs"], route_class=StrictRoute)

Id = Annotated[str, Path(max_length=64)]


@router.get("/{id}/network", responses=refusals(404))
def show_network(id: Id, designs: TheDesigns) -> DesignNetwork:
    """The dependencies of a design: its blocks in order of calculation, its relations, and names for them."""
    with designs.database.read() as session:
        _, document = repository.newest_document(session, id)
    graph, _ = build_graph(resolved(read_document(document), designs.catalogues), designs.catalogues)
    return network_of(graph)
