"""Count the size of a design before anything of it is read or calculated."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from app.designs.document import Document
from app.plain import Raw
from templates.core.errors import Fault, FaultyText
from templates.core.units.relation import is_relation

MOST_RELATION_TEXT = (
    50_000  # characters of all relations of a design; reading them takes a quarter of a second
)
MOST_VALUES = 100_000  # of a relation, or of all outputs of a step
MOST_OPERATIONS = 20_000_000  # on single values, of all relations of a design


def too_many_relations(document: Document) -> Iterator[Fault]:
    """Yield a fault if the relations of a design are longer together than is read."""
    texts = [item for item in _items(document) if isinstance(item, str)]
    required = sum(len(criterion.require or "") for criterion in document.criteria.values())
    if required + sum(map(len, texts)) <= MOST_RELATION_TEXT:
        return
    length = required + sum(len(text) for text in texts if is_relation(text))
    if length > MOST_RELATION_TEXT:
        most = f"at most {MOST_RELATION_TEXT} characters together, not {length}"
        message = f"the relations and criteria of a design have {most}"
        yield Fault("design", "too_long", message)


def _items(document: Document) -> Iterator[Raw]:
    """Return every value of a document, and every item of those that are lists."""
    groups = [document.parameters]
    groups += [group for step in document.steps.values() for group in (step.inputs, step.limits)]
    groups += [model.parameters for model in document.models.values()]
    groups += document.variants.values()
    values = chain.from_iterable(group.values() for group in groups)
    return chain.from_iterable(value if isinstance(value, list) else (value,) for value in values)


def has_relation(raw: Raw) -> bool:
    """Return whether a value is a relation, or a list that holds one."""
    return any(map(is_relation, raw)) if isinstance(raw, list) else is_relation(raw)


def limit_values(values: int) -> None:
    """Refuse more values in one place than a design takes.

    Raises
    ------
    FaultyText
        With code `too_many_values`.
    """
    if values > MOST_VALUES:
        message = f"this makes {values} values, more than the {MOST_VALUES} that a design takes in one place"
        raise FaultyText("too_many_values", message)


def limit_operations(operations: int) -> None:
    """Refuse relations that calculate more, all together, than a design does.

    Raises
    ------
    FaultyText
        With code `too_many_values`.
    """
    if operations > MOST_OPERATIONS:
        message = f"the relations up to here make {operations} operations on single values"
        raise FaultyText(
            "too_many_values", f"{message}; use shorter arrays, at most {MOST_OPERATIONS} are made"
        )
