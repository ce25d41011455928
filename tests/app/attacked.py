"""A service with an object of every kind, and its attackers: for `test_attack.py`."""

import re
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

import httpx
from approving import Room, signed
from patience import patient, until
from serving import API, created
from sheets import fresh
from study_helpers import done

from app.identity.principal import INCLUDED
from app.identity.service import Changes

ROLES = {
    "nobody": None, "revoked": None, "expired": None, "disabled": None, "bare": frozenset(),
    "scoped": INCLUDED["viewer"], **INCLUDED,
}  # fmt: skip
"""Who attacks, and with which roles; None: without a valid key. `scoped` is a checker's key for viewing."""
WAIT = {"Prefer": f"wait={patient(20):.0f}"}
BINARY = {"Content-Type": "application/octet-stream"}
BUILD = {"parameters": {"size": "23 mm"}, "artifacts": ["step", "glb"]}
BAR = {"parameters": {"diameter": "26 mm", "length": "41 mm"}, "level": "coarse", "outputs": ["surface"]}
VARY = {"length": {"between": ["1 mm", "3 mm"]}}
GRID = {"method": "grid", "vary": VARY, "steps": 3, "outputs": ["double.twice_the_length"]}
KINDS = {"report": "html", "model": "step", "worksheet": "json", "field": "glb"}


def document(**changes):
    """A design with something for every route: a tolerance, a criterion, a solid, variants."""
    return {
        "name": "attacked",
        "parameters": {"length": "2 ± 0.1 mm", "size": "12 mm"},
        "steps": {"double": {"template": "double", "version": 1, "inputs": {"length": "= length"}}},
        "models": {"block": {"id": "moody", "version": 1, "parameters": {"size": "= size"}}},
        "criteria": {"long": {"require": "double.twice_the_length >= 3 mm"}},
        "variants": {"small": {"size": "11 mm"}, "large": {"size": "13 mm"}},
        **changes,
    }


@dataclass
class Scene:
    """A service; HTTP, principals and keys by who attacks; names of objects by what stands before them."""

    team: object
    sheet: bytes  # of Mathcad
    http: dict = field(default_factory=dict)
    principals: dict = field(default_factory=dict)
    ids: dict = field(default_factory=dict)

    @classmethod
    @contextmanager
    def of(cls, team, sheet):
        scene = cls(team, sheet)
        with ExitStack() as stack:
            for name, (principal, key) in everybody(team).items():
                scene.principals[name] = principal
                scene.http[name] = stack.enter_context(speaking(team, key))
            scene.ids.update(objects(scene))
            yield scene

    @property
    def author(self):
        return self.http["author"]

    @property
    def services(self):
        return self.team.server.app.state.services

    def path(self, path, **names):
        """A path with the names of objects: those that are given, else those of this scene."""

        def named(place):
            before, name = place[1], place[2].partition(":")[0]
            if name == "kind" and before.endswith("."):
                return before + KINDS[before.strip("/.") or "field"]
            if name == "id":
                return before + names.get(name, self.ids[before.strip("/")])
            return before + names.get(name, self.ids.get(before.strip("/"), self.ids.get(name, "")))

        return re.sub(r"([^/]*[./])\{([^}]+)\}", named, path)


def speaking(team, key):
    headers = {} if key is None else {"Authorization": f"Bearer {key}"}
    return httpx.Client(base_url=team.server.url, timeout=90, trust_env=False, headers=headers)


def everybody(team):
    """Principal and key of whoever attacks, and of an author to whom the objects do not belong."""
    identity, admin, checker = team.identity, team.principals["admin"], team.principals["checker"]
    moment = datetime.now(UTC)
    gone, bare = identity.add(f"gone {moment}", ["admin"]).id, identity.add(f"bare {moment}", []).id
    principals = {
        "revoked": (admin, identity.add_key(admin)[0]),
        "expired": (admin, identity.add_key(admin, expires=moment - timedelta(seconds=1))[0]),
        "disabled": (gone, identity.add_key(gone)[0]),
        "bare": (bare, identity.add_key(bare)[0]),
        "scoped": (checker, identity.add_key(checker, scopes=["viewer"])[0]),
    }
    identity.revoke(principals["revoked"][1].prefix)
    identity.change(gone, Changes(disabled=True))
    usual = {name: (team.principals[name], team.keys[name]) for name in (*INCLUDED, "author2")}
    return {"nobody": (None, None), **{who: (id, key.text) for who, (id, key) in principals.items()}, **usual}


def objects(scene):
    """One object of every kind, which the author has made."""
    author = scene.author
    design = created(author, document())
    place = f"{API}/designs/{design['id']}"
    comment = author.post(f"{place}/revisions/1/comments", json={"text": "why?"}).json()
    built = author.post(f"{API}/models/moody/versions/1/build", json=BUILD, headers=WAIT).json()
    analysed = author.post(f"{API}/models/bar/versions/1/analyses/torsion", json=BAR, headers=WAIT).json()
    job = author.post(f"{place}/tolerance", json={}, headers={"Prefer": "respond-async"}).headers["location"]
    until(lambda: author.get(job).json()["state"] == "done")
    with Room.of(scene.team) as room:
        signed(room, design)
    return {
        "designs": design["id"], "templates": "double", "models": "block", "worksheets": imported(scene),
        "studies": done(author, design, **GRID)["id"], "jobs": job.rpartition("/")[2],
        "evaluations": job.rpartition("/")[2], "builds": built["build"], "analyses": analysed["id"],
        "artifacts": built["artifacts"]["step"], "principals": scene.principals["author"],
        "comments": comment["id"], "keys": scene.team.keys["author"][3:13],
        "library": "surface_finish", "problems": "not-found", "explain": "block.size",
        "versions": "1", "revisions": "1", "variants": "small", "fields": "life",
    }  # fmt: skip


def imported(scene):
    """The id of a worksheet that was imported."""
    query = {"id": fresh("attacked"), "file": "x.mcdx"}
    path = f"{API}/worksheets/import"
    job = scene.author.post(path, params=query, content=scene.sheet, headers=BINARY).headers["location"]
    until(lambda: scene.author.get(job).json()["state"] == "done")
    return query["id"]
