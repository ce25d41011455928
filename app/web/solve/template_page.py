"""The page that solves a template: values of one input that give a wanted output, and the curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

import numpy as np
from fastapi import Request, Response
from pydantic import JsonValue

from app.calculations.bodies import SolveIn
from app.calculations.schemas.evaluations import Solution
from app.catalogue.routes.templates import show_template
from app.catalogue.schemas.declarations import DeclaredValue, properties
from app.catalogue.schemas.templates import Template
from app.pool.cost import solving_seconds
from app.presentation.input_text import text_of, value_of
from app.web.shared.answers import AnswerOrJob, TemplateQuestion, calculated, stored
from app.web.shared.places import PlaceOption, suggested
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices
from app.web.solve.solution import PATIENCE, Drawing, Reply, ShownRoot, in_words, replied
from app.web.template.routes import inputs_of, typed_in
from templates.core.language import template as language
from templates.core.units.quantity import read_any, read_beside
from templates.core.units.units import unit

FIELDS = ("unknown", "low", "high", "output", "value")
MARK = "?"  # prefix of these fields in the address; no input name has it
JOB = f"{MARK}job"


@dataclass(frozen=True)
class Question:
    """The texts of the form, and the inputs taken over from the template's page."""

    typed: Mapping[str, str]  # by field
    inputs: Mapping[str, str]  # inputs and options, by control of the template's form; empty: the example

    @classmethod
    def of(cls, request: Request) -> Question:
        """Return the form, filled with the texts in the address."""
        query = typed_in(request)
        inputs = {name: text for name, text in query.items() if not name.startswith(MARK)}
        return cls({name: query.get(f"{MARK}{name}", "").strip()[:200] for name in FIELDS}, inputs)

    @property
    def is_whole(self) -> bool:
        """Return whether the form has everything that an answer needs."""
        return all(self.typed.values())

    def body(self, template: Template) -> dict[str, object]:
        """Return the form as a request body."""
        typed, (inputs, options) = self.typed, self._given(template)
        return {
            "inputs": {name: value for name, value in inputs.items() if name != typed["unknown"]},
            "unknown": typed["unknown"],
            "between": [value_of(typed["low"]), value_of(typed["high"])],
            "target": {typed["output"]: value_of(typed["value"])},
            "outputs": [typed["output"]],
            **options,
        }

    def present(self, template: Template) -> dict[str, str]:
        """Return the present values of the inputs as texts."""
        return {name: text_of(value) for name, value in self._given(template)[0].items()}

    def _given(self, template: Template) -> tuple[dict[str, JsonValue], dict[str, JsonValue]]:
        inputs, options, _ = inputs_of(template, self.inputs)
        return inputs, options

    def with_bounds(self, places: list[PlaceOption]) -> Question:
        """Return the form; an input chosen without bounds gets half and twice its value as bounds."""
        chosen = next((place for place in places if place.name == self.typed["unknown"]), None)
        if chosen is None or self.typed["low"] or self.typed["high"]:
            return self
        low, high = suggested(chosen)
        return Question({**self.typed, "low": low, "high": high}, self.inputs)

    def address(self, **more: str) -> str:
        """Return the query of this page for the same request."""
        marked = {f"{MARK}{name}": text for name, text in self.typed.items()}
        return urlencode({**self.inputs, **marked, **more})

    def tried_with(self, template: Template, value: str) -> str:
        """Return the query of the template's page with a given value of the unknown."""
        inputs = self.inputs or self.present(template)
        return urlencode({**inputs, self.typed["unknown"]: value})


async def template_solve_page(request: Request, services: PageServices, id: str, version: int) -> Response:
    """Return the form, with the answer once the form is filled in."""
    template = await services.run(show_template, id, version, services.catalogues)
    question, job = Question.of(request), request.query_params.get(JOB, "")
    places = list(_varied(template, question.present(template)))
    question = question.with_bounds(places)
    reply = Reply[Solution]()
    if question.is_whole:
        reply = await replied(
            stored(services, job, Solution) if job else _solved(services, template, question)
        )
    if reply.job and not job:
        return go(f"?{question.address(**{JOB: reply.job})}")
    solution = reply.answer.in_units(units_of(request)) if reply.answer else None
    drawing = _drawing(question, solution) if solution else None
    return show(
        request,
        "solve/template_solve.html",
        template=template,
        question=question,
        places=places,
        outputs=list(_outputs(template)),
        inputs=urlencode(question.inputs),
        solution=solution,
        drawing=drawing,
        roots=[ShownRoot.of(root) for root in drawing.roots] if drawing else [],
        refusal=reply.refusal,
        job=reply.job,
    )


async def _solved(services: PageServices, template: Template, question: Question) -> AnswerOrJob[Solution]:
    """Return the solution, or the job that calculates it if it takes longer than the page waits."""
    body = services.read(SolveIn, question.body(template))
    asked = TemplateQuestion(template.id, template.version, "solve", body)
    return await calculated(services, asked, _seconds, Solution, PATIENCE)


def _seconds(cls: type[language.Template], body: SolveIn) -> float:
    """Return the estimated time of a solution [s]."""
    return solving_seconds(cls, body.inputs, body.level, body.tolerance, body.outputs, body.target)


def _varied(template: Template, present: Mapping[str, str]) -> Iterator[PlaceOption]:
    """Yield the inputs that have a single quantity."""
    for name, declared in properties(template.inputs).items():
        if _is_single(declared):
            yield PlaceOption(name, declared.title, declared.unit or "", present.get(name, ""))


def _outputs(template: Template) -> Iterator[PlaceOption]:
    """Yield the outputs that are a single quantity."""
    for name, declared in properties(template.outputs).items():
        if _is_single(declared):
            yield PlaceOption(name, declared.title, declared.unit or "")


def _is_single(declared: DeclaredValue) -> bool:
    return declared.unit is not None and not declared.along and not declared.is_list


def _drawing(question: Question, solution: Solution) -> Drawing:
    """Return the drawing of an answer's curve with its solutions."""
    curve = solution.curve
    scale, raw = unit(curve.y.unit or "1"), value_of(question.typed["value"])
    typed = read_beside(raw, scale.text) if scale.difference else read_any(raw)
    wanted = float(np.asarray(scale.from_si(typed.si)))
    roots = [*solution.roots, *solution.touching]
    return Drawing(
        question.typed["unknown"],
        question.typed["output"],
        wanted,
        curve,
        solution.finer,
        roots,
        solution.jumps,
        in_words(curve.level),
        [in_words(one.level) for one in solution.finer],
    )
