"""A design as sent to a calculation process: its document and the files of its templates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from pydantic_core import from_json

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.plain import JsonObject
from app.pool.sources import Source, loaded, source_of
from app.storage.tables import canonical_json
from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue
from templates.core.language.template import Template

T = TypeVar("T", bound=Template)
_Sources = tuple[tuple[str, int, Source], ...]
Versions = set[tuple[str, int]]
"""Versions, given by id and number."""


@dataclass(frozen=True)
class CatalogueTask:
    """Versions of templates and models, given by their files; tasks with equal versions are equal."""

    templates: _Sources
    models: _Sources

    @classmethod
    def of(cls, templates: Versions, models: Versions, catalogues: Catalogues) -> CatalogueTask:
        """Return the task for some versions.

        Raises
        ------
        UnknownTemplate
            If the catalogue no longer has one of them.
        """
        return cls(_sources(catalogues.templates, templates), _sources(catalogues.models, models))

    def read(self) -> Catalogues:
        """Load the versions in this process, and return their catalogues."""
        templates = _catalogue(self.templates, Template, "template")
        return Catalogues(templates, _catalogue(self.models, CadModel, "model"))


@dataclass(frozen=True)
class DesignTask:
    """A revision's document with its templates and models; equal designs make equal tasks."""

    document: str
    parts: CatalogueTask

    @classmethod
    def of(cls, document: JsonObject, catalogues: Catalogues) -> DesignTask:
        """Return the task for a revision's document.

        Raises
        ------
        UnknownTemplate
            If the catalogue no longer has a version that the design needs.
        """
        read = Document.model_validate(document)
        steps = {(step.template, _number(step.version)) for step in read.steps.values()}
        models = {(model.id, _number(model.version)) for model in read.models.values()}
        return cls(canonical_json(document), CatalogueTask.of(steps, models, catalogues))

    def read(self) -> tuple[Document, Catalogues]:
        """Load the design, its templates and its models in this process, and return them."""
        return Document.model_validate(from_json(self.document)), self.parts.read()


def _catalogue(sources: _Sources, base: type[T], kind: str) -> Catalogue[T]:
    classes = {(id, version): loaded(source) for id, version, source in sources}
    return Catalogue({key: cls for key, cls in classes.items() if issubclass(cls, base)}, kind)


def _sources(catalogue: Catalogue[T], wanted: Versions) -> _Sources:
    return tuple((id, number, source_of(catalogue.get(id, number))) for id, number in sorted(wanted))


def _number(version: object) -> int:
    assert isinstance(version, int), "a revision pins every version"
    return version
