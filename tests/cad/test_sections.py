"""Assembly drawings have the right section planes, cut the right parts, and show tolerances."""

import re
from xml.etree import ElementTree

import pytest

from cad.catalogue import models
from cad.drafting.svg import write_drawing
from cad.drafting.views import views
from cad.header import read_header
from cad.regenerate import as_text, regenerate_class
from cad.step import read_step
from cad.surfaces import Y


def built(id, version, **given):
    cls = models().get(id, version)
    return regenerate_class(cls, as_text(cls.from_quantities({**cls.example, **given})))


@pytest.fixture(scope="module")
def drawing():
    """Of a bush with a fine bore and a coarse width."""
    step = built("flanged_bush", 1, inner_diameter="20 mm H7", width="30 mm ± 0.1 mm").step
    return write_drawing(read_step(step), read_header(step)).decode()


@pytest.mark.parametrize("crush", ["0 mm", "0.06 mm"])
def test_a_pair_of_shells_is_cut_through_the_crown_and_not_in_its_joint(crush):
    build = built("plain_bearing", 1, shells="pair", oil_hole_diameter="0 mm", crush_height=crush)
    section, _ = views(read_step(build.step))
    assert section.frame.up == Y
    assert {cut.part for cut in section.cut} == {0, 1, 2, 3}


def test_the_journal_of_an_assembly_is_not_cut():
    bodies = read_step(built("bearing_assembly", 1).step)
    section, _ = views(bodies)
    assert {bodies[cut.part].name for cut in section.cut} == {body.name for body in bodies} - {"journal"}


def test_a_line_that_crosses_a_word_of_a_dimension_is_interrupted(drawing):
    root = ElementTree.fromstring(drawing)
    drawn = [node for group in root for node in group]
    kinds = [node.tag.rpartition("}")[2] for node in drawn]
    assert kinds == sorted(kinds)  # every path, then every text
    word = next(node for node in drawn if node.text == "Ø20 H7")
    assert (word.get("stroke"), word.get("paint-order")) == ("white", "stroke")


def test_only_a_finer_texture_stands_beside_its_face(drawing):
    assert re.findall("Ra [0-9.]+", drawing).count("Ra 3.2") == 1  # that of all other faces
    assert "Ra 0.8" in drawing


def test_equal_deviations_are_written_once_in_the_table(drawing):
    assert ">30 ±0.1<" in drawing
