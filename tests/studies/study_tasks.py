"""Studies in the form in which calculation processes get them, without a service."""

from app.catalogue.catalogues import Catalogues
from app.catalogue.discovery import find_templates
from app.designs.document import Document
from app.designs.service import resolved
from app.studies.plan import planned
from app.studies.search_slice import Search
from app.studies.task import Task
from cad.catalogue import models

NEVER = 10**9
FILM = {
    "name": "main bearing",
    "parameters": {"width": "18 mm", "clearance": "0.055 mm"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "outputs": ["minimum_film_thickness", "power_loss"],
            "inputs": {
                "radial_load": "25 kN",
                "bearing_diameter": "48 mm",
                "bearing_width": "= width",
                "speed": "5000 rpm",
                "diametral_clearance": "= clearance",
                "dynamic_viscosity": "10 mPa*s",
            },
        }
    },
    "criteria": {"thick_enough": {"require": "film.minimum_film_thickness >= 1.8 um"}},
}
VARY = {"clearance": {"between": ["0.03 mm", "0.09 mm"]}, "width": {"between": ["15 mm", "25 mm"]}}


def planned_search(**body):
    """The task of an optimisation of a bearing, and what it searches."""
    catalogues = Catalogues(find_templates(()), models())
    document = resolved(Document.model_validate(FILM), catalogues).model_dump(mode="json")
    body = {"design": "d", "method": "optimise", "vary": VARY, "hold": ["thick_enough"], **body}
    asked = Task.of(document, body, list(VARY), {}, catalogues)
    plan, _ = planned(asked, None, 0.0)
    levels = tuple(tuple(sorted(one.items())) for one in plan.searched)
    return asked, Search(levels, tuple(plan.criteria), tuple(plan.required), plan.rows)
