"""Test plans for a rig."""

import sqlalchemy as sa
from alembic import op

revision = "0016"
down_revision = "0015"


def upgrade() -> None:
    op.create_table(
        "plans",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=True),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_plans_fit", "plans", ["fit"])
    op.create_index("ix_plans_created_at", "plans", ["created_at"])


def downgrade() -> None:
    op.drop_index("ix_plans_created_at", "plans")
    op.drop_index("ix_plans_fit", "plans")
    op.drop_table("plans")
