"""The impact of a version as a long answer: a job calculates it, unless it is answered before."""

from __future__ import annotations

from collections.abc import Mapping

from app.calculations.jobs import IMPACT
from app.designs import repository as designs
from app.designs.long_answers import LongAnswers
from app.impact.bodies import ImpactIn
from app.impact.schemas import Impact
from app.impact.survey import Asked, Survey
from app.presentation.units import System


class Impacts(LongAnswers):
    """Makes jobs that calculate the impact of versions, and is their handler."""

    kind = IMPACT

    def requested(self, asked: Asked, client: str) -> str:
        """Return the job that calculates an impact.

        Raises
        ------
        UnknownTemplate
            If there is no such version, or it is a draft with faults.
        NotFound
            If a design is named that there is not.
        QueueFull
            Too many jobs are waiting.
        """
        self.catalogues.to_try(asked.template, asked.version)
        with self.database.read() as session:
            for id in asked.body.designs or ():
                designs.design(session, id)
        payload = {"template": asked.template, "version": asked.version, "units": asked.units}
        return self.queued(payload, asked.body.model_dump(), client)

    def calculated(self, payload: Mapping[str, object], body: object) -> Impact:
        """Return the impact that a job holds."""
        units: System = "us" if payload["units"] == "us" else "si"
        version = int(str(payload["version"]))
        asked = Asked(str(payload["template"]), version, ImpactIn.model_validate(body), units)
        self.catalogues.to_try(asked.template, asked.version)
        catalogues = self.catalogues.with_drafts([(asked.template, asked.version)])
        return Survey(asked, self.database, catalogues).impact().in_units(asked.units)
