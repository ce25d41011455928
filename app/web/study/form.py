"""The form for a new study: varied values, method, and wanted results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf
from typing import NamedTuple

from fastapi import Request, Response
from pydantic import JsonValue

from app.designs.preview import PreviewRequest
from app.designs.routes.variants import variants_of
from app.designs.schemas.designs import Design, RevisionWorksheet
from app.designs.schemas.network import DesignNetwork, NetworkName
from app.designs.variants.names import BASE, natural
from app.presentation.criteria import limit_of, subject_of
from app.presentation.input_text import text_of, value_of
from app.reference import Reference
from app.schemas.criteria import Criterion
from app.studies.schemas import StudyEstimate
from app.web.shared.places import measured, outputs, present, set_aside, suggested, varied
from app.web.shared.responses import show
from app.web.shared.services import PageServices, Refused

LINES = 4
"""Number of places that the form can vary; the interface accepts more."""
METHODS = {
    "grid": "every combination of evenly spaced values (sweeps, contours)",
    "sample": "rows spread over all intervals (histograms, parallel coordinates)",
    "sensitivity": "how much each input affects each output",
    "optimise": "the best row that meets the criteria",
}
POINTS = "1024"
ON = "on"


@dataclass(frozen=True)
class StudyForm:
    """The texts of the form, and its faults."""

    fields: Mapping[str, str]
    faults: Mapping[str, str] = field(default_factory=dict)
    notice: str | None = None

    def text(self, name: str, default: str = "") -> str:
        """Return the text of a field."""
        return self.fields.get(name, default)

    def wrong(self, *names: str) -> list[str]:
        """Return the faults of the given members of a study, or of their parts."""
        heads = tuple(f"{name}." for name in names if name)
        return [detail for name, detail in self.faults.items() if name in names or name.startswith(heads)]

    def wrong_in(self, line: int) -> list[str]:
        """Return the faults of the varied value in one line of the form."""
        place = self.text(f"place.{line}")
        return self.wrong(place, f"vary.{place}") if place else self.wrong("vary") if line == 0 else []

    def is_on(self, name: str) -> bool:
        """Return whether a box is ticked."""
        return self.fields.get(name) == ON

    def ticked(self, group: str) -> list[str]:
        """Return the names of the ticked boxes in a group."""
        head = f"{group}."
        return [name.removeprefix(head) for name in self.fields if name.startswith(head) and self.is_on(name)]

    def body(self, design: str) -> dict[str, JsonValue]:
        """Return the study as a request body, without empty fields."""
        method = self.text("method", "grid")
        vary = self._vary()
        body: dict[str, JsonValue] = {"design": design, "method": method, "vary": vary}
        if variant := self.text("variant"):
            body["variant"] = variant
        if aside := [name for name in vary if name in self.ticked("related")]:
            body["set_aside"] = list[JsonValue](aside)
        body |= {group: list[JsonValue](names) for group in ("outputs",) if (names := self.ticked(group))}
        if self.is_on("choose_criteria"):
            body["hold"] = list[JsonValue](self.ticked("hold"))
        stages = ("explore", "confirm") if method == "optimise" else ("explore",)
        body |= {stage: {"tolerance": value} for stage in stages if (value := self._share(stage))}
        return body | self._of_method(method)

    def _vary(self) -> dict[str, JsonValue]:
        """Return the values of each varied quantity: a list, or two bounds."""
        vary: dict[str, JsonValue] = {}
        for line in range(LINES):
            place, values = self.text(f"place.{line}"), self.text(f"values.{line}").strip()
            ends: list[JsonValue] = [value_of(self.text(f"{end}.{line}")) for end in ("low", "high")]
            if place and values:
                vary[place] = {"values": [value_of(text) for text in values.split(";")]}
            elif place:
                vary[place] = {"between": ends}
        return vary

    def _of_method(self, method: str) -> dict[str, JsonValue]:
        match method:
            case "grid":
                chosen = {self.text(f"place.{n}"): self.text(f"steps.{n}") for n in range(LINES)}
                steps: dict[str, JsonValue] = {p: _whole(text) for p, text in chosen.items() if p and text}
                return {"steps": steps}
            case "sample":
                return {
                    "points": _whole(self.text("points", POINTS)),
                    "sequence": self.text("sequence", "sobol"),
                }
            case "sensitivity":
                points: JsonValue = _whole(self.text("points", POINTS))
                kind = self.text("kind", "local")
                return {"kind": kind} if kind == "local" else {"kind": kind, "points": points}
            case "optimise":
                goals = {goal: self._goals(goal) for goal in ("minimise", "maximise")}
                wanted: dict[str, JsonValue] = {goal: names for goal, names in goals.items() if names}
                return wanted | ({"build": build} if (build := self.text("build")) else {})
        return {}

    def with_bounds(self, bounds: Mapping[str, tuple[str, str]]) -> StudyForm:
        """Return the form; a quantity without bounds gets half and twice its present value as bounds."""
        filled = dict(self.fields)
        for line in range(LINES):
            ends = (f"low.{line}", f"high.{line}")
            if not any(self.text(name).strip() for name in (*ends, f"values.{line}")):
                place = bounds.get(self.text(f"place.{line}"), ("", ""))
                filled |= {end: text for end, text in zip(ends, place, strict=True) if text}
        return replace(self, fields=filled)

    def _goals(self, goal: str) -> list[JsonValue]:
        return [
            name for n in range(2) if self.text(f"goal.{n}") == goal and (name := self.text(f"objective.{n}"))
        ]

    def _share(self, name: str) -> JsonValue:
        """Return a tolerance typed in per cent as a fraction; other texts are unchanged."""
        text = self.text(name).strip().removesuffix("%").strip()
        try:
            return float(text) / 100 if text else None
        except ValueError:
            return text


def _whole(text: str) -> JsonValue:
    """Return a text as a whole number; other texts are passed on, so that the interface reports them."""
    return int(text) if text.isascii() and text.strip().isdecimal() and len(text) < 12 else text


async def study_form(
    request: Request,
    services: PageServices,
    id: str,
    typed: StudyForm,
    status: int = 200,
    estimate: StudyEstimate | None = None,
) -> Response:
    """Return the form with the typed values, and the estimated cost if requested."""
    design = await services.run(services.designs.show, id)
    governing = await _governing(services, design)
    network = await services.run(services.designs.network, id)
    revision = await services.calculate(None, services.reports.worksheet, id, design.revision, "si")
    preview = (
        await services.calculate(
            inf, services.previews.in_parts, PreviewRequest(id, {}, False, "si"), services.client
        )
    )[0]
    places, named = varied(design, network), [*outputs(network), *measured(network)]
    aside = set_aside(design, network, places, present(revision, preview))
    judged = _judged(revision, named)
    bounds = {place.name: suggested(place) for place in (*places, *aside)}
    return show(
        request,
        "study/new_study.html",
        status=status,
        design=design,
        governing=governing,
        variants=sorted(design.variants, key=natural),
        differs={place: text_of(value) for place, value in design.variants.get(governing, {}).items()},
        places=places,
        aside=aside,
        bounds=bounds,
        outputs=named,
        judged=judged,
        listed_first=judged | _main_results(revision, network),
        grouped=_by_step(named),
        criteria=[Demand.of(one) for one in revision.criteria or ()],
        methods=METHODS,
        lines=range(LINES),
        typed=typed.with_bounds(bounds),
        estimate=estimate,
    )


async def _governing(services: PageServices, design: Design) -> str:
    """Return the governing variant of a design, which a study of the design itself does not calculate.

    The result is empty if the design itself governs.
    """
    if not design.variants:
        return ""
    worst = (
        await services.run(variants_of, design.id, None, services.database, services.catalogues)
    ).governing
    return worst.variant if worst and worst.variant != BASE else ""


class Demand(NamedTuple):
    """A criterion that a row must meet, in words."""

    name: str
    subject: str
    limit: str
    require: str
    has_limit: bool

    @classmethod
    def of(cls, one: Criterion) -> Demand:
        """Return a criterion of the design."""
        subject, limit = subject_of(one.name, one.require), limit_of(one.require)
        return cls(one.name, subject, limit, one.require, has_limit(one))


def has_limit(criterion: Criterion) -> bool:
    """Return whether a criterion is checked against a number, given by the user or in its rule."""
    return criterion.verdict != "not_checked" and criterion.limit is not None


def _main_results(revision: RevisionWorksheet, network: DesignNetwork) -> set[str]:
    """Return the outputs in the table of results that are single numbers; the form lists them first.

    They are not ticked, because an output may need a more expensive level than the judged ones.
    """
    outputs = {
        f"{step}.{name}": output.value
        for step, result in revision.steps.items()
        for name, output in result.outputs.items()
    }
    return {name for name in network.table if isinstance(outputs.get(name), float | int)}


def _judged(revision: RevisionWorksheet, named: list[NetworkName]) -> set[str]:
    """Return the outputs that criteria with limits judge; a study stores them by default."""
    limited = filter(has_limit, revision.criteria or ())
    words = {word for one in limited for word in _words(one.name, one.require)}
    return {name.name for name in named if name.name in words}


def _by_step(named: list[NetworkName]) -> dict[str, list[NetworkName]]:
    """Return outputs and measures by step and model, in the order of the design."""
    groups: dict[str, list[NetworkName]] = {}
    for name in named:
        groups.setdefault(Reference.parse(name.name).block, []).append(name)
    return groups


def _words(criterion: str, require: str) -> set[str]:
    """Return the names that a criterion uses, prefixed with the step if it belongs to a template."""
    name = Reference.parse(criterion)
    bare = require.replace(">=", " ").replace("<=", " ").split()
    return {f"{name.block}.{word}" if name.output else word for word in bare}


def again(typed: Mapping[str, str], refused: Refused) -> StudyForm:
    """Return a form with the same texts, and the faults for which they were refused."""
    return StudyForm(typed, refused.faults, None if refused.faults else refused.problem.detail)
