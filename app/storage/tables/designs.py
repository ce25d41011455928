"""Designs: tags, revisions and their CAD models."""

from sqlalchemy import BigInteger, ForeignKey, ForeignKeyConstraint
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.plain import JsonObject
from app.storage.tables.base import Base


class DesignRow(Base):
    """A design; its content is in its revisions."""

    __tablename__ = "design"

    id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    created: Mapped[str]
    deleted: Mapped[str | None]
    head: Mapped[int]  # the number of the newest revision
    archived: Mapped[str | None] = mapped_column(default=None)  # when it was archived
    event: Mapped[int] = mapped_column(BigInteger, default=0)  # the number of its newest event

    revisions: Mapped[list["RevisionRow"]] = relationship(order_by="RevisionRow.number")


class DesignTagRow(Base):
    """A tag of a design. It belongs to no revision, so setting it invalidates no result."""

    __tablename__ = "design_tag"

    design_id: Mapped[str] = mapped_column(ForeignKey("design.id"), primary_key=True)
    key: Mapped[str] = mapped_column(primary_key=True, index=True)  # equal for all spellings
    tag: Mapped[str]  # as its user wrote it


class RevisionRow(Base):
    """One state of a design: the document never changes, and the results are added once."""

    __tablename__ = "revision"

    design_id: Mapped[str] = mapped_column(ForeignKey("design.id"), primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    note: Mapped[str | None]
    created: Mapped[str]
    document: Mapped[JsonObject]  # as typed by the user
    results: Mapped[JsonObject | None]  # the evaluated steps
    state: Mapped[str]  # current, regenerating, failed
    problem: Mapped[JsonObject | None]
    author: Mapped[str | None] = mapped_column(default=None)  # the principal who saved it; null before 0.2
    supersedes: Mapped[int | None] = mapped_column(default=None)  # the released revision that it replaces

    models: Mapped[list["RevisionModelRow"]] = relationship(
        primaryjoin="and_(RevisionRow.design_id == RevisionModelRow.design_id,"
        " RevisionRow.number == RevisionModelRow.number, ~RevisionModelRow.name.contains('.'))",
        order_by="RevisionModelRow.name",
        viewonly=True,
    )
    variant_models: Mapped[list["RevisionModelRow"]] = relationship(
        primaryjoin="and_(RevisionRow.design_id == RevisionModelRow.design_id,"
        " RevisionRow.number == RevisionModelRow.number, RevisionModelRow.name.contains('.'))",
        order_by="RevisionModelRow.name",
        viewonly=True,
    )


class RevisionModelRow(Base):
    """A CAD model in a revision, with resolved parameters; a variant's model is named `main_2.shell`."""

    __tablename__ = "revision_model"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "number"], ["revision.design_id", "revision.number"]),
    )

    design_id: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    model: Mapped[str]
    model_version: Mapped[int]
    parameters: Mapped[JsonObject]
    relations: Mapped[JsonObject]
    # No foreign key: the key is computed from the parameters and known before the build exists.
    build_key: Mapped[str | None] = mapped_column(index=True)

    @property
    def variant(self) -> str | None:
        """Return the variant to which the model belongs; None for a model of the design itself."""
        return variant_of(self.name)

    @property
    def own_name(self) -> str:
        """Return the name of the model within the design or the variant."""
        return self.name.rpartition(".")[2]


def variant_of(model: str) -> str | None:
    """Return the variant in the name of a model, such as `main_2.shell`; None if it names none."""
    return model.rpartition(".")[0] or None
