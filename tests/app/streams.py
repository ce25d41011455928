"""Streams of events as a client reads them, with the numbers for resuming."""

import json
from contextlib import closing

import httpx
from serving import PATIENCE


def messages(url, path, last=None):
    """The messages of a stream, without comments: (id, name, data)."""
    headers = {} if last is None else {"Last-Event-ID": str(last)}
    with httpx.stream("GET", f"{url}{path}", timeout=PATIENCE, trust_env=False, headers=headers) as stream:
        assert stream.status_code == 200, stream.read()
        fields = {}
        for line in stream.iter_lines():
            name, _, value = line.partition(":")
            if name:
                fields[name] = value.strip()
            elif "data" in fields:
                yield fields.get("id"), fields["event"], json.loads(fields["data"])
                fields = {}


def first(count, *about):
    """The first messages of a stream."""
    with closing(messages(*about)) as stream:
        return [next(stream) for _ in range(count)]


def short(received):
    """Ids, names and revisions."""
    return [(id, name, data["revision"]) for id, name, data in received]
