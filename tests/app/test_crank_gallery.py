"""The gallery's design of the paper's study leads from dimensions to stiffness, stress and life."""

import numpy as np
import pytest
from patience import until
from serving import API, created, revision
from study_helpers import begun, ended, rows

from app.designs.gallery.gallery import GALLERY

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


STUDY = """variant	pin	journal	throw	inclination
unit	mm	mm	mm	deg
face	46	44	80	1.4
journal	46	48.4	80	4.5
pin	50.6	44	80	4.5
throw	46	44	81.5	4.5
"""
"""The four changes of the paper, as a user pastes them from a spreadsheet."""


@pytest.mark.slow
def test_the_study_of_the_paper_is_pasted_into_the_table_of_variants(http):
    """K changes by +6.0, +10.1, −2.0 and +13.3 % (docs/crank_study.md, at level fine)."""
    design = created(http, GALLERY["crank"].document)
    typed = {"table": STUDY, "revision": str(design["revision"])}
    answer = http.post(f"/designs/{design['id']}/variants/pasted", data=typed)
    assert answer.status_code in (200, 303), answer.text
    ask = lambda: http.get(f"{API}/designs/{design['id']}").json()["state"]  # noqa: E731
    assert until(ask, lambda state: state != "regenerating", 600) == "current"
    table = http.get(f"{API}/designs/{design['id']}/variants").json()["table"]
    names = [column["name"] for column in table["columns"]]
    changed = {row["name"]: dict(zip(names, row["changes"], strict=True)) for row in table["rows"]}
    changes = {name: 100 * row["model.torsion.stiffness"] for name, row in changed.items()}
    wanted = {"base": 0, "pin": 6.0, "journal": 10.1, "throw": -2.0, "face": 13.3}
    assert changes == pytest.approx(wanted, abs=0.3)
    assert changed["face"]["model.mass"] == pytest.approx(0.144 / 2.69, abs=2e-3)
    assert all(row["life.cycles"] is not None for row in changed.values())
    sheet = http.get(f"{API}/designs/{design['id']}/variants.csv").text
    page = http.get(f"/designs/{design['id']}", headers={"Accept": "text/html"}).text
    report = http.get(f"{API}/designs/{design['id']}/variants/report.html").text
    assert "results: stiffness change" in sheet
    for name, change in changes.items():
        text = f"{change:+.1f} %".replace("-", "−") if name != "base" else "0.0 %"
        assert text in page
        assert text in report
