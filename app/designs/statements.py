"""Compiled SQL statements for designs and revisions."""

from __future__ import annotations

from sqlalchemy import Integer, bindparam, func, insert, select, update

from app.designs.releases import OF_NEWEST_RELEASED
from app.storage.tables import Base, BuildRow, DesignRow, RevisionModelRow, RevisionRow
from app.storage.units import Statement

_DESIGNS = Base.metadata.tables[DesignRow.__tablename__]
_REVISIONS = Base.metadata.tables[RevisionRow.__tablename__]
_BUILDS = Base.metadata.tables[BuildRow.__tablename__]
MODELS = Base.metadata.tables[RevisionModelRow.__tablename__]
NEW_DESIGN = Statement(insert(_DESIGNS), "id", "name", "created", "head")
NEW_REVISION = Statement(
    insert(_REVISIONS).values(supersedes=OF_NEWEST_RELEASED.scalar_subquery()),
    "design_id",
    "number",
    "note",
    "created",
    "document",
    "results",
    "state",
    "problem",
    "author",
    "design",
)
"""Records that a revision supersedes the newest released revision of `design`."""
APPENDED = Statement(
    update(_DESIGNS)
    .where(
        _DESIGNS.c.id == bindparam("of"), _DESIGNS.c.head == bindparam("base"), _DESIGNS.c.deleted.is_(None)
    )
    .values(head=bindparam("number"), name=bindparam("named"))
    .returning(_DESIGNS.c.head),
    "of",
    "base",
    "number",
    "named",
)
DOCUMENT = Statement(
    select(_REVISIONS.c.document, _REVISIONS.c.created).where(
        _REVISIONS.c.design_id == bindparam("of"), _REVISIONS.c.number == bindparam("at")
    ),
    "of",
    "at",
)
NEW_MODEL = Statement(
    insert(MODELS),
    "design_id",
    "number",
    "name",
    "model",
    "model_version",
    "parameters",
    "relations",
    "build_key",
)
ATTACHED = Statement(
    update(_REVISIONS)
    .where(_REVISIONS.c.design_id == bindparam("of"), _REVISIONS.c.number == bindparam("at"))
    .values(results=bindparam("computed"), state="current", problem=None),
    "of",
    "at",
    "computed",
)
_OF_NAME = (
    select(*MODELS.c)
    .join(_BUILDS, _BUILDS.c.key == MODELS.c.build_key)
    .where(MODELS.c.design_id == bindparam("of"), MODELS.c.name == bindparam("model"))
)
BUILT = Statement(_OF_NAME.where(MODELS.c.number == bindparam("at")), "of", "model", "at")
GOOD = Statement(
    _OF_NAME.join(
        _REVISIONS,
        (_REVISIONS.c.design_id == MODELS.c.design_id) & (_REVISIONS.c.number == MODELS.c.number),
    )
    .where(MODELS.c.number <= bindparam("until"), _REVISIONS.c.state == "current")
    .order_by(MODELS.c.number.desc())
    .limit(1),
    "of",
    "model",
    "until",
)
_DESIGN_OF = _DESIGNS.join(_REVISIONS, _REVISIONS.c.design_id == _DESIGNS.c.id)
NEWEST = Statement(
    select(
        _REVISIONS.c.number, _REVISIONS.c.document, _DESIGNS.c.created, _REVISIONS.c.created,
        _REVISIONS.c.state, _REVISIONS.c.problem,
    )
    .select_from(_DESIGN_OF)
    .where(
        _DESIGNS.c.id == bindparam("of"),
        _DESIGNS.c.deleted.is_(None),
        _REVISIONS.c.number == func.coalesce(bindparam("at", type_=Integer), _DESIGNS.c.head),
    ),
    "of",
    "at",
)  # fmt: skip
NAMES = Statement(
    select(MODELS.c.name)
    .where(
        MODELS.c.design_id == bindparam("of"),
        MODELS.c.number == bindparam("at"),
        ~MODELS.c.name.contains("."),
    )
    .order_by(MODELS.c.name),
    "of",
    "at",
)
