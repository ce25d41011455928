"""The DXF entities of drawings obey a checklist of rules, and texts do not overlap."""

import io
from collections.abc import Sequence
from math import cos, hypot, radians, sin
from xml.etree import ElementTree

import ezdxf
import pytest
from bare_shells import BUSH, HALF
from ezdxf import path
from ezdxf.document import Drawing
from ezdxf.math import is_point_in_polygon_2d
from PIL import ImageFont
from slow_models import DRAWN
from undivided import TWO_THROWS

from benchmarks.drawings import SIZES, latest, sized
from cad.catalogue import models
from cad.drafting.curves import Curve, Round, joined, recognised, rounded
from cad.drafting.room import Room, overlap
from cad.drafting.title import general_profile
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, as_text, regenerate_from_text

QUICK_MODELS = DRAWN
SVG = "{http://www.w3.org/2000/svg}"
FIELDS = ("owner title author checker approver status number revision date material mass part").split()

Rectangle = tuple[float, float, float, float]


@pytest.fixture(scope="module")
def font() -> ImageFont.FreeTypeFont:
    """DejaVu Sans, the widest letters in which a browser shows a drawing."""
    matplotlib = pytest.importorskip("matplotlib")
    return ImageFont.truetype(f"{matplotlib.get_data_path()}/fonts/ttf/DejaVuSans.ttf", 200)


def read(dxf: bytes) -> Drawing:
    return ezdxf.read(io.StringIO(dxf.decode()))


def boxes(svg: bytes, font: ImageFont.FreeTypeFont) -> dict[str, Rectangle]:
    """The rectangle of every text of a drawing [mm], by its place and words; y points down."""
    result = {}
    for node in ElementTree.fromstring(svg).iter(f"{SVG}text"):
        text, size = node.text or "", float(node.attrib["font-size"])
        if not text:
            continue
        x, y = float(node.attrib["x"]), float(node.attrib["y"])
        width = font.getlength(text) / 200 * size
        left = x - width / 2 if node.attrib.get("text-anchor") == "middle" else x
        corners = [(left, y - 0.74 * size), (left + width, y), (left, y), (left + width, y - 0.74 * size)]
        if turn := node.attrib.get("transform"):
            angle, at_x, at_y = map(float, turn.removeprefix("rotate(").removesuffix(")").split())
            c, s = cos(radians(angle)), sin(radians(angle))
            corners = [
                (at_x + (a - at_x) * c - (b - at_y) * s, at_y + (a - at_x) * s + (b - at_y) * c)
                for a, b in corners
            ]
        across, down = zip(*corners, strict=True)
        result[f"{x:.1f} {y:.1f} {text}"] = min(across), min(down), max(across), max(down)
    return result


def overlapping(svg: bytes, font: ImageFont.FreeTypeFont) -> list[tuple[str, str]]:
    every = list(boxes(svg, font).items())
    return [
        (one, other)
        for i, (one, box) in enumerate(every)
        for other, its in every[:i]
        if overlap(box, its, -0.05)
    ]


def outlines_under_dimensions(drawing: Drawing) -> list[str]:
    """Words of dimensions across an edge of the part."""
    space, crossed = drawing.modelspace(), []
    edges = list(space.query('LINE[layer=="OUTLINE"]'))
    for dimension in space.query("DIMENSION"):
        for words in dimension.virtual_entities():
            if words.dxftype() != "MTEXT":
                continue
            (x, y, _), half = words.dxf.insert, words.dxf.char_height / 2
            for edge in edges:
                (a, b, _), (c, d, _) = edge.dxf.start, edge.dxf.end
                share = max(
                    0.0, min(1.0, ((x - a) * (c - a) + (y - b) * (d - b)) / (hypot(c - a, d - b) ** 2))
                )
                if hypot(a + share * (c - a) - x, b + share * (d - b) - y) < half:
                    crossed.append(words.plain_text())
    return crossed


def marks(drawing: Drawing) -> set[str]:
    texts = drawing.modelspace().query("TEXT")
    return {t.get_xdata("CRANKWRIGHT")[0].value for t in texts if t.has_xdata("CRANKWRIGHT")}


def words(drawing: Drawing) -> list[str]:
    return [text.dxf.text for text in drawing.modelspace().query("TEXT")]


def is_shaft(model: type[CadModel]) -> bool:
    return model.is_throw() or model.shaft is not CadModel.shaft


def test_checklist(model: type[CadModel], dxf: bytes) -> None:
    drawing = read(dxf)
    space = drawing.modelspace()
    layers: dict[str, list[str]] = {}
    for entity in space:
        layers.setdefault(entity.dxf.layer, []).append(entity.dxftype())
    # ISO 7200: every field of the title block, those of a design for a stamp
    assert marks(drawing) >= {f"stamp:iso-{name}" for name in FIELDS}
    captions = words(drawing)
    for caption in ("legal owner", "identification number", "document status", "mass", "scale", "projection"):
        assert caption in captions
    # ISO 5456-2: first angle, the cone's small end to the left, the circles to its right
    circles = sorted(space.query('CIRCLE[layer=="SYMBOLS"]'), key=lambda circle: circle.dxf.radius)[-2:]
    assert circles[0].dxf.center.isclose(circles[1].dxf.center)
    assert circles[1].dxf.radius == pytest.approx(2 * circles[0].dxf.radius)
    # ISO 128-2: centre lines, dash-dotted
    assert layers["CENTRE"].count("LINE") >= 3
    assert drawing.layers.get("CENTRE").dxf.linetype == "CENTER"
    # true arcs
    assert {"ARC", "CIRCLE"} & set(layers["OUTLINE"])
    # ISO 128-3: cut faces are hatched by one entity each, and marked; shafts are cut only across
    letters = {caption[0] for caption in captions if caption[1:2] == "–"}
    assert bool(space.query("HATCH")) is bool(letters)
    assert ("A" in letters) is not is_shaft(model)
    assert is_shaft(model) or len(letters) == 1 + len(model.sections)
    # a cutting line has a letter at each of its two thick ends, and equal webs share a section
    ends = sum(captions.count(letter) for letter in letters) if is_shaft(model) else 2 * len(letters)
    assert layers.get("CUTTING", []).count("LWPOLYLINE") == ends
    assert all(captions.count(letter) >= 2 for letter in letters)
    # ISO 129-1, ISO 2768, ISO 21920-1
    assert layers["DIMENSIONS"].count("DIMENSION") >= 1
    assert ("ISO 2768-mK" in captions) is not ("ISO 2768-m, ISO 22081" in captions)
    assert "Ra 3.2" in captions
    assert outlines_under_dimensions(drawing) == []


def test_no_words_overlap(svg: bytes, font: ImageFont.FreeTypeFont) -> None:
    assert overlapping(svg, font) == []


def test_overlapping_words_are_noticed(font: ImageFont.FreeTypeFont) -> None:
    svg = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'
    text = '<text x="{}" y="10" font-size="4">Ø48</text>'
    assert len(overlapping(svg.format(text.format(10) + text.format(12)).encode(), font)) == 1
    assert overlapping(svg.format(text.format(10) + text.format(30)).encode(), font) == []


@pytest.mark.slow
@pytest.mark.parametrize("factor", SIZES)
@pytest.mark.parametrize("newest", list(latest()), ids=lambda cls: cls.id)
def test_no_words_overlap_at_three_sizes(
    newest: type[CadModel], factor: float, font: ImageFont.FreeTypeFont
) -> None:
    build = sized(newest, factor)
    assert overlapping(derive(build.step, "drawing.svg"), font) == []
    assert outlines_under_dimensions(read(derive(build.step, "dxf"))) == []


def toleranced(texts: dict[str, str]) -> Build:
    model = models().get("plain_bearing", 1).from_quantities({**HALF, "inner_diameter": "48 mm", **texts})
    return regenerate_from_text(model.id, model.version, as_text(model))


@pytest.fixture(scope="module")
def fitted() -> bytes:
    return toleranced(
        {"inner_diameter": "48 mm H7", "width": "24 mm +0.05/-0.02 mm", "wall": "2.4 mm ±0.01 mm"}
    ).step


def labels(drawing: Drawing) -> dict[str, str]:
    """The words of every dimension that carries a parameter, as DXF has them."""
    return {
        dimension.get_xdata("CRANKWRIGHT")[0].value: part.text
        for dimension in drawing.modelspace().query("DIMENSION")
        if dimension.has_xdata("CRANKWRIGHT")
        for part in dimension.virtual_entities()
        if part.dxftype() == "MTEXT"
    }


def test_tolerances_and_fits(fitted: bytes) -> None:
    """ISO 286-2: H7 at 48 mm is +25/0 µm."""
    result = labels(read(derive(fitted, "dxf")))
    assert result["inner_diameter"] == "Ø48 H7 {\\H0.7x;\\S+0.025^ 0;}"
    assert result["width"] == "24 {\\H0.7x;\\S+0.05^ -0.02;}"
    assert result["wall"] == "2.4 ±0.01"
    assert result["oil_hole_diameter"] == "Ø3.84"


def test_datum_geometric_tolerances_and_texture(fitted: bytes, font: ImageFont.FreeTypeFont) -> None:
    drawing = read(derive(fitted, "dxf"))
    texts = words(drawing)
    assert texts.count("0.0125") == 1  # cylindricity: half of 25 µm
    assert texts.count("0.07") == 1  # perpendicularity: the width of +50/-20 µm
    assert texts.count("A") == 2 + 3  # of the cutting line, the datum, two frames that refer to it
    assert "Ra 0.8" in texts  # a twentieth of 25 µm is 1.25 µm
    assert (
        len(drawing.modelspace().query('SOLID[layer=="SYMBOLS"]')) >= 2 + 1 + 2
    )  # arrows, the triangle, leaders
    svg = derive(fitted, "drawing.svg")
    shown = [node.text for node in ElementTree.fromstring(svg).iter(f"{SVG}text")]
    assert shown.count("+0.025") == shown.count("-0.02") == 1
    assert overlapping(svg, font) == []


@pytest.mark.slow
def test_words_do_not_overlap_where_everything_is_toleranced(font: ImageFont.FreeTypeFont) -> None:
    model = models().get("ball_bearing", 1)
    texts = as_text(model.from_quantities(model.example))
    for name in model.toleranced:
        texts[name] += " +0.025/-0.013 mm"
    step = regenerate_from_text(model.id, model.version, texts).step
    assert overlapping(derive(step, "drawing.svg"), font) == []
    drawing = read(derive(step, "dxf"))
    assert labels(drawing)["ball_diameter"] == "11×SØ12 +0.025/-0.013"
    assert not drawing.audit().errors


def test_balls_are_not_cut_and_rings_are(example_of, font) -> None:
    build = example_of(models().get("ball_bearing", 1))
    drawing = read(derive(build.step, "dxf"))
    radius = build.dimensions["ball_diameter"] / 2
    balls = [c for c in drawing.modelspace().query("CIRCLE") if c.dxf.radius == pytest.approx(radius)]
    hatches = list(drawing.modelspace().query("HATCH"))
    assert balls
    assert len(hatches) == 4  # two rings, each cut twice
    assert {hatch.dxf.pattern_name for hatch in hatches} == {"ANSI31"}
    assert len({hatch.pattern.lines[0].angle for hatch in hatches}) == 2
    for ball in balls:
        for hatch in hatches:
            assert not holds(hatch, ball.dxf.center)


def holds(hatch, point) -> bool:
    outlines = [[corner.vec2 for corner in line.flattening(0.01)] for line in path.from_hatch(hatch)]
    return any(is_point_in_polygon_2d(point.vec2, line) > 0 for line in outlines)


def extent(entities) -> tuple[float, float, float, float]:
    """Left, low, right, high of the corners of entities."""
    every = [corner for one in entities for corner in path.make_path(one).flattening(0.1)]
    across, up = [corner.x for corner in every], [corner.y for corner in every]
    return min(across), min(up), max(across), max(up)


def test_views_fill_their_sheet(dxf: bytes) -> None:
    """ISO 5455, ISO 5457: at least a third of the width or the height that a sheet leaves for views."""
    space = read(dxf).modelspace()
    left, low, right, high = extent(space.query("LINE ARC CIRCLE LWPOLYLINE").query('*[layer=="OUTLINE"]'))
    sheet = extent([space.query('LWPOLYLINE[layer=="FRAME"]').first])
    (name,) = {text.dxf.text for text in space.query("TEXT")} & {"A3", "A2", "A1", "A0"}
    wide, tall = {"A3": (420, 297), "A2": (594, 420), "A1": (841, 594), "A0": (1189, 841)}[name]
    scale = wide / (sheet[2] - sheet[0])
    assert scale * (sheet[3] - sheet[1]) == pytest.approx(tall)
    assert max((right - left) * scale / (wide - 134), (high - low) * scale / (tall - 66)) > 0.33
    (text,) = {t.dxf.text for t in space.query("TEXT") if ":" in t.dxf.text and t.dxf.text[0].isdigit()}
    paper, part = map(float, text.split(":"))
    assert paper / part == pytest.approx(scale)
    assert f"{paper / part:.1e}"[0] in "125"


@pytest.mark.parametrize(("id", "hole"), [("connecting_rod", "bolt_hole"), ("bearing_housing", "bolt_hole")])
def test_a_hole_that_no_section_shows_is_broken_out(example_of, id: str, hole: str) -> None:
    """ISO 128-3: one of two bolt holes, bounded by thin lines with zigzags; both have centre lines."""
    build = example_of(models().latest(id))
    drawing = read(derive(build.step, "dxf"))
    space = drawing.modelspace()
    sides = list(space.query('LWPOLYLINE[layer=="BREAK"]'))
    assert len(sides) == 2  # towards the bore and above the blind end; the others lie beyond the part
    assert drawing.layers.get("BREAK").dxf.lineweight < drawing.layers.get("OUTLINE").dxf.lineweight
    sizes = [(max(u - x, v - y), len(side)) for side in sides for x, y, u, v in [extent([side])]]
    assert all((points > 2) == (size > 8) for size, points in sizes)  # a short side has no zigzag
    assert max(points for _, points in sizes) > 2
    left, _, _, _ = extent(sides)
    breadth = next(value for name, value in build.dimensions.items() if name.endswith("_breadth"))
    right = max(
        line.dxf.start.x
        for line in space.query('LINE[layer=="OUTLINE"]')
        if line.dxf.start.x < left + breadth
    )
    hatches = [
        hatch
        for hatch in space.query("HATCH")
        if left - 1e-6 < extent([hatch])[0] and extent([hatch])[2] < right + 1e-6
    ]
    assert len({hatch.pattern.lines[0].angle for hatch in hatches}) == 2  # both parts, each in its direction
    diameter, spacing = build.dimensions[f"{hole}_diameter"], build.dimensions["bolt_spacing"]
    upright = [line for line in space.query('LINE[layer=="CENTRE"]') if line.dxf.start.x == line.dxf.end.x]
    axes = sorted({round(line.dxf.start.x, 4) for line in upright})
    pairs = [(a, b) for a in axes for b in axes if b - a == pytest.approx(spacing)]
    assert len(pairs) == 1
    opened = pairs[0][1]
    edges = {
        round(line.dxf.start.x - opened, 4)
        for line in space.query('LINE[layer=="OUTLINE"]')
        if abs(line.dxf.start.x - line.dxf.end.x) < 1e-6
    }
    assert {round(-diameter / 2, 4), round(diameter / 2, 4)} <= edges
    assert labels(drawing)["bolt_hole_diameter"] == f"2×Ø{diameter:g}"


@pytest.fixture(scope="module")
def rod() -> Build:
    """The example of a rod, with a fit."""
    model = models().get("connecting_rod", 1)
    texts = as_text(model.from_quantities(model.example))
    return regenerate_from_text(model.id, 1, {**texts, "big_end_bore": "51.8 mm H6"})


def test_a_rod_is_cut_across_its_shank(rod: Build, font: ImageFont.FreeTypeFont) -> None:
    """ISO 128-3: B–B shows the I with its four sizes; no extension line crosses the big end any more."""
    drawing = read(derive(rod.step, "dxf"))
    space = drawing.modelspace()
    captions = words(drawing)
    assert captions.count("B–B") == 1
    assert captions.count("B") == 2
    # a removed section has one hatch, of the area of the I, by the shoelace formula
    sizes = rod.dimensions
    width, thick = sizes["shank_width"], sizes["shank_thickness"]
    area = width * thick - sizes["pocket_width"] * (thick - sizes["web_thickness"])
    corners = [
        [corner.vec2 for corner in line.flattening(0.01)]
        for hatch in space.query("HATCH")
        for line in path.from_hatch(hatch)
    ]
    areas = [
        abs(sum(a.x * b.y - b.x * a.y for a, b in zip(line, line[1:] + line[:1], strict=True))) / 2
        for line in corners
    ]
    (place,) = [number for number, one in enumerate(areas) if one == pytest.approx(area, rel=1e-9)]
    left, right = min(c.x for c in corners[place]), max(c.x for c in corners[place])
    assert right - left == pytest.approx(width)
    shown = {"shank_width", "shank_thickness", "pocket_width", "web_thickness"}
    dimensions = {
        d.get_xdata("CRANKWRIGHT")[0].value: d for d in space.query("DIMENSION") if d.has_xdata("CRANKWRIGHT")
    }
    for name in shown:
        assert left - 1e-6 <= dimensions[name].dxf.defpoint2.x <= right + 1e-6
        assert dimensions[name].get_measurement() == pytest.approx(sizes[name])
    assert not any("(" in text for text in labels(drawing).values())
    assert overlapping(derive(rod.step, "drawing.svg"), font) == []


@pytest.mark.slow  # test_pmi.py reads counted lengths in the quick lane
def test_lengths_that_repeat_are_given_once_and_counted() -> None:
    """ISO 129-1: a shaft of two throws has 3 journals, 2 pins, 4 webs; its overall length is the solid's.

    Other lengths locate only the mouths of the oil drilling: in the middle of a journal of 26 mm, from its
    thrust face 1 mm high, and in the middle of a pin of 32 mm.
    """
    model = models().get("crankshaft", 1)
    texts = as_text(model.from_quantities({**TWO_THROWS, "counterweight_radius": "0 mm"}))
    build = regenerate_from_text(model.id, 1, {**texts, "pin_length": "32 mm ±0.1 mm"})
    drawing = read(derive(build.step, "dxf"))
    result = labels(drawing)
    assert (result["journal_length"], result["web_thickness"]) == ("3×26", "4×18")
    assert result["pin_length"] == "2×32 ±0.1"
    lengths = [
        d.get_measurement()
        for d in drawing.modelspace().query("DIMENSION")
        if not d.has_xdata("CRANKWRIGHT") and d.dxf.angle % 180 == 0
    ]
    whole = build.measures["high_z"] - build.measures["low_z"]
    assert sorted(lengths) == pytest.approx([26 / 2 - 1, 32 / 2, whole])


def test_a_leader_keeps_out_of_the_views_where_it_can() -> None:
    room = Room((0, 0, 100, 100))
    room.add_outline([(20, 20), (60, 20), (60, 60), (20, 60), (20, 20)])
    assert room.lines_met((30, 50), (30, 90)) == 1
    assert room.lines_met((0, 40), (100, 40)) == 2
    assert room.lines_met((0, 70), (100, 70)) == 0


@pytest.mark.slow
def test_general_tolerances_with_a_datum(rod: Build, example_of) -> None:
    """ISO 22081: the profile of all surfaces about datum A, as wide as ISO 2768-m allows the longest side."""
    space = read(derive(rod.step, "dxf")).modelspace()
    assert "ISO 2768-m, ISO 22081" in [t.dxf.text for t in space.query("TEXT")]
    (general,) = [t for t in space.query("TEXT") if t.dxf.text.startswith("ISO 2768-m, ")]
    unit, corner = general.dxf.height / 2.5, general.dxf.insert  # 1 mm on paper
    away = [(t.dxf.text, (t.dxf.insert - corner) / unit) for t in space.query("TEXT") if t is not general]
    beside = [text for text, (x, y, _) in away if abs(y) < 1 and 0 < x < 65]
    assert sorted(beside) == ["1", "A"]  # the rod is 197 mm long: ±0.5 mm
    bearing = read(derive(example_of(models().get("ball_bearing", 1)).step, "dxf"))
    assert "ISO 2768-mK" in words(bearing)  # an assembly has no datum of its own


@pytest.mark.parametrize(
    ("longest", "width"), [(6, 0.2), (6.1, 0.4), (120, 0.6), (400, 1.0), (4000, 4.0), (4001, None)]
)
def test_general_profile(longest: float, width: float | None) -> None:
    assert general_profile(longest) == width


def test_nothing_is_broken_out_that_the_section_shows(example_of) -> None:
    space = read(derive(example_of(models().get("flanged_bush", 1)).step, "dxf")).modelspace()
    assert not space.query('*[layer=="BREAK"]')


def test_extension_lines_begin_at_the_outline(example_of) -> None:
    """The heights of block and cap, between the joint and their ends, are not drawn across the housing."""
    drawing = read(derive(example_of(models().latest("bearing_housing")).step, "dxf"))
    space = drawing.modelspace()
    ends = [end for line in space.query('LINE[layer=="OUTLINE"]') for end in (line.dxf.start, line.dxf.end)]
    heights = [d for d in space.query("DIMENSION") if d.has_xdata("CRANKWRIGHT")]
    heights = [d for d in heights if d.get_xdata("CRANKWRIGHT")[0].value in ("block_height", "cap_height")]
    assert len(heights) == 2
    for height in heights:
        for point in (height.dxf.defpoint2, height.dxf.defpoint3):
            at_this_height = [end.x for end in ends if abs(end.y - point.y) < 1e-3]
            assert point.x == pytest.approx(max(at_this_height))


def test_arcs_of_the_svg_are_arcs() -> None:
    build = toleranced(BUSH)
    root = ElementTree.fromstring(derive(build.step, "drawing.svg"))
    outlines = [p.attrib["d"] for p in root.iter(f"{SVG}path") if p.attrib.get("stroke-width") == "0.6"]
    assert any("A" in d for d in outlines)
    assert all(d.count("L") < 20 for d in outlines)


def test_pdf_is_the_drawing() -> None:
    pypdf = pytest.importorskip("pypdf")
    pdf = derive(toleranced({}).step, "drawing.pdf")
    assert derive(toleranced({}).step, "drawing.pdf") == pdf
    (page,) = pypdf.PdfReader(io.BytesIO(pdf)).pages
    width, height = (float(side) / 72 * 25.4 for side in page.mediabox[2:])
    assert (width, height) == pytest.approx((420, 297), abs=0.1)
    text = page.extract_text()
    for expected in ("identification number", "ISO 2768-m, ISO 22081", "plain bearing, version 1", "24"):
        assert expected in text


def test_curves_join_and_give_way() -> None:
    halves = [rounded(Round((0, 0), 5, start, 180.0)) for start in (90.0, 270.0)]
    (circle,) = joined([*halves, halves[0]])
    assert circle.arc is not None
    assert circle.arc.is_whole
    (line,) = joined([Curve([(0, 0), (4, 0)]), Curve([(10, 0), (3, 0)])])
    assert sorted(line.points) == [(0, 0), (10, 0)]
    left = joined([line], [Curve([(2, 0), (5, 0)])])
    assert sorted(sorted(curve.points) for curve in left) == [
        [(0.0, 0.0), (2.0, 0.0)],
        [(5.0, 0.0), (10.0, 0.0)],
    ]
    for x in (0.0, -1e-14, 1e-14):  # upright but for rounding, to either side
        (upright,) = joined([Curve([(3.0, -40.0), (3.0 + x, 40.0)])])
        assert sorted(y for _, y in upright.points) == pytest.approx([-40.0, 40.0])
    points: Sequence[tuple[float, float]] = [(cos(t / 10), sin(t / 10)) for t in range(12)]
    arc = recognised([*points]).arc
    assert arc is not None
    assert (arc.radius, arc.turn) == pytest.approx((1.0, 63.025), abs=1e-2)
