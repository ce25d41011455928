"""Stamps on finished files are escaped, read back by the kernel, and recognised by `is_copy`."""

import io
import re
from dataclasses import replace

import ezdxf
import pytest
from bare_shells import BUSH
from cadquery import Location, func
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds import examples

from cad.catalogue import models
from cad.drafting.letter_width import clipped, width_of
from cad.export import derive
from cad.file_names import name, plain_name, stem, wide_stem
from cad.header import Header
from cad.model import Part
from cad.part21 import end_of_string, plain, quoted
from cad.regenerate import as_text, regenerate_class
from cad.stamp import Stamp, is_copy, stamped, takes_stamp
from cad.step import read_step, write_step

NAMES = [
    "435 cc main bearing",
    "it's '' a \\X2\\ trap\\X0\\",
    "Größe 1,5 µm; (#7) = PRODUCT('x','y','z',(#8));",
    "轴承",
    "🔩" * 200,
    "ENDSEC; DATA;",
    "a\u202eb",
    "/* no comment */",
]
APP, TITLE = "CRANKWRIGHT", "stamp:iso-title"
NAME = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=60)


@pytest.fixture(scope="module")
def shell():
    model = models().get("plain_bearing", 1)
    return regenerate_class(model, as_text(model.from_quantities({**BUSH, "inner_diameter": "50 mm"}))).step


def moved_box():
    return Part("block", func.box(1, 2, 3), 6.0, places=(Location((10, 0, 0)),))


def stamp(design):
    return Stamp(design, "shell", 3, "2026-11-22T05:47:46", {"full_back": "CuSn8 (8800 kg/m³)"})


@pytest.mark.parametrize("design", NAMES)
def test_the_kernel_reads_the_product_back(shell, design):
    step = stamped(shell, "step", stamp(design))
    assert step.isascii()
    (body,) = read_step(step)
    assert body.name == f"{name(design)}_shell"
    assert body.shape.isValid()
    text = step.decode()
    start = text.index("'design ")
    assert plain(text[start : end_of_string(text, start)]).startswith(f"design {design}, model shell")
    assert is_copy(step, shell)
    assert not is_copy(shell, step.replace(b"PRODUCT(", b"PRODUKT(", 1))


def test_the_product_keeps_its_id_from_revision_to_revision_and_rows_differ(shell):
    one = stamp("435 cc")
    products = {}
    for key, each in {
        "first": one,
        "next": replace(one, revision=4),
        "row": replace(one, variant="main_2"),
        "numbered": replace(one, number="PN-100", mark="C"),
    }.items():
        text = stamped(shell, "step", each).decode()
        (id,) = re.findall(r"= PRODUCT\(\s*'([^']*)'", text)
        (version,) = re.findall(r"PRODUCT_DEFINITION_FORMATION\(\s*'([^']*)'", text)
        products[key] = id, version
    assert products == {
        "first": ("435_cc_shell", "3"),
        "next": ("435_cc_shell", "4"),
        "row": ("435_cc_main_2", "3"),
        "numbered": ("PN-100", "C"),
    }
    assert "mass 0.125 kg" in stamped(shell, "step", replace(one, mass=0.125)).decode()


@settings(max_examples=examples(25), deadline=None)
@given(st.text("ab'\\,;)(# X204µ轴/*🔩", min_size=1, max_size=30))
def test_property_the_kernel_reads_odd_names(shell, design):
    (body,) = read_step(stamped(shell, "step", stamp(design)))
    assert body.name == f"{name(design)}_shell"
    assert plain(quoted(design)) == design


@settings(max_examples=examples(60), deadline=None)
@given(NAME)
def test_property_a_stamp_changes_nothing_else(shell, design):
    step = stamped(shell, "step", stamp(design))
    assert is_copy(step, shell)
    assert stamped(step, "step", stamp("other")) == stamped(shell, "step", stamp("other"))
    assert stamped(shell, "step", stamp(design)) == step
    assert plain(quoted(design)) == design


@settings(max_examples=examples(60), deadline=None)
@given(st.data())
def test_property_a_change_of_one_byte_outside_the_stamp_is_noticed(shell, data):
    step = stamped(shell, "step", stamp("x"))
    place = data.draw(st.integers(0, len(step) - 1))
    changed = step[:place] + bytes([step[place] ^ 1]) + step[place + 1 :]
    strings = [match.span() for match in re.finditer(rb"'(?:[^']|'')*'", step)]
    is_in_a_string = any(start <= place < end for start, end in strings)
    assert is_in_a_string or not is_copy(changed, shell)


@pytest.mark.parametrize("design", NAMES)
@pytest.mark.parametrize("kind", ["dxf", "drawing.svg"])
def test_a_drawing_stays_sound(shell, drawings, kind, design):
    file = stamped(drawings[kind], kind, stamp(design)).decode()
    assert "CuSn8" in file
    if kind == "dxf":
        drawing = ezdxf.read(io.StringIO(file))
        assert not drawing.audit().errors
        fields = drawing.modelspace().query("TEXT")
        (title,) = [e.dxf.text for e in fields if e.has_xdata(APP) and e.get_xdata(APP)[0].value == TITLE]
        assert title
        assert width_of(title, 3.5) <= 117
    assert takes_stamp(drawings[kind], kind)
    assert not takes_stamp(b"0\nSECTION", kind)


@pytest.fixture(scope="module")
def drawings(shell):
    return {kind: derive(shell, kind) for kind in ("dxf", "drawing.svg")}


def older_drawing(kind):
    """A title block as this program drew it before it followed ISO 7200."""
    if kind == "dxf":
        lines = [f"  1\n{name}:\n1001\n{APP}\n1000\nstamp:{name}" for name in ("design", "part", "material")]
        return ("\n".join(lines) + "\n").encode()
    lines = [f'<text data-stamp="{name}" x="0">{name}:</text>' for name in ("design", "part", "material")]
    return "".join(lines).encode()


@pytest.mark.parametrize("kind", ["dxf", "drawing.svg"])
def test_a_drawing_of_an_older_program_keeps_its_lines(kind):
    older = older_drawing(kind)
    assert takes_stamp(older, kind)
    text = stamped(older, kind, stamp("435 cc")).decode()
    for line in ("design: 435 cc", "part: shell, revision 3, 2026-11-22", "material: CuSn8 (8800 kg/m³)"):
        assert line in text


@settings(max_examples=examples(200), deadline=None)
@given(st.text(max_size=300), st.floats(5, 120))
def test_property_a_clipped_text_is_one_line_that_has_room(text, width):
    line = clipped(text, width, 2.5)
    assert width_of(line, 2.5) <= width
    assert line.isprintable()
    assert line == text or len(line) <= len(text)


def test_fields_of_a_title_block(drawings):
    signed = replace(
        stamp("435 cc"),
        owner="Keller & Söhne",
        author="Ada",
        checker="Bo",
        approver="Cy",
        status="released",
        mass=0.123456,
    )
    text = stamped(drawings["drawing.svg"], "drawing.svg", signed).decode()
    for mark, field in {
        "owner": "Keller &amp; Söhne",
        "title": "435 cc",
        "number": "435_cc_shell",
        "revision": "3",
        "date": "2026-11-22",
        "author": "Ada",
        "checker": "Bo",
        "approver": "Cy",
        "status": "released",
        "mass": "0.1235 kg",
        "material": "CuSn8 (8800 kg/m³)",
        "part": "shell",
    }.items():
        assert re.search(rf'<text data-stamp="iso-{mark}"[^>]*>{re.escape(field)}</text>', text), mark


@settings(max_examples=examples(200), deadline=None)
@given(NAME)
def test_property_names_of_files_are_safe(design):
    for each in (stem(design, "model", 1), wide_stem(design, "model", 1)):
        assert len(f"{each}.drawing.svg.part".encode()) <= 255
        assert not set(each) & set('/\\\0"*?<>|:\r\n')
        assert not each.startswith((".", "-"))
    assert stem(design, "model", 1).isascii()
    assert plain_name(plain_name(design)) == plain_name(design)


def test_a_single_part_at_a_place_of_its_own_is_one_product_there():
    part = moved_box()
    step = write_step([part], Header("box", 1, {}, ""))
    assert step.count(b"= PRODUCT(") == 1
    (body,) = read_step(step)
    assert body.name == part.name
    placed = body.shape.moved(body.places[0])
    assert placed.Center().toTuple() == pytest.approx((10, 0, 1.5))


def test_several_places_are_an_assembly():
    part = moved_box()
    twice = Part(part.name, part.shape, part.volume, places=(*part.places, *part.places))
    assert write_step([twice], Header("box", 1, {}, "")).count(b"NEXT_ASSEMBLY_USAGE_OCCURRENCE") == 2


def test_the_title_block_names_every_material_where_the_names_of_parts_have_no_room():
    parts = {f"a_part_with_a_long_name_{n}": f"material {n % 2}" for n in range(6)}
    stamp = Stamp("engine", "bearing", 1, "2026-01-01", parts)
    assert stamp.fields["material"] == "material 0; material 1"
    assert "a_part_with_a_long_name_5" in stamp.material
    few = Stamp("engine", "bearing", 1, "2026-01-01", {"cap": "iron", "pin": "steel"})
    assert few.fields["material"] == "cap: iron; pin: steel"


@pytest.mark.parametrize(
    ("volume", "mass"), [("904.78 mm³", "0.007962 kg"), ("2.5 dm³", "22 kg"), ("", ""), ("1.2…", "")]
)
def test_the_mass_of_a_part_is_its_volume_times_the_density_of_its_material(volume: str, mass: str):
    parts = {"back": "steel (7850 kg/m³)", "lining": "CuSn8 (8800 kg/m³)"}
    stamp = Stamp("engine", "bearing", 1, "2026-01-01", parts, part="lining")
    assert stamp.of_part(volume) == {"material": "CuSn8 (8800 kg/m³)", "mass": mass}
