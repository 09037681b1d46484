"""A job may be told to stop and keep what it found."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    # Added in place: a table made anew and copied would leave a database of half-empty pages behind.
    op.add_column("jobs", sa.Column("conclude", sa.Boolean(), nullable=False, server_default=sa.false()))


def downgrade() -> None:
    with op.batch_alter_table("jobs") as batch:
        batch.drop_column("conclude")
