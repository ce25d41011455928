"""The gallery's design of the paper's study leads from dimensions to stiffness, stress and life."""

import numpy as np
import pytest
from patience import until
from serving import API, revision
from study_helpers import begun, ended, rows

from app.web.gallery.gallery import GALLERY

pytestmark = pytest.mark.slow  # each row builds a solid and solves it by finite elements

STIFFNESS, FREQUENCY = "model.torsion.stiffness", "frequency"
STRESS, LIFE = "life.stress_amplitude", "life.cycles"


@pytest.fixture(scope="module")
def crank(http):
    document = GALLERY["crank"].document
    asked = {**document["parameters"], "frequency": "= torsion.natural_frequencies[1]"}
    answer = http.post(f"{API}/designs", json={**document, "parameters": asked})
    assert answer.status_code in (201, 202), answer.text
    ask = lambda: http.get(f"{API}/designs/{answer.json()['id']}").json()  # noqa: E731
    design = until(ask, lambda now: now["state"] != "regenerating", 120)
    assert design["state"] == "current", design
    return design


def test_stiffness_drives_frequency_stress_and_life(http, crank):
    steps = revision(http, crank)["steps"]
    given = steps["torsion"]["inputs"]
    k, J = (given[name]["value"][0] for name in ("shaft_stiffness", "inertias"))
    unit = {"N*m/rad": 1.0, "kN*m/rad": 1e3}[given["shaft_stiffness"]["unit"]]
    frequency = steps["torsion"]["outputs"]["natural_frequencies"]["value"][0]
    assert frequency == pytest.approx(np.sqrt(k * unit / J) / (2 * np.pi), rel=1e-9)
    assert k * unit == pytest.approx(79.1e3, rel=0.02)
    assert 0 < steps["life"]["inputs"]["stress_amplitude"]["value"] < 600
    assert steps["life"]["outputs"]["cycles"]["value"] > 0


def test_two_of_the_changes_as_a_table_study(http, crank):
    """The one that gains most, and the one that loses: a solid for each, and the design's own."""
    table = {
        "inclination": {"value": [4.5, 1.4, 4.5], "unit": "deg"},
        "throw": {"value": [80, 80, 81.5], "unit": "mm"},
    }
    study = begun(http, crank, method="table", rows=table, outputs=[STIFFNESS, FREQUENCY, STRESS, LIFE])
    study = ended(http, study, 240)
    assert study["state"] == "done", study
    first, inclined, wider = (row["values"] for row in rows(http, study)["items"])
    assert inclined[STIFFNESS] > 1.08 * first[STIFFNESS] > first[STIFFNESS] > wider[STIFFNESS]
    assert wider[FREQUENCY] < first[FREQUENCY]
    for row in (inclined, wider):
        assert (row[STRESS] < first[STRESS]) == (row[LIFE] > first[LIFE])
