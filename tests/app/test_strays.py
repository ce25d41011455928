"""Tasks of a scheduler that no machine works on, by its answers."""

from app.workers.remote.strays import Strays

TIME = 1000.0  # of the first look [s]


def test_a_task_on_a_machine_is_never_lost():
    strays = Strays()
    for state in ("processing", "memory", "erred"):
        strays.note({"task": state}, TIME)
        strays.note({"task": state}, TIME + 1e6)
        assert strays.why("task") is None
    assert strays.why("another") is None


def test_a_task_without_a_machine_is_lost_at_once():
    strays = Strays()
    strays.note({"here": "processing", "gone": "no-worker"}, TIME)
    assert strays.why("here") is None
    assert strays.why("gone") == "the machine that should run it has gone"


def test_a_task_has_time_to_come_to_the_scheduler():
    strays = Strays()
    strays.note({"task": None}, TIME)
    strays.note({"task": None}, TIME + 119)
    assert strays.why("task") is None
    strays.note({"task": None}, TIME + 121)
    assert strays.why("task") == "the scheduler does not have it"


def test_the_time_begins_again_once_a_task_was_on_a_machine():
    strays = Strays()
    strays.note({"task": None}, TIME)
    strays.note({"task": "processing"}, TIME + 100)
    strays.note({"task": None}, TIME + 200)
    assert strays.why("task") is None
    strays.note({"task": None}, TIME + 321)
    assert strays.why("task") is not None


def test_what_has_ended_is_forgotten():
    strays = Strays()
    strays.note({"task": "no-worker"}, TIME)
    strays.note({}, TIME + 1)
    assert strays.why("task") is None
