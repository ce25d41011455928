"""The total that each principal has stored, as one row each, which follows `usage` by triggers.

So a server of the schema before, which goes on while another one is upgraded, keeps it right as well.
"""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"

ADD = (
    "INSERT INTO storage (principal_id, bytes) VALUES (NEW.principal_id, {added}) "
    "ON CONFLICT (principal_id) DO UPDATE SET bytes = storage.bytes + excluded.bytes"
)
EVENTS = {"insert": ("INSERT", "NEW.bytes", "NEW.bytes <> 0"),
          "update": ("UPDATE OF bytes", "NEW.bytes - OLD.bytes", "NEW.bytes <> OLD.bytes")}  # fmt: skip


def upgrade() -> None:
    op.create_table(
        "storage",
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("bytes", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("principal_id", name="pk_storage"),
    )
    follow = follow_on_postgresql if op.get_bind().dialect.name == "postgresql" else follow_on_sqlite
    for name, (event, added, changes) in EVENTS.items():
        follow(f"usage_stored_{name}", event, ADD.format(added=added), changes)
    # After the triggers: they wait for whoever writes at present, and whoever writes next waits for this.
    op.execute(
        "INSERT INTO storage (principal_id, bytes) "
        'SELECT principal_id, SUM(bytes) FROM "usage" GROUP BY principal_id'
    )


def follow_on_sqlite(name: str, event: str, statement: str, changes: str) -> None:
    op.execute(f'CREATE TRIGGER {name} AFTER {event} ON "usage" WHEN {changes} BEGIN {statement}; END')


def follow_on_postgresql(name: str, event: str, statement: str, changes: str) -> None:
    op.execute(
        f"CREATE FUNCTION {name}() RETURNS trigger LANGUAGE plpgsql "
        f"AS $$ BEGIN {statement}; RETURN NULL; END $$"
    )
    op.execute(
        f'CREATE TRIGGER {name} AFTER {event} ON "usage" FOR EACH ROW WHEN ({changes}) '
        f"EXECUTE FUNCTION {name}()"
    )
