"""Forms for analyses of models and for iterations, and the changes that they request."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from pydantic import JsonValue

from app.designs.schemas.designs import Design, DesignIteration
from app.presentation.input_text import text_of, value_of
from app.solids.schemas.models import Analysable
from app.web.shared.blocks import ModelBlock, Refusal
from app.web.shared.forms import option_of

Change = Mapping[str, JsonValue]
"""A merge patch of a design."""
_OF_ANALYSIS = ("boundary", "level", "tolerance", "load")
_OF_ITERATION = ("through", "start", "tolerance", "limit")
_NUMBERS = {"tolerance", "limit"}


@dataclass(frozen=True)
class AnalysisLine:
    """One analysis of a model; without a name, the empty line for a new one. `texts` are by field."""

    model: str
    kinds: Mapping[str, Analysable]
    name: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)
    errors: Mapping[str, str] = field(default_factory=dict)
    is_refused: bool = False

    @property
    def levels(self) -> list[str]:
        """Return the levels of the analysis's kind."""
        return list(dict.fromkeys(level for kind in self.kinds.values() for level in kind.levels))

    @property
    def boundaries(self) -> list[str]:
        """Return the supports that the loaded end may have."""
        return list(dict.fromkeys(name for kind in self.kinds.values() for name in kind.boundaries))


@dataclass(frozen=True)
class IterationLine:
    """One iteration; without a place, the empty line for a new one. `texts` are by field."""

    place: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)
    errors: Mapping[str, str] = field(default_factory=dict)
    is_refused: bool = False


Line = TypeVar("Line", AnalysisLine, IterationLine)


def errors_of(part: Mapping[str, str], faults: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    """Return the faults of a refused form by field, each with its name and detail."""
    match part.get("declare") or part.get("add"):
        case "analysis":
            fields, begins = _OF_ANALYSIS, f"models.{part.get('model', '')}.analyses.{part.get('kind', '')}."
        case "iteration":
            fields, begins = _OF_ITERATION, "iterations"
        case "parameter":
            name = part.get("name", "").strip()
            return {"value": (name, faults[name])} if name in faults else {}
        case _:
            return {}
    errors: dict[str, tuple[str, str]] = {}
    for name, detail in faults.items():
        if name.startswith(begins):
            named = (one for one in fields if one in name.removeprefix(begins).split("."))
            if at := next(named, "through" if begins == name else None):
                errors.setdefault(at, (name, detail))
    return errors


def _refused(line: Line, refusal: Refusal) -> Line:
    """Return the line with its entries and their faults, if its form was refused."""
    part = refusal.part
    if isinstance(line, AnalysisLine):
        is_its = part.get("declare") == "analysis" and part.get("model") == line.model
        is_its = is_its and line.name == ("" if part.get("new") else part.get("kind"))
    else:
        is_its = part.get("declare") == "iteration" and part.get("place", "") == line.place
    if not is_its or part.get("drop"):
        return line
    errors = {name: detail for name, (_, detail) in errors_of(part, refusal.faults).items()}
    return replace(line, texts={**line.texts, **part}, errors=errors, is_refused=True)


def analysis_lines(design: Design, models: Sequence[ModelBlock], refusal: Refusal) -> list[AnalysisLine]:
    """Return the analyses of every model that can be analysed, each model followed by an empty line."""
    lines: list[AnalysisLine] = []
    for block in models:
        if kinds := block.model.analyses:
            for name, options in design.models[block.name].analyses.items():
                chosen = {"boundary": options.boundary, "level": options.level}
                chosen |= {"tolerance": text_of(options.tolerance), "load": text_of(options.load)}
                texts = {key: text or "" for key, text in chosen.items()}
                lines.append(AnalysisLine(block.name, kinds, name, texts))
            lines.append(AnalysisLine(block.name, kinds, texts=dict.fromkeys(_OF_ANALYSIS, "")))
    return [_refused(line, refusal) for line in lines]


def iteration_lines(design: Design, refusal: Refusal) -> list[IterationLine]:
    """Return the iterations, followed by an empty line."""
    lines = [IterationLine(str(place), _texts(one)) for place, one in enumerate(design.iterations)]
    lines.append(IterationLine(texts=dict.fromkeys(_OF_ITERATION, "")))
    return [_refused(line, refusal) for line in lines]


def _texts(iteration: DesignIteration) -> dict[str, str]:
    whole = iteration.model_dump()
    return {name: str(whole[name]) if name in _NUMBERS else text_of(whole[name]) for name in whole}


def measures(design: Design, models: Sequence[ModelBlock]) -> Iterator[str]:
    """Yield the names that an iteration may use: measures of solids, and outputs of their analyses."""
    for block in models:
        yield from (f"{block.name}.{measure}" for measure in block.model.measures)
        for name, options in design.models[block.name].analyses.items():
            kind = block.model.analyses.get(options.kind or name)
            outputs = [one for one in kind.outputs if one not in kind.tables] if kind else []
            yield from (f"{block.name}.{name}.{output}" for output in outputs if output != "surface")


def change_of(design: Design, typed: Mapping[str, str]) -> Change | None:
    """Return the merge patch for a form of this module; None for any other form."""
    match typed.get("declare", ""):
        case "analysis":
            name = typed.get("kind", "").strip()  # an analysis is named after its kind
            options = None if typed.get("drop") else _analysis(typed)
            return {"models": {typed.get("model", ""): {"analyses": {name: options}}}}
        case "iteration":
            return {"iterations": _iterations(design, typed)}
    return None


def _analysis(typed: Mapping[str, str]) -> dict[str, JsonValue]:
    """Return the options of an analysis; an option that the user emptied is null, which removes it."""
    return {
        name: _value(name, typed.get(name, ""))
        for name in _OF_ANALYSIS
        if name != "boundary" or typed.get(name)
    }


def _iterations(design: Design, typed: Mapping[str, str]) -> list[JsonValue]:
    """Return all iterations after one was added, changed or removed."""
    given = {name: _value(name, typed[name]) for name in _OF_ITERATION if typed.get(name, "").strip()}
    whole: list[JsonValue] = [one.model_dump(mode="json") for one in design.iterations]
    place = typed.get("place", "")
    at = next((n for n in range(len(whole)) if str(n) == place), len(whole))
    return [*whole[:at], *([] if typed.get("drop") else [given]), *whole[at + 1 :]]


def _value(name: str, text: str) -> JsonValue:
    """Return the value of a field; None if it is empty."""
    if not text.strip():
        return None
    if name == "limit" and text.strip().isdecimal() and len(text) < 10:
        return int(text)
    return option_of(name, value_of(text))
