"""Descriptions of imported models become classes, and their parameters are read back from a solid."""

import io
import pickle
from dataclasses import replace

import ezdxf
import pytest
from cadquery import Solid, Workplane, exporters

from cad.errors import GeometryError
from cad.export import derive
from cad.header import Header
from cad.imported_models import (
    Description,
    DrawnPart,
    Parameter,
    ProgramResult,
    parts_of,
    role_of,
    tried,
)
from cad.model import Part, arrays_of_points
from cad.model_classes import class_of, description_of
from cad.regenerate import as_text, build_key, regenerate_shape
from cad.statements import read_statements
from cad.step import read_step, write_step
from cad.tolerances import not_stated
from templates.core.catalogue.digests import digest
from templates.core.errors import InvalidInputs

BORE = Parameter("bore", "bore", "mm", 20.0, "Sizes.cell.bore", 0.0, 1e3, "diameter")
RING = Description("freecad", 64 * "a", "ring.FCStd", "Ring", "FreeCAD 0.20", (BORE,))


def ring(bore, tmp_path):
    place = tmp_path / f"ring_{bore}.step"
    solid = Solid.makeCylinder(20, 8).cut(Solid.makeCylinder(bore / 2, 8))
    exporters.export(Workplane(solid), str(place))
    return ProgramResult(step=place.read_bytes())


def shape(**parameters):
    return class_of(RING.text, "ring", 1).from_quantities(parameters)


def test_a_description_is_read_as_it_was_written():
    assert description_of(RING.text) == RING
    assert RING.digest() != replace(RING, file=64 * "b").digest()


def test_a_class_has_id_version_title_and_defaults():
    cls = class_of(RING.text, "ring", 3)
    assert (cls.id, cls.version, cls.title()) == ("ring", 3, "Ring")
    assert as_text(cls.from_quantities({})) == {"bore": "20 mm"}
    assert digest(cls) == RING.digest()


def test_class_and_shape_pass_between_processes():
    cls = class_of(RING.text, "ring", 1)
    assert pickle.loads(pickle.dumps(cls)) is cls
    assert as_text(pickle.loads(pickle.dumps(shape(bore="21 mm")))) == {"bore": "21 mm"}


def test_another_file_is_another_build():
    other = class_of(replace(RING, file=64 * "b").text, "ring", 1)
    assert build_key(other.from_quantities({})) != build_key(shape())


@pytest.mark.parametrize("bore", ["-1 mm", "2 m", "5 kg"])
def test_a_value_out_of_bounds_is_refused(bore):
    with pytest.raises(InvalidInputs):
        shape(bore=bore)


def test_a_list_of_bores_is_no_part():
    [fault] = arrays_of_points(shape(bore="[20, 21] mm"))
    assert fault.name == "bore"


def test_what_was_drawn_is_checked_like_any_model(tmp_path):
    one = shape(bore="21 mm")
    one.take(ring(21, tmp_path))
    build = regenerate_shape(one, as_text(one))
    assert build.dimensions == {"bore": 21}
    assert build.measures["volume"] == pytest.approx(3.141592653589793 * (20**2 - 10.5**2) * 8, rel=1e-9)


def test_a_tolerance_of_a_drawn_model_is_refused_unless_the_table_states_it(tmp_path):
    text = "21 mm +0.02/-0.01 mm"
    one = shape(bore=text)
    (fault,) = not_stated(type(one), one.ledger.typed)
    assert fault.name == "bore"
    assert "does not tell which faces" in fault.detail
    one = shape(bore=f"{text}, in table")
    assert not [*not_stated(type(one), one.ledger.typed)]
    one.take(ring(21, tmp_path))
    build = regenerate_shape(one, as_text(one))
    assert (build.tolerances["bore"].faces, build.tolerances["bore"].drawn) == ((), "table")
    assert not [one for one in read_statements(build.step) if one.kind == "dimension"]
    drawing = ezdxf.read(io.StringIO(derive(build.step, "dxf").decode()))
    texts = [one.dxf.text for one in drawing.modelspace().query("TEXT")]
    assert "bore *" in texts
    assert "21 +0.02/-0.01" in texts


def test_a_solid_that_does_not_follow_its_parameter_is_refused(tmp_path):
    one = shape(bore="21 mm")
    one.take(ring(20, tmp_path))
    with pytest.raises(GeometryError, match="bore should be 21 mm") as caught:
        regenerate_shape(one, as_text(one))
    assert (caught.value.code, caught.value.parameters) == ("dimension", ("bore",))


def test_a_shape_that_nobody_drew_is_refused():
    with pytest.raises(GeometryError, match="must be drawn"):
        regenerate_shape(shape(), as_text(shape()))


def test_a_volume_other_than_the_program_says_is_refused(tmp_path):
    one = shape()
    one.take(replace(ring(20, tmp_path), mass_volume=1.0))
    with pytest.raises(GeometryError) as caught:
        regenerate_shape(one, as_text(one))
    assert caught.value.code == "volume"


def test_a_size_that_follows_a_trial_is_the_role(tmp_path):
    before, after = (tried(ring(bore, tmp_path)).sizes for bore in (20, 20.2))
    assert before == {
        "diameter": [20, 40], "diameter inside": [20], "diameter outside": [40],
        "distance": [8], "distance inside": [], "distance outside": [8],
    }  # fmt: skip
    assert role_of(20, 20.2, before, after) == ("diameter", "inside")
    assert role_of(10, 10.1, before, after) == ("radius", "inside")
    assert role_of(8, 8.08, before, after) == ("", "")
    assert role_of(20, 20.2, after, after) == ("", "")


def test_trust_names_what_is_read_back_and_what_is_not():
    hidden = replace(BORE, name="draft", unit="deg", role="")
    trust = replace(RING, parameters=(BORE, hidden)).trust
    assert "read back from the solid: bore; not read back: draft" in trust


def assembly(*names):
    parts = [Part(name, Solid.makeBox(1, 2, 3 + n), 2.0 * (3 + n)) for n, name in enumerate(names)]
    return write_step(parts, Header("bought", 1, {}, 64 * "0"))


def fixed(step):
    one = class_of(
        Description("step", 64 * "c", "bought.stp", "Bought", "STEP").text, "bought", 1
    ).from_quantities({})
    one.take(ProgramResult(step=step))
    return one


@pytest.mark.parametrize(
    ("names", "parts"),
    [
        (["Körper"], ["Körper"]),
        (["軸受", "🔩"], ["軸受", "🔩"]),
        (["bolt", "bolt", "bolt_2"], ["bolt", "bolt_2", "bolt_2_2"]),
        (["  lead", "1/2\" it's", "a\\b", "new\nline"], ["lead", "1/2 it s", "a b", "new line"]),
        (["a" * 300], ["a" * 100]),
    ],
)
def test_a_part_is_built_whatever_its_file_calls_it(names, parts):
    one = fixed(assembly(*names))
    assert [part.name for part in one.build()] == parts
    build = regenerate_shape(one, {})
    assert list(build.materials) == parts
    assert build.step.isascii()
    assert [body.name for body in read_step(build.step)] == parts


def test_a_part_without_a_name_has_one():
    step = assembly("nameless").replace(b"'nameless'", b"''")
    (part,) = fixed(step).build()
    assert part.name
    assert regenerate_shape(fixed(step), {}).materials.keys() == {part.name}


def test_solids_that_freecad_calls_alike_get_numbers():
    brep = io.BytesIO()
    Solid.makeBox(1, 2, 3).exportBrep(brep)
    drawn = ProgramResult(
        tuple(DrawnPart(name, brep.getvalue(), 6.0) for name in ("Körper", "Körper", "Körper 1", ""))
    )
    assert [part.name for part in parts_of(drawn)] == ["Körper", "Körper_2", "Körper 1", "part"]


def test_a_parameter_is_written_as_its_name_and_a_whole_number_as_one():
    cls = class_of(RING.text, "ring", 1)
    assert cls.inputs["bore"].meaning.symbol == r"\mathrm{bore}"
    assert str(cls.example["bore"]["value"]) == "20"
