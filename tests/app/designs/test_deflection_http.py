"""`model.stl?deflection=…` returns a mesh of the requested fineness, or a refusal with the valid values."""

import re
from math import pi

import pytest
from serving import API, created, faults, moody, problem

WAIT = {"Prefer": "wait=60"}


@pytest.fixture(scope="module")
def design(http):
    return created(http, moody("23.7 mm"))


def mesh_of(http, design, kind, **query):
    return http.get(f"{API}/designs/{design['id']}/model.{kind}", params=query, headers=WAIT)


@pytest.mark.parametrize("kind", ["stl", "glb"])
def test_a_mesh_with_a_deflection_is_a_file_of_its_own(http, design, kind):
    answer = mesh_of(http, design, kind, deflection="0.1 mm")
    again = mesh_of(http, design, kind, deflection="100 um")
    assert answer.status_code == 200, answer.text
    assert f".{kind}" in answer.headers["content-disposition"]
    assert "@" not in answer.headers["content-disposition"]
    assert answer.headers["content-type"] == mesh_of(http, design, kind).headers["content-type"]
    assert again.headers["etag"] == answer.headers["etag"]


@pytest.mark.parametrize(
    ("kind", "raw", "code"),
    [("stl", "0.1", "missing_unit"), ("stl", "-1 mm", "out_of_range"), ("png", "1 mm", "not_offered")],
)
def test_what_is_no_deflection_is_refused_by_name(http, design, kind, raw, code):
    assert faults(mesh_of(http, design, kind, deflection=raw)) == {"deflection": code}


@pytest.mark.parametrize("raw", ["1 nm", "3 m"])
def test_a_deflection_beside_the_size_is_refused_with_what_suits(http, design, raw):
    answer = mesh_of(http, design, "stl", deflection=raw)
    problem(answer, 422, "invalid-inputs")
    assert "give 0.00" in answer.text


def test_one_part_is_a_file_of_its_own_named_after_it(http, design):
    whole, alone = mesh_of(http, design, "stl"), mesh_of(http, design, "stl", part="block")
    assert alone.status_code == 200, alone.text
    assert "_block.stl" in alone.headers["content-disposition"]
    assert alone.content == whole.content
    for kind, magic in {"3mf": b"PK", "brep": b"\nCASCADE"}.items():
        file = mesh_of(http, design, kind, part="block")
        assert magic.strip() in file.content[:100]
    assert mesh_of(http, design, "3mf", part="block", deflection="0.1 mm").status_code == 200


def test_what_is_no_part_is_refused_by_name(http, design):
    assert faults(mesh_of(http, design, "png", part="block")) == {"part": "not_offered"}
    unknown = mesh_of(http, design, "stl", part="bal")
    assert faults(unknown) == {"part": "unknown_part"}
    assert "there is no part 'bal'; the only part is block" in unknown.text


def test_an_unknown_design_is_reported_before_a_wrong_deflection(http):
    problem(http.get(f"{API}/designs/none/model.stl", params={"deflection": "much"}), 404, "not-found")


def test_the_drawing_of_one_part_states_its_own_material_and_mass(http):
    """A ball of 12 mm: π/6 · 12³ mm³ at 7850 kg/m³ is 7.103 g; the rings are not in it."""
    bearing = {"id": "ball_bearing", "version": 1, "parameters": {"inner_diameter": "50 mm"}}
    design = created(http, {"name": "ball", "model": bearing})
    svg = mesh_of(http, design, "drawing.svg", part="ball")
    assert svg.status_code == 200, svg.text
    assert "_ball.drawing.svg" in svg.headers["content-disposition"]
    diameter = float(re.search(r"Ø([0-9.]+)<", svg.text)[1])
    assert re.search(r'data-stamp="part-mass"[^>]*>([0-9.]+) kg<', svg.text)[1] == (
        f"{pi / 6 * diameter**3 * 7850e-9:.4g}"
    )
    assert re.search(r'data-stamp="part-material"[^>]*>([^<]*)<', svg.text)[1] == "steel (7850 kg/m³)"
    whole = mesh_of(http, design, "drawing.svg")
    assert 'data-stamp="part-mass"' not in whole.text
    dxf = mesh_of(http, design, "dxf", part="ball")
    assert f"{pi / 6 * diameter**3 * 7850e-9:.4g} kg" in dxf.text
    assert mesh_of(http, design, "drawing.pdf", part="ball").content.startswith(b"%PDF")
    assert faults(mesh_of(http, design, "drawing.svg", part="cage")) == {"part": "unknown_part"}
