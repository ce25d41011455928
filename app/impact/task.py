"""A batch of designs as a calculation process receives it, with everything that it needs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from pydantic_core import from_json

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.tasks import CatalogueTask
from app.impact.solids import Solids
from app.reference import Reference


@dataclass(frozen=True)
class DesignAt:
    """A design at its newest revision.

    `settled` are the final values [SI] of its iterations, by name.
    """

    id: str
    revision: int
    document: str
    settled: tuple[tuple[str, float], ...] = ()

    def read(self) -> Document:
        """Return the parsed document of the revision."""
        return Document.model_validate(from_json(self.document))

    def assumed(self) -> dict[Reference, float]:
        """Return the final values of its iterations."""
        return {Reference.parse(name): value for name, value in self.settled}


@dataclass(frozen=True)
class Batch:
    """Designs that are compared with version `version` of a template."""

    template: str
    version: int
    designs: tuple[DesignAt, ...]
    parts: CatalogueTask
    solids: Solids = field(default_factory=Solids)


def uses(documents: Iterable[Document]) -> tuple[set[tuple[str, int]], set[tuple[str, int]]]:
    """Return the versions of templates and models that some documents use; documents fix every version."""
    templates, models = set[tuple[str, int]](), set[tuple[str, int]]()
    for document in documents:
        templates |= {(step.template, int(step.version or 0)) for step in document.steps.values()}
        models |= {(model.id, int(model.version or 0)) for model in document.models.values()}
    return templates, models


def upgraded(document: Document, template: str, version: int) -> Document:
    """Return a copy of the document with a version in every step that uses the template.

    The original is not changed.
    """
    steps = {
        name: step.model_copy(update={"version": version}) if step.template == template else step
        for name, step in document.steps.items()
    }
    return document.model_copy(update={"steps": steps})


def missing(document: Document, catalogues: Catalogues) -> list[str]:
    """Return the versions that a document uses and the catalogues lack, such as `oil_film 1`."""
    templates, models = uses([document])
    absent = [key for key in sorted(templates) if key not in catalogues.templates.versions]
    absent += [key for key in sorted(models) if key not in catalogues.models.versions]
    return [f"{id} {version}" for id, version in absent]
