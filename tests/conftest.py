"""The lanes of the tests: one thread for numerical libraries, deadlines, and who shares a worker."""

import os

from app.workers.threads import use_one_thread

use_one_thread()  # before NumPy is imported, here and in the servers that tests start

import pytest  # noqa: E402
from lanes import group_of, rank  # noqa: E402
from patience import FACTOR, SLOW_TEST, TEST  # noqa: E402

if FACTOR != 1:
    os.environ.setdefault("PYTEST_TIMEOUT", str(TEST))  # prevails over pyproject.toml


@pytest.hookimpl(tryfirst=True)  # before pytest-xdist reads the groups
def pytest_collection_modifyitems(items):
    for item in items:
        item.add_marker(pytest.mark.xdist_group(group_of(item)))
        if item.get_closest_marker("slow") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(SLOW_TEST))
    items.sort(key=lambda item: rank(group_of(item)))
