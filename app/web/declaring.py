"""Analyses of a design's models and its iterations: lines of their forms, and the change that a form asks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from pydantic import JsonValue

from app.presentation.typed import text_of, value_of
from app.schemas.designs import Design, DesignIteration
from app.schemas.solids import Analysable
from app.web.blocks import ModelBlock
from app.web.forms import option_of

Change = Mapping[str, JsonValue]
"""A merge patch of a design."""
_OF_ANALYSIS = ("boundary", "level", "tolerance", "load")
_OF_ITERATION = ("through", "start", "tolerance", "limit")
_NUMBERS = {"tolerance", "limit"}


@dataclass(frozen=True)
class AnalysisLine:
    """One analysis of a model; without a name, the empty line that adds one. `texts` are by field."""

    model: str
    kinds: Mapping[str, Analysable]
    name: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)

    @property
    def levels(self) -> list[str]:
        """The levels of its kinds."""
        return list(dict.fromkeys(level for kind in self.kinds.values() for level in kind.levels))

    @property
    def boundaries(self) -> list[str]:
        """How the loaded end may be held."""
        return list(dict.fromkeys(name for kind in self.kinds.values() for name in kind.boundaries))


@dataclass(frozen=True)
class IterationLine:
    """One iteration; without a place, the empty line that adds one. `texts` are by field."""

    place: str = ""
    texts: Mapping[str, str] = field(default_factory=dict)


def analysis_lines(design: Design, models: Sequence[ModelBlock]) -> list[AnalysisLine]:
    """The analyses of every model that can be analysed, each followed by an empty line."""
    lines = []
    for block in models:
        if kinds := block.model.analyses:
            for name, options in design.models[block.name].analyses.items():
                chosen = {"boundary": options.boundary, "level": options.level}
                chosen |= {"tolerance": text_of(options.tolerance), "load": text_of(options.load)}
                texts = {key: text or "" for key, text in chosen.items()}
                lines.append(AnalysisLine(block.name, kinds, name, texts))
            lines.append(AnalysisLine(block.name, kinds, texts=dict.fromkeys(_OF_ANALYSIS, "")))
    return lines


def iteration_lines(design: Design) -> list[IterationLine]:
    """The iterations, then an empty line."""
    lines = [IterationLine(str(place), _texts(one)) for place, one in enumerate(design.iterations)]
    return [*lines, IterationLine(texts=dict.fromkeys(_OF_ITERATION, ""))]


def _texts(iteration: DesignIteration) -> dict[str, str]:
    whole = iteration.model_dump()
    return {name: str(whole[name]) if name in _NUMBERS else text_of(whole[name]) for name in whole}


def measures(design: Design, models: Sequence[ModelBlock]) -> Iterator[str]:
    """What an iteration may run through: the measures of solids, and the outputs of their analyses."""
    for block in models:
        yield from (f"{block.name}.{measure}" for measure in block.model.measures)
        for name, options in design.models[block.name].analyses.items():
            kind = block.model.analyses.get(options.kind or name)
            outputs = kind.outputs if kind else {}
            yield from (f"{block.name}.{name}.{output}" for output in outputs if output != "surface")


def change_of(design: Design, typed: Mapping[str, str]) -> Change | None:
    """The merge patch that a form of this page asks for; None for another form."""
    match typed.get("declare", ""):
        case "analysis":
            name = typed.get("kind", "").strip()  # an analysis is called by its kind
            options = None if typed.get("drop") else _analysis(typed)
            return {"models": {typed.get("model", ""): {"analyses": {name: options}}}}
        case "iteration":
            return {"iterations": _iterations(design, typed)}
    return None


def _analysis(typed: Mapping[str, str]) -> dict[str, JsonValue]:
    """The options of an analysis; null removes those that were emptied."""
    return {
        name: _value(name, typed.get(name, ""))
        for name in _OF_ANALYSIS
        if name != "boundary" or typed.get(name)
    }


def _iterations(design: Design, typed: Mapping[str, str]) -> list[JsonValue]:
    """All iterations, with one added, changed or removed."""
    given = {name: _value(name, typed[name]) for name in _OF_ITERATION if typed.get(name, "").strip()}
    whole: list[JsonValue] = [one.model_dump(mode="json") for one in design.iterations]
    place = typed.get("place", "")
    at = next((n for n in range(len(whole)) if str(n) == place), len(whole))
    return [*whole[:at], *([] if typed.get("drop") else [given]), *whole[at + 1 :]]


def _value(name: str, text: str) -> JsonValue:
    """What a field means; nothing where it is empty."""
    if not text.strip():
        return None
    if name == "limit" and text.strip().isdecimal() and len(text) < 10:
        return int(text)
    return option_of(name, value_of(text))
