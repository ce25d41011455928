"""Edge cases of the language: lengths of units and lists, depths of arrays, docstrings, broken files."""

import math

import numpy as np
import pytest

from templates.core.catalogue.discovery import find
from templates.core.errors import MOST_LISTED, FaultyText, UnusableFile, listed, unknown_names
from templates.core.language.evaluate import evaluate
from templates.core.language.solve import solve
from templates.core.language.template import Template, derived, formula, given
from templates.core.paper import mathml, schema
from templates.core.units import units
from templates.core.units.quantity import read


class TestUnits:
    def test_a_unit_has_at_most_sixty_letters(self):
        longest = "mm" + "*m" * 29
        assert len(longest) == units.LONGEST_UNIT == 60
        assert units.unit(longest).factor == pytest.approx(1e-3)
        with pytest.raises(FaultyText, match="is not a unit"):
            units.unit(longest + "*m")

    @pytest.mark.parametrize("text", ["Ym**99*Ym**99", "ym**99", "dB", "kN*furlongs_of_mine", "m//s"])
    def test_a_unit_without_a_finite_size_is_refused(self, text):
        with pytest.raises(FaultyText) as refused:
            units.unit(text)
        assert refused.value.code == "unknown_unit"

    @pytest.mark.parametrize(
        ("text", "base", "is_difference", "is_absolute"),
        [("delta_degC", "K", True, False), ("degC", "K", False, True), ("K", "K", False, False)],
    )
    def test_temperatures_and_their_differences(self, text, base, is_difference, is_absolute):
        unit = units.unit(text)
        assert unit.base == units.registry.Unit(base)
        assert (unit.difference, unit.absolute) == (is_difference, is_absolute)
        assert unit.from_si(unit.to_si(20.0)) == pytest.approx(20)

    def test_what_pint_remembers_stays_bounded(self, monkeypatch):
        units.unit.cache_clear()
        units.unit("kN*mm")
        kept = units.registry._cache
        remembered = (kept.root_units, kept.dimensionality, kept.parse_unit, kept.conversion_factor)
        assert any(remembered)
        monkeypatch.setattr(units, "MOST_REMEMBERED", 0)
        units.forget_units()
        assert not any(remembered)
        units.unit.cache_clear()
        assert units.unit("kN*mm").factor == pytest.approx(1)


class TestArrays:
    @pytest.mark.parametrize("value", [[1.0, 2.0], [[1.0, 2.0], [3.0, 4.0]], [[[[1.0], [2.0]]]]])
    def test_nested_lists_keep_their_shape(self, value):
        typed = read({"value": value, "unit": "mm"}, "m")
        assert typed.si.shape == np.shape(value)
        assert typed.si == pytest.approx(np.array(value) * 1e-3)

    @pytest.mark.parametrize(
        ("value", "code"),
        [
            ([], "empty"),
            ([[], []], "empty"),
            ([[1.0], [2.0, 3.0]], "uneven"),
            ([[1.0], 2.0], "uneven"),
            ([1.0, [2.0]], "not_a_number"),
            ([[[[[1.0]]]]], "not_a_number"),  # five axes
            ([True, 1.0], "not_a_number"),
            ([1.0, math.inf], "not_finite"),
            ([1, 10**400], "not_finite"),
        ],
    )
    def test_lists_that_are_no_arrays_are_refused(self, value, code):
        with pytest.raises(FaultyText) as refused:
            read({"value": value, "unit": "mm"}, "m")
        assert refused.value.code == code

    def test_a_unit_is_needed_unless_the_input_has_none(self):
        assert read({"value": 2.0}, "1").si == 2
        assert read({"value": 2.0, "unit": "%"}, "1").si == pytest.approx(0.02)
        with pytest.raises(FaultyText) as refused:
            read({"value": 2.0}, "mm")
        assert refused.value.code == "missing_unit"


class TestNames:
    def test_a_hundred_names_stand_in_a_sentence_and_the_others_are_counted(self):
        names = [f"n{number}" for number in range(MOST_LISTED + 3)]
        assert listed(names[:MOST_LISTED]).count("n") == MOST_LISTED
        assert "more" not in listed(names[:MOST_LISTED])
        assert listed(names).endswith(f"n{MOST_LISTED - 1} and 3 more")

    def test_the_first_ten_unknown_names_come_with_a_suggestion(self):
        faults = unknown_names([f"spead{n}" for n in range(12)], ["speed", "width"], "input")
        assert len(faults) == 12
        assert ["speed" in fault.detail for fault in faults] == [True] * 10 + [False] * 2


class Worded(Template):
    """A disc. It turns.

    Second paragraph.

    Limits
    ------
    Thin
    discs.
    Steel.

    References
    ----------
    A book.
    """

    example = {"x": "1 m"}

    x = given("m", "x")

    @derived("m", "hidden length")
    def hidden(self):
        return 2 * self.x

    @derived("m", "open length", shown=True)
    def opened(self):
        return 3 * self.x

    @formula("m**3", "volume")
    def volume(self):
        return self.x * self.hidden * self.opened


class Wordless(Template):
    example = {"x": "1 m"}

    x = given("m", "x")

    @formula("m", "same")
    def same(self):
        return self.x


class TestWords:
    def test_the_title_is_the_first_sentence_and_the_summary_the_first_paragraph(self):
        assert (Worded.title(), Worded.summary()) == ("A disc", "A disc. It turns.")

    def test_without_a_docstring_that_of_the_module_counts(self):
        assert Wordless.documentation() == __doc__.strip()

    def test_sections_are_read_line_by_line_up_to_a_full_stop(self):
        assert schema.documentation(Worded) == {
            "Limits": ["Thin discs.", "Steel."],
            "References": ["A book."],
        }

    def test_a_derived_input_is_an_output_only_if_it_says_so(self):
        outputs = evaluate(Worded, {"x": "1 m"}).outputs
        assert set(outputs) == {"volume", "open_length"}
        assert outputs["volume"].value == pytest.approx(6)

    @pytest.mark.parametrize(
        ("value", "latex"),
        [
            (12345.678, "12346"),
            (1.5e-7, r"1.5\,\cdot 10^{-7}"),
            (-2e12, r"-2\,\cdot 10^{12}"),
            (0.0, "0"),
            (0.1, "0.1"),
        ],
    )
    def test_numbers_have_five_digits(self, value, latex):
        assert mathml.number(value) == latex


class TestSolve:
    def test_a_root_is_closed_in_to_rounding(self):
        """x (2 x) (3 x) = 6 x³: to the last digits, not to some fixed step."""
        for target in (1e-9, 0.3, 4e6):
            solution = solve(Worded, {}, "x", ["1 um", "1 km"], {"volume": f"{target!r} m**3"})
            root = solution.evaluation.template.x
            assert float(root) == pytest.approx(np.cbrt(target / 6), rel=1e-13)


class TestFiles:
    @pytest.mark.parametrize(
        ("text", "line"),
        [
            ("x = 1\ny = = 2\n", 2),
            ("x = 1\n\ny = 1 / 0\n", 3),
            ("def f():\n    raise ValueError\n\nf()\n", 2),
        ],
        ids=["syntax", "running", "within"],
    )
    def test_a_file_that_cannot_be_imported_is_refused_with_the_line(self, tmp_path, text, line):
        (tmp_path / "broken_v1.py").write_text(text)
        with pytest.raises(UnusableFile, match=f"broken_v1.py: line {line}: "):
            find([tmp_path], Template)

    def test_a_file_with_two_templates_is_refused(self, tmp_path):
        base = "from templates.core.language.template import Template\n"
        one = base + "class {0}(Template):\n    example = {{}}\n"
        (tmp_path / "two_v1.py").write_text(one.format("A") + one.format("B"))
        with pytest.raises(UnusableFile, match="one template, not 2"):
            find([tmp_path], Template)
