"""The server has priority over calculating processes: short slices, one session, own groups."""

import os
import threading

import pytest
import victims

from app.workers.pool import WarmProcesses
from app.workers.priority import answer_promptly, share_fairly


def in_a_thread(function):
    """Return the result of a function in a thread of its own, whose slice ends with it."""
    returned = []
    thread = threading.Thread(target=lambda: returned.append(function()))
    thread.start()
    thread.join()
    return returned[0]


def prompt():
    answer_promptly()
    return victims.slice_of_thread()


needs_slices = pytest.mark.skipif(in_a_thread(prompt) != 100_000, reason="Linux takes slices since 6.12")


def standing_beside_a_prompt_server():
    answer_promptly()
    worker = WarmProcesses(())
    try:
        return worker.run(victims.standing)
    finally:
        worker.close()


@needs_slices
def test_threads_inherit_the_slice_and_may_give_it_back():
    def started_by_a_prompt_thread():
        answer_promptly()
        return in_a_thread(victims.slice_of_thread)

    def undone():
        answer_promptly()
        share_fairly()
        return victims.slice_of_thread()

    usual = victims.slice_of_thread()
    assert in_a_thread(started_by_a_prompt_thread) == 100_000
    assert in_a_thread(undone) == usual > 100_000


@needs_slices
def test_processes_do_not_inherit_it():
    assert in_a_thread(standing_beside_a_prompt_server)[2] == victims.slice_of_thread()


@pytest.mark.usefixtures("real_fork_servers")
def test_processes_are_of_the_session_but_not_of_the_group():
    session, group, _ = in_a_thread(standing_beside_a_prompt_server)
    assert session == os.getsid(0)
    assert group != os.getpgid(0)
