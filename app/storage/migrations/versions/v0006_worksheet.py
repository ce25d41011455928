"""Worksheets: templates as text, in versions from the draft to the release."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
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
        sa.Column("withdrawn", sa.Text()),
        sa.Column("import_sha256", sa.Text()),
        sa.Column("imported", sa.Text()),
        sa.Column("created", sa.Text(), nullable=False),
        sa.Column("updated", sa.Text(), nullable=False),
        sa.Column("released", sa.Text()),
        sa.PrimaryKeyConstraint("id", "number", name="pk_worksheet_version"),
    )
