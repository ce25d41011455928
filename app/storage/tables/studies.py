"""Studies and their calculated chunks of rows."""

from sqlalchemy import BigInteger, ForeignKey, ForeignKeyConstraint, Index
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class StudyRow(Base):
    """A study: many rows of a revision. Its rows follow from body, seed and number; `plan` fixes the rest."""

    __tablename__ = "study"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
        Index(None, "design_id", "revision"),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    design_id: Mapped[str]
    revision: Mapped[int]
    method: Mapped[str]
    state: Mapped[str]  # queued, running, done, failed, cancelled
    body: Mapped[JsonObject]  # as its user wrote it
    plan: Mapped[JsonObject]  # what it led to: places, units, levels, stages
    seed: Mapped[int] = mapped_column(BigInteger)
    chunk: Mapped[int]  # rows of one chunk
    rows: Mapped[int]  # that are planned; an optimisation may need fewer
    table_sha256: Mapped[str | None]  # the artifact with the rows that its user gave
    client: Mapped[str]
    job: Mapped[str | None]  # the job that works on it
    result: Mapped[JsonObject | None]
    problem: Mapped[JsonObject | None]
    created: Mapped[str]
    updated: Mapped[str]


class StudyChunkRow(Base):
    """Rows of a study that have been calculated; the values are in the artifact."""

    __tablename__ = "study_chunk"

    study_id: Mapped[str] = mapped_column(ForeignKey("study.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    state: Mapped[str]  # done
    attempt: Mapped[int]  # of the job that calculated it
    rows: Mapped[int]
    refused: Mapped[JsonObject]  # how many rows, by reason
    sha256: Mapped[str] = mapped_column(index=True)
