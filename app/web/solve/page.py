"""The page that solves a design: values of one parameter that give a wanted output, and the curve."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from fastapi import Request, Response

from app.calculations.schemas.evaluations import TracedCurve
from app.designs import questions
from app.designs.schemas.designs import Design
from app.designs.schemas.solution import DesignRoot, DesignSolution
from app.designs.solution import SolveDesignIn
from app.presentation import numbers
from app.presentation.criteria import UNKNOWN, WORDS
from app.presentation.input_text import value_of
from app.web.shared.answers import AnswerOrJob, stored
from app.web.shared.places import PlaceOption, outputs, related, suggested, times, varied
from app.web.shared.responses import go, show, units_of
from app.web.shared.services import PageServices
from app.web.solve.solution import PATIENCE, Drawing, Reply, ShownRoot, in_words, replied

FIELDS = ("unknown", "low", "high", "output", "value", "tolerance", "other", "other_value")
OPTIONAL = ("tolerance", "other", "other_value")


WIDER = 5.0
"""Factor by which a question searches farther to both sides, if its answer is out of reach."""


@dataclass(frozen=True)
class Wider:
    """Bounds farther apart, and the address of the page with these bounds."""

    low: str
    high: str
    query: str


@dataclass(frozen=True)
class SolveForm:
    """The texts of the form; empty where nothing was typed."""

    typed: Mapping[str, str]

    @classmethod
    def of(cls, request: Request) -> SolveForm:
        """Return the form, filled with the texts in the address."""
        return cls({name: request.query_params.get(name, "").strip()[:200] for name in FIELDS})

    @property
    def is_whole(self) -> bool:
        """Return whether the form has everything that an answer needs."""
        is_paired = bool(self.typed["other"]) == bool(self.typed["other_value"])
        return is_paired and all(self.typed[name] for name in FIELDS if name not in OPTIONAL)

    def body(self) -> dict[str, object]:
        """Return the form as a request body."""
        typed = self.typed
        body: dict[str, object] = {
            "unknown": typed["unknown"],
            "between": [value_of(typed["low"]), value_of(typed["high"])],
            "target": {typed["output"]: value_of(typed["value"])},
        }
        if typed["other"]:
            body["with"] = {typed["other"]: value_of(typed["other_value"])}
        return body | ({"tolerance": _number(typed["tolerance"])} if typed["tolerance"] else {})

    def wider(self) -> Wider | None:
        """Return the form with wider bounds, if its bounds can be multiplied."""
        low, high = times(self.typed["low"], 1 / WIDER), times(self.typed["high"], WIDER)
        query = urlencode({**self.typed, "low": low, "high": high})
        return Wider(low, high, query) if low and high else None

    def saved_beside(self) -> tuple[str, str] | None:
        """Return the design's field for the second replaced value, with that value; None if there is none."""
        return (_control(self.typed["other"]), self.typed["other_value"]) if self.typed["other"] else None


async def solve_page(request: Request, services: PageServices, id: str) -> Response:
    """Return the form, with the answer once the form is filled in."""
    design = await services.run(services.designs.show, id)
    network = await services.run(services.designs.network, id)
    places = varied(design, network)
    question, job = _with_bounds(SolveForm.of(request), places), request.query_params.get("job", "")
    reply = Reply[DesignSolution]()
    if question.is_whole:
        reply = await replied(
            stored(services, job, DesignSolution) if job else _solved(request, services, id, question)
        )
    if reply.job and not job:
        return go(f"?{urlencode({**question.typed, 'job': reply.job})}")
    solution = reply.answer
    return show(
        request,
        "solve/solve.html",
        design=design,
        places=places,
        related=related(design),
        outputs=outputs(network),
        asked=question,
        beside=question.saved_beside(),
        solution=solution,
        drawing=_drawing(solution) if solution else None,
        roots=_saved(design, solution) if solution else [],
        refusal=reply.refusal,
        wider=question.wider() if reply.is_out_of_reach else None,
        job=reply.job,
    )


async def _solved(
    request: Request, services: PageServices, id: str, question: SolveForm
) -> AnswerOrJob[DesignSolution]:
    """Return the solution, or the job that calculates it if it takes longer than the page waits."""
    body = services.read(SolveDesignIn, question.body())
    wanted = questions.DesignQuestion(
        id, body.model_dump_json(exclude_unset=True, by_alias=True), units=units_of(request)
    )
    answer, job = await services.calculate(PATIENCE, services.solving.answer, wanted, services.client)
    return AnswerOrJob(answer, job or "")


def _drawing(solution: DesignSolution) -> Drawing:
    """Return the drawing of an answer's curve with its solutions."""
    target = solution.target
    return Drawing(
        solution.unknown,
        target.name,
        target.value,
        solution.curve,
        solution.finer,
        [*solution.roots, *solution.touching],
        solution.jumps,
        _level(solution.curve, solution.levels, solution.finer_levels),
        [_level(curve, solution.finer_levels, solution.levels) for curve in solution.finer],
    )


def _level(curve: TracedCurve, levels: Mapping[str, str | None], others: Mapping[str, str | None]) -> str:
    """Return the level of a curve, and the steps whose levels differ from those of the other curve."""
    apart = {step: level for step, level in levels.items() if others and others.get(step) != level}
    if len(apart) < 2 and curve.level in apart.values():
        return in_words(curve.level)
    return ", ".join(f"{step} {in_words(level)}" for step, level in apart.items()) or in_words(curve.level)


def _with_bounds(asked: SolveForm, places: list[PlaceOption]) -> SolveForm:
    """Return the form; if a value was chosen without bounds, half and twice that value become the bounds."""
    chosen = next((place for place in places if place.name == asked.typed["unknown"]), None)
    if chosen is None or asked.typed["low"] or asked.typed["high"]:
        return asked
    low, high = suggested(chosen)
    return SolveForm({**asked.typed, "low": low, "high": high})


def _number(text: str) -> float | str:
    """Return a typed number; the interface reports a text that is not a number."""
    try:
        return float(text)
    except ValueError:
        return text


OPEN = ("not_met", "undecided")
COUNTED = {"met": "met", "not_checked": "not checked"}


def _words(root: DesignRoot, name: str) -> str:
    """Return the verdict on a criterion at a root in words, and whether its error is unknown."""
    words = WORDS[root.verdicts[name]]
    return f"{words}; {UNKNOWN}" if name in root.error_unknown else words


def _counted(root: DesignRoot) -> str:
    """Return the numbers of other criteria that are met, met with unknown error, and not checked."""
    counts = Counter[str](root.verdicts.values())
    unknown = sum(root.verdicts[name] == "met" for name in root.error_unknown)
    words = [f"{counts[word]} {words}" for word, words in COUNTED.items() if counts[word]]
    return ", ".join([*words, *([f"error unknown of {unknown} met"] if unknown else [])])


@dataclass(frozen=True)
class SavedRoot(ShownRoot):
    """A root of a design, and the field of the design's form that receives it."""

    open: list[tuple[str, str, str]]  # criteria that are not met or undecided, with verdict and its words
    rest: str  # how many are met, and not checked
    rounded: str  # the target with the chosen values; empty if nothing is rounded
    field: str
    note: str


def _control(name: str) -> str:
    """Return the field of the design's form for a name."""
    return name if "." in name else f".{name}"


def _saved(design: Design, solution: DesignSolution) -> list[SavedRoot]:
    """Return every solution with the data to save it as a revision."""
    control = _control(solution.unknown)
    target = f"{solution.target.name} = {numbers.plain(solution.target.value)} {solution.target.unit}"
    return [
        SavedRoot(
            **vars(ShownRoot.of(root)),
            open=sorted((n, v, _words(root, n)) for n, v in root.verdicts.items() if v in OPEN),
            rest=_counted(root),
            rounded=f"{numbers.in_line(root.rounded)} with the chosen values" if root.rounded else "",
            field=control,
            note=f"solved for {target}",
        )
        for root in (*solution.roots, *solution.touching)
    ]
