"""A change enters few files of `app`, and is read, ordered and calculated once."""

from pathlib import Path

import pytest

from benchmarks.files_entered import Files, change_to_step, changed_step
from benchmarks.function_calls import counted

ROOT = Path(__file__).resolve().parents[2]
MOST_FILES = 44  # of app, without HTTP, queue and the kernel's process; the aim was 50
MOST_WITH_HTTP = 45  # of app, for a change of one closed-form step


@pytest.fixture(scope="module")
def calls():
    return counted(ROOT)


def test_a_changed_width_enters_few_files(calls):
    assert set(calls.by_package(ROOT)) == {"app", "cad", "templates"}
    names = {code.co_qualname for code in calls.counts}
    assert {"Designs.change", "Regeneration.__call__", "PlainBearing.build", "check_dimensions"} <= names
    files = Files(calls, ROOT)
    assert files.app <= MOST_FILES, files.by_package["app"]


@pytest.mark.parametrize(("change", "most"), [(change_to_step, MOST_FILES), (changed_step, MOST_WITH_HTTP)])
def test_a_change_of_the_paper_s_design_enters_few_files(change, most):
    files = change(ROOT)
    assert {"app/designs/service.py", "app/designs/engine/calculate.py"} <= set(files.by_package["app"])
    assert files.app <= most, files.by_package["app"]


def test_a_change_is_read_ordered_and_calculated_once(calls):
    counts = {code.co_qualname: count for code, count in calls.counts.items()}
    assert counts["build_graph"] == 1
    assert counts["calculate"] == 1
    assert counts["_key"] == 2  # in the server, and in the process that builds
    assert counts["PlainBearing.build"] == 1
