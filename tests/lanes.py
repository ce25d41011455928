"""Groups of tests that share a worker: those of one file, and those of one server, which starts once.

`--dist loadgroup` gives a group to whichever worker is free, in the order of collection. The groups that take
longest come first, so that both workers end at about the same time. The order is of measured processor times;
a wrong order costs some balance and nothing else.
"""

import re
from collections import Counter, defaultdict

import pytest

SERVED = "served"  # every test that needs the server of tests/app/conftest.py
TEAM = "team"  # every test that needs PostgreSQL, an S3 server or Dask, of which one worker has each
PAGES = "pages"  # every test that needs the server or the browser of tests/app/web/conftest.py

MODELS = "models"  # the files that go through every model, whose example and files are made once

TOGETHER = {
    "tests/test_lanes.py": "tests/test_mutation.py",  # both read the imports of all our files
    "tests/cad/test_cad_catalogue_properties.py": MODELS,
    "tests/cad/test_dxf.py": MODELS,
    "tests/cad/test_export.py": MODELS,
    "tests/cad/test_iso_drawing.py": MODELS,
    "tests/cad/test_meshes.py": MODELS,
    "tests/cad/test_pmi.py": MODELS,
    "tests/cad/test_step.py": MODELS,
}
"""Files that share a worker with others."""

SET = re.compile(r"\{'[^':{}]*'(?:, '[^':{}]*')+\}")

LONGEST = (PAGES, SERVED, TEAM, MODELS, "tests/templates/test_catalogue_properties.py")
"""Groups that begin first, the longest in front."""


def group_of(item):
    """The group of a test: its server's, else its file."""
    file = item.path.relative_to(item.config.rootpath).as_posix()
    if file.startswith("tests/app/web/"):
        return PAGES
    if file.startswith("tests/team/"):
        return TEAM
    if file.startswith("tests/app/") and "served" in item.fixturenames:
        return SERVED
    return TOGETHER.get(file, file)


def name_group(item):
    """Append the group to the id of a test, where the scheduler of pytest-xdist reads it.

    pytest-xdist 3.8 writes it to an attribute that pytest 9.2 no longer reads, so that every test would be a
    group of its own and every fixture of a module be set up on both workers (pytest-xdist issue 1386). Older
    versions of pytest have no `_id`.

    Schemathesis puts the operation into the name of a test alone. Without it in the id the scheduler takes
    the tests of all operations for one, and runs only the first.
    """
    if hasattr(item, "_id"):
        operation = "" if item.nodeid.endswith(item.name) else item.name.removeprefix(item.originalname)
        item._id = type(item._id).parse(f"{item.nodeid}{operation}@{group_of(item)}")


def require_distinct(items):
    """Refuse tests of one id: pytest-xdist would run the first of them and omit the others."""
    shared = [id for id, count in Counter(item.nodeid for item in items).items() if count > 1]
    if shared:
        raise pytest.UsageError(f"{len(shared)} ids belong to several tests: {', '.join(shared[:3])}")


def require_equal_everywhere(items):
    """Refuse ids with the text of a set: each worker writes it in its own order, and then none begins."""
    if named := [item.nodeid for item in items if SET.search(item.nodeid)]:
        raise pytest.UsageError(f"{len(named)} ids have the text of a set: {', '.join(named[:3])}")


def left_out(items):
    """The cases of `sampled` tests that belong to the slow lane: all but as many as the marker says."""
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("sampled") and not item.get_closest_marker("slow"):
            cases[item.path, item.parent.name, item.originalname].append(item)
    return [item for each in cases.values() for item in unsampled(each)]


def unsampled(cases):
    """The cases of one test that are slow; the quick ones, with the first, are spread evenly over all."""
    (count,) = cases[0].get_closest_marker("sampled").args
    quick = {len(cases) * number // count for number in range(count)}
    return [case for number, case in enumerate(cases) if number not in quick]


def rank(group):
    """The place of a group in the order."""
    return LONGEST.index(group) if group in LONGEST else len(LONGEST)
