"""Profile likelihoods that jobs have made."""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"


def upgrade() -> None:
    op.create_table(
        "profiles",
        sa.Column("id", sa.String(length=64), nullable=False),
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("parameter", sa.String(length=200), nullable=False),
        sa.Column("created_at", sa.String(length=40), nullable=False),
        sa.Column("result", sa.JSON(), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("id"),
    )
    op.create_index("ix_profiles_fit", "profiles", ["fit"])


def downgrade() -> None:
    op.drop_index("ix_profiles_fit", "profiles")
    op.drop_table("profiles")
