"""Where the files of a build state a tolerance: at faces and a dimension, or in the drawing's table alone."""

import io
import json
import subprocess
from pathlib import Path

import ezdxf
import pytest
from part21_reader import File
from slow_models import LARGE, quick_for, slow_for

from benchmarks.tolerance_places import drawn, lengths, toleranced
from cad.catalogue import models
from cad.drafting.content import content_of
from cad.errors import GeometryError
from cad.export import derive
from cad.file_kinds import bodies_of
from cad.header import read_header
from cad.pmi import on_faces
from cad.regenerate import as_quantities, as_text, build_key, regenerate_class
from cad.statements import read_statements
from cad.step import read_step
from cad.surfaces import look
from cad.tolerances import not_stated
from templates.core.errors import InvalidInputs

THROW = models().get("crank_throw", 1)
LENGTH = "40 mm ± 0.1 mm, in table"
CARRIED_BY_NONE = {
    "bearing_assembly": {"diametral_clearance"},  # between two diameters of two parts
    "crank_throw": {"journal_length"},  # the solid has half of each journal
    "plain_bearing": {"free_spread", "wall_reduction", "reduction_height"},  # of a fitted, concentric shell
}
"""Lengths of the library that no face has."""


def throw(**changes):
    return THROW.from_quantities({**THROW.example, **changes})


def faults(model):
    return list(not_stated(type(model), model.ledger.typed))


@slow_for(*LARGE)
def test_faces_carry_every_length_that_a_face_or_a_pair_of_faces_has(model):
    shape = model.from_quantities(toleranced(model))
    seen = {part.name: look(part.solid, len(part.places), part.name) for part in shape.build()}
    carried = on_faces(shape.dimensions(seen))
    assert set(lengths(model)) - carried.keys() == CARRIED_BY_NONE.get(model.id, set())
    assert carried.keys() <= model.toleranced.keys()


@quick_for(("thrust_washer", 1), ("plain_bearing", 1))
def test_the_file_and_the_drawing_state_every_tolerance_that_faces_carry(model):
    build = regenerate_class(model, toleranced(model))
    carried = {name for name, place in build.tolerances.items() if place.faces}
    whole, header = read_step(build.step), read_header(build.step)
    content = content_of(whole, header)
    parts = [content_of(bodies_of(f"dxf#{body.name}", whole), header, whole) for body in whole]
    assert build.tolerances.keys() == set(lengths(model))
    assert {one.name.removesuffix("/2") for one in File(build.step).dimensions()} == carried
    assert {n for n, place in build.tolerances.items() if place.drawn == "dimension"} == carried
    assert set().union(*map(drawn, [content, *parts])) == carried  # a bolt has its sizes on its own sheet
    assert set(lengths(model)) - carried <= set(content.unseen)


def test_a_tolerance_that_no_face_carries_is_named_and_the_remedy_is_accepted():
    (fault,) = faults(throw(journal_length="40 mm ± 0.1 mm", pin_diameter="48 mm h6"))
    assert (fault.name, fault.code) == ("journal_length", "tolerance_not_stated")
    assert "not the size of a face" in fault.detail
    assert "`, in table`" in fault.detail
    assert "`state_in_table`" in fault.detail
    assert not faults(throw(journal_length=LENGTH))
    marked = {"value": 40, "unit": "mm", "plus": 0.1, "minus": 0.1, "state_in_table": True}
    assert not faults(throw(journal_length=marked))
    assert as_text(throw(journal_length=marked)) == as_text(throw(journal_length=LENGTH))


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"counterweight_angle": "100 ± 1 deg"}, "of lengths only"),
        ({"counterweight_angle": {"value": 100, "unit": "deg", "plus": 1}}, "of lengths only"),
    ],
)
def test_the_reason_is_told(changes, reason):
    (fault,) = faults(throw(**changes))
    assert reason in fault.detail


def test_a_list_states_its_tolerance_in_the_table():
    cls = models().get("crankshaft", 1)
    radii = {"value": [70, 0, 0, 0, 0, 70], "unit": "mm", "plus": 0.1, "minus": 0.2}
    (fault,) = faults(cls.from_quantities({**cls.example, "counterweight_radius": radii}))
    assert "it is a list" in fault.detail
    marked = cls.from_quantities({**cls.example, "counterweight_radius": {**radii, "state_in_table": True}})
    assert not faults(marked)
    texts = as_text(marked)
    assert texts["counterweight_radius"] == "[70, 0, 0, 0, 0, 70] mm +0.1/-0.2 mm, in table"
    assert as_text(cls.from_quantities(texts)) == texts
    each = [{"value": r, "unit": "mm", "plus": 0.1 * (r > 0), "state_in_table": True} for r in radii["value"]]
    (fault,) = faults(cls.from_quantities({**cls.example, "counterweight_radius": each}))
    assert "share one tolerance" in fault.detail


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("40 mm, in table", "not_a_tolerance"),
        ({"value": 40, "unit": "mm", "state_in_table": True}, "not_a_tolerance"),
        ({"value": 40, "unit": "mm", "plus": 1, "state_in_table": "yes"}, "not_an_option"),
        ({"value": 40, "unit": "mm", "plus": 1, "state_in_table": 1}, "not_an_option"),
    ],
)
def test_a_mark_without_a_tolerance_and_one_that_is_no_truth_are_refused(text, code):
    with pytest.raises(InvalidInputs) as refused:
        throw(journal_length=text)
    assert [(fault.name, fault.code) for fault in refused.value.faults] == [("journal_length", code)]


@pytest.fixture(scope="module")
def washer():
    cls = models().get("thrust_washer", 1)
    marked = {"value": 3, "unit": "1", "plus": 1, "state_in_table": True}
    shape = cls.from_quantities({**cls.example, "oil_grooves": marked, "thickness": "2.5 mm h9"})
    return regenerate_class(cls, as_text(shape))


def test_a_marked_tolerance_stands_in_the_table_with_an_asterisk_and_among_the_attributes(washer):
    place = washer.tolerances["oil_grooves"]
    assert (place.faces, place.drawn, place.reason) == ((), "table", "faces carry tolerances of lengths only")
    stated = read_statements(washer.step)
    assert {one.name for one in stated if one.kind == "dimension"} == {"thickness"}
    assert ("oil_grooves", ("3 +1/+0, in table",)) in [(one.name, one.values) for one in stated]
    header = read_header(washer.step)
    assert header is not None
    assert header.parameters["oil_grooves"] == "3 +1/+0, in table"
    drawing = ezdxf.read(io.StringIO(derive(washer.step, "dxf").decode()))
    texts = [one.dxf.text for one in drawing.modelspace().query("TEXT")]
    assert "oil grooves *" in texts
    assert "3 +1/+0" in texts
    assert any(text.startswith("* no dimension shows it") for text in texts)
    assert "thickness *" not in texts


@pytest.mark.slow
def test_a_marked_tolerance_of_an_angle_stands_in_the_table_in_degrees():
    cls = models().get("plain_bearing", 1)
    marked = {"inner_diameter": "48 mm", "shells": "upper", "oil_groove_angle": "100 +2/-1 deg, in table"}
    texts = as_text(cls.from_quantities({**cls.example, **marked}))
    drawing = ezdxf.read(io.StringIO(derive(regenerate_class(cls, texts).step, "dxf").decode()))
    rows = [one.dxf.text for one in drawing.modelspace().query("TEXT")]
    assert "oil groove angle *" in rows
    assert "100° +2.0/-1.0°" in rows


def test_a_marked_tolerance_of_a_hole_that_is_not_there_stands_in_the_table():
    cls = models().get("thrust_washer", 1)
    texts = as_text(cls.from_quantities({**cls.example, "pin_hole_diameter": "0 mm"}))
    for text, is_stated in (("0 mm +0.1/0 mm", False), ("0 mm +0.1/0 mm, in table", True)):
        given = {**texts, "pin_hole_diameter": text}
        if is_stated:
            place = regenerate_class(cls, given).tolerances["pin_hole_diameter"]
            assert (place.faces, place.drawn) == ((), "table")
            assert "no face" in place.reason
        else:
            with pytest.raises(GeometryError, match="`state_in_table`"):
                regenerate_class(cls, given)


def test_a_row_with_a_marked_tolerance_is_read_again():
    one = throw(journal_length=LENGTH, counterweight_angle="100 deg +1/-2 deg, in table")
    rows = {n: p if "unit" in p else p["value"] for n, p in as_quantities(one).items()}
    assert rows["counterweight_angle"] == {
        "value": 100.0, "unit": "deg", "upper": 1.0, "lower": -2.0, "state_in_table": True,
    }  # fmt: skip
    again = THROW.from_quantities(rows)
    assert as_text(again) == as_text(one)
    assert build_key(again) == build_key(one) != build_key(throw(journal_length="40 mm"))


FREECAD = Path("/usr/lib/freecad-python3/lib")
DIAMETERS = """
import sys
sys.path.append(sys.argv[1])
import FreeCAD
import Part
shape = Part.Shape()
shape.read(sys.argv[2])
(solid,) = shape.Solids
print([2 * getattr(face.Surface, "Radius", 0.0) for face in solid.Faces])
"""


@pytest.mark.slow
@pytest.mark.skipif(not FREECAD.exists(), reason="FreeCAD is not installed (Debian: freecad-python3)")
def test_faces_have_the_numbers_of_freecad(tmp_path):
    cls = models().get("thrust_washer", 1)
    texts = as_text(cls.from_quantities(cls.example))
    wanted = {name: f"{texts[name]} h9" for name in ("inner_diameter", "outer_diameter", "pin_hole_diameter")}
    build = regenerate_class(cls, {**texts, **wanted})
    file = tmp_path / "washer.step"
    file.write_bytes(build.step)
    program = ["/usr/bin/python3", "-c", DIAMETERS, str(FREECAD), str(file)]
    done = subprocess.run(
        program, capture_output=True, text=True, timeout=120, check=True, env={"PATH": "/usr/bin"}
    )
    diameters = json.loads(done.stdout.splitlines()[-1])
    for name in wanted:
        ((_, number),) = build.tolerances[name].faces
        assert diameters[number] == pytest.approx(float(texts[name].split(" ")[0]), abs=1e-6)
