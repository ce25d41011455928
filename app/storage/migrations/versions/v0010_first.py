"""The schema of the first release: all tables, counters, constraints and triggers."""

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = None


def upgrade() -> None:
    dialect = op.get_bind().dialect.name
    create_designs()
    create_solids()
    create_jobs()
    create_studies()
    create_worksheets()
    create_identity()
    create_approvals()
    create_records()
    begin_counters(dialect)
    guard_rows(dialect)
    sum_storage(dialect)


def create_designs() -> None:
    op.create_table(
        "design",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("deleted", sa.Text()),
        sa.Column("head", sa.Integer(), nullable=False),
        sa.Column("archived", sa.Text()),
        sa.Column("event", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_design"),
    )
    op.create_table(
        "design_tag",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("tag", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["design_id"], ["design.id"], name="fk_design_tag_design_id_design"),
        sa.PrimaryKeyConstraint("design_id", "key", name="pk_design_tag"),
    )
    op.create_index("ix_design_tag_key", "design_tag", ["key"])
    op.create_table(
        "revision",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("note", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("document", sa.Text(), nullable=False),
        sa.Column("results", sa.Text()),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("problem", sa.Text()),
        sa.Column("author", sa.Text()),
        sa.Column("supersedes", sa.Integer()),
        sa.ForeignKeyConstraint(["design_id"], ["design.id"], name="fk_revision_design_id_design"),
        sa.PrimaryKeyConstraint("design_id", "number", name="pk_revision"),
    )
    op.create_table(
        "revision_model",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("model", sa.Text(), nullable=False),
        sa.Column("model_version", sa.Integer(), nullable=False),
        sa.Column("parameters", sa.Text(), nullable=False),
        sa.Column("relations", sa.Text(), nullable=False),
        sa.Column("build_key", sa.Text()),
        sa.ForeignKeyConstraint(
            ["design_id", "number"],
            ["revision.design_id", "revision.number"],
            name="fk_revision_model_design_id_number_revision",
        ),
        sa.PrimaryKeyConstraint("design_id", "number", "name", name="pk_revision_model"),
    )
    op.create_index("ix_revision_model_build_key", "revision_model", ["build_key"])


def create_solids() -> None:
    op.create_table(
        "build",
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("model", sa.Text(), nullable=False),
        sa.Column("version", sa.Integer(), nullable=False),
        sa.Column("parameters", sa.Text(), nullable=False),
        sa.Column("measurements", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("operated", sa.BigInteger(), nullable=False),
        sa.Column("made_by", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("key", name="pk_build"),
    )
    op.create_table(
        "artifact",
        sa.Column("build_key", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("size", sa.Integer(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["build_key"], ["build.key"], name="fk_artifact_build_key_build"),
        sa.PrimaryKeyConstraint("build_key", "kind", name="pk_artifact"),
    )
    op.create_index("ix_artifact_sha256", "artifact", ["sha256"])
    op.create_table(
        "analysis",
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("output", sa.Text(), nullable=False),
        sa.Column("build_key", sa.Text(), nullable=False),
        sa.Column("asked", sa.Text(), nullable=False),
        sa.Column("found", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["build_key"], ["build.key"], name="fk_analysis_build_key_build"),
        sa.PrimaryKeyConstraint("key", "output", name="pk_analysis"),
    )
    op.create_index("ix_analysis_build_key", "analysis", ["build_key"])
    op.create_table(
        "imported_model",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("program", sa.Text(), nullable=False),
        sa.Column("description", sa.Text(), nullable=False),
        sa.Column("file_sha256", sa.Text(), nullable=False),
        sa.Column("sent_sha256", sa.Text(), nullable=False),
        sa.Column("author", sa.Text()),
        sa.Column("author_principal", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("id", "number", name="pk_imported_model"),
    )


def create_jobs() -> None:
    op.create_table(
        "job",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("kind", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("design_id", sa.Text()),
        sa.Column("revision", sa.Integer()),
        sa.Column("payload", sa.Text(), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("crashes", sa.Integer(), nullable=False),
        sa.Column("progress", sa.Double(), nullable=False),
        sa.Column("log", sa.Text(), nullable=False),
        sa.Column("problem", sa.Text()),
        sa.Column("result", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("updated", sa.Text(), nullable=False),
        sa.Column("client", sa.Text(), nullable=False),
        sa.Column("others", sa.Text(), nullable=False),
        sa.Column("turn", sa.BigInteger(), nullable=False),
        sa.Column("operated", sa.BigInteger(), nullable=False),
        sa.Column("principal", sa.Text()),
        sa.Column("event", sa.BigInteger(), nullable=False),
        sa.Column("losses", sa.Integer(), nullable=False),
        sa.Column("owner", sa.Text()),
        sa.Column("lease_until", sa.Double()),
        sa.Column("cause", sa.Text()),
        sa.Column("question", sa.Text()),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_job_design_id_revision_revision",
        ),
        sa.PrimaryKeyConstraint("id", name="pk_job"),
    )
    op.create_index("ix_job_client_state", "job", ["client", "state"])
    op.create_index("ix_job_design_id_revision", "job", ["design_id", "revision"])
    op.create_index("ix_job_operated", "job", ["operated"])
    op.create_index("ix_job_owner", "job", ["owner"])
    op.create_index("ix_job_question", "job", ["question"])
    op.create_index("ix_job_state_turn_id", "job", ["state", "turn", "id"])
    op.create_table(
        "idempotency",
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("scope", sa.Text(), nullable=False),
        sa.Column("client", sa.Text(), nullable=False),
        sa.Column("fingerprint", sa.Text(), nullable=False),
        sa.Column("status", sa.Integer(), nullable=False),
        sa.Column("location", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("operated", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("key", "scope", "client", name="pk_idempotency"),
    )
    op.create_index("ix_idempotency_operated", "idempotency", ["operated"])
    op.create_table(
        "counter",
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("value", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("name", name="pk_counter"),
    )


def create_studies() -> None:
    op.create_table(
        "study",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("method", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("body", sa.Text(), nullable=False),
        sa.Column("plan", sa.Text(), nullable=False),
        sa.Column("seed", sa.BigInteger(), nullable=False),
        sa.Column("chunk", sa.Integer(), nullable=False),
        sa.Column("rows", sa.Integer(), nullable=False),
        sa.Column("table_sha256", sa.Text()),
        sa.Column("client", sa.Text(), nullable=False),
        sa.Column("job", sa.Text()),
        sa.Column("result", sa.Text()),
        sa.Column("problem", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("updated", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_study_design_id_revision_revision",
        ),
        sa.PrimaryKeyConstraint("id", name="pk_study"),
    )
    op.create_index("ix_study_design_id_revision", "study", ["design_id", "revision"])
    op.create_table(
        "study_chunk",
        sa.Column("study_id", sa.Text(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("attempt", sa.Integer(), nullable=False),
        sa.Column("rows", sa.Integer(), nullable=False),
        sa.Column("refused", sa.Text(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["study_id"], ["study.id"], name="fk_study_chunk_study_id_study"),
        sa.PrimaryKeyConstraint("study_id", "number", name="pk_study_chunk"),
    )
    op.create_index("ix_study_chunk_sha256", "study_chunk", ["sha256"])


def create_worksheets() -> None:
    op.create_table(
        "worksheet_version",
        sa.Column("id", sa.Text(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("edit", sa.Text(), nullable=False),
        sa.Column("state", sa.Text(), nullable=False),
        sa.Column("text", sa.Text(), nullable=False),
        sa.Column("title", sa.Text(), nullable=False),
        sa.Column("language", sa.Integer(), nullable=False),
        sa.Column("digest", sa.Text()),
        sa.Column("faults", sa.Text(), nullable=False),
        sa.Column("tests", sa.Text(), nullable=False),
        sa.Column("record", sa.Text()),
        sa.Column("author", sa.Text()),
        sa.Column("reviewer", sa.Text()),
        sa.Column("author_principal", sa.Text()),
        sa.Column("reviewer_principal", sa.Text()),
        sa.Column("withdrawn", sa.Text()),
        sa.Column("import_sha256", sa.Text()),
        sa.Column("imported", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("updated", sa.Text(), nullable=False),
        sa.Column("released", sa.Text()),
        sa.PrimaryKeyConstraint("id", "number", name="pk_worksheet_version"),
    )


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
        sa.ForeignKeyConstraint(["principal_id"], ["principal.id"], name="fk_api_key_principal_id_principal"),
        sa.PrimaryKeyConstraint("prefix", name="pk_api_key"),
    )
    op.create_index("ix_api_key_principal_id", "api_key", ["principal_id"])
    op.create_table(
        "session",
        sa.Column("hash", sa.Text(), nullable=False),
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("key", sa.Text()),
        sa.Column("csrf", sa.Text(), nullable=False),
        sa.Column("expires", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(["principal_id"], ["principal.id"], name="fk_session_principal_id_principal"),
        sa.PrimaryKeyConstraint("hash", name="pk_session"),
    )
    op.create_index("ix_session_expires", "session", ["expires"])
    op.create_index("ix_session_principal_id", "session", ["principal_id"])


def create_approvals() -> None:
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
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_approval_design_id_revision_revision",
        ),
        sa.PrimaryKeyConstraint("design_id", "revision", "step", name="pk_approval"),
    )
    op.create_index("ix_approval_digest", "approval", ["digest"])
    op.create_index(
        "uq_approval_design_id_revision_principal_id",
        "approval",
        ["design_id", "revision", "principal_id"],
        unique=True,
        sqlite_where=sa.text("step <> 'withdrawn'"),
        postgresql_where=sa.text("step <> 'withdrawn'"),
    )
    op.create_table(
        "printed_report",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("sha256", sa.Text(), nullable=False),
        sa.Column("at", sa.Text(), nullable=False),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_printed_report_design_id_revision_revision",
        ),
        sa.PrimaryKeyConstraint("design_id", "revision", "sha256", name="pk_printed_report"),
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
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_comment_design_id_revision_revision",
        ),
        sa.PrimaryKeyConstraint("id", name="pk_comment"),
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
    op.create_table(
        "storage",
        sa.Column("principal_id", sa.Text(), nullable=False),
        sa.Column("bytes", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("principal_id", name="pk_storage"),
    )


def begin_counters(dialect: str) -> None:
    """Create the counters of one server; for several, also a sequence and the time of the last tick."""
    op.execute("INSERT INTO counter (name, value) VALUES ('identity', 0), ('operation', 0)")
    if dialect == "postgresql":
        op.execute("CREATE SEQUENCE identity AS bigint START WITH 1")
        op.execute(
            "INSERT INTO counter (name, value) "
            "VALUES ('ticked', floor(extract(epoch from clock_timestamp())))"
        )


RECORDED = ("id", "at", "principal", "name", "action", "object", "digest")
"""The content of an audit row; a sealer writes the other columns, once."""
SIGNED = "SELECT 1 FROM approval WHERE design_id = {row}.design_id AND revision = {row}.number"


def guard_rows(dialect: str) -> None:
    """Create triggers that refuse changes to records and to signed revisions."""
    guard = guard_on_postgresql if dialect == "postgresql" else guard_on_sqlite
    sealed = " OR ".join(
        ["OLD.hash IS NOT NULL", *(f"OLD.{name} {{differs}} NEW.{name}" for name in RECORDED)]
    )
    guard("audit_sealed", "UPDATE", "audit", sealed)
    guard("audit_kept", "DELETE", "audit", "")
    for event in ("UPDATE", "DELETE"):
        guard(f"approval_{event.lower()}", event, "approval", "")
        guard(f"printed_report_{event.lower()}", event, "printed_report", "")
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


ADD = (
    "INSERT INTO storage (principal_id, bytes) VALUES (NEW.principal_id, {added}) "
    "ON CONFLICT (principal_id) DO UPDATE SET bytes = storage.bytes + excluded.bytes"
)
EVENTS = {"insert": ("INSERT", "NEW.bytes", "NEW.bytes <> 0"),
          "update": ("UPDATE OF bytes", "NEW.bytes - OLD.bytes", "NEW.bytes <> OLD.bytes")}  # fmt: skip


def sum_storage(dialect: str) -> None:
    """Create triggers that update each principal's total of stored bytes from `usage`."""
    follow = follow_on_postgresql if dialect == "postgresql" else follow_on_sqlite
    for name, (event, added, changes) in EVENTS.items():
        follow(f"usage_stored_{name}", event, ADD.format(added=added), changes)


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
