"""Three readers find PMI and properties in STEP files, and they agree with the typed limits."""

import hashlib
import io
import re
import subprocess
import sys
from collections import Counter
from decimal import Decimal
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from bare_shells import HALF
from cadquery import Shape, Vertex
from part21_reader import File
from seeds import seeded
from sizes_of import sizes_of
from undivided import TWO_THROWS

from cad.catalogue import models
from cad.errors import GeometryError
from cad.inspect import measure
from cad.pmi import FORM_SIGNS, SIGNS
from cad.pmi_presentation import strokes
from cad.regenerate import as_text, build_key, regenerate_class
from cad.statements import UNITS, compared, read_statements
from cad.step import read_step
from templates.core.errors import InvalidInputs
from templates.core.units.fits import deviations

QUICK = [("plain_bearing", 1)] * 6 + [("ball_bearing", 1)] * 3 + [("crank_throw", 1)]
ALL = [
    ("plain_bearing", 1), ("ball_bearing", 1), ("flanged_bush", 1), ("thrust_washer", 1), ("crank_throw", 1),
    ("crankshaft", 1), ("bearing_housing", 1),
    ("bearing_assembly", 1), ("connecting_rod", 1),
]  # fmt: skip
ZONES = ("H6", "H7", "H8", "G7", "JS7", "P7", "h6", "g6", "f7", "js6", "k6", "p6")
BETWEEN_AXES = (
    "throw", "centre_distance", "bolt_spacing", "relief_depth", "pin_circle_diameter/2",
    "bolt_circle_diameter/2",
)  # fmt: skip
"""Distances of cylinders whose radii say nothing of it."""
CIRCLES = ("pin_circle_diameter", "bolt_circle_diameter")
FREECAD = Path("/usr/lib/freecad-python3/lib")
OPEN_IN_FREECAD = """
import sys
sys.path.append(sys.argv[1])
import FreeCAD
import Part
for path in sys.argv[2:]:
    shape = Part.Shape()
    shape.read(path)
    assert shape.isValid() and len(shape.Solids) > 0, path
    print(shape.Volume)
"""


def typed(rng, number):
    """A random tolerance as a user types it, and its deviations in mm: lower, upper."""
    digits = int(rng.integers(0, 4))
    low, high = sorted(Decimal(str(round(rng.uniform(0.5, 60), digits))) for _ in range(2))
    forms = {
        f"± {high} um": (-high, high),
        f"+{high}/-{low} um": (-low, high),
        f"+{high + 1}/+{low} um": (low, high + 1),
        f"-{low}/-{high + 1} um": (-high - 1, -low),
        f"0/-{high} um": (-high, Decimal(0)),
    }
    text, (lower, upper) = list(forms.items())[rng.integers(len(forms))]
    if rng.random() < 0.4:
        zone = str(rng.choice(ZONES))
        ends = (round(end * 1e3, 9) for end in deviations(zone, number * 1e-3))
        return f" {zone}", tuple(ends)
    return f" {text}", (float(lower / 1000) + 0.0, float(upper / 1000) + 0.0)


def scaled(cls, rng):
    """The texts of a random model: its example, larger or smaller, each length a little apart."""
    factor = 10 ** rng.uniform(-0.5, 0.5)
    given = {}
    for name, raw in cls.example.items():
        number, _, unit = str(raw).partition(" ") if isinstance(raw, str) else ("", "", "")
        if unit == "mm":
            given[name] = f"{float(number) * factor * rng.uniform(0.99, 1.01):.{int(rng.integers(3, 7))}f} mm"
        elif isinstance(raw, dict) and raw["unit"] == "mm":
            given[name] = {"value": [v * factor for v in raw["value"]], "unit": "mm"}
        else:
            given[name] = raw
    if "shells" in cls.inputs:
        given["shells"] = str(rng.choice(cls.inputs["shells"].options))
    if given.get("shells") == "full":
        given |= dict.fromkeys(("tang_width", "relief_depth", "crush_height", "free_spread"), "0 mm")
    return as_text(cls.from_quantities(given))


def toleranced(cls, rng):
    """The texts of a random toleranced model, and the limits of each toleranced dimension in mm."""
    while True:
        try:
            texts, limits = scaled(cls, rng), {}
            carried, _ = sizes_of(cls.from_quantities(texts))
            for name in cls.toleranced:
                if name not in carried:
                    continue  # a lower shell has no hole, a full bush no tang
                number = round(float(texts[name].split(" ")[0]), 9)  # decimals of mm in which models draw
                if number > 0 and rng.random() < 0.7:
                    text, ends = typed(rng, number)
                    limits[name] = (number, *ends)
                    texts[name] += text
            model = cls.from_quantities(texts)
        except InvalidInputs:
            continue  # of a size without such a zone, or against a rule
        if limits:
            return as_text(model), limits


def halved(limits):
    """The limits of dimensions as a file states them: pitch circles by their radius."""
    return {
        f"{name}/2" if name in CIRCLES else name: tuple(one / 2 for one in ends) if name in CIRCLES else ends
        for name, ends in limits.items()
    }


def pair_of(dimension):
    """Whether the surfaces of a dimension are of its size, as far as their own numbers show it."""
    radii = [{radius for _, radius in side} for side in dimension.sides]
    keywords = [{keyword for keyword, _ in side} for side in dimension.sides]
    match dimension.kind:
        case "diameter" | "spherical diameter":
            return all(radius == pytest.approx(dimension.nominal / 2, abs=1e-6) for radius in radii[0])
        case "radius":
            return keywords[0] <= {"TOROIDAL_SURFACE"} or all(
                radius == pytest.approx(dimension.nominal, abs=1e-6) for radius in radii[0]
            )
        case "thickness":
            return keywords == [{"CONICAL_SURFACE"}]
    if keywords == [{"CYLINDRICAL_SURFACE"}] * 2 and dimension.name not in BETWEEN_AXES:
        (one,), (other,) = radii
        return other - one == pytest.approx(dimension.nominal, abs=1e-6)
    if dimension.name == "relief_height":
        return keywords == [{"CYLINDRICAL_SURFACE"}, {"LINE"}]
    return all(each <= {"PLANE", "CYLINDRICAL_SURFACE"} for each in keywords)


def check(cls, texts, limits):
    """Build a toleranced model and read its PMI with the second reader; returns the STEP file."""
    build = regenerate_class(cls, texts)
    file = File(build.step)
    found = list(file.dimensions())
    assert {d.name: (d.nominal, d.lower, d.upper) for d in found} == halved(limits)  # to the last digit
    assert all(map(pair_of, found))
    assert not list(file.dangling())
    expected = {
        (name, form, round(share * round(limits[name][2] - limits[name][1], 9), 9))
        for name, declared in cls.toleranced.items()
        if name in limits
        for form, share in declared.items()
        if form in ("cylindricity", "perpendicularity", "parallelism")
    }
    tolerances = list(file.tolerances())
    assert {(name, form, width) for name, form, width, _ in tolerances} == expected
    assert all(datums == ([] if form == "cylindricity" else ["A"]) for _, form, _, datums in tolerances)
    return build.step


def parts(sets, kinds, seed):
    rng = np.random.default_rng(seed)
    for number in range(sets):
        cls = models().get(*kinds[number % len(kinds)])
        yield cls, *toleranced(cls, rng)


def opened_by_freecad(paths):
    program = ["/usr/bin/python3", "-c", OPEN_IN_FREECAD, str(FREECAD), *map(str, paths)]
    done = subprocess.run(program, capture_output=True, text=True, timeout=240, env={"PATH": "/usr/bin"})
    assert done.returncode == 0, done.stderr
    return [float(line) for line in done.stdout.splitlines()[-len(paths) :]]


def volumes(step):
    return sum(measure(body).volume * len(body.places) for body in read_step(step))


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Ten random toleranced parts, each checked by the second reader."""
    folder = tmp_path_factory.mktemp("pmi")
    paths = []
    for number, (cls, texts, limits) in enumerate(parts(10, QUICK, seeded(19))):
        paths.append(folder / f"{number}.step")
        paths[-1].write_bytes(check(cls, texts, limits))
    return paths


def test_property_limits_are_read_back_exactly_by_a_second_reader(files):
    assert len(files) == 10


STRAIGHT = {"nose_fillet": "0 mm"}
"""A nose as thick as the journal has no shoulder that a fillet could take."""


@pytest.mark.sampled(1)
@pytest.mark.parametrize("nose", ["35 mm", "55 mm"])  # 55: as thick as the journal, so without a shoulder
def test_lengths_that_repeat_along_a_shaft_are_stated_at_each_place(nose):
    cls = models().get("crankshaft", 1)
    texts = as_text(cls.from_quantities({**TWO_THROWS, **STRAIGHT, "nose_diameter": nose}))
    limits = {
        "journal_length": (26.0, -0.1, 0.0),
        "pin_length": (32.0, 0.0, 0.052),
        "web_thickness": (18.0, -0.05, 0.05),
    }
    for name, (_, lower, upper) in limits.items():
        texts[name] += f" {upper:+g}/{lower:+g} mm"
    step = check(cls, as_text(cls.from_quantities(texts)), limits)
    counts = Counter(d.name for d in File(step).dimensions())
    assert counts == {"journal_length": 3 - (nose == "55 mm"), "pin_length": 2, "web_thickness": 4}


@pytest.mark.slow
def test_a_shaft_of_split_pins_states_its_middle_webs_apart():
    cls = models().get("crankshaft", 1)
    texts = as_text(cls.from_quantities(cls.example))
    numbers = {name: float(texts[name].split(" ")[0]) for name in ("web_thickness", "middle_web_thickness")}
    limits = {name: (number, -0.05, 0.05) for name, number in numbers.items()}
    for name in limits:
        texts[name] += " ±0.05 mm"
    step = check(cls, as_text(cls.from_quantities(texts)), limits)
    throws = len(cls.example["pin_angles"]["value"])
    assert Counter(d.name for d in File(step).dimensions()) == {
        "web_thickness": 2 * throws, "middle_web_thickness": throws,
    }  # fmt: skip


def test_a_length_that_repeats_does_not_change_the_key_of_other_tolerances(monkeypatch):
    cls = models().get("crankshaft", 1)
    texts = {**TWO_THROWS, "pin_diameter": "48 mm h6"}
    one = build_key(cls.from_quantities(texts))
    two = build_key(cls.from_quantities({**texts, "pin_length": "32 mm H9"}))
    older = {n: said for n, said in cls.toleranced.items() if not {"shoulders", "discs"} & said.keys()}
    monkeypatch.setattr(cls, "toleranced", older)
    assert build_key(cls.from_quantities(texts)) == one != two


def test_property_netgen_opens_some_files(files):
    occ = pytest.importorskip("netgen.occ")
    for path in files[:3]:
        assert occ.OCCGeometry(str(path)).shape.mass == pytest.approx(volumes(path.read_bytes()), rel=1e-3)


def test_property_gmsh_opens_every_file(files):
    gmsh = pytest.importorskip("gmsh")
    opened_by_gmsh(gmsh, files)


def opened_by_gmsh(gmsh, paths):
    gmsh.initialize(["-v", "0"], interruptible=False)
    try:
        for path in paths:
            gmsh.clear()
            gmsh.model.occ.importShapes(str(path))
            gmsh.model.occ.synchronize()
            solids = gmsh.model.getEntities(3)
            volume = sum(gmsh.model.occ.getMass(3, tag) for _, tag in solids)
            assert volume == pytest.approx(volumes(path.read_bytes()), rel=1e-3)
    finally:
        gmsh.finalize()


@pytest.mark.skipif(not FREECAD.exists(), reason="FreeCAD is not installed (Debian: freecad-python3)")
def test_property_freecad_opens_every_file(files):
    expected = [volumes(path.read_bytes()) for path in files]
    assert opened_by_freecad(files) == pytest.approx(expected, rel=1e-3)


@pytest.mark.slow
def test_property_200_random_toleranced_parts(tmp_path):
    paths = []
    for number, (cls, texts, limits) in enumerate(parts(200, ALL, seeded(1900))):
        paths.append(tmp_path / f"{number}.step")
        paths[-1].write_bytes(check(cls, texts, limits))
    expected = [volumes(path.read_bytes()) for path in paths]
    if FREECAD.exists():
        assert opened_by_freecad(paths) == pytest.approx(expected, rel=1e-3)
    opened_by_gmsh(pytest.importorskip("gmsh"), paths)


SHELL = models().get("plain_bearing", 1)
FITTED = as_text(
    SHELL.from_quantities(
        {**HALF, "inner_diameter": "48 mm H7", "width": "24 mm +0/-0.1 mm", "wall": "2.4 mm ± 5 um"}
    )
)


@pytest.fixture(scope="module")
def fitted():
    return regenerate_class(SHELL, FITTED)


def test_open_cascade_reads_its_limits_datum_material_and_volume(fitted):
    """Its reader gives lower deviations without their sign."""
    pytest.importorskip("OCP")
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDF import TDF_LabelSequence
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application
    from OCP.XCAFDoc import XCAFDoc_Datum, XCAFDoc_Dimension, XCAFDoc_DocumentTool

    reader = STEPCAFControl_Reader()
    reader.SetGDTMode(True)
    reader.SetMatMode(True)
    reader.ReadStream("model.step", io.BytesIO(fitted.step))
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader.Transfer(document)
    tool = XCAFDoc_DocumentTool.DimTolTool_s(document.Main())

    def read(labels, cls):
        return [cls.Set_s(label).GetObject() for label in labels]

    dimensions, datums, materials = (TDF_LabelSequence() for _ in range(3))
    tool.GetDimensionLabels(dimensions)
    tool.GetDatumLabels(datums)
    XCAFDoc_DocumentTool.MaterialTool_s(document.Main()).GetMaterialLabels(materials)
    values = [
        (d.GetValue(), d.GetLowerTolValue(), d.GetUpperTolValue())
        for d in read(dimensions, XCAFDoc_Dimension)
    ]
    assert [(n, abs(low), abs(high)) for n, low, high in values] == [
        (48.0, 0.0, 0.025), (2.4, 0.005, 0.005), (24.0, 0.1, 0.0),
    ]  # fmt: skip
    assert [d.GetName().ToCString() for d in read(datums, XCAFDoc_Datum)] == ["A"]
    lines = [Shape.cast(d.GetPresentation()) for d in read(dimensions, XCAFDoc_Dimension)]
    box = read_step(fitted.step)[0].shape.BoundingBox()
    rows = []
    for line in lines:  # letters beside the box of the solid, and a leader to it
        boxes = [edge.BoundingBox() for edge in line.Edges()]
        beside = [one for one in boxes if one.xmin > box.xmax]
        assert len(beside) > 10
        assert any(one.xmin <= box.xmax for one in boxes)
        rows.append((min(one.zmin for one in beside), max(one.zmax for one in beside)))
    assert all(below[1] < above[0] for below, above in pairwise(sorted(rows)))
    assert materials.Length() == 1


@pytest.mark.parametrize("id", ["ball_bearing", "bearing_assembly"])
def test_leaders_end_on_the_parts_at_their_places(id):
    """Balls are made at the origin and stand in their raceways."""
    cls = models().get(id, 1)
    texts = as_text(cls.from_quantities(cls.example))
    sizes, _ = sizes_of(cls.from_quantities(texts))
    for name in cls.toleranced:
        texts[name] += " +0.01/0 mm"
    step = regenerate_class(cls, texts).step
    placed = {body.name: body.shape.moved(body.places[0]) for body in read_step(step)}
    seen = set()
    for name, lines in File(step).lines():
        parts = {part for place in sizes[name].places for part, _ in (*place.first[:1], *place.second[:1])}
        ends = [Vertex.makeVertex(*point) for pair in lines for point in pair]
        for part in parts:
            assert min(end.distance(placed[part]) for end in ends) < 1e-6, (name, part)
            inside = min(ends, key=lambda end: end.distance(placed[part]))
            assert min(inside.distance(face) for face in placed[part].Faces()) < 1e-6, (name, part)
        seen.add(name)
    assert seen == set(cls.toleranced)


def test_every_letter_of_an_annotation_has_strokes():
    signs = {*SIGNS.values(), *FORM_SIGNS.values(), *"0123456789.+-±/ABC"}
    assert all(strokes(letter) for sign in signs for letter in sign)
    assert all(0 <= x <= 4 and 0 <= y <= 6 for letter in signs for s in strokes(letter[0]) for x, y in s)


def test_annotations_are_drawn_once_each_and_name_their_text(fitted):
    text = fitted.step.decode("latin-1")
    assert re.findall(r"DRAUGHTING_CALLOUT\('([^']*)'", text)[:3] == [
        "diameter 48 +0.025/0", "2.4 +/-0.005", "24 0/-0.1",
    ]  # fmt: skip
    assert text.count("= TESSELLATED_ANNOTATION_OCCURRENCE(") == text.count("= DRAUGHTING_CALLOUT(")
    assert "COLOUR('white')" not in text


def test_properties_are_those_of_the_solid(fitted):
    found = list(File(fitted.step).properties())
    by_name = {(name, what): items for name, what, items in found}
    assert by_name["geometric validation property", "volume"] == pytest.approx(
        [fitted.measures["volume"]], rel=1e-9
    )
    centre = [fitted.measures[f"centre_{axis}"] for axis in "xyz"]
    assert by_name["geometric validation property", "centroid"][0] == pytest.approx(centre, abs=1e-6)
    (body,) = read_step(fitted.step)
    assert by_name["geometric validation property", "surface area"] == pytest.approx(
        [body.shape.Area()], rel=1e-4
    )
    assert by_name["material property", "density"] == [7850.0]
    assert by_name["material property", "material name"] == [("steel", "")]
    attributes = dict(by_name["Crankwright", ""])
    assert {name: attributes[name] for name in FITTED} == FITTED
    assert attributes["build"] == fitted.key


def test_an_untoleranced_build_states_nothing_and_keeps_its_bytes(example):
    assert read_statements(example.step) == []
    assert b"PROPERTY_DEFINITION(" not in example.step
    assert b"TOLERANCE" not in example.step.split(b"DATA;", 1)[1]


def test_bytes_are_equal_each_time_but_for_no_tolerance(fitted):
    assert regenerate_class(SHELL, FITTED).step == fitted.step


@pytest.mark.slow
def test_bytes_are_equal_in_another_process(fitted):
    code = (
        "import hashlib; from cad.catalogue import models; from cad.regenerate import regenerate_class;"
        f"build = regenerate_class(models().get('plain_bearing', 1), {FITTED!r});"
        "print(hashlib.sha256(build.step).hexdigest())"
    )
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True,
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": str(Path(__file__).parents[2])},
        )  # fmt: skip
        assert done.stdout.strip() == hashlib.sha256(fitted.step).hexdigest()


@pytest.mark.parametrize(
    ("pattern", "other", "kind", "name"),
    [
        (rb"LENGTH_MEASURE\(2\.5E-02\)", b"LENGTH_MEASURE(3.5E-02)", "dimension", "inner_diameter"),
        (rb"LENGTH_MEASURE\(-0\.1\)", b"LENGTH_MEASURE(0.1)", "dimension", "width"),
        (rb"CYLINDRICITY_TOLERANCE\('inner_", b"CYLINDRICITY_TOLERANCE('", "cylindricity", "inner_diameter"),
        (rb",\.F\.,'A'\)", b",.F.,'B')", "datum", "A"),
        (rb"VOLUME_MEASURE\(4", b"VOLUME_MEASURE(5", "volume", "upper_back"),
        (rb"AREA_MEASURE\(4", b"AREA_MEASURE(5", "surface area", "upper_back"),
        (rb"'centre point',\(0\.", b"'centre point',(1.", "centroid", "upper_back"),
        (rb"POSITIVE_RATIO_MEASURE\(7850", b"POSITIVE_RATIO_MEASURE(2700", "density", "upper_back"),
        (rb"ITEM\('steel'", b"ITEM('lead'", "material", "upper_back"),
        (rb"ITEM\('shells','upper'", b"ITEM('shells','full'", "attribute", "shells"),
        (rb"#\d+ = PLUS_MINUS_TOLERANCE\([^;]*;", b"", "dimension", "inner_diameter"),
    ],
)  # fmt: skip
def test_a_change_of_any_statement_is_seen(fitted, pattern, other, kind, name):
    changed, count = re.subn(pattern, other, fitted.step, count=1)
    assert count == 1
    wrong = [c for c in compared(read_statements(fitted.step), read_statements(changed)) if not c.agrees]
    assert (kind, name) in {(c.kind, c.name) for c in wrong}
    assert len(wrong) <= 3  # a datum is named by the tolerances that refer to it


def test_every_kind_of_number_has_a_unit(fitted):
    for one in read_statements(fitted.step):
        assert (one.kind in UNITS) == any(isinstance(value, float) for value in one.values), one


@pytest.mark.parametrize(
    "text",
    ["", "#1=", "#1=(((((", "#1=DATUM('", "'" * 9, "#1=DATUM();#2=DATUM(#2);", "#1=PROPERTY_DEFINITION(#1);",
     "#1=DIMENSIONAL_CHARACTERISTIC_REPRESENTATION();#1=PLUS_MINUS_TOLERANCE(#1,#1);",
     "#1=PROPERTY_DEFINITION('material property','density',#1);#2=PROPERTY_DEFINITION_REPRESENTATION(#1,#1);",
     "#9=REPRESENTATION('x',(#9,#9),#9);#8=PROPERTY_DEFINITION('material property','density',#9);"
     "#7=PROPERTY_DEFINITION_REPRESENTATION(#8,#9);", "#1=CYLINDRICITY_TOLERANCE('a','',#1,#1,#1,#1);"],
)  # fmt: skip
def test_text_that_is_no_file_is_read_without_a_fault(text):
    for statement in read_statements(text.encode()):
        assert statement.kind


def test_a_tolerance_on_what_is_not_there_is_refused_by_name():
    texts = as_text(SHELL.from_quantities({"inner_diameter": "48 mm", "oil_hole_diameter": "0 mm"}))
    texts["oil_hole_diameter"] = "0 mm +0.1/0 mm"
    with pytest.raises(GeometryError, match=r"oil_hole_diameter has .* no face shows its 0 mm") as refused:
        regenerate_class(SHELL, texts)
    assert (refused.value.code, refused.value.parameters) == ("tolerance", ("oil_hole_diameter",))


def test_two_dimensions_of_one_size_are_stated_on_the_faces_of_each():
    cls = models().get("crankshaft", 1)
    texts = as_text(cls.from_quantities({**TWO_THROWS, "bolt_hole_diameter": "14 mm"}))
    texts["pin_bore"] += " H7"
    texts["bolt_hole_diameter"] += " H11"
    file = {one.name: one for one in File(regenerate_class(cls, texts).step).dimensions()}
    away = {
        name: {round(float(np.hypot(*point[:2])), 6) for _, point, _, _ in one.places[0]}
        for name, one in file.items()
    }
    throw, circle = (float(texts[name].split(" ")[0]) for name in ("throw", "bolt_circle_diameter"))
    assert away == {"pin_bore": {throw}, "bolt_hole_diameter": {round(circle / 2, 6)}}


@pytest.mark.slow
def test_the_nose_of_a_shaft_is_not_its_journal_where_both_are_as_thick():
    cls = models().get("crankshaft", 1)
    texts = as_text(cls.from_quantities({**TWO_THROWS, **STRAIGHT, "nose_diameter": "55 mm"}))
    texts["journal_diameter"] += " g6"
    both = {**texts, "nose_diameter": "55 mm h6"}
    one, two = (list(File(regenerate_class(cls, t).step).dimensions()) for t in (texts, both))
    assert [d.name for d in one] == ["journal_diameter"]
    assert [d.name for d in two] == ["journal_diameter", "nose_diameter"]


@pytest.mark.parametrize("shells", ["upper", "lower", "pair"])
def test_the_bore_of_half_shells_is_toleranced_on_the_shell_that_is_drawn(shells):
    cls = models().get("plain_bearing", 1)
    given = {"inner_diameter": "48 mm H6", "width": "24 mm h8", "shells": shells}
    texts = as_text(cls.from_quantities(given))
    file = File(regenerate_class(cls, texts).step)
    assert [(d.name, d.lower, d.upper) for d in file.dimensions()] == [
        ("inner_diameter", 0.0, 0.016), ("width", -0.033, 0.0),
    ]  # fmt: skip
    assert ("width", "perpendicularity", 0.033, ["A"]) in list(file.tolerances())


def test_a_tolerance_on_a_hole_that_the_lower_shell_has_not_is_refused_by_name():
    cls = models().get("plain_bearing", 1)
    shell = {"inner_diameter": "48 mm", "oil_hole_diameter": "4 mm +0.1/0 mm", "shells": "lower"}
    with pytest.raises(GeometryError, match=r"oil_hole_diameter has .* no face shows its 4 mm") as refused:
        regenerate_class(cls, as_text(cls.from_quantities(shell)))
    assert refused.value.parameters == ("oil_hole_diameter",)


@pytest.mark.parametrize(
    ("id", "fit"),
    [
        ("bearing_housing", "housing_bore"),
        ("bearing_assembly", "journal_diameter"),
        ("connecting_rod", "centre_distance"),
    ],
)
def test_every_dimension_that_a_mated_part_declares_is_written(id, fit):
    cls = models().get(id, 1)
    texts = as_text(cls.from_quantities(cls.example))
    for name in cls.toleranced:
        texts[name] += " +0.02/0 mm" if texts[name] == "0 mm" else " +0.02/-0.01 mm"
    dimensions = list(File(regenerate_class(cls, texts).step).dimensions())
    assert {d.name for d in dimensions} == set(cls.toleranced)
    (one,) = [d for d in dimensions if d.name == fit]
    assert (one.lower, one.upper) == (-0.01, 0.02)
