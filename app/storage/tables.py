"""The tables. Times are ISO 8601 texts in UTC; JSON is stored canonically: equal values are equal texts."""

import json

from sqlalchemy import (
    BigInteger,
    Dialect,
    Double,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    MetaData,
    Text,
    TypeDecorator,
    UniqueConstraint,
    text,
)
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

from app import plain
from app.plain import JsonObject

NAMING = {
    "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    "uq": "uq_%(table_name)s_%(column_0_N_name)s",
    "ck": "ck_%(table_name)s_%(constraint_name)s",
    "fk": "fk_%(table_name)s_%(column_0_N_name)s_%(referred_table_name)s",
    "pk": "pk_%(table_name)s",
}


canonical_json = json.JSONEncoder(
    sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode
"""Write a JSON value in its one canonical form; raises ValueError for NaN and infinity, which are no JSON."""


class NotWritten(ValueError):
    """A column holds what this program has never written there."""


class Json(TypeDecorator[plain.Json]):
    """A JSON value in a text column; None is NULL. Replace a value whole: a change inside it is not seen."""

    impl = Text
    cache_ok = True

    def process_bind_param(self, value: plain.Json, dialect: Dialect) -> str | None:
        """From Python to the column."""
        return None if value is None else canonical_json(value)

    def process_result_value(self, value: str | None, dialect: Dialect) -> plain.Json:
        """From the column to Python; text that is no JSON was not written by this program."""
        try:
            return None if value is None else json.loads(value)
        except ValueError as error:
            raise NotWritten(f"a stored text is no JSON: {error}") from error


class Base(DeclarativeBase):
    """All tables share one metadata and one way to name constraints, which migrations rely on."""

    metadata = MetaData(naming_convention=NAMING)
    type_annotation_map = {str: Text, JsonObject: Json, list[JsonObject]: Json, list[str]: Json}


class CounterRow(Base):
    """A number that only grows, whatever the wall clock does; see `app.storage.identity`, `ownership`."""

    __tablename__ = "counter"

    name: Mapped[str] = mapped_column(primary_key=True)  # identity, operation, database
    value: Mapped[int] = mapped_column(BigInteger)


class DesignRow(Base):
    """A design; what it holds is in its revisions."""

    __tablename__ = "design"

    id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    created: Mapped[str]
    deleted: Mapped[str | None]
    head: Mapped[int]  # the number of the newest revision
    archived: Mapped[str | None] = mapped_column(default=None)  # since when lists leave it out
    event: Mapped[int] = mapped_column(BigInteger, default=0)  # the number of its newest event

    revisions: Mapped[list["RevisionRow"]] = relationship(order_by="RevisionRow.number")


class DesignTagRow(Base):
    """A tag of a design. It belongs to no revision: to set it makes nothing old."""

    __tablename__ = "design_tag"

    design_id: Mapped[str] = mapped_column(ForeignKey("design.id"), primary_key=True)
    key: Mapped[str] = mapped_column(primary_key=True, index=True)  # the same for every spelling
    tag: Mapped[str]  # as its user wrote it


class RevisionRow(Base):
    """One state of a design: the document never changes, the results are attached once."""

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
    """A CAD model in a revision, with its parameters resolved; that of a variant is named `main_2.shell`."""

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
    # No foreign key: the key follows from the parameters and is known before the build is made.
    build_key: Mapped[str | None] = mapped_column(index=True)


class BuildRow(Base):
    """A solid that was built, under the hash of all that determines it."""

    __tablename__ = "build"

    key: Mapped[str] = mapped_column(primary_key=True)
    model: Mapped[str]
    version: Mapped[int]
    parameters: Mapped[JsonObject]
    measurements: Mapped[JsonObject]
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, default=0)  # when last wanted [s of operation]
    made_by: Mapped[str] = mapped_column(default="")  # kernel and recipe; empty in builds of version 0.1

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
    """One output of an analysis of a build, under the hash of all that determines it."""

    __tablename__ = "analysis"

    key: Mapped[str] = mapped_column(primary_key=True)
    output: Mapped[str] = mapped_column(primary_key=True)  # stiffness, …
    build_key: Mapped[str] = mapped_column(ForeignKey("build.key"), index=True)
    asked: Mapped[JsonObject]
    found: Mapped[JsonObject]
    created: Mapped[str]


class JobRow(Base):
    """A piece of long work. The queue is the order of turns, which the clients take one after another."""

    __tablename__ = "job"
    __table_args__ = (
        ForeignKeyConstraint(["design_id", "revision"], ["revision.design_id", "revision.number"]),
        Index(None, "state", "turn", "id"),
        Index(None, "client", "state"),
        Index(None, "design_id", "revision"),
        Index(None, "operated"),
        Index(None, "owner"),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    state: Mapped[str]  # queued, running, done, failed, cancelled
    design_id: Mapped[str | None]
    revision: Mapped[int | None]
    payload: Mapped[JsonObject]
    attempt: Mapped[int]  # how often it was claimed: only the newest claim may write
    crashes: Mapped[int]  # how often it took its process down
    progress: Mapped[float]
    log: Mapped[list[str]]
    problem: Mapped[JsonObject | None]
    result: Mapped[str | None]  # a link
    created: Mapped[str]
    updated: Mapped[str]
    client: Mapped[str] = mapped_column(default="")  # whose turn it takes; see `app.api.gate.clients`
    others: Mapped[list[str]] = mapped_column(Json, default=list)  # clients that wait for it as well
    turn: Mapped[int] = mapped_column(BigInteger, default=0)
    operated: Mapped[int] = mapped_column(BigInteger, default=0)  # queued, then ended [s of operation]
    principal: Mapped[str | None] = mapped_column(default=None)  # who asked for it
    event: Mapped[int] = mapped_column(BigInteger, default=0)  # the number of its newest event
    losses: Mapped[int] = mapped_column(default=0)  # how often its worker was lost
    owner: Mapped[str | None] = mapped_column(default=None)  # the server process that runs it
    lease_until: Mapped[float | None] = mapped_column(Double, default=None)  # by the database's clock [s]
    cause: Mapped[str | None] = mapped_column(default=None)  # the id of its request, and the trace's context


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


class IdempotencyRow(Base):
    """What was answered to a request that may be sent again."""

    __tablename__ = "idempotency"
    __table_args__ = (Index(None, "operated"),)

    key: Mapped[str] = mapped_column(primary_key=True)
    scope: Mapped[str] = mapped_column(primary_key=True)  # method and path
    client: Mapped[str] = mapped_column(primary_key=True, default="")  # see `app.api.gate.clients`
    fingerprint: Mapped[str]  # SHA-256 of the body
    status: Mapped[int]
    location: Mapped[JsonObject]  # what to render again
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, default=0)  # when it was kept [s of operation]


class PrincipalRow(Base):
    """A person or a service that may use the interface."""

    __tablename__ = "principal"
    __table_args__ = (UniqueConstraint("name"), UniqueConstraint("subject"))

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]  # person, service
    name: Mapped[str]
    subject: Mapped[str | None]  # what the OpenID provider calls this person
    roles: Mapped[list[str]]  # viewer, author, checker, admin
    limits: Mapped[JsonObject | None]  # where they differ from those of the settings
    disabled: Mapped[str | None]  # since when
    created: Mapped[str]


class ApiKeyRow(Base):
    """A key of a principal. The key itself is not stored."""

    __tablename__ = "api_key"

    prefix: Mapped[str] = mapped_column(primary_key=True)
    hash: Mapped[str]  # SHA-256 of the whole key
    principal_id: Mapped[str] = mapped_column(ForeignKey("principal.id"), index=True)
    name: Mapped[str]
    scopes: Mapped[list[str]]  # roles that the key may use; empty: all of its principal
    expires: Mapped[str | None]
    revoked: Mapped[str | None]  # since when
    made_by: Mapped[str | None]  # prefix of the key by which its principal made it; it ends with that
    created: Mapped[str]


class SessionRow(Base):
    """A browser in which a principal has signed in. The cookie itself is not stored."""

    __tablename__ = "session"

    hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256 of the cookie's value
    principal_id: Mapped[str] = mapped_column(ForeignKey("principal.id"), index=True)
    key: Mapped[str | None]  # prefix of the key by which they signed in; its end is that of the session
    csrf: Mapped[str]
    expires: Mapped[str] = mapped_column(index=True)
    created: Mapped[str]


class ApprovalRow(Base):
    """A step of the approval of a revision. A principal takes at most one of them; anyone may withdraw."""

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
    name: Mapped[str]  # of the principal at that time
    digest: Mapped[str] = mapped_column(index=True)  # SHA-256 of the content
    content: Mapped[JsonObject]  # what was signed: document, results and files by their hashes, name, time
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
    name: Mapped[str]  # of the principal at that time
    subject: Mapped[str | None]  # a reference into the document, such as film.bearing_width
    text: Mapped[str]
    resolved: Mapped[str | None]  # since when
    resolved_by: Mapped[str | None]
    created: Mapped[str]


class AuditRow(Base):
    """Who did what. Rows are only added; a sealer numbers and chains them."""

    __tablename__ = "audit"
    __table_args__ = (UniqueConstraint("seq"),)

    id: Mapped[str] = mapped_column(primary_key=True)
    at: Mapped[str]
    principal: Mapped[str]
    name: Mapped[str]  # of the principal at that time
    action: Mapped[str]  # design.create, key.revoke, …
    object: Mapped[str] = mapped_column(index=True)  # designs/<id>/revisions/<n>, keys/<prefix>, …
    digest: Mapped[str | None]  # of what was written or signed
    seq: Mapped[int | None] = mapped_column(BigInteger)
    previous: Mapped[str | None]  # the hash of the row before
    hash: Mapped[str | None]


class EventRow(Base):
    """An event of a design or a job, numbered within its topic without a gap."""

    __tablename__ = "event"

    topic: Mapped[str] = mapped_column(primary_key=True)  # design:<id>, job:<id>
    number: Mapped[int] = mapped_column(BigInteger, primary_key=True)
    name: Mapped[str]
    data: Mapped[JsonObject]
    created: Mapped[str]
    operated: Mapped[int] = mapped_column(BigInteger, index=True)  # when [s of operation]


class UsageRow(Base):
    """What a principal used on a day (UTC)."""

    __tablename__ = "usage"

    principal_id: Mapped[str] = mapped_column(primary_key=True)
    day: Mapped[str] = mapped_column(primary_key=True)  # 2026-11-22
    requests: Mapped[int] = mapped_column(BigInteger, default=0)
    jobs: Mapped[int] = mapped_column(BigInteger, default=0)
    seconds: Mapped[float] = mapped_column(Double, default=0.0)  # of calculation
    bytes: Mapped[int] = mapped_column(BigInteger, default=0)  # of files, stored for the first time
