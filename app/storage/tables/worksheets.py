"""Versions of worksheets."""

from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class WorksheetVersionRow(Base):
    """A version of a worksheet; all other data depend on its text, which never changes after a release."""

    __tablename__ = "worksheet_version"

    id: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    edit: Mapped[str]  # changes with every change; the ETag
    state: Mapped[str]  # draft, tested, reviewed, released, withdrawn
    text: Mapped[str]
    title: Mapped[str]
    language: Mapped[int]  # version of the language
    digest: Mapped[str | None]  # digest of the statements; null while they have faults
    faults: Mapped[list[JsonObject]]
    tests: Mapped[list[JsonObject]]  # results of the last run
    record: Mapped[JsonObject | None]  # golden record: the results of the released version
    author: Mapped[str | None]  # a name
    reviewer: Mapped[str | None]
    author_principal: Mapped[str | None] = mapped_column(default=None)
    reviewer_principal: Mapped[str | None] = mapped_column(default=None)
    withdrawn: Mapped[str | None]  # reason of the withdrawal
    import_sha256: Mapped[str | None]  # the artifact with the file from which it was imported
    imported: Mapped[JsonObject | None]  # import record of its regions
    created: Mapped[str]
    updated: Mapped[str]
    released: Mapped[str | None]
