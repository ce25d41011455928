"""Principals for tests of approval, and their actions."""

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import httpx
from serving import API


@dataclass
class Room:
    """HTTP of everybody who works on a design; there are two checkers, `checker` and `releaser`."""

    viewer: httpx.Client
    author: httpx.Client
    author2: httpx.Client
    checker: httpx.Client
    releaser: httpx.Client
    admin: httpx.Client

    @classmethod
    @contextmanager
    def of(cls, team):
        if "releaser" not in team.keys:
            row = team.identity.add("releaser", ["checker"])
            team.principals["releaser"] = row.id
            team.keys["releaser"] = team.identity.add_key(row.id, "test")[0].text
        with ExitStack() as stack:
            yield cls(**{name: stack.enter_context(team.http(name)) for name in cls.__annotations__})


def signing(http, design, step, number=1, **more):
    """Take a step, having looked at what there is to sign."""
    place = f"{API}/designs/{design['id']}/revisions/{number}/approvals"
    seen = http.get(place)
    headers = {"If-Match": seen.headers["etag"]}
    if seen.json()["unconfirmed"] and step in ("checked", "released"):
        more = {"acknowledged": "tried on the test bench", **more}
    answer = http.post(place, json={"step": step, **more}, headers=headers)
    assert answer.status_code == 201, answer.text
    return answer.json()


def signed(room, design, number=1):
    """Release a revision; what the last step answered."""
    signing(room.author, design, "calculated", number)
    signing(room.checker, design, "checked", number)
    return signing(room.releaser, design, "released", number)
