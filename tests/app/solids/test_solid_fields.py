"""A crankshaft can be coloured by the use of its fillets or by torsional modes, as GLB and as a picture.

The solver is replaced by rows that it would have written.
"""

import io
import json
from math import cos, pi, sin
from types import SimpleNamespace

import numpy as np
import pypdf
import pytest
from PIL import Image
from serving import API, created, revision

from app.designs import solid_fields
from app.designs.schemas.designs import RevisionStep
from app.designs.solid_fields import ends_of
from app.solids import analysis_rows as repository
from app.solids.questions import Options, question
from cad.analysis.kinds import KINDS, TABLES
from cad.field_mesh import Glb

DESIGNS = f"{API}/designs"
SIZES = {
    "journal_diameter": "40 mm", "throw": "30 mm", "fillet": "2 mm", "pin_diameter": "36 mm",
    "pin_length": "24 mm", "web_thickness": "14 mm", "web_width": "60 mm", "journal_length": "20 mm",
    "pin_angles": "[0, 180] deg",
}  # fmt: skip
MESH = {"elements": 10, "degrees_of_freedom": 90, "order": 3, "mirror_plane": None}
PIN_RING = [[30 + 19 * cos(a), 19 * sin(a), 11.0] for a in np.arange(12) * pi / 6]
TENSOR = [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]
STUBS = {
    "chain": {"stiffness": 60e3, "throw_stiffnesses": [100e3, 150e3], "torsional_frequency": 900.0},
    "unit_loads": {
        "stress_of_force_1": [[(1 + n) * part for part in TENSOR] for n in range(12)],
        "points": PIN_RING,
    },
}
ASKED = {"chain": {"level": "coarse", "boundary": "guided_end"}, "unit_loads": {"level": "coarse"}}
TORSION = {
    "inertias": {"value": [0.01, 0.02, 0.02, 0.2], "unit": "kg*m**2"},
    "shaft_from": [1, 2, 3],
    "shaft_to": [2, 3, 4],
    "shaft_stiffness": ["200 kN*m/rad", "= shaft.chain.throw_stiffnesses[1]", "300 kN*m/rad"],
    "loss_factors": [0.01, 0.01, 0.01],
    "excited_inertias": [2, 3],
    "firing_angles": {"value": [0, 360], "unit": "deg"},
    "crank_angle": {"value": list(range(0, 720, 45)), "unit": "deg"},
    "gas_torque": {"value": [0, 700, 400, 200, 0, -20, -30, -20, 0, 20, 30, 20, 0, -90, -200, -260],
                   "unit": "N*m"},
    "highest_order": 2,
    "speeds": {"value": [800, 1300], "unit": "rpm"},
}  # fmt: skip
LIFE = {
    "ultimate_strength": "900 MPa",
    "force_1": {"value": [4, 10, 46, 22, 8, 2, -6, -9], "unit": "kN"},
    "stress_of_force_1": "= shaft.unit_loads.stress_of_force_1",
}


@pytest.fixture(scope="module")
def design(http, served):
    shaft = {"id": "crankshaft", "version": 1, "parameters": SIZES, "analyses": ASKED}
    alone = revision(http, created(http, {"name": "alone", "models": {"shaft": shaft}}))
    build = alone["models"]["shaft"]["build"]
    for kind, values in STUBS.items():
        asked = question(kind, Options(**ASKED[kind]))
        outputs = {
            name: {
                "value": value, "unit": KINDS[kind][name], "error": None, "level": "coarse", "mesh": MESH,
                "seconds": 0.5, **({"columns": [*TABLES[name]]} if name in TABLES else {}),
            }
            for name, value in values.items()
        }  # fmt: skip
        served.app.state.services.database.write(
            lambda session, asked=asked, outputs=outputs: repository.add(session, build, asked, outputs)
        )
    steps = {
        "train": {"template": "forced_torsion", "version": 1, "inputs": TORSION},
        "life": {"template": "fatigue_life", "version": 1, "inputs": LIFE},
        "other": {"template": "fatigue_life", "version": 1, "inputs": {
            **LIFE, "stress_of_force_1": {"value": [TENSOR], "unit": "MPa/kN"}}},
    }  # fmt: skip
    saved = created(http, {"name": "engine", "models": {"shaft": shaft}, "steps": steps})
    assert saved["state"] == "current", saved["problem"]
    return saved


@pytest.fixture(scope="module")
def base(design):
    return f"{DESIGNS}/{design['id']}/revisions/{design['revision']}/models/shaft/fields"


@pytest.fixture(scope="module")
def listed(http, base):
    return {one["id"]: one for one in http.get(base).json()["items"]}


def test_fields_follow_from_the_steps_that_use_finite_elements_of_the_model(http, design, listed):
    assert [*listed] == ["life.load_use", "train.mode_1", "train.mode_2", "train.mode_3"]
    steps = revision(http, design)["steps"]
    use = steps["life"]["outputs"]["load_use"]["value"]
    assert (listed["life.load_use"]["low"], listed["life.load_use"]["high"]) == (min(use), max(use))
    assert max(use) == pytest.approx(1 / steps["life"]["outputs"]["safety_factor"]["value"])
    assert "Hz" in listed["train.mode_1"]["title"]


def test_the_file_has_the_use_at_one_fillet_of_each_throw(http, listed):
    answer = http.get(listed["life.load_use"]["glb"])
    assert answer.headers["content-type"] == "model/gltf-binary"
    glb = Glb(answer.content)
    accessor = glb.attributes["COLOR_0"]
    colours = glb._read(accessor, np.float32, 3)
    grey = np.isclose(colours, np.array([0.74, 0.76, 0.79]) ** 2.2, atol=1e-3).all(axis=1)
    painted = glb.points[~grey]
    pitch = 24 + 28 + 20
    assert {*np.unique(np.floor(painted[:, 2] / pitch))} == {0.0, 1.0}
    from_middle = painted[:, 2] % pitch - pitch / 2
    assert from_middle.min() > 9.5
    assert from_middle.max() < 12.5
    again = http.get(listed["life.load_use"]["glb"], headers={"If-None-Match": answer.headers["etag"]})
    assert again.status_code == 304


def test_a_mode_colours_the_whole_shaft(http, listed, base):
    glb = Glb(http.get(listed["train.mode_1"]["glb"]).content)
    extras = glb.about["nodes"][0]["extras"]
    assert (extras["low"], extras["high"]) == (
        -listed["train.mode_1"]["high"],
        listed["train.mode_1"]["high"],
    )
    picture = Image.open(io.BytesIO(http.get(f"{base}/train.mode_1.png").content))
    assert picture.size == (640, 480)
    assert len(picture.convert("RGB").getcolors(10**6)) > 500


def test_page_offers_them_as_colours_and_files(http, design, listed):
    page = http.get(f"/designs/{design['id']}").text
    for one in listed.values():
        assert f'<option value="{one["glb"]}"' in page
        assert f'href="{one["png"]}"' in page


@pytest.mark.slow
def test_the_report_shows_them(http, design, listed):
    address = f"{DESIGNS}/{design['id']}/report"
    page = http.get(f"{address}.html", headers={"Prefer": "wait=60"}).text
    for one in listed.values():
        assert f'<img src="{one["png"]}"' in page
    printed = http.get(f"{address}.pdf", headers={"Prefer": "wait=60"})
    assert printed.content.startswith(b"%PDF")
    text = "".join(page.extract_text() for page in pypdf.PdfReader(io.BytesIO(printed.content)).pages)
    assert "Angle of torsional mode 1" in " ".join(text.split())


@pytest.mark.parametrize("tail", ["nothing.glb", "life.load_use.stl", "train.mode_9.png"])
def test_what_is_not_there_is_refused(http, base, tail):
    answer = http.get(f"{base}/{tail}")
    assert answer.status_code in (404, 422), answer.text
    if tail.startswith(("nothing", "train")):
        assert "life.load_use" in answer.json()["detail"]


def test_the_description_offers_no_option_of_other_files(http):
    (path,) = [
        path for path in http.get("/openapi.json").json()["paths"] if path.endswith("/fields/{field}.{kind}")
    ]
    asked = {one["name"] for one in http.get("/openapi.json").json()["paths"][path]["get"]["parameters"]}
    assert not asked & {"deflection", "drawing_title"}


def life_of(use, source="shaft"):
    step = {
        "template": {"id": "fatigue_life", "version": 1, "digest": "0"},
        "inputs": {},
        "outputs": {"load_use": {"value": use, "unit": "1"}},
        "relations": {"stress_of_force_1": f"= {source}.unit_loads.stress_of_force_1"},
    }
    return RevisionStep.model_validate(step)


def uses(monkeypatch, life):
    monkeypatch.setattr(solid_fields, "_points", lambda session, model: np.zeros((3, 3)))
    models = {"shaft": None, "big_shaft": None}
    revision = SimpleNamespace(models=models, steps={"life": life})
    return [*solid_fields._uses(None, revision, "shaft", None, [])]


def test_a_point_without_a_value_leaves_the_range_of_the_others(monkeypatch):
    (field,) = uses(monkeypatch, life_of([None, 0.5, 0.25]))
    assert (field.low, field.high) == (0.25, 0.5)
    assert uses(monkeypatch, life_of([None, None, None])) == []


def test_a_model_whose_name_ends_another_does_not_take_its_fields(monkeypatch):
    assert len(uses(monkeypatch, life_of([0.1, 0.5, 0.25]))) == 1
    assert uses(monkeypatch, life_of([0.1, 0.5, 0.25], "big_shaft")) == []


def test_a_model_that_is_no_crank_has_none(http):
    parameters = {"inner_diameter": "48 mm", "width": "20 mm"}
    models = {"shell": {"id": "plain_bearing", "version": 1, "parameters": parameters}}
    saved = created(http, {"name": "shell", "models": models})
    answer = http.get(f"{DESIGNS}/{saved['id']}/revisions/1/models/shell/fields")
    assert answer.json() == {"items": []}
    assert http.get(f"{DESIGNS}/{saved['id']}/revisions/1/models/none/fields").status_code == 404


def train(**changed):
    inputs = {
        "excited_inertias": [3, 4], "shaft_from": [1, 2, 3, 4, 5], "shaft_to": [2, 3, 4, 5, 6],
        "shaft_stiffness": [0, 2, 2, 2, 1], **changed,
    }  # fmt: skip
    used = {name: {"value": value, "unit": "1", "from": "given"} for name, value in inputs.items()}
    step = {"template": {"id": "forced_torsion", "version": 1, "digest": "0"}, "inputs": used}
    return RevisionStep.model_validate(json.loads(json.dumps(step)))


def test_nose_and_flange_are_what_an_elastic_shaft_joins_to_the_outer_throws():
    assert ends_of(train(), 2) == ([2, 3], 1, 4)
    assert ends_of(train(shaft_stiffness=[0, 0, 2, 2, 1]), 2) == ([2, 3], 2, 4)  # a loose nose
    assert ends_of(train(shaft_from=[1, 2, 3, 4, 4]), 2) == ([2, 3], 1, 3)  # a branch behind the last throw
    assert ends_of(train(excited_inertias=[3, 3, 4, 4]), 2) == ([2, 3], 1, 4)  # two rods on each pin
    assert ends_of(train(), 4) is None
