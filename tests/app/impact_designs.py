"""Designs of different structure that use oil_film, and those that form a batch."""

from copy import deepcopy

from bare_shells import BUSH
from row_designs import CATALOGUES

from app.designs.document import Document
from app.designs.tasks import CatalogueTask
from app.impact.solids import Solids
from app.impact.task import Batch, DesignAt, uses
from app.storage.tables import canonical_json

PAPER = {
    "name": "paper",
    "parameters": {"load": "25 kN"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 1,
            "inputs": {
                "radial_load": "= load",
                "diametral_clearance": "0.055 mm",
                "bearing_diameter": "48 mm",
                "bearing_width": "18 mm",
                "speed": "5000 rpm",
                "oil_inlet_temperature": "80 degC",
                "oil_outlet_temperature": "87.762 degC",
            },
            "limits": {"permissible_specific_load": "40 MPa"},
        }
    },
    "models": {
        "shell": {
            "id": "plain_bearing",
            "version": 1,
            "parameters": {
                **BUSH,
                "inner_diameter": "= film.bearing_diameter + film.minimum_film_thickness",
                "wall": "2 mm",
                "width": "= film.bearing_width",
                "tang_length": "4 mm",  # by default a share of the bore, as is the height of the relief
                "relief_height": "6 mm",
            },
        }
    },
    "criteria": {"thick": {"require": "film.minimum_film_thickness >= 2.8 um"}},
}


def paper(**changes):
    """The paper's bearing, with some inputs of its step changed; None takes one away."""
    document = deepcopy(PAPER)
    inputs = document["steps"]["film"]["inputs"]
    for name, value in changes.items():
        if value is None:
            del inputs[name]
        else:
            inputs[name] = value
    return document


def loaded(load):
    document = paper()
    document["parameters"]["load"] = load
    return document


def with_variants():
    document = loaded("20 kN")
    document["variants"] = {
        "main_1": {"load": "22 kN"},
        "main_2": {"film.diametral_clearance": "0.05 mm", "load": "= 21 kN"},
        "main_3": {"load": "400 kN"},
    }
    return document


def at_points(speed="4000 rpm"):
    """A design with inputs at several points."""
    document = paper(radial_load={"value": [10, 20, 30], "unit": "kN"}, speed=speed)
    del document["models"], document["criteria"]
    return document


def weighed():
    """A design of which the load is the weight of its own bearing."""
    document = paper(radial_load="= shell.mass * 9.81 m/s**2 * 10000")
    document["models"]["shell"]["parameters"]["inner_diameter"] = "48 mm"
    return document


def batch_of(documents, version, template="oil_film", solids=None, ids=None):
    """Documents as one batch; their ids are their places."""
    read = [Document.model_validate(document) for document in documents]
    ids = ids or [f"d{place:02}" for place in range(len(read))]
    designs = tuple(
        DesignAt(id, 1, canonical_json(document.model_dump(mode="json")))
        for id, document in zip(ids, read, strict=True)
    )
    templates, models = uses(read)
    parts = CatalogueTask.of({*templates, (template, version)}, models, CATALOGUES)
    return Batch(template, version, designs, parts, solids or Solids())
