"""An import builds a STEP file as designs do and reports what was lost."""

from dataclasses import replace
from pathlib import Path

import pytest
from cadquery import Location, Solid, Vector

from cad import examination, regenerate
from cad.errors import GeometryError
from cad.examination import examine
from cad.header import Header
from cad.imported_models import VOLUME_TOLERANCE, Description, ProgramResult
from cad.mesh import mesh
from cad.model import Part
from cad.model_classes import class_of
from cad.step import read_step, write_step

FILES = Path(__file__).with_name("brought_steps")
FIXED = Description("step", 64 * "d", "sent.step", "Fixed part", "STEP")


def step_of(*parts):
    return write_step(parts, Header("sent", 1, {}, 64 * "0"))


def box(name, size=10.0, **more):
    return Part(name, Solid.makeBox(size, size, size), size**3, **more)


def examined(step):
    return examine(FIXED.text, "sent", ProgramResult(step=step))


def at(*places):
    return tuple(Location(Vector(*place)) for place in places)


def test_an_exact_solid_is_found_unchanged():
    found = examined(step_of(box("cube")))
    told = "Written again and read back, a volume changes by less than 1e-09 of itself"
    assert found.findings == (f"{told}; the number of faces stays 6.",)
    assert found.overlapping == ()


def read_with_change(change):
    """A second read that finds other volumes, as with the solids of some other kernels."""
    count = 0

    def read(step):
        nonlocal count
        count += 1
        bodies = read_step(step)
        return tuple(replace(one, shape=one.shape.scale((1 + change) ** (1 / 3))) for one in bodies)

    return read


@pytest.mark.parametrize("change", [1.1e-6, 1.8e-6, 9e-6, 4.4e-5, 9.2e-5, -0.9 * VOLUME_TOLERANCE])
def test_a_change_by_writing_again_is_told_and_taken_by_designs_too(monkeypatch, change):
    step, read = step_of(box("cube")), read_with_change(change)
    monkeypatch.setattr(regenerate, "read_step", read)
    with monkeypatch.context() as patch:
        patch.setattr(examination, "read_step", read)
        (told,) = examined(step).findings
    assert f"a volume changes by up to {abs(change):.2g} of itself" in told
    shape = class_of(FIXED.text, "sent", 1).from_quantities({})
    shape.take(ProgramResult(step=step))
    assert regenerate.regenerate_shape(shape, {}).measures["volume"] == pytest.approx(1000 * (1 + change))


def test_a_change_beyond_the_tolerance_is_refused_at_the_import(monkeypatch):
    monkeypatch.setattr(regenerate, "read_step", read_with_change(2 * VOLUME_TOLERANCE))
    with pytest.raises(GeometryError) as caught:
        examined(step_of(box("cube")))
    assert caught.value.code == "volume"


def test_a_file_without_a_solid_is_refused():
    with pytest.raises(GeometryError, match=r"contains no solid \(faces that enclose none: 1\)") as caught:
        examined((FILES / "sheet.step").read_bytes())
    assert caught.value.code == "no_solid"


def test_loose_faces_are_told():
    _, told = examined((FILES / "mixed.step").read_bytes()).findings
    assert told.startswith("Loose faces, which belong to no solid, are left out; they are of ")
    assert told.endswith(" (1).")


def test_positions_keep_their_names():
    sent = (FILES / "pair.step").read_bytes()
    found = examined(sent)
    assert len(found.findings) == 1
    (body,) = read_step(found.step)
    assert (body.name, body.names) == ("left", ("left", "right"))
    assert mesh(body).names == ("left", "right")
    assert b"'right'" in found.step


def test_positions_with_one_name_are_renamed_and_told():
    places = at((0, 0, 0), (20, 0, 0), (40, 0, 0))
    nut = box("nut", places=places, called=("nut:1", "nut:2", "nut:2"))
    found = examined(step_of(nut, box("plate", 5.0, places=at((0, 50, 0)))))
    assert found.findings[1:] == (
        "Renamed, because names must be unique and plain: 'nut:2' is now 'nut:2_2'.",
    )
    assert read_step(found.step)[0].names == ("nut:1", "nut:2", "nut:2_2")


def test_positions_without_names_of_their_own_are_numbered():
    plain = step_of(box("ball", places=at((0, 0, 0), (20, 0, 0))))
    for names in ((b"1", b"2"), (b"", b""), (b"ball", b"ball"), (b"NAUO1", b"NAUO2")):
        sent = plain
        for number, name in enumerate(names, 1):
            sent = sent.replace(b"'ball_%d'" % number, b"'%s'" % name)
        assert sent != plain
        (body,) = read_step(sent)
        assert body.names == ("ball_1", "ball_2")


def test_overlapping_solids_are_told_with_the_space_that_counts_twice():
    sent = step_of(box("one"), box("other", places=at((4, 0, 0))), box("far", places=at((50, 0, 0))))
    found = examined(sent)
    assert found.findings[1:] == (
        "Solids overlap, so volume and mass count the common space twice: one and other overlap by 600 mm³.",
    )
    assert found.overlapping == (("one", "other"),)


def test_positions_of_one_solid_overlap_too():
    found = examined(step_of(box("cube", places=at((0, 0, 0), (1, 0, 0)))))
    assert found.overlapping == (("cube_1", "cube_2"),)


def test_two_copies_in_one_place_overlap_wholly():
    _, told = examined(step_of(box("cube", places=at((0, 0, 0), (0, 0, 0))))).findings
    assert told.endswith("cube_1 and cube_2 overlap by 1000 mm³.")


def test_solids_that_cannot_be_compared_are_told(monkeypatch):
    def cannot(bodies):
        raise GeometryError("kernel", "the kernel cannot determine whether one and other overlap")

    monkeypatch.setattr(examination, "overlaps", cannot)
    found = examined(step_of(box("one"), box("other", places=at((4, 0, 0)))))
    assert found.overlapping is None
    assert found.findings[1] == (
        "Overlaps were not examined: the kernel cannot determine whether one and other overlap."
    )


def test_too_many_pairs_are_said_not_to_be_compared(monkeypatch):
    monkeypatch.setattr(examination, "MOST_COMPARED", 0)
    found = examined(step_of(box("one"), box("other", places=at((4, 0, 0)))))
    assert found.overlapping is None
    assert found.findings[1].startswith("Overlaps were not examined: the boxes of 1 pairs of solids meet")
