"""Counters that no clock disturbs, and clients: who asked for a job, and whose an idempotency key is."""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    counter = op.create_table(
        "counter",
        sa.Column("name", sa.Text(), nullable=False),
        sa.Column("value", sa.BigInteger(), nullable=False),
        sa.PrimaryKeyConstraint("name", name="pk_counter"),
    )
    op.bulk_insert(
        counter,
        [{"name": "identity", "value": _newest_identity()}, {"name": "operation", "value": 0}],
    )
    with op.batch_alter_table("build") as build:
        build.add_column(sa.Column("operated", sa.BigInteger(), nullable=False, server_default="0"))
        build.add_column(sa.Column("made_by", sa.Text(), nullable=False, server_default=""))
    with op.batch_alter_table("job") as job:
        job.add_column(sa.Column("client", sa.Text(), nullable=False, server_default=""))
        job.add_column(sa.Column("others", sa.Text(), nullable=False, server_default="[]"))
        job.add_column(sa.Column("turn", sa.BigInteger(), nullable=False, server_default="0"))
        job.add_column(sa.Column("operated", sa.BigInteger(), nullable=False, server_default="0"))
        job.drop_index("ix_job_state_id")
        job.create_index("ix_job_state_turn_id", ["state", "turn", "id"])
        job.create_index("ix_job_client_state", ["client", "state"])
        job.create_index("ix_job_operated", ["operated"])
    with op.batch_alter_table("idempotency") as idempotency:
        idempotency.add_column(sa.Column("client", sa.Text(), nullable=False, server_default=""))
        idempotency.add_column(sa.Column("operated", sa.BigInteger(), nullable=False, server_default="0"))
        idempotency.drop_constraint("pk_idempotency", type_="primary")
        idempotency.create_primary_key("pk_idempotency", ["key", "scope", "client"])
        idempotency.create_index("ix_idempotency_operated", ["operated"])


def _newest_identity() -> int:
    """The number in the newest identity: its first 14 hexadecimal digits, microseconds of a clock so far."""
    newest = [op.get_bind().scalar(sa.text(f"SELECT max(id) FROM {table}")) for table in ("design", "job")]
    return max((int(id[:14], 16) for id in newest if id), default=0)
