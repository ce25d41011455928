"""The page that solves a design: which value of one parameter gives a wanted output, with the curve."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import quote, urlencode

import httpx
from fastapi import Request, Response

from app.presentation import numbers
from app.presentation.typed import value_of
from app.reports.charts import Chart, Series, svg
from app.schemas.answers import Accepted
from app.schemas.designs import Design
from app.schemas.networks import DesignNetwork
from app.schemas.solve import DesignRoot, DesignSolution
from app.web.api import Api, Refused, read
from app.web.places import PlaceOption, outputs, related, suggested, varied
from app.web.rendering import go, show, units_of

FIELDS = ("unknown", "low", "high", "output", "value", "tolerance", "other", "other_value")
OPTIONAL = ("tolerance", "other", "other_value")
PATIENT = {"Prefer": "wait=5"}  # the page shows how a longer calculation goes on
ANSWERED, ACCEPTED = 422, 202
"""Status of a question that is wrong; the page shows why beside the form."""


@dataclass(frozen=True)
class Asked:
    """What stands in the form; empty where nothing was typed."""

    typed: Mapping[str, str]

    @classmethod
    def of(cls, request: Request) -> Asked:
        """The question in the address."""
        return cls({name: request.query_params.get(name, "").strip()[:200] for name in FIELDS})

    @property
    def is_whole(self) -> bool:
        """Whether everything is given that an answer needs."""
        is_paired = bool(self.typed["other"]) == bool(self.typed["other_value"])
        return is_paired and all(self.typed[name] for name in FIELDS if name not in OPTIONAL)

    def body(self) -> dict[str, object]:
        """The question as the interface takes it."""
        typed = self.typed
        body: dict[str, object] = {
            "unknown": typed["unknown"],
            "between": [value_of(typed["low"]), value_of(typed["high"])],
            "target": {typed["output"]: value_of(typed["value"])},
        }
        if typed["other"]:
            body["with"] = {typed["other"]: value_of(typed["other_value"])}
        return body | ({"tolerance": _number(typed["tolerance"])} if typed["tolerance"] else {})

    def saved_beside(self) -> tuple[str, str] | None:
        """The field of the design's form that takes the other value, and what it takes."""
        return (_control(self.typed["other"]), self.typed["other_value"]) if self.typed["other"] else None


async def solve_page(request: Request, api: Api, id: str) -> Response:
    """The form, and the answer once the form is filled in."""
    design = await api.get(f"/designs/{id}", Design)
    network = await api.get(f"/designs/{id}/network", DesignNetwork)
    places = varied(design, network)
    asked, job = _with_bounds(Asked.of(request), places), request.query_params.get("job", "")
    solution, refusal = None, None
    if asked.is_whole:
        try:
            response = await _answer(request, api, id, asked, job)
        except Refused as refused:
            if refused.status != ANSWERED:
                raise
            refusal = refused
        else:
            if response.status_code == ACCEPTED and not job:
                return go(
                    f"?{urlencode({**asked.typed, 'job': read(response, Accepted).job.rpartition('/')[2]})}"
                )
            solution = None if response.status_code == ACCEPTED else read(response, DesignSolution)
    return show(
        request,
        "solve.html",
        design=design,
        places=places,
        related=related(design),
        outputs=outputs(network),
        asked=asked,
        beside=asked.saved_beside(),
        solution=solution,
        chart=drawn(solution) if solution else "",
        roots=_saved(design, solution) if solution else [],
        refusal=refusal,
        job=job if asked.is_whole and not solution and not refusal else "",
    )


async def _answer(request: Request, api: Api, id: str, asked: Asked, job: str) -> httpx.Response:
    """The solution, or that its job still goes on."""
    if job:
        return await api.send("GET", f"/evaluations/{quote(job, safe='')}")
    query = {"units": units_of(request)}
    return await api.send("POST", f"/designs/{id}/solve", json=asked.body(), params=query, headers=PATIENT)


def drawn(solution: DesignSolution) -> str:
    """The curve between the bounds with the value that is wanted, and the roots, as SVG."""
    curve, target = solution.curve, solution.target
    x = [float(value) for value in curve.x.value]
    y = [None if value is None else float(value) for value in _list(curve.y.value)]
    found = [*solution.roots, *solution.touching]
    wanted, words = target.value, target.name.rpartition(".")[2].replace("_", " ")
    series = [
        Series(words, x, y),
        Series("wanted", [x[0], x[-1]], [wanted, wanted], dashed=True),
        Series("solutions", [root.value for root in found], [wanted] * len(found), marked=True, joined=False),
    ]
    axis = f"{solution.unknown} [{numbers.unit(curve.x.unit)}]", f"{words} [{numbers.unit(target.unit)}]"
    return svg(Chart(*axis, series))


def _list(value: object) -> list[float | None]:
    assert isinstance(value, list)
    return value


def _with_bounds(asked: Asked, places: list[PlaceOption]) -> Asked:
    """Half and twice the present value as bounds, where a value was chosen and no bound is given."""
    chosen = next((place for place in places if place.name == asked.typed["unknown"]), None)
    if chosen is None or asked.typed["low"] or asked.typed["high"]:
        return asked
    low, high = suggested(chosen)
    return Asked({**asked.typed, "low": low, "high": high})


def _number(text: str) -> float | str:
    """A number as typed; the interface says what is wrong with a text that is none."""
    try:
        return float(text)
    except ValueError:
        return text


OPEN = ("not_met", "undecided")
COUNTED = {"met": "met", "not_checked": "not checked"}


def _counted(root: DesignRoot) -> str:
    """How many of the other criteria are met, and how many not checked."""
    counts = Counter[str](root.verdicts.values())
    return ", ".join(f"{counts[word]} {words}" for word, words in COUNTED.items() if counts[word])


@dataclass(frozen=True)
class SavedRoot:
    """A solution as the page lists it, and the field of the design's form that takes it."""

    text: str
    shown: str
    rises: str
    level: str
    error: str
    open: list[tuple[str, str]]  # criteria that are not met or undecided
    rest: str  # how many are met, and not checked
    field: str
    note: str


def _control(name: str) -> str:
    """The field of the design's form for a place."""
    return name if "." in name else f".{name}"


def _saved(design: Design, solution: DesignSolution) -> list[SavedRoot]:
    """Every solution, with what saves it as a revision; none of several is preferred."""
    control = _control(solution.unknown)
    target = f"{solution.target.name} = {numbers.plain(solution.target.value)} {solution.target.unit}"
    return [
        SavedRoot(
            text=f"{root.value!r} {root.unit}" if root.unit != "1" else repr(root.value),
            shown=numbers.told(root),
            rises={1: "rises", -1: "falls", 0: "touches"}[root.slope],
            level=(root.level or "").replace("_", " ") + ("" if root.confirmed else " (not confirmed)"),
            error="not stated" if root.error is None else f"± {numbers.percent(root.error)}",
            open=sorted((n, v) for n, v in root.verdicts.items() if v in OPEN),
            rest=_counted(root),
            field=control,
            note=f"solved for {target}",
        )
        for root in (*solution.roots, *solution.touching)
    ]
