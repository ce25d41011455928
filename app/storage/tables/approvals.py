"""Approvals of revisions, and comments on them."""

from sqlalchemy import ForeignKeyConstraint, Index, text
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class ApprovalRow(Base):
    """A step in the approval of a revision. A principal may take at most one step; anyone may withdraw."""

    __tablename__ = "approval"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
        Index(
            "uq_approval_design_id_revision_principal_id",
            "design_id",
            "revision",
            "principal_id",
            unique=True,
            sqlite_where=text("step <> 'withdrawn'"),
            postgresql_where=text("step <> 'withdrawn'"),
        ),
    )

    design_id: Mapped[str] = mapped_column(primary_key=True)
    revision: Mapped[int] = mapped_column(primary_key=True)
    step: Mapped[str] = mapped_column(primary_key=True)  # calculated, checked, released, withdrawn
    principal_id: Mapped[str]
    name: Mapped[str]  # the principal's name at that time
    digest: Mapped[str] = mapped_column(index=True)  # SHA-256 of `content`
    content: Mapped[JsonObject]  # the signed content: document, results and files by their hashes, name, time
    at: Mapped[str]


class PrintedReportRow(Base):
    """A report that was printed of a revision with at least one signature."""

    __tablename__ = "printed_report"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
    )

    design_id: Mapped[str] = mapped_column(primary_key=True)
    revision: Mapped[int] = mapped_column(primary_key=True)
    sha256: Mapped[str] = mapped_column(primary_key=True)  # of the whole file
    at: Mapped[str]


class CommentRow(Base):
    """A comment on a revision."""

    __tablename__ = "comment"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
        Index(None, "design_id", "revision"),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    design_id: Mapped[str]
    revision: Mapped[int]
    principal_id: Mapped[str]
    name: Mapped[str]  # the principal's name at that time
    subject: Mapped[str | None]  # a reference into the document, such as film.bearing_width
    text: Mapped[str]
    resolved: Mapped[str | None]  # since when
    resolved_by: Mapped[str | None]
    created: Mapped[str]
