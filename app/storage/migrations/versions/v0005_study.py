"""Studies: many rows of one design, calculated in chunks whose values are artifacts."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
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
        sa.PrimaryKeyConstraint("id", name="pk_study"),
        sa.ForeignKeyConstraint(
            ["design_id", "revision"],
            ["revision.design_id", "revision.number"],
            name="fk_study_design_id_revision_revision",
        ),
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
        sa.PrimaryKeyConstraint("study_id", "number", name="pk_study_chunk"),
        sa.ForeignKeyConstraint(["study_id"], ["study.id"], name="fk_study_chunk_study_id_study"),
    )
    op.create_index("ix_study_chunk_sha256", "study_chunk", ["sha256"])
