"""The way of a change, once 2 568 function calls long, takes at most half as many."""

from pathlib import Path

import pytest

from benchmarks.function_calls import counted

ROOT = Path(__file__).resolve().parents[2]
AIM = 2568 // 2


@pytest.fixture(scope="module")
def calls():
    return counted(ROOT)


def test_a_changed_width_takes_half_the_calls_that_it_took(calls):
    assert set(calls.by_package(ROOT)) == {"app", "cad", "templates"}
    names = {code.co_qualname for code in calls.counts}
    assert {"Designs.change", "Regeneration.__call__", "PlainBearing.build", "check_dimensions"} <= names
    most = ", ".join(f"{code.co_qualname} {count}" for code, count in calls.counts.most_common(10))
    assert calls.total <= AIM, most


def test_a_change_is_read_ordered_and_calculated_once(calls):
    counts = {code.co_qualname: count for code, count in calls.counts.items()}
    assert counts["build_graph"] == 1
    assert counts["calculate"] == 1
    assert counts["_key"] == 2  # in the server, and in the process that builds
    assert counts["PlainBearing.build"] == 1
