"""The import reads regions in areas, compressed sheets, repeated region counts, and undefined names."""

import gzip
from collections import Counter
from pathlib import Path

import pytest
from mathcad_files import (
    apply,
    constant,
    define,
    legacy,
    legacy_math,
    math,
    name,
    prime,
    raw,
    real,
    tag,
)

from app.worksheets.imports import job
from app.worksheets.imports.errors import SheetNotRead
from app.worksheets.imports.job import imported
from app.worksheets.imports.package import MOST_BYTES
from app.worksheets.imports.record import unresolved
from app.worksheets.imports.regions import count_regions
from templates.core.sheets import read

CASES = Path(__file__).parent / "cases"
MIN, SHADOW = ((CASES / f"area_{one}.xmcd").read_bytes() for one in ("min", "shadow"))


def id_(text):
    return f'<ml:id xml:space="preserve">{text}</ml:id>'


def states(content):
    record = imported(content, "Sheet").record
    return [(region["region"], region["state"]) for region in record["regions"]]


def values(content):
    """The values of an imported worksheet, and its unresolved regions."""
    result = imported(content, "Sheet")
    sheet = read(result.text).template("imported", 1)
    return sheet.from_quantities(sheet.example), unresolved(result.record, result.text)


class TestAreas:
    def test_a_region_of_a_collapsed_area_is_calculated(self):
        sheet, left = values(MIN)
        assert sheet.c == 12  # 3 times 4, which Mathcad stored
        assert not left
        assert dict(states(MIN)) == {
            "1": "unverified", "2": "unverified", "10": "shown", "11": "unverified", "20": "verified",
        }  # fmt: skip

    def test_an_area_shadows_a_name_defined_above_it(self):
        sheet, left = values(SHADOW)
        assert sheet.e == 24  # 2 times 3 times 4
        assert not left

    @pytest.mark.parametrize("inner", ["{}", "<regions>{}</regions>", "<rendering/><regions>{}</regions>"])
    def test_any_form_of_an_area_within_another(self, inner):
        deep = f'<region region-id="12">{legacy_math(define(id_("c"), real(5)))}</region>'
        area = f'<region region-id="11"><area>{inner.format(deep)}</area></region>'
        sheet, _ = values(
            legacy(f"<area>{inner.format(area)}</area>", legacy_math(define(id_("d"), id_("c"))))
        )
        assert sheet.d == 5

    def test_a_region_among_the_words_of_a_text(self):
        within = f'<region region-id="9">{legacy_math(define(id_("c"), real(5)))}</region>'
        sheet, left = values(
            legacy(f"<text><p>Take {within} here</p></text>", legacy_math(define(id_("d"), id_("c"))))
        )
        assert (sheet.d, left) == (5, [])

    @pytest.mark.parametrize("inner", ["{}", "<regions>{}</regions>"])
    def test_an_area_of_mathcad_prime(self, inner):
        body = f'<region region-id="9"><math>{define("c", real(5))}</math></region>'
        sheet, left = values(prime(raw(f"<Area>{inner.format(body)}</Area>"), math(define("d", name("c")))))
        assert (sheet.d, left) == (5, [])


class TestCompressed:
    def test_xmcdz_is_read_as_what_it_holds(self):
        assert imported(gzip.compress(MIN), "A").text == imported(MIN, "A").text

    @pytest.mark.parametrize(
        ("content", "code"),
        [
            (gzip.compress(MIN)[:-20], "package"),
            (gzip.compress(MIN)[:40] + b"\xff" * 40, "package"),
            (b"\x1f\x8b", "package"),
            (gzip.compress(b""), "xml"),
            (gzip.compress(b" " * (MOST_BYTES + 1)), "too_large"),
            (gzip.compress(gzip.compress(MIN)), "xml"),
            (gzip.compress(b"<!DOCTYPE a><a/>"), "entities"),
        ],
        ids=["cut", "damaged", "head alone", "empty", "bomb", "twice", "document type"],
    )  # fmt: skip
    def test_damaged_and_hostile_ones_are_refused_by_name(self, content, code):
        with pytest.raises(SheetNotRead) as refusal:
            imported(content, "Sheet")
        assert refusal.value.code == code


class TestCount:
    def test_the_count_agrees_with_what_is_reported(self):
        for content, count in ((MIN, 5), (SHADOW, 6)):
            record = imported(content, "Sheet").record
            assert record["counted"] == len(record["regions"]) == count

    def test_the_count_knows_prefixes_and_nesting(self):
        text = b'<w:a xmlns:w="x"><w:region region-id="1"><w:region region-id="2"/></w:region><region/></w:a>'
        assert count_regions(text) == Counter({"1": 1, "2": 1, "": 1})

    def test_an_empty_region_is_reported(self):
        assert ("1", "shown") in states(legacy(legacy_math(define(id_("a"), real(3))), ""))

    def test_a_region_that_the_reading_loses_forbids_the_release(self, monkeypatch):
        whole = job.read_legacy

        def forgetful(content):
            sheet = whole(content)
            kept = tuple(region for region in sheet.regions if region.number != "11")
            return type(sheet)(sheet.program, kept, sheet.counted, sheet.origin, sheet.results_carry_units)

        monkeypatch.setattr(job, "read_legacy", forgetful)
        result = imported(MIN, "Sheet")
        lost = {region["region"]: region for region in unresolved(result.record, result.text)}
        assert lost.keys() == {"11", "20"}  # the region, and what needs c
        assert "error in the program" in lost["11"]["reason"]
        assert "nothing above defines" in lost["20"]["reason"]


def old(formula, *above):
    """A sheet of Mathcad 15 with a definition of x by a formula."""
    return legacy(
        *(legacy_math(define(id_(key), value)) for key, value in above),
        legacy_math(define(id_("x"), formula)),
    )


class TestUndefinedNames:
    @pytest.mark.parametrize(
        "undefined", "c g e h k m s N T R F C a b d u D P G L hc mu_0 ha Pa bar mm min".split()
    )
    def test_alone_in_a_sum_and_before_a_number_it_is_refused(self, undefined):
        twice = apply("plus", id_(undefined), real(2))
        functional = apply("pow", real(2), id_(undefined))
        product = apply("mult", id_("a_"), id_(undefined)) if len(undefined) == 1 else twice
        for formula in (id_(undefined), twice, functional, product):
            assert states(old(formula, ("a_", real(3))))[-1] == ("1", "refused"), formula

    @pytest.mark.parametrize("undefined", "c g e h k T R F C a b d u D P G hc mu_0 ha".split())
    def test_no_constant_and_no_rare_unit_is_guessed_behind_a_number(self, undefined):
        for formula in (apply("mult", real(2), id_(undefined)), apply("mult", id_(undefined), real(2))):
            assert states(old(formula))[-1] == ("0", "refused"), formula

    @pytest.mark.parametrize("label", ["", "*", "None", "VARIABLE", "FUNCTION"])
    def test_prime_too(self, label):
        for key in ("c", "e", "g"):
            formula = apply("mult", real(2), f'<ml:id labels="{label}">{key}</ml:id>')
            assert states(prime(math(define("x", formula))))[-1][1] == "refused"

    def test_what_is_labelled_is_taken(self):
        sheet, _ = values(prime(math(define("x", apply("mult", real(2), constant("c"))))))
        assert sheet.x == 2 * 299792458

    @pytest.mark.parametrize(
        ("formula", "si"),
        [
            (apply("mult", real(3), id_("m")), 3.0),
            (apply("mult", real(3), id_("mm")), 0.003),
            (apply("div", apply("mult", real(3), id_("kN")), id_("m")), 3000.0),
            (apply("mult", real(3), apply("pow", id_("m"), real(2))), 3.0),
            (apply("mult", tag("parens", apply("neg", real(3))), id_("s")), -3.0),
            (apply("mult", id_("a_"), id_("mm")), 0.005),
            (apply("mult", real(3), tag("parens", apply("div", id_("kN"), id_("mm")))), 3e6),
        ],
    )
    def test_units_beside_numbers_are_units(self, formula, si):
        sheet, left = values(old(formula, ("a_", real(5))))
        assert sheet.x == pytest.approx(si, rel=1e-12)
        assert not left

    def test_a_letter_is_a_unit_where_the_sheet_uses_it_behind_a_number(self):
        length = apply("mult", real(3), id_("m"))
        ratio = apply("div", id_("a_"), id_("m"))
        sheet, left = values(old(ratio, ("a_", length)))
        assert (sheet.x, left) == (3.0, [])

    def test_euler_is_the_base_of_a_power_alone(self):
        sheet, _ = values(old(apply("pow", id_("e"), real(1))))
        assert sheet.x == pytest.approx(2.718281828459045, rel=1e-15)

    def test_a_defined_letter_is_no_unit(self):
        sheet, left = values(old(apply("mult", real(3), id_("m")), ("m", real(5))))
        assert (sheet.x, left) == (15.0, [])
