"""A key is claimed before it is answered, with the id of what comes of it; old answers are found by age."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    with op.batch_alter_table("idempotency") as batch:
        batch.add_column(sa.Column("subject", sa.String(length=64), nullable=False, server_default=""))
        batch.alter_column("status", existing_type=sa.Integer(), nullable=True)
        batch.create_index("ix_idempotency_created_at", ["created_at"], unique=False)


def downgrade() -> None:
    op.execute("DELETE FROM idempotency WHERE status IS NULL")
    with op.batch_alter_table("idempotency") as batch:
        batch.drop_index("ix_idempotency_created_at")
        batch.alter_column("status", existing_type=sa.Integer(), nullable=False)
        batch.drop_column("subject")
