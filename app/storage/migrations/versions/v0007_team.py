"""A team: principals with keys and sessions, approvals, comments, audit, events, leases of jobs, usage."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    extend_tables()
    create_identity()
    create_approval()
    create_records()
    if op.get_bind().dialect.name == "postgresql":
        share_counters()
    guard_rows(op.get_bind().dialect.name)


def extend_tables() -> None:
    with op.batch_alter_table("design") as design:
        design.add_column(sa.Column("event", sa.BigInteger(), nullable=False, server_default="0"))
    with op.batch_alter_table("revision") as revision:
        revision.add_column(sa.Column("author", sa.Text(), nullable=True))
        revision.add_column(sa.Column("supersedes", sa.Integer(), nullable=True))
    with op.batch_alter_table("job") as job:
        job.add_column(sa.Column("principal", sa.Text(), nullable=True))
        job.add_column(sa.Column("event", sa.BigInteger(), nullable=False, server_default="0"))
        job.add_column(sa.Column("losses", sa.Integer(), nullable=False, server_default="0"))
        job.add_column(sa.Column("owner", sa.Text(), nullable=True))
        job.add_column(sa.Column("lease_until", sa.Double(), nullable=True))
        job.add_column(sa.Column("cause", sa.Text(), nullable=True))
        job.create_index("ix_job_owner", ["owner"])
    with op.batch_alter_table("worksheet_version") as sheet:
        sheet.add_column(sa.Column("author_principal", sa.Text(), nullable=True))
        sheet.add_column(sa.Column("reviewer_principal", sa.Text(), nullable=True))


def create_identity() -> None:
    op.create_table(
        "principal",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("subject", sa.Text()),
        sa.Column("roles", sa.Text(), nullable=False),
        sa.Column("limits", sa.Text()),
        sa.Column("disabled", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_principal"),
        sa.UniqueConstraint("name", name="uq_principal_name"),
        sa.UniqueConstraint("subject", name="uq_principal_subject"),
    )
    op.create_table(
        "api_key",
        sa.Column("prefix", sa.Text(), nullable=False),
        sa.Column("hash", sa.Text(), nullable=False),
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("scopes", sa.Text(), nullable=False),
        sa.Column("expires", sa.Text()),
        sa.Column("revoked", sa.Text()),
        sa.Column("made_by", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("prefix", name="pk_api_key"),
        sa.ForeignKeyConstraint(["principal_id"], ["principal.id"], name="fk_api_key_principal_id_principal"),
    )
    op.create_index("ix_api_key_principal_id", "api_key", ["principal_id"])
    op.create_table(
        "session",
        sa.Column("hash", sa.Text(), nullable=False),
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("key", sa.Text(), nullable=True),
        sa.Column("csrf", sa.Text(), nullable=False),
        sa.Column("expires", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("hash", name="pk_session"),
        sa.ForeignKeyConstraint(["principal_id"], ["principal.id"], name="fk_session_principal_id_principal"),
    )
    op.create_index("ix_session_principal_id", "session", ["principal_id"])
    op.create_index("ix_session_expires", "session", ["expires"])


def create_approval() -> None:
    op.create_table(
        "approval",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("step", sa.Text(), nullable=False),
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("digest", sa.Text(), nullable=False),
        sa.Column("content", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("design_id", "revision", "step", name="pk_approval"),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_approval_design_id_revision_revision",
        ),
    )
    op.create_index("ix_approval_digest", "approval", ["digest"])
    taken = sa.text("step <> 'withdrawn'")
    op.create_index(
        "uq_approval_design_id_revision_principal_id",
        "approval",
        ["design_id", "revision", "principal_id"],
        unique=True,
        sqlite_where=taken,
        postgresql_where=taken,
    )
    op.create_table(
        "comment",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("subject", sa.Text()),
        sa.Column("text", sa.Text(), nullable=False),
        sa.Column("resolved", sa.Text()),
        sa.Column("resolved_by", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_comment"),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_comment_design_id_revision_revision",
        ),
    )
    op.create_index("ix_comment_design_id_revision", "comment", ["design_id", "revision"])


def create_records() -> None:
    op.create_table(
        "audit",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.Column("principal", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("action", sa.Text(), nullable=False),
        sa.Column("object", sa.Text(), nullable=False),
        sa.Column("digest", sa.Text()),
        sa.Column("seq", sa.BigInteger()),
        sa.Column("previous", sa.Text()),
        sa.Column("hash", sa.Text()),
        sa.PrimaryKeyConstraint("id", name="pk_audit"),
        sa.UniqueConstraint("seq", name="uq_audit_seq"),
    )
    op.create_index("ix_audit_object", "audit", ["object"])
    op.create_table(
        "event",
        sa.Column("topic", sa.Text(), nullable=False),
        sa.Column("number", sa.BigInteger(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("data", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("operated", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("topic", "number", name="pk_event"),
    )
    op.create_index("ix_event_operated", "event", ["operated"])
    op.create_table(
        "usage",
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("day", sa.Text(), nullable=False),
        sa.Column("requests", sa.BigInteger(), nullable=False),
        sa.Column("jobs", sa.BigInteger(), nullable=False),
        sa.Column("seconds", sa.Double(), nullable=False),
        sa.Column("bytes", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("principal_id", "day", name="pk_usage"),
    )


def share_counters() -> None:
    """Counters of several servers: a sequence above the counter, and for which moment the clock stands."""
    newest = op.get_bind().scalar(sa.text("SELECT value FROM counter WHERE name = 'identity'"))
    op.execute(f"CREATE SEQUENCE identity AS bigint START WITH {int(newest) + 1}")
    op.execute(
        "INSERT INTO counter (name, value) VALUES ('ticked', floor(extract(epoch from clock_timestamp())))"
    )


RECORDED = ("id", "at", "principal", "name", "action", "object", "digest")
"""What a row of the audit says; a sealer writes the other columns, once."""
SIGNED = "SELECT 1 FROM approval WHERE design_id = {row}.design_id AND revision = {row}.number"


def guard_rows(dialect: str) -> None:
    """Let the database itself refuse what the program never does to records and to signed revisions."""
    guard = guard_on_postgresql if dialect == "postgresql" else guard_on_sqlite
    sealed = " OR ".join(
        ["OLD.hash IS NOT NULL", *(f"OLD.{name} {{differs}} NEW.{name}" for name in RECORDED)]
    )
    guard("audit_sealed", "UPDATE", "audit", sealed)
    guard("audit_kept", "DELETE", "audit", "")
    for event in ("UPDATE", "DELETE"):
        guard(f"approval_{event.lower()}", event, "approval", "")
        for table in ("revision", "revision_model"):
            guard(f"{table}_signed_{event.lower()}", event, table, f"EXISTS ({SIGNED.format(row='OLD')})")
    guard("revision_model_signed_insert", "INSERT", "revision_model", f"EXISTS ({SIGNED.format(row='NEW')})")


def guard_on_sqlite(name: str, event: str, table: str, condition: str) -> None:
    when = f"WHEN {condition.format(differs='IS NOT')}" if condition else ""
    refuse = f"SELECT RAISE(ABORT, '{name}: this row is kept as it is')"
    op.execute(f"CREATE TRIGGER {name} BEFORE {event} ON {table} {when} BEGIN {refuse}; END")


def guard_on_postgresql(name: str, event: str, table: str, condition: str) -> None:
    met = condition.format(differs="IS DISTINCT FROM") or "TRUE"
    row = "OLD" if event == "DELETE" else "NEW"
    op.execute(
        f"CREATE FUNCTION {name}() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN IF {met} THEN "
        f"RAISE EXCEPTION '{name}: this row is kept as it is'; END IF; RETURN {row}; END $$"
    )
    op.execute(f"CREATE TRIGGER {name} BEFORE {event} ON {table} FOR EACH ROW EXECUTE FUNCTION {name}()")
