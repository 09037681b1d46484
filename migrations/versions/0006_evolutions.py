"""The history of a fit's search stands beside the fit, compact. Those of earlier fits stay in their rows."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    op.create_table(
        "evolutions",
        sa.Column("fit", sa.String(length=64), nullable=False),
        sa.Column("content", sa.LargeBinary(), nullable=False),
        sa.ForeignKeyConstraint(["fit"], ["fits.id"]),
        sa.PrimaryKeyConstraint("fit"),
    )


def downgrade() -> None:
    op.drop_table("evolutions")
