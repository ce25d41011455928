"""Tests of choices in relations, such as `film.oil is "SAE 30"`: resolved from the document alone.

The options chosen in a document do not depend on calculated values. So each test is resolved when the
network is built, and it creates no loop even if the relation sets an input of the same step.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document, Version
from app.plain import Raw
from app.reference import Reference
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import FaultyText, UnknownTemplate, unknown_name
from templates.core.language.intake import option_named
from templates.core.language.spec import Choice
from templates.core.language.template import Template
from templates.core.units.expressions import check_word
from templates.core.units.relation import Relation

T = TypeVar("T", bound=Template)


@dataclass(frozen=True)
class Choices:
    """The choice inputs of a design's steps and models, and the options that its document selects."""

    document: Document
    catalogues: Catalogues

    def decided(self, relation: Relation) -> Relation:
        """Return a relation in which each tested choice is replaced by the selected option.

        The relation is returned unchanged if a template is unknown.

        Raises
        ------
        FaultyText
            The code is `unknown_name`, `no_truth` or `missing`.
        """
        words: dict[str, str] = {}
        for name, word in relation.tests:
            try:
                declared, raw = self._choice(name)
            except UnknownTemplate:  # reported as a separate fault
                return relation
            check_word(name, word, declared.options)
            words[name] = _word(name, declared, raw)
        return relation.decided(words)

    def _choice(self, name: str) -> tuple[Choice, Raw]:
        """Return the declaration of a choice, and the option that the document selects."""
        reference = Reference.parse(name)
        cls, values = self._block(name, reference.block)
        declared = cls.inputs.get(reference.member) if cls else None
        if isinstance(declared, Choice):
            return declared, values.get(reference.member)
        raise FaultyText("no_truth", f"{name[:60]} is not a choice; compare it with < <= > >= == or !=")

    def _block(self, name: str, block: str) -> tuple[type[Template] | None, Mapping[str, Raw]]:
        if step := self.document.steps.get(block):
            return _class(self.catalogues.templates, step.template, step.version), step.inputs
        if model := self.document.models.get(block):
            return _class(self.catalogues.models, model.id, model.version), model.parameters
        if block in self.document.parameters:
            return None, {}
        blocks = [*self.document.steps, *self.document.models]
        raise FaultyText("unknown_name", unknown_name(name, blocks, "choice").detail)


def _class(catalogue: Catalogue[T], id: str, version: Version) -> type[T]:
    return catalogue.get(id, version) if isinstance(version, int) else catalogue.latest(id)


def _word(name: str, declared: Choice, raw: Raw) -> str:
    given = raw.get("value") if isinstance(raw, dict) else raw
    word = given if given is not None else declared.default
    if word is None:
        raise FaultyText("missing", f"{name} is not set: choose one of {', '.join(declared.options)}")
    return option_named(declared.options, str(word)) or str(word)
