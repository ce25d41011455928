"""Tables of a design's place among others: tags, and whether it is archived."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"


def upgrade() -> None:
    with op.batch_alter_table("design") as design:
        design.add_column(sa.Column("archived", sa.Text(), nullable=True))
    op.create_table(
        "design_tag",
        sa.Column("design_id", sa.Text(), nullable=False),
        sa.Column("key", sa.Text(), nullable=False),
        sa.Column("tag", sa.Text(), nullable=False),
        sa.PrimaryKeyConstraint("design_id", "key", name="pk_design_tag"),
        sa.ForeignKeyConstraint(["design_id"], ["design.id"], name="fk_design_tag_design_id_design"),
    )
    op.create_index("ix_design_tag_key", "design_tag", ["key"])
