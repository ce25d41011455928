"""The script of the mutation tests: which tests are about a file, what a record amounts to, which mutants."""

import ast
import random

import pytest

from benchmarks.mutation.related import NEAREST, changed, related
from benchmarks.mutation.verdict import REASONS, Reason, by_folder, reasons, verdict


@pytest.mark.parametrize(
    ("file", "test"),
    [
        ("templates/physics/films/film_map.py", "tests/physics/test_film_map.py"),
        ("templates/physics/engine/gas_cycle.py", "tests/physics/test_gas_cycle.py"),
        ("templates/core/units/quantity.py", "tests/templates/core/test_quantities.py"),
        ("cad/regenerate.py", "tests/cad/test_keys.py"),
    ],
)
def test_a_file_has_its_own_tests(file, test):
    assert test in related(file)


def test_related_tests_are_few_and_none_of_the_pages():
    for file in ("templates/core/errors.py", "app/jobs/turns.py"):
        tests = related(file)
        assert 2 < len(tests) <= NEAREST + 2
        assert len(set(tests)) == len(tests)
        assert not any(test.startswith("tests/web/") for test in tests)
    assert changed.CATALOGUE in related("templates/core/errors.py")


def row(key, outcome="survived", file="templates/core/x.py", text="a = b + c", after="a = b - c"):
    return {"key": key, "outcome": outcome, "file": file, "line": 1, "text": text, "operator": "o"} | {
        "diff": f"-{text}\n+{after}"
    }


def killed(count):
    return [row(f"k{number}", "killed") for number in range(count)]


EQUIVALENT = Reason("core/x.py", "a = b + c", "b - c", "c is 0 here", equivalent=True)
ACCEPTED = Reason("core/x.py", "a = b + c", "b - c", "a matter of taste")


class TestVerdict:
    def test_a_survivor_without_a_reason_fails(self):
        result = verdict([*killed(99), row("s")], [])
        assert [one["key"] for one in result.without_reason] == ["s"]
        assert not result.holds
        assert verdict(killed(99), []).holds

    def test_an_equivalent_mutant_leaves_the_figure_and_an_accepted_one_does_not(self):
        rows = [*killed(9), row("s")]
        assert verdict(rows, [EQUIVALENT]).share == 1
        assert verdict(rows, [EQUIVALENT]).holds
        assert verdict(rows, [ACCEPTED]).share == 0.9
        assert verdict(rows, [ACCEPTED]).holds

    def test_too_few_killed_or_too_many_equivalent_fail_however_argued(self):
        assert not verdict([*killed(84), *(row(f"s{n}") for n in range(16))], [ACCEPTED]).holds
        assert verdict([*killed(85), *(row(f"s{n}") for n in range(15))], [ACCEPTED]).holds
        assert not verdict([*killed(89), *(row(f"s{n}") for n in range(11))], [EQUIVALENT]).holds
        assert verdict([*killed(90), *(row(f"s{n}") for n in range(10))], [EQUIVALENT]).holds

    def test_a_failure_that_no_mutant_explains_fails(self):
        assert not verdict([*killed(99), row("u", "unclear")], []).holds

    @pytest.mark.parametrize(
        "other",
        [{"file": "templates/core/y.py"}, {"text": "a = b + d"}, {"after": "a = b * c"}],
        ids=["file", "line", "change"],
    )
    def test_a_reason_is_for_one_change_of_one_line(self, other):
        assert EQUIVALENT.covers(row("s"))
        assert not EQUIVALENT.covers(row("s", **other))

    def test_folders_are_counted(self):
        assert by_folder([*killed(2), row("s")]) == {"templates/core": (2, 3)}


def test_every_reason_on_file_argues():
    assert all(len(reason.reason) > 20 for reason in reasons(REASONS))


class TestPlaces:
    """What Cosmic Ray is for; it is installed for the nightly checks only."""

    @pytest.fixture
    def places(self):
        return pytest.importorskip("benchmarks.mutation.places", exc_type=ImportError)

    def test_every_named_mutant_is_found_in_the_code(self, places):
        named = pytest.importorskip("benchmarks.mutation.named", exc_type=ImportError)
        mutants = named.named(REASONS)
        assert len({mutant.key for mutant in mutants}) == len(mutants) >= 11

    def test_each_mutant_differs_from_its_file_by_one_place(self, places):
        file = "templates/physics/journals/whirl.py"
        before = (places.ROOT / file).read_text(encoding="utf-8")
        found = places.places(file, 1)
        mutants = [one for place in random.Random(1).sample(found, 10) if (one := places.mutant(place))]
        assert len(mutants) > 5
        for mutant in mutants:
            assert ast.dump(ast.parse(mutant.source)) != ast.dump(ast.parse(before))
            assert [line[0] for line in mutant.diff.splitlines()] == ["-", "+"]

    def test_ranks_follow_the_seed_and_not_the_number_of_the_line(self, places):
        def at(above, seed):
            span, lines = ((above + 1, 6), (above + 1, 7)), [*["x"] * above, "a = b + c"]
            return places.place("x.py", span, "k", lines, places.Counter(), (("o", 0),), seed).rank

        assert at(0, 1) == at(5, 1)
        assert at(0, 1) != at(0, 2)

    def test_annotations_are_no_places(self, places):
        source = "def f(a: int | None = 1) -> int | str:\n    b: int | None = a\n    return b\n"
        spans = places.annotations(source)
        assert sorted(span[0] for span in spans) == [(1, 9), (1, 28), (2, 7)]

    def test_a_call_that_nobody_uses_is_dropped(self, places):
        source = "def f(x):\n    'Words.'\n    x.flush()\n    return g(x)\n"
        spans = [s for name, _, s in places.occurrences(source) if name == "ours/DropCall"]
        assert [span[0] for span in spans] == [(3, 4)]
        dropped = places.mutate_code(source, places.OPERATORS["ours/DropCall"], 0)
        assert dropped == source.replace("x.flush()", "pass")
