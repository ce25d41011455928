"""The tool that answers a requirement with a part: the values that meet it, or what conflicts."""

from __future__ import annotations

from collections.abc import Iterator

from app.agents.arguments import Answer
from app.agents.calls import Call
from app.agents.replies import Item, Number, Reply, limited, of_value
from app.answers.schemas import ChosenValue, DesignAnswer, RequirementVerdict
from app.client.exchange import calculated, post

VERDICTS = {
    "confirmed": "confirmed",
    "unconfirmed": "met (error unknown)",
    "undecided": "undecided",
    "infeasible": "not met",
    "not_settled": "undecided (the levels disagree)",
}
"""The verdict on the chosen values, by the state of the answer."""


async def answer(call: Call, given: Answer) -> Reply:
    """Return the values of free places that meet requirements; save nothing."""
    body = given.model_dump(mode="json", by_alias=True, exclude_unset=True)
    solution = await call.service.run(calculated(DesignAnswer, post("/answer", body)))
    return Reply(
        summary=f"{solution.state}: {solution.sentence}",
        numbers=[*_chosen(solution), *_objective(solution), *map(_requirement, solution.requirements)],
        items=[*_conflict(solution), *(Item(name="warning", text=one.detail) for one in solution.warnings)],
        rest=call.rest(solution),
    )


def _chosen(solution: DesignAnswer) -> Iterator[Number]:
    verdict = VERDICTS[solution.state]
    for place, one in solution.values.items():
        source = (
            f"chosen{f', {one.fit}' if one.fit else ''}{f', at {one.at_bound} bound' if one.at_bound else ''}"
        )
        yield of_value(place, one.value.value, one.value.unit, 0.0, source, verdict)


def _objective(solution: DesignAnswer) -> Iterator[Number]:
    if (one := solution.objective) is not None:
        source = f"{one.sense}; optimum {solution.optimum}"
        yield of_value(one.name, one.value.value, one.value.unit, one.error, source, "no limit")


def _requirement(one: RequirementVerdict) -> Number:
    value, unit = (one.value.value, one.value.unit) if one.value else (None, None)
    word = "confirmed" if one.confirmed else one.verdict.replace("_", " ")
    notes = [] if one.confirmed or one.verdict != "met" else ["error unknown"]
    verdict = limited(word, one.limit, notes)
    return of_value(one.require, value, unit, one.error, "requirement", verdict)


def _conflict(solution: DesignAnswer) -> Iterator[Item]:
    """Yield what conflicts, the best reachable values, and the smallest relaxation."""
    if (one := solution.conflict) is None:
        return
    written = {requirement.name: requirement.require for requirement in solution.requirements}
    yield Item(name="conflict", text="; ".join(written.get(name, name) for name in one.requirements))
    for best in one.reachable:
        text = f"{written.get(best.name, best.name)}: best {best.best.value:.6g} {best.best.unit}"
        yield Item(name="reachable", text=text)
    if one.relaxation is not None:
        limits = (
            f"{written.get(name, name)} -> {limit.value:.6g} {limit.unit}"
            for name, limit in one.relaxation.limits.items()
        )
        places = (f"{place} {_text(value)}" for place, value in one.relaxation.at.items())
        yield Item(name="relaxation", text=f"{'; '.join(limits)} at {'; '.join(places)}")


def _text(one: ChosenValue) -> str:
    return f"{one.value.value} {one.value.unit or ''}".strip()
