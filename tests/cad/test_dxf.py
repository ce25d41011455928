"""Drawings of every model: valid DXF with dimensions that measure the parameters, equal to the SVG."""

import io
import re
from math import hypot
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
from bare_shells import BUSH, HALF
from ezdxf.document import Drawing
from ezdxf.entitydb import EntityDB
from slow_models import DRAWN

from cad.catalogue import models
from cad.drafting.hatch import hatch
from cad.drafting.measures import measures
from cad.drafting.parameter_match import matched
from cad.drafting.views import views
from cad.export import derive
from cad.header import read_header
from cad.inspect import bounding_box, look_at
from cad.regenerate import Build, as_text, regenerate_class
from cad.step import read_step
from cad.surfaces import Z
from templates.core.units.units import unit

SHEETS = {
    "A3": ("420mm", "297mm"),
    "A2": ("594mm", "420mm"),
    "A1": ("841mm", "594mm"),
    "A0": ("1189mm", "841mm"),
}  # ISO 216
SHOWN = 0.9  # of the lengths and angles of an example
NOT_DRAWN = {"free_spread", "pin_split"}  # of a shell that its housing holds; in the table, as pin angles are
OF_NONE = {
    "tang_length",
    "tang_height",
    "relief_height",
    "flange_thickness",
    "free_spread",
    "oil_groove_angle",
    "reduction_height",
}
"""Sizes of features that a bare shell has not; its groove goes from joint to joint."""
QUICK_MODELS = DRAWN


@pytest.fixture
def drawing(dxf: bytes) -> Drawing:
    return ezdxf.read(io.StringIO(dxf.decode()))


def dimensions(drawing: Drawing) -> dict[str, float]:
    """The measured value of every DIMENSION, by the parameter whose name it carries."""
    return {
        entity.get_xdata("CRANKWRIGHT")[0].value: float(entity.get_measurement())
        for entity in drawing.modelspace().query("DIMENSION")
        if entity.has_xdata("CRANKWRIGHT")
    }


def wanted(text: str) -> float:
    """A parameter in millimetres or degrees."""
    value, name = text.split(" ")
    scale = unit(name)
    shown = unit("mm" if scale.base == unit("m").base else "deg")
    return float(shown.from_si(scale.to_si(float(value))))


def test_the_file_is_sound(drawing: Drawing) -> None:
    audit = drawing.audit()
    assert not audit.errors
    assert not audit.fixes


def test_it_is_in_millimetres_on_layers(drawing: Drawing) -> None:
    assert drawing.header["$INSUNITS"] == 4
    used = {entity.dxf.layer for entity in drawing.modelspace()}
    assert {"OUTLINE", "DIMENSIONS", "FRAME", "TEXT", "CENTRE", "SYMBOLS"} <= used
    assert used <= {layer.dxf.name for layer in drawing.layers}


def test_every_dimension_measures_its_parameter(example: Build, drawing: Drawing) -> None:
    header = read_header(example.step)
    assert header is not None
    sizes = {
        n: text
        for n, text in header.parameters.items()
        if (
            " " in text
            and not text.startswith("[")
            and wanted(text) != 0
            and n not in NOT_DRAWN
            and not n.startswith(("bolt_", "dowel_"))
        )  # bolts and dowels have sheets of their own
        or n in dimensions(drawing)
    }
    result = dimensions(drawing)
    assert result.keys() <= sizes.keys()
    assert len(result) >= SHOWN * len(sizes), sorted(sizes.keys() - result.keys())
    for name, value in result.items():
        assert value == pytest.approx(wanted(sizes[name]), rel=1e-6), name


def test_dimensions_are_drawn_with_their_numbers(drawing: Drawing) -> None:
    for entity in drawing.modelspace().query("DIMENSION"):
        reported = "".join(
            part.plain_text() for part in entity.virtual_entities() if part.dxftype() == "MTEXT"
        )
        number = reported.removesuffix("×45°").strip("()°").rpartition("×")[2].lstrip("SØR")
        assert float(number) == pytest.approx(entity.get_measurement(), abs=5.1e-4), reported


def test_views_are_true_to_the_part(example: Build) -> None:
    bodies = read_step(example.step)
    section, end = views(bodies)
    box = bounding_box(bodies)
    (left, _), (right, _) = section.box
    assert (left, right) == pytest.approx((box.low[2], box.high[2]), abs=1e-3)
    (left, low), (right, high) = end.box
    sizes = sorted(high - low for low, high in zip(box.low[:2], box.high[:2], strict=True))
    assert sorted((right - left, high - low)) == pytest.approx(sizes, rel=2e-3)


def test_title_block_names_model_build_and_scale(example: Build, drawing: Drawing) -> None:
    texts = [entity.dxf.text for entity in drawing.modelspace().query("TEXT")]
    assert f"{example.model.replace('_', ' ')}, version {example.version}" in texts
    assert f"build {example.key[:32]}" in texts
    assert any(re.fullmatch("1:[125]0*|[125]0*:1", text) for text in texts)


def test_everything_lies_within_the_sheet(drawing: Drawing) -> None:
    sheet = drawing.modelspace().query('LWPOLYLINE[layer=="FRAME"]').first
    corners = np.array(sheet.get_points("xy"))
    low, high = corners.min(axis=0), corners.max(axis=0)
    for entity in drawing.modelspace().query("LWPOLYLINE"):
        points = np.array(entity.get_points("xy"))
        assert (points >= low - 1e-9).all()
        assert (points <= high + 1e-9).all()


@pytest.mark.slow  # the order of sets, below, asks the same and more
def test_equal_files_from_equal_steps(example: Build, dxf: bytes) -> None:
    assert derive(example.step, "dxf") == dxf


def test_svg_shows_the_same(svg: bytes, drawing: Drawing) -> None:
    root = ElementTree.fromstring(svg)
    formats = {text.dxf.text for text in drawing.modelspace().query("TEXT")} & SHEETS.keys()
    assert [SHEETS[name] for name in formats] == [(root.attrib["width"], root.attrib["height"])]
    texts = [node.text for node in root.iter("{http://www.w3.org/2000/svg}text")]
    words = [entity.dxf.text for entity in drawing.modelspace().query("TEXT")]
    assert set(words) <= {text or "" for text in texts}
    count = len(drawing.modelspace().query("DIMENSION"))
    assert len(texts) >= len(words) + count
    assert not [name for node in root.iter() for name in node.attrib if name in ("style", "onload", "href")]


def bare(**given: str) -> Build:
    """Return a shell of one body, a full bush unless another is asked for."""
    model = models().get("plain_bearing", 1)
    return regenerate_class(model, as_text(model.from_quantities({**BUSH, **given})))


def test_a_size_is_matched_by_the_faces_that_carry_it() -> None:
    build = bare(inner_diameter="40 mm", width="40 mm")
    bodies = read_step(build.step)
    seen = look_at(bodies)
    part = seen["full_back"]
    sizes = {"width": part.length(Z), "inner_diameter": part.diameters(Z)[0]}
    texts = {"width": "40 mm", "inner_diameter": "40 mm", "wall": "7 mm"}
    result, unseen = matched(texts, sizes, measures(bodies, seen, *views(bodies)), {})
    sorts = {one.name: one.measure.sort for one in result}
    assert sorts == {"width": "length", "inner_diameter": "diameter"}
    assert unseen == ["wall"]


@pytest.mark.parametrize(
    "parameters",
    [
        {**HALF, "inner_diameter": "50 mm", "oil_hole_diameter": "0 mm"},
        {**HALF, "inner_diameter": "50 mm", "oil_hole_diameter": "0 mm", "oil_groove_width": "0 mm"},
        {**BUSH, "inner_diameter": "50 mm", "oil_groove_width": "0 mm"},
        {**HALF, "inner_diameter": "1 mm"},
        {**HALF, "inner_diameter": "5 m"},
    ],
)
@pytest.mark.sampled(2)
def test_shells_of_all_kinds_and_sizes(parameters: dict[str, str]) -> None:
    build = bare(**parameters)
    drawing = ezdxf.read(io.StringIO(derive(build.step, "dxf").decode()))
    header = read_header(build.step)
    assert header is not None
    sizes = {n: wanted(text) for n, text in header.parameters.items() if n not in OF_NONE and " " in text}
    there = {name: size for name, size in sizes.items() if size != 0}
    shown = {name: value for name, value in dimensions(drawing).items() if name not in OF_NONE}
    assert shown == pytest.approx(there, rel=1e-6)
    assert not drawing.audit().errors


def test_a_part_of_nobody_gets_a_drawing_with_reference_lengths() -> None:
    build = bare(inner_diameter="40 mm")
    foreign = build.step.replace(b"Crankwright plain_bearing", b"Somebody plain_bearing")
    assert read_header(foreign) is None
    drawing = ezdxf.read(io.StringIO(derive(foreign, "dxf").decode()))
    assert not drawing.audit().errors
    assert len(drawing.modelspace().query("DIMENSION")) >= 1
    assert dimensions(drawing) == {}


def test_hatch_stays_within_its_outline() -> None:
    square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
    hole = [(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0), (4.0, 4.0)]
    lines = [*hatch([square, hole], 0.01)]
    length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in lines)
    assert length * 0.01 == pytest.approx(96.0, rel=1e-3)  # the area
    for a, b in lines:
        middle = (a[0] + b[0]) / 2, (a[1] + b[1]) / 2
        assert 0 <= min(middle) <= max(middle) <= 10
        assert abs((b[1] - a[1]) - (b[0] - a[0])) < 1e-9  # at 45°


@pytest.mark.parametrize("backwards", [pytest.param(False, marks=pytest.mark.slow), True])
def test_the_order_of_sets_does_not_show(
    example: Build, dxf: bytes, monkeypatch: pytest.MonkeyPatch, backwards: bool
) -> None:
    """A set of texts is walked in another order by every process."""
    in_use = EntityDB.dxf_types_in_use
    monkeypatch.setattr(EntityDB, "dxf_types_in_use", lambda self: sorted(in_use(self), reverse=backwards))
    assert derive(example.step, "dxf") == dxf
