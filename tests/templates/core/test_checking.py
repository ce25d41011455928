"""Analytic: each possible fault in a template is reported with its line, and no other."""

import json
from itertools import chain
from pathlib import Path

import pytest
from newest import older_slow

from app.catalogue.check import check_content
from cad.catalogue import models
from templates.core.catalogue import golden
from templates.core.catalogue.digests import digest
from templates.core.catalogue.discovery import declared_in_file, find
from templates.core.checks.check import faults_of
from templates.core.language.template import Template
from templates.door import built_in

BUSH = '''"""Duty of a plain bush."""

from templates.core.language.template import Array, Template, Truth, derived, formula, given, require


class BushDuty(Template):
    """Duty of a plain bush: projected pressure and sliding speed."""

    example = {"radial_load": "2 kN", "bearing_diameter": "20 mm", "speed": "300 rpm"}

    F: Array = given("N", "radial load", ge=0)
    d: Array = given("mm", "bearing diameter", gt=0)
    omega: Array = given("rpm", "speed", ge=0)

    @derived("mm", "bearing width", gt=0)
    def b(self) -> Array:
        return self.d

    @require("bearing_width", remedy="use two bushes", warning="long_bush")
    def short_enough(self) -> Truth:
        """A bush longer than twice its bore carries on its edges."""
        return self.b <= 2 * self.d

    @formula("MPa", "projected pressure", symbol=r"\\\\bar{p}")
    def p(self) -> Array:
        return self.F / (self.d * self.b)

    @formula("m/s", "sliding speed")
    def u(self) -> Array:
        return self.omega * self.d / 2
'''.replace("\\\\\\\\", "\\\\")

PRESSURE, SPEED = "return self.F / (self.d * self.b)", "return self.omega * self.d / 2"


def line_of(text, part):
    """The line of a text in which a part of it stands."""
    return text[: text.index(part)].count("\n") + 1


def checked(folder, text, name="bush_duty_v1.py"):
    return check_content(str(folder / name), text.encode() if isinstance(text, str) else text)


@pytest.mark.parametrize(
    ("old", "new", "code", "place", "words"),
    [
        (
            PRESSURE,
            "return self.F / self.d",
            "dimensions",
            '@formula("MPa"',
            "projected_pressure is declared",
        ),
        ("self.b <= 2 * self.d", "self.b <= self.omega", "dimensions", "@require", "carries on its edges"),
        (SPEED, "return self.omega * self.dd / 2", "unknown_attribute", "self.dd", "u uses self.dd"),
        ("self.b <= 2", "self.bb <= 2", "unknown_attribute", "self.bb", "short_enough uses self.bb"),
        ("return self.d\n", "return self.b\n", "cycle", "@derived", "b follows from itself: b ← b"),
        (SPEED, "return self.p * self.u", "cycle", '@formula("m/s"', "u follows from itself: u ← u"),
        (SPEED, "if self.omega: return 1", "formula", '@formula("m/s"', "one return"),
        (SPEED, "return (self.omega)(self.d) / 2", "raises", "return (self.omega)", "not callable"),
        ('"300 rpm"}', '"-300 rpm"}', "example", "example =", "speed: "),
        ('"speed": "300 rpm"', '"spee": "300 rpm"', "example", "example =", "leaves out speed"),
        (
            '"bearing_diameter": "20 mm"',
            '"bearing_diameter": "20 N"',
            "example",
            "example =",
            "N measures a force",
        ),
        ("example = ", "sample = ", "example", "class BushDuty", "leaves out radial_load"),
        ("omega: Array = given", "omega: Array = gven", "raises", "omega: Array", "NameError"),
        ('"m/s", "sliding', '"m/x", "sliding', "unit", "def u", "m/x"),
        ('"rpm", "speed"', '"upm", "speed"', "unit", "omega: Array", "'upm'"),
        ("import Array", "import Aray, Array", "import", "import Aray", "Aray"),
        (SPEED, SPEED + ")", "syntax", SPEED, "unmatched"),
        ("class BushDuty(Template)", "class BushDuty", "declares", None, "one template, not 0"),
    ],
)
def test_a_fault_is_reported_once_with_its_line(tmp_path, old, new, code, place, words):
    assert old in BUSH
    text = BUSH.replace(old, new, 1)
    (fault,) = checked(tmp_path, text)
    assert fault.code == code, fault
    assert words in fault.what
    assert fault.remedy
    assert fault.quarantines
    assert fault.line == (line_of(text, place) if place else None), fault


def test_a_loop_of_several_is_reported_with_its_path(tmp_path):
    text = BUSH.replace("return self.d\n", "return self.p / self.F\n", 1)
    (fault,) = checked(tmp_path, text)
    assert fault.code == "cycle"
    assert fault.what in ("b follows from itself: b ← p ← b", "p follows from itself: p ← b ← p")


def test_a_function_of_the_file_that_raises_is_reported_by_its_own_line(tmp_path):
    """Not by the line of the formula that calls it."""
    text = (
        BUSH.replace(SPEED, "return halved(self.omega * self.d)") + "\n\ndef halved(x):\n    return x() / 2\n"
    )
    faults = checked(tmp_path, text)
    assert {(fault.code, fault.line) for fault in faults} == {("raises", line_of(text, "return x() / 2"))}


def test_a_formula_that_cannot_be_written_on_paper_is_reported(tmp_path):
    text = BUSH.replace('"sliding speed"', '"sliding speed", latex=7')
    assert any(
        fault.what.startswith("its formulas cannot be written on paper") for fault in checked(tmp_path, text)
    )


def test_a_sound_file_has_no_fault(tmp_path):
    assert checked(tmp_path, BUSH) == []


def test_a_docstring_is_wanted(tmp_path):
    text = BUSH.replace('"""Duty of a plain bush."""\n', "", 1)
    assert checked(tmp_path, text) == [], "the class has one"
    text = text.replace('    """Duty of a plain bush: projected pressure and sliding speed."""\n', "", 1)
    (fault,) = checked(tmp_path, text)
    assert (fault.code, fault.line) == ("docstring", line_of(text, "class BushDuty"))


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b'"""\xff\xfe"""', "syntax"),
        (b"x = 1\x00", "syntax"),
        (b"raise SystemExit(3)", "raises"),
        (b"raise KeyboardInterrupt", "raises"),
        (b"from os import nothing", "import"),
        (b"", "declares"),
        (b"(" * 5000, "syntax"),
    ],
)
def test_bytes_that_are_no_template(tmp_path, content, code):
    (fault,) = checked(tmp_path, content)
    assert fault.code == code


@pytest.mark.parametrize("cls", older_slow(chain(built_in(), models())))
def test_the_shipped_versions_have_no_fault(cls):
    assert faults_of(cls, Path(f"{cls.id}_v{cls.version}.py")) == []


@pytest.fixture
def frozen(tmp_path):
    """A file whose release was recorded."""
    path = tmp_path / "bush_duty_v1.py"
    path.write_text(BUSH)
    golden.freeze(declared_in_file(path), tmp_path / "golden")
    return path


def test_a_released_file_is_held_to_its_record(frozen):
    assert checked(frozen.parent, BUSH) == []
    faults = checked(frozen.parent, BUSH.replace(SPEED, "return self.omega * self.d / 3"))
    assert {fault.code for fault in faults} == {"golden", "released"}
    assert any("sliding_speed is 0.2" in fault.what for fault in faults)
    assert any(fault.quarantines for fault in faults)


def test_an_edit_that_changes_no_result_is_reported_and_does_not_quarantine(frozen):
    (fault,) = checked(frozen.parent, BUSH.replace(SPEED, "return self.d * self.omega / 2"))
    assert (fault.code, fault.quarantines) == ("released", False)


@pytest.mark.parametrize("record", ["{", "[]", '{"cases": 1}'])
def test_a_damaged_record_is_a_fault(frozen, record):
    (frozen.parent / "golden" / "bush_duty_v1.json").write_text(record)
    (fault,) = checked(frozen.parent, BUSH)
    assert (fault.code, fault.quarantines) == ("golden", True)


def test_a_record_that_refuses_what_is_calculated_now(frozen):
    file = frozen.parent / "golden" / "bush_duty_v1.json"
    record = json.loads(file.read_text())
    record["cases"] = [{"inputs": record["cases"][0]["inputs"], "refused": ["out_of_range"]}]
    file.write_text(json.dumps(record))
    (fault,) = checked(frozen.parent, BUSH)
    assert "were refused" in fault.what


def test_two_contents_of_one_file_live_beside_each_other(tmp_path):
    """What was loaded first keeps its code, its digest and its formulas on paper."""
    path = tmp_path / "bush_duty_v1.py"
    classes = []
    for divisor in (2, 3):
        path.write_text(BUSH.replace(SPEED, f"return self.omega * self.d / {divisor}"))
        (cls,) = find([tmp_path], Template)
        classes.append(cls)
    path.unlink()
    values = [cls.from_quantities(cls.example).u for cls in classes]
    assert values[0] == pytest.approx(values[1] * 3 / 2)
    assert faults_of(classes[0], path) == faults_of(classes[1], path) == []
    digests = {digest(cls) for cls in classes}
    assert len(digests) == 2
