"""Texts like the request that froze the service: a careless parser backtracks on them.

Each is `(method, path, headers, body)`; `{design}` in a path stands for the id of some design. The tests send
them all and want an answer.
"""

from __future__ import annotations

import json
from urllib.parse import quote

from app.calculations.bodies import OIL_FILM

Request = tuple[str, str, dict[str, str], bytes]

API = "/api/v1"
FILM = f"{API}/templates/oil_film/versions/1"
LONG = 2**20  # a megabyte of something
JSON = {"Content-Type": "application/json"}
STEP = {"Content-Type": "model/step"}
CSV = {"Content-Type": "text/csv"}
FORM = {"Content-Type": "application/x-www-form-urlencoded"}
START = b"FILE_DESCRIPTION(("


def _step(body: bytes) -> Request:
    return "POST", f"{API}/verify", STEP, START + body


def _csv(body: str) -> Request:
    return "POST", f"{API}/curves", CSV, body.encode()


def _json(path: str, body: object, method: str = "POST", **headers: str) -> Request:
    return method, path, {**JSON, **headers}, json.dumps(body).encode()


def _input(value: object) -> Request:
    return _json(f"{FILM}/evaluate", {"inputs": {**OIL_FILM, "bearing_diameter": value}})


def _relation(*relations: object) -> Request:
    parameters = {f"p{i}": relation for i, relation in enumerate(relations)}
    return _json(f"{API}/designs", {"name": "x", "parameters": parameters})


def _form(**fields: str) -> Request:
    body = "&".join(f"{quote(name)}={quote(text)}" for name, text in fields.items())
    return "POST", "/designs/{design}", FORM, body.encode()


def _build(**body: object) -> Request:
    return _json(f"{API}/models/ball_bearing/versions/1/build", body)


def _query(path: str, **headers: str) -> Request:
    return "GET", path, headers, b""


STEP_FILES: dict[str, Request] = {
    "the reproducer": _step(b"''" * 40),
    "60 kB of quotes": _step(b"''" * 30_000),
    "60 kB of 'a' 'a' …": _step(b"'a' " * 15_000),
    "a megabyte of 'a', 'a', …": _step(b"'a', " * (LONG // 5)),
    "an odd number of quotes": _step(b"'" * 59_999),
    "nested lists": _step(b"(" * 30_000 + b"'a'" + b")" * 30_000),
    "comments that do not end": _step(b"/*" * 30_000),
    "a string that does not end": _step(b"'" + b"a" * LONG),
    "a megabyte of starts": _step(START * (LONG // len(START))),
    "\\X2\\ that does not end": _step(b"'" + b"\\X2\\" * 15_000 + b"')"),
    "a version of 60 000 digits": _step(b"'Crankwright a version " + b"9" * 60_000 + b"')"),
}
QUANTITIES: dict[str, Request] = {
    "a megabyte of digits": _input("9" * LONG + " mm"),
    "a megabyte of dots": _input("." * LONG),
    "a megabyte of signs": _input("-" * LONG + "1 mm"),
    "a megabyte of signs in a unit": _input("1 m" + "*m" * (LONG // 2)),
    "a megabyte of dots in a unit": _input({"value": 1, "unit": "." * LONG}),
    "a power tower": _input("1 m" + "**9" * 19),
    "blanks within 5000 quantities": _input(["1 " + " " * 190 + "mm"] * 5000 + ["x"]),
    "2000 unknown inputs": _json(
        f"{FILM}/evaluate", {"inputs": {f"bearing_diametre{i}": "1" for i in range(2000)}}
    ),
    "200 unknown outputs and units": _json(
        f"{FILM}/evaluate",
        {
            "inputs": OIL_FILM,
            "outputs": [f"minimum_film_thicknes{i}" for i in range(200)],
            "units": {f"minimum_film_thicknes{i}": "mm" for i in range(200)},
        },
    ),
}
RELATIONS: dict[str, Request] = {
    "a megabyte of signs, relation": _relation("= " + "-" * LONG + "1"),
    "a megabyte of dots, relation": _relation("= " + "." * LONG),
    "a megabyte of signs in 500 relations": _relation(*["= " + "-" * 1990 + "1"] * 500),
    "a megabyte of relations in a list": _relation([f"= {i} + {i}" for i in range(80_000)]),
    "signs up to the bound": _relation(*["= " + "-" * 1990 + "1"] * 20),
    "unknown names": _relation(*["= " + " + ".join(f"p_{i}" for i in range(95))] * 70),
    "a long array, often": _relation(
        {"value": [1.5] * 100_000, "unit": "mm"}, *["= p0" + " + p0" * 90] * 100
    ),
}
TABLES: dict[str, Request] = {
    "a megabyte of digits, cell": _csv("p [bar]\n" + "1" * LONG),
    "digits and a letter, 20 cells": _csv("p [bar]\n" + ("1" * 3990 + "x\n") * 20),
    "dots, 260 cells": _csv("p [bar]\n" + ("." * 3990 + "\n") * 260),
    "signs, 260 cells": _csv("p [bar]\n" + ("-" * 3990 + "\n") * 260),
    "a megabyte of quotes, cell": _csv("p [bar]\n" + '"' * LONG),
    "a megabyte of empty lines": _csv("\n" * LONG),
    "a header of brackets": _csv("[" * 4000 + "\n1\n"),
}
DOCUMENTS: dict[str, Request] = {
    "a megabyte of unknown files": _build(parameters={}, artifacts=[1] * (LONG // 3)),
    "40 000 unknown parameters": _build(parameters={f"inner_diametre{i}": 1 for i in range(40_000)}),
    "40 000 unknown fields": _json(f"{API}/designs", {"name": "x", **{f"k{i}": 1 for i in range(40_000)}}),
    "100 names used twice": _json(
        f"{API}/designs",
        {
            "name": "x",
            "parameters": {f"a{i}": "1" for i in range(100)},
            "steps": {f"a{i}": {"template": "oil_film"} for i in range(100)},
        },
    ),
    "a patch of 40 000 names": _json(
        f"{API}/designs/{{design}}",
        {"parameters": {f"k{i}": 1 for i in range(40_000)}},
        "PATCH",
        **{"If-Match": "*"},
    ),
    "a name of a megabyte": _json(f"{API}/designs", {"name": "x", "parameters": {"a" * LONG: "1"}}),
    "a load of a megabyte": _json(
        f"{API}/models/ball_bearing/versions/1/analyses/torsion", {"parameters": {}, "load": "." * LONG}
    ),
}
HEADERS: dict[str, Request] = {
    "a cursor of dots": _query(f"{API}/designs?cursor=" + "." * 30_000),
    "Prefer of waits": _query(f"{API}/designs/{{design}}/model", Prefer="wait=" * 8000),
    "Accept of commas": _query(f"{API}/designs/{{design}}/report", Accept="," * 50_000),
    "If-Match of quotes": ("PATCH", f"{API}/designs/{{design}}", {**JSON, "If-Match": '"' * 50_000}, b"{}"),
    "a cookie in quotes": ("POST", f"{API}/designs", {**JSON, "Cookie": 'a="' + "\\a" * 25_000 + '"'}, b"{}"),
    "a header of a megabyte": _query("/healthz", **{"X-Long": "a" * LONG}),
    "an address of 60 kB": _query("/templates/oil_film/1?" + "&".join(f"a{i}=1" for i in range(7000))),
    "1000 fields in an address": _query("/templates/oil_film/1?" + "&".join(f"a{i}=1" for i in range(1000))),
}
FORMS: dict[str, Request] = {
    "a megabyte of fields": ("POST", "/designs/{design}", FORM, b"a&" * (LONG // 2)),
    "19 000 fields": _form(revision="1", **{f".a{i}": "1" for i in range(19_000)}),
    "brackets in a field": _form(revision="1", **{".a": "[" * 50_000}),
    "brackets in what was": _form(revision="x", was="[" * 50_000),
    "NaN in a field": _form(revision="1", **{".a": "[NaN]"}),
}
EVERY: dict[str, Request] = {
    **STEP_FILES, **QUANTITIES, **RELATIONS, **TABLES, **DOCUMENTS, **HEADERS, **FORMS,
}  # fmt: skip
