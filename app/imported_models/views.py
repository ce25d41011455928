"""Convert imported models to the schemas of the interface."""

from __future__ import annotations

from app.imported_models import repository
from app.imported_models.schemas import ImportedParameter, ModelOrigin
from app.storage.database import Database
from cad.model_classes import description_of


def origin(database: Database, id: str, number: int) -> ModelOrigin:
    """Return the origin of an imported model.

    Raises
    ------
    NotFound
        If it was not imported, or does not exist.
    """
    with database.read() as session:
        row = repository.version(session, id, number)
        described = description_of(row.description)
        return ModelOrigin(
            program=described.program,
            file=described.file_name,
            sha256=row.sent_sha256,
            made_with=described.made_with,
            trust=described.trust,
            findings=list(described.findings),
            ends=[name for name, _ in described.ends.parts] if described.ends else [],
            author=row.author,
            created=row.created,
            parameters=[
                ImportedParameter(
                    name=one.name,
                    unit=one.unit,
                    value=one.value,
                    source=one.source,
                    read_back=one.role or None,
                    moves=one.moves or None,
                )
                for one in described.parameters
            ],
        )
