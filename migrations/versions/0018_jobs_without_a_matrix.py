"""Jobs that need no runs: a plan is made before anything is measured."""

import sqlalchemy as sa
from alembic import op

revision = "0018"
down_revision = "0017"


def upgrade() -> None:
    with op.batch_alter_table("jobs") as batch:
        batch.alter_column("matrix", existing_type=sa.String(length=64), nullable=True)


def downgrade() -> None:
    op.execute("DELETE FROM jobs WHERE matrix IS NULL")
    with op.batch_alter_table("jobs") as batch:
        batch.alter_column("matrix", existing_type=sa.String(length=64), nullable=False)
