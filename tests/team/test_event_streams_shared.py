"""Streams of two servers on one PostgreSQL: both send every change, and a client may switch servers."""

from contextlib import closing

import httpx
import pytest
from serving import API, PATIENCE, created, patched, serving
from streams import first, messages, short

from app.settings import Settings

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills

pytest.importorskip("psycopg", reason="the driver of PostgreSQL is not installed")
DESIGN = {"name": "x", "parameters": {"a": "1"}}


@pytest.fixture(scope="module")
def both(postgres, tmp_path_factory):
    """The addresses of two servers."""
    folder = tmp_path_factory.mktemp("servers")
    store = (folder / "store").as_uri()
    one, other = (
        Settings(data=folder / name, database_url=postgres, artifacts_url=store) for name in ("one", "other")
    )
    with serving(one) as first_one, serving(other) as second:
        yield first_one.url, second.url


def asking(url):
    return httpx.Client(base_url=url, timeout=PATIENCE, trust_env=False)


def test_a_change_at_one_server_is_heard_at_the_other(both):
    here, there = both
    with asking(here) as http:
        design = created(http, DESIGN)
        path = f"{API}/designs/{design['id']}/events"
        with closing(messages(there, path)) as stream:
            assert short([next(stream)]) == [("2", "current", 1)]
            for value in "23":
                design = patched(http, design, {"parameters": {"a": value}})
            heard = short(next(stream) for _ in range(4))
    assert heard == [("3", "revision", 2), ("4", "current", 2), ("5", "revision", 3), ("6", "current", 3)]


def test_a_client_goes_on_at_the_other_server(both):
    here, there = both
    with asking(here) as http, asking(there) as other:
        design = created(http, DESIGN)
        path = f"{API}/designs/{design['id']}/events"
        ((last, *_),) = first(1, here, path)
        design = patched(http, design, {"parameters": {"a": "2"}})
        patched(other, design, {"parameters": {"a": "3"}})
        for url in both:
            assert [id for id, *_ in first(4, url, path, last)] == ["3", "4", "5", "6"]
