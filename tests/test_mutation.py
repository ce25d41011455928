"""The mutation script selects related tests of a file, makes mutants, and reads its record."""

import ast
import json
import random
import tomllib

import pytest

from benchmarks.mutation import ROOT, observations
from benchmarks.mutation.related import NEAREST, changed, related
from benchmarks.mutation.verdict import REASONS, Reason, by_folder, reasons, summary, verdict


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
        assert 2 < len(tests) <= NEAREST + 2 + len(changed.ABOUT)
        assert len(set(tests)) == len(tests)
        assert not any(test.startswith("tests/app/web/") for test in tests)
    assert changed.CATALOGUE in related("templates/core/errors.py")


def test_a_server_is_stopped_where_the_table_of_slow_tests_says_so():
    assert "tests/app/http/test_stopping.py" in related("app/http/server.py")


def row(key, outcome="survived", file="templates/core/x.py", text="a = b + c", after="a = b - c"):
    about = {"key": key, "outcome": outcome, "file": file, "line": 1, "text": text, "operator": "o"}
    return about | {"diff": f"-{text}\n+{after}", "by": "tests/test_x.py::test_it - assert 1 == 2"}


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

    @pytest.mark.parametrize("outcome", ["unclear", "undecided"])
    def test_what_is_not_decided_counts_as_tried_and_fails(self, outcome):
        result = verdict([*killed(99), row("u", outcome)], [])
        assert not result.holds
        assert result.share == 0.99

    @pytest.mark.parametrize(
        "other",
        [{"file": "templates/core/y.py"}, {"text": "a = b + d"}, {"after": "a = b * c"}],
        ids=["file", "line", "change"],
    )
    def test_a_reason_is_for_one_change_of_one_line(self, other):
        assert EQUIVALENT.covers(row("s"))
        assert not EQUIVALENT.covers(row("s", **other))

    def test_the_summary_counts_all_and_lists_what_was_not_killed(self):
        rows = [*killed(8), row("s"), row("t", text="x = 1", after="x = 2")]
        figures = summary(rows, verdict(rows, [EQUIVALENT]))
        assert (figures["tried"], figures["killed"], figures["equivalent"]) == (10, 8, 1)
        assert figures["without_reason"] == 1
        assert figures["share"] == round(8 / 9, 4)
        assert [one["state"] for one in figures["not_killed"]] == ["equivalent", "without_reason"]
        assert len(figures["killed_by"]) == 8
        assert figures["killed_by"][0]["change"] == "a = b - c"
        assert figures["killed_by"][0]["test"] == "tests/test_x.py::test_it"

    def test_folders_are_counted(self):
        assert by_folder([*killed(2), row("s")]) == {"templates/core": (2, 3)}


def test_every_reason_on_file_argues():
    assert all(len(reason.reason) > 20 for reason in reasons(REASONS))


def test_the_text_of_every_named_mutant_occurs_once():
    """Also where Cosmic Ray is not installed: an entry has to follow the code when that changes."""
    entries = tomllib.loads(REASONS.read_text(encoding="utf-8"))["named"]
    files = (file for folder in ("app", "cad", "templates") for file in (ROOT / folder).rglob("*.py"))
    code = "\n".join(file.read_text(encoding="utf-8") for file in files)
    assert {entry["title"]: code.count(entry["before"]) for entry in entries} == {
        entry["title"]: 1 for entry in entries
    }


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
        listed = places.places(file, 1)
        mutants = [one for place in random.Random(1).sample(listed, 10) if (one := places.mutant(place))]
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
        spans = places.annotated(source)
        assert sorted(span[0] for span in spans) == [(1, 9), (1, 28), (2, 7)]

    def test_a_call_that_nobody_uses_is_dropped(self, places):
        source = "def f(x):\n    'Words.'\n    x.flush()\n    return g(x)\n"
        spans = [s for name, _, s in places.occurrences(source) if name == "ours/DropCall"]
        assert [span[0] for span in spans] == [(3, 4)]
        dropped = places.mutate_code(source, places.OPERATORS["ours/DropCall"], 0)
        assert dropped == source.replace("x.flush()", "pass")


class TestObservations:
    """Which tests run a line, from what a run of each file wrote."""

    FILE, OTHER, TEST = "app/jobs/turns.py", "app/jobs/leases.py", "tests/app/jobs/test_turns.py"

    @pytest.fixture
    def source(self, tmp_path, monkeypatch):
        """A repository of two files and one test, which runs one of them."""
        for name in (self.FILE, self.OTHER, self.TEST):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(
                "A = (\n    1,\n)\n\n@cache\ndef f(x):\n    if x:\n        return A\n    return 0\n"
            )
        monkeypatch.setattr(observations, "ROOT", tmp_path)
        monkeypatch.setattr(observations, "targets", lambda: [self.FILE, self.OTHER])
        for function in (observations.dependent, observations._tree, observations.digest):
            function.cache_clear()
        yield tmp_path
        for function in (observations.dependent, observations._tree, observations.digest):
            function.cache_clear()

    @staticmethod
    def observed(folder, seen):
        """Observations that a run of pytest would make, and how often it ran."""
        runs = []

        def observe(test, target):
            runs.append(test)
            if seen is not None:
                target.write_text(json.dumps(seen))
            return seen is not None

        return observations.Observations(folder / "kept", observe), runs

    def seen(self, **changes):
        names = ["slow[1]", "slow[2]", "quick[1]", "quick[2]", "other"]
        seconds = {f"{self.TEST}::{name}": took for name, took in zip(names, (9, 8, 1, 2, 0.1), strict=True)}
        lines = {self.FILE: {1: [], 6: [], 7: [0, 1, 2, 3, 4], 8: [0, 1, 2, 3], 9: [4]}}
        return {"seconds": seconds, "lines": lines, "programs": False, "processes": True} | changes

    @pytest.mark.parametrize(
        ("line", "lines"),
        [(2, range(1, 10)), (5, range(5, 10)), (6, range(5, 10)), (7, range(7, 8)), (8, range(8, 9))],
    )
    def test_a_line_depends_on_its_statement_a_head_on_its_function_others_on_the_file(
        self, source, line, lines
    ):
        assert observations.dependent(self.FILE, line) == lines

    def test_quick_tests_come_first_and_one_of_each_function(self, source):
        kept, _ = self.observed(source, self.seen())
        names = [test.rpartition("::")[2] for test in kept.quickest(self.FILE, 8, [self.TEST])]
        assert names == ["quick[1]", "slow[2]", "quick[2]", "slow[1]"]
        assert kept.seconds(self.FILE, kept.quickest(self.FILE, 8, [self.TEST])) == 20
        assert kept.quickest(self.FILE, 9, [self.TEST]) == [f"{self.TEST}::other"]

    def test_the_first_test_may_take_any_time_and_all_together_half_a_minute(self, source):
        seconds = {test: 40 * took for test, took in self.seen()["seconds"].items()}
        kept, _ = self.observed(source, self.seen(seconds=seconds))
        assert kept.quickest(self.FILE, 8, [self.TEST]) == [f"{self.TEST}::quick[1]"]
        others = kept.others(self.FILE, 8, [self.TEST], kept.quickest(self.FILE, 8, [self.TEST]))
        assert [test.rpartition("::")[2] for test in others] == ["quick[2]", "slow[1]", "slow[2]"]

    def test_a_whole_file_runs_only_if_it_starts_servers(self, source):
        with_server, _ = self.observed(source / "a", self.seen(programs=True))
        assert with_server.others(self.FILE, 9, [self.TEST], ()) == [self.TEST]
        without, _ = self.observed(source / "b", self.seen())
        assert without.others(self.FILE, 9, [self.TEST], ()) == [f"{self.TEST}::other"]

    def test_a_file_that_cannot_be_observed_runs_as_a_whole(self, source):
        kept, _ = self.observed(source, None)
        assert kept.quickest(self.FILE, 8, [self.TEST]) == []
        assert kept.others(self.FILE, 8, [self.TEST], ()) == [self.TEST]

    def test_a_file_that_was_not_run_is_looked_for_again_once_it_has_changed(self, source):
        kept, runs = self.observed(source, self.seen())
        assert kept.of(self.TEST, self.OTHER).tests(self.OTHER, [7]) == set()
        assert kept.has(self.TEST, self.OTHER)
        (source / self.OTHER).write_text("def g():\n    return 1\n")
        observations.digest.cache_clear()
        assert not kept.has(self.TEST, self.OTHER)
        kept.of(self.TEST, self.OTHER)
        assert len(runs) == 2

    def test_an_observation_is_kept_until_the_file_or_the_test_changes(self, source):
        for changed_file, expected in ((None, 1), (self.FILE, 1), (self.TEST, 1)):
            kept, runs = self.observed(source, self.seen())
            if changed_file:
                (source / changed_file).write_text("A = 2\n\n")
                observations.digest.cache_clear()
            kept.quickest(self.FILE, 8, [self.TEST])
            kept.quickest(self.FILE, 9, [self.TEST])
            assert len(runs) == expected
            again, runs = self.observed(source, self.seen())
            again.quickest(self.FILE, 8, [self.TEST])
            assert runs == []
