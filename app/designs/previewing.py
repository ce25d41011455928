"""Previews of changes: answered whole, or as far as they are known while a job calculates the rest."""

from __future__ import annotations

from dataclasses import dataclass

from app.calculations.jobs import PREVIEW
from app.designs.long_answers import LongAnswers
from app.designs.preview import preview
from app.designs.schemas.designs import Preview
from app.plain import Json, JsonObject
from app.presentation.units import System


@dataclass(frozen=True)
class Change:
    """A change that is to be previewed, and how."""

    design: str
    patch: JsonObject
    worksheet: bool
    system: System


class Previews(LongAnswers):
    """Makes previews, and jobs of those that take long, and is the handler of such jobs."""

    kind = PREVIEW

    def quick(self, change: Change) -> Preview:
        """Return the preview as far as its caller waits for it."""
        return preview(self.database, self.catalogues, **vars(change)).content

    def answer(self, change: Change, client: str) -> tuple[Preview, str | None]:
        """Return the preview as far as its caller waits for it, and the job that calculates the rest, if any.

        Raises
        ------
        InvalidInputs
            With everything that is wrong as far as it is known.
        QueueFull
            Too many calculations, or jobs, are waiting.
        """
        previewed = preview(self.database, self.catalogues, **vars(change))
        if previewed.is_whole:
            return previewed.content, None
        payload = {
            "design": change.design,
            "revision": previewed.content.revision,
            "worksheet": change.worksheet,
            "system": change.system,
        }
        return previewed.content, self.queued(payload, change.patch, client)

    def calculated(self, payload: JsonObject, body: Json) -> Preview:
        """Return the whole preview of the patch that a job holds."""
        return preview(self.database, self.catalogues, patch=body, **payload).content
