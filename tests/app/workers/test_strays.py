"""Scheduler tasks on which no machine works, recognised by the scheduler's answers."""

import pytest

from app.workers.errors import WorkerLost
from app.workers.remote.strays import NeverBegun, Strays

TIME = 1000.0  # of the first look [s]


def test_a_task_on_a_machine_is_never_lost():
    strays = Strays()
    for state in ("processing", "memory", "erred"):
        strays.note({"task": state}, TIME)
        strays.note({"task": state}, TIME + 1e6)
        strays.check("task")
    strays.check("another")


def test_a_task_without_a_machine_never_begins():
    strays = Strays()
    strays.note({"here": "processing", "gone": "no-worker"}, TIME)
    strays.check("here")
    with pytest.raises(NeverBegun):
        strays.check("gone")


def test_a_task_has_time_to_come_to_the_scheduler():
    strays = Strays()
    strays.note({"task": None}, TIME)
    strays.note({"task": None}, TIME + 119)
    strays.check("task")
    strays.note({"task": None}, TIME + 121)
    with pytest.raises(WorkerLost, match="the scheduler does not know the task"):
        strays.check("task")


def test_the_time_begins_again_once_a_task_was_on_a_machine():
    strays = Strays()
    strays.note({"task": None}, TIME)
    strays.note({"task": "processing"}, TIME + 100)
    strays.note({"task": None}, TIME + 200)
    strays.check("task")
    strays.note({"task": None}, TIME + 321)
    with pytest.raises(WorkerLost):
        strays.check("task")


def test_what_has_ended_is_forgotten():
    strays = Strays()
    strays.note({"task": "no-worker"}, TIME)
    strays.note({}, TIME + 1)
    strays.check("task")
