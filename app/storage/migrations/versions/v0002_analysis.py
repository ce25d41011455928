"""Table of results of finite elements on solids."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.create_table(
        "analysis",
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("output", sa.Text(), nullable=False),
        sa.Column("build_key", sa.Text(), nullable=False),
        sa.Column("asked", sa.Text(), nullable=False),
        sa.Column("found", sa.Text(), nullable=False),
        sa.Column("created", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("key", "output", name="pk_analysis"),
        sa.ForeignKeyConstraint(["build_key"], ["build.key"], name="fk_analysis_build_key_build"),
    )
    op.create_index("ix_analysis_build_key", "analysis", ["build_key"])
