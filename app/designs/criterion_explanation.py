"""Explain a criterion's verdict: verdict ← value ← formula ← inputs, and limit ← its source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from app.calculations.json_values import criterion as rendered
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import Verdicts
from app.designs.network import Subject
from app.designs.parameter_explanation import Explainer, explain, full_name, model_parameters, shown
from app.plain import JsonObject
from app.reference import Reference
from app.storage.errors import NotFound
from templates.core.criteria.criterion import Limit
from templates.core.units.relation import Relation

PREFIX = "criteria."  # before the name of a criterion that has the name of a parameter of the only model


def explain_any(document: Document, calculation: Calculation, name: str) -> JsonObject:
    """Return the explanation of a model parameter, or of a criterion's verdict.

    Raises
    ------
    NotFound
        If there is no such name.
    """
    parameters, criteria = model_parameters(calculation), list(Verdicts(calculation).names())
    if (parameter := full_name(calculation, name)) in parameters:
        return explain(calculation, parameter)
    if name.removeprefix(PREFIX) in criteria:
        return explain_criterion(document, calculation, name)
    detail = f"nothing that can be explained is called {name[:80]!r}"
    raise NotFound(f"{detail}; {_explainable(parameters, criteria)}")


def _explainable(parameters: Sequence[str], criteria: Sequence[str]) -> str:
    """Return a sentence that lists the names in a design that can be explained."""
    kinds = {"parameters of models": parameters, "verdicts of criteria": criteria}
    there = [f"{kind} ({', '.join(names)})" for kind, names in kinds.items() if names]
    if not there:
        return f"{' and '.join(kinds)} can be explained, and this design has neither models nor criteria"
    return f"there are {' and '.join(there)}"


def explain_criterion(document: Document, calculation: Calculation, name: str) -> JsonObject:
    """Return the explanation of a verdict, with the values on both sides traced as far as possible.

    If the step does not compute a required output, the criterion was not judged, and the answer has no
    `criterion`.
    """
    verdicts = Verdicts(calculation)
    name = name.removeprefix(PREFIX)
    judgement = next(iter(verdicts.some([name])), None)
    sides = _Sides(document, calculation, verdicts.subject(name))
    judged = {} if judgement is None else {"criterion": rendered(judgement)}
    return {"name": name, "kind": "criterion", **judged, "because": list(sides.all())}


class _Sides:
    """Explain the value side and the limit side of one criterion."""

    def __init__(self, document: Document, calculation: Calculation, subject: Subject) -> None:
        self.document, self.subject = document, subject
        self.explainer = Explainer(calculation, depth=1)

    def all(self) -> Iterator[JsonObject]:
        """Yield the explanation of every name on the value side, then on the limit side.

        A side without names is explained as a whole.
        """
        criterion = self.subject.criterion
        for link in self._side(criterion.value):
            yield {**link, "side": "value"}
        for link in self._side(criterion.limit):
            yield {**link, "side": "limit"}

    def _side(self, relation: Relation) -> Iterator[JsonObject]:
        for name in (n for n in self.subject.criterion.names if n in relation.names):
            yield self._link(name)
        if not relation.names:
            source = self.subject.criterion.source
            yield {"name": relation.text, "kind": "written", **({"source": source} if source else {})}

    def _link(self, name: str) -> JsonObject:
        """Return the explanation of a name: the values on which it depends, or the user who typed it."""
        if name in self.subject.references:
            return self.explainer.of(self.subject.references[name])
        return self._limit(self.subject.criterion.limits_by_name[name])

    def _limit(self, limit: Limit) -> JsonObject:
        """Return the origin of a limit that the calculation itself does not use.

        The origin is the step, a library row, a default, or empty.
        """
        block = self.subject.block
        assert block is not None, "a criterion of the design declares no limits"
        typed = self.document.steps[block.name].limits
        named: JsonObject = {"name": f"{block.name}.limits.{limit.name}"}
        if limit.name in block.limits:
            given = block.limits[limit.name]
            named["value"] = shown(given.value, limit.unit)
            if limit.name in typed:
                return {**named, "kind": "given", "typed": typed[limit.name]}
            row = {"library": limit.library, "typed": typed.get(limit.library or "")}
            return {**named, "kind": "library_row", **row, "source": given.source}
        if limit.default is None:
            return {**named, "kind": "not_given", "text": limit.remedy}
        function, other = limit.default
        because = [self.explainer.of(Reference(block.name, None, other))]
        return {**named, "kind": "default", "text": f"{function}({other})", "because": because}
