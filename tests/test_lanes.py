"""Which tests run together, which slow ones after a change, and how tests wait."""

import fnmatch
import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import patience
import pytest
from lanes import MODELS, PAGES, SERVED, TOGETHER, group_of, rank, require_equal_everywhere, unsampled
from patience import until

from benchmarks.mutation.related import changed

ROOT = Path(__file__).parents[1]


def item(file, *fixtures):
    return SimpleNamespace(
        path=ROOT / file, config=SimpleNamespace(rootpath=ROOT), fixturenames=["tmp_path", *fixtures]
    )


@pytest.mark.parametrize(
    ("test", "group"),
    [
        (item("tests/app/web/test_pages.py", "http"), PAGES),
        (item("tests/app/designs/test_designs.py", "http", "served"), SERVED),
        (item("tests/app/test_jobs.py"), "tests/app/test_jobs.py"),
        (item("tests/physics/test_oil.py"), "tests/physics/test_oil.py"),
        (item("tests/test_lanes.py"), "tests/test_mutation.py"),
        (item("tests/cad/test_dxf.py"), MODELS),
    ],
)
def test_tests_of_one_server_or_one_file_share_a_worker(test, group):
    assert group_of(test) == group


def test_files_that_share_a_worker_exist():
    assert [file for file in TOGETHER if not (ROOT / file).exists()] == []


@pytest.mark.skipif("PYTEST_XDIST_WORKER" not in os.environ, reason="needs pytest-xdist: pytest -n 2")
def test_the_scheduler_reads_the_group(request):
    assert request.node.nodeid.endswith("@tests/test_mutation.py")


def test_an_id_that_differs_from_worker_to_worker_is_refused_by_name():
    ids = ["a[{'x': '1', 'y': {'z'}}]", "b[{'x'}-2]", "c[{'x', 'y'}-2]"]
    items = [SimpleNamespace(nodeid=id) for id in ids]
    require_equal_everywhere(items[:2])
    with pytest.raises(pytest.UsageError, match=r"^1 ids have the text of a set: c"):
        require_equal_everywhere(items)


def test_servers_begin_first():
    groups = ["tests/physics/test_oil.py", SERVED, PAGES]
    assert sorted(groups, key=rank) == [PAGES, SERVED, "tests/physics/test_oil.py"]


@pytest.mark.parametrize(("cases", "count", "quick"), [(7, 3, "024"), (3, 1, "0"), (2, 5, "01"), (1, 1, "0")])
def test_the_quick_cases_of_a_sampled_test_are_spread_over_all(cases, count, quick):
    marker = SimpleNamespace(args=(count,))
    each = [SimpleNamespace(name=str(n), get_closest_marker=lambda _: marker) for n in range(cases)]
    slow = unsampled(each)
    assert "".join(case.name for case in each if case not in slow) == quick


@pytest.mark.parametrize(
    ("file", "test", "other"),
    [
        (
            "templates/physics/films/reynolds.py",
            "tests/physics/test_film_map.py",
            "tests/cad/test_cranks_random.py",
        ),
        ("cad/step.py", "tests/cad/analysis/test_stress.py", "tests/physics/test_film_map.py"),
        (
            "templates/physics/supplied/supplied_march.py",
            "tests/templates/test_golden_at_length.py",
            "tests/cad/test_cranks_random.py",
        ),
        ("cad/models/crank_throw_v1.py", "tests/cad/test_cranks_random.py", "tests/app/test_crash.py"),
        ("cad/models/bearing_assembly_v1.py", "tests/cad/test_dxf.py", "tests/app/test_crash.py"),
        ("cad/freecad/admission.py", "tests/app/imported_models/test_freecad.py", "tests/app/test_crash.py"),
        ("templates/oil_film/oil_film_v2.py", changed.CATALOGUE, "tests/cad/test_cranks_random.py"),
        ("app/storage/database.py", "tests/app/test_crash.py", "tests/physics/test_film_map.py"),
        (
            "tests/app/serving.py",
            "tests/app/http/test_contract_at_length.py",
            "tests/physics/test_film_map.py",
        ),
        (
            "tests/references/torsional_frequencies.csv",
            "tests/templates/stiffness/test_torsional_vibration_v1.py",
            "tests/app/test_crash.py",
        ),
    ],
)
def test_a_change_selects_the_slow_tests_that_reach_it(file, test, other):
    assert (ROOT / file).exists()
    selected = changed.selection([file])
    assert test in selected
    assert other not in selected


def test_prose_selects_nothing():
    assert changed.selection(["README.md"]) == []


def test_the_fixed_selection_holds_slow_tests():
    assert set(changed.ALWAYS) < set(changed.slow_files())
    assert changed.selection(None) == changed.selection(["constraints.txt"]) == sorted(changed.ALWAYS)


def test_a_test_of_a_whole_server_is_about_files_that_exist():
    tree = [changed.name(file) for part in ("app", "cad", "templates") for file in (ROOT / part).rglob("*.*")]
    slow = changed.slow_files()
    for test, patterns in changed.ABOUT.items():
        assert test in slow
        for pattern in patterns:
            files = fnmatch.filter([*tree, "pyproject.toml"], pattern)
            assert files, f"{test}: {pattern} names no file"
            assert changed.is_related(test, files[:1])
        assert not changed.is_related(test, ["app/web/shared/icon.svg"])


def test_a_slow_test_of_the_pages_is_about_the_pages():
    pages = {
        test for test in changed.slow_files() if test.startswith("tests/app/web/")
    } - changed.ABOUT.keys()
    assert len(pages) > 10
    assert pages <= set(changed.selection(["app/web/design/design.js"]))
    assert pages & set(changed.selection(["app/designs/service.py"])) == set()


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_a_clone_without_history_gets_the_fixed_selection(tmp_path, monkeypatch):
    monkeypatch.delenv("CRANKWRIGHT_CI_BASE", raising=False)
    (tmp_path / ".ci").mkdir()
    script = shutil.copy(ROOT / ".ci" / "changed.py", tmp_path / ".ci")
    for command in (
        ["git", "init", "-q", "."],
        ["git", "-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "--allow-empty", "-m", "first"],
    ):
        subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == sorted(changed.ALWAYS)
    assert "cannot compare with HEAD~1" in done.stderr


def test_until_returns_the_answer_that_was_wanted():
    answers = iter([1, 2, 3, 4])
    assert until(lambda: next(answers), lambda answer: answer > 2) == 3


def test_until_fails_with_the_last_answer(monkeypatch):
    monkeypatch.setattr(patience, "FACTOR", 0.0)
    with pytest.raises(AssertionError, match="waited 0 s; last answer: 'regenerating'"):
        until(lambda: "regenerating", lambda answer: answer == "current")
