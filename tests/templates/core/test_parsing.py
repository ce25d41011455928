"""Syntax trees are right in several threads, and in a process forked in the meantime."""

import ast
import gc
import inspect
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from templates.core.language import syntax_trees


@pytest.fixture
def eager_switches() -> Iterator[None]:
    """Threads change and garbage is collected as often as Python allows."""
    interval, thresholds = sys.getswitchinterval(), gc.get_threshold()
    sys.setswitchinterval(1e-6)
    gc.set_threshold(10)
    yield
    sys.setswitchinterval(interval)
    gc.set_threshold(*thresholds)


class _Noisy:
    """Garbage whose end runs Python code, which is where another thread may take over."""

    def __init__(self) -> None:
        self.cycle = self

    def __del__(self) -> None:
        for _ in range(20):
            pass


@pytest.mark.slow
def test_threads_that_parse_at_once_all_get_their_tree(eager_switches):
    """Without the lock, four threads met the fault of CPython 3.11 in about one of 30 trees."""
    source = inspect.getsource(ast)
    faults: list[BaseException] = []

    def parse_often() -> None:
        for _ in range(8):
            for _ in range(50):
                _Noisy()
            try:
                syntax_trees.parse(source)
            except SystemError as fault:
                faults.append(fault)

    threads = [threading.Thread(target=parse_often) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert faults == []


def test_a_child_forked_while_another_thread_parses_does_not_wait():
    entered, leave = threading.Event(), threading.Event()

    def hold() -> None:
        with syntax_trees._ONE_AT_A_TIME:
            entered.set()
            leave.wait()

    holder = threading.Thread(target=hold)
    holder.start()
    entered.wait()
    child = os.fork()
    if child == 0:
        os._exit(0 if len(syntax_trees.parse("a = 1\nb = 2").body) == 2 else 1)
    leave.set()
    holder.join()
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_all_code_of_the_service_parses_under_the_lock():
    """A call of `ast.parse` or of `inspect.getsourcelines` elsewhere would run beside the lock."""
    root = Path(__file__).parents[3]
    elsewhere = [
        f"{path.relative_to(root)}: {name}"
        for folder in ("app", "cad", "templates")
        for path in sorted((root / folder).rglob("*.py"))
        for name in ("ast.parse(", "getsourcelines(")
        if name in path.read_text(encoding="utf-8") and path.name != "syntax_trees.py"
    ]
    assert elsewhere == []
