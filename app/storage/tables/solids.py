"""Built solids: their files and the outputs of their analyses."""

from sqlalchemy import BigInteger, ForeignKey
from sqlalchemy.orm import Mapped, mapped_column, relationship

from app.plain import JsonObject
from app.storage.tables.base import Base


class BuildRow(Base):
    """A built solid, identified by the hash of all data that determine it."""

    __tablename__ = "build"

    key: Mapped[str] = mapped_column(primary_key=True)
    model: Mapped[str]
    version: Mapped[int]
    parameters: Mapped[JsonObject]
    measurements: Mapped[JsonObject]
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, default=0)  # when last requested [s of operation]
    made_by: Mapped[str] = mapped_column(default="")  # kernel and recipe

    artifacts: Mapped[list["ArtifactRow"]] = relationship(order_by="ArtifactRow.kind")


class ArtifactRow(Base):
    """A file of a build; its bytes are in the artifact store."""

    __tablename__ = "artifact"

    build_key: Mapped[str] = mapped_column(ForeignKey("build.key"), primary_key=True)
    kind: Mapped[str] = mapped_column(primary_key=True)  # step, glb, …
    sha256: Mapped[str] = mapped_column(index=True)
    size: Mapped[int]
    created: Mapped[str]


class AnalysisRow(Base):
    """One output of an analysis of a build, identified by the hash of all data that determine it."""

    __tablename__ = "analysis"

    key: Mapped[str] = mapped_column(primary_key=True)
    output: Mapped[str] = mapped_column(primary_key=True)  # stiffness, …
    build_key: Mapped[str] = mapped_column(ForeignKey("build.key"), index=True)
    asked: Mapped[JsonObject]
    found: Mapped[JsonObject]
    created: Mapped[str]
