"""Principals, their keys and sessions, and their usage."""

from sqlalchemy import BigInteger, Double, ForeignKey, UniqueConstraint
from sqlalchemy.orm import Mapped, mapped_column

from app.plain import JsonObject
from app.storage.tables.base import Base


class PrincipalRow(Base):
    """A person or a service that may use the interface."""

    __tablename__ = "principal"
    __table_args__ = (UniqueConstraint("name"), UniqueConstraint("subject"))

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]  # person, service
    name: Mapped[str]
    subject: Mapped[str | None]  # identifier of this person at the OpenID provider
    roles: Mapped[list[str]]  # viewer, author, checker, admin
    limits: Mapped[JsonObject | None]  # limits that differ from the settings
    disabled: Mapped[str | None]  # time of the change
    created: Mapped[str]


class ApiKeyRow(Base):
    """A key of a principal. The key itself is not stored."""

    __tablename__ = "api_key"

    prefix: Mapped[str] = mapped_column(primary_key=True)
    hash: Mapped[str]  # SHA-256 of the whole key
    principal_id: Mapped[str] = mapped_column(ForeignKey("principal.id"), index=True)
    name: Mapped[str]
    scopes: Mapped[list[str]]  # roles that the key may use; if empty, all roles of its principal
    expires: Mapped[str | None]
    revoked: Mapped[str | None]  # time of the change
    made_by: Mapped[str | None]  # prefix of the key with which it was created; it ends when that key ends
    created: Mapped[str]


class SessionRow(Base):
    """A browser in which a principal has signed in. The cookie itself is not stored."""

    __tablename__ = "session"

    hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256 of the cookie's value
    principal_id: Mapped[str] = mapped_column(ForeignKey("principal.id"), index=True)
    key: Mapped[str | None]  # prefix of the key used to sign in; the session ends when that key ends
    csrf: Mapped[str]
    expires: Mapped[str] = mapped_column(index=True)
    created: Mapped[str]


class UsageRow(Base):
    """Usage of a principal on a day (UTC)."""

    __tablename__ = "usage"

    principal_id: Mapped[str] = mapped_column(primary_key=True)
    day: Mapped[str] = mapped_column(primary_key=True)  # 2026-11-22
    requests: Mapped[int] = mapped_column(BigInteger, default=0)
    jobs: Mapped[int] = mapped_column(BigInteger, default=0)
    seconds: Mapped[float] = mapped_column(Double, default=0.0)  # calculation time
    bytes: Mapped[int] = mapped_column(
        BigInteger, default=0
    )  # size of files that were stored for the first time


class StorageRow(Base):
    """The total number of bytes that a principal has stored; triggers update it from `usage.bytes`."""

    __tablename__ = "storage"

    principal_id: Mapped[str] = mapped_column(primary_key=True)
    bytes: Mapped[int] = mapped_column(BigInteger)
