"""The columns of a study's rows are in the order in which the user named the inputs."""

import numpy as np

from app.designs.document import Document
from app.designs.graph import Catalogues
from app.designs.service import resolved
from app.studies.task import Task, prepared
from cad.catalogue import models
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
IDLE = {
    "journal_diameter": "= 2 * radius", "bearing_width": "= width", "radial_clearance": "= gap",
    "speed": "3000 rpm", "dynamic_viscosity": "10 mPa*s",
}  # fmt: skip
DESIGN = {
    "name": "Petroff",
    "parameters": {"width": "20 mm", "gap": "30 um", "radius": "25 mm"},
    "steps": {"idle": {"template": "journal_friction", "version": 1, "inputs": IDLE}},
}
VARY = {"width": ["10 mm", "40 mm"], "gap": ["20 um", "50 um"], "radius": ["20 mm", "30 mm"]}
BOUNDS = {"width": (0.01, 0.04), "gap": (2e-5, 5e-5), "radius": (0.02, 0.03)}


def test_columns_stay_in_order_though_a_stored_body_sorts_its_keys():
    document = resolved(Document.model_validate(DESIGN), CATALOGUES).model_dump(mode="json", by_alias=True)
    body = {
        "design": "d",
        "method": "sample",
        "points": 64,
        "outputs": ["idle.power_loss"],
        "vary": {name: {"between": ends} for name, ends in VARY.items()},
    }
    ready = prepared(Task.of(document, body, list(VARY), {}, CATALOGUES))
    assert [str(place) for place in ready.asked.places] == ["width", "gap", "radius"]
    rows = ready.asked.points.rows(0, 64)
    for column, (low, high) in zip(rows.T, BOUNDS.values(), strict=True):
        assert np.all((low <= column) & (column <= high))
        assert np.ptp(column) > 0.9 * (high - low)
