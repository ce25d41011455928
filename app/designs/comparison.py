"""List all differences between two stored revisions of one design or of two; nothing is recalculated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs import repository
from app.designs.compared_results import compared_results
from app.designs.differences import differing, differing_texts, leaves
from app.designs.document import WORKSHEET
from app.designs.schemas.comparison import Comparison, Side, VerdictChange, VerdictOf
from app.plain import Json, JsonObject
from app.presentation import numbers
from app.solids import measures, rows
from app.storage.tables import RevisionRow

T = TypeVar("T")


@dataclass(frozen=True)
class Pair:
    """The two revisions to compare; `rows` chooses a revision if its number is not given."""

    design: str
    revision: int | None
    other: str | None  # the id of the second design; None for the same design
    number: int | None  # of the second revision

    def rows(self, session: Session) -> tuple[RevisionRow, RevisionRow]:
        """Return the older and the newer revision.

        If the numbers are missing, these are the last two revisions of one design, or the newest revision of
        each of two designs.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        """
        other = self.other or self.design
        newest = repository.design(session, other).head
        number = self.number or newest
        first = repository.design(session, self.design).head
        before = max(1, number - 1) if other == self.design else first
        old = repository.revision(session, self.design, self.revision or before)
        return old, repository.revision(session, other, number)


def compare(session: Session, pair: Pair, catalogues: Catalogues) -> Comparison:
    """Return the differences between the two revisions.

    Raises
    ------
    NotFound
        If there is no such design or revision.
    """
    old, new = pair.rows(session)
    one, other = _Parts.of(session, old), _Parts.of(session, new)
    return Comparison(
        old=_side(old),
        new=_side(new),
        table=compared_results(session, old, new, catalogues),
        parameters=differing_texts(one.parameters, other.parameters),
        versions=differing_texts(one.versions, other.versions),
        relations=differing_texts(one.relations, other.relations),
        inputs=differing(one.inputs, other.inputs),
        outputs=differing(one.outputs, other.outputs),
        criteria=_verdicts(one.criteria, other.criteria),
        model_parameters=differing(one.model_parameters, other.model_parameters),
        measurements=differing(one.measurements, other.measurements),
    )


@dataclass(frozen=True)
class _Parts:
    """The comparable values and texts of a revision, by dotted names."""

    parameters: dict[str, str]
    versions: dict[str, str]
    relations: dict[str, str]
    inputs: dict[str, Json]
    outputs: dict[str, Json]
    criteria: dict[str, VerdictOf]
    model_parameters: dict[str, Json]
    measurements: dict[str, Json]

    @classmethod
    def of(cls, session: Session, row: RevisionRow) -> _Parts:
        results: JsonObject = row.results or {}
        calculated: dict[str, JsonObject] = results.get("steps", {})
        steps = {name: {**typed, **calculated.get(name, {})} for name, typed in row.document["steps"].items()}
        models = {model.name: model for model in row.models}
        return cls(
            parameters={name: numbers.in_line(raw) for name, raw in _typed(row.document).items()},
            versions={**_versions(row.document["steps"], calculated), **_model_versions(row)},
            relations={
                **_named({name: _texts(step.get("relations", {})) for name, step in steps.items()}),
                **_named({name: _texts(model.relations) for name, model in models.items()}),
                **({WORKSHEET: lines} if (lines := row.document.get(WORKSHEET)) else {}),
            },
            inputs=_named({name: step["inputs"] for name, step in steps.items()}),
            outputs=_named({name: _outputs(step) for name, step in calculated.items()}),
            criteria=dict(_criteria(results)),
            model_parameters=_named({name: model.parameters for name, model in models.items()}),
            measurements=dict(_measured(session, row)),
        )


def _typed(document: JsonObject) -> dict[str, Json]:
    """Return the values of the design's parameters and of its variants' overrides, as typed."""
    variants = {f"variants.{name}": values for name, values in document.get("variants", {}).items()}
    return {**document["parameters"], **_named(variants)}


def _side(row: RevisionRow) -> Side:
    return Side.model_validate(
        {
            "design": row.design_id,
            "name": row.document["name"],
            "revision": row.number,
            "state": row.state,
            "created": row.created,
            "note": row.note,
        }
    )


def _named(groups: Mapping[str, Mapping[str, T]]) -> dict[str, T]:
    return {f"{group}.{name}": value for group, values in groups.items() for name, value in values.items()}


def _texts(relations: Mapping[str, Json]) -> dict[str, str]:
    return {name: numbers.in_line(raw) for name, raw in relations.items()}


def _outputs(step: JsonObject) -> dict[str, Json]:
    outputs: dict[str, Json] = step.get("outputs", {})
    return outputs


def _versions(steps: Mapping[str, JsonObject], calculated: Mapping[str, JsonObject]) -> dict[str, str]:
    """Return each step's version, level, and the first digits of its code's digest."""
    texts: dict[str, str] = {}
    for name, step in steps.items():
        done = calculated.get(name, {})
        digest = done.get("template", {}).get("digest")
        code = f", code {digest[:12]}" if digest else ""
        texts[name] = f"{step['template']} version {step['version']}{code}"
        if isinstance(level := done.get("level"), str):
            texts[f"{name}.level"] = level
    return texts


def _model_versions(row: RevisionRow) -> dict[str, str]:
    return {model.name: f"{model.model} version {model.model_version}" for model in row.models}


def _criteria(results: JsonObject) -> Iterator[tuple[str, VerdictOf]]:
    """Yield the name and verdict of each stored criterion; step results may store names without the step."""
    for item in results.get("criteria", ()):
        yield item["name"], _verdict(item)
    for name, step in results.get("steps", {}).items():
        for item in step.get("criteria", ()):
            yield f"{name}.{item['name'].removeprefix(f'{name}.')}", _verdict(item)


def _verdict(item: JsonObject) -> VerdictOf:
    utilisation = item.get("utilisation")
    more = {} if utilisation is None else {"utilisation": utilisation}
    return VerdictOf(verdict=item["verdict"], **more)


def _verdicts(old: Mapping[str, VerdictOf], new: Mapping[str, VerdictOf]) -> list[VerdictChange]:
    names = dict.fromkeys([*new, *old])
    changes = (VerdictChange(name=name, old=old.get(name), new=new.get(name)) for name in names)
    return [c for c in changes if (c.old and c.old.verdict) != (c.new and c.new.verdict)]


def _measured(session: Session, row: RevisionRow) -> Iterator[tuple[str, Json]]:
    """Yield the measurements of a revision's finished solids."""
    for model in row.models:
        build = rows.build(session, model.build_key) if model.build_key else None
        if build is not None:
            yield from leaves(measures.measurements(**build.measurements).plain(), model.name)
