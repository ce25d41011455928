"""Quick and slow tests: one thread for numerical libraries, deadlines, and shared workers."""

import gc
import os
import sys
import time

from app.workers.threads import use_one_thread

use_one_thread()  # before NumPy is imported, here and in the servers that tests start
if sys.dont_write_bytecode:  # what is compiled is kept, here and in all processes that tests start:
    sys.dont_write_bytecode = False  # to compile takes seconds
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

gc.disable()  # until all tests are collected: what is made meanwhile lives as long as this process

import forked  # noqa: E402
import pytest  # noqa: E402
from components import cluster, object_store, own_postgres, postgres, s3  # noqa: E402, F401 - for all folders
from hypothesis import settings  # noqa: E402
from lanes import (  # noqa: E402
    group_of,
    left_out,
    name_group,
    rank,
    require_distinct,
    require_equal_everywhere,
)
from one_analysis import share_one_analysis  # noqa: E402
from patience import BUDGET, FACTOR, SLOW_TEST, TEST  # noqa: E402
from seeds import CHOSEN, SEED, examples  # noqa: E402

from app.workers import processes  # noqa: E402

share_one_analysis()  # before the routes of the program are imported

# No timed assertions, and the same examples in every run, unless a seed is chosen.
settings.register_profile(
    "lanes", deadline=None, derandomize=CHOSEN is None, print_blob=True, max_examples=examples(100)
)
settings.load_profile("lanes")

if FACTOR != 1:
    os.environ.setdefault("PYTEST_TIMEOUT", str(TEST))  # prevails over pyproject.toml


@pytest.hookimpl(tryfirst=True)  # before Hypothesis reads its option
def pytest_configure(config):
    if CHOSEN is not None and config.getoption("--hypothesis-seed") is None:
        config.option.hypothesis_seed = str(SEED)


def pytest_ignore_collect(collection_path, config):
    """Leave out files of the slow lane in the quick one: their import makes up thousands of requests."""
    is_quick = config.getoption("markexpr") == "not slow"
    return True if is_quick and collection_path.name.endswith("_at_length.py") else None


def pytest_report_header(config):
    seed = "the usual" if CHOSEN is None else f"CRANKWRIGHT_TEST_SEED={SEED}"
    return f"lanes: seed {seed}, patience {FACTOR:g}"


BEGIN = time.monotonic()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    if BUDGET and item.get_closest_marker("slow") and time.monotonic() - BEGIN > BUDGET:
        pytest.skip(f"the {BUDGET:g} s for slow tests are over; .ci/nightly runs it")


@pytest.hookimpl(tryfirst=True)  # before pytest-xdist reads the groups
def pytest_collection_modifyitems(config, items):
    for item in left_out(items):
        item.add_marker(pytest.mark.slow)
    for item in items:
        item.add_marker(pytest.mark.xdist_group(group_of(item)))
        if getattr(config.option, "loadgroup", False):  # in a worker
            name_group(item)
        if item.get_closest_marker("slow") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(SLOW_TEST))
    if getattr(config.option, "loadgroup", False):
        require_distinct(items)
        require_equal_everywhere(items)
    items.sort(key=lambda item: rank(group_of(item)))


def pytest_collection_finish(session):
    """Keep modules and tests out of collections: there are a million objects, and each walks through all."""
    gc.freeze()
    gc.enable()


@pytest.fixture
def real_fork_servers(monkeypatch):
    """Fork servers are processes that import by themselves, as those of the program are."""
    monkeypatch.setattr(processes, "launch", forked.LAUNCH)


@pytest.fixture(scope="session", autouse=True)
def forked_forkservers():
    """Fork servers of servers in this process need no seconds to begin: they are forked themselves."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(processes, "launch", forked.launch_forkserver)
        yield
