"""A variant of an array call takes its error from that call: no orbit is marched again for one row."""

import numpy as np
import pytest

from app.designs.document import Document
from app.designs.graph import Catalogues
from app.designs.service import resolved
from app.designs.variants.together import Available, together
from cad.catalogue import models
from templates.core.language.evaluate import evaluate
from templates.door import built_in
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle

CATALOGUES = Catalogues(built_in(), models())
FED = {
    "groove_width": "3 mm",
    "groove_start": "-90 deg",
    "groove_extent": "180 deg",
    "supply_pressure": "4 bar",
}
CLEARANCES = {"close": "60 um", "wide": "80 um"}


@pytest.mark.slow
def test_property_rows_have_the_errors_of_single_calculations(monkeypatch):
    inputs = {**OilFilmCycle.example, **FED}
    step = {"template": "oil_film_cycle", "version": 1, "level": "supplied", "inputs": inputs}
    variants = {name: {"film.diametral_clearance": gap} for name, gap in CLEARANCES.items()}
    whole = Document.model_validate({"name": "two", "steps": {"film": step}, "variants": variants})
    asked, own = [], OilFilmCycle.own_error
    monkeypatch.setattr(OilFilmCycle, "own_error", lambda film, name: asked.append(film) or own(film, name))
    outcomes = together(resolved(whole, CATALOGUES), Available(CATALOGUES, lambda *_: None, lambda *_: None))
    assert len(set(map(id, asked))) == 1  # the array call alone
    for outcome in outcomes:
        row = outcome.calculation.evaluations["film"]
        alone = evaluate(
            OilFilmCycle, {**inputs, "diametral_clearance": CLEARANCES[outcome.name]}, level="supplied"
        )
        assert set(row.error) == set(alone.error)
        for name, error in alone.error.items():
            assert row.error[name] == pytest.approx(error, rel=1e-3, abs=1e-9, nan_ok=True), name
        film = "minimum_film_thickness"
        assert row.outputs[film].value == pytest.approx(alone.outputs[film].value, rel=1e-6)
        assert np.isfinite(row.error[film])
