"""A server caches few drafts, because every edit creates a class of a megabyte or more."""

from contextlib import nullcontext
from types import SimpleNamespace

from app.pool.sources import loaded
from app.worksheets import publication

TEXT = '# Draft {}\ngiven F [kN] "load" (example 1 kN)\np [kN] = 2 * F "double"'


def test_drafts_do_not_stay_among_the_loaded_templates(monkeypatch):
    rows = iter(SimpleNamespace(text=TEXT.format(n)) for n in range(3))
    monkeypatch.setattr(publication.repository, "version", lambda session, id, number: next(rows))
    server = SimpleNamespace(database=SimpleNamespace(read=nullcontext))
    before = loaded.cache_info().currsize
    drafts = {publication.WorksheetPublication.draft(server, "duty", 1) for _ in range(3)}
    assert len(drafts) == 3
    assert loaded.cache_info().currsize == before
