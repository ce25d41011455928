"""Makes the service of studies and registers its jobs; called once by the application."""

from __future__ import annotations

from app.designs.service import Designs
from app.studies.building import Building
from app.studies.conclude import Concluding
from app.studies.healing import Healing
from app.studies.running import STUDY, Parts, Studying
from app.studies.service import Studies


def assemble_studies(parts: Parts, designs: Designs) -> Studies:
    """Return the service of studies, its handler registered."""
    conclude = Concluding(Building(parts, designs))
    healing = Healing(parts, conclude)
    handler = Studying(parts, conclude, healing.heal)
    parts.jobs.register(STUDY, handler, handler.failed, lane=STUDY)
    return Studies(parts.database, parts.store, parts.jobs, parts.catalogues, designs, healing.lost)
