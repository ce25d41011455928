"""Studies and their calculated chunks of rows."""

from sqlalchemy import BigInteger, ForeignKey, ForeignKeyConstraint, Index
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class StudyRow(Base):
    """A study: many rows of a revision, determined by body, seed, row number and `plan`."""

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
    plan: Mapped[JsonObject]  # the plan made from it: places, units, levels, stages
    seed: Mapped[int] = mapped_column(BigInteger)
    chunk: Mapped[int]  # number of rows in a chunk
    rows: Mapped[int]  # planned number of rows; an optimisation may need fewer
    table_sha256: Mapped[str | None]  # the artifact with the rows that the user gave
    client: Mapped[str]
    job: Mapped[str | None]  # its job
    result: Mapped[JsonObject | None]
    problem: Mapped[JsonObject | None]
    created: Mapped[str]
    updated: Mapped[str]


class StudyChunkRow(Base):
    """Calculated rows of a study; the values are in the artifact."""

    __tablename__ = "study_chunk"

    study_id: Mapped[str] = mapped_column(ForeignKey("study.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    state: Mapped[str]  # done
    attempt: Mapped[int]  # attempt of the job that calculated it
    rows: Mapped[int]
    refused: Mapped[JsonObject]  # number of refused rows by reason
    sha256: Mapped[str] = mapped_column(index=True)
