"""Saves of designs that calculate next to nothing: each is one unit of work, its answer is what it wrote.

The general way reads in one thread, writes in another, and reads again for the answer. That takes longer than
such a save itself. Whatever is not quick, or not right, raises `NotQuick`; nothing is stored then, and the
general way does it, or says what is wrong.
"""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy.orm import Session

from app.calculations.cost import is_quick as is_quick_template
from app.catalogue.catalogues import Catalogues
from app.designs import repository, views
from app.designs.bodies import LONGEST_NOTE
from app.designs.document import merge
from app.designs.schemas.designs import Design
from app.designs.service import Designs, Draft, matches
from app.storage.database import Unit
from app.storage.idempotency import Once
from app.storage.identity import now
from templates.core.errors import UnknownTemplate

MOST_STEPS = 4
MOST_CRITERIA = 10
MOST_PARAMETERS = 50
Body = dict[str, object]
"""A document or a patch as it came."""

_SLOW = ("model", "models", "variants", "iterations")


class NotQuick(Exception):
    """The general way has to save this, or to say what is wrong with it."""


class QuickSaves:
    """Creates and changes of designs without geometry whose steps are quick."""

    def __init__(self, designs: Designs) -> None:
        self._designs = designs

    def creation(self, raw: Body, once: Once) -> Unit[Design]:
        """The unit of work that creates a design, calculated by now.

        Raises
        ------
        NotQuick, InvalidInputs
            The general way has to do it.
        """
        note = _note(raw)
        if not self._is_quick(raw):
            raise NotQuick
        draft = self._draft(raw, note, "design.create")

        def unit(session: Session) -> Design:
            if once.begin(session):
                raise NotQuick
            at = now()
            document = draft.written.document
            id, number = repository.create(session, document["name"], draft.written, at)
            self._designs.enqueued(session, id, number, draft, once, created=True)
            return views.current(id, number, document, at, at)

        return unit

    def change(self, id: str, patch: Body, expected: str, once: Once) -> Unit[Design]:
        """The unit of work that applies a merge patch to a design; it calculates as well.

        Raises
        ------
        NotQuick, InvalidInputs
            Here or in the unit: the general way has to do it.
        """
        note = _note(patch)
        if patch.keys() == {"name"}:
            raise NotQuick

        def unit(session: Session) -> Design:
            if once.begin(session):
                raise NotQuick
            head = repository.newest(session, id)
            document = merge(head.document, patch)
            if not (matches(expected, head.number) and self._is_quick(document)):
                raise NotQuick
            draft = self._draft(document, note, "design.change")
            if draft.written.document == head.document:
                raise NotQuick
            at = now()
            number = repository.append(session, id, head.number, draft.written, at)
            self._designs.enqueued(session, id, number, draft, once, created=False)
            return views.current(id, number, draft.written.document, head.created, at)

        return unit

    def _draft(self, raw: Body, note: str | None, action: str) -> Draft:
        draft = self._designs.draft(raw, note, action)
        if draft.written.state != "current":
            raise NotQuick
        return draft

    def _is_quick(self, document: Mapping[str, object]) -> bool:
        """Return whether a document, which may be wrong, has no geometry, no arrays, few and quick steps."""
        if any(document.get(name) for name in _SLOW):
            return False
        groups = (document.get(name) or {} for name in ("parameters", "steps", "criteria"))
        parameters, steps, criteria = (group if isinstance(group, dict) else None for group in groups)
        if parameters is None or steps is None or criteria is None:
            return False
        return (
            len(parameters) <= MOST_PARAMETERS
            and len(steps) <= MOST_STEPS
            and len(criteria) <= MOST_CRITERIA
            and all(map(_is_single, parameters.values()))
            and all(_is_quick_step(self._designs.catalogues, step) for step in steps.values())
        )


def _note(raw: Body) -> str | None:
    """Take the note out of a body."""
    note = raw.pop("note", None)
    if note is not None and not (isinstance(note, str) and len(note) <= LONGEST_NOTE):
        raise NotQuick
    return note


def _is_quick_step(catalogues: Catalogues, step: object) -> bool:
    if not isinstance(step, dict):
        return False
    id, version, inputs = step.get("template"), step.get("version"), step.get("inputs") or {}
    if not (isinstance(id, str) and isinstance(inputs, dict) and all(map(_is_single, inputs.values()))):
        return False
    templates = catalogues.templates
    try:
        cls = templates.get(id, version) if isinstance(version, int) else templates.latest(id)
    except UnknownTemplate:
        return False
    return is_quick_template(cls)


def _is_single(value: object) -> bool:
    """Return whether a value as typed is no list."""
    if isinstance(value, dict):
        return not any(isinstance(part, (list, dict)) for part in value.values())
    return not isinstance(value, list)
