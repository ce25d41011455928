"""Validation properties on request: a second reader finds them, and solids stay unchanged."""

import re

import pytest
from part21_reader import File
from slow_models import DRAWN, quick_for

from cad.errors import UnreadableStep
from cad.export import derive
from cad.file_kinds import VALIDATED
from cad.header import Header
from cad.inspect import measure
from cad.model import CadModel, Part
from cad.regenerate import Build
from cad.stamp import Stamp, stamped
from cad.step import read_step, write_step


def stated(step: bytes) -> list[tuple[str, object]]:
    return [(what, items) for name, what, items in File(step).properties() if "validation" in name]


@quick_for(*DRAWN)
def test_a_plain_file_gets_volume_area_and_centroid_of_each_part(
    model: type[CadModel], example: Build, files: dict[str, bytes]
) -> None:
    assert not stated(example.step)
    found = stated(files[VALIDATED])
    bodies = read_step(example.step)
    assert [what for what, _ in found] == ["volume", "surface area", "centroid"] * len(bodies)
    volumes = [items[0] for what, items in found if what == "volume"]
    assert volumes == pytest.approx([measure(body).volume for body in bodies], rel=1e-9)
    areas = [items[0] for what, items in found if what == "surface area"]
    assert areas == pytest.approx([body.shape.Area() for body in bodies], rel=1e-4)
    assert not list(File(files[VALIDATED]).dangling())


@quick_for(*DRAWN)
def test_solids_and_header_stay_as_they_are(example: Build, files: dict[str, bytes]) -> None:
    validated = files[VALIDATED]
    head, _, tail = example.step.rpartition(b"ENDSEC;")
    assert validated.startswith(head)
    assert validated.endswith(tail)
    numbers = [int(n) for n in re.findall(rb"^#(\d+) = ", validated, re.MULTILINE)]
    assert len(set(numbers)) == len(numbers)
    assert [body.name for body in read_step(validated)] == [body.name for body in read_step(example.step)]


def box(name: str) -> Part:
    from cadquery import Solid

    return Part(name, Solid.makeBox(1, 2, 3), 6.0)


def test_of_a_box_they_are_those_of_geometry() -> None:
    step = write_step([box("block")], Header("box", 1, {}, ""))
    (_, volume), (_, area), (_, centre) = stated(derive(step, VALIDATED))
    assert volume == pytest.approx([6], rel=1e-12)
    assert area == pytest.approx([22], rel=1e-12)
    assert centre[0] == pytest.approx([0.5, 1, 1.5], abs=1e-9)


def test_a_file_that_states_them_is_returned_as_it_is() -> None:
    once = derive(write_step([box("block")], Header("box", 1, {}, "")), VALIDATED)
    assert derive(once, VALIDATED) == once


def test_parts_of_one_name_are_refused() -> None:
    step = write_step([box("a"), box("b")], Header("box", 1, {}, "")).replace(b"'b'", b"'a'")
    with pytest.raises(UnreadableStep, match="the same name"):
        derive(step, VALIDATED)


def test_the_copy_of_a_design_carries_its_stamp() -> None:
    step = derive(write_step([box("block")], Header("box", 1, {}, "")), VALIDATED)
    mine = stamped(step, VALIDATED, Stamp("Engine", "block", 2, "2026-01-01T00:00:00"))
    assert b"design Engine" in mine
    assert stated(mine) == stated(step)


def test_a_file_whose_lines_the_kernel_breaks_between_tokens() -> None:
    # nine parts, as a bearing with bolts: the representation of the whole ends on its second line
    step = write_step([box(f"block_{n}") for n in range(1, 9)], Header("box", 1, {}, ""))
    assert re.search(rb"\(#11(?:,#\d+)+\),#\d+\s+\);", step)
    assert len(stated(derive(step, VALIDATED))) == 3 * 8
