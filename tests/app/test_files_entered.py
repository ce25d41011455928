"""A change enters few files of `app`, and is parsed, ordered and calculated once."""

import sys
import threading
from pathlib import Path

import pytest

from benchmarks.files_entered import Files, change_to_step, changed_step, evaluation
from benchmarks.function_calls import Calls, counted
from templates.core.units.units import unit

ROOT = Path(__file__).resolve().parents[2]
MOST_FILES = 47  # of app, without HTTP, queue and the kernel's process; the aim was 50
MOST_WITH_HTTP = 45  # of app, for a change of one closed-form step
MOST_OF_AN_EVALUATION = 20  # of app, with HTTP
TEMPLATES = {change_to_step: 31, changed_step: 29, evaluation: 27}
"""The most files of templates: as many as before the rooms were tidied (a901714f)."""


@pytest.fixture(scope="module")
def calls():
    return counted(ROOT)


def test_a_changed_width_enters_few_files(calls):
    assert set(calls.by_package(ROOT)) == {"app", "cad", "templates"}
    names = {code.co_qualname for code in calls.counts}
    assert {"Designs.change", "Regeneration.__call__", "PlainBearing.build", "check_dimensions"} <= names
    files = Files(calls.counts, ROOT)
    assert files.app <= MOST_FILES, " ".join(files.by_package["app"])


@pytest.mark.parametrize(("change", "most"), [(change_to_step, MOST_FILES), (changed_step, MOST_WITH_HTTP)])
def test_a_change_of_the_paper_s_design_enters_few_files(change, most):
    files = change(ROOT)
    assert {"app/designs/service.py", "app/designs/engine/calculate.py"} <= set(files.by_package["app"])
    assert files.app <= most, " ".join(files.by_package["app"])
    assert files.templates <= TEMPLATES[change], " ".join(files.by_package["templates"])


def test_an_evaluation_enters_few_files():
    files = evaluation(ROOT)
    assert {"app/calculations/service.py", "app/calculations/json_values.py"} <= set(files.by_package["app"])
    assert files.app <= MOST_OF_AN_EVALUATION, " ".join(files.by_package["app"])
    assert files.templates <= TEMPLATES[evaluation], " ".join(files.by_package["templates"])


def test_threads_that_serve_no_request_are_not_counted():
    def entered(name):
        calls = Calls(ROOT)
        with calls.counting():
            thread = threading.Thread(target=lambda: (sys.setprofile(calls), unit("m")), name=name)
            thread.start()
            thread.join()
        return calls.total

    unit.cache_clear()
    assert entered("jobs-0") == 0
    unit.cache_clear()
    assert entered("AnyIO worker thread") > 0


def test_a_change_is_read_ordered_and_calculated_once(calls):
    counts = {code.co_qualname: count for code, count in calls.counts.items()}
    assert counts["build_graph"] == 1
    assert counts["calculate"] == 1
    assert counts["_key"] == 2  # in the server, and in the process that builds
    assert counts["PlainBearing.build"] == 1
