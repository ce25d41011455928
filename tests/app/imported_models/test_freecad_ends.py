"""The ends of FreeCAD documents: decided at the import, and the same in every later drawing."""

from dataclasses import replace
from math import pi
from random import Random

import pytest
from freecad_files import bush, documents, needs_freecad
from freecad_here import FreeCadHere

from cad.errors import GeometryError
from cad.model_classes import description_of

pytestmark = needs_freecad


@pytest.fixture(scope="module")
def here():
    freecad = FreeCadHere()
    yield freecad
    freecad.close()


@pytest.fixture(scope="module")
def files():
    return documents(
        {
            "cut": ("cut", {"hole": "8 mm"}),
            "unitless": ("unitless", {"outside": 60, "d1": 24, "count": 4, "unused": 7}),
            "ring": ("ring", {"bore": "20 mm"}),
            "reversed": ("reversed_part", {"unused": "1 mm"}),
            "tied": ("tied", {"length": "30 mm"}),
            "loose": ("loose", {"unused": "1 mm"}),
        }
    )


def refused(built, code):
    with pytest.raises(GeometryError) as caught:
        built()
    assert caught.value.code == code, caught.value
    return str(caught.value)


def test_a_last_feature_that_comes_out_empty_is_refused_by_name(here, files):
    described = here.described(files["cut"])
    assert [name for name, _ in described.ends.parts] == ["Bored"]
    assert set(described.ends.inner) == {"Block", "Drill"}
    volume = here.built(described).measures["volume"]
    assert volume == pytest.approx(40**3 - pi * 8**2 * 40, rel=1e-9)
    said = refused(lambda: here.built(described, hole="55 mm"), "no_solid")
    assert "Bored has no solid at these values, but had one at the import" in said
    assert here.built(described, hole="9 mm").measures["volume"] < volume


def test_a_model_imported_before_ends_were_recorded_gets_them_at_first_use(here, files):
    described = here.described(files["cut"])
    older = replace(described, ends=None, findings=(), overlapping=None)
    assert "ends" not in older.text
    assert description_of(older.text) == older
    assert description_of(described.text) == described
    assert here.built(older, hole="9 mm").measures["volume"] > 0
    assert "Bored has no solid" in refused(lambda: here.built(older, hole="55 mm"), "no_solid")


def test_the_digest_of_an_older_description_does_not_change(here, files):
    described = here.described(files["cut"])
    plain = tuple(replace(one, side="", moves="") for one in described.parameters)
    older = replace(described, ends=None, findings=(), overlapping=None, parameters=plain)
    for later in ("ends", "findings", "overlapping", '"side"', '"moves"'):
        assert later not in older.text


def test_a_number_without_unit_says_what_it_moves(here, files):
    described = here.described(files["unitless"])
    there = {one.name: one for one in described.parameters}
    assert there["d1"].role == "radius"
    assert there["d1"].moves.startswith("24 → 24.24: diameter 48 → 48.48 mm, volume ")
    assert there["count"].moves.startswith("4 → 5: distance 40 → 50 mm, volume ")
    assert there["unused"].moves == "nothing"
    described_class = here.built(described, d1="25")
    assert described_class.dimensions["d1"] == 25
    assert "move nothing: unused" in described.trust


def test_loose_faces_and_overlaps_are_reported(here, files):
    described = here.described(files["loose"])
    assert [name for name, _ in described.ends.parts] == ["Mixed", "Beside"]
    findings = " ".join(described.findings)
    assert "Mixed has faces that belong to no solid; they are left out (1)" in findings
    assert "Sheet has faces, but no solid; it is left out" in findings
    assert "Solids overlap, so volume and mass count the common space twice" in findings
    assert described.overlapping == (("Mixed", "Beside"),)


def test_a_part_that_is_turned_inside_out_is_refused(here, files):
    described = here.described(files["ring"])
    (bore,) = described.parameters
    assert (bore.role, bore.side) == ("radius", "inside")
    assert here.built(described, bore="25 mm").dimensions == {"bore": 25}
    said = refused(lambda: here.built(described, bore="35 mm"), "inside_out")
    assert "bore = 35 mm turns the part inside out" in said
    assert "inside out" in refused(lambda: here.described(files["reversed"]), "inside_out")


def test_the_bore_of_a_bush_does_not_grow_beyond_its_outside(here):
    described = here.described(bush())
    assert "inside out" in refused(lambda: here.built(described, bore="70 mm"), "inside_out")


def test_parts_that_expressions_tie_are_both_parts(here, files):
    described = here.described(files["tied"])
    assert here.built(described, length="20 mm").measures["volume"] == pytest.approx(2 * 20 * 1600)


def mm(number):
    return f"{number:.3f} mm"


def drawn_by(random):
    """30 documents: kind, sizes, values of the design, the object to be named, and the right volume."""

    def length():
        return round(random.uniform(15, 35), 3)

    for n in range(3):
        hole = round(random.uniform(2, 4), 3)
        too_large = {"hole": mm(random.uniform(31, 60))}
        yield f"cut_{n}", "cut", {"hole": mm(hole)}, too_large, "Bored", None
        yield f"empty_{n}", "cut", too_large, {}, "Bored", None
        yield f"inner_{n}", "inner", {"hole": mm(hole)}, too_large, "Boss", None
        yield f"common_{n}", "common", {"at": "20 mm"}, {"at": mm(random.uniform(50, 90))}, "Core", None
        depth = mm(random.uniform(10, 30))
        yield f"split_{n}", "split", {"depth": depth}, {"depth": "41 mm"}, "Slotted", None
        yield f"met_{n}", "met", {"at": "50 mm"}, {"at": mm(random.uniform(1, 39))}, "Left", None
        yield f"doubled_{n}", "doubled", {"length": mm(length())}, {}, "One", None
        tied = length()
        yield f"tied_{n}", "tied", {"length": "12 mm"}, {"length": mm(tied)}, None, 2 * tied * 1600
    for n in range(2):
        alike = length()
        yield f"alike_{n}", "alike", {"length": mm(alike)}, {}, "Rail", 2 * alike * 1600
        yield f"linked_{n}", "linked", {"length": mm(alike)}, {}, "Again", alike * 1600
        yield f"hidden_{n}", "hidden", {"length": mm(alike)}, {}, "Unseen", alike * 1600


SEED = 37


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_no_document_with_other_ends_is_taken_silently(here):
    wanted = list(drawn_by(Random(SEED)))
    assert len(wanted) == 30
    files = documents({name: (kind, sizes) for name, kind, sizes, *_ in wanted})
    silent, wrong = list[str](), list[str]()
    for name, _, _, values, named, volume in wanted:
        try:
            described = here.described(files[name])
            told, found = " ".join(described.findings), here.built(described, **values).measures["volume"]
        except GeometryError as error:
            told, found = str(error), None
        if named and named not in told:
            silent.append(f"{name}: {told}")
        if volume and (found is None or abs(found / volume - 1) > 1e-6):
            wrong.append(f"{name}: {found} instead of {volume}: {told}")
    assert silent == []
    assert wrong == []
