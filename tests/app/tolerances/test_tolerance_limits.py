"""A tolerance analysis accepts a limit that a relation sets."""

from app.designs.document import Document
from app.designs.graph import Catalogues, build_graph
from app.designs.service import resolved
from app.tolerances.criteria import demanded
from cad.catalogue import models
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())


def missing(**limits):
    """The limits that nobody has given, by criterion, for a film and one parameter."""
    film = built_in().get("oil_film", 2)
    step = {"template": "oil_film", "version": 2, "inputs": dict(film.example), "limits": limits}
    raw = {"name": "film", "parameters": {"bears": "20 MPa"}, "steps": {"film": step}}
    graph, faults = build_graph(resolved(Document.model_validate(raw), CATALOGUES), CATALOGUES)
    assert faults == []
    return {name: one.missing for name, one in demanded(graph).items()}


def test_a_limit_by_a_relation_is_given_as_one_by_hand():
    assert missing()["film.pressure"] == ["film.permissible_pressure"]
    assert missing(permissible_pressure="20 MPa")["film.pressure"] == []
    assert missing(permissible_pressure="= 2 * bears")["film.pressure"] == []
