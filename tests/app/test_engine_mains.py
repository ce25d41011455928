"""In one design over HTTP, an engine's loads drive a film in each bearing, by items of arrays."""

import numpy as np
import pytest
from engines import bearings_of, four_cylinders
from serving import API, created, revision

from app.designs.gallery.gallery import GALLERY

ENGINE = bearings_of(GALLERY["engine"].document)
FILM = "film.minimum_film_thickness"


def steps(design):
    """The engine and one film, without variants and models."""
    return {name: value for name, value in design.items() if name not in ("models", "variants")}


@pytest.fixture(scope="module")
def engine(http):
    document = steps(ENGINE)
    film = {**document["steps"]["film"]}
    film["inputs"] = {
        **film["inputs"],
        "load_x": "= engine.main_load_x[2]",
        "load_y": "= engine.main_load_y[2]",
    }
    loads = {**document["steps"]["engine"]}
    loads["outputs"] = [*loads["outputs"], "main_load_x", "main_load_y", "elastic_main_load_x"]
    design = created(http, {**document, "steps": {"engine": loads, "film": film}})
    assert design["state"] == "current", design
    return design


def test_an_item_of_the_loads_drives_the_film_counted_from_1(http, engine):
    done = revision(http, engine)["steps"]
    loads = np.array(done["engine"]["outputs"]["main_load_x"]["value"])
    unit = done["engine"]["outputs"]["main_load_x"]["unit"]
    taken = done["film"]["inputs"]["load_x"]
    assert loads.shape == (5, 144)
    assert taken["unit"] == unit
    assert taken["value"] == pytest.approx(loads[1], rel=1e-12)
    assert np.abs(loads[0] - loads[1]).max() > 1000
    film = done["film"]["outputs"]
    assert 0 < film["minimum_film_thickness"]["value"] < 27.5
    assert film["minimum_film_thickness"]["value"] != film["film_thickness"]["value"][0]


@pytest.mark.parametrize("index", ["6", "0"])
def test_an_item_beyond_the_mains_is_refused_by_name(http, index):
    document = steps(ENGINE)
    film = {**document["steps"]["film"]}
    film["inputs"] = {**film["inputs"], "load_x": f"= engine.main_load_x[{index}]"}
    answer = http.post(f"{API}/designs", json={**document, "steps": {**document["steps"], "film": film}})
    assert answer.status_code == 422, answer.text
    assert any("from 1 to" in error["detail"] for error in answer.json()["errors"])


@pytest.mark.parametrize(
    ("change", "names"),
    [
        ({"bank_angles": {"value": [0, 90], "unit": "deg"}}, {"bank_angles"}),
        ({"throws": [1, 1, 2, 2]}, {"throws"}),
        ({"main_positions": {"value": [0, 94, 90, 282, 376], "unit": "mm"}}, {"main_positions"}),
    ],
)
def test_contradictions_of_an_engine_are_refused_by_name(http, change, names):
    inputs = four_cylinders(bore="86 mm", **change)["inputs"]
    answer = http.post(f"{API}/templates/engine/versions/1/evaluate", json={"inputs": inputs})
    assert answer.status_code == 422, answer.text
    assert names <= {error["name"] for error in answer.json()["errors"]}


@pytest.mark.slow
def test_all_nine_bearings_are_variants_and_the_worst_governs(http):
    design = created(http, {name: value for name, value in ENGINE.items() if name != "models"})
    table = http.get(f"{API}/designs/{design['id']}/variants").json()
    assert len(table["variants"]) == 9, table
    thickness = {}
    for name in ENGINE["variants"]:
        address, params = f"{API}/designs/{design['id']}/variants/{name}", {"output": FILM}
        thickness[name] = http.get(address, params=params).json()["outputs"][FILM]["value"]
    assert min(thickness.values()) > 0
    worst = table["by_criterion"]["film.film"]["variant"]
    assert thickness[worst] == min(thickness.values()), (worst, thickness)
    assert table["governing"]["criterion"].startswith("film."), table["governing"]
    assert thickness["main_2"] != pytest.approx(thickness["main_1"], rel=1e-3)
    assert len(set(thickness.values())) > 3
