"""Models that a team has imported."""

from sqlalchemy.orm import Mapped, mapped_column

from app.storage.tables.base import Base


class ImportedModelRow(Base):
    """A version of an imported model: written once, never changed."""

    __tablename__ = "imported_model"

    id: Mapped[str] = mapped_column(primary_key=True)
    number: Mapped[int] = mapped_column(primary_key=True)
    program: Mapped[str]
    description: Mapped[str]  # the text of `cad.imported_models.Description`
    file_sha256: Mapped[str]  # the artifact that the program opens
    sent_sha256: Mapped[str]  # the artifact as it was sent
    author: Mapped[str | None]
    author_principal: Mapped[str | None]
    created: Mapped[str]
