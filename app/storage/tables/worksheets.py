"""Versions of worksheets."""

from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class WorksheetVersionRow(Base):
    """A version of a worksheet: its text is the truth. Only a version that was never released changes it."""

    __tablename__ = "worksheet_version"

    id: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    edit: Mapped[str]  # another at every change: the ETag
    state: Mapped[str]  # draft, tested, reviewed, released, withdrawn
    text: Mapped[str]
    title: Mapped[str]
    language: Mapped[int]  # its version
    digest: Mapped[str | None]  # of the statements; null while they have faults
    faults: Mapped[list[JsonObject]]
    tests: Mapped[list[JsonObject]]  # as they ran last
    record: Mapped[JsonObject | None]  # golden: what the released version calculated
    author: Mapped[str | None]  # a name
    reviewer: Mapped[str | None]
    author_principal: Mapped[str | None] = mapped_column(default=None)
    reviewer_principal: Mapped[str | None] = mapped_column(default=None)
    withdrawn: Mapped[str | None]  # why
    import_sha256: Mapped[str | None]  # the artifact with the file that it was imported from
    imported: Mapped[JsonObject | None]  # what the import says of its regions
    created: Mapped[str]
    updated: Mapped[str]
    released: Mapped[str | None]
