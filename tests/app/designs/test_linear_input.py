"""Processing of client bytes takes linear time, or the number of items is limited."""

from types import SimpleNamespace

import pytest
from scaling import LIMIT, assert_constant, assert_linear, times
from starlette.requests import cookie_parser

from app.api.responses import patience
from app.calculations.bodies import OIL_FILM, EvaluateIn
from app.calculations.curves import curves_of
from app.calculations.tables import _NUMBER, LONGEST_LINE
from app.designs.document import Document, merge
from app.designs.graph import MOST_RELATION_TEXT, Catalogues, Graph, build_graph
from app.designs.routes.files import _accepted
from app.http import problems
from app.http.limits import _plain_cookies
from app.http.pages import page_of
from app.pool.cost import points
from app.presentation import numbers
from app.presentation.input_text import text_of, value_of
from app.reports.cells import clean
from app.reports.routes import REPORTS, _wanted
from app.solids.routes.models import BuildIn
from app.web.shared.forms import kept, patch_of
from cad.lists import listed
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import MOST_SUGGESTED, Fault, InvalidInputs, excerpt, unknown_name, unknown_names
from templates.core.language.meaning import api_name
from templates.core.nearest import nearest
from templates.core.units.quantity import _parted, read
from templates.core.units.relation import MAX_LENGTH, parse
from templates.core.units.units import MOST_REMEMBERED, forget_units, registry, unit
from templates.oil_film.oil_film_v1 import OilFilm

RELATIONS = {
    "signs": lambda n: "= " + "-" * n + "1",
    "dots": lambda n: "= " + "." * n,
    "brackets": lambda n: "= " + "(" * n,
    "closed brackets": lambda n: "= " + "(" * (n // 2) + "1" + ")" * (n // 2),
    "calls": lambda n: "= " + "abs(" * (n // 4),
    "a long name": lambda n: "= " + "a" * n,
    "a name of parts": lambda n: "= a" + ".a" * (n // 2),
    "digits": lambda n: "= " + "1" * n,
    "digits and a letter": lambda n: "= " + "1" * n + "x",
    "a long unit": lambda n: "= 1 a" + "*a" * (n // 2),
    "a unit, not closed": lambda n: "= 1 a/(" + "a" * n,
    "units, not closed": lambda n: "= " + "1 a/(" * (n // 5),
    "a sum": lambda n: "= 1" + "+1" * (n // 2),
    "powers": lambda n: "= 9" + "**9" * (n // 3),
    "blanks": lambda n: "= 1" + " " * n + "x",
}
CELLS = {
    "digits": "1",
    "dots": ".",
    "signs": "-",
    "exponents": "1e",
    "quotes": '"',
    "quoted quotes": '"",',
    "commas": ",",
    "semicolons": ";",
    "brackets": "[",
    "blanks": " ",
    "letters": "x",
    "accents": "é",
}


class TestUnitsAndQuantities:
    @pytest.mark.parametrize(
        "piece", ["m*", "m/", "m**9", "²", ".", "-", "(", "a_", "µ", "1", "/(m*m)", "%", " "]
    )
    def test_a_unit(self, piece):
        assert_constant(unit.__wrapped__, lambda n: "m" + piece * n, 100_000)

    @pytest.mark.parametrize("piece", ["1", ".", "-", "+1", "e9", " ", "m ", "\n", "1 "])
    def test_a_quantity(self, piece):
        assert_constant(lambda text: read(text, "mm"), lambda n: "1" + piece * n + "\x00", 100_000)

    @pytest.mark.parametrize("piece", ["1", " ", "m ", " m", "\t"])
    def test_a_quantity_below_its_bound(self, piece):
        assert_linear(_parted, lambda n: ("1 a" + piece * 1000)[:n] + "b", 50)

    def test_a_list_of_quantities(self):
        assert_linear(lambda raw: read(raw, "mm"), lambda n: ["1 " + " " * 190 + "mm"] * n, 500)

    @pytest.mark.parametrize("text", ["[1] {}[", "{}[1", "[{}", "[1] deg{}]"])
    def test_a_list_of_a_model(self, text):
        assert_linear(listed, lambda n: text.format(" " * n), 480)
        assert_constant(listed, lambda n: text.format(" " * n), 100_000)

    def test_rows_of_an_array(self):
        assert_linear(lambda raw: read(raw, "1"), lambda n: [[1.0, 2.0]] * n, 2000)
        assert_linear(points, lambda n: {f"a{i}": [1, 2, 3] for i in range(n)}, 500)

    def test_pint_does_not_keep_everything_that_it_was_asked_for(self, monkeypatch):
        monkeypatch.setattr("templates.core.units.units.MOST_REMEMBERED", 200)
        for power in range(300):
            unit.__wrapped__(f"mm**{power % 99}*s**{power // 99}")
        forget_units()
        remembered = registry._cache
        assert max(map(len, (remembered.parse_unit, remembered.root_units, remembered.dimensionality))) <= 202
        assert unit.__wrapped__("kN/mm**2").factor == 1e9
        assert MOST_REMEMBERED > 4096


class TestRelations:
    @pytest.mark.parametrize("make", RELATIONS.values(), ids=RELATIONS)
    @pytest.mark.sampled(3)
    def test_within_the_bound(self, make):
        assert_linear(parse.__wrapped__, make, MAX_LENGTH // 4 - 5)

    @pytest.mark.parametrize("make", RELATIONS.values(), ids=RELATIONS)
    def test_beyond_the_bound(self, make):
        assert_constant(parse.__wrapped__, make, 250_000)

    def test_the_relations_of_a_design(self):
        def make(count):
            return Document(name="x", parameters={"a": [f"= {i} + 1" for i in range(count)]})

        assert_linear(lambda document: build_graph(document, NONE), make, 200)

    @pytest.mark.parametrize("relation", ["= " + "-" * 1900 + "1", "= a" + " + a" * 100])
    def test_more_of_them_than_a_design_takes_are_not_read(self, relation):
        count = MOST_RELATION_TEXT // len(relation) + 1
        document = Document(name="x", parameters={"a": [relation] * count})
        graph, (fault,) = build_graph(document, NONE)
        assert (fault.name, fault.code) == ("design", "too_long")
        assert not graph.parameters
        assert_linear(lambda document: build_graph(document, NONE), lambda n: repeated(relation, n), 1000)

    def test_names_that_nothing_has(self):
        def make(count):
            names = "= " + " + ".join(f"width_{i}" for i in range(90))
            return Document(name="x", parameters={f"width{i}": names for i in range(count)})

        assert_linear(lambda document: build_graph(document, NONE), make, 25)


NONE = Catalogues(Catalogue({}, "template"), Catalogue({}, "model"))


def repeated(relation, count):
    return Document(name="x", parameters={"a": [relation] * count})


class TestCurves:
    @pytest.mark.parametrize("piece", CELLS.values(), ids=CELLS)
    def test_a_line_of_them(self, piece):
        def make(length):
            return b"p [bar]\n" + 20 * ((piece * length)[:length] + "z\n").encode()

        assert_linear(curves_of, make, LONGEST_LINE // 4 - 1)

    @pytest.mark.parametrize("piece", CELLS.values(), ids=CELLS)
    def test_a_number(self, piece):
        assert_linear(_NUMBER.fullmatch, lambda n: piece * n + "z", 20_000)

    @pytest.mark.parametrize("piece", CELLS.values(), ids=CELLS)
    def test_a_header(self, piece):
        assert_linear(curves_of, lambda n: (piece * n)[:n].encode() + b"\n1\n", LONGEST_LINE // 4 - 1)

    @pytest.mark.parametrize("piece", [*CELLS.values(), "\xff"], ids=[*CELLS, "no UTF-8"])
    @pytest.mark.sampled(3)
    def test_a_line_beyond_the_bound(self, piece):
        assert_linear(curves_of, lambda n: b"p [bar]\n" + piece.encode("latin-1") * n, 250_000)

    @pytest.mark.parametrize("line", ["1\n", "1,2\n", "x\n", "#\n", "\n", "\r", "\f", "\u2028", '"\n'])
    @pytest.mark.sampled(3)
    def test_lines(self, line):
        assert_linear(curves_of, lambda n: b"p [bar]\n" + line.encode() * n, 4000)

    @pytest.mark.parametrize("line", ["\n", "\r\n", "#\n", "\f"])
    def test_lines_beyond_the_bound(self, line):
        assert_linear(curves_of, lambda n: line.encode() * n, 250_000)


class TestDesigns:
    def test_a_merge_patch(self):
        def action(patch):
            merge(
                {"name": "x", "parameters": {"a": "1"}},
                {"parameters": patch, "steps": {"s": {"inputs": patch}}},
            )

        assert_linear(action, lambda n: {f"p{i}": i for i in range(n)}, 5000)

    def test_a_deep_merge_patch(self):
        def deep(n):
            patch = {}
            for _ in range(n):
                patch = {"steps": patch}
            return patch

        assert_linear(lambda patch: merge({"name": "x"}, patch), deep, 5000)

    def test_names(self):
        assert_linear(
            Document.model_validate,
            lambda n: {"name": "x", "parameters": {f"p{i}": "1" for i in range(n)}},
            125,
        )

    @pytest.mark.parametrize(
        "make",
        [
            lambda n: {"name": "x", **{f"k{i}": 1 for i in range(n)}},
            lambda n: {"name": "x", "parameters": {f"k.{i}": 1 for i in range(n)}},
            lambda n: {"name": "x", "iterations": [1] * n},
            lambda n: {"name": "x", "steps": {"a": {"template": "t", "outputs": [1] * n}}},
            lambda n: {
                "name": "x",
                "steps": {"a": {"template": "t", "inputs": {f"k.{i}": 1 for i in range(n)}}},
            },
            lambda n: {"name": "x", "models": {"a": {"id": "t", **{f"k{i}": 1 for i in range(n)}}}},
        ],
    )
    def test_what_no_document_has(self, make):
        assert_constant(Document.model_validate, make, 10_000)

    def test_what_no_build_has(self):
        assert_constant(BuildIn.model_validate, lambda n: {"parameters": {}, "artifacts": [1] * n}, 100_000)
        assert_constant(
            BuildIn.model_validate, lambda n: {"parameters": {f"a{i}": 1 for i in range(n)}}, 10_000
        )

    def test_the_names_of_blocks_are_looked_up_once(self):
        cells = build_graph(Document(name="x", parameters={"a": "1", "b": "= a"}), NONE)[0].parameters
        assert_linear(
            lambda n: [
                graph.wanted(f"m{i}", "torsion")
                for graph in [Graph(cells, {}, frozenset())]
                for i in range(n)
            ],
            int,
            2000,
        )


class TestNames:
    @pytest.mark.parametrize("piece", ["a", "ab", "bearing_width", "_"])
    def test_a_long_one(self, piece):
        assert_constant(lambda name: nearest(name, OilFilm.inputs), lambda n: piece * n, 100_000)

    def test_many_unknown_ones(self):
        assert_linear(lambda names: unknown_names(names, OilFilm.inputs, "input"), close_names, 2000)

    def test_many_declared_ones(self):
        assert_constant(lambda declared: unknown_name("a" * 64, declared, "name"), alike_names, 1500)

    def test_only_the_first_get_a_suggestion(self):
        faults = unknown_names(close_names(50), OilFilm.inputs, "input")
        assert len(faults) == 50
        assert all("did you mean" in fault.detail for fault in faults[:MOST_SUGGESTED])
        assert not any("did you mean" in fault.detail for fault in faults[MOST_SUGGESTED:])

    def test_the_nearest_is_found_among_many(self):
        declared = [*(f"film.parameter_{i}" for i in range(500)), "film.bearing_diameter"]
        assert nearest("film.bearing_diametre", declared)[0] == "film.bearing_diameter"

    def test_inputs_of_a_template(self):
        def action(names):
            EvaluateIn(inputs={**OIL_FILM, **dict.fromkeys(names, "1")})
            OilFilm.from_quantities({**OIL_FILM, **dict.fromkeys(names, "1")})

        assert_linear(action, close_names, 500)

    def test_words(self):
        for piece in ("a", "_", " ", "A-", "é"):
            assert_linear(api_name, lambda n, piece=piece: piece * n, 50_000)


def close_names(count):
    return [f"bearing_diametre_{i}" for i in range(count)]


def alike_names(count):
    return ["a" * 59 + f"{i:05d}" for i in range(count)]


class TestHeaders:
    @pytest.mark.parametrize("piece", ["wait=", "wait=9", "w", "wait=1 ", ",", "respond-async", "=9999"])
    def test_prefer(self, piece):
        assert_linear(lambda text: patience(text, 2.0), lambda n: piece * n, 20_000)

    @pytest.mark.parametrize("piece", ["/", ",", ";", "q=", ";q=0.5", "text/html,", "model/step;q=1,", " "])
    def test_accept(self, piece):
        assert_linear(_accepted, lambda n: piece * n, 20_000)
        assert_linear(lambda text: _wanted("report", None, text, REPORTS), lambda n: piece * n, 20_000)

    @pytest.mark.parametrize("piece", ['"', '"\\a', "\\", 'a="\\1";', "a=1;", ";", "="])
    def test_cookies(self, piece):
        def action(header):
            cookie_parser(_plain_cookies(header).decode())

        assert_linear(action, lambda n: b'a="' + piece.encode() * n + b'"', 5000)

    def test_cookies_in_quotes_are_dropped(self):
        assert (
            _plain_cookies(b'units=us; x="a\\b"; crankwright_session=abc')
            == b"units=us; crankwright_session=abc"
        )

    @pytest.mark.parametrize("cursor", ["9", "x", "٣", "-"])
    def test_cursor(self, cursor):
        assert_linear(lambda text: page_of([1, 2], 1, text, str), lambda n: cursor * n, 50_000)


class TestForms:
    @pytest.mark.parametrize("piece", ["[", "[]", "{", '{"a":', "[1,", '"', "]", "}", " ", "-", "NaN,"])
    def test_a_value(self, piece):
        assert_linear(value_of, lambda n: "[" + piece * n + "] mm", 20_000)

    def test_fields(self):
        design = SimpleNamespace(parameters={}, steps={f"s{i}" for i in range(100)}, models={})
        assert_linear(
            lambda typed: patch_of(design, typed), lambda n: {f"s{i % 100}.a{i}": "1" for i in range(n)}, 2000
        )
        assert_linear(kept, lambda n: {"was": "[" * n, "a": " " * n}, 50_000)

    @pytest.mark.parametrize("value", ["[NaN]", "[Infinity]", "[" * 500 + "]" * 500])
    def test_what_json_does_not_know_stays_a_text(self, value):
        assert value_of(value) == value
        assert kept({"was": "[" * 10_000, "a": "1"}) == {"was": "[" * 10_000, "a": "1"}


class TestAnswers:
    def test_an_excerpt(self):
        assert_constant(excerpt, lambda n: "\ud800" * n, 100_000)
        assert_constant(excerpt, lambda n: [1] * n, 100_000)
        assert_linear(excerpt, lambda n: {f"k{i}": 1 for i in range(n)}, 5000)

    def test_a_problem(self):
        assert_linear(
            lambda n: problems.describe(InvalidInputs(Fault(f"n{i}", "code", "detail") for i in range(n))),
            int,
            2000,
        )

    def test_the_place_of_a_fault_is_short(self):
        error = SimpleNamespace(errors=lambda: [{"loc": ("body", "x" * 10**6), "msg": "wrong", "type": "t"}])
        (fault,) = problems._validation(error)["errors"]
        assert len(fault["name"]) == problems.LONGEST_PLACE

    @pytest.mark.parametrize(
        "piece", ["a", "\x00", *(pytest.param(piece, marks=pytest.mark.slow) for piece in ("\u202e", " "))]
    )
    @pytest.mark.sampled(1)
    def test_a_text_in_a_report(self, piece):
        assert_linear(clean, lambda n: piece * n, 20_000)
        assert_linear(text_of, lambda n: [piece] * n, 20_000)
        assert_linear(numbers.in_line, lambda n: [1.0] * n, 20_000)  # the least and the largest are shown


def test_the_measurement_tells_a_quadratic_function():
    def quadratic(n):
        return sum(1 for _ in range(n) for _ in range(n))

    least = times(quadratic, int, 200)
    assert least[2] > LIMIT * least[0]
    with pytest.raises(AssertionError):
        assert_linear(quadratic, int, 200)
