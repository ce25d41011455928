"""An assembly of a model of this program with fixed parts is measured, checked and named."""

import hashlib
import json
from math import pi, sqrt

import pytest
from cadquery import Location, Vector, Workplane
from freecad_files import ended, imported, post
from serving import API, created, faults, paper, patched, revision

from app.imported_models.assemblies import AssemblyFiles
from app.maintenance.rows import SENT
from app.retention.rows import referenced_files
from app.storage.errors import ArtifactMissing
from cad.errors import GeometryError
from cad.header import Header
from cad.model import Part
from cad.step import read_step, rigid, write_step

RADIUS, LENGTH = 4.0, 30.0  # of the bolt [mm]
BLUE = (0.1, 0.2, 0.9)


def step_of(*parts):
    return write_step(parts, Header("bought", 1, {}, "0" * 64))


def bolt_step():
    shape = Workplane().circle(RADIUS).extrude(LENGTH).val()
    return step_of(Part("shank", shape, pi * RADIUS**2 * LENGTH, BLUE))


@pytest.fixture(scope="module")
def bolt(http):
    return imported(http, "m8_bolt", bolt_step(), file="m8.stp")


def manifest(*components, title="Bearing with its bolt", base="bearing_assembly", **more):
    said = {"program": "assembly", "title": title, "components": list(components), **more}
    return said | ({"base": {"model": base, "version": 1}} if base else {})


def below(**more):
    """The bolt with its head end on the cap's underside, pointing away from it."""
    return {"name": "bolt", "model": "m8_bolt", "datum": "cap.low_y", **more}


def brought(http, id, said):
    return imported(http, id, json.dumps(said).encode(), file=f"{id}.json")


def refusal(http, said, id="refused"):
    """Why a manifest is not taken, at once or by its job."""
    answer = post(http, id, json.dumps(said).encode())
    return answer.json() if answer.status_code != 202 else ended(http, answer)["problem"]


@pytest.fixture(scope="module")
def assembly(http, bolt):
    return brought(http, "bolted_bearing", manifest(below(z="1.25 mm")))


def design_with(http, **places):
    parameters = {
        "journal_diameter": "= film.bearing_diameter",
        "diametral_clearance": "= film.diametral_clearance",
    }
    model = {"id": "bolted_bearing", "version": 1, "parameters": {**parameters, **places}}
    return created(http, {**paper(), "model": model})


@pytest.fixture(scope="module")
def design(http, assembly):
    return design_with(http)


def measured(http, design):
    return http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]


def between(answer, one, other):
    """The distance between two parts [mm]."""
    (found,) = [c for c in answer["clearances"] if {*c["parts"]} == {one, other}]
    return found["distance"]["value"]


def test_the_film_drives_the_model_and_the_clearances_of_the_fixed_part_are_measured(http, design):
    assert design["state"] == "current"
    answer = measured(http, design)
    film = http.get(f"{API}/designs/{design['id']}/revisions/1").json()
    wanted = film["models"]["model"]["parameters"]["diametral_clearance"]
    assert wanted["unit"] == "mm"
    assert answer["dimensions"]["diametral_clearance"]["value"] == pytest.approx(wanted["value"], abs=1e-6)
    assert between(answer, "cap", "bolt") == pytest.approx(1.25, abs=1e-6)
    cap = answer["dimensions"]["cap_height"]["value"]
    journal = answer["dimensions"]["journal_diameter"]["value"]
    assert between(answer, "journal", "bolt") == pytest.approx(cap + 1.25 - journal / 2, abs=1e-6)


def test_relations_and_criteria_use_the_clearance_of_a_fixed_part(http, assembly):
    described = http.get(f"{API}/models/bolted_bearing/versions/1").json()["measures"]
    assert (described["bolt_clearance"], described["bolt_overlap"]) == ("mm", "mm**3")
    assembly = {"id": "bolted_bearing", "version": 1, "parameters": {"journal_diameter": "48 mm"}}
    wide = {"inner_diameter": "48 mm", "width": "= 20 * assembly.bolt_clearance + shared / 1 mm**2"}
    written = {
        "name": "room",
        "parameters": {"shared": "= assembly.bolt_overlap"},
        "criteria": {
            "free": {"require": "assembly.bolt_clearance >= 1.2 mm"},
            "wide": {"require": "assembly.bolt_clearance >= 1.3 mm"},
        },
        "models": {"assembly": assembly, "shell": {"id": "plain_bearing", "version": 1, "parameters": wide}},
    }
    design = created(http, written)
    answer = http.get(f"{API}/designs/{design['id']}/revisions/1").json()
    assert answer["models"]["shell"]["parameters"]["width"]["value"] == pytest.approx(25, abs=1e-5)
    assert {one["name"]: one["verdict"] for one in answer["criteria"]} == {"free": "met", "wide": "not_met"}
    refused = http.post(
        f"{API}/designs", json={**written, "parameters": {"shared": "= assembly.nut_clearance"}}
    )
    assert refused.status_code == 422
    assert "assembly.bolt_clearance" in refused.text


def test_the_step_file_holds_it_with_its_own_name_colour_and_place(http, design):
    file = http.get(f"{API}/designs/{design['id']}/model.step").content
    bodies = {body.name: body for body in read_step(file)}
    assert {"journal", "cap", "block", "bolt"} <= bodies.keys()
    assert bodies["bolt"].colour == pytest.approx(BLUE, abs=1e-6)
    turn, shift = rigid(bodies["bolt"].places[0])
    cap = measured(http, design)["dimensions"]["cap_height"]["value"]
    assert shift == pytest.approx([0, -cap - 1.25, 0], abs=1e-6)
    assert turn[:, 2] == pytest.approx([0, -1, 0], abs=1e-12)


def test_an_assembly_has_no_finite_elements_though_its_model_has_them(http, bolt):
    assert http.get(f"{API}/models/bearing_housing/versions/1").json()["analyses"]
    brought(http, "bolted_housing", manifest(below(z="6 mm"), base="bearing_housing"))
    assert http.get(f"{API}/models/bolted_housing/versions/1").json()["analyses"] == {}


def test_an_interference_is_refused_by_names_and_volume(http, assembly):
    design = design_with(http, bolt_z="-5 mm")
    assert design["state"] == "failed"
    problem = design["problem"]
    assert problem["status"] == 422
    assert f"cap and bolt overlap by {pi * RADIUS**2 * 5:.6g} mm³" in problem["detail"]
    assert named(problem) == ["model.bolt_x", "model.bolt_y", "model.bolt_z"]
    moved = patched(http, design, {"model": {"parameters": {"bolt_z": "0 mm"}}})
    assert moved["state"] == "current"
    assert between(measured(http, moved), "cap", "bolt") == 0


def test_an_interference_names_what_changed_since_the_last_good_model(http, assembly):
    """By a parameter of the fixed part, and by one of the part that it meets."""
    design = design_with(http, bolt_z="1 mm", bolt_y="0.5 mm")
    turned = patched(http, design, {"model": {"parameters": {"bolt_turn_z": "30 deg", "bolt_z": "-5 mm"}}})
    assert turned["state"] == "failed"
    assert set(named(turned["problem"])) == {"model.bolt_turn_z", "model.bolt_z"}
    assert "Changed since the last good model: " in turned["problem"]["detail"]
    asked = {"bolt_turn_z": None, "bolt_z": "1 mm", "cap_height": "50 mm"}
    assert patched(http, turned, {"model": {"parameters": asked}})["state"] == "current"


@pytest.mark.slow
def test_an_interference_by_a_change_of_the_base_names_that_change(http, bolt):
    beside = {"name": "bolt", "model": "m8_bolt", "datum": "origin", "x": "60 mm"}
    brought(http, "bolt_beside", manifest(beside))
    model = {"id": "bolt_beside", "version": 1, "parameters": {"journal_diameter": "48 mm"}}
    design = created(http, {"name": "beside", "model": model})
    assert design["state"] == "current"
    wider = patched(http, design, {"model": {"parameters": {"housing_breadth": "118 mm"}}})
    assert wider["state"] == "failed"
    assert named(wider["problem"]) == ["model.housing_breadth"]
    asked = {"housing_breadth": None, "journal_diameter": "54 mm"}
    thicker = patched(http, wider, {"model": {"parameters": asked}})
    assert named(thicker["problem"]) == ["model.journal_diameter"]


def named(problem):
    """The parameters beside which the page shows a problem."""
    return [one["name"] for one in problem["errors"]]


@pytest.mark.slow
def test_a_press_fit_that_is_allowed_is_measured(http, bolt):
    version = brought(http, "pressed_bearing", manifest(below(z="-5 mm", may_overlap=["cap"])))
    answer = http.post(f"{version}/build", json={"parameters": {"journal_diameter": "48 mm"}},
                       headers={"Prefer": "wait=60"})  # fmt: skip
    (pressed,) = [c for c in answer.json()["measurements"]["clearances"] if "overlap" in c]
    assert pressed["parts"] == ["cap", "bolt"]
    assert pressed["overlap"]["value"] == pytest.approx(pi * RADIUS**2 * 5, rel=1e-9)


def test_its_origin_says_what_it_is_made_of(http, assembly):
    answer = http.get(assembly).json()
    assert answer["title"] == "Bearing with its bolt"
    assert answer["origin"]["program"] == "assembly"
    assert "bearing_assembly is checked as ever" in answer["origin"]["trust"]
    properties = answer["parameters"]["properties"]
    assert {"journal_diameter", "bolt_x", "bolt_turn_z"} <= properties.keys()


@pytest.mark.slow
def test_a_model_of_another_design_is_a_fixed_part_pinned_to_its_revision(http, bolt):
    model = {"id": "ball_bearing", "version": 1, "parameters": {"inner_diameter": "20 mm"}}
    other = created(http, {"name": "bearing", "model": model})
    part = {"name": "bearing", "design": other["id"], "x": "300 mm", "turn_y": "90 deg"}
    version = brought(http, "with_bearing", manifest(below(), part))
    before = build_of(http, version)
    patched(http, other, {"model": {"parameters": {"inner_diameter": "25 mm"}}})
    again = brought(http, "with_bearing", manifest(below(), {**part, "revision": 1}))
    assert again == version  # the newest was revision 1
    newer = brought(http, "with_bearing", manifest(below(), part))
    assert newer != version
    assert build_of(http, version)["build"] == before["build"]
    assert build_of(http, newer)["build"] != before["build"]
    names = {name for c in before["measurements"]["clearances"] for name in c["parts"]}
    assert any(name.startswith("bearing:ball") for name in names)


def build_of(http, version):
    body = {"parameters": {"journal_diameter": "48 mm"}}
    answer = http.post(f"{version}/build", json=body, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.mark.slow
def test_fixed_parts_alone_are_an_assembly(http, bolt):
    parts = [{"name": f"bolt_{n}", "model": "m8_bolt", "x": f"{x} mm"} for n, x in ((1, 0), (2, 20))]
    parts.append(
        {"name": "cross", "model": "m8_bolt", "datum": "bolt_1.axis_1", "turn_x": "90 deg", "y": "-10 mm"}
    )
    version = brought(http, "bolts", manifest(*parts, base=None))
    answer = http.post(f"{version}/build", json={"parameters": {}}, headers={"Prefer": "wait=60"}).json()
    clear = answer["measurements"]
    assert between(clear, "bolt_1", "bolt_2") == pytest.approx(20 - 2 * RADIUS, abs=1e-6)
    assert between(clear, "bolt_1", "cross") == pytest.approx(10 - RADIUS, abs=1e-6)
    assert clear["volume"]["value"] == pytest.approx(3 * pi * RADIUS**2 * LENGTH, rel=1e-9)


@pytest.mark.parametrize(
    ("component", "said"),
    [
        ({"model": "no_such"}, "there is no model no_such that was imported as a file"),
        ({"model": "m8_bolt", "may_overlap": ["cap\x1b"]}, "may_overlap.0: String should match pattern"),
        ({"model": "m8_bolt", "version": 99}, "it has versions 1"),
        ({"design": "nobodys"}, "there is no design 'nobodys'"),
        ({"model": "bearing_assembly"}, "there is no model bearing_assembly"),
        ({"model": "m8_bolt", "design": "x"}, "give either"),
        ({}, "give either"),
        ({"model": "m8_bolt", "x": "nan mm"}, "x: "),
        ({"model": "m8_bolt", "x": "1e999 mm"}, "x: "),
        ({"model": "m8_bolt", "x": "1e9 mm"}, "exceeds the limit of"),
        ({"model": "m8_bolt", "turn_x": "3 mm"}, "turn_x: "),
        ({"model": "m8_bolt", "x": "1 ± 0.1 mm"}, "single quantity"),
        ({"model": "m8_bolt", "density": "0 kg/m**3"}, "density"),
        ({"model": "m8_bolt", "name": "wall width"}, "components.0.name"),
    ],
)
def test_a_component_that_makes_no_sense_is_refused_by_name(http, bolt, component, said):
    problem = refusal(http, manifest({"name": "part", **component}))
    assert problem["status"] == 422
    assert said in problem["detail"]


@pytest.mark.parametrize(
    ("said", "why"),
    [
        (manifest(below(), below()), "two components are called bolt"),
        (manifest(*[below(name=f"b{n}") for n in range(31)]), "at most 30"),
        (manifest(), "at least 1"),
        (manifest(below(), base="no_such"), "no_such"),
        (manifest(below(), base="m8_bolt"), "is not a model of this program"),
        ({**manifest(below()), "more": 1}, "more"),
        (manifest(below(name="origin")), "`origin` is the name of a datum"),
    ],
)
def test_a_manifest_that_makes_no_sense_is_refused_with_the_reason(http, bolt, said, why):
    problem = refusal(http, said)
    assert problem["status"] == 422
    assert why in problem["detail"]


@pytest.mark.slow
@pytest.mark.parametrize("datum", ["cap.axis_9", "hood.low_y", "cap.underneath", "low_y", "."])
def test_a_datum_that_is_not_there_fails_the_build_with_what_there_is(http, bolt, datum):
    id = "datum_" + hashlib.sha256(datum.encode()).hexdigest()[:8].translate(
        str.maketrans("0123456789", "abcdefghij")
    )
    version = brought(http, id, manifest(below(datum=datum)))
    answer = http.post(f"{version}/build", json={"parameters": {"journal_diameter": "48 mm"}},
                       headers={"Prefer": "wait=60"})  # fmt: skip
    assert answer.status_code == 422
    assert "bolt: " in answer.json()["detail"]


def test_an_assembly_does_not_hold_itself(http, bolt, assembly, design):
    part = {"name": "self", "design": design["id"]}
    problem = refusal(http, manifest(part, base=None), id="bolted_bearing")
    assert problem["status"] == 422
    assert "contains bolted_bearing itself" in problem["detail"]


def test_a_place_out_of_range_is_refused_by_name(http, assembly):
    answer = http.post(
        f"{assembly}/build", json={"parameters": {"journal_diameter": "48 mm", "bolt_x": "1 km"}}
    )
    assert faults(answer) == {"bolt_x": "out_of_range"}


def test_its_package_is_kept_and_a_lost_one_is_named(http, served, assembly):
    services = served.app.state.services
    cls = services.catalogues.models.get("bolted_bearing", 1)
    with services.database.read() as session:
        assert cls.imported.file in referenced_files(session)
    assert any(table == "imported_model" for table, _, _ in SENT)

    class Lost:
        def read(self, sha):
            raise ArtifactMissing(sha)

    with pytest.raises(GeometryError, match="restore file") as lost:
        AssemblyFiles(Lost()).draw(cls.imported, {}, None)
    assert lost.value.code == "component_lost"


def test_a_clearance_askew_is_that_of_geometry():
    """Two balls on a diagonal, by the distance of their centres."""
    from cad.overlaps import clearances
    from cad.step import Body

    ball = Workplane().sphere(3).val()
    far = Body("far", ball, BLUE, (Location(Vector(10, 10, 10)),))
    near = Body("near", ball, BLUE, (Location(),))
    (one,) = clearances([near, far], lambda name: name)
    assert one.distance == pytest.approx(sqrt(300) - 6, abs=1e-6)
    inside = Body("inside", Workplane().sphere(1).val(), BLUE, (Location(Vector(0.5, 0, 0)),))
    (two,) = clearances([near, inside], lambda name: name)
    assert two.overlap == pytest.approx(4 / 3 * pi, rel=1e-6)
    assert not list(clearances([near, far], lambda name: None))


def test_a_toleranced_place_of_a_step_part_is_stated_in_the_table(http, assembly):
    given = {"journal_diameter": "48 mm h6", "bolt_z": "1.25 ± 0.2 mm"}
    document = {"name": "bolted", "models": {"bearing": {"id": "bolted_bearing", "parameters": given}}}
    assert faults(http.post(f"{API}/designs", json=document)) == {"bearing.bolt_z": "tolerance_not_stated"}
    given["bolt_z"] += ", in table"
    design = created(http, document)
    assert design["state"] == "current", design["problem"]
    stated = revision(http, design)["models"]["bearing"]["tolerances"]
    assert {name: (one["where"], one["drawing"]) for name, one in stated.items()} == {
        "bolt_z": ("table", "table"),
        "journal_diameter": ("faces", "table"),
    }
    assert "built-in models only" in stated["journal_diameter"]["detail"]
